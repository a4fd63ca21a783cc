/** Fails when `schema.ts` is not what the generator makes of `openapi.json`: the first half of `npm run check`. */
import { readFileSync } from "node:fs";
import { fault } from "./stamp.ts";

const text = (file: string) => readFileSync(new URL(file, import.meta.url), "utf8");
const found = fault({ document: text("openapi.json"), lock: text("generator/package-lock.json") }, text("schema.ts"));
if (found !== null) {
  console.error(`web/api/schema.ts ${found}; run \`npm run types\` in web and commit what it writes.`);
  process.exit(1);
}
