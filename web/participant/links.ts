/** Web and e-mail addresses in a study's texts, as links. They are built as nodes, so a text can never become markup. */
import { h } from "../shared/dom.ts";

/** What scripts without blanks are written in, and what else parts their words: an address ends there (such a host can be written in its `xn--` form). */
const UNPARTED = "\\p{sc=Han}\\p{sc=Hiragana}\\p{sc=Katakana}\\p{sc=Thai}\\p{sc=Lao}\\p{sc=Khmer}\\p{sc=Myanmar}\\u3000-\\u303f\\u30fc\\uff00-\\uff65";
const LETTER = `(?:(?![${UNPARTED}])[\\p{L}\\p{N}])`;

/** What may be an address; punctuation at its end is the sentence's. Of an e-mail address's parts none is longer than mail allows, or looking for it would take ever longer. */
const ADDRESS = new RegExp(`(?:https?:\\/\\/|www\\.)[^\\s<>"“”«»${UNPARTED}]+|(?:${LETTER}|[._%+-]){1,64}@(?:${LETTER}|-){1,63}(?:\\.(?:${LETTER}|-){1,63})+`, "giu");
const PUNCTUATION = /[.,;:!?'’)\]}…،؛؟]$/u;

/** A stretch of a text: an address with where it leads, or what is none. */
export interface Piece {
  text: string;
  href: string | null;
}

/** A text in pieces. */
export function pieces(text: string): Piece[] {
  const found: Piece[] = [];
  let at = 0;
  for (const { 0: match, index } of text.matchAll(ADDRESS)) {
    const address = trimmed(match);
    const href = target(address);
    if (href === null) continue;
    found.push({ text: text.slice(at, index), href: null }, { text: address, href });
    at = index + address.length;
  }
  return [...found, { text: text.slice(at), href: null }].filter((piece) => piece.text !== "");
}

/** A paragraph's text, its addresses as links that open beside the study. */
export const linked = (text: string): Array<Node | string> => pieces(text).map((piece) => (piece.href === null ? piece.text : link(piece.text, piece.href)));

/** Paragraphs of a study's text. */
export const linkedParagraphs = (texts: readonly string[]): HTMLElement[] => texts.map((text) => h("p", {}, ...linked(text)));

function link(address: string, href: string): HTMLElement {
  const beside = href.startsWith("mailto:") ? {} : { target: "_blank", rel: "noopener noreferrer" };
  return h("a", { class: "link", href, dir: "ltr", ...beside }, address);
}

/** Without the punctuation at its end; a closing bracket is the address's where it was opened there. */
function trimmed(address: string): string {
  const count = (bracket: string) => address.split(bracket).length - 1;
  let spare = count(")") - count("(");
  let end = address.length;
  for (; end > 0 && PUNCTUATION.test(address.slice(end - 1, end)); end--) {
    if (address[end - 1] === ")" && spare-- <= 0) break;
  }
  return address.slice(0, end);
}

/** Where a link leads; null where it would be no web or e-mail address. */
export function target(address: string): string | null {
  const written = /^https?:/i.test(address) ? address : address.includes("@") && !/^www\./i.test(address) ? `mailto:${address}` : `https://${address}`;
  try {
    const url = new URL(written);
    return url.protocol === "mailto:" || url.hostname.includes(".") || url.hostname === "localhost" ? url.href : null;
  } catch {
    return null;
  }
}
