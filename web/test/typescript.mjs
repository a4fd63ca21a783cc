// Lets `node --test` (Node 20) import .ts files: esbuild strips the types as they are loaded.
import { register } from "node:module";

register(
  "data:text/javascript," +
    encodeURIComponent(`
      import { transform } from ${JSON.stringify(import.meta.resolve("esbuild"))};
      import { readFile } from "node:fs/promises";
      export async function load(url, context, next) {
        if (!url.endsWith(".ts")) return next(url, context);
        const { code } = await transform(await readFile(new URL(url), "utf8"), { loader: "ts", sourcemap: "inline" });
        return { format: "module", source: code, shortCircuit: true };
      }
    `),
);
