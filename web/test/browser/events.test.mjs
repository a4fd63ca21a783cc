// What happens to the page while a trial is taken, and how the stimuli stood.
import assert from "node:assert/strict";
import { test } from "node:test";
import { begin, painted, position, rows, visit } from "./visit.mjs";

const of = (row, ...kinds) => (row.events ?? []).filter(({ event }) => kinds.includes(event));

test("losing the focus without being hidden, going out of view and coming back are logged with their times", async (t) => {
  const v = await visit(t);
  await begin(v);
  const tell = (script) => v.page.evaluate(script);
  const hide = (hidden) =>
    v.page.evaluate((hidden) => {
      Object.defineProperty(document, "hidden", { configurable: true, get: () => hidden });
      document.dispatchEvent(new Event("visibilitychange"));
    }, hidden);
  await tell(() => void dispatchEvent(new Event("blur")));
  await tell(() => void dispatchEvent(new Event("focus")));
  await hide(true);
  await hide(false);
  await v.page.keyboard.press("ArrowLeft");
  await position(v.page, 1);
  await v.page.keyboard.press("ArrowRight");
  await position(v.page, 2);
  const [first, second] = rows(v.mock);
  const told = of(first, "blur", "focus", "hidden", "visible");
  assert.deepEqual(
    told.map(({ event }) => event),
    ["blur", "focus", "hidden", "visible"],
  );
  for (const [i, { time_ms }] of told.entries()) assert.ok(time_ms > 0 && time_ms < first.rt && time_ms >= (told[i - 1]?.time_ms ?? 0), JSON.stringify(told));
  assert.deepEqual(of(second, "blur", "focus", "hidden", "visible"), [], "each is told once");
});

test("a window that changes is logged with how the stimuli stood from then on, and the answer with how they stood at onset", async (t) => {
  const v = await visit(t);
  await begin(v);
  await v.page.setViewportSize({ width: 390, height: 844 });
  await v.page.waitForFunction(() => document.querySelector(".pair.stack") !== null);
  await v.page.waitForTimeout(150);
  await v.page.setViewportSize({ width: 500, height: 844 });
  await v.page.waitForFunction(() => document.querySelector('[data-testid="choice-left"]').getBoundingClientRect().width > 400);
  await painted(v.page);
  const { width } = await v.hook("choice-left").boundingBox();
  await v.page.keyboard.press("ArrowDown");
  await position(v.page, 1);
  await v.page.keyboard.press("ArrowDown");
  await position(v.page, 2);
  const [first, second] = rows(v.mock);
  assert.deepEqual([first.choice, second.choice], ["right", "right"]);
  assert.equal(first.geometry_changed, 1);
  assert.deepEqual(first.at_onset, { scale: 1, css_width_px: 592, arrangement: "side", device_pixel_ratio: 1, viewport: [1280, 800] });
  assert.deepEqual([first.arrangement, first.viewport, first.css_width_px], ["stack", [500, 844], width]);
  const resizes = of(first, "resize");
  assert.deepEqual(
    resizes.map(({ viewport, arrangement, css_width_px }) => [viewport, arrangement, css_width_px]),
    [
      [[390, 844], "stack", 370],
      [[500, 844], "stack", width],
    ],
  );
  assert.deepEqual([second.geometry_changed, second.at_onset, of(second, "resize")], [0, undefined, []]);
});

test("a pinch is logged as what it does to the picture's size", async (t) => {
  const v = await visit(t, { options: { viewport: { width: 390, height: 844 }, deviceScaleFactor: 3, hasTouch: true, isMobile: true } });
  await begin(v);
  const cdp = await v.context.newCDPSession(v.page);
  await cdp.send("Emulation.setPageScaleFactor", { pageScaleFactor: 2 });
  await v.page.waitForFunction(() => visualViewport.scale === 2);
  await v.page.keyboard.press("ArrowUp");
  await position(v.page, 1);
  const [row] = rows(v.mock);
  assert.deepEqual([row.at_onset.scale, row.scale, of(row, "resize").at(-1)?.scale], [1, 2, 2]);
});

test("full screen and the way a display is held are logged", async (t) => {
  const v = await visit(t, { options: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true } });
  await begin(v);
  // What can be asked changes before its event comes: each step waits for the event, which the page's own log has heard before this list.
  await v.page.evaluate(() => {
    globalThis.heard = [];
    for (const [target, event] of [
      [screen.orientation, "change"],
      [document, "fullscreenchange"],
    ])
      target.addEventListener(event, () => globalThis.heard.push(event));
  });
  const heard = (count) => v.page.waitForFunction((count) => globalThis.heard.length === count, count);
  const cdp = await v.context.newCDPSession(v.page);
  await cdp.send("Emulation.setDeviceMetricsOverride", { width: 844, height: 390, deviceScaleFactor: 1, mobile: true, screenOrientation: { type: "landscapePrimary", angle: 90 } });
  await v.page.waitForFunction(() => innerWidth === 844);
  await heard(1);
  await v.page.evaluate(() => document.documentElement.requestFullscreen());
  await heard(2);
  await v.page.evaluate(() => document.exitFullscreen());
  await heard(3);
  await painted(v.page);
  await v.page.keyboard.press("ArrowLeft");
  await position(v.page, 1);
  const [row] = rows(v.mock);
  assert.deepEqual(
    of(row, "orientation").map(({ orientation }) => orientation),
    ["landscape-primary"],
  );
  assert.deepEqual(
    of(row, "fullscreen_enter", "fullscreen_exit").map(({ event }) => event),
    ["fullscreen_enter", "fullscreen_exit"],
  );
  assert.equal(row.geometry_changed, 1);
});

test("the log is bounded, and says how much more there was", async (t) => {
  const v = await visit(t);
  await begin(v);
  await v.page.evaluate(() => {
    for (let i = 0; i < 150; i++) document.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", code: "ArrowLeft" }));
    for (let i = 0; i < 150; i++) dispatchEvent(new Event("blur"));
  });
  await v.page.keyboard.press("ArrowLeft");
  await position(v.page, 1);
  const [row] = rows(v.mock);
  assert.deepEqual([of(row, "ignored").length, row.events.length, row.events_dropped], [100, 200, 100]);
});

test("nothing is kept of anybody before the first trial", async (t) => {
  const v = await visit(t);
  await v.hook("consent-agree").waitFor();
  await v.page.evaluate(() => void dispatchEvent(new Event("blur")));
  await begin(v);
  await v.page.keyboard.press("ArrowLeft");
  await position(v.page, 1);
  assert.equal(rows(v.mock)[0].events, undefined);
});
