// Inputs that belong to what was on the screen before, in Chromium and in Firefox.
import assert from "node:assert/strict";
import { test } from "node:test";
import { startMock } from "../mock-server.ts";
import { material, study } from "../mock-study.ts";
import { hasFirefox, launchFirefox } from "./firefox.mjs";
import { begin, bundle, position, rows, stored, visit } from "./visit.mjs";

const EDITION_2 = { min_visible_ms: 200, min_gap_ms: 500 };
const EDITION_1 = { min_visible_ms: 0, min_gap_ms: 0 };
/** For tests whose presses come when a busy machine lets them: what has to be quick may take two seconds. */
const SLOW = { min_visible_ms: 200, min_gap_ms: 2000 };
/** The page's time goes a fifth as fast: what has to be quick is, however busy the machine. */
const SLOWLY = 5;
const slowly = `{
  const now = performance.now.bind(performance);
  performance.now = () => now() / ${SLOWLY};
  const frame = requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (run) => frame((time) => run(time / ${SLOWLY}));
  const { get } = Object.getOwnPropertyDescriptor(Event.prototype, "timeStamp");
  Object.defineProperty(Event.prototype, "timeStamp", { get() { return get.call(this) / ${SLOWLY}; } });
}`;
const ARROW_LEFT = "\uE012";
const ENTER = "\uE007";

/** The reasons in the logs of the stored answers. */
const reasons = (mock) => rows(mock).flatMap((row) => (row.events ?? []).filter(({ event }) => event === "ignored").map(({ reason }) => reason));

/** Notes, whenever pictures or a button's state change, whether pictures can be seen and their button is offered. */
const watched = `{
  window.states = [];
  new MutationObserver(() => {
    const button = document.querySelector('.pair.shown [data-testid="choice-left"]');
    const state = button === null ? "no pair" : button.matches("[aria-disabled]") ? "seen" : "offered";
    if (window.states.at(-1) !== state) window.states.push(state);
  }).observe(document, { subtree: true, childList: true, attributes: true, attributeFilter: ["class", "aria-disabled"] });
}`;

/** Resolves when the trial on the page can be answered. */
const answerable = (page) => page.locator('.pair.shown [data-testid="choice-left"]:not([aria-disabled])').waitFor();

/** At trial `i`, with nothing counted for so long that an answer counts. */
async function ready(v, i) {
  await position(v.page, i);
  await answerable(v.page);
}

/** Presses a point of the page, quick ones counted as a browser does: `clickCount` is what `event.detail` will be. */
async function press(v, at, clickCount, pointer) {
  v.cdp ??= await v.context.newCDPSession(v.page);
  const { cdp } = v;
  if (pointer === "touch") {
    await cdp.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: [at] });
    return cdp.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  }
  for (const type of ["mousePressed", "mouseReleased"]) await cdp.send("Input.dispatchMouseEvent", { type, ...at, button: "left", clickCount, pointerType: pointer });
}

const middle = async (v, testid) => {
  const { x, y, width, height } = await v.hook(testid).boundingBox();
  return { x: x + width / 2, y: y + height / 2 };
};

for (const pointer of ["mouse", "touch", "pen"]) {
  for (const after of [180, 311, 480]) {
    test(`Chromium: a double click with ${pointer}, the second after ${after} ms, answers one pair`, async (t) => {
      const v = await visit(t, { response: SLOW, options: { viewport: { width: 1280, height: 800 }, hasTouch: true } });
      await begin(v);
      await ready(v, 0);
      const at = await middle(v, "choice-left");
      await press(v, at, 1, pointer);
      await v.page.waitForTimeout(after);
      await press(v, at, 2, pointer);
      await ready(v, 1);
      assert.deepEqual(stored(v.mock), [[[0, "left"]]]);
      if (pointer !== "touch") await press(v, at, 2, pointer);
      await v.hook("choice-right").click();
      await ready(v, 2);
      assert.deepEqual(stored(v.mock), [
        [
          [0, "left"],
          [1, "right"],
        ],
      ]);
      const [first, second] = rows(v.mock);
      assert.deepEqual([first.input, first.events], [pointer, undefined]);
      // The second press may have come between the pairs, where there is nothing to press.
      const ignored = (second.events ?? []).filter(({ event }) => event === "ignored");
      assert.ok(
        ignored.every(({ choice, input, reason }) => choice === "left" && input === pointer && ["double", "early", "gap", "answered"].includes(reason)),
        JSON.stringify(ignored),
      );
      if (pointer !== "touch") assert.deepEqual([ignored.at(-1).reason, ignored.at(-1).time_ms > 0], ["double", true]);
      for (const row of [first, second]) assert.ok(row.rt >= 200 && row.min_visible_ms >= 200, JSON.stringify(row));
    });
  }
}

test("without rules the second of two quick presses answers nothing either; a later touch does", async (t) => {
  for (const [pointer, pause, answers] of [
    ["touch", 0, 1],
    ["touch", 100, 1],
    ["mouse", 0, 1],
    ["touch", 600, 2],
  ]) {
    const v = await visit(t, { response: EDITION_1, options: { viewport: { width: 1280, height: 800 }, hasTouch: true }, spoil: slowly });
    await begin(v);
    const at = await middle(v, "choice-left");
    await press(v, at, 1, pointer);
    await position(v.page, 1);
    await v.page.waitForTimeout(pause * SLOWLY);
    await press(v, at, 2, pointer);
    await v.page.waitForTimeout(400);
    assert.equal(rows(v.mock).length, answers, `${pointer}, ${pause} ms`);
  }
});

for (const response of [EDITION_1, EDITION_2]) {
  test(`Chromium: what is offered counts, and nothing is offered before or after, with ${JSON.stringify(response)}`, async (t) => {
    const v = await visit(t, { response, spoil: watched });
    await begin(v);
    for (let i = 0; i < 5; i++) {
      await v.page.getByText(`${i + 1} of 5`, { exact: true }).waitFor();
      await answerable(v.page);
      await v.page.keyboard.press(i % 2 === 0 ? "ArrowLeft" : "ArrowRight");
    }
    await v.hook("completion-code").waitFor();
    assert.deepEqual(
      stored(v.mock)[0].map(([, choice]) => choice),
      ["left", "right", "left", "right", "left"],
    );
    assert.deepEqual(reasons(v.mock), []);
    const states = await v.page.evaluate(() => globalThis.states);
    assert.deepEqual(states, [...Array(5).fill(["no pair", "seen", "offered", "seen"]).flat(), "no pair"]);
  });
}

test("Chromium: a held key answers one pair, and answers the next once it was let go", async (t) => {
  const v = await visit(t, { response: EDITION_2 });
  await begin(v);
  await ready(v, 0);
  for (let i = 0; i < 40; i++) {
    await v.page.keyboard.down("ArrowLeft");
    await v.page.waitForTimeout(30);
  }
  await ready(v, 1);
  assert.deepEqual(stored(v.mock), [[[0, "left"]]]);
  await v.page.keyboard.press("ArrowRight");
  await v.page.waitForTimeout(300);
  assert.equal(rows(v.mock).length, 1, "the other key is not let go");
  await v.page.keyboard.up("ArrowLeft");
  await v.page.keyboard.press("ArrowRight");
  await ready(v, 2);
  assert.deepEqual(stored(v.mock), [
    [
      [0, "left"],
      [1, "right"],
    ],
  ]);
  const said = reasons(v.mock);
  assert.ok(said.includes("repeat") && said.includes("held"), String(said));
});

test("Chromium: repeats that come as pairs of down and up answer one pair", async (t) => {
  const v = await visit(t, { response: SLOW });
  await begin(v);
  await ready(v, 0);
  const until = Date.now() + 2500;
  while (Date.now() < until) {
    await v.page.keyboard.press("ArrowLeft");
    await v.page.waitForTimeout(30);
  }
  assert.deepEqual(stored(v.mock), [[[0, "left"]]]);
  await v.page.waitForTimeout(SLOW.min_gap_ms / 2 + 300);
  await answerable(v.page);
  await v.page.keyboard.press("ArrowLeft");
  await position(v.page, 2);
  const [, second] = rows(v.mock);
  const ignored = second.events.filter(({ event }) => event === "ignored");
  assert.ok(ignored.length > 10 && ignored.length <= 100, String(ignored.length));
  assert.ok(
    ignored.every(({ input, reason }) => input === "keyboard" && ["repeat", "answered"].includes(reason)),
    JSON.stringify(ignored[0]),
  );
});

test("Chromium: a key held on a focused picture answers one pair", async (t) => {
  const v = await visit(t, { response: EDITION_2 });
  await begin(v);
  for (const [i, key] of [
    [0, "Enter"],
    [1, "Space"],
  ]) {
    await ready(v, i);
    await v.hook("choice-right").focus();
    for (let n = 0; n < 20; n++) {
      await v.page.keyboard.down(key);
      await v.page.waitForTimeout(30);
    }
    await v.page.keyboard.up(key);
    await ready(v, i + 1);
  }
  assert.deepEqual(stored(v.mock), [
    [
      [0, "right"],
      [1, "right"],
    ],
  ]);
  assert.deepEqual(
    rows(v.mock).map((row) => row.input),
    ["keyboard", "keyboard"],
  );
});

test("Chromium: what a script presses is no answer", async (t) => {
  const v = await visit(t, { response: EDITION_2 });
  await begin(v);
  await ready(v, 0);
  await v.page.evaluate(() => {
    document.querySelector('[data-testid="choice-left"]').click();
    document.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", code: "ArrowLeft", bubbles: true }));
  });
  await v.page.waitForTimeout(300);
  assert.deepEqual(stored(v.mock), [[]]);
  await v.page.keyboard.press("ArrowRight");
  await ready(v, 1);
  assert.deepEqual(reasons(v.mock), ["untrusted", "untrusted"]);
});

test("Chromium: a double click on a page of text goes on one page, and the last page's counts for the first trial's gap", async (t) => {
  const v = await visit(t, { response: SLOW });
  await v.hook("consent-agree").waitFor();
  const at = await middle(v, "consent-agree");
  for (const clickCount of [1, 2]) {
    await press(v, at, clickCount, "mouse");
    await v.page.waitForTimeout(180);
  }
  await v.hook("start").waitFor();
  await v.page.locator('[data-testid="start"]:not([aria-disabled])').waitFor();
  const start = await middle(v, "start");
  await press(v, start, 1, "mouse");
  await position(v.page, 0);
  await v.page.keyboard.press("ArrowLeft");
  await ready(v, 0);
  assert.deepEqual(stored(v.mock), [[]]);
  await v.page.keyboard.press("ArrowLeft");
  await ready(v, 1);
  assert.deepEqual(stored(v.mock), [[[0, "left"]]]);
});

test("Chromium: a reload is no new hand", async (t) => {
  const v = await visit(t, { response: { min_visible_ms: 0, min_gap_ms: 20_000 } });
  await v.hook("consent-agree").click();
  await v.hook("start").waitFor();
  await v.page.reload();
  await v.hook("start").waitFor();
  assert.equal(await v.hook("start").getAttribute("aria-disabled"), "true");
  await v.hook("start").click({ force: true });
  await v.page.waitForTimeout(300);
  assert.equal(await v.hook("start").count(), 1);
});

test("Chromium: time that the page was hidden is not time that the stimulus was visible", async (t) => {
  const v = await visit(t, { response: { min_visible_ms: 3000, min_gap_ms: 0 } });
  await begin(v);
  const hide = (hidden) =>
    v.page.evaluate((hidden) => {
      Object.defineProperty(document, "hidden", { configurable: true, get: () => hidden });
      document.dispatchEvent(new Event("visibilitychange"));
    }, hidden);
  await hide(true);
  await v.page.waitForTimeout(3200);
  await hide(false);
  await v.page.keyboard.press("ArrowLeft");
  await v.page.waitForTimeout(300);
  assert.deepEqual(stored(v.mock), [[]]);
  await answerable(v.page);
  await v.page.keyboard.press("ArrowRight");
  await position(v.page, 1);
  const [row] = rows(v.mock);
  assert.ok(row.hidden_ms >= 3100 && row.min_visible_ms >= 3000, JSON.stringify([row.hidden_ms, row.min_visible_ms]));
  assert.deepEqual(
    row.events.map(({ event }) => event),
    ["hidden", "visible", "ignored"],
  );
});

/** A participant in Firefox, at the first trial. */
async function inFirefox(t, response, stuff = material()) {
  const mock = await startMock({ dist: bundle, stuff, response });
  const firefox = await launchFirefox();
  t.after(async () => {
    await firefox.close();
    await mock.close();
  });
  await firefox.goto(`${mock.url}/study/${study.id}`);
  await firefox.click("consent-agree");
  await firefox.click("start");
  const trial = (i) =>
    firefox.until(
      (text) => document.querySelector(".position")?.textContent === text && document.querySelector('.pair.shown [data-testid="choice-left"]:not([aria-disabled])') !== null,
      `${i + 1} of ${stuff.trials.length}`,
    );
  await trial(0);
  return { mock, firefox, trial };
}

test("Firefox: double clicks, double touches, held and repeating keys each answer one pair", { skip: !hasFirefox }, async (t) => {
  const { mock, firefox, trial } = await inFirefox(t, EDITION_2);
  await firefox.presses(await firefox.middle("choice-left"), [0, 180, 130]);
  await trial(1);
  assert.deepEqual(stored(mock), [[[0, "left"]]]);
  await firefox.presses(await firefox.middle("choice-right"), [0, 200], "touch");
  await trial(2);
  assert.deepEqual(stored(mock), [
    [
      [0, "left"],
      [1, "right"],
    ],
  ]);
  await firefox.keys(ARROW_LEFT, [0, ...Array(60).fill(30)]);
  await trial(3);
  assert.equal(rows(mock).length, 3);
  await firefox.evaluate(() => document.querySelector('[data-testid="choice-right"]').focus());
  await firefox.keys(ENTER, [0, ...Array(30).fill(30)]);
  await trial(4);
  const answers = rows(mock);
  assert.deepEqual(
    answers.map(({ choice, input }) => [choice, input]),
    [
      ["left", "mouse"],
      ["right", "touch"],
      ["left", "keyboard"],
      ["right", "keyboard"],
    ],
  );
  for (const { rt } of answers) assert.ok(rt >= 200, String(rt));
  assert.ok(reasons(mock).length >= 20, String(reasons(mock).length));
});

test("Firefox: without a gap to keep, repeats that come as pairs of down and up are one press all the same", { skip: !hasFirefox }, async (t) => {
  const { mock, firefox, trial } = await inFirefox(t, EDITION_1);
  await firefox.keys(ARROW_LEFT, [0, ...Array(80).fill(30)]);
  await trial(1);
  assert.deepEqual(stored(mock), [[[0, "left"]]]);
  await firefox.keys(ARROW_LEFT, [300]);
  await trial(2);
  assert.deepEqual(stored(mock), [
    [
      [0, "left"],
      [1, "left"],
    ],
  ]);
});

test("Firefox: without rules a double touch answers one pair, and two touches two", { skip: !hasFirefox }, async (t) => {
  const { mock, firefox, trial } = await inFirefox(t, EDITION_1);
  const at = await firefox.middle("choice-left");
  await firefox.presses(at, [0, 300], "touch");
  await trial(1);
  assert.equal(rows(mock).length, 1);
  await firefox.presses(at, [700], "touch");
  await trial(2);
  assert.equal(rows(mock).length, 2);
});
