/** Holds the catalogues to each other and to the page, and writes `messages.d.ts`: the first step of `npm run check`. */
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { faults, read, types } from "./catalogue.ts";

const here = new URL("./", import.meta.url);
const participant = new URL("../", import.meta.url);
const files = (folder: URL, end: string) =>
  readdirSync(folder, { recursive: true, encoding: "utf8" })
    .filter((file) => file.endsWith(end))
    .sort();

const catalogues = Object.fromEntries(files(here, ".ftl").map((file) => [file.replace(".ftl", ""), read(readFileSync(new URL(file, here), "utf8"))]));
const sources = files(participant, ".ts")
  .filter((file) => !file.startsWith("words"))
  .map((file) => readFileSync(new URL(file, participant), "utf8"));
// What is said before the page is there is put into it as it is built.
sources.push(readFileSync(new URL("../../build.mjs", import.meta.url), "utf8"));

const found = faults(catalogues, sources.join("\n"));
for (const fault of found) console.error(`web/participant/words: ${fault}`);
if (found.length > 0) process.exit(1);

const target = new URL("messages.d.ts", here);
const body = types(catalogues.en ?? new Map());
let before = "";
try {
  before = readFileSync(target, "utf8");
} catch {
  // it has not been made yet
}
if (before !== body) writeFileSync(target, body);
