// A participant's visit in a real browser against the mock server: `npm run test:browser` (needs Chromium; CHROMIUM names another one).
import assert from "node:assert/strict";
import { test } from "node:test";
import { study } from "../mock-study.ts";
import { launch } from "./chromium.mjs";
import { differing, pixels, screenOf } from "./pixels.mjs";
import { answer, begin, position, stored, visit } from "./visit.mjs";

test("a whole visit: every answer once, the code only at the end, nothing stored before consent", async (t) => {
  const v = await visit(t, { query: "?PROLIFIC_PID=p1&STUDY_ID=s1&SESSION_ID=x1" });
  await v.hook("consent-agree").waitFor();
  assert.equal(v.mock.sessions.size, 0);
  await begin(v);
  assert.equal(await v.hook("completion-code").count(), 0);
  await answer(v, 0, 5);
  assert.equal(await v.hook("completion-code").textContent(), "LAKON-7Q4F");
  assert.deepEqual(stored(v.mock), [
    [
      [0, "left"],
      [1, "left"],
      [2, "left"],
      [3, "left"],
      [4, "left"],
    ],
  ]);
  const [session] = v.mock.sessions.values();
  assert.deepEqual(session.body.params, { PROLIFIC_PID: "p1", STUDY_ID: "s1", SESSION_ID: "x1" });
  assert.equal(await v.page.getByRole("link", { name: "Return to prolific.com" }).count(), 1);
  const row = JSON.parse(session.answers.get(0));
  assert.equal(row.input, "mouse");
  assert.equal(row.scale, 1);
  assert.ok(row.rt > 0 && row.onset > 0 && row.time_elapsed > 0);
  assert.ok(row.refresh_hz > 20 && row.refresh_hz < 400);
  const { frames } = JSON.parse(session.answers.get(4));
  assert.equal(frames.left.fps, 12);
  assert.ok(frames.left.draws.length >= 1 && frames.left.draws.length === frames.left.shown);
});

test("the keyboard alone is enough, and arrows mean sides", async (t) => {
  const v = await visit(t);
  await v.hook("consent-agree").waitFor();
  assert.equal(await v.page.evaluate(() => document.activeElement?.tagName), "H1");
  await v.hook("consent-agree").focus();
  await v.page.keyboard.press("Enter");
  await v.hook("start").waitFor();
  await v.page.keyboard.press("Tab");
  assert.equal(await v.page.evaluate(() => document.activeElement?.getAttribute("data-testid")), "start", "one tab stop from heading to action");
  await v.page.waitForTimeout(200); // the same key sooner is a repeat
  await v.page.keyboard.press("Enter");
  for (const [i, key] of ["ArrowRight", "ArrowLeft"].entries()) {
    await position(v.page, i);
    await v.page.keyboard.press(key);
  }
  await position(v.page, 2);
  await v.page.keyboard.press("Tab");
  await v.page.keyboard.press("Tab");
  await v.page.keyboard.press("Enter");
  await position(v.page, 3);
  await v.page.keyboard.press("Alt+ArrowLeft").catch(() => {});
  assert.deepEqual(stored(v.mock), [
    [
      [0, "right"],
      [1, "left"],
      [2, "right"],
    ],
  ]);
  const [session] = v.mock.sessions.values();
  assert.deepEqual(
    [0, 2].map((i) => JSON.parse(session.answers.get(i)).input),
    ["keyboard", "keyboard"],
  );
});

test("pictures have their labels, and the page says where it is", async (t) => {
  const v = await visit(t);
  await begin(v);
  assert.equal(await v.page.getByRole("button", { name: "Left image" }).count(), 1);
  assert.equal(await v.page.getByRole("button", { name: "Right image" }).count(), 1);
  assert.equal(await v.page.locator("[aria-live=polite]").textContent(), "1 of 5");
  assert.equal(await v.page.evaluate(() => document.activeElement?.textContent), study.question);
});

test("a reload resumes at the next trial; after the end it shows the code again", async (t) => {
  const v = await visit(t);
  await begin(v);
  await answer(v, 0, 2);
  await position(v.page, 2);
  await v.page.reload();
  await position(v.page, 2);
  await answer(v, 2, 5, "right");
  await v.hook("completion-code").waitFor();
  await v.page.reload();
  assert.equal(await v.hook("completion-code").textContent(), "LAKON-7Q4F");
  assert.deepEqual(stored(v.mock), [
    [
      [0, "left"],
      [1, "left"],
      [2, "right"],
      [3, "right"],
      [4, "right"],
    ],
  ]);
  const [session] = v.mock.sessions.values();
  assert.deepEqual(
    [0, 2].map((i) => JSON.parse(session.answers.get(i)).reload_count),
    [0, 1],
  );
});

test("another participant's link starts another session, the first one's resumes his", async (t) => {
  const v = await visit(t, { query: "?PROLIFIC_PID=a" });
  await begin(v);
  await answer(v, 0, 1);
  await v.page.goto(v.url.replace("=a", "=b"));
  await v.hook("consent-agree").waitFor();
  await v.page.goto(v.url);
  await position(v.page, 1);
});

test("a second tab says so and may take over; the first one stops", async (t) => {
  const v = await visit(t);
  await begin(v);
  await answer(v, 0, 1);
  await position(v.page, 1);
  const second = await v.context.newPage();
  await second.goto(v.url);
  await second.getByText("This study is open in another tab").waitFor();
  await second.getByRole("button", { name: "Continue here" }).click();
  await position(second, 1);
  await v.page.getByText("Continued in another tab").waitFor();
  await v.page.keyboard.press("ArrowRight");
  await second.getByTestId("choice-left").click();
  await position(second, 2);
  assert.deepEqual(stored(v.mock), [
    [
      [0, "left"],
      [1, "left"],
    ],
  ]);
});

test("a session that the server has forgotten starts again from consent", async (t) => {
  const v = await visit(t);
  await begin(v);
  v.mock.sessions.clear();
  await v.page.reload();
  await v.hook("consent-agree").waitFor();
});

test("wrong bytes are never shown", async (t) => {
  const v = await visit(t);
  await v.hook("consent-agree").waitFor();
  const { sha256 } = v.mock.stuff.trials[0].shown.left;
  const { sha256: other } = v.mock.stuff.trials[1].shown.left;
  v.mock.stuff.bytes.set(sha256, v.mock.stuff.bytes.get(other));
  await v.hook("consent-agree").click();
  await v.hook("start").click();
  await v.page.getByText("The study has stopped").waitFor();
  assert.equal(await v.hook("choice-left").count(), 0);
  assert.equal(v.problems.length, 1, "the console says why");
  v.problems.length = 0;
});

test("nothing scrolls sideways down to 320 pixels, and the page can be zoomed", async (t) => {
  const v = await visit(t, { options: { viewport: { width: 320, height: 568 }, hasTouch: true, isMobile: true } });
  const wide = () => v.page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  const zoom = await v.page.locator("meta[name=viewport]").getAttribute("content");
  assert.doesNotMatch(zoom, /maximum-scale|user-scalable/);
  await v.hook("consent-agree").waitFor();
  assert.equal(await wide(), 0);
  await v.hook("consent-agree").tap();
  await v.hook("start").waitFor();
  assert.equal(await wide(), 0);
  await v.hook("start").tap();
  for (let i = 0; i < 5; i++) {
    await position(v.page, i);
    assert.equal(await wide(), 0);
    const [left, right] = [await v.hook("choice-left").boundingBox(), await v.hook("choice-right").boundingBox()];
    assert.ok(right.y >= left.y + left.height * 1.05 && right.y + right.height <= 568, JSON.stringify([left, right]));
    await v.hook("choice-right").tap();
  }
  await v.hook("completion-code").waitFor();
  assert.equal(await wide(), 0);
  const [session] = v.mock.sessions.values();
  const row = JSON.parse(session.answers.get(0));
  assert.deepEqual([row.input, row.arrangement], ["touch", "stack"]);
  assert.ok(Math.abs(row.scale - 297 / 592) < 1e-9, String(row.scale));
});

test("a study that is not there says so", async (t) => {
  const v = await visit(t);
  await v.page.goto(v.url.replace(study.id, "nothing"));
  await v.page.getByText("There is no such study").waitFor();
});

// A real scale factor: Chromium's emulated one places pictures in whole CSS pixels, which no display does.
for (const dpr of [1, 1.25, 1.5, 2, 2.625]) {
  test(`at ${dpr} device pixels to a CSS pixel the screen shows exactly the stimulus's pixels`, async (t) => {
    const chromium = await launch([`--force-device-scale-factor=${dpr}`, "--window-size=1280,800"]);
    t.after(() => chromium.close());
    const v = await visit(t, { chromium, options: { viewport: null } });
    await begin(v);
    await v.hook("choice-left").waitFor();
    assert.equal(await v.page.evaluate(() => devicePixelRatio), dpr);
    const screen = await screenOf(v);
    for (const side of ["left", "right"]) {
      const stimulus = pixels(v.mock.stuff.bytes.get(v.mock.stuff.trials[0].shown[side].sha256).pictures[0]);
      const box = await v.hook(`choice-${side}`).boundingBox();
      const at = [Math.round(box.x * dpr), Math.round(box.y * dpr)];
      assert.equal(differing(screen, stimulus, ...at), 0, side);
      assert.ok(differing(screen, stimulus, ...at, 1) > 1000, "one pixel off would be seen");
    }
  });
}
