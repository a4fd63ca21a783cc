import assert from "node:assert/strict";
import { test } from "node:test";
import { AnimationClock, refreshPeriod } from "../participant/clock.ts";

/** Timestamps of `n` refreshes at `hz`, without those in `dropped`. */
const refreshes = (hz: number, n: number, dropped: number[] = []) =>
  Array.from({ length: n }, (_, i) => 100 + (1000 * i) / hz).filter((_, i) => !dropped.includes(i));

const near = (actual: number | null, expected: number, tolerance: number) =>
  assert.ok(actual !== null && Math.abs(actual - expected) <= tolerance, `${actual} is not within ${tolerance} of ${expected}`);

test("the refresh is measured, not assumed", () => {
  for (const hz of [50, 59.94, 60, 75, 120, 144, 240]) near(refreshPeriod(refreshes(hz, 60)), 1000 / hz, 1e-9);
});

test("dropped frames don't move the measured refresh", () => {
  const times = refreshes(60, 60, [7, 20, 21, 40]);
  near(refreshPeriod(times), 1000 / 60, 1e-9);
  // The plain mean, which this isn't, would be well off.
  const mean = ((times.at(-1) ?? 0) - (times[0] ?? 0)) / (times.length - 1);
  assert.ok(Math.abs(mean - 1000 / 60) > 0.5);
});

test("too few refreshes give no number", () => {
  assert.equal(refreshPeriod([]), null);
  assert.equal(refreshPeriod(refreshes(60, 5)), null);
  assert.equal(refreshPeriod(refreshes(1, 60)), null, "a hidden page ticks once a second");
});

/** Frames drawn at each of the times. */
const play = (clock: AnimationClock, times: number[]) => times.map((t) => clock.tick(t));

test("each frame is held for a whole number of refreshes, and the loop closes", () => {
  const clock = new AnimationClock({ fps: 30, frames: 3, loop: true, periodMs: 1000 / 60 });
  assert.equal(clock.hold, 2);
  assert.deepEqual(play(clock, refreshes(60, 8)), [0, 0, 1, 1, 2, 2, 0, 0]);
  const { shown, skipped, missed_refreshes, intervals, late } = clock.log();
  assert.deepEqual({ shown, skipped, missed_refreshes, intervals, late }, { shown: 4, skipped: 0, missed_refreshes: 0, intervals: { 1: 7 }, late: [] });
});

test("the hold follows the display", () => {
  const hold = (fps: number, hz: number) => new AnimationClock({ fps, frames: 9, loop: true, periodMs: 1000 / hz }).hold;
  assert.deepEqual([hold(30, 60), hold(30, 120), hold(30, 144), hold(60, 60), hold(24, 75), hold(60, 50)], [2, 4, 5, 1, 3, 1]);
});

test("a late browser skips to the frame that is due, and the log says when", () => {
  const clock = new AnimationClock({ fps: 60, frames: 10, loop: true, periodMs: 1000 / 60 });
  assert.deepEqual(play(clock, refreshes(60, 8, [3, 4])), [0, 1, 2, 5, 6, 7]);
  const log = clock.log();
  assert.deepEqual(log.late, [[5, 2]]);
  assert.equal(log.missed_refreshes, 2);
  assert.equal(log.skipped, 2);
  assert.equal(log.shown, 6);
  near(log.longest_interval_ms, 50, 0.001);
});

test("an error of the measured period does not add up", () => {
  const clock = new AnimationClock({ fps: 60, frames: 100_000, loop: true, periodMs: (1000 / 60) * 1.01 });
  assert.equal(play(clock, refreshes(60, 3001)).at(-1), 3000);
  // A clock that divides the total time would be thirty frames behind by then.
  assert.equal(Math.round((3000 * 1000) / 60 / ((1000 / 60) * 1.01)), 2970);
});

test("an animation that doesn't loop stays on its last frame and logs no more", () => {
  const clock = new AnimationClock({ fps: 60, frames: 3, loop: false, periodMs: 1000 / 60 });
  assert.deepEqual(play(clock, refreshes(60, 6)), [0, 1, 2, 2, 2, 2]);
  assert.equal(clock.log().shown, 3);
});

test("the log is a snapshot", () => {
  const clock = new AnimationClock({ fps: 60, frames: 3, loop: true, periodMs: 1000 / 60 });
  play(clock, refreshes(60, 3));
  const log = clock.log();
  clock.tick(1e4);
  assert.deepEqual(log.intervals, { 1: 2 });
  assert.deepEqual(log.late, []);
});
