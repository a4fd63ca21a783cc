// How pages of text stand on a phone.
import assert from "node:assert/strict";
import { test } from "node:test";
import { sizes } from "./chromium.mjs";
import { visits } from "./pages.mjs";
import { visit } from "./visit.mjs";

test("a notice covers no heading, two actions stand apart within a phone, and an ended visit says nothing else", async (t) => {
  const checks = {
    "no line at the end": async (page) => {
      const [notice, heading] = [await page.locator("#notice").boundingBox(), await page.locator("h1").boundingBox()];
      assert.ok(notice.y + notice.height <= heading.y, JSON.stringify([notice, heading]));
    },
    "a kiosk's end": async (page) => {
      const [first, second] = await Promise.all([0, 1].map((i) => page.locator(".actions .action").nth(i).boundingBox()));
      assert.ok(first.y + first.height + 8 <= second.y && second.x >= 0 && second.x + second.width <= 390, JSON.stringify([first, second]));
    },
    "a session that the server has forgotten": async (page) => assert.equal(await page.locator("#notice").textContent(), ""),
  };
  for (const [name, check] of Object.entries(checks)) {
    const { walk, stuff, server } = visits[name];
    const v = await visit(t, { options: sizes.phone, stuff: stuff(), ...server });
    await walk(v, () => check(v.page));
    v.problems.length = 0;
  }
});

test("the ribbon of a preview covers no action, in any language, on the narrowest phone", async (t) => {
  const { stuff, server } = visits["a preview, with its ribbon"];
  for (const lang of ["en", "de", "ar"]) {
    const v = await visit(t, { options: { ...sizes.phone, viewport: { width: 320, height: 568 } }, stuff: stuff(), query: `?preview&lang=${lang}`, ...server });
    for (const id of ["consent-agree", "start"]) {
      await v.hook(id).waitFor();
      const [action, ribbon] = [await v.hook(id).boundingBox(), await v.hook("ribbon").boundingBox()];
      assert.ok(action.y + action.height <= ribbon.y, `${lang}: ${JSON.stringify([action, ribbon])}`);
      await v.hook(id).click();
    }
  }
});
