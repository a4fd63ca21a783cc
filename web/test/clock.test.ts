import assert from "node:assert/strict";
import { test } from "node:test";
import { AnimationClock, refreshPeriod } from "../participant/clock.ts";

/** Timestamps of `n` refreshes at `hz`, without those in `dropped`. */
const refreshes = (hz: number, n: number, dropped: number[] = []) => Array.from({ length: n }, (_, i) => 100 + (1000 * i) / hz).filter((_, i) => !dropped.includes(i));

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

type Film = ConstructorParameters<typeof AnimationClock>[0];
const film = (options: Partial<Film> = {}): AnimationClock => new AnimationClock({ fps: 30, frames: 90, loop: true, periodMs: 1000 / 60, ...options });
/** Frames drawn at each of the times. */
const play = (clock: { tick(now: number): number }, times: number[]) => times.map((t) => clock.tick(t));

/** Numbers in [−1, 1), the same each time. */
function noise(seed: number): () => number {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return (2 * state) / 2 ** 32 - 1;
  };
}

/** Displays by name: when they redraw in ten seconds, and the period that is measured of them. */
function displays(): Record<string, { times: number[]; periodMs: number }> {
  const random = noise(7);
  const steady = (hz: number) => ({ times: refreshes(hz, 10 * hz), periodMs: 1000 / hz });
  const times = (next: (i: number) => number) => {
    const all = [100];
    for (let i = 0; (all.at(-1) ?? 0) < 10_100; i++) all.push((all.at(-1) ?? 0) + next(i));
    return all;
  };
  const jittered = (hz: number) => ({ ...steady(hz), times: refreshes(hz, 10 * hz).map((t) => t + random()) });
  return {
    ...Object.fromEntries([50, 60, 75, 90, 120, 144, 240].map((hz) => [`${hz} Hz`, steady(hz)])),
    ...Object.fromEntries([60, 75, 144].map((hz) => [`${hz} Hz whose times jitter by a millisecond`, jittered(hz)])),
    "60 Hz, to whole milliseconds": { times: refreshes(60, 600).map(Math.round), periodMs: 1000 / 60 },
    "variable, 40 to 144 Hz": { times: times(() => 16 + 9 * random()), periodMs: 16 },
    "60 Hz that falls to 30 half way": { times: times((i) => (i < 300 ? 1000 / 60 : 1000 / 30)), periodMs: 1000 / 60 },
    "75 Hz measured as 60": { times: refreshes(75, 750), periodMs: 1000 / 60 },
  };
}

/** How a film of ten seconds was shown: frames a second, and the furthest that a frame was from its time, in refreshes. */
function seen(clock: { tick(now: number): number }, { times, periodMs }: { times: number[]; periodMs: number }, fps: number) {
  const first = times[0] ?? 0;
  const seconds = ((times.at(-1) ?? 0) - first) / 1000;
  const counts = play(clock, times);
  const off = counts.map((count, i) => {
    const time = (times[i] ?? 0) - first;
    return Math.max(time - (1000 * (count + 1)) / fps, (1000 * count) / fps - time) / periodMs;
  });
  return { rate: (counts.at(-1) ?? 0) / seconds, furthest: Math.max(...off) };
}

const LONG = 1_000_000; // frames: so that what is drawn is how many have been

for (const [name, display] of Object.entries(displays())) {
  for (const fps of [12, 24, 30]) {
    test(`a film of ${fps} frames a second runs at ${fps} on a display of ${name}`, () => {
      const clock = film({ fps, frames: LONG, periodMs: display.periodMs });
      const { rate, furthest } = seen(clock, display, fps);
      near(rate, fps, 0.1 + 1e-9);
      assert.ok(furthest <= 0.6, `a frame was ${furthest} refreshes from its time`);
    });
  }
}

test("a clock that counts refreshes would fail at 75 Hz", () => {
  const display = { times: refreshes(75, 750), periodMs: 1000 / 75 };
  let refresh = -1;
  const hold = Math.max(1, Math.round(75 / 30));
  const counting = { tick: () => Math.floor(++refresh / hold) };
  const { rate, furthest } = seen(counting, display, 30);
  assert.ok(Math.abs(rate - 30) > 5 || furthest > 0.6, `${rate} a second`);
  near(seen(film({ frames: LONG, periodMs: 1000 / 75 }), display, 30).rate, 30, 0.11);
});

test("where frames are whole refreshes each is on for as many, and the loop closes", () => {
  const clock = film({ frames: 3 });
  assert.deepEqual(play(clock, refreshes(60, 8)), [0, 0, 1, 1, 2, 2, 0, 0]);
  const { shown, skipped, missed_frames, missed_refreshes, refreshes: n, draws } = clock.log();
  assert.deepEqual({ shown, skipped, missed_frames, missed_refreshes, n }, { shown: 4, skipped: 0, missed_frames: 0, missed_refreshes: 0, n: 7 });
  assert.deepEqual(draws, [
    [0, 0],
    [1, 33.333],
    [2, 66.667],
    [3, 100],
  ]);
});

test("a display that shows every frame at its time has missed none, at any rate", () => {
  for (const [name, { times, periodMs }] of Object.entries(displays())) {
    if (/measured as|falls/.test(name)) continue;
    const clock = film({ fps: 24, periodMs });
    play(clock, times);
    assert.equal(clock.log().missed_frames, 0, name);
  }
});

test("frames that were never shown, or more than a refresh too late, are missed", () => {
  const skipping = film({ fps: 60, frames: 10 });
  assert.deepEqual(play(skipping, refreshes(60, 8, [3, 4])), [0, 1, 2, 5, 6, 7]);
  const { missed_frames, skipped, shown, missed_refreshes, longest_interval_ms } = skipping.log();
  assert.deepEqual({ missed_frames, skipped, shown, missed_refreshes }, { missed_frames: 2, skipped: 2, shown: 6, missed_refreshes: 2 });
  near(longest_interval_ms, 50, 0.001);

  const late = film({ fps: 12 }); // frame 1 is due at the fifth refresh, and comes at the eighth
  play(late, refreshes(60, 12, [5, 6, 7]));
  assert.deepEqual([late.log().missed_frames, late.log().skipped], [1, 0]);
  const once = film({ fps: 12 });
  play(once, refreshes(60, 12, [5]));
  assert.equal(once.log().missed_frames, 0, "one refresh late is not more than one");

  const faster = film({ fps: 60, frames: 120, periodMs: 1000 / 50 });
  play(faster, refreshes(50, 51));
  assert.equal(faster.log().missed_frames, 10, "a display can't show more frames than it has refreshes");
});

test("a frame that isn't here when its time comes leaves the last one on the screen; what was not seen is missed, and time goes on", () => {
  const clock = film({ fps: 60, frames: 10 });
  // Frames 3 to 5 come when it is the time of the seventh refresh.
  const seen = refreshes(60, 9).map((now, i) => clock.tick(now, (frame) => frame < 3 || i >= 6));
  assert.deepEqual(seen, [0, 1, 2, 2, 2, 2, 6, 7, 8]);
  assert.deepEqual([clock.log().shown, clock.log().skipped, clock.log().missed_frames], [6, 3, 3]);

  const waiting = film({ fps: 60, frames: 10 });
  for (const now of refreshes(60, 6)) waiting.tick(now, (frame) => frame < 3);
  assert.deepEqual([waiting.log().shown, waiting.log().missed_frames], [3, 3], "those that are still waited for are missed already");

  const late = film({ fps: 12, frames: 10 }); // frame 1 is due at the fifth refresh, and comes before the eighth
  const at = refreshes(60, 9).map((now, i) => late.tick(now, (frame) => frame < 1 || i >= 7));
  assert.deepEqual(at, [0, 0, 0, 0, 0, 0, 0, 1, 1]);
  assert.deepEqual([late.log().skipped, late.log().missed_frames], [0, 1]);

  const none = film();
  assert.deepEqual(
    refreshes(60, 3).map((now) => none.tick(now, () => false)),
    [-1, -1, -1],
    "no frame is here yet",
  );
});

test("the position is a function of time: any way to a moment shows the same frame there", () => {
  const random = noise(3);
  for (let i = 0; i < 50; i++) {
    const times = Array.from({ length: 40 }, () => 500 * (random() + 1)).sort((a, b) => a - b);
    const clocks = [film({ frames: LONG }), film({ frames: LONG })] as const;
    const [all, few] = [play(clocks[0], [0, ...times, 1000]), play(clocks[1], [0, 1000])];
    assert.equal(all.at(-1), few.at(-1));
  }
});

test("an error of the measured period does not add up", () => {
  const clock = film({ fps: 60, frames: LONG, periodMs: (1000 / 60) * 1.01 });
  assert.equal(play(clock, refreshes(60, 3001)).at(-1), 3000);
});

test("an animation that doesn't loop stays on its last frame and logs no more", () => {
  const clock = film({ fps: 60, frames: 3, loop: false });
  assert.deepEqual(play(clock, refreshes(60, 6)), [0, 1, 2, 2, 2, 2]);
  assert.deepEqual([clock.log().shown, clock.log().missed_frames], [3, 0]);
});

test("the log is a snapshot, and bounded", () => {
  const clock = film({ fps: 60, frames: 3 });
  play(clock, refreshes(60, 3));
  const log = clock.log();
  play(clock, refreshes(60, 2000));
  assert.equal(log.draws.length, 3);
  assert.ok(clock.log().shown > 1000 && clock.log().draws.length === 600);
});
