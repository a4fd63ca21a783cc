/** The paper that the built-in study follows: its three tests computed again, and what they leave out. */
import { h } from "../shared/dom.ts";
import { fixed, interval, pValue, significant } from "../shared/format.ts";
import type { Comparison, Paper } from "./api.ts";
import { copyButton, number, tableText } from "./copy.ts";

/** The study that has the paper beside it. */
export const PAPER_STUDY = "shadow-puppets";

/** The paper's comparisons across, statistics down. */
export function drawPaper({ comparisons, printed_t }: Paper): Node[] {
  const one = (decimals: number, of: (c: Comparison) => number) => (c: Comparison) => [number(fixed(of(c), decimals), of(c))];
  const p = (of: (c: Comparison) => number) => (c: Comparison) => [number(pValue(of(c)), of(c))];
  const rows: Array<[string, string, (c: Comparison) => Node[]]> = [
    ["Chose PA", "how often: how many participants", (c) => [h("span", {}, c.counts.map(([choices, people]) => `${choices}: ${people}`).join(", "))]],
    ["Participants", "", one(0, (c) => c.test.n)],
    ["Mean (SD)", "as printed", (c) => [number(fixed(c.printed.mean, 3), c.printed.mean), number(` (${fixed(c.printed.sd, 3)})`, c.printed.sd)]],
    ["t", "as printed", one(3, (c) => c.printed.t)],
    ["t", "of the counts", one(3, (c) => c.test.t)],
    ["p", "two-tailed", p((c) => c.test.p)],
    ["p after Holm", "for three tests", p((c) => c.p_holm)],
    [
      "Hedges' g",
      "95% interval",
      (c) => [number(fixed(c.effect.g, 3), c.effect.g), number(` (${interval(c.effect.g_interval.low, c.effect.g_interval.high, 3)})`, `${c.effect.g_interval.low} ${c.effect.g_interval.high}`)],
    ],
    ["Equivalent within ±0.5 choices", "p of two one-sided tests", p((c) => c.equivalence_points.p)],
    ["Equivalent within ±0.5 SD", "p of two one-sided tests", p((c) => c.equivalence_sd.p)],
    ["Bayes factor BF₀₁", "for no effect; JZS", (c) => [number(significant(c.bayes.bf01), c.bayes.bf01)]],
  ];
  const table = h(
    "table",
    { class: "statistics" },
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        h("th", { scope: "col", class: "word" }, "Statistic"),
        ...comparisons.map((c) => h("th", { scope: "col", "data-testid": `paper-${c.id}`, "data-t": c.test.t, "data-p": c.test.p }, c.title)),
      ),
    ),
    h(
      "tbody",
      {},
      ...rows.map(([name, about, cells]) =>
        h("tr", {}, h("th", { scope: "row" }, name, ...(about === "" ? [] : [h("span", { class: "note" }, about)])), ...comparisons.map((c) => h("td", {}, ...cells(c)))),
      ),
    ),
  );
  return [
    h("h2", {}, "The paper, judged again"),
    h("p", { class: "quiet" }, "Taylor & Cameron's survey, from the counts that their printed means and standard deviations imply."),
    h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "The paper's tests" }, table),
    ...comparisons.filter((c) => !c.t_as_printed).map((c) => h("p", { class: "banner" }, ...remark(c, printed_t))),
    h(
      "p",
      { class: "quiet" },
      copyButton("Copy the table", () => tableText(table), { class: "link" }),
    ),
  ];
}

/** What is wrong with a printed t, from the search for data that could give it. */
function remark(c: Comparison, { participants: [from, to], splits_with_this_t: splits, printed }: Paper["printed_t"]): Array<Node | string> {
  const chosen = c.counts.reduce((sum, [choices, people]) => sum + choices * people, 0);
  const none = printed === c.printed.t && splits.length === 0 ? ` No whole number of participants from ${from} to ${to} gives ${fixed(printed, 3)}, whatever they chose.` : "";
  return [`The printed t of ${fixed(c.printed.t, 3)} does not follow from the printed mean and standard deviation: ${chosen} of ${c.test.n} give `, number(fixed(c.test.t, 3), c.test.t), `.${none}`];
}
