/**
 * The page's own words in the participant's language: message catalogues (Fluent) of which each language has one, `LANGUAGE.ftl`
 * here. `check.ts` holds them to each other, and makes `messages.d.ts`, by which a message's name and arguments are typed.
 */
import { FluentBundle, FluentResource } from "@fluent/bundle";
import ar from "./ar.ftl";
import de from "./de.ftl";
import en from "./en.ftl";
import type { Messages } from "./messages.d.ts";

/** A message's name. */
export type Id = keyof Messages;

/** Messages without arguments. */
export type Plain = { [K in Id]: Messages[K] extends null ? K : never }[Id];

/** Catalogues by language. */
const catalogues: Record<string, string> = { en, de, ar };

/** Written from right to left, by the language's first part. */
const RIGHT_TO_LEFT = new Set(["ar", "arc", "ckb", "dv", "fa", "he", "ks", "nqo", "ps", "sd", "syr", "ug", "ur", "yi"]);

const primary = (language: string) => (language.split("-")[0] ?? "").toLowerCase();

/** Which way a language is written. */
export const direction = (language: string): "ltr" | "rtl" => (RIGHT_TO_LEFT.has(primary(language)) ? "rtl" : "ltr");

/** The language the page has words in that is nearest to the one wanted. */
export const spoken = (language: string): string => (Object.hasOwn(catalogues, primary(language)) ? primary(language) : "en");

/** A catalogue, ready to speak. */
function open(language: string): FluentBundle {
  // Latin digits in every language, as in a study's own texts and its code; arguments are isolated where the line runs the other way.
  const bundle = new FluentBundle(`${language}-u-nu-latn`, { useIsolating: direction(language) === "rtl" });
  bundle.addResource(new FluentResource(catalogues[language] ?? ""));
  return bundle;
}

const english = open("en");
let current = english;

/** The language of the page from now on; the document's too, and the way in which it is written. */
export function speak(language: string): void {
  current = spoken(language) === "en" ? english : open(spoken(language));
  document.documentElement.lang = language;
  document.documentElement.dir = direction(language);
}

/** A message in the page's language; in English where the language lacks it. */
export function words<K extends Id>(id: K, ...args: Messages[K] extends null ? [] : [Messages[K]]): string {
  return said(current, id, args[0]) ?? said(english, id, args[0]) ?? id;
}

function said(bundle: FluentBundle, id: string, args: Record<string, string | number> | null | undefined): string | null {
  const pattern = bundle.getMessage(id)?.value;
  if (pattern === undefined || pattern === null) return null;
  const errors: Error[] = []; // what can't be formatted stands as {$name}: better than an exception
  return bundle.formatPattern(pattern, args ?? {}, errors);
}
