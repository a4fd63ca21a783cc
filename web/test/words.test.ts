import assert from "node:assert/strict";
import { test } from "node:test";
import { faults, read, types } from "../participant/words/catalogue.ts";
import { direction, speak, spoken, words } from "../participant/words/index.ts";

Object.assign(globalThis, { document: { documentElement: { lang: "", dir: "" } } });
const root = document.documentElement;

test("the page speaks the language it is told, and the document says which", () => {
  speak("de-AT");
  assert.equal(words("position", { number: 3, all: 25 }), "3 von 25");
  assert.deepEqual([root.lang, root.dir], ["de-AT", "ltr"]);
  speak("ar");
  assert.equal(root.dir, "rtl");
  assert.match(words("position", { number: 3, all: 25 }), /^\u2068?3\u2069? من \u2068?25\u2069?$/, "Latin digits, as in the code and in most studies' texts");
  speak("fi");
  assert.equal(words("position", { number: 3, all: 25 }), "3 of 25", "a language without a catalogue is spoken to in English");
  assert.equal(root.lang, "fi");
});

test("numbers take the forms of their language", () => {
  speak("ar");
  const minutes = [1, 2, 3, 11].map((n) => words("consent-minutes", { minutes: n }).replace(/[\u2068\u2069]/g, ""));
  assert.deepEqual(
    minutes.map((text) => text.split(" نحو ")[1]),
    ["دقيقة واحدة.", "دقيقتين.", "3 دقائق.", "11 دقيقة."],
  );
  speak("en");
  assert.equal(words("missing", { count: 1 }).split(" ")[0], "One");
  assert.equal(words("missing", { count: 2 }).split(" ")[0], "2");
});

test("languages by their first part, in any case", () => {
  assert.deepEqual(["AR-eg", "fa", "de", "he-IL"].map(direction), ["rtl", "rtl", "ltr", "rtl"]);
  assert.deepEqual(["AR-eg", "de-CH", "nl", ""].map(spoken), ["ar", "de", "en", "en"]);
});

test("catalogues that differ are told apart, and messages that nobody says", () => {
  const en = read("a-title = A { $n }\nb = B\n");
  const said = `words("a-title", { n: 1 }); words("b")`;
  assert.deepEqual(faults({ en, de: read("a-title = { $n } A\nb = B\n") }, said), []);
  assert.deepEqual(faults({ en, de: read("a-title = A\nc = C\n") }, said), ["de has no b", "de's a-title takes nothing, and English's n", "de has c, which English has not"]);
  assert.deepEqual(faults({ en }, `words("b")`), ["a-title is said nowhere"]);
  assert.throws(() => read("a = { $n\nb = B"), /no message: a = \{ \$n/);
  assert.throws(() => read("a = A\na = B"), /a is there twice/);
  assert.match(types(en), /"a-title": \{ n: string \| number \};\n {2}"b": null;/);
});
