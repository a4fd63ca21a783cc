import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { newer, oldest, unsupported } from "./newer.ts";

const dist = mkdtempSync(join(tmpdir(), "kelir-old-"));
execFileSync("node", ["build.mjs", dist]);
after(() => rmSync(dist, { recursive: true }));
const built = (ending: string) =>
  readdirSync(join(dist, "assets"))
    .filter((name) => name.endsWith(ending))
    .map((name) => [name, readFileSync(join(dist, "assets", name), "utf8")] as const);

/** Names that are newer than the oldest browsers, and why they may stand in the bundles. */
const ALLOWED: Record<string, string> = { run: "jsPsych's own", draw: "our own", toZonedDateTime: "Fluent asks first whether there is a Temporal" };

test("the bundles use nothing that the oldest browsers have not", () => {
  const found = built(".js").map(([name, text]) => [name.replace(/-.*/, ""), unsupported(text).filter((one) => !(one in ALLOWED))]);
  assert.deepEqual(
    found.filter(([, names]) => names?.length !== 0),
    [],
  );
  assert.ok(found.length >= 2);
});

test("what is newer is found: functions, classes, expressions", () => {
  const found = "canParse OffscreenCanvas AbortSignal.timeout findLast toSorted groupBy withResolvers (?<=".split(" ");
  const text = "URL.canParse(x);new OffscreenCanvas(1,1);AbortSignal.timeout(9);[].findLast(f);[].toSorted();Object.groupBy(a);Promise.withResolvers();/(?<=a)b/";
  for (const name of found) assert.ok(unsupported(text).includes(name), name);
  for (const name of ["at", "hasOwn", "replaceChildren", "decode", "structuredClone", "addEventListener"]) assert.ok(!newer.has(name), name);
  assert.ok(newer.size > 1000, String(newer.size));
});

test("a length that only newer browsers know has one before it that all do", () => {
  for (const [name, text] of built(".css")) {
    for (const [, property, value] of text.matchAll(/[;{]([a-z-]+):([^;}]*\b\d+(?:dvh|svh|lvh|dvw|svw)[^;}]*)/g)) {
      assert.ok(text.includes(`${property}:${value?.replace(/[dsl]v([hw])/g, "v$1")};${property}:${value}`), `${name}: ${property}: ${value}`);
    }
  }
});

test("the README names the same browsers", () => {
  const named = Object.entries(oldest)
    .map((browser) => browser.join(" "))
    .join(", ");
  assert.ok(readFileSync(new URL("../../README.md", import.meta.url), "utf8").includes(named), named);
});
