// axe finds nothing in Firefox either: the participant's way in two languages, and the console's pages.
import assert from "node:assert/strict";
import { test } from "node:test";
import { results } from "../../mock-results.ts";
import { startMock } from "../../mock-server.ts";
import { material, study } from "../../mock-study.ts";
import { violations } from "../axe.mjs";
import { hasFirefox, launchFirefox } from "../firefox.mjs";
import { bundle } from "../visit.mjs";

/** A Firefox and a mock server with one pair; `look` says what axe finds. */
async function open(t) {
  const stuff = { ...material(), trials: material().trials.slice(0, 1) };
  const mock = await startMock({ dist: bundle, results: results(stuff), stuff });
  const firefox = await launchFirefox();
  t.after(async () => {
    await firefox.close();
    await mock.close();
  });
  return { mock, firefox, look: async (where) => assert.deepEqual(await firefox.evaluate(violations), [], where) };
}

const there = (testid) => document.querySelector(`[data-testid="${testid}"]`) !== null;

test("in Firefox: from consent to the code, from left to right and from right to left", { skip: !hasFirefox }, async (t) => {
  const { mock, firefox, look } = await open(t);
  for (const lang of ["en", "ar"]) {
    await firefox.goto(`${mock.url}/study/${study.id}?PROLIFIC_PID=${lang}&lang=${lang}`);
    await firefox.until(there, "consent-agree");
    assert.equal(await firefox.evaluate(() => document.documentElement.dir), lang === "ar" ? "rtl" : "ltr");
    await look(`consent, ${lang}`);
    await firefox.click("consent-agree");
    await firefox.until(there, "start");
    await look(`instructions, ${lang}`);
    await firefox.click("start");
    await firefox.middle("choice-left");
    await look(`trial, ${lang}`);
    await firefox.click("choice-left");
    await firefox.until(there, "completion-code");
    await look(`return, ${lang}`);
  }
});

test("in Firefox: the console", { skip: !hasFirefox }, async (t) => {
  const { mock, firefox, look } = await open(t);
  await firefox.goto(`${mock.url}/console/studies`);
  await firefox.until(there, "login-password");
  await look("sign in");
  await firefox.evaluate(() => fetch("/api/v1/auth/session", { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify({ password: "wayang" }) }).then(() => true));
  for (const [path, ready] of [
    ["", "table"],
    [`/${study.id}`, "#report-how-to-cite"],
    ["/empty", ".empty"],
  ]) {
    await firefox.goto(`${mock.url}/console/studies${path}`);
    await firefox.until((selector) => document.querySelector(selector) !== null, ready);
    await look(`studies${path}`);
  }
});
