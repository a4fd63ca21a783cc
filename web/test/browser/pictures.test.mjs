// How pictures come: in the order in which they are needed, whole, and to the pixel.
import assert from "node:assert/strict";
import { test } from "node:test";
import { startMock } from "../mock-server.ts";
import { material, study } from "../mock-study.ts";
import { hasFirefox, launchFirefox } from "./firefox.mjs";
import { differing, pixels } from "./pixels.mjs";
import { begin, bundle, position, visit } from "./visit.mjs";

test("pictures are asked for from consent on, those of the first trial first", async (t) => {
  const v = await visit(t);
  const asked = [];
  v.page.on("request", (request) => request.url().includes("/stimuli/") && asked.push(request.url().split("/").pop()));
  assert.deepEqual(asked, [], "nothing is fetched for who has not agreed");
  await v.hook("consent-agree").click();
  await v.hook("start").waitFor();
  const planned = v.mock.stuff.trials.flatMap(({ shown }) => [shown.left.sha256, shown.right.sha256]);
  for (let tries = 0; asked.length < planned.length && tries < 600; tries++) await new Promise((done) => setTimeout(done, 50));
  assert.deepEqual(asked, planned, "all of them, in the plan's order, while the instructions are read");
});

test("a picture that stalls is asked for again, and the study goes on", async (t) => {
  const v = await visit(t);
  await v.page.clock.install();
  let stalled = 0;
  await v.page.route("**/stimuli/**", (route) => (stalled++ === 0 ? undefined : route.continue()));
  await v.hook("consent-agree").click();
  await v.hook("start").waitFor();
  for (let tries = 0; stalled < 1 && tries < 100; tries++) await new Promise((done) => setTimeout(done, 50));
  await v.hook("start").click();
  await v.page.getByText(/are on their way/).waitFor();
  // Ten seconds without a byte, and the wait before the next try.
  await v.page.clock.runFor(12_000);
  await position(v.page, 0);
  assert.ok(stalled >= 11, `the ten pictures, one of them at least twice: ${stalled}`);
});

/** One trial whose animation changes every value to every other in a band that wanders; its frames as RGB rows. It does not loop. */
function wandering() {
  const stuff = material();
  const [width, height] = [592, 333];
  const value = (frame) => (x, y) => (frame > 0 && Math.floor(x / 60) <= frame ? [(x * 11 + frame * y) % 256, (y * 5 + x) % 256, (x + y * frame) % 256] : [x % 256, (x * 7 + y) % 256, (y * 3) % 256]);
  const frames = [0, 1, 2, 3].map((frame) => rows(width, height, value(frame)));
  const ref = stuff.animation(frames, 4, false);
  const [trial] = stuff.trials;
  stuff.trials.splice(0, stuff.trials.length, { ...trial, kind: "animation", shown: { left: ref, right: ref } });
  return { stuff, frames };
}

/** In the page: how many values the first canvas has otherwise than these RGB rows. */
const otherwise = (base64) => {
  const expected = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const canvas = document.querySelector("canvas");
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  return expected.filter((value, i) => value !== data[Math.floor(i / 3) * 4 + (i % 3)]).length;
};

/** Holds the last frame, which stands in the end, to its pixels; `differing` asks the page. */
async function lastFrame(frames, differing) {
  const count = (frame) => differing(frames[frame].toString("base64"));
  let wrong = -1;
  for (let tries = 0; tries < 100 && wrong !== 0; tries++) {
    wrong = await count(3);
    await new Promise((done) => setTimeout(done, 100));
  }
  assert.equal(wrong, 0);
  assert.ok((await count(2)) > 10_000, "the frame before would be seen");
}

test("frames are stepped through to the pixel in Chromium", async (t) => {
  const { stuff, frames } = wandering();
  const v = await visit(t, { stuff });
  await begin(v, "1");
  await lastFrame(frames, (rows) => v.page.evaluate(otherwise, rows));
});

for (const guarded of [false, true]) {
  test(`frames are stepped through to the pixel in Firefox${guarded ? " that guards against fingerprints" : ""}`, { skip: !hasFirefox }, async (t) => {
    const { stuff, frames } = wandering();
    const mock = await startMock({ dist: bundle, stuff });
    // It tells every page that a CSS pixel is two of the display's: only on such a display can a page show pixel for pixel.
    const firefox = await launchFirefox(guarded ? { preferences: { "privacy.resistFingerprinting": true, "layout.css.devPixelsPerPx": "2" }, width: 2560, height: 1600 } : {});
    t.after(() => Promise.all([firefox.close(), mock.close()]));
    await firefox.goto(`${mock.url}/study/${study.id}`);
    await firefox.click("consent-agree");
    await firefox.click("start");
    await firefox.until(() => document.querySelector(".position")?.textContent === "1 of 1");
    // What a page reads back is false there; what is on the screen is not.
    if (guarded) await onScreen(firefox, frames[3]);
    else await lastFrame(frames, (rows) => firefox.evaluate(String(otherwise), rows));
  });
}

/** Holds what Firefox shows to a frame's RGB rows. */
async function onScreen(firefox, frame) {
  const { x, y } = await firefox.evaluate(() => {
    const box = document.querySelector("canvas").getBoundingClientRect();
    return { x: Math.round(box.x * devicePixelRatio), y: Math.round(box.y * devicePixelRatio) };
  });
  let wrong = -1;
  for (let tries = 0; tries < 60 && wrong !== 0; tries++) {
    const screen = pixels(await firefox.screenshot());
    wrong = differing(screen, { width: 592, height: 333, at: (x, y) => [...frame.subarray((y * 592 + x) * 3, (y * 592 + x) * 3 + 3)] }, x, y);
    await new Promise((done) => setTimeout(done, 100));
  }
  assert.equal(wrong, 0);
}

/** RGB rows, by what each pixel is. */
function rows(width, height, pixel) {
  const rgb = Buffer.alloc(width * height * 3);
  for (let y = 0; y < height; y++) for (let x = 0; x < width; x++) rgb.set(pixel(x, y), (y * width + x) * 3);
  return rgb;
}
