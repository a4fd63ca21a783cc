// axe finds nothing on any page, at desktop and phone size, in every language, in Chromium and in Firefox.
import assert from "node:assert/strict";
import { test } from "node:test";
import { violations } from "../axe.mjs";
import { sizes } from "../chromium.mjs";
import { consolePages, visits } from "../pages.mjs";
import { visit } from "../visit.mjs";

/** What axe says of a page, with the page's name. */
const found = async (page, where) => (await page.evaluate(`(${violations})()`)).map((sentence) => `${where}: ${sentence}`);

for (const [size, options] of Object.entries(sizes)) {
  for (const lang of ["en", "de", "ar"]) {
    test(`participants' pages, ${size}, ${lang}`, async (t) => {
      for (const { walk, stuff, query, server } of Object.values(visits)) {
        const v = await visit(t, { options, stuff: stuff(), query: `?lang=${lang}${query === undefined ? "" : `&${query}`}`, ...server });
        let looked = 0;
        await walk(v, async (where, page = v.page) => {
          looked += 1;
          assert.deepEqual(await found(page, where), []);
        });
        assert.ok(looked > 0);
        if (server !== undefined) v.problems.length = 0; // trouble is said in the browser's console too
      }
    });
  }
  for (const colorScheme of ["light", "dark"]) {
    test(`the console's pages, ${size}, ${colorScheme}`, async (t) => {
      const v = await visit(t, { options: { ...options, colorScheme } });
      await consolePages(v, async (where) => assert.deepEqual(await found(v.page, where), []));
    });
  }
}

test("what is wrong is found: the test can fail", async (t) => {
  const v = await visit(t);
  await v.hook("consent-agree").waitFor();
  await v.page.evaluate(() => {
    document.querySelector("h1").style.color = "rgb(140 140 140)";
    document.querySelector('[data-testid="consent-agree"]').textContent = "";
  });
  const all = (await found(v.page, "consent")).join("\n");
  assert.match(all, /color-contrast/);
  assert.match(all, /button-name/);
});
