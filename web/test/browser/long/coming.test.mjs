// Animations that begin while they come.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Line } from "../../line.ts";
import { startMock } from "../../mock-server.ts";
import { Maker, study } from "../../mock-study.ts";
import { PICTURES } from "../../samples.ts";
import { display } from "../display.mjs";
import { hasFirefox, launchFirefox } from "../firefox.mjs";
import { HURRY } from "../troubles.mjs";
import { begin, bundle, rows, stored, visit } from "../visit.mjs";

const MBIT = 1e6 / 8;
const FPS = 30;
/** Bytes after which the pair has begun at 9 Mbit/s, and is not all here. */
const BEGUN = 2.7e6;

/** A pair as long as the built-in one; frame i of the first film has the code 4i. */
function pair(kind = "two-alternative", roles = ["left", "right"], settings = null) {
  const made = new Maker();
  const shown = Object.fromEntries(roles.map((role, i) => [role, made.greys(i, PICTURES, FPS)]));
  made.trial({ trial: kind, block_index: 0, item_index: 0, kind: "animation", shown, settings });
  return made;
}

/** In the page, before its own scripts: counts the bytes that it has read, notes how many there were when the film began, and each code that the first one shows. */
const WATCH = `
  globalThis.seen = { read: 0, begun: null, codes: [] };
  const read = ReadableStreamDefaultReader.prototype.read;
  ReadableStreamDefaultReader.prototype.read = async function () {
    const got = await read.call(this);
    seen.read += got.value?.length ?? 0;
    return got;
  };
  const draw = CanvasRenderingContext2D.prototype.drawImage;
  CanvasRenderingContext2D.prototype.drawImage = function (...given) {
    draw.apply(this, given);
    if (this.canvas.closest("[data-testid=choice-left]") === null) return;
    seen.begun ??= seen.read;
    seen.codes.push(this.getImageData(0, 0, 1, 1).data[0]);
  };`;

/** A visit over a line of so many bytes a second; `sends` says what is sent of a stimulus from one byte on. */
async function over(t, rate, { stuff = pair(), spoil = "", ranges = true, sends = (data, from) => data.subarray(from) } = {}) {
  const line = new Line(rate);
  t.after(() => line.close());
  const asked = [];
  const served = (stimulus, response) => {
    asked.push(stimulus);
    line.send(sends(stimulus.data, stimulus.from), response);
  };
  const v = await visit(t, { stuff, init: [display, { hz: 60, drop: [] }], spoil: WATCH + spoil, ranges, serve: served });
  const seen = () => v.page.evaluate(() => globalThis.seen);
  /** Resolves when the first film has drawn so many frames. */
  const drawn = (frames) => v.page.waitForFunction((frames) => globalThis.seen.codes.length >= frames, frames, { timeout: 60_000 });
  /** Resolves when it has drawn nothing for half a second, with how many frames it drew before. */
  const stands = async () => {
    for (let before = -1, tries = 0; tries < 60; tries++) {
      const { codes } = await seen();
      if (codes.length === before) return before;
      before = codes.length;
      await v.page.waitForTimeout(500);
    }
    throw new Error("it goes on and on");
  };
  return { ...v, line, asked, seen, drawn, stands };
}

/** Holds what was on the screen to the log: each frame that it says was drawn has its own code. The film goes on a little after the choice. */
function rightFrames({ codes }, { draws }) {
  assert.ok(codes.length >= draws.length && draws.length > 0, `${codes.length} drawn, ${draws.length} logged`);
  assert.deepEqual(
    codes.slice(0, draws.length),
    draws.map(([frame]) => 4 * (frame % PICTURES.length)),
  );
}

for (const [mbits, least, most] of [
  [9, 2.1e6, 2.5e6],
  [1.6, 3.6e6, 4e6],
]) {
  test(`a pair such as the built-in one begins after ${most / 1e6} MB at most on a line of ${mbits} Mbit/s, and misses no frame`, async (t) => {
    const v = await over(t, mbits * MBIT);
    await begin(v, "1");
    await v.drawn(PICTURES.length + 20);
    const { begun } = await v.seen();
    assert.ok(begun >= least && begun <= most, `${begun} bytes`);
    await v.hook("choice-left").click();
    await v.hook("completion-code").waitFor();
    const [row] = rows(v.mock);
    assert.equal(row.missed_frames, 0, JSON.stringify(row.frames.left));
    rightFrames(await v.seen(), row.frames.left);
    assert.equal(v.asked.length, 2, "nothing was asked for twice");
  });
}

test("a line that stalls amid a film: the last frame stays, the answer waits until all is here, and the trial says what it missed", async (t) => {
  const v = await over(t, 9 * MBIT);
  v.line.after(BEGUN, () => (v.line.rate = 0));
  await begin(v, "1");
  const stands = await v.stands();
  assert.ok(stands > 10 && stands < PICTURES.length, `${stands} frames`);
  await v.hook("choice-left").click();
  await v.page.getByText(/The pictures are on their way/).waitFor();
  assert.deepEqual(stored(v.mock), [[]], "nobody knows yet whether these were the right pictures");
  v.line.rate = 9 * MBIT;
  await v.hook("completion-code").waitFor();
  const [row] = rows(v.mock);
  assert.ok(row.missed_frames > 20, `${row.missed_frames} missed`);
  rightFrames(await v.seen(), row.frames.left);
});

test("after a stall a film goes on at its time", async (t) => {
  const v = await over(t, 9 * MBIT);
  v.line.after(BEGUN, () => (v.line.rate = 0));
  await begin(v, "1");
  const stands = await v.stands();
  v.line.rate = 9 * MBIT;
  await v.drawn(stands + 60);
  await v.hook("choice-left").click();
  await v.hook("completion-code").waitFor();
  const [row] = rows(v.mock);
  const { draws, missed_frames, skipped } = row.frames.left;
  for (const [frame, at] of draws) assert.ok(Math.abs(at - (1000 * frame) / FPS) <= 1000 / FPS, `frame ${frame} after ${at} ms`);
  assert.ok(skipped > 20 && missed_frames >= skipped, JSON.stringify([skipped, missed_frames]));
  rightFrames(await v.seen(), row.frames.left);
});

for (const ranges of [true, false]) {
  test(`a request that is given up amid a film is made again ${ranges ? "from where it was" : "from the beginning, where the server can't do otherwise"}, and no wrong frame is shown`, async (t) => {
    const v = await over(t, 9 * MBIT, { spoil: HURRY, ranges });
    v.line.after(BEGUN, () => v.line.hold());
    await begin(v, "1");
    for (let tries = 0; v.asked.length < 4 && tries < 200; tries++) await v.page.waitForTimeout(50);
    await v.drawn(150);
    await v.hook("choice-left").click();
    await v.hook("completion-code").waitFor();
    const [row] = rows(v.mock);
    rightFrames(await v.seen(), row.frames.left);
    assert.ok(v.asked.length >= 4 && v.asked.slice(2).every(({ from }) => (ranges ? from > 500_000 : from === 0)), JSON.stringify(v.asked.map(({ from }) => from)));
    assert.ok(row.missed_frames > 0, "nobody saw what came too late");
  });
}

/** Sends the first film otherwise than the plan says, once: `wrong` makes its bytes. */
function wrongOnce(wrong) {
  let times = 0;
  return (data, from) => (times++ === 0 ? wrong(Buffer.from(data)) : data.subarray(from));
}
const again = /A picture came damaged, so these pictures are here once more/;

test("an answer to pictures whose last byte turns out wrong is not sent: they are shown once more, and answered", async (t) => {
  const v = await over(t, 9 * MBIT, { sends: wrongOnce((data) => data.fill(1, data.length - 1)) });
  v.line.after(BEGUN, () => (v.line.rate = 0));
  await begin(v, "1");
  await v.hook("choice-left").click();
  v.line.rate = 9 * MBIT;
  await v.page.getByText(again).waitFor();
  await v.hook("choice-right").waitFor();
  await v.page.locator(".pair.shown").waitFor();
  assert.deepEqual(stored(v.mock), [[]]);
  assert.equal(v.mock.log.filter(({ method }) => method === "PUT").length, 0);
  await v.hook("choice-right").click();
  await v.hook("completion-code").waitFor();
  assert.deepEqual(stored(v.mock), [[[0, "right"]]]);
  assert.equal(await v.page.locator("#notice").textContent(), "");
});

test("a picture amid a film that can't be decoded ends it without anybody's doing, and it is shown once more", async (t) => {
  const broken = PICTURES.slice(0, 45).reduce((sum, length) => sum + length, 0);
  const v = await over(t, 9 * MBIT, { sends: wrongOnce((data) => data.fill(0, data.indexOf(10) + 1 + broken, data.indexOf(10) + 101 + broken)) });
  await begin(v, "1");
  await v.page.getByText(again).waitFor();
  await v.page.locator(".pair.shown").waitFor();
  await v.page.evaluate(() => (globalThis.seen.codes = []));
  await v.drawn(70);
  await v.hook("choice-left").click();
  await v.hook("completion-code").waitFor();
  const [row] = rows(v.mock);
  assert.equal(row.missed_frames, 0, "what is shown once more is here whole");
});

test("a sequence begins while its films come, and counts on the time before them", async (t) => {
  const durations = { fixation_ms: 2000, first_ms: 2000, mask_ms: 500, second_ms: 2000 };
  const v = await over(t, 4 * MBIT, { stuff: pair("two-interval", ["first", "second"], durations) });
  await v.hook("consent-agree").click();
  await v.hook("start").click();
  await v.page.locator(".intervals").waitFor();
  const { read } = await v.seen();
  // Were they shown at once, it would take 3.3 MB.
  assert.ok(read > 2e6 && read < 2.8e6, `${read} bytes`);
  await v.hook("choice-first").waitFor({ state: "visible" });
  await v.page.waitForTimeout(200);
  await v.page.keyboard.press("1");
  await v.hook("completion-code").waitFor();
  const [row] = rows(v.mock);
  assert.equal(row.missed_frames, 0);
});

test("a film begins while it comes in Firefox too", { skip: !hasFirefox }, async (t) => {
  const line = new Line(9 * MBIT);
  const mock = await startMock({ dist: bundle, stuff: pair(), spoil: WATCH, serve: ({ data, from }, response) => line.send(data.subarray(from), response) });
  const firefox = await launchFirefox();
  t.after(() => Promise.all([firefox.close(), mock.close(), line.close()]));
  await firefox.goto(`${mock.url}/study/${study.id}`);
  await firefox.click("consent-agree");
  await firefox.click("start");
  await firefox.until(() => globalThis.seen.codes.length >= 80);
  const { begun } = await firefox.evaluate(() => globalThis.seen);
  assert.ok(begun >= 2e6 && begun <= 2.6e6, `${begun} bytes`);
  await firefox.click("choice-left");
  await firefox.until(() => document.querySelector('[data-testid="completion-code"]') !== null);
  const [row] = rows(mock);
  rightFrames(await firefox.evaluate(() => globalThis.seen), row.frames.left);
});
