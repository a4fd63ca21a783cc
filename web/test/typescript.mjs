// Lets `node --test` (Node 20) import what esbuild bundles: it strips the types of .ts files as they are loaded; .ftl files are texts.
import { register } from "node:module";

register(
  "data:text/javascript," +
    encodeURIComponent(`
      import { transform } from ${JSON.stringify(import.meta.resolve("esbuild"))};
      import { readFile } from "node:fs/promises";
      export async function load(url, context, next) {
        if (url.endsWith(".ftl")) {
          return { format: "module", source: "export default " + JSON.stringify(await readFile(new URL(url), "utf8")), shortCircuit: true };
        }
        if (!url.endsWith(".ts")) return next(url, context);
        const { code } = await transform(await readFile(new URL(url), "utf8"), { loader: "ts", sourcemap: "inline" });
        return { format: "module", source: code, shortCircuit: true };
      }
    `),
);
