/** The pages of text: what they say, and what can be done there. */
import { h, paragraphs } from "../shared/dom.ts";
import type { Completion, Study } from "./api.ts";
import { copied } from "./copy.ts";
import { languages, type Reading } from "./language.ts";
import { legendsContent } from "./legend.ts";
import { linkedParagraphs } from "./links.ts";
import { hush } from "./notice.ts";
import { showPage } from "./text-page.ts";
import type { TrialModule } from "./trials/module.ts";
import { direction, words } from "./words/index.ts";

/** Where everything but `notice` is shown. */
export const display = h("main", { id: "study" });

/** A page that ends the visit, with at most one thing to do. */
export function lastPage(heading: string, texts: string[], action?: HTMLElement): void {
  hush();
  const screen = h("div", {});
  display.replaceChildren(screen);
  showPage(screen, heading, paragraphs(texts), action);
  document.title = heading;
}

/** An error that a participant meets as a page of its own, with what to do. */
export class Ended extends Error {
  readonly heading: string;
  readonly texts: string[];

  constructor(heading: string, texts: string[], cause?: unknown) {
    super(`${heading}: ${texts.join(" ")}`, { cause });
    this.heading = heading;
    this.texts = texts;
  }
}

/** An action's button. */
export function action(label: string, onclick: () => void): HTMLButtonElement {
  return h("button", { type: "button", class: "action", onclick: () => onclick() }, label);
}

/** What taking part means; where the language may still be chosen, in which. */
export function consentContent(study: Reading, choosing: boolean): Node[] {
  const { texts, estimated_minutes } = study;
  const print_ = h("button", { type: "button", class: "link", onclick: () => print() }, words("consent-print"));
  return [
    ...(choosing ? languageSwitch(study) : []),
    ...linkedParagraphs(texts.welcome),
    h("p", { "data-testid": "minutes" }, words("consent-minutes", { minutes: estimated_minutes })),
    h("h2", {}, words("consent-title")),
    ...linkedParagraphs(texts.consent),
    h("p", { class: "quiet" }, words("consent-decline"), " ", print_),
  ];
}

/** The study's languages, as links to itself; none where there is one. */
function languageSwitch(study: Reading): Node[] {
  const all = languages(study);
  if (all.length < 2) return [];
  const link = (language: string) => {
    const query = new URLSearchParams(location.search);
    query.set("lang", language);
    const current = study.reading === language ? "true" : null;
    return h("a", { class: "link", href: `?${query}`, lang: language, hreflang: language, dir: direction(language), "aria-current": current }, nameOf(language));
  };
  return [h("nav", { class: "languages", "aria-label": words("language-switch") }, ...all.map(link))];
}

/** What a language calls itself; its tag where the browser takes it for none. */
function nameOf(language: string): string {
  try {
    return new Intl.DisplayNames([language], { type: "language" }).of(language) ?? language;
  } catch {
    return language;
  }
}

/** The study's instructions, and how to answer each of its kinds of trial. */
export function instructionsContent(study: Study, legends: readonly TrialModule["legend"][]): Node[] {
  return [...linkedParagraphs(study.texts.instructions), legendsContent(study, legends)];
}

/** The last page of a visit that came to its end. */
export function showThanks(screen: HTMLElement, { texts }: Study, { completion_code, redirect }: Completion): void {
  const code = h("output", { class: "code", translate: "no", dir: "ltr", "data-testid": "completion-code", "aria-label": words("code-label") }, completion_code);
  const target = safeRedirect(redirect);
  const action =
    target !== null ? h("a", { class: "action", href: target.href, rel: "noreferrer" }, words("return-to", { host: target.hostname.replace(/^(app|www)\./, "") })) : copyButton(completion_code);
  const content = [
    ...linkedParagraphs(texts.thanks),
    h("div", { class: "receipt" }, h("p", { class: "quiet" }, words("code-stored")), code),
    h("h2", {}, words("about-title")),
    ...linkedParagraphs(texts.debriefing),
  ];
  showPage(screen, words("thanks-title"), content, action);
}

/** Says which answers the server won't store; resolves when the participant wants to try again. */
export function askAgain(screen: HTMLElement, refused: readonly string[], session: string): Promise<void> {
  const reasons = [...new Set(refused)].join(" ");
  const content = paragraphs([words("missing", { count: refused.length }), words("missing-report", { reasons, session })]);
  return new Promise((resolve) => showPage(screen, words("missing-title"), content, action(words("try-again"), resolve)));
}

function copyButton(text: string): HTMLButtonElement {
  const button = h("button", { type: "button", class: "action" }, words("code-copy"));
  button.addEventListener("click", async () => {
    button.textContent = words((await copied(text)) ? "code-copied" : "code-select");
  });
  return button;
}

/** A panel's return address, if it is a web address at all. */
function safeRedirect(redirect: string | null | undefined): URL | null {
  try {
    const url = new URL(redirect ?? "");
    return url.protocol === "https:" || url.protocol === "http:" ? url : null;
  } catch {
    return null;
  }
}
