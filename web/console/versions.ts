/** A study's versions: whose answers are shown, and which are pooled. The choice stands in the address. */
import { h } from "../shared/dom.ts";
import { count, dateSpan } from "../shared/format.ts";
import type { Results, Selection, StudyVersion } from "./api.ts";
import { number } from "./copy.ts";

/** So many digits of a hash are shown and stand in addresses. */
const DIGITS = 12;
/** The least that names a version. */
const LEAST = 8;

export const short = (version: string) => version.slice(0, DIGITS);

/** What an address asks for: `?version=HASH&with=HASH,HASH`, each a hash or its beginning, or `with=all`. */
export function selectionOf(study: string, search: URLSearchParams, versions: readonly StudyVersion[]): Selection | { unknown: string } {
  const asked = search.get("version");
  const find = (name: string) => {
    const found = name.length < LEAST ? [] : versions.filter(({ version }) => version.startsWith(name));
    return found.length === 1 ? found[0] : undefined;
  };
  const named = asked === null || asked === "current" ? versions.find((version) => version.is_current) : find(asked);
  if (named === undefined && asked !== null && asked !== "current") return { unknown: asked };
  const others = versions.filter((version) => version !== named);
  const pool = search.get("with");
  const wanted = pool === "all" ? others.map(({ version }) => version) : (pool ?? "").split(",").filter((name) => name !== "");
  const unknown = wanted.find((name) => find(name) === undefined);
  if (unknown !== undefined) return { unknown };
  const pooled = wanted.flatMap((name) => find(name)?.version ?? []).filter((version) => version !== named?.version);
  return { study, version: named?.version ?? "current", pooled: [...new Set(pooled)] };
}

/** The console's address of a selection; of the current version alone it is the study's own. */
export function pageOf({ study, version, pooled }: Selection, versions: readonly StudyVersion[]): string {
  const current = version === "current" || versions.some((other) => other.is_current && other.version === version);
  const query = [...(current ? [] : [`version=${short(version)}`]), ...(pooled.length === 0 ? [] : [`with=${pooled.map(short).join(",")}`])].join("&");
  return `/console/studies/${encodeURIComponent(study)}${query === "" ? "" : `?${query}`}`;
}

/** The versions with their counts, and what is to be shown of them: one, and those that are pooled with it. */
export class VersionList {
  readonly element: HTMLElement;
  readonly #rows: Row[];

  constructor(selection: Selection, versions: readonly StudyVersion[], go: (address: string) => void) {
    this.#rows = versions.map((version) => row(version, selection));
    const word = (name: string) => h("th", { scope: "col", class: "word" }, name);
    const heads = [word("Version"), word("Pool with it"), ...COUNTS.map(([name]) => h("th", { scope: "col" }, name)), h("th", { scope: "col" }, "Served (UTC)")];
    const table = h("table", {}, h("thead", {}, h("tr", {}, ...heads)), h("tbody", {}, ...this.#rows.map(({ element }) => element)));
    const form = h(
      "form",
      {},
      h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table of versions" }, table),
      h("p", { class: "quiet" }, "A version is what a study asks and the pictures that it shows. Answers to different versions are pooled only where you ask for it."),
      h("p", {}, h("button", { class: "primary" }, "Show these answers")),
    );
    // A version is not pooled with itself.
    const settle = () => {
      for (const { chosen, pool } of this.#rows) pool.disabled = chosen.checked;
    };
    form.addEventListener("change", settle);
    settle();
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const version = this.#rows.find(({ chosen }) => chosen.checked)?.version ?? selection.version;
      const pooled = this.#rows.filter(({ chosen, pool }) => pool.checked && !chosen.checked).map(({ version }) => version);
      go(pageOf({ study: selection.study, version, pooled }, versions));
    });
    this.element = form;
  }

  /** New counts in place: what somebody is just choosing stays. */
  recount(versions: readonly StudyVersion[]): void {
    for (const { version, counts } of this.#rows) {
      const now = versions.find((other) => other.version === version);
      if (now === undefined) continue;
      for (const [i, cell] of counts.entries()) cell.replaceChildren(countOf(now, i));
    }
  }
}

const COUNTS: ReadonlyArray<[string, (version: StudyVersion) => number]> = [
  ["Completed", ({ participants }) => participants.completed],
  ["Started", ({ participants }) => participants.started],
  ["Answers", ({ answers }) => answers],
  ["Stimuli", ({ stimuli }) => stimuli],
];

const countOf = (version: StudyVersion, i: number) => {
  const n = COUNTS[i]?.[1](version) ?? 0;
  return number(n.toLocaleString("en"), n);
};

interface Row {
  version: string;
  element: HTMLElement;
  chosen: HTMLInputElement;
  pool: HTMLInputElement;
  counts: HTMLElement[];
}

function row(version: StudyVersion, selection: Selection): Row {
  const { version: hash, is_current, first_served_at, last_served_at } = version;
  const chosen = h("input", { type: "radio", name: "version", value: hash, checked: hash === selection.version });
  const pool = h("input", { type: "checkbox", name: "with", value: hash, checked: selection.pooled.includes(hash), "aria-label": `Pool the answers of version ${short(hash)}` });
  const counts = COUNTS.map((_, i) => h("td", {}, countOf(version, i)));
  const element = h(
    "tr",
    { "data-testid": `version-${short(hash)}` },
    h("th", { scope: "row" }, h("label", { class: "choice" }, chosen, h("code", { title: hash }, short(hash)), ...(is_current ? [h("span", { class: "note" }, "current")] : []))),
    h("td", { class: "word" }, h("label", { class: "choice" }, pool)),
    ...counts,
    h("td", {}, dateSpan(first_served_at, last_served_at)),
  );
  return { version: hash, element, chosen, pool, counts };
}

/** Says what the numbers on the page are of, where that isn't simply the current version. */
export function pooledBanner({ version, pooled, different_stimuli }: Pick<Results, "version" | "pooled" | "different_stimuli">, versions: readonly StudyVersion[]): Node[] {
  const old = versions.some((other) => other.version === version && !other.is_current);
  if (pooled.length < 2 && !old) return [];
  const part = ({ version, sessions, answers }: Results["pooled"][number]) =>
    h("li", {}, h("code", { title: version }, short(version)), `: ${count(sessions, "participant")}, ${count(answers, "answer")}`);
  const differing = different_stimuli.map(({ item, condition, versions }) =>
    h("li", {}, `${item}, ${condition}: other pixels in `, ...versions.flatMap((hash, i) => [i > 0 ? ", " : "", h("code", { title: hash }, short(hash))])),
  );
  const what =
    pooled.length < 2
      ? [h("p", {}, "These are the answers of version ", h("code", { title: version }, short(version)), ", which is not the current one.")]
      : [h("p", {}, `The answers of ${pooled.length} versions are pooled here, judged by the rules of the first:`), h("ul", {}, ...pooled.map(part))];
  const stimuli =
    pooled.length < 2
      ? []
      : differing.length === 0
        ? [h("p", {}, "All of them showed the same stimuli.")]
        : [h("p", {}, h("strong", {}, "They did not all show the same:")), h("ul", {}, ...differing)];
  return [h("div", { class: "banner", role: "status", "data-testid": "pooled" }, ...what, ...stimuli)];
}
