/** How answers are given on the device and in the window that are there; said once, on the page of instructions. */
import { h } from "../shared/dom.ts";
import type { Study } from "./api.ts";
import type { Legend, TrialModule } from "./trials/module.ts";
import { words } from "./words/index.ts";

/** Whether there is nothing to answer with but a finger. A keyboard can't be asked for: what points finely, or hovers, mostly has one. */
const onlyTouch = () => matchMedia("(any-pointer: coarse)").matches && !matchMedia("(any-pointer: fine)").matches && !matchMedia("(any-hover: hover)").matches;

/** The legends of a study's kinds of trial, kept true while the window changes. */
export function legendsContent(study: Study, kinds: readonly TrialModule["legend"][]): HTMLElement {
  const box = h("div", { class: "legends" });
  const write = () => box.replaceChildren(...kinds.flatMap((kind) => content(typeof kind === "function" ? kind(study) : kind, kinds.length > 1)));
  const listening = new AbortController();
  write();
  addEventListener("resize", () => (box.isConnected ? write() : listening.abort()), { signal: listening.signal });
  return box;
}

function content(legend: Legend, named: boolean): HTMLElement[] {
  const title = named ? [h("h2", { class: "kind" }, words(legend.title))] : [];
  const how = legend.how === undefined ? [] : [h("p", { class: "how" }, words(onlyTouch() ? legend.how.touch : legend.how.click))];
  return [...title, ...how, ...(onlyTouch() ? [] : [keys(legend)])];
}

function keys({ answers, stacked }: Legend): HTMLElement {
  const side = ({ keys, label }: Legend["answers"][number]) => {
    const names = keys.flatMap((key, i) => [...(i > 0 ? [` ${words("key-or")} `] : []), h("kbd", {}, key)]);
    return h("div", { class: "side" }, h("span", { class: "sketch", "aria-hidden": "true" }), h("span", {}, ...names, ` ${words(label)}`));
  };
  return h("div", { class: stacked === true ? "keys stacked" : "keys" }, ...answers.map(side));
}
