import assert from "node:assert/strict";
import { test } from "node:test";
import { fitOne, fitPair, inkOn, type Layout, type Offered, srgbCode } from "../participant/layout.ts";

const one: Offered = { sizes: [[592, 333]], fit: "native" };
const two = (fit: Offered["fit"]): Offered => ({
  sizes: [
    [592, 333],
    [1008, 567],
  ],
  fit,
});
const fit = (roomWidth: number, roomHeight: number, devicePixelRatio = 1, offered = one) => fitPair(offered, { roomWidth, roomHeight, devicePixelRatio });

test("two pictures of the study's size fit a 1280-pixel window side by side at native pixels", () => {
  assert.deepEqual(fit(1280 - 28, 600), { arrangement: "side", pixels: [592, 333], scale: 1, width: 592, height: 333, gap: 30 });
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
  const alone = (roomWidth: number, roomHeight: number, devicePixelRatio = 1, offered = one) => fitOne(offered, { roomWidth, roomHeight, devicePixelRatio });
  const pixels = [592, 333];
  assert.deepEqual(alone(1252, 600), { pixels, scale: 1, width: 592, height: 333 });
  assert.deepEqual(alone(1252, 600, 2), { pixels, scale: 1, width: 296, height: 166.5 });
  assert.deepEqual(alone(362, 700), { pixels, scale: 362 / 592, width: 362, height: 204 });
  assert.equal(alone(592, 333).scale, 1);
  assert.ok(alone(591, 333).scale < 1);
  assert.ok(alone(592, 332).scale < 1);
  // Where a pair has room for the smaller size alone, one picture has it for the larger.
  assert.deepEqual(alone(1900, 900, 1, two("integer")), { pixels: [1008, 567], scale: 1, width: 1008, height: 567 });
  assert.deepEqual(alone(1007, 900, 1, two("native")).pixels, pixels);
});

// Rooms are windows without 10 CSS pixels on either side and without question and position; right values by hand.
const displays: Array<[string, Offered["fit"], [number, number, number], Omit<Layout, "gap" | "height">]> = [
  // 370 × 3 = 1110 device pixels; two of 567 and a gap of 84 are 1218 of 1962.
  ["a phone upright at three device pixels", "native", [370, 654, 3], { arrangement: "stack", pixels: [1008, 567], scale: 1, width: 336 }],
  // 2 × 1008 + 84 = 2100 of 2472.
  ["the same phone turned", "native", [824, 280, 3], { arrangement: "side", pixels: [1008, 567], scale: 1, width: 336 }],
  // 340 × 3 = 1020 of 1080; 1218 of 1260.
  ["a phone 360 CSS pixels wide", "integer", [340, 420, 3], { arrangement: "stack", pixels: [1008, 567], scale: 1, width: 336 }],
  // 392 × 2.625 = 1029 of 1080; 2 × 567 + 73.5 = 1208 of 1260.
  ["one of as many device pixels, 412 CSS pixels wide", "integer", [392, 480, 2.625], { arrangement: "stack", pixels: [1008, 567], scale: 1, width: 384 }],
  // 300 × 3 = 900: the larger has no room; 592 / 3.
  ["a narrower phone", "integer", [300, 500, 3], { arrangement: "stack", pixels: [592, 333], scale: 1, width: 592 / 3 }],
  ["the same, filled", "fill", [300, 500, 3], { arrangement: "stack", pixels: [1008, 567], scale: 900 / 1008, width: 300 }],
  ["1280 × 720", "integer", [1260, 540, 1], { arrangement: "side", pixels: [592, 333], scale: 1, width: 592 }],
  // Stacked the larger would take 2 × 567 + 51 = 1185 of 900; the smaller is as large side by side.
  ["1920 × 1080", "integer", [1900, 900, 1], { arrangement: "side", pixels: [592, 333], scale: 1, width: 592 }],
  // 2 × 1008 + 51 = 2067 of 2540; the smaller, twice enlarged, would be 1184 wide, and is not what was drawn for it.
  ["2560 × 1440", "integer", [2540, 1260, 1], { arrangement: "side", pixels: [1008, 567], scale: 1, width: 1008 }],
  ["4K at two device pixels", "integer", [1900, 900, 2], { arrangement: "side", pixels: [1008, 567], scale: 1, width: 504 }],
  // 1725 × 1.1 = 1897 whole device pixels; a gap of 31.
  ["1920 × 1080 at 110%", "integer", [1725, 800, 1.1], { arrangement: "side", pixels: [592, 333], scale: 1, width: 592 / 1.1 }],
  // 4 × 1008 + 101 = 4133 of 5100.
  ["5K, whole multiples", "integer", [5100, 2700, 1], { arrangement: "side", pixels: [1008, 567], scale: 2, width: 2016 }],
  ["5K, never enlarged", "native", [5100, 2700, 1], { arrangement: "side", pixels: [1008, 567], scale: 1, width: 1008 }],
  // 2 × 2487 + 125 = 5099 of 5100.
  ["5K, filled", "fill", [5100, 2700, 1], { arrangement: "side", pixels: [1008, 567], scale: 2487 / 1008, width: 2487 }],
  // No size has room: 2 × 171 + 28 = 370.
  ["a small window", "integer", [370, 150, 1], { arrangement: "side", pixels: [592, 333], scale: 171 / 592, width: 171 }],
];
for (const [name, rule, [roomWidth, roomHeight, devicePixelRatio], right] of displays) {
  test(`the size on ${name} is the one worked out by hand`, () => {
    const { gap: _, height, ...found } = fit(roomWidth, roomHeight, devicePixelRatio, two(rule));
    assert.deepEqual(found, right);
    assert.equal(Math.round(height * devicePixelRatio), Math.round((right.pixels[1] * right.width * devicePixelRatio) / right.pixels[0]));
  });
}

test("whatever the room, all that is shown is whole device pixels and within it; native and multiples keep each pixel whole", () => {
  for (const rule of ["native", "integer", "fill"] as const) {
    for (const dpr of [1, 1.1, 1.25, 2, 2.625, 3]) {
      for (let w = 200; w < 2600; w += 97) {
        for (const h of [180, 333, 700, 1300]) {
          const { pixels, scale, width, height, gap, arrangement } = fit(w, h, dpr, two(rule));
          const text = `${rule} ${w}×${h} at ${dpr}: ${JSON.stringify({ pixels, scale, width, height, gap, arrangement })}`;
          const total = arrangement === "side" ? [2 * width + gap, height] : [width, 2 * height + gap];
          assert.ok((total[0] ?? 0) <= w + 1e-6 && (total[1] ?? 0) <= h + 1e-6, text);
          for (const side of [width, height]) assert.ok(Math.abs(side * dpr - Math.round(side * dpr)) < 1e-6, text);
          if (rule !== "fill" && scale >= 1) assert.ok(Number.isInteger(scale) && (rule === "integer" || scale === 1), text);
          if (rule !== "fill" && scale < 1) assert.deepEqual(pixels, [592, 333], text);
        }
      }
    }
  }
});

test("the grey is the study's linear luminance, encoded by sRGB", () => {
  // IEC 61966-2-1: 0.2 encodes to 0.48453, which is code 123.55.
  assert.deepEqual([0, 0.002, 0.2, 0.5, 1].map(srgbCode), [0, 7, 124, 188, 255]);
  assert.notEqual(srgbCode(0.2), Math.round(0.2 * 255), "linear codes would be darker");
});

test("ink reads on every grey", () => {
  assert.deepEqual([0, 0.1, 0.2, 0.5, 1].map(inkOn), ["white", "white", "black", "black", "black"]);
});
