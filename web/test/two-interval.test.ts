import assert from "node:assert/strict";
import { test } from "node:test";
import { srgbCode } from "../participant/layout.ts";
import { mask, seedOf } from "../participant/trials/two-interval/mask.ts";
import { inFrames, missed, refusal, requested, SequenceClock, type Step } from "../participant/trials/two-interval/sequence.ts";

const ms = (fixation: number, first: number, mask: number, second: number) => ({ fixation, first, mask, second });
const hz = (n: number) => 1000 / n;

test("durations are whole frames, at least one where something is asked for", () => {
  assert.deepEqual(inFrames(ms(500, 250, 100, 250), hz(60)), ms(30, 15, 6, 15));
  assert.deepEqual(inFrames(ms(500, 250, 100, 250), hz(144)), ms(72, 36, 14, 36));
  assert.deepEqual(inFrames(ms(0, 1, 0, 1000 / 60), hz(60)), ms(0, 1, 0, 1));
});

test("a display that misses a duration by more than half a frame is refused, and only then", () => {
  assert.equal(missed(ms(500, 250, 0, 250), hz(60)), null);
  assert.equal(missed(ms(0, 8.4, 0, 250), hz(60)), null, "one frame of 16.67 ms is 8.27 ms too long: less than half of one");
  assert.equal(missed(ms(0, 8.3, 0, 250), hz(60)), "first");
  assert.equal(missed(ms(0, 250, 5, 250), hz(60)), "mask");
  assert.equal(missed(ms(0, 250, 5, 250), hz(120)), null, "the same request on a faster display");
  assert.equal(missed(ms(0, 250, 0, 250), hz(60)), null, "what is left out can't be missed");
  for (let period = 4; period < 40; period += 0.37) for (let asked = 20; asked < 400; asked += 7) assert.equal(missed(ms(0, asked, 0, asked), period), null);
});

test("the participant is told why, and not about what works", () => {
  const settings = (first_ms: number) => ({ fixation_ms: 0, first_ms, mask_ms: 0, second_ms: 250 });
  assert.equal(refusal(settings(5), hz(60)), "This study shows something for 5 ms, and this display redraws only every 16.7 ms.");
  assert.equal(refusal(settings(50), hz(60)), null);
  assert.match(refusal(settings(50), null) ?? "", /does not tell/);
});

test("settings that are no durations are an error with its field", () => {
  assert.deepEqual(requested({ fixation_ms: 0, first_ms: 1, mask_ms: 0, second_ms: 2 }), ms(0, 1, 0, 2));
  for (const [settings, field] of [
    [null, /fixation_ms/],
    [{ fixation_ms: 0, first_ms: 0, mask_ms: 0, second_ms: 1 }, /first_ms = 0/],
    [{ fixation_ms: -1 }, /fixation_ms = -1/],
    [{ fixation_ms: "9" }, /fixation_ms/],
  ] as const) {
    assert.throws(() => requested(settings), field);
  }
});

/** The step at each of the times. */
const play = (clock: SequenceClock, times: number[]) => times.map((t) => clock.tick(t));
const refreshes = (n: number, dropped: number[] = [], period = hz(60)) => Array.from({ length: n }, (_, i) => 100 + period * i).filter((_, i) => !dropped.includes(i));
function counted(steps: Array<Step | null>): Record<string, number> {
  const sums: Record<string, number> = {};
  for (const step of steps) sums[step ?? "over"] = (sums[step ?? "over"] ?? 0) + 1;
  return sums;
}

test("each step is on for its frames, in order, and then all is over", () => {
  const clock = new SequenceClock(ms(2, 3, 1, 2), hz(60));
  assert.deepEqual(play(clock, refreshes(10)), ["fixation", "fixation", "first", "first", "first", "mask", "second", "second", null, null]);
  assert.deepEqual(clock.shown(), { frames: ms(2, 3, 1, 2), ms: ms(33.333, 50, 16.667, 33.333) });
});

test("what is left out is never on", () => {
  const clock = new SequenceClock(ms(0, 1, 0, 1), hz(60));
  assert.deepEqual(play(clock, refreshes(3)), ["first", "second", null]);
  assert.deepEqual(clock.shown().frames, ms(0, 1, 0, 1));
});

test("a frame that is dropped within a step is made up for; one at its end is seen, and shortens no other step", () => {
  const within = new SequenceClock(ms(0, 6, 0, 6), hz(60));
  assert.deepEqual(counted(play(within, refreshes(13, [2, 3]))), { first: 4, second: 6, over: 1 });
  assert.deepEqual(within.shown(), { frames: ms(0, 6, 0, 6), ms: ms(0, 100, 0, 100) });

  const atEnd = new SequenceClock(ms(0, 6, 0, 6), hz(60));
  assert.deepEqual(counted(play(atEnd, refreshes(15, [6, 7]))), { first: 6, second: 6, over: 1 });
  assert.deepEqual(atEnd.shown(), { frames: ms(0, 8, 0, 6), ms: ms(0, 133.333, 0, 100) });
});

test("an error of the measured period does not add up", () => {
  const clock = new SequenceClock(ms(0, 600, 0, 1), hz(60) * 1.01);
  assert.equal(counted(play(clock, refreshes(700))).first, 600);
  // A clock that divides the elapsed time by the period would be six frames off.
  assert.equal(Math.ceil(600 * 1.01), 606);
});

test("the mask is the same for the same trial, another for another", () => {
  const draw = (seed: number) => Buffer.from(mask({ width: 592, height: 333, surround: 0.2, seed })).toString("base64");
  const seed = seedOf(["aa11bb22", "0123abcd"], 4);
  assert.equal(draw(seed), draw(seed));
  for (const other of [seedOf(["aa11bb22", "0123abcd"], 5), seedOf(["0123abcd", "aa11bb22"], 4), seedOf(["aa11bb23", "0123abcd"], 4)]) assert.notEqual(draw(other), draw(seed));
});

test("its greys lie about the surround's luminance, in blocks", () => {
  const linear = (code: number) => (code / 255 <= 0.04045 ? code / 255 / 12.92 : ((code / 255 + 0.055) / 1.055) ** 2.4);
  for (const surround of [0, 0.2, 0.5, 0.8, 1]) {
    const rgba = mask({ width: 592, height: 333, surround, seed: 7 });
    const [low, high] = [surround - Math.min(surround, 1 - surround), surround + Math.min(surround, 1 - surround)].map(srgbCode) as [number, number];
    let sum = 0;
    let same = 0;
    for (let i = 0; i < rgba.length; i += 4) {
      const [r, g, b, a] = rgba.subarray(i, i + 4);
      assert.ok(r === g && g === b && a === 255 && (r ?? -1) >= low && (r ?? 256) <= high);
      sum += linear(r ?? 0);
      if (rgba[i + 4] === r) same += 1;
    }
    const [pixels, reach] = [592 * 333, Math.min(surround, 1 - surround)];
    // The mean of some 1,900 uniform blocks: three standard errors, and sRGB's rounding.
    assert.ok(Math.abs(sum / pixels - surround) < (3 * reach) / Math.sqrt(3 * 1900) + 0.002, `${surround}: ${sum / pixels}`);
    assert.ok(same > 0.85 * pixels, "neighbours are alike: blocks, not noise");
  }
});
