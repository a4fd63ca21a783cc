// Plans that grow with the answers: the next trial is decided when the server has the last answer.
import assert from "node:assert/strict";
import { test } from "node:test";
import { answer, begin, position, stored, visit } from "./visit.mjs";

const grow = { start: 1, most: 43 };
const all = [
  [0, "left"],
  [1, "left"],
  [2, "left"],
  [3, "left"],
  [4, "left"],
];

test("a plan that grows by one trial an answer comes to its end, and its length is promised only then", async (t) => {
  const v = await visit(t, { grow });
  await begin(v, "at most 43");
  await answer(v, 0, 4, "left", "at most 43");
  // The answer to the fourth decides the fifth, which is the last.
  await answer(v, 4, 5, "left", "5");
  await v.hook("completion-code").waitFor();
  assert.deepEqual(stored(v.mock), [all]);
  const calls = v.mock.log.filter((call) => call.method !== "GET" || call.path.includes("/sessions/"));
  assert.deepEqual(
    calls.filter((call) => call.method === "PUT").map((call) => call.query),
    ["1", "2", "3", "4", "5"].map((known) => `?known=${known}&plan=0`),
  );
  assert.equal(calls.filter((call) => call.method === "GET").length, 0, "acknowledgements bring the trials: nothing else is asked");
  assert.equal(calls.filter((call) => call.path.endsWith("/completion")).length, 1, "completion is asked for once, at the end");
});

test("the line goes in the middle: the page waits, says so, and a reload changes nothing", async (t) => {
  let down = false;
  const v = await visit(t, { grow, fault: ({ method }) => (down && method === "PUT" ? "hang up" : null) });
  await begin(v, "at most 43");
  await answer(v, 0, 2, "left", "at most 43");
  await position(v.page, 2, "at most 43");
  down = true;
  await v.hook("choice-left").click();
  const waiting = v.page.getByText("The next pictures depend on your answers: they come once these are stored.");
  await waiting.waitFor();
  await v.page.getByText("No connection. Your answers are kept here and sent later; this page goes on by itself when it is back.").waitFor();
  assert.equal(await v.hook("choice-left").count(), 0, "nothing is shown that was not decided");
  await v.page.reload();
  await waiting.waitFor();
  assert.deepEqual(stored(v.mock), [all.slice(0, 2)]);
  assert.equal(v.mock.log.filter((call) => call.path.endsWith("/completion")).length, 0, "no completion while more is to come");
  down = false;
  await v.page.evaluate(() => dispatchEvent(new Event("online")));
  await answer(v, 3, 4, "left", "at most 43");
  await answer(v, 4, 5, "left", "5");
  await v.hook("completion-code").waitFor();
  assert.deepEqual(stored(v.mock), [all]);
  assert.equal(await v.page.locator("#notice").textContent(), "");
});

test("a lost acknowledgement is made up for by the same bytes", async (t) => {
  const lost = new Set();
  const fault = ({ method, path }) => (method === "PUT" && !lost.has(path) && lost.add(path) ? { after: true } : null);
  const v = await visit(t, { grow, fault });
  await begin(v, "at most 43");
  await answer(v, 0, 2, "left", "at most 43");
  await position(v.page, 2, "at most 43");
  const sent = v.mock.log.filter((call) => call.method === "PUT" && call.path.endsWith("/trials/0")).map((call) => call.text);
  assert.equal(sent.length, 2);
  assert.equal(sent[0], sent[1]);
});

test("an answer that another tab's stands for: the server's plan counts", async (t) => {
  const v = await visit(t, { grow });
  await begin(v, "at most 43");
  const [session] = v.mock.sessions.values();
  session.answers.set(0, '{"choice":"right"}');
  await v.hook("choice-left").click();
  // The refusal brings no trials, so the state is asked for.
  await position(v.page, 1, "at most 43");
  assert.equal(v.mock.log.filter((call) => call.method === "GET" && /\/sessions\/[^/]+$/.test(call.path)).length, 1);
  assert.deepEqual(stored(v.mock), [[[0, "right"]]]);
});

test("an answer that is refused for good stops a growing plan, says so, and goes on after another try", async (t) => {
  let refuse = true;
  const v = await visit(t, { grow, fault: ({ method, path }) => (refuse && method === "PUT" && path.endsWith("/trials/1") ? { status: 422 } : null) });
  await begin(v, "at most 43");
  await answer(v, 0, 2, "left", "at most 43");
  // Its trial comes once more before anybody is asked what to do.
  await v.page.getByText("Please choose again").waitFor();
  await answer(v, 1, 2, "left", "at most 43");
  await v.page.getByText("One answer could not be stored").waitFor();
  // What it waits for must not cover what can be done.
  await v.page.waitForTimeout(600);
  refuse = false;
  await v.page.getByRole("button", { name: "Try again" }).click();
  await position(v.page, 2, "at most 43");
});

test("answers that a page before the update left in this browser are sent as it would have", async (t) => {
  const v = await visit(t);
  await begin(v);
  await answer(v, 0, 1);
  await position(v.page, 1);
  const [session] = v.mock.sessions.values();
  const old = { choice: "right", rt: 812.5, onset: 4021.1, input: "touch", scale: 1, time_elapsed: 9000, trial_type: "two-alternative", plugin_version: "1.0.0" };
  await v.page.evaluate(([id, answer]) => localStorage.setItem(`kelir:outbox:${id}`, JSON.stringify([{ index: 1, answer }])), [session.id, old]);
  await v.page.reload();
  await position(v.page, 2);
  assert.equal(session.answers.get(1), JSON.stringify(old));
  assert.equal(await v.page.evaluate((id) => localStorage.getItem(`kelir:outbox:${id}`), session.id), null);
});
