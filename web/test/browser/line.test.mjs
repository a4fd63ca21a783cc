// What happens on a bad line: nothing is lost, nothing doubled, and what is said is true.
import assert from "node:assert/strict";
import { test } from "node:test";
import { problem } from "../mock-server.ts";
import { answer, begin, position, stored, visit } from "./visit.mjs";

test("a lost line: the sentence is calm and true, the study goes on, all arrives", async (t) => {
  let down = false;
  const v = await visit(t, { fault: ({ method }) => (down && method === "PUT" ? "hang up" : null) });
  await begin(v);
  down = true;
  await answer(v, 0, 2);
  await position(v.page, 2);
  await v.page.getByText("No connection. Your answers are kept here and sent later; you can go on.").waitFor();
  assert.deepEqual(stored(v.mock), [[]]);
  // What waits survives a reload.
  await v.page.reload();
  await position(v.page, 2);
  await answer(v, 2, 5);
  await v.page.getByText("Almost done").waitFor();
  await v.page.getByText("No connection. Your answers are kept here and sent later; this page goes on by itself when it is back.").waitFor();
  assert.equal(await v.hook("completion-code").count(), 0, "no code while answers wait");
  down = false;
  await v.page.evaluate(() => dispatchEvent(new Event("online")));
  assert.equal(await v.hook("completion-code").textContent(), "LAKON-7Q4F");
  assert.equal(stored(v.mock)[0].length, 5);
  assert.equal(await v.page.locator("#notice").textContent(), "");
});

test("what one participant left unsent goes out with the next one's visit", async (t) => {
  let down = false;
  const v = await visit(t, { query: "?PROLIFIC_PID=a", fault: ({ method }) => (down && method === "PUT" ? "hang up" : null) });
  await begin(v);
  down = true;
  await answer(v, 0, 1, "right");
  await position(v.page, 1);
  await v.page.goto("about:blank");
  assert.deepEqual(stored(v.mock), [[]]);
  down = false;
  await v.page.goto(v.url.replace("=a", "=b"));
  await v.hook("consent-agree").click();
  await v.hook("start").waitFor();
  assert.deepEqual(stored(v.mock), [[[0, "right"]], []]);
});

test("pictures that are long in coming are announced", async (t) => {
  const v = await visit(t);
  let come;
  const coming = new Promise((resolve) => (come = resolve));
  await v.page.route("**/stimuli/**", async (route) => {
    await coming;
    await route.continue();
  });
  await v.hook("consent-agree").click();
  await v.hook("start").click();
  await v.page.getByText(/The pictures are on their way: \D?\d\D* of \D*10\D* are here/).waitFor();
  come();
  await position(v.page, 0);
  assert.equal(await v.page.locator("#notice").textContent(), "");
});

test("a lost acknowledgement costs nothing and doubles nothing", async (t) => {
  const lost = new Set();
  const fault = ({ method, path }) => (method === "PUT" && !lost.has(path) && lost.add(path) ? { after: true } : null);
  const v = await visit(t, { fault });
  await begin(v);
  await answer(v, 0, 5);
  await v.hook("completion-code").waitFor();
  assert.deepEqual(stored(v.mock), [
    [
      [0, "left"],
      [1, "left"],
      [2, "left"],
      [3, "left"],
      [4, "left"],
    ],
  ]);
});

test("a page that was frozen while its plan went to somebody else shows the trials of the new one, and stores no answer to the old", async (t) => {
  const v = await visit(t);
  const pictures = () => v.page.locator(".pair.shown [data-sha256]").evaluateAll((buttons) => buttons.map((button) => button.dataset.sha256));
  await begin(v);
  const [left, right] = await pictures();
  [...v.mock.sessions.values()][0].replans += 1;
  const answered = v.page.waitForResponse((response) => response.request().method() === "PUT" && response.status() === 409);
  await v.hook("choice-left").click();
  await answered;
  // The refusal may come before the next trial or during it.
  const again = v.page.getByText("other pictures have been chosen for you meanwhile");
  const next = position(v.page, 1).then(
    () => true,
    () => false,
  );
  if (await Promise.race([again.waitFor().then(() => false), next])) await v.hook("choice-left").click();
  await again.waitFor();
  assert.deepEqual(stored(v.mock), [[]]);
  await position(v.page, 0);
  assert.deepEqual(await pictures(), [right, left], "the mirror's");
  await answer(v, 0, 5, "right");
  await v.hook("completion-code").waitFor();
  assert.deepEqual(stored(v.mock), [
    [
      [0, "right"],
      [1, "right"],
      [2, "right"],
      [3, "right"],
      [4, "right"],
    ],
  ]);
  const sent = v.mock.log.filter(({ method }) => method === "PUT").map(({ query }) => new URLSearchParams(query).get("plan"));
  assert.deepEqual(
    sent.filter((plan) => plan !== "0"),
    ["1", "1", "1", "1", "1"],
  );
});

test("a trial whose answer the server refuses is taken again; refused once more it is kept and said, and no code is shown", async (t) => {
  let refuse = true;
  const errors = [{ pointer: "/choice", value: "left", rule: "must be otherwise" }];
  const [, body] = problem(422, "invalid_field", "The answer has a fault.", { errors });
  const v = await visit(t, { fault: ({ method, path }) => (refuse && method === "PUT" && path.endsWith("/trials/1") ? { status: 422, body } : null) });
  await begin(v);
  // The refusal may come before the next trial or during it.
  const seen = [];
  const missing = v.page.getByText("One answer could not be stored");
  const trial = v.page.locator(".trial:not([data-done])");
  while (
    await Promise.race([
      missing.waitFor().then(() => false),
      trial
        .locator(".pair.shown")
        .waitFor()
        .then(() => true),
    ])
  ) {
    seen.push({ at: await trial.locator(".position").textContent(), again: await v.page.getByText("its pictures are here once more. Please choose again.").isVisible() });
    await trial.evaluate((element) => (element.dataset.done = ""));
    await v.hook("choice-left").click();
  }
  assert.deepEqual(seen.map(({ at }) => at).sort(), ["1 of 5", "2 of 5", "2 of 5", "3 of 5", "4 of 5", "5 of 5"]);
  assert.equal(seen.filter(({ at }) => at === "2 of 5")[1].again, true);
  await v.page.getByText('The answer has a fault. /choice = "left": must be otherwise.').waitFor();
  assert.equal(await v.hook("completion-code").count(), 0);
  refuse = false;
  await v.page.getByRole("button", { name: "Try again" }).click();
  assert.equal(await v.hook("completion-code").textContent(), "LAKON-7Q4F");
});
