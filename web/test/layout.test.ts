import assert from "node:assert/strict";
import { test } from "node:test";
import { fitOne, fitPair, inkOn, srgbCode } from "../participant/layout.ts";

const fit = (roomWidth: number, roomHeight: number, devicePixelRatio = 1) =>
  fitPair({ width: 592, height: 333, roomWidth, roomHeight, devicePixelRatio });

test("two pictures of the study's size fit a 1280-pixel window side by side at native pixels", () => {
  assert.deepEqual(fit(1280 - 28, 600), { arrangement: "side", scale: 1, width: 592, height: 333, gap: 30 });
});

test("on a dense display a picture's pixels are the display's pixels", () => {
  const layout = fit(1252, 600, 2);
  assert.equal(layout.scale, 1);
  assert.equal(layout.width, 296);
});

test("a phone stacks them, as large as fits, in whole device pixels", () => {
  const layout = fit(362, 700);
  assert.equal(layout.arrangement, "stack");
  assert.equal(layout.width, 362);
  assert.equal(layout.scale, 362 / 592);
});

test("nothing is ever enlarged, and nothing reaches beyond its room", () => {
  for (const dpr of [1, 1.25, 1.5, 2, 2.625, 3]) {
    for (let w = 292; w < 2600; w += 37) {
      for (const h of [180, 333, 700, 1300]) {
        const { scale, width, height, gap, arrangement } = fit(w, h, dpr);
        const total = arrangement === "side" ? [2 * width + gap, height] : [width, 2 * height + gap];
        const text = `${w}×${h} at ${dpr}: ${JSON.stringify({ scale, width, height, gap, arrangement })}`;
        assert.ok(scale <= 1, text);
        assert.ok((total[0] ?? 0) <= w + 1e-6, `too wide: ${text}`);
        assert.ok((total[1] ?? 0) <= h + 1e-6, `too high: ${text}`);
        assert.ok(gap >= 0.05 * width, `gap: ${text}`);
        assert.ok(Math.abs(width * dpr - Math.round(width * dpr)) < 1e-6, `not whole pixels: ${text}`);
      }
    }
  }
});

test("room that is one pixel short is noticed", () => {
  assert.equal(fit(2 * 592 + 30, 333).scale, 1);
  assert.ok(fit(2 * 592 + 29, 333).scale < 1);
  assert.ok(fit(2 * 592 + 30, 332).scale < 1);
});

test("one picture has the room of two", () => {
  const one = (roomWidth: number, roomHeight: number, devicePixelRatio = 1) => fitOne({ width: 592, height: 333, roomWidth, roomHeight, devicePixelRatio });
  assert.deepEqual(one(1252, 600), { scale: 1, width: 592, height: 333 });
  assert.deepEqual(one(1252, 600, 2), { scale: 1, width: 296, height: 166.5 });
  assert.deepEqual(one(362, 700), { scale: 362 / 592, width: 362, height: 204 });
  assert.equal(one(592, 333).scale, 1);
  assert.ok(one(591, 333).scale < 1);
  assert.ok(one(592, 332).scale < 1);
});

test("the grey is the study's linear luminance, encoded by sRGB", () => {
  // IEC 61966-2-1: 0.2 encodes to 0.48453, which is code 123.55.
  assert.deepEqual([0, 0.002, 0.2, 0.5, 1].map(srgbCode), [0, 7, 124, 188, 255]);
  assert.notEqual(srgbCode(0.2), Math.round(0.2 * 255), "linear codes would be darker");
});

test("ink reads on every grey", () => {
  assert.deepEqual([0, 0.1, 0.2, 0.5, 1].map(inkOn), ["white", "white", "black", "black", "black"]);
});
