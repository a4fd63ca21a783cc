// Languages: which is read, what is stored of it, and that left stays left where lines run from right to left.
import assert from "node:assert/strict";
import { test } from "node:test";
import { material, study } from "../mock-study.ts";
import { sizes } from "./chromium.mjs";
import { painted, rows, visit } from "./visit.mjs";

const root = (page) => page.evaluate(() => [document.documentElement.lang, document.documentElement.dir, document.title]);
const session = (mock) => [...mock.sessions.values()][0].body;

test("the browser's language is read, the switch changes it before consent, and the session keeps it", async (t) => {
  const v = await visit(t, { options: { ...sizes.desktop, locale: "de-AT" }, query: "?PROLIFIC_PID=w1" });
  await v.page.getByRole("button", { name: "Ich willige ein und nehme teil" }).waitFor();
  assert.deepEqual(await root(v.page), ["de", "ltr", study.translations.de.title]);
  assert.equal(await v.hook("minutes").innerText(), "Es dauert ungefähr 3 Minuten.");
  const nav = v.page.getByRole("navigation", { name: "Sprache" });
  assert.deepEqual(await nav.getByRole("link").allInnerTexts(), ["English", "Deutsch", "العربية"]);
  await nav.getByRole("link", { name: "English" }).click();
  await v.page.getByRole("button", { name: "I agree and take part" }).waitFor();
  assert.match(v.page.url(), /PROLIFIC_PID=w1/);
  await v.hook("consent-agree").click();
  await v.hook("start").waitFor();
  assert.equal(session(v.mock).display.language, "en");
  assert.deepEqual(session(v.mock).params, { PROLIFIC_PID: "w1" }, "the page's own parameter is nobody's");
  await v.page.goto(`${v.url}&lang=ar`);
  await v.hook("start").waitFor();
  assert.deepEqual(await root(v.page), ["en", "ltr", study.title], "a session goes on in the language that it began in");
  assert.equal(v.mock.sessions.size, 1);
});

test("in Arabic the text runs from right to left, and left stays left", async (t) => {
  const v = await visit(t, { query: "?lang=ar", stuff: { ...material(), trials: material().trials.slice(0, 2) } });
  await v.hook("consent-agree").waitFor();
  assert.deepEqual(await root(v.page), ["ar", "rtl", study.translations.ar.title]);
  const heading = await v.page.locator("h1").evaluate((h1) => ({
    right: h1.getBoundingClientRect().right,
    text: (() => {
      const range = document.createRange();
      range.selectNodeContents(h1);
      return range.getBoundingClientRect().right;
    })(),
  }));
  assert.ok(Math.abs(heading.right - heading.text) < 2, "the text begins on the right");
  await v.hook("consent-agree").click();
  await v.hook("start").waitFor();
  const keys = await v.page.locator(".keys kbd").evaluateAll((all) => all.map((kbd) => [kbd.textContent, kbd.getBoundingClientRect().x]));
  assert.deepEqual(
    keys.sort((a, b) => a[1] - b[1]).map(([key]) => key),
    ["←", "→"],
  );
  await v.hook("start").click();
  const plan = v.mock.stuff.trials;
  for (const [i, key] of [
    [0, "ArrowLeft"],
    [1, "ArrowRight"],
  ]) {
    await v.page.locator(`.pair.shown [data-sha256="${plan[i].shown.left.sha256}"]:not([aria-disabled])`).waitFor();
    const at = async (one) => ({ x: (await v.hook(`choice-${one}`).boundingBox()).x, sha256: await v.hook(`choice-${one}`).getAttribute("data-sha256") });
    const [left, right] = [await at("left"), await at("right")];
    assert.ok(left.x < right.x);
    assert.deepEqual([left.sha256, right.sha256], [plan[i].shown.left.sha256, plan[i].shown.right.sha256]);
    assert.equal(await v.hook("choice-left").getAttribute("aria-label"), "الصورة اليسرى");
    await v.page.waitForTimeout(600);
    await v.page.keyboard.press(key);
  }
  const code = v.hook("completion-code");
  await code.waitFor();
  assert.deepEqual(
    rows(v.mock).map(({ choice }) => choice),
    ["left", "right"],
  );
  assert.deepEqual([await code.getAttribute("translate"), await code.getAttribute("dir")], ["no", "ltr"]);
  assert.equal(session(v.mock).display.language, "ar");
});

test("a signed link for trying a study survives the choice of another language", async (t) => {
  const v = await visit(t, { query: "?preview=1&exp=9&key=k&sig=s", visitKind: "preview" });
  await v.page.getByRole("navigation").getByRole("link", { name: "Deutsch" }).click();
  await v.page.getByRole("button", { name: "Ich willige ein und nehme teil" }).click();
  await v.hook("start").waitFor();
  assert.equal(await v.hook("ribbon").count(), 1);
});

test("a language that the browser has no name for stands by its tag", async (t) => {
  const unnamed = () => {
    const Names = Intl.DisplayNames;
    Intl.DisplayNames = class extends Names {
      constructor(tags, options) {
        if (tags[0] === "ar") throw new RangeError("Incorrect locale information provided");
        super(tags, options);
      }
    };
  };
  const v = await visit(t, { init: [unnamed] });
  await v.hook("consent-agree").waitFor();
  assert.deepEqual(await v.page.getByRole("navigation").getByRole("link").allInnerTexts(), ["English", "Deutsch", "ar"]);
});

test("addresses in a study's texts are links that lead beside it, and nothing else is", async (t) => {
  const v = await visit(t, { query: "?lang=de" });
  await v.hook("consent-agree").waitFor();
  const links = await v.page.locator(".text p a").evaluateAll((all) => all.map((a) => [a.textContent, a.getAttribute("href"), a.target, a.rel]));
  assert.deepEqual(links, [
    ["studie@example.org", "mailto:studie@example.org", "", ""],
    ["https://example.org/schatten", "https://example.org/schatten", "_blank", "noopener noreferrer"],
  ]);
  assert.match(await v.page.locator(".text").innerText(), /mehr steht auf https:\/\/example\.org\/schatten\.\n/);
});

for (const [name, { options, query }] of Object.entries({ English: { options: sizes.desktop, query: "" }, Arabic: { options: sizes.desktop, query: "?lang=ar" } })) {
  test(`at 1280 by 800 the action of every page is in sight, however long the text: ${name}`, async (t) => {
    const long = Array.from({ length: 40 }, () => "A paragraph that is long enough to take its line and more, as consent forms of real boards of ethics do.");
    const stuff = { ...material(), trials: material().trials.slice(0, 1) };
    const v = await visit(t, { options, query, stuff, texts: { consent: long, instructions: long, debriefing: long } });
    const inSight = async (where) => {
      const box = await v.page.locator(".actions > *").last().boundingBox();
      assert.ok(box.y >= 0 && box.y + box.height <= 800, `${where}: ${box.y} to ${box.y + box.height}`);
    };
    await v.hook("consent-agree").waitFor();
    assert.ok((await v.page.evaluate(() => document.documentElement.scrollHeight)) > 1600, "the text is longer than the window");
    await inSight("consent");
    await v.hook("consent-agree").click();
    await v.hook("start").waitFor();
    await inSight("instructions");
    await v.hook("start").click();
    await v.page.locator(".pair.shown").waitFor();
    await painted(v.page);
    await v.page.waitForTimeout(600);
    await v.hook("choice-left").click();
    await v.hook("completion-code").waitFor();
    await inSight("thanks");
  });
}
