// Builds the two pages into one folder: `node build.mjs OUT` (or KELIR_WEB_OUT; default node_modules/.kelir/dist).
//
// OUT/participant.html, OUT/console.html    shells that name the hashed files
// OUT/assets/*-HASH.{js,css,svg}            immutable
// OUT/assets/licenses.txt                   notices of the packages inside the bundles

import { mkdir, readdir, readFile, rm, writeFile } from "node:fs/promises";
import { basename, dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const root = dirname(fileURLToPath(import.meta.url));
const out = resolve(process.argv[2] ?? process.env.KELIR_WEB_OUT ?? join(root, "node_modules/.kelir/dist"));
const pages = ["participant", "console"];

await rm(out, { recursive: true, force: true });
await mkdir(join(out, "assets"), { recursive: true });

/** The oldest browsers that the pages are made for. */
const oldest = JSON.parse(await readFile(join(root, "browsers.json"), "utf8"));
const target = ["es2022", ...Object.entries(oldest).map(([name, version]) => name.toLowerCase() + version)];

const { metafile } = await build({
  absWorkingDir: root,
  entryPoints: [...pages.map((page) => ({ in: `${page}/main.ts`, out: page })), { in: "shared/icon.svg", out: "icon" }],
  outdir: join(out, "assets"),
  entryNames: "[name]-[hash]",
  bundle: true,
  minify: true,
  format: "esm",
  target,
  charset: "utf8",
  legalComments: "none", // the notices are in licenses.txt
  loader: { ".svg": "copy", ".ftl": "text" },
  metafile: true,
  logLevel: "warning",
});

/** What is said before the page is there, by language: of its own catalogues, with the browsers that it is made for. */
const catalogues = (await readdir(join(root, "participant/words"))).filter((name) => name.endsWith(".ftl")).sort((a, b) => Number(b === "en.ftl") - Number(a === "en.ftl"));
const early = Object.fromEntries(
  await Promise.all(
    catalogues.map(async (name) => {
      const text = await readFile(join(root, "participant/words", name), "utf8");
      const message = (id) => text.match(new RegExp(`^${id} = (.*)$`, "m"))[1];
      const browsers = Object.entries(oldest)
        .map((browser) => browser.join(" "))
        .join(", ");
      const said = ["reload", "not-loaded", "too-old", "no-script"].map((id) => [id, message(id).replace("{ $browsers }", browsers)]);
      return [name.replace(".ftl", ""), Object.fromEntries(said)];
    }),
  ),
);
const boot = await build({
  absWorkingDir: root,
  entryPoints: ["participant/boot.ts"],
  outdir: join(out, "assets"),
  entryNames: "[name]-[hash]",
  minify: true,
  target: "es5",
  bundle: true,
  charset: "ascii",
  define: { WORDS: JSON.stringify(early) },
  metafile: true,
  logLevel: "warning",
});

/** The file names an entry point was written to. */
const outputs = Object.entries(metafile.outputs);
const written = (entry) => {
  const [path, output] = outputs.find(([, o]) => o.entryPoint === entry) ?? [];
  // A copied file has no entryPoint of its own: it is known by its input.
  const copied = outputs.find(([p, o]) => Object.keys(o.inputs)[0] === entry && !p.endsWith(".js"))?.[0];
  const script = path ?? copied;
  if (!script) throw new Error(`nothing was built from ${entry}`);
  return { file: basename(script), css: output?.cssBundle && basename(output.cssBundle) };
};

const icon = written("shared/icon.svg").file;
for (const page of pages) {
  const { file, css } = written(`${page}/main.ts`);
  const head = [`<link rel="icon" type="image/svg+xml" href="/assets/${icon}">`, `<link rel="stylesheet" href="/assets/${css}">`, `<script type="module" src="/assets/${file}"></script>`].join(
    "\n    ",
  );
  const shell = await readFile(join(root, page, "index.html"), "utf8");
  if (!shell.includes("<!-- assets -->")) throw new Error(`${page}/index.html has no <!-- assets --> line`);
  const first = page === "participant" ? `<script src="/assets/${basename(Object.keys(boot.metafile.outputs)[0])}"></script>\n    ` : "";
  const noScript = Object.entries(early).map(([language, said]) => `<p lang="${language}" dir="auto">${said["no-script"]}</p>`);
  const made = shell.replace("<!-- assets -->", () => first + head).replace("<!-- no script -->", () => noScript.join("\n    "));
  await writeFile(join(out, `${page}.html`), made);
}

// The notices of every package that has code in a bundle.
const packages = new Set(Object.keys(metafile.inputs).flatMap((input) => input.match(/^node_modules\/((?:@[^/]+\/)?[^/]+)/)?.[1] ?? []));
let notices = "";
for (const name of [...packages].sort()) {
  const folder = join(root, "node_modules", name);
  const { version, license } = JSON.parse(await readFile(join(folder, "package.json"), "utf8"));
  const file = (await readdir(folder)).find((f) => /^licen[cs]e/i.test(f));
  notices += `${name} ${version} (${license})\n\n${file ? await readFile(join(folder, file), "utf8") : ""}\n\n`;
}
await writeFile(join(out, "assets/licenses.txt"), notices);

for (const name of await readdir(join(out, "assets"))) {
  const bytes = await readFile(join(out, "assets", name));
  console.log(`${name}\t${bytes.length} bytes\t${gzipSync(bytes).length} gzip`);
}
