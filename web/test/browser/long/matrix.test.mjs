// No dead ends: whatever browser, storage, clock and network do, a visit ends with the code or with a sentence that says what to do.
import assert from "node:assert/strict";
import { test } from "node:test";
import { startMock } from "../../mock-server.ts";
import { material, study } from "../../mock-study.ts";
import { hasFirefox, launchFirefox } from "../firefox.mjs";
import { HURRY, troubles } from "../troubles.mjs";
import { bundle, visit } from "../visit.mjs";

/** Two trials are a study. */
const short = () => {
  const made = material();
  return { ...made, trials: made.trials.slice(0, 2) };
};

const STEPS = ["consent-agree", "start", "choice-left"].map((id) => `[data-testid="${id}"]`).join(",");

/** Does what a page asks for until it asks for nothing more; gives what it says then. */
async function through({ page }, says) {
  for (let steps = 0; steps < 400; steps++) {
    if (await page.locator('[data-testid="completion-code"]').count()) return "code";
    const text = await page
      .locator("body")
      .innerText()
      .catch(() => "");
    if (says?.test(text)) return text;
    await page
      .locator(STEPS)
      .first()
      .click({ timeout: 250, noWaitAfter: true })
      .catch(() => undefined);
    await page.waitForTimeout(50);
  }
  return `nothing: ${await page.locator("body").innerText()}`;
}

for (const { name, spoil = "", fault = () => () => null, says, sessions } of troubles) {
  test(name, async (t) => {
    const v = await visit(t, { stuff: short(), spoil: HURRY + spoil, fault: fault(), query: "" });
    const end = await through(v, says);
    if (says === undefined) assert.equal(end, "code");
    else assert.match(end, says);
    if (says === undefined) {
      const done = [...v.mock.sessions.values()].filter((session) => session.code !== null);
      assert.deepEqual(
        done.map((session) => session.answers.size),
        [2],
        "all answers are there",
      );
    }
    if (sessions !== undefined) assert.equal(v.mock.sessions.size, sessions);
    v.problems.length = 0; // what went wrong is said in the console too
  });
}

/** What Firefox is likely to take otherwise than Chromium. */
const IN_FIREFOX = /blocked|no storage|full|forgets|cut twice|stalls for ever|half an|without PUT|portal amid|refused twice|jumps back|tenths|hidden and shown|newer functions|before its time/;

test("Firefox goes through its share of these", { skip: !hasFirefox }, async (t) => {
  const firefox = await launchFirefox();
  t.after(() => firefox.close());
  const look = () =>
    firefox.evaluate(
      (steps) => ({
        text: document.body?.innerText ?? "",
        code: document.querySelector('[data-testid="completion-code"]') !== null,
        step: [...document.querySelectorAll(steps)].find((element) => getComputedStyle(element).visibility === "visible" && element.getAttribute("aria-disabled") !== "true")?.dataset.testid ?? null,
      }),
      STEPS,
    );
  for (const { name, spoil = "", fault = () => () => null, says } of troubles.filter(({ name }) => IN_FIREFOX.test(name))) {
    await t.test(name, async () => {
      const mock = await startMock({ dist: bundle, stuff: short(), spoil: HURRY + spoil, fault: fault() });
      await firefox.goto(`${mock.url}/study/${study.id}`);
      let seen = await look();
      for (let steps = 0; steps < 200 && !seen.code && !says?.test(seen.text); steps++) {
        if (seen.step !== null) await firefox.click(seen.step).catch(() => undefined);
        await new Promise((resolve) => setTimeout(resolve, 100));
        seen = await look();
      }
      await mock.close();
      if (says === undefined) assert.ok(seen.code, seen.text);
      else assert.match(seen.text, says);
    });
  }
});
