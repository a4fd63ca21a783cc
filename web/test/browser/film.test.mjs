// Films in Chromium, on displays of several refresh rates: the page's frames come at exact times, whenever the machine gets to them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { intervals, material } from "../mock-study.ts";
import { display } from "./display.mjs";
import { begin, rows, visit } from "./visit.mjs";

/** Takes the animated trial of a study whose film has `fps`, and gives its row. */
async function film(t, { hz, fps, drop = [], seconds = 2 }) {
  const stuff = material({ frames: 12, fps });
  stuff.trials = stuff.trials.slice(4).map((trial) => ({ ...trial, trial_index: 0 }));
  const v = await visit(t, { stuff, init: [display, { hz, drop }] });
  await begin(v, "1");
  await v.page.waitForFunction((draws) => globalThis.drawn >= draws, 2 * fps * seconds, { timeout: 60_000 });
  await v.page.keyboard.press("ArrowLeft");
  await v.hook("completion-code").waitFor();
  const [row] = rows(v.mock);
  return { row, log: row.frames.left };
}

for (const hz of [60, 75, 120, 144]) {
  test(`a film of 30 frames a second runs at 30 on a display of ${hz} Hz`, async (t) => {
    const { row, log } = await film(t, { hz, fps: 30 });
    const period = 1000 / hz;
    assert.ok(Math.abs(log.refresh_hz - hz) < 0.01 && Math.abs(row.refresh_hz - hz) < 0.01, `${log.refresh_hz} Hz`);
    for (const [frame, at] of log.draws) assert.ok(Math.abs(at - (1000 * frame) / 30) <= period / 2 + 0.01, `frame ${frame} after ${at} ms`);
    assert.deepEqual(
      log.draws.map(([frame]) => frame),
      log.draws.map((_, i) => i),
      "each frame, in order, through the loops",
    );
    assert.ok(log.draws.length >= 60, `${log.draws.length} frames`);
    assert.deepEqual([row.missed_frames, log.missed_frames, log.skipped, log.shown], [0, 0, 0, log.draws.length]);
  });
}

test("a film on a display that leaves out frames stays at its time, and the trial says how many it missed", async (t) => {
  // Three times six frames of the display in a row.
  const drop = Array.from({ length: 60 }, (_, i) => 20 + i).filter((i) => i % 20 < 6);
  const { row, log } = await film(t, { hz: 60, fps: 30, drop, seconds: 3 });
  assert.ok(row.missed_frames >= 4 && row.missed_frames === row.frames.left.missed_frames + row.frames.right.missed_frames, JSON.stringify([row.missed_frames, log.missed_frames]));
  assert.ok(log.skipped > 0 && log.missed_refreshes >= 10);
  for (const [frame, at] of log.draws) assert.ok(at - (1000 * frame) / 30 <= 1000 / 30 && at - (1000 * frame) / 30 >= -1000 / 120 - 0.01, `frame ${frame} after ${at} ms`);
});

test("steps of a sequence stay whole frames of the measured refresh, at 75 Hz too", async (t) => {
  // No duration lies halfway between two frames: which of them is nearer would be the last bit of the measured period.
  const settings = { fixation_ms: 200, first_ms: 310, mask_ms: 110, second_ms: 250 };
  const v = await visit(t, { stuff: intervals({ stills: 1, settings }), init: [display, { hz: 75, drop: [] }] });
  await begin(v, "1");
  await v.hook("choice-first").waitFor({ state: "visible" });
  await v.page.waitForTimeout(200);
  await v.page.keyboard.press("1");
  await v.hook("completion-code").waitFor();
  const [row] = rows(v.mock);
  assert.deepEqual(row.shown_frames, { fixation: 15, first: 23, mask: 8, second: 19 });
  for (const [step, frames] of Object.entries(row.shown_frames)) assert.ok(Math.abs(row.shown_ms[step] - (frames * 1000) / 75) < 0.01, `${step}: ${row.shown_ms[step]} ms`);
});
