/** In which of its languages a study is read. */
import type { Study } from "./api.ts";

/** All of a study's languages, its own first. */
export const languages = ({ language, translations }: Pick<Study, "language" | "translations">): string[] => [language, ...Object.keys(translations)];

/** The language that the link asks for, else the first that the browser wants and the study has, else the study's own. */
export function choose(study: Pick<Study, "language" | "translations">, asked: string | null, wanted: readonly string[]): string {
  const all = languages(study);
  const nearest = (tag: string) => all.find((language) => language.toLowerCase() === tag.toLowerCase()) ?? all.find((language) => primary(language) === primary(tag));
  for (const tag of [...(asked === null ? [] : [asked]), ...wanted]) {
    const found = nearest(tag);
    if (found !== undefined) return found;
  }
  return study.language;
}

/** A study with its words in the language in which it is read. */
export interface Reading extends Study {
  reading: string;
}

/** The study as it is read in a language. */
export const inLanguage = (study: Study, language: string): Reading => ({ ...study, ...(Object.hasOwn(study.translations, language) ? study.translations[language] : {}), reading: language });

const primary = (tag: string) => tag.split("-")[0]?.toLowerCase();
