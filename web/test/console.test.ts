import assert from "node:assert/strict";
import { test } from "node:test";
import { addressOf, type Stimulus, type StudySummary, type StudyVersion } from "../console/api.ts";
import { nameOf } from "../console/document.ts";
import { smallest } from "../console/gallery.ts";
import { flatten, measuredError, standardError } from "../console/provenance.ts";
import { statusText } from "../console/status.ts";
import { pageOf, selectionOf } from "../console/versions.ts";

const stimulus = (item: string, condition: string, rmse: number | null): Stimulus => {
  const errors = { count: 1, bias: 0, rmse: rmse ?? 0, p999: 0, max: 0 };
  const error = rmse === null ? null : { reference: { technique: "mc" }, frames: [0], all: { ...errors, rmse: 1 }, penumbra: errors, floor: null };
  return { item, condition, size: [592, 333], sha256: "0", pixels_sha256: "0", provenance: { error } };
};
test("a section's name in an address is its title, whatever that is written in", () => {
  assert.deepEqual(
    ["In short", "With and without the excluded", "Größe & <b>", "影"].map((title) => nameOf({ title })),
    ["report-in-short", "report-with-and-without-the-excluded", "report-größe-b-", "report-影"],
  );
});

test("what is drawn at several sizes is told once, at the smallest", () => {
  const [a, b, c] = [stimulus("a", "pa", 1e-3), { ...stimulus("a", "pa", 2e-3), size: [1110, 624] }, { ...stimulus("a", "mc", 1e-3), size: [1110, 624] }];
  assert.deepEqual(smallest([b, a, c]), [a, c]);
});

test("provenance is read to its leaves, and what is null is left out", () => {
  assert.deepEqual(flatten({ a: { b: 1, c: null }, size: [592, 333], d: "x" }), [
    ["a.b", 1],
    ["size", "592, 333"],
    ["d", "x"],
  ]);
  assert.deepEqual(flatten({ list: [{ a: 1 }] }), [["list.0.a", 1]]);
});

test("provenance is believed only where it is what it should be", () => {
  const penumbra = { rmse: 1e-3, max: 2e-2 };
  assert.deepEqual(measuredError({ error: { reference: { technique: "mc" }, penumbra, floor: 7e-5 } }), { reference: { technique: "mc" }, penumbra, floor: 7e-5 });
  assert.equal(measuredError({ error: { penumbra } })?.floor, null);
  for (const nothing of [null, undefined, 7, "x", [], {}, { error: null }, { error: { penumbra: { rmse: "1", max: 2 } } }, { error: [penumbra] }]) {
    assert.equal(measuredError(nothing), null, JSON.stringify(nothing));
    assert.equal(standardError(nothing), null, JSON.stringify(nothing));
  }
  assert.deepEqual(standardError({ standard_error: { rms_sampled: 1e-4, max: 1e-3 } }), { rms: 1e-4, max: 1e-3 });
});

test("a study's readiness is said in words", () => {
  const row: StudySummary = {
    ...{ id: "s", title: "S", version: null, file_hash: "0", status: "ready", progress: null, reason: null, warnings: [], most_trials: 1 },
    participants: { started: 0, in_progress: 0, completed: 0 },
  };
  assert.equal(statusText(row), null);
  assert.match(statusText({ ...row, warnings: ["completion.redirect: must hold [CODE]"] }) ?? "", /can come.*must hold \[CODE\]/);
  assert.match(statusText({ ...row, status: "preparing", progress: { done: 3, total: 10, stimulus: "x" } }) ?? "", /3 of 10 ready/);
  assert.match(statusText({ ...row, status: "preparing" }) ?? "", /being made\./);
  assert.match(statusText({ ...row, status: "failed", reason: "no such scene" }) ?? "", /no such scene/);
});

const versions = ["c0ffee00aa", "beef0123bb", "beef0123cc"].map(
  (beginning, i): StudyVersion => ({
    ...{ version: beginning.padEnd(64, "9"), design_hash: "0", title: "S", is_current: i === 0, answers: 0, stimuli: 0 },
    ...{ first_served_at: "", last_served_at: "", participants: { started: 0, in_progress: 0, completed: 0 } },
  }),
);
const [current, second, third] = versions.map(({ version }) => version) as [string, string, string];

test("an address names versions by hashes or their beginnings, and nothing that could be two", () => {
  const read = (query: string) => selectionOf("s", new URLSearchParams(query), versions);
  assert.deepEqual(read(""), { study: "s", version: current, pooled: [] });
  assert.deepEqual(read("version=current"), read(""));
  assert.deepEqual(read("version=beef0123b&with=c0ffee00,beef0123c"), { study: "s", version: second, pooled: [current, third] });
  assert.deepEqual(read(`version=${third}&with=all`), { study: "s", version: third, pooled: [current, second] });
  assert.deepEqual(read("with=c0ffee00,beef0123b,beef0123b"), { study: "s", version: current, pooled: [second] }, "neither with itself nor twice");
  for (const [query, name] of [
    ["version=beef0123", "beef0123"],
    ["version=beef01", "beef01"],
    ["version=00000000", "00000000"],
    ["with=beef0123", "beef0123"],
    ["version=c0ffee00&with=x", "x"],
  ] as const) {
    assert.deepEqual(read(query), { unknown: name });
  }
  assert.deepEqual(selectionOf("s", new URLSearchParams(), []), { study: "s", version: "current", pooled: [] });
});

test("a selection comes back from its address", () => {
  const all = [current, second, third];
  for (const version of all) {
    for (const pooled of [[], ...all.filter((other) => other !== version).map((other) => [other]), all.filter((other) => other !== version)]) {
      const address = pageOf({ study: "a study", version, pooled }, versions);
      const { pathname, searchParams } = new URL(address, "http://x");
      assert.equal(pathname, "/console/studies/a%20study");
      assert.deepEqual(selectionOf("a study", searchParams, versions), { study: "a study", version, pooled });
    }
  }
  assert.equal(pageOf({ study: "s", version: current, pooled: [] }, versions), "/console/studies/s");
});

test("files are of the versions that were chosen", () => {
  assert.equal(addressOf({ study: "s", version: second, pooled: [] }, "report.md"), `/api/v1/studies/s/versions/${second}/report.md`);
  assert.equal(addressOf({ study: "s", version: "current", pooled: [second, third] }, "pairs.csv"), `/api/v1/studies/s/versions/current/pairs.csv?with=${second},${third}`);
});
