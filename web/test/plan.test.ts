import assert from "node:assert/strict";
import { test } from "node:test";
import type { Trial } from "../participant/api.ts";
import { position, remaining, withAnswered } from "../participant/plan.ts";

const ref = { sha256: "0", url: "/stimuli/0" };
const trial = (trial_index: number, answered = false): Trial => ({
  ...{ trial_index, answered, trial: "two-alternative", block_index: 0, item_index: 0, kind: "still", shown: { left: ref, right: ref }, larger: [], settings: null, width: 592, height: 333 },
});
const indices = (trials: Trial[]) => trials.map((t) => t.trial_index);

test("a new session begins with the first trial, in the plan's order whatever the list's", () => {
  assert.deepEqual(indices(remaining([trial(2), trial(0), trial(1)], new Set())), [0, 1, 2]);
});

test("a reload resumes after what the server has and what still waits here", () => {
  const trials = [trial(0, true), trial(1, true), trial(2), trial(3), trial(4)];
  assert.deepEqual(indices(remaining(trials, new Set([2]))), [3, 4]);
  // Without the waiting answer trial 2 would be asked twice.
  assert.deepEqual(indices(remaining(trials, new Set())), [2, 3, 4]);
});

test("a gap that the server reports is filled first", () => {
  assert.deepEqual(indices(remaining([trial(0, true), trial(1), trial(2, true), trial(3)], new Set())), [1, 3]);
});

test("nothing remains when all is answered or waiting", () => {
  assert.deepEqual(remaining([trial(0, true), trial(1)], new Set([1])), []);
});

test("position counts from one over the whole plan", () => {
  const plan = { trials: [trial(0, true), trial(1), trial(2)], more: false, most_trials: 3 };
  assert.equal(position(plan, trial(2)), "3 of 3");
  assert.equal(position(plan, trial(0)), "1 of 3");
});

test("while a plan grows its length is not known, only its most", () => {
  const plan = { trials: [trial(0, true), trial(1)], more: true, most_trials: 43 };
  assert.equal(position(plan, trial(1)), "2 of at most 43");
  assert.equal(position({ ...plan, more: false }, trial(1)), "2 of 2");
});

test("an acknowledged trial is answered, and only that one", () => {
  assert.deepEqual(
    withAnswered([trial(0), trial(1)], 1).map((t) => t.answered),
    [false, true],
  );
});

test("decided trials are added once, and never change what is known", () => {
  const grown = withAnswered([trial(0), trial(1)], 0, [{ ...trial(1), width: 7 }, trial(2)]);
  assert.deepEqual(indices(grown), [0, 1, 2]);
  assert.deepEqual(
    grown.map((t) => [t.answered, t.width]),
    [
      [true, 592],
      [false, 592],
      [false, 592],
    ],
  );
  // An answer that was resent brings its trials again.
  assert.deepEqual(indices(withAnswered(grown, 0, [trial(1), trial(2)])), [0, 1, 2]);
});
