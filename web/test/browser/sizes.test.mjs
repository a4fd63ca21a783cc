// A study in several sizes: each display gets the largest that fits it, pixel for pixel.
import assert from "node:assert/strict";
import { test } from "node:test";
import { inTwoSizes, twoSizes } from "../mock-study.ts";
import { sizes } from "./chromium.mjs";
import { begin, position, rows, visit } from "./visit.mjs";

/** What the pair is made of and where it stands, in device pixels. */
const seen = (page) =>
  page.evaluate(() => {
    const dpr = devicePixelRatio;
    return [...document.querySelectorAll(".picture > *")].map((picture) => {
      const { left, top, width, height } = picture.getBoundingClientRect();
      return {
        pixels: [picture.naturalWidth ?? picture.width, picture.naturalHeight ?? picture.height],
        device: [width * dpr, height * dpr],
        place: [left * dpr, top * dpr],
        css: width,
        rendering: getComputedStyle(picture).imageRendering,
        within: left >= 0 && left + width <= innerWidth,
      };
    });
  });

const near = (found, right, text, within = 0.02) => {
  for (const [i, x] of found.entries()) assert.ok(Math.abs(x - right[i]) < within, `${text}: ${found} for ${right}`);
};

const displays = [
  ["a phone upright", sizes.phone, "native", { pixels: [1008, 567], times: 1, arrangement: "stack", css: 336 }],
  ["a phone turned", { ...sizes.phone, viewport: { width: 844, height: 390 } }, "native", { pixels: [1008, 567], times: 1, arrangement: "side", css: 336 }],
  ["a phone 360 CSS pixels wide, its browser's bars taken off", { ...sizes.phone, viewport: { width: 360, height: 620 } }, "native", { pixels: [1008, 567], times: 1, arrangement: "stack", css: 336 }],
  ["1280 × 800", sizes.desktop, "integer", { pixels: [592, 333], times: 1, arrangement: "side", css: 592 }],
  ["4K at two", { viewport: { width: 1920, height: 1080 }, deviceScaleFactor: 2 }, "integer", { pixels: [1008, 567], times: 1, arrangement: "side", css: 504 }],
  ["5K at one", { viewport: { width: 5120, height: 2880 } }, "integer", { pixels: [1008, 567], times: 2, arrangement: "side", css: 2016 }],
];

for (const [name, options, fit, right] of displays) {
  test(`${name}: whole pixels of the largest size that fits, still or moving, and the answer says so`, async (t) => {
    const v = await visit(t, { stuff: inTwoSizes(), shownAs: twoSizes(fit), options });
    await begin(v, "2");
    for (const trial of [0, 1]) {
      await position(v.page, trial, "2");
      const pair = await seen(v.page);
      assert.equal(pair.length, 2);
      for (const picture of pair) {
        assert.deepEqual(picture.pixels, right.pixels, name);
        near(
          picture.device,
          right.pixels.map((side) => side * right.times),
          name,
        );
        // A browser lays out in 64ths of a CSS pixel, of which a third is none, and paints at the whole pixel that is nearest.
        near(picture.place, picture.place.map(Math.round), `${name}: begins at a whole pixel`, (options.deviceScaleFactor ?? 1) / 64 + 0.001);
        near([picture.css], [right.css], name);
        assert.equal(picture.rendering, right.times > 1 ? "pixelated" : "auto");
        assert.ok(picture.within, `${name}: ${JSON.stringify(picture)}`);
      }
      await v.hook("choice-left").click();
    }
    await v.hook("completion-code").waitFor();
    for (const row of rows(v.mock)) {
      assert.deepEqual([row.stimulus_size, row.scale, row.arrangement], [right.pixels, right.times, right.arrangement]);
      near([row.css_width_px], [right.css], name);
    }
  });
}

test("what is fetched from consent on is the size that is shown, and nothing of the other", async (t) => {
  const v = await visit(t, { stuff: inTwoSizes(), shownAs: twoSizes("native"), options: sizes.phone });
  const asked = [];
  v.page.on("request", (request) => request.url().includes("/stimuli/") && asked.push(request.url().split("/").pop()));
  await begin(v, "2");
  const large = v.mock.stuff.trials.flatMap(({ larger }) => Object.values(larger[0].shown).map(({ sha256 }) => sha256));
  for (let tries = 0; asked.length < large.length && tries < 600; tries++) await new Promise((done) => setTimeout(done, 50));
  assert.deepEqual(new Set(asked), new Set(large));
});

test("a window that changes before a trial gets the size for it; one that changes during it keeps its pictures", async (t) => {
  const v = await visit(t, { stuff: inTwoSizes(), shownAs: twoSizes("native"), options: { viewport: { width: 2600, height: 1200 } } });
  await v.hook("consent-agree").click();
  await v.hook("start").waitFor();
  await v.page.setViewportSize({ width: 1280, height: 800 });
  await v.hook("start").click();
  await position(v.page, 0, "2");
  assert.deepEqual((await seen(v.page))[0].pixels, [592, 333], "the window of before consent had room for the larger");
  await v.page.setViewportSize({ width: 2600, height: 1200 });
  assert.deepEqual((await seen(v.page))[0].pixels, [592, 333], "new pictures would be others");
  await v.hook("choice-left").click();
  await position(v.page, 1, "2");
  assert.deepEqual((await seen(v.page))[0].pixels, [1008, 567]);
  await v.page.setViewportSize({ width: 800, height: 700 });
  await v.page.waitForFunction(() => document.querySelector(".picture > *").getBoundingClientRect().width < 800);
  assert.deepEqual((await seen(v.page))[0].pixels, [1008, 567], "scaled down where it must");
  await v.hook("choice-left").click();
  await v.hook("completion-code").waitFor();
  const [first, second] = rows(v.mock);
  assert.deepEqual(
    [first.stimulus_size, second.stimulus_size],
    [
      [592, 333],
      [1008, 567],
    ],
  );
  assert.ok(second.scale < 1 && second.geometry_changed === 1);
});
