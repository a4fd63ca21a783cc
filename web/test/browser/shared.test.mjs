// Shared computers: nobody lands in somebody else's session, and nobody sees somebody else's code.
import assert from "node:assert/strict";
import { test } from "node:test";
import { answer, begin, position, stored, visit } from "./visit.mjs";

/** Comes by the link anew, as the next person would. */
const again = (v) => v.page.goto(v.url);

test("who comes to a study that was begun is asked, and may go on or be someone else", async (t) => {
  let down = false;
  const v = await visit(t, { fault: ({ method }) => (down && method === "PUT" ? "hang up" : null) });
  await begin(v);
  await answer(v, 0, 1);
  await position(v.page, 1);
  await again(v);
  await v.page.getByRole("button", { name: "I began it: go on" }).click();
  await position(v.page, 1);
  down = true;
  await answer(v, 1, 2);
  await again(v);
  await v.page.getByText("Welcome back").waitFor();
  assert.equal(await v.hook("choice-left").count(), 0);
  down = false;
  await v.page.getByRole("button", { name: "I am someone else" }).click();
  await v.hook("consent-agree").click();
  await v.hook("start").click();
  await position(v.page, 0);
  assert.deepEqual(
    stored(v.mock),
    [
      [
        [0, "left"],
        [1, "left"],
      ],
      [],
    ],
    "what the first one left unsent is the first one's",
  );
  await answer(v, 0, 1);
  await v.page.reload();
  await position(v.page, 1);
});

test("a code is shown to who reloads or comes by a link of one's own, and to nobody else", async (t) => {
  for (const [query, shown] of [
    ["", false],
    ["?PROLIFIC_PID=p1", true],
  ]) {
    const v = await visit(t, { query });
    await begin(v);
    await answer(v, 0, 5);
    await v.hook("completion-code").waitFor();
    await v.page.reload();
    await v.hook("completion-code").waitFor();
    await again(v);
    await v.hook(shown ? "completion-code" : "consent-agree").waitFor();
  }
});

test("in a kiosk each visit is somebody else's, but for a reload, and the end leads back to the start", async (t) => {
  const v = await visit(t, { perVisit: true, query: "?PROLIFIC_PID=p1" });
  await begin(v);
  await answer(v, 0, 1);
  await position(v.page, 1);
  await v.page.reload();
  await position(v.page, 1);
  await again(v);
  await begin(v);
  await answer(v, 0, 5);
  await v.hook("completion-code").waitFor();
  await v.page.getByRole("button", { name: "Back to the start" }).click();
  await v.hook("consent-agree").waitFor();
  await v.page.reload();
  await v.hook("consent-agree").waitFor();
  assert.deepEqual(
    stored(v.mock).map((answers) => answers.length),
    [1, 5],
  );
});

test("a kiosk that nobody touches goes back to the start by itself", async (t) => {
  const spoil = "const later = setTimeout; window.setTimeout = (run, ms = 0, ...given) => later(run, ms >= 100000 ? 1000 : ms, ...given);";
  const v = await visit(t, { perVisit: true, spoil });
  await begin(v);
  await answer(v, 0, 5);
  await v.hook("completion-code").waitFor();
  await v.hook("consent-agree").waitFor();
  assert.equal(await v.hook("completion-code").count(), 0);
});

test("over http the code is selected and copied, or it is said how", async (t) => {
  const spoil = 'Object.defineProperty(Navigator.prototype, "clipboard", { get: () => undefined });';
  for (const [more, words] of [
    ["", "Copied"],
    ["Document.prototype.execCommand = () => false;", "Please select the code and copy it"],
    ["Document.prototype.execCommand = undefined;", "Please select the code and copy it"],
  ]) {
    const v = await visit(t, { spoil: spoil + more });
    await begin(v);
    await answer(v, 0, 5);
    await v.page.getByRole("button", { name: "Copy the code" }).click();
    await v.page.getByRole("button", { name: words }).waitFor();
    assert.equal(await v.page.evaluate(() => getSelection().toString().trim()), "LAKON-7Q4F");
    assert.equal(await v.hook("completion-code").getAttribute("translate"), "no");
  }
});
