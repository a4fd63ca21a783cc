/** What participants chose: a figure and a row for each block. */
import { h } from "../shared/dom.ts";
import { count, fixed, pValue } from "../shared/format.ts";
import type { Block, Results } from "./api.ts";
import { copyButton, number, tableText } from "./copy.ts";
import { choiceDistribution } from "./plots.ts";

export function choices({ blocks, scale, standing }: Pick<Results, "blocks" | "scale" | "standing">): Node[] {
  const table = resultsTable(blocks);
  return [
    h("h2", {}, "Choices"),
    h("div", { class: "plots" }, ...blocks.map((block) => blockFigure(block, standing.summary))),
    h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table of choices" }, table),
    h(
      "p",
      { class: "quiet" },
      "Number of choices of the target per participant, over those who answered every pair of the block. Two-tailed one-sample t-test against chance, half the pairs. ",
      copyButton("Copy the table", () => tableText(table), { class: "link" }),
    ),
    ...(scale ? [positions(scale)] : []),
  ];
}

/** The conditions' positions in words, best first: they are there at once, where the report takes its time. */
function positions(scale: NonNullable<Results["scale"]>): HTMLElement {
  const best = scale.conditions.map((name, i) => ({ name, jod: scale.jod[i] ?? 0 })).sort((a, b) => b.jod - a.jod);
  const shown = best.flatMap(({ name, jod }, i) => [i > 0 ? ", " : "", `${name} `, number(fixed(jod, 2), jod)]);
  return h("p", { "data-testid": "scale" }, "All conditions on one scale, in JOD: ", ...shown, ".");
}

/** A block nobody of those judged has answered has no plot; why, the counts say. */
function blockFigure(block: Block, summary: string): HTMLElement {
  const what = `${block.conditions.join(" against ")}, ${count(block.items, "pair")} of ${block.kind === "still" ? "stills" : "animations"}, ${block.layout}`;
  const plot =
    block.n > 0 ? choiceDistribution(block) : h("p", { class: "empty" }, block.incomplete > 0 ? `0 of those judged answered every pair of this block, ${block.incomplete} answered some.` : summary);
  return h("figure", { class: "block" }, h("figcaption", {}, h("strong", {}, block.title), h("span", { class: "quiet" }, what)), plot);
}

function resultsTable(blocks: readonly Block[]): HTMLTableElement {
  const heads = ["Block", "Target", "n", "Mean", "SD", "Chance", "t", "df", "p"];
  const row = (block: Block) => {
    const cell = (text: string, exact: number | null | undefined) => h("td", {}, number(text, exact));
    const hooks = { "data-testid": `block-${block.id}`, "data-n": block.n, "data-mean": block.mean, "data-sd": block.sd, "data-t": block.t, "data-df": block.df, "data-p": block.p };
    return h(
      "tr",
      hooks,
      h("th", { scope: "row" }, block.title, ...(block.note ? [h("span", { class: "note" }, block.note)] : [])),
      h("td", { class: "word" }, block.target),
      cell(String(block.n), block.n),
      cell(fixed(block.mean, 3), block.mean),
      cell(fixed(block.sd, 3), block.sd),
      cell(fixed(block.mu, 1), block.mu),
      cell(fixed(block.t, 3), block.t),
      cell(String(block.df ?? "–"), block.df),
      cell(pValue(block.p), block.p),
    );
  };
  const head = h("thead", {}, h("tr", {}, ...heads.map((name, i) => h("th", { scope: "col", class: i < 2 ? "word" : null }, name))));
  return h("table", {}, head, h("tbody", {}, ...blocks.map(row)));
}
