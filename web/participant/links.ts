/** Web and e-mail addresses in a study's texts, as links. They are built as nodes, so a text can never become markup. */
import { h } from "../shared/dom.ts";

/** What may be an address; punctuation at its end is the sentence's. */
const ADDRESS = /(?:https?:\/\/|www\.)[^\s<>"“”«»]+|[\p{L}\p{N}._%+-]+@[\p{L}\p{N}-]+(?:\.[\p{L}\p{N}-]+)+/giu;
const PUNCTUATION = /[.,;:!?'’)\]}…،؛؟]$/u;

/** A paragraph's text, its addresses as links that open beside the study. */
export function linked(text: string): Array<Node | string> {
  const parts: Array<Node | string> = [];
  let at = 0;
  for (const { 0: found, index } of text.matchAll(ADDRESS)) {
    const address = trimmed(found);
    const href = target(address);
    if (href === null) continue;
    parts.push(text.slice(at, index), link(address, href));
    at = index + address.length;
  }
  return [...parts, text.slice(at)].filter((part) => part !== "");
}

/** Paragraphs of a study's text. */
export const linkedParagraphs = (texts: readonly string[]): HTMLElement[] => texts.map((text) => h("p", {}, ...linked(text)));

function link(address: string, href: string): HTMLElement {
  const beside = href.startsWith("mailto:") ? {} : { target: "_blank", rel: "noopener noreferrer" };
  return h("a", { class: "link", href, dir: "ltr", ...beside }, address);
}

/** Without the punctuation at its end; a closing bracket is the address's where it was opened there. */
function trimmed(address: string): string {
  const count = (bracket: string) => address.split(bracket).length;
  const own = address.endsWith(")") && count("(") >= count(")");
  return PUNCTUATION.test(address) && !own ? trimmed(address.slice(0, -1)) : address;
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
