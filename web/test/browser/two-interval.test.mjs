// Trials of two pictures one after the other, from end to end.
import assert from "node:assert/strict";
import { test } from "node:test";
import { mask, seedOf } from "../../participant/trials/two-interval/mask.ts";
import { durations, intervals, study } from "../mock-study.ts";
import { launch, sizes } from "./chromium.mjs";
import { differing, pixels, screenOf } from "./pixels.mjs";
import { answer, begin, painted, position, rows, stored, visit } from "./visit.mjs";

const STEPS = ["fixation", "first", "mask", "second"];
/** Waits for the response screen. */
const answering = async ({ hook, page }) => {
  await hook("choice-first").waitFor({ state: "visible" });
  await painted(page);
};

/** What is wrong with the durations of a stored answer; nothing is, where each step got what was asked for to half a frame, or more where a frame was dropped. */
function wrong(row, asked) {
  const period = 1000 / row.refresh_hz;
  return STEPS.flatMap((step) => {
    const [ms, frames, wanted] = [row.shown_ms[step], row.shown_frames[step], asked[`${step}_ms`]];
    const faults = [];
    if (row.requested_ms[step] !== wanted) faults.push(`${step}: asked for ${row.requested_ms[step]}`);
    if (ms < wanted - period / 2 - 1 || frames < Math.round(wanted / period)) faults.push(`${step}: ${ms} ms, ${frames} frames`);
    if (Math.abs(ms - frames * period) > period / 2) faults.push(`${step}: ${ms} ms are not ${frames} frames`);
    return faults;
  });
}

for (const dpr of [1, 2]) {
  test(`a visit by keyboard, mouse and arrows at ${dpr} device pixels to a CSS pixel`, async (t) => {
    const chromium = await launch([`--force-device-scale-factor=${dpr}`, "--window-size=1280,800"]);
    t.after(() => chromium.close());
    const v = await visit(t, { chromium, options: { viewport: null }, stuff: intervals({ stills: 4, animations: 1 }) });
    await begin(v, "5");
    for (const [i, key] of ["1", "ArrowRight", "2", "ArrowLeft"].entries()) {
      await position(v.page, i);
      await answering(v);
      await v.page.keyboard.press(key);
    }
    await position(v.page, 4);
    await answering(v);
    await v.hook("choice-second").click();
    assert.equal(await v.hook("completion-code").textContent(), "LAKON-7Q4F");
    assert.deepEqual(stored(v.mock), [
      [
        [0, "first"],
        [1, "second"],
        [2, "second"],
        [3, "first"],
        [4, "second"],
      ],
    ]);
    const answers = rows(v.mock);
    assert.deepEqual(
      answers.map((row) => row.input),
      ["keyboard", "keyboard", "keyboard", "keyboard", "mouse"],
    );
    for (const row of answers) {
      assert.deepEqual(wrong(row, durations), []);
      assert.ok(wrong(row, { ...durations, mask_ms: durations.mask_ms + 40 }).length > 0, "40 ms too few would be seen");
      assert.equal(row.min_visible_ms, Math.min(row.shown_ms.first, row.shown_ms.second));
      assert.deepEqual([row.scale, row.css_width_px, row.device_pixel_ratio, row.restarts], [1, 592 / dpr, dpr, 0]);
      assert.ok(row.rt > 0 && row.onset > 0);
    }
    assert.equal(answers[0].frames, undefined);
    const { frames, shown_frames } = answers[4];
    for (const interval of ["first", "second"]) {
      assert.equal(frames[interval].fps, 12);
      // Played in its interval alone, from its first frame: a few frames of 12 a second fit into it.
      assert.ok(frames[interval].refreshes < shown_frames[interval], JSON.stringify(frames[interval]));
      assert.ok(frames[interval].shown >= 1 && frames[interval].shown <= 5);
    }
  });

  test(`each step shows exactly its pixels at ${dpr} device pixels to a CSS pixel`, async (t) => {
    const chromium = await launch([`--force-device-scale-factor=${dpr}`, "--window-size=1280,800"]);
    t.after(() => chromium.close());
    const settings = { fixation_ms: 2500, first_ms: 2500, mask_ms: 2500, second_ms: 2500 };
    const v = await visit(t, { chromium, options: { viewport: null }, stuff: intervals({ stills: 1, settings }) });
    await begin(v, "1");
    const canvas = v.page.locator("canvas");
    const box = await canvas.boundingBox();
    const at = [Math.round(box.x * dpr), Math.round(box.y * dpr)];
    const spoken = v.page.locator(".spoken");
    const { shown, trial_index } = v.mock.stuff.trials[0];
    const bytes = (role) => pixels(v.mock.stuff.bytes.get(shown[role].sha256).pictures[0]);
    const grey = { width: 592, height: 333, at: () => [124, 124, 124] };

    // All are taken before any is compared, which takes a busy machine longer than a step.
    const seen = { fixation: await screenOf(v) };
    await spoken.getByText("First image").waitFor({ state: "attached" });
    seen.first = await screenOf(v);
    await spoken.getByText("First image").waitFor({ state: "detached" });
    seen.mask = await screenOf(v);
    await spoken.getByText("Second image").waitFor({ state: "attached" });
    seen.second = await screenOf(v);
    await answering(v);
    const buttons = await Promise.all(["first", "second"].map((role) => v.hook(`choice-${role}`).boundingBox()));
    const response = await screenOf(v);
    const outside = { ...grey, at: (x, y) => (buttons.some((b) => y + at[1] >= b.y * dpr - 2 && y + at[1] <= (b.y + b.height) * dpr + 2) ? response.at(at[0] + x, at[1] + y) : [124, 124, 124]) };
    assert.equal(differing(response, outside, ...at), 0, "nothing is left of the pictures");
    const ink = differing(seen.fixation, grey, ...at);
    assert.ok(ink > 50 && ink < 1000, `a small cross: ${ink} pixels`);
    for (const [role, other] of [
      ["first", "second"],
      ["second", "first"],
    ]) {
      assert.equal(differing(seen[role], bytes(role), ...at), 0, role);
      assert.ok(differing(seen[role], bytes(role), ...at, 1) > 1000, "one pixel off would be seen");
      assert.ok(differing(seen[role], bytes(other), ...at) > 1000, "the other picture would be seen");
    }
    const rgba = mask({ width: 592, height: 333, surround: study.surround, seed: seedOf([shown.first.sha256, shown.second.sha256], trial_index) });
    const blocks = { width: 592, height: 333, at: (x, y) => [...rgba.subarray(4 * (592 * y + x), 4 * (592 * y + x) + 3)] };
    assert.equal(differing(seen.mask, blocks, ...at), 0, "mask");
    await v.hook("choice-first").click();
    await v.hook("completion-code").waitFor();
  });
}

test("nothing is an answer before the question is asked", async (t) => {
  const v = await visit(t, { stuff: intervals({ stills: 1 }) });
  await v.hook("consent-agree").click();
  await v.page.evaluate(() => {
    globalThis.pressing = setInterval(() => {
      for (const key of ["1", "2", "ArrowLeft", "ArrowRight"]) document.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
      if (!document.querySelector(".intervals")?.classList.contains("answering")) for (const button of document.querySelectorAll(".answers button")) button.click();
      else clearInterval(globalThis.pressing);
    }, 5);
  });
  await v.hook("start").click();
  await answering(v);
  await v.page.waitForTimeout(300);
  assert.equal(await v.hook("choice-first").isVisible(), true);
  // A control: the same key does answer now.
  await v.page.keyboard.press("2");
  await v.hook("completion-code").waitFor();
  assert.deepEqual(stored(v.mock), [[[0, "second"]]]);
});

test("a page that is hidden during an interval begins the trial again, and says how often", async (t) => {
  const v = await visit(t, { stuff: intervals({ stills: 2, settings: { ...durations, first_ms: 600, second_ms: 600 } }) });
  await begin(v, "2");
  const hide = (hidden) =>
    v.page.evaluate((hidden) => {
      Object.defineProperty(document, "hidden", { configurable: true, get: () => hidden });
      document.dispatchEvent(new Event("visibilitychange"));
    }, hidden);
  const spoken = v.page.locator(".spoken");
  for (const words of ["First image", "Second image"]) {
    await spoken.getByText(words).waitFor({ state: "attached" });
    await hide(true);
    await spoken.getByText(words).waitFor({ state: "detached" });
    await v.page.waitForTimeout(200);
    assert.equal(await v.hook("choice-first").isVisible(), false);
    await hide(false);
  }
  await spoken.getByText("First image").waitFor({ state: "attached" });
  await answering(v);
  await hide(true);
  await v.page.waitForTimeout(200);
  await hide(false);
  await v.page.keyboard.press("1");
  await answer(v, 1, 2, "first", "2");
  await v.hook("completion-code").waitFor();
  const [first, second] = rows(v.mock);
  assert.deepEqual([first.restarts, second.restarts], [2, 0]);
  assert.deepEqual(wrong(first, { ...durations, first_ms: 600, second_ms: 600 }), [], "what is logged is the sequence that was seen to its end");
  assert.ok(first.hidden_ms >= 190 && first.hidden_ms < first.rt && second.hidden_ms === 0, `${first.hidden_ms} of ${first.rt}`);
});

test("a display that can't show what is asked for is told so before a trial, and nothing is lost", async (t) => {
  const stuff = intervals({ stills: 2 });
  stuff.trials[1].settings = { ...durations, mask_ms: 3 };
  const v = await visit(t, { stuff });
  await v.hook("consent-agree").click();
  await v.hook("start").click();
  await v.page.getByText("This study shows something for 3 ms, and this display redraws only every").waitFor();
  await v.page.getByText("in another browser or on another device").waitFor();
  assert.equal(await v.page.locator("canvas").count(), 0, "not after half of the trials");
  assert.deepEqual(stored(v.mock), [[]]);
  assert.equal(v.problems.length, 1, "the console says why");
  v.problems.length = 0;
  stuff.trials[1].settings = durations;
  await v.page.getByRole("button", { name: "Reload the page" }).click();
  await v.hook("start").click();
  await position(v.page, 0, "2");
});

test("a phone: one picture as large as fits, two buttons large enough for a thumb, nothing beyond the edge", async (t) => {
  const v = await visit(t, { stuff: intervals({ stills: 1 }), options: { viewport: { width: 320, height: 568 }, hasTouch: true, isMobile: true } });
  await v.hook("consent-agree").tap();
  await v.hook("start").tap();
  await answering(v);
  const [first, second] = [await v.hook("choice-first").boundingBox(), await v.hook("choice-second").boundingBox()];
  for (const { width, height, x } of [first, second]) assert.ok(width >= 44 && height >= 44 && x >= 0 && x + width <= 320, JSON.stringify([first, second]));
  assert.ok(first.x + first.width <= second.x, "first is left of second");
  assert.equal(await v.page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth), 0);
  await v.hook("choice-second").tap();
  await v.hook("completion-code").waitFor();
  const [row] = rows(v.mock);
  assert.deepEqual([row.choice, row.input, row.css_width_px], ["second", "touch", 300]);
  assert.ok(Math.abs(row.scale - 300 / 592) < 1e-9);
});

test("those who don't see the page hear its steps, and reach the answers by keyboard", async (t) => {
  const v = await visit(t, { stuff: intervals({ stills: 1, settings: { ...durations, fixation_ms: 1000 } }), options: sizes.desktop });
  await begin(v, "1");
  assert.equal(await v.page.evaluate(() => document.activeElement?.textContent), study.question);
  await v.page.evaluate(() => {
    globalThis.heard = [];
    new MutationObserver(() => globalThis.heard.push(document.querySelector(".spoken").textContent)).observe(document.querySelector(".spoken"), {
      childList: true,
      characterData: true,
      subtree: true,
    });
  });
  await answering(v);
  assert.deepEqual((await v.page.evaluate(() => globalThis.heard)).filter(Boolean), ["First image", "Second image", "Please choose: first or second"]);
  assert.equal(await v.page.getByRole("group", { name: study.question }).getByRole("button").count(), 2);
  await v.page.keyboard.press("Tab");
  assert.equal(await v.page.evaluate(() => document.activeElement?.textContent), "First");
  await v.page.keyboard.press("Enter");
  await v.hook("completion-code").waitFor();
  assert.deepEqual(
    rows(v.mock).map((row) => [row.choice, row.input]),
    [["first", "keyboard"]],
  );
});
