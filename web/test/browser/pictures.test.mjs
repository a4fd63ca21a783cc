// How pictures come: in the order in which they are needed, whole, and to the pixel.
import assert from "node:assert/strict";
import { test } from "node:test";
import { material } from "../mock-study.ts";
import { begin, position, visit } from "./visit.mjs";

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

test("frames are stepped through to the pixel", async (t) => {
  const stuff = material();
  const [width, height] = [592, 333];
  // A band wanders, and in it every value changes to every other.
  const value = (frame) => (x, y) => (frame > 0 && Math.floor(x / 60) <= frame ? [(x * 11 + frame * y) % 256, (y * 5 + x) % 256, (x + y * frame) % 256] : [x % 256, (x * 7 + y) % 256, (y * 3) % 256]);
  const frames = [0, 1, 2, 3].map((frame) => rows(width, height, value(frame)));
  const ref = stuff.animation(frames, 4, false);
  const [trial] = stuff.trials;
  stuff.trials.splice(0, stuff.trials.length, { ...trial, kind: "animation", shown: { left: ref, right: ref } });
  const v = await visit(t, { stuff });
  await begin(v, "1");
  const wrong = (frame) =>
    v.page.locator("canvas").first().evaluate((canvas, base64) => {
      const expected = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const copy = new OffscreenCanvas(canvas.width, canvas.height);
      copy.getContext("2d").drawImage(canvas, 0, 0);
      const { data } = copy.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      return expected.filter((value, i) => value !== data[Math.floor(i / 3) * 4 + (i % 3)]).length;
    }, frames[frame].toString("base64"));
  // It does not loop: in the end it stands at its last frame.
  let differing = -1;
  for (let tries = 0; tries < 100 && differing !== 0; tries++) {
    differing = await wrong(3);
    await new Promise((done) => setTimeout(done, 100));
  }
  assert.equal(differing, 0);
  assert.ok((await wrong(2)) > 10_000, "the frame before would be seen");
});

/** RGB rows, by what each pixel is. */
function rows(width, height, pixel) {
  const rgb = Buffer.alloc(width * height * 3);
  for (let y = 0; y < height; y++) for (let x = 0; x < width; x++) rgb.set(pixel(x, y), (y * width + x) * 3);
  return rgb;
}
