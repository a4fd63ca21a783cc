/** How wrong a picture is against how many prefer it. */
import { s } from "../shared/dom.ts";
import { fixed, significant } from "../shared/format.ts";
import type { BlockReport, Stimulus } from "./api.ts";
import { placed } from "./labels.ts";
import { figure } from "./plots.ts";
import { measuredError } from "./provenance.ts";

interface Point {
  item: string;
  condition: string;
  target: boolean;
  error: number;
  share: number;
  interval: { low: number; high: number };
}

/** Every stimulus with a measured error and answers: its RMSE in penumbra, and the share of participants who preferred it. */
export function points(blocks: readonly BlockReport[], stimuli: readonly Stimulus[]): Point[] {
  return blocks.flatMap((block) =>
    block.by_item.flatMap(({ id, target }) =>
      stimuli
        .filter((stimulus) => stimulus.item === id && block.conditions.includes(stimulus.condition))
        .flatMap(({ condition, provenance }): Point[] => {
          const error = measuredError(provenance)?.penumbra.rmse;
          if (error === undefined || !(error > 0) || !target) return [];
          const own = condition === block.target;
          const { low, high } = target.wilson;
          return [{ item: id, condition, target: own, error, share: own ? target.proportion : 1 - target.proportion, interval: own ? { low, high } : { low: 1 - high, high: 1 - low } }];
        }),
    ),
  );
}

/** The marks of conditions: the target's circle, and a shape for each other one. */
const SHAPES: ReadonlyArray<(x: number, y: number) => SVGElement> = [
  (cx, cy) => s("circle", { cx, cy, r: 5.5 }),
  (x, y) => s("rect", { x: x - 5, y: y - 5, width: 10, height: 10 }),
  (x, y) => s("path", { d: `M${x} ${y - 6.5}l6.2 11h-12.4z` }),
  (x, y) => s("path", { d: `M${x} ${y - 7}l7 7-7 7-7-7z` }),
];

function mark(p: Pick<Point, "condition" | "target">, others: readonly string[], x: number, y: number): SVGElement {
  const shape = SHAPES[p.target ? 0 : 1 + (others.indexOf(p.condition) % (SHAPES.length - 1))] ?? SHAPES[0];
  const element = (shape as (x: number, y: number) => SVGElement)(x, y);
  element.setAttribute("class", p.target ? "dot target" : "dot");
  return element;
}

/** The plot, `width` CSS pixels wide; the two stimuli of a pair are joined, and the pair is named at its target. */
export function errorPlot(all: readonly Point[], width: number): SVGSVGElement {
  const height = Math.round(Math.min(400, Math.max(330, width * 0.5)));
  const box = { left: 46, right: width - 14, top: 58, bottom: height - 52 };
  const logs = all.map((p) => Math.log10(p.error));
  const [low, high] = [Math.floor(Math.min(...logs) - 0.1), Math.ceil(Math.max(...logs) + 0.1)];
  const x = (error: number) => box.left + ((Math.log10(error) - low) / (high - low)) * (box.right - box.left);
  const y = (share: number) => box.bottom - share * (box.bottom - box.top);
  const description = all.map((p) => `${p.item}, ${p.condition}: error ${significant(p.error)}, preferred by ${fixed(100 * p.share, 0)}%`).join("; ");
  const svg = figure(width, height, "Error of each stimulus against the share of participants who preferred it", `${description}.`);

  const others = [...new Set(all.filter((p) => !p.target).map((p) => p.condition))];
  let at = box.left + 6;
  for (const p of [...new Map(all.map((p) => [`${p.target} ${p.condition}`, p])).values()].sort((a, b) => Number(b.target) - Number(a.target))) {
    svg.append(mark(p, others, at, 9), s("text", { class: p.target ? "name target" : "name", x: at + 12, y: 13 }, p.condition));
    at += 12 + 7.5 * p.condition.length + 26;
  }
  for (const share of [0, 0.25, 0.5, 0.75, 1]) {
    svg.append(
      s("line", { class: share === 0.5 ? "chance" : "grid", x1: box.left, x2: box.right, y1: y(share), y2: y(share) }),
      s("text", { class: "tick", x: box.left - 8, y: y(share) + 4, "text-anchor": "end" }, `${100 * share}%`),
    );
  }
  for (let decade = low; decade <= high; decade++) {
    const tick = x(10 ** decade);
    svg.append(
      s("line", { class: "axis", x1: tick, x2: tick, y1: box.bottom, y2: box.bottom + 5 }),
      s("text", { class: "tick", x: tick, y: box.bottom + 20, "text-anchor": decade === high ? "end" : decade === low ? "start" : "middle" }, significant(10 ** decade, 1)),
    );
  }
  svg.append(
    s("line", { class: "axis", x1: box.left, x2: box.right, y1: box.bottom, y2: box.bottom }),
    s("text", { class: "label", x: (box.left + box.right) / 2, y: height - 8, "text-anchor": "middle" }, "RMSE in penumbra, share of full scale (log axis)"),
    s("text", { class: "label", x: 0, y: box.top - 18 }, "share that preferred it"),
  );
  for (const item of new Set(all.map((p) => p.item))) {
    const [a, b] = all.filter((p) => p.item === item);
    if (a !== undefined && b !== undefined) svg.append(s("line", { class: "join", x1: x(a.error), y1: y(a.share), x2: x(b.error), y2: y(b.share) }));
  }
  for (const p of all) {
    svg.append(s("line", { class: p.target ? "whisker target" : "whisker", x1: x(p.error), x2: x(p.error), y1: y(p.interval.low), y2: y(p.interval.high) }));
  }
  const named = all.filter((p) => p.target);
  const dots = all.map((p) => ({ left: x(p.error) - 8, right: x(p.error) + 8, top: y(p.share) - 8, bottom: y(p.share) + 8 }));
  const whiskers = all.map((p) => ({ left: x(p.error) - 3, right: x(p.error) + 3, top: y(p.interval.high), bottom: y(p.interval.low) }));
  const room = { ...box, left: box.left + 2, bottom: box.bottom - 2 };
  const labels = placed(
    named.map((p) => ({ x: x(p.error), y: y(p.share), width: 7.2 * p.item.length })),
    [...dots, ...whiskers],
    room,
  );
  named.forEach((p, i) => {
    const label = labels[i];
    if (label === undefined) return;
    const { box, anchor, led } = label;
    const [near, middle] = [anchor === "start" ? box.left : box.right, (box.top + box.bottom) / 2];
    if (led) svg.append(s("line", { class: "join", x1: x(p.error), y1: y(p.share), x2: near + (anchor === "start" ? -3 : 3), y2: middle }));
    svg.append(s("text", { class: "name", x: near, y: middle + 4, "text-anchor": anchor }, p.item));
  });
  for (const p of all) svg.append(mark(p, others, x(p.error), y(p.share)));
  return svg;
}
