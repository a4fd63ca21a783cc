// How pictures come: in the order in which they are needed, whole, and to the pixel.
import assert from "node:assert/strict";
import { test } from "node:test";
import { crc32, deflateSync } from "node:zlib";
import { material } from "../mock-study.ts";
import { sha256 } from "../samples.ts";
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

/** An RGBA PNG, by what each pixel is. */
function rgba(width, height, pixel) {
  const raw = Buffer.alloc((width * 4 + 1) * height);
  for (let y = 0; y < height; y++) for (let x = 0; x < width; x++) raw.set(pixel(x, y), y * (width * 4 + 1) + 1 + 4 * x);
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, 6, 0, 0, 0], 8);
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
    const out = Buffer.alloc(body.length + 8);
    out.writeUInt32BE(data.length, 0);
    body.copy(out, 4);
    out.writeUInt32BE(crc32(body), body.length + 4);
    return out;
  };
  return Buffer.concat([Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]), chunk("IHDR", header), chunk("IDAT", deflateSync(raw)), chunk("IEND", Buffer.alloc(0))]);
}

test("frames are drawn over each other to the pixel, transparent where nothing changed", async (t) => {
  const stuff = material();
  const [width, height] = [592, 333];
  // Every value of each channel, changed in a moving band by every difference.
  const first = (x, y) => [x % 256, (x * 7 + y) % 256, (y * 3) % 256, 255];
  const changed = (k) => (x, y) => (Math.floor(x / 60) === k ? [(x * 11 + k) % 256, (y * 5 + x) % 256, (x + y * k) % 256, 255] : null);
  const layers = [rgba(width, height, first), ...[1, 2, 3].map((k) => rgba(width, height, (x, y) => changed(k)(x, y) ?? [0, 0, 0, 0]))];
  const at = (frame) => (x, y) => [3, 2, 1].filter((k) => k <= frame).map((k) => changed(k)(x, y)).find((p) => p !== null) ?? first(x, y);
  const head = { format: 2, width, height, fps: 4, loop: false, frames: [0, 1, 2, 3], picture_type: "image/png", picture_bytes: layers.map((layer) => layer.length) };
  const data = Buffer.concat([Buffer.from(`${JSON.stringify(head)}\n`), ...layers, Buffer.alloc(7)]);
  const hash = sha256(data);
  stuff.bytes.set(hash, { data, pictures: layers });
  const ref = { sha256: hash, url: `/stimuli/${hash}` };
  const [trial] = stuff.trials;
  stuff.trials.splice(0, stuff.trials.length, { ...trial, kind: "animation", shown: { left: ref, right: ref } });
  const v = await visit(t, { stuff });
  await begin(v, "1");
  // It does not loop: after a second and a half it stands at its last frame.
  const wrong = async (frame) => {
    const expected = Buffer.alloc(width * height * 4);
    for (let y = 0; y < height; y++) for (let x = 0; x < width; x++) expected.set(at(frame)(x, y), 4 * (y * width + x));
    return v.page.locator("canvas").first().evaluate((canvas, base64) => {
      const expected = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const copy = new OffscreenCanvas(canvas.width, canvas.height);
      copy.getContext("2d").drawImage(canvas, 0, 0);
      const { data } = copy.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      return data.filter((value, i) => value !== expected[i]).length;
    }, expected.toString("base64"));
  };
  let differing = -1;
  for (let tries = 0; tries < 100 && differing !== 0; tries++) {
    differing = await wrong(3);
    await new Promise((done) => setTimeout(done, 100));
  }
  assert.equal(differing, 0);
  assert.ok((await wrong(2)) > 10_000, "the frame before would be seen");
});
