// The instructions name what there is to answer with, on the device and in the window as they are.
import assert from "node:assert/strict";
import { test } from "node:test";
import { intervals } from "../mock-study.ts";
import { sizes } from "./chromium.mjs";
import { position, stored, visit } from "./visit.mjs";

const keys = (v) => v.page.locator(".legends kbd").allTextContents();
const instructions = async (v) => {
  await v.hook("consent-agree").click();
  await v.hook("start").waitFor();
};

test("beside each other it is ← and →, below each other ↑ and ↓, and a window that changes changes them", async (t) => {
  const v = await visit(t);
  await instructions(v);
  assert.deepEqual(await keys(v), ["←", "→"]);
  await v.page.getByText("left image").waitFor();
  await v.page.setViewportSize({ width: 600, height: 900 });
  await v.page.getByText("lower image").waitFor();
  assert.deepEqual(await keys(v), ["↑", "↓"]);
  const [upper, lower] = await v.page.locator(".legends .side").all();
  assert.ok((await upper.boundingBox()).y < (await lower.boundingBox()).y);
  await v.page.getByText("Click the picture that you choose, or press its key.").waitFor();
  await v.hook("start").click();
  for (const [i, key] of ["ArrowDown", "ArrowUp", "ArrowRight", "ArrowLeft"].entries()) {
    await position(v.page, i);
    assert.equal(await v.page.locator(".pair.stack").count(), 1, "the legend was right");
    await v.page.keyboard.press(key);
  }
  await position(v.page, 4);
  assert.deepEqual(stored(v.mock), [
    [
      [0, "right"],
      [1, "left"],
      [2, "right"],
      [3, "left"],
    ],
  ]);
});

test("beside each other ↑ and ↓ mean nothing", async (t) => {
  const v = await visit(t);
  await instructions(v);
  await v.hook("start").click();
  await position(v.page, 0);
  for (const key of ["ArrowUp", "ArrowDown", "ArrowRight"]) await v.page.keyboard.press(key);
  await position(v.page, 1);
  assert.deepEqual(stored(v.mock), [[[0, "right"]]]);
});

for (const [stuff, touch] of [
  [undefined, "Touch the picture that you choose."],
  [intervals(), "Touch the button of the picture that you choose."],
]) {
  test(`a device without keys is told to touch: "${touch}"`, async (t) => {
    const v = await visit(t, { options: sizes.phone, ...(stuff && { stuff }) });
    await instructions(v);
    await v.page.getByText(touch).waitFor();
    assert.deepEqual(await keys(v), []);
    assert.doesNotMatch(await v.page.locator("main").innerText(), /\b(press|click|arrow|key)\b/i);
  });
}
