/** Rows of estimates with their intervals on one axis: a label, a strip, the number. The strips stretch with the page. */
import { h, s } from "../shared/dom.ts";
import { number } from "./copy.ts";

export interface Strip {
  label: string;
  /** What the label's row is about, in smaller letters. */
  note?: string;
  /** A row that sums up those below it. */
  strong?: boolean;
  value: number | null;
  low: number | null;
  high: number | null;
  /** The numbers as text. */
  text: string;
}

export interface Axis {
  from: number;
  to: number;
  ticks: Array<[number, string]>;
  /** A value to compare with. */
  mark?: number;
  /** What the axis measures, with its unit. */
  name: string;
}

/** A figure of strips; `caption` says what dot and line are. */
export function strips(rows: readonly Strip[], axis: Axis, caption: string): HTMLElement {
  const at = (value: number) => `${(100 * Math.min(1, Math.max(0, (value - axis.from) / (axis.to - axis.from)))).toFixed(3)}%`;
  const strip = (row: Strip) => {
    const svg = s("svg", { class: "strip", role: "img", "aria-label": `${row.label}: ${row.text}` });
    if (axis.mark !== undefined) svg.append(s("line", { class: "chance", x1: at(axis.mark), x2: at(axis.mark), y1: 0, y2: "100%" }));
    const kind = row.strong === true ? "target" : "";
    if (row.low !== null && row.high !== null) svg.append(s("line", { class: `whisker ${kind}`, x1: at(row.low), x2: at(row.high), y1: "50%", y2: "50%" }));
    if (row.value !== null) svg.append(s("circle", { class: `dot ${kind}`, cx: at(row.value), cy: "50%", r: row.strong === true ? 6 : 4.5 }));
    return svg;
  };
  const scale = s("svg", { class: "strip scale", "aria-hidden": "true" });
  for (const [value, text] of axis.ticks) {
    const anchor = value === axis.from ? "start" : value === axis.to ? "end" : "middle";
    scale.append(s("line", { class: "axis", x1: at(value), x2: at(value), y1: 0, y2: 5 }), s("text", { class: "tick", x: at(value), y: 19, "text-anchor": anchor }, text));
  }
  const lines = rows.map((row) =>
    h(
      "div",
      { class: row.strong === true ? "strip-row strong" : "strip-row" },
      h("span", { class: "strip-label" }, row.label, ...(row.note === undefined ? [] : [h("span", { class: "quiet" }, row.note)])),
      strip(row),
      h("span", { class: "strip-value" }, number(row.text, row.value)),
    ),
  );
  return h(
    "figure",
    { class: "strips" },
    ...lines,
    h("div", { class: "strip-row axis-row" }, h("span", { class: "strip-label quiet" }, axis.name), scale, h("span", {})),
    h("figcaption", { class: "quiet" }, caption),
  );
}

/** Ticks at 1, 2 or 5 times a power of ten, about `wanted` of them, from 0 to at least `most`. */
export function niceTicks(most: number, wanted = 5): number[] {
  const raw = most / wanted;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = ([1, 2, 5, 10].find((m) => m * power >= raw) ?? 10) * power;
  return Array.from({ length: Math.ceil(most / step - 1e-9) + 1 }, (_, i) => Number((i * step).toPrecision(12)));
}
