/** The pages of text: what they say, and what can be done there. */
import { h, paragraphs } from "../shared/dom.ts";
import type { Completion, Study } from "./api.ts";
import { showPage } from "./text-page.ts";
import type { Legend } from "./trials/module.ts";

/** Where everything but `notice` is shown. */
export const display = h("main", { id: "study" });

/** A page that ends the visit, with at most one thing to do. */
export function lastPage(heading: string, texts: string[], action?: HTMLElement): void {
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

/** "Nothing is lost" where a page has to be loaded again. */
export const KEPT = "Answers you have given are stored or kept in this browser; reloading goes on from there.";

/** An action's button. */
export function action(label: string, onclick: () => void): HTMLButtonElement {
  return h("button", { type: "button", class: "action", onclick: () => onclick() }, label);
}

export function consentContent({ texts }: Study): Node[] {
  const print_ = h("button", { type: "button", class: "link", onclick: () => print() }, "Print this page");
  return [
    ...paragraphs(texts.welcome),
    h("h2", {}, "Your consent"),
    ...paragraphs(texts.consent),
    h("p", { class: "quiet" }, "If you would rather not take part, close this page: nothing has been stored. ", print_),
  ];
}

/** The study's instructions, and the keys of each of its kinds of trial, shown once. */
export function instructionsContent({ texts }: Study, legends: readonly Legend[]): Node[] {
  const several = legends.length > 1;
  return [...paragraphs(texts.instructions), ...legends.flatMap((legend) => [...(several ? [h("h2", { class: "kind" }, legend.title)] : []), keys(legend)])];
}

function keys({ answers }: Legend): HTMLElement {
  const side = ({ keys, label }: Legend["answers"][number]) => {
    const names = keys.flatMap((key, i) => [...(i > 0 ? [" or "] : []), h("kbd", {}, key)]);
    return h("div", { class: "side" }, h("span", { class: "sketch", "aria-hidden": "true" }), h("span", {}, ...names, ` ${label}`));
  };
  return h("div", { class: "keys" }, ...answers.map(side));
}

/** The last page of a visit that came to its end. */
export function showThanks(screen: HTMLElement, { texts }: Study, { completion_code, redirect }: Completion): void {
  const code = h("output", { class: "code", "data-testid": "completion-code", "aria-label": "Your completion code" }, completion_code);
  const target = safeRedirect(redirect);
  const action =
    target !== null
      ? h("a", { class: "action", href: target.href, rel: "noreferrer" }, `Return to ${target.hostname.replace(/^(app|www)\./, "")}`)
      : copyButton(completion_code);
  const content = [
    ...paragraphs(texts.thanks),
    h("div", { class: "receipt" }, h("p", { class: "quiet" }, "All your answers are stored. Your completion code:"), code),
    h("h2", {}, "What this study is about"),
    ...paragraphs(texts.debriefing),
  ];
  showPage(screen, "Thank you", content, action);
}

/** Says which answers the server won't store; resolves when the participant wants to try again. */
export function askAgain(screen: HTMLElement, refused: readonly string[], session: string): Promise<void> {
  const one = refused.length === 1;
  const reasons = [...new Set(refused)].join(" ");
  const content = paragraphs([
    `${one ? "One answer" : `${refused.length} answers`} could not be stored, so there is no completion code yet. Nothing is lost: ${one ? "it is" : "they are"} kept in this browser.`,
    `If trying again does not help, please send the researchers this text: ${reasons} Session ${session}.`,
  ]);
  return new Promise((resolve) => showPage(screen, "One thing is missing", content, action("Try again", resolve)));
}

/** Asks whether to go on here, where another tab has the study open. */
export function askToTakeOver(): Promise<void> {
  return new Promise((resolve) => {
    lastPage("This study is open in another tab", ["Please go on there, or continue in this one from where you are."], action("Continue here", resolve));
  });
}

function copyButton(text: string): HTMLButtonElement {
  const button = h("button", { type: "button", class: "action" }, "Copy the code");
  button.addEventListener("click", () => {
    void navigator.clipboard?.writeText(text).then(
      () => (button.textContent = "Copied"),
      () => (button.textContent = "Please select the code and copy it"),
    );
  });
  return button;
}

/** A panel's return address, if it is a web address at all. */
function safeRedirect(redirect: string | null | undefined): URL | null {
  if (redirect === null || redirect === undefined || !URL.canParse(redirect)) return null;
  const url = new URL(redirect);
  return url.protocol === "https:" || url.protocol === "http:" ? url : null;
}
