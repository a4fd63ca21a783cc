import assert from "node:assert/strict";
import { test } from "node:test";
import { choose, inLanguage, languages } from "../participant/language.ts";
import { pieces, target } from "../participant/links.ts";
import { study as told } from "./mock-study.ts";

const study = { ...told, trial_kinds: [] };

test("the link's language counts first, then the browser's in their order, then the study's own", () => {
  assert.deepEqual(languages(study), ["en", "de", "ar"]);
  assert.equal(choose(study, "ar", ["de"]), "ar");
  assert.equal(choose(study, "AR-eg", ["de"]), "ar");
  assert.equal(choose(study, "fr", ["fi", "de-AT", "en"]), "de");
  assert.equal(choose(study, null, ["fi"]), "en");
  const regional = { language: "pt-BR", translations: { pt: { ...study } } };
  assert.deepEqual(
    ["pt-BR", "pt", "pt-AO", "xx"].map((asked) => choose(regional, asked, [])),
    ["pt-BR", "pt", "pt-BR", "pt-BR"],
  );
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

/** The addresses that are found in a text. */
const found = (text: string) => pieces(text).flatMap((piece) => (piece.href === null ? [] : [piece.text]));

test("an address ends with its sentence, and where a script without blanks goes on", () => {
  assert.deepEqual(found("Ask a.b+c@example.org, or see (https://example.org/a_(b))."), ["a.b+c@example.org", "https://example.org/a_(b)"]);
  assert.deepEqual(found("请联系study@example.org询问，详见https://example.org/a。谢谢"), ["study@example.org", "https://example.org/a"]);
  assert.deepEqual(found("質問はwww.example.org/q?a=1へ（mail@example.org）。"), ["www.example.org/q?a=1", "mail@example.org"]);
  assert.deepEqual(found("Größe: müller@bücher.example"), ["müller@bücher.example"]);
  assert.deepEqual(found("javascript:alert(1) data:text/html,x a@b"), []);
  for (const text of ["a", "", "漢字", "x@y.example"])
    assert.equal(
      pieces(text)
        .map((piece) => piece.text)
        .join(""),
      text,
    );
});

test("no text takes long to be looked through", () => {
  const texts = ["漢", "a", "a.", "a@", "www.", ")"].flatMap((part) => [part.repeat(20_000 / part.length), `https://example.org/${part.repeat(19_000 / part.length)}`]);
  const start = performance.now();
  texts.forEach(found);
  assert.ok(performance.now() - start < 3000, `${performance.now() - start} ms`);
});
