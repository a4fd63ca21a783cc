// No dead ends: whatever browser, storage, clock and network do, a visit ends with the code or with a sentence that says what to do.
import assert from "node:assert/strict";
import { test } from "node:test";
import { material } from "../mock-study.ts";
import { HURRY, troubles } from "./troubles.mjs";
import { visit } from "./visit.mjs";

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
    const text = await page.locator("body").innerText().catch(() => "");
    if (says?.test(text)) return text;
    await page.locator(STEPS).first().click({ timeout: 250, noWaitAfter: true }).catch(() => undefined);
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
      assert.deepEqual(done.map((session) => session.answers.size), [2], "all answers are there");
    }
    if (sessions !== undefined) assert.equal(v.mock.sessions.size, sessions);
    v.problems.length = 0; // what went wrong is said in the console too
  });
}
