import assert from "node:assert/strict";
import { test } from "node:test";
import type { BlockReport, Stimulus, StudyRow } from "../console/api.ts";
import { flatten } from "../console/gallery.ts";
import { points } from "../console/scatter.ts";
import { niceTicks } from "../console/strips.ts";
import { statusText } from "../console/study.ts";

const stimulus = (pair: string, condition: string, rmse: number | null): Stimulus => {
  const errors = { count: 1, bias: 0, rmse: rmse ?? 0, p999: 0, max: 0 };
  const error = rmse === null ? null : { reference: { technique: "mc" }, frames: [0], all: { ...errors, rmse: 1 }, penumbra: errors, floor: null };
  return { pair, condition, sha256: "0", provenance: { error } };
};
const block = (pair: string, chosen: number): BlockReport =>
  ({
    ...{ id: "b", target: "pa", conditions: ["pa", "mc"] },
    by_item: [{ id: pair, target: { chosen, trials: 32, proportion: chosen / 32, wilson: { low: 0.1, high: 0.4 }, by_participant: null } }],
  }) as unknown as BlockReport;

test("who did not prefer the target preferred the other, interval and all", () => {
  const [pa, mc] = points([block("a", 8)], [stimulus("a", "pa", 1e-3), stimulus("a", "mc", 2e-4)]);
  assert.deepEqual([pa?.share, pa?.interval, pa?.error], [0.25, { low: 0.1, high: 0.4 }, 1e-3]);
  assert.deepEqual([mc?.share, mc?.interval, mc?.error], [0.75, { low: 0.6, high: 0.9 }, 2e-4]);
});

test("stimuli without a measured error, of other pairs or of unknown conditions have no point", () => {
  const none = [stimulus("a", "pa", null), stimulus("z", "pa", 1), stimulus("a", "oracle", 1), stimulus("a", "mc", 0)];
  assert.deepEqual(points([block("a", 8)], none), []);
  assert.equal(points([block("a", 8)], [...none, stimulus("a", "mc", 1)]).length, 1);
});

test("ticks are round and reach the largest value", () => {
  assert.deepEqual(niceTicks(8.8), [0, 2, 4, 6, 8, 10]);
  assert.deepEqual(niceTicks(0.98, 3), [0, 0.5, 1]);
  for (const most of [0.001, 0.3, 1, 7, 99, 1234]) assert.ok((niceTicks(most).at(-1) ?? 0) >= most, String(most));
});

test("provenance is read to its leaves, and what is null is left out", () => {
  assert.deepEqual(flatten({ a: { b: 1, c: null }, size: [592, 333], d: "x" }), [["a.b", 1], ["size", "592, 333"], ["d", "x"]]);
  assert.deepEqual(flatten({ list: [{ a: 1 }] }), [["list.0.a", 1]]);
});

test("a study's readiness is said in words", () => {
  const row: StudyRow = { id: "s", title: "S", participants: { started: 0, in_progress: 0, completed: 0 } };
  assert.equal(statusText(undefined), null);
  assert.equal(statusText({ ...row, status: "ready" }), null);
  assert.match(statusText({ ...row, status: "preparing", detail: { done: 3, total: 10, stimulus: "x" } }) ?? "", /3 of 10 ready/);
  assert.match(statusText({ ...row, status: "failed", detail: "no such scene" }) ?? "", /no such scene/);
});
