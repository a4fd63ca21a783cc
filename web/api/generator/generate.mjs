// Writes ../schema.ts from ../openapi.json. It lives in a folder of its own because it needs a TypeScript older than the pages'.
import { readFile, writeFile } from "node:fs/promises";
import openapi, { astToString } from "openapi-typescript";
import { stamped } from "../stamp.ts";

const address = (file) => new URL(file, import.meta.url);
const document = await readFile(address("../openapi.json"), "utf8");
const lock = await readFile(address("package-lock.json"), "utf8");
const body = astToString(await openapi(JSON.parse(document)));
await writeFile(address("../schema.ts"), stamped({ document, lock }, body));
