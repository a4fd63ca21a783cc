/** What the t-test leaves out: how large, how sure, how equivalent, and what a reader must not conclude. */
import { h } from "../shared/dom.ts";
import { count, fixed, interval, pValue, significant } from "../shared/format.ts";
import type { BlockReport, Coefficient, Interval, Proportion, Report } from "./api.ts";
import { copyButton, number, tableText } from "./copy.ts";
import { smallest } from "./gallery.ts";
import { errorPlot, points } from "./scatter.ts";
import { niceTicks, type Strip, strips } from "./strips.ts";

type Bounds = Pick<Interval, "low" | "high">;

const percent = (x: number) => `${fixed(100 * x, 0)}%`;

/** Every part of the report that has something to say; `width` is the room for plots, CSS pixels. */
export function drawReport(report: Report, width: number): Node[] {
  const answered = report.blocks.filter((block) => block.n > 0 || block.by_item.some((pair) => pair.target));
  if (answered.length === 0) return [h("h2", {}, "Beyond the t-test"), h("p", { class: "empty" }, "Effect sizes, intervals, equivalence and Bayes factors appear here with the first answers.")];
  return [
    h("h2", {}, "Beyond the t-test"),
    ...preferences(answered),
    ...times(answered),
    ...errors(answered, report, width),
    ...statistics(report),
    ...notes(report.blocks),
    ...scale(report),
    ...exclusions(report),
    ...methods(report),
  ];
}

/** How many preferred the target: each block over all its choices, then each pair alone. */
function preferences(blocks: readonly BlockReport[]): Node[] {
  const row = (label: string, share: Proportion | null | undefined, more: Partial<Strip>): Strip => {
    const bounds = share?.by_participant ?? share?.wilson;
    const text = !share ? "no answers" : `${percent(share.proportion)}, ${percent(bounds?.low ?? NaN)} to ${percent(bounds?.high ?? NaN)}`;
    return { label, value: share?.proportion ?? null, low: bounds?.low ?? null, high: bounds?.high ?? null, text, ...more };
  };
  const rows = blocks.flatMap((block) => [
    row(block.title, block.analysis.proportion, { strong: true, note: `chose ${block.target}` }),
    ...(block.by_item.length > 1 ? block.by_item.map((pair) => row(pair.id, pair.target, {})) : []),
  ]);
  const axis = { from: 0, to: 1, mark: 0.5, name: "share of choices", ticks: [0, 0.25, 0.5, 0.75, 1].map((t): [number, string] => [t, percent(t)]) };
  return [h("h3", {}, "Who preferred what"), strips(rows, axis, "Dot: share of choices. Line: 95% interval; of a block from resampled participants, of a pair Wilson's. Dotted: chance.")];
}

function times(blocks: readonly BlockReport[]): Node[] {
  const rows = blocks.flatMap((block): Strip[] => {
    if (!block.rt_ms) return [];
    const [q1, median, q3] = [block.rt_ms.q1, block.rt_ms.median, block.rt_ms.q3].map((ms) => ms / 1000) as [number, number, number];
    return [{ label: block.title, value: median, low: q1, high: q3, text: `${fixed(median, 2)} s, ${fixed(q1, 2)} to ${fixed(q3, 2)}` }];
  });
  if (rows.length === 0) return [];
  const ticks = niceTicks(Math.max(...rows.map((row) => row.high ?? 0), 0.001));
  const axis = { from: 0, to: ticks.at(-1) ?? 1, name: "response time, s", ticks: ticks.map((t): [number, string] => [t, String(t)]) };
  return [h("h3", {}, "How long they took"), strips(rows, axis, "Dot: median of the trials. Line: the middle half of them.")];
}

function errors(blocks: readonly BlockReport[], report: Report, width: number): Node[] {
  const all = points(blocks, smallest(report.stimuli));
  const heading = h("h3", {}, "Error and preference");
  if (all.length === 0) return [heading, h("p", { class: "empty" }, "No stimulus with answers has a measured error yet.")];
  return [
    heading,
    h(
      "figure",
      { class: "wide" },
      errorPlot(all, width),
      h(
        "figcaption",
        { class: "quiet" },
        "Each stimulus: its error against the reference (of simulated photographs before the camera), and the share that preferred it with Wilson's 95% interval. Lines join the two of a pair, named at the target's. Dotted: chance.",
      ),
    ),
  ];
}

/** Statistics down, blocks across. */
function statistics(report: Report): Node[] {
  const { blocks } = report;
  const everybody = report.blocks_with_excluded ?? null;
  const within = (bounds: Bounds | null | undefined, decimals: number) => (bounds ? ` (${interval(bounds.low, bounds.high, decimals)})` : "");
  const estimate = (x: number | null | undefined, bounds: Bounds | null | undefined, decimals = 2) => [
    number(fixed(x, decimals), x),
    number(within(bounds, decimals), bounds ? `${bounds.low} ${bounds.high}` : null),
  ];
  const logit = (c: Coefficient | undefined) => (c === undefined ? [number("–", null)] : [...estimate(c.estimate, c), h("span", { class: "quiet" }, ", p ", number(pValue(c.p), c.p))]);
  const tost = (block: BlockReport, unit: "points" | "sd") => {
    const found = block.analysis.equivalence.find((e) => unit in e.bounds);
    return [number(pValue(found?.p), found?.p)];
  };
  const rows: Array<[string, string, (block: BlockReport, i: number) => Node[]]> = [
    ["t (df), p", "two-tailed, the paper's test", (b) => [number(`${fixed(b.t, 3)} (${b.df ?? "–"})`, b.t), ", p ", number(pValue(b.p), b.p)].map(asNode)],
    ["p after Holm", "for this number of blocks", (b) => [number(pValue(b.p_holm), b.p_holm)]],
    ["Cohen's d", "95% interval, noncentral t", (b) => estimate(b.analysis.effect?.d, b.analysis.effect?.d_interval)],
    ["Hedges' g", "unbiased, 95% interval", (b) => estimate(b.analysis.effect?.g, b.analysis.effect?.g_interval, 3)],
    ["Equivalent within ±0.5 choices", "p of two one-sided tests", (b) => tost(b, "points")],
    ["Equivalent within ±0.5 SD", "p of two one-sided tests", (b) => tost(b, "sd")],
    ["Bayes factor BF₀₁", "for no effect; JZS", (b) => [number(significant(b.analysis.bayes?.bf01), b.analysis.bayes?.bf01)]],
    ["Sign test", "p, without normality", (b) => [number(pValue(b.analysis.sign?.p), b.analysis.sign?.p)]],
    ["Wilcoxon's signed ranks", "p, ties exact", (b) => [number(pValue(b.analysis.wilcoxon?.p), b.analysis.wilcoxon?.p)]],
    ["Share of target choices", "95% interval, resampled participants", (b) => estimate(b.analysis.proportion?.proportion, b.analysis.proportion?.by_participant ?? b.analysis.proportion?.wilson, 3)],
    ["Intraclass correlation", "how alike one participant's choices are", (b) => [number(fixed(b.analysis.intraclass?.icc, 3), b.analysis.intraclass?.icc)]],
    ["Log odds, cluster-robust", "95% interval", (b) => logit(b.analysis.robust_logit?.coefficients[0])],
    ["Log odds, random intercept", "95% interval", (b) => logit(b.analysis.mixed_logit?.coefficients[0])],
    [firstRole(blocks), "far from 0.5: a bias of side or order", (b) => estimate(b.first?.proportion, b.first?.wilson, 3)],
    ["Power at d = 0.2, 0.5, 0.8", "with this n", (b) => b.analysis.power.flatMap((plan, i) => [...(i > 0 ? [asNode(", ")] : []), number(fixed(plan.power, 2), plan.power)])],
    ["Found with 80% power", "true effect in SD, with this n", (b) => [number(fixed(b.analysis.detectable?.d, 2), b.analysis.detectable?.d)]],
    ...(everybody === null
      ? []
      : [
          [
            "t, p with the excluded",
            "everybody's answers",
            (_: BlockReport, i: number) => [number(fixed(everybody[i]?.t, 3), everybody[i]?.t), ", p ", number(pValue(everybody[i]?.p), everybody[i]?.p)].map(asNode),
          ] as [string, string, (block: BlockReport, i: number) => Node[]],
        ]),
  ];
  const hooks = (block: BlockReport) => ({ "data-testid": `report-${block.id}`, "data-p-holm": block.p_holm, "data-g": block.analysis.effect?.g, "data-bf01": block.analysis.bayes?.bf01 });
  const table = h(
    "table",
    { class: "statistics" },
    h("thead", {}, h("tr", {}, h("th", { scope: "col", class: "word" }, "Statistic"), ...blocks.map((block) => h("th", { scope: "col", ...hooks(block) }, block.title)))),
    h(
      "tbody",
      {},
      ...rows.map(([name, about, cells]) => h("tr", {}, h("th", { scope: "row" }, name, h("span", { class: "note" }, about)), ...blocks.map((block, i) => h("td", {}, ...cells(block, i))))),
    ),
  );
  return [
    h("h3", {}, "Every number"),
    h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table of statistics" }, table),
    h(
      "p",
      { class: "quiet" },
      copyButton("Copy the table", () => tableText(table), { class: "link" }),
    ),
  ];
}

/** What the share of the first role is of: the left picture, the first one, or either where a study has both kinds of trial. */
function firstRole(blocks: readonly BlockReport[]): string {
  const roles = new Set(blocks.map((block) => block.first_role));
  return `Chose the ${[...roles].join(" or the ")} picture`;
}

const asNode = (part: Node | string): Node => (typeof part === "string" ? document.createTextNode(part) : part);

function notes(blocks: readonly BlockReport[]): Node[] {
  const items = blocks
    .filter((block) => block.analysis.notes.length > 0)
    .map((block) => h("li", {}, h("strong", {}, block.title), ...block.analysis.notes.map((note) => h("span", { class: "warning" }, note))));
  return items.length === 0 ? [] : [h("h3", {}, "Read with care"), h("ul", { class: "notes" }, ...items)];
}

function scale({ scale: found, scale_note }: Report): Node[] {
  const heading = h("h3", {}, "All conditions on one scale");
  if (!found) return !scale_note ? [] : [heading, h("p", { class: "quiet" }, scale_note)];
  const rows = found.conditions.map(({ condition, jod, low, high }): Strip => ({ label: condition, value: jod, low, high, text: `${fixed(jod, 2)}, ${interval(low, high, 2)}` }));
  const reach = niceTicks(Math.max(...rows.flatMap((row) => [Math.abs(row.low ?? 0), Math.abs(row.high ?? 0)]), 0.1), 3);
  const ticks = [
    ...reach
      .slice(1)
      .map((t) => -t)
      .reverse(),
    ...reach,
  ];
  const axis = { from: ticks[0] ?? -1, to: ticks.at(-1) ?? 1, mark: 0, name: "JOD", ticks: ticks.map((t): [number, string] => [t, fixed(t, Number.isInteger(t) ? 0 : 1)]) };
  return [
    heading,
    strips(
      rows,
      axis,
      `Just-objectionable differences; more is chosen more often, and 1 JOD apart is chosen by 75%. Lines: ${percent(found.level)} intervals from ${count(found.replicates, "resample")} of ${count(found.observers, "participant")}. Overlap of intervals is no test.`,
    ),
  ];
}

function exclusions({ excluded }: Report): Node[] {
  if (excluded.length === 0) return [];
  const items = excluded.map(({ session_id, why }) => h("li", {}, number(session_id.slice(0, 13), session_id), `: ${why}`));
  return [h("h3", {}, `${count(excluded.length, "participant")} left out by the study's rules`), h("ul", {}, ...items)];
}

function methods({ methods: texts, kelir_version, chain }: Report): Node[] {
  const whole = texts.join(" ");
  const judged = ` Judged by kelir ${kelir_version}.`;
  return [
    h(
      "details",
      { class: "methods" },
      h("summary", {}, "Methods, as a paper's section"),
      ...texts.map((text) => h("p", {}, text)),
      h(
        "p",
        {},
        copyButton("Copy the text", () => whole, { class: "link" }),
      ),
    ),
    ...(chain.faults.length === 0
      ? [
          h(
            "p",
            { class: "quiet" },
            `All ${count(chain.rows, "stored answer")} are what was written, in order (chain ends in `,
            number(chain.head.slice(0, 12), chain.head),
            ").",
            ...blanked(chain),
            judged,
          ),
        ]
      : [
          h(
            "div",
            { class: "banner" },
            h("p", {}, "Not all stored rows are what was written. Do not use these data before you know why."),
            h("ul", {}, ...chain.faults.map(fault)),
            h("p", {}, judged),
          ),
        ]),
  ];
}

const blanked = ({ blanked: n }: Report["chain"]) => (n > 0 ? [` ${count(n, "payload")} blanked by a withdrawal.`] : []);

const fault = ({ chain, seq, what, note }: Report["chain"]["faults"][number]) => h("li", {}, `${chain}, row ${seq}: ${what}${note ? ` (${note})` : ""}`);
