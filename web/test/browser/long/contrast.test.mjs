// Every button and link can be read, in every state, scheme and surround.
import assert from "node:assert/strict";
import { test } from "node:test";
import { inkOn, srgbCode } from "../../../participant/layout.ts";
import { contrasts, inEveryState } from "../contrast.mjs";
import { consolePages, visits } from "../pages.mjs";
import { visit } from "../visit.mjs";

/** WCAG 2.2, 1.4.3 (AA): words against what is behind them; 1.4.11: what tells a button from the page. */
const LEAST = 4.5;
const LEAST_EDGE = 3;

const faint = (found) => found.filter(({ contrast }) => contrast < LEAST).map(({ words, state, contrast }) => `${words} (${state}): ${contrast.toFixed(2)}`);
/** A disabled button need not be told from the page; its words still must be read. */
const unseen = (found) =>
  found
    .filter(({ kind, edge, state }) => state !== "disabled" && /\b(action|primary)\b/.test(kind) && edge < LEAST_EDGE)
    .map(({ words, state, edge }) => `${words} (${state}): edge ${edge.toFixed(2)}`);

/** How a browser may be asked to colour pages. */
const schemes = ["light", "dark"].flatMap((colorScheme) => ["none", "active"].map((forcedColors) => ({ colorScheme, forcedColors })));

/** Surrounds from black to white, close together where the ink turns. */
const surrounds = [...Array.from({ length: 33 }, (_, i) => i / 32), ...Array.from({ length: 41 }, (_, i) => 0.16 + i / 1000)];

/** Gives a participant's page another surround, as its study file would. */
const dress = (page, surround) =>
  page.evaluate(
    ([code, ink]) => {
      document.documentElement.style.setProperty("--surround", `rgb(${code} ${code} ${code})`);
      document.documentElement.dataset.ink = ink;
    },
    [srgbCode(surround), inkOn(surround)],
  );

for (const [name, { walk, stuff, query, server }] of Object.entries(visits)) {
  test(`participants can read every button and link: ${name}`, async (t) => {
    const v = await visit(t, { stuff: stuff(), query: query === undefined ? "" : `?${query}`, ...server });
    const pages = [];
    await walk(v, async (where, page = v.page) => {
      pages.push(where);
      for (const media of schemes) {
        await page.emulateMedia(media);
        const found = await inEveryState(page);
        assert.deepEqual([...faint(found), ...unseen(found)], [], `${where}, ${JSON.stringify(media)}`);
        if (where !== "moved" && where !== "no study" && where !== "trial") assert.ok(found.length > 0, where);
      }
      await page.emulateMedia({ colorScheme: "light", forcedColors: "none" });
      for (const surround of surrounds) {
        await dress(page, surround);
        const found = (await page.evaluate(contrasts)).map((one) => ({ ...one, state: `surround ${surround}` }));
        assert.deepEqual([...faint(found), ...unseen(found)], [], where);
      }
      for (const surround of [0, 0.179, 1]) {
        await dress(page, surround);
        const found = await inEveryState(page);
        assert.deepEqual([...faint(found), ...unseen(found)], [], `${where}, surround ${surround}`);
      }
      await dress(page, 0.2);
    });
    assert.ok(pages.length > 0);
    if (server !== undefined) v.problems.length = 0; // trouble is said in the browser's console too
  });
}

for (const media of schemes) {
  test(`researchers can read every button and link: ${JSON.stringify(media)}`, async (t) => {
    const v = await visit(t);
    await v.page.emulateMedia(media);
    await consolePages(v, async (where) => {
      const found = await inEveryState(v.page);
      assert.ok(found.length > 0, where);
      assert.deepEqual([...faint(found), ...unseen(found)], [], where);
    });
  });
}

test("a link whose ink is the page's is found: the test can fail", async (t) => {
  const { walk, stuff, query } = visits["from consent to the panel's page"];
  const v = await visit(t, { stuff: stuff(), query: `?${query}` });
  let looked = 0;
  await walk(v, async (where) => {
    if (where !== "return") return;
    await v.page.evaluate(() => document.styleSheets[0].insertRule("a.action { color: inherit; }", document.styleSheets[0].cssRules.length));
    assert.match(faint(await inEveryState(v.page))[0] ?? "nothing", /^Return to prolific\.com \(at rest\): 1\.00$/);
    await v.page.evaluate(() => document.styleSheets[0].insertRule(".action { background: transparent; border: 0; color: var(--ink); }", document.styleSheets[0].cssRules.length));
    await v.page.emulateMedia({ forcedColors: "active" });
    assert.match(unseen(await inEveryState(v.page))[0] ?? "nothing", /edge 1\.00/);
    looked += 1;
  });
  assert.equal(looked, 1);
});
