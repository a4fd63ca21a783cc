import assert from "node:assert/strict";
import { test } from "node:test";
import { choose, inLanguage, languages } from "../participant/language.ts";
import { target } from "../participant/links.ts";
import { study as told } from "./mock-study.ts";

const study = { ...told, trial_kinds: [] };

test("the link's language counts first, then the browser's in their order, then the study's own", () => {
  assert.deepEqual(languages(study), ["en", "de", "ar"]);
  assert.equal(choose(study, "ar", ["de"]), "ar");
  assert.equal(choose(study, "AR-eg", ["de"]), "ar");
  assert.equal(choose(study, "fr", ["fi", "de-AT", "en"]), "de");
  assert.equal(choose(study, null, ["fi"]), "en");
  const regional = { language: "pt-BR", translations: { pt: { ...study } } };
  assert.deepEqual(["pt-BR", "pt", "pt-AO", "xx"].map((asked) => choose(regional, asked, [])), ["pt-BR", "pt", "pt-BR", "pt-BR"]);
});

test("a study reads whole in its language, and in its own where it has no other", () => {
  const german = inLanguage(study, "de");
  assert.deepEqual([german.title, german.texts.thanks[0]], ["Schatten auf einer Leinwand", "Das war das letzte Paar."]);
  assert.equal(inLanguage(study, "en").title, study.title);
  assert.equal(inLanguage(study, "constructor").title, study.title);
});

test("web and e-mail addresses lead somewhere, and nothing else does", () => {
  assert.equal(target("https://example.org/a?b=c"), "https://example.org/a?b=c");
  assert.equal(target("www.example.org"), "https://www.example.org/");
  assert.equal(target("a.b+c@example.org"), "mailto:a.b+c@example.org");
  assert.equal(target("http://"), null);
  assert.equal(target("https://["), null);
});
