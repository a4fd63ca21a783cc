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
  await v.page.route("**/stimuli/**", async (route) => {
    await new Promise((resolve) => setTimeout(resolve, 2500));
    await route.continue();
  });
  await v.hook("consent-agree").click();
  await v.hook("start").click();
  await v.page.getByText(/The pictures are on their way: \D?\d\D* of \D*10\D* are here/).waitFor();
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
  assert.deepEqual(stored(v.mock), [[[0, "left"], [1, "left"], [2, "left"], [3, "left"], [4, "left"]]]);
});

test("an answer that the server refuses for good is kept and said, and no code is shown", async (t) => {
  let refuse = true;
  const errors = [{ pointer: "/rt", value: -1, rule: "must be a number from 0 to 86400000" }];
  const [, body] = problem(422, "invalid_field", "The answer has a fault.", { errors });
  const v = await visit(t, { fault: ({ method, path }) => (refuse && method === "PUT" && path.endsWith("/trials/1") ? { status: 422, body } : null) });
  await begin(v);
  await answer(v, 0, 5);
  await v.page.getByText("One answer could not be stored").waitFor();
  await v.page.getByText("The answer has a fault. /rt = -1: must be a number from 0 to 86400000.").waitFor();
  assert.equal(await v.hook("completion-code").count(), 0);
  refuse = false;
  await v.page.getByRole("button", { name: "Try again" }).click();
  assert.equal(await v.hook("completion-code").textContent(), "LAKON-7Q4F");
});
