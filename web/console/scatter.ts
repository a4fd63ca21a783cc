/** How wrong a picture is against how many prefer it. */
import { s } from "../shared/dom.ts";
import { fixed, significant } from "../shared/format.ts";
import type { BlockReport, Interval, Stimulus } from "./api.ts";
import { figure } from "./plots.ts";

interface Point {
  pair: string;
  condition: string;
  target: boolean;
  error: number;
  share: number;
  interval: Interval;
}

/** Every stimulus with a measured error and answers: its RMSE in penumbra, and the share of participants who preferred it. */
export function points(blocks: readonly BlockReport[], stimuli: readonly Stimulus[]): Point[] {
  return blocks.flatMap((block) =>
    block.by_pair.flatMap(({ id, target }) =>
      stimuli
        .filter((stimulus) => stimulus.pair === id && target !== null && block.conditions.includes(stimulus.condition))
        .flatMap(({ condition, provenance }): Point[] => {
          const error = provenance.error?.penumbra.rmse;
          if (error === undefined || !(error > 0) || target === null) return [];
          const own = condition === block.target;
          const { low, high } = target.wilson;
          return [{ pair: id, condition, target: own, error, share: own ? target.proportion : 1 - target.proportion, interval: own ? { low, high } : { low: 1 - high, high: 1 - low } }];
        }),
    ),
  );
}

/** The plot, `width` CSS pixels wide; the two stimuli of a pair are joined. */
export function errorPlot(all: readonly Point[], width: number): SVGSVGElement {
  const height = Math.round(Math.min(380, Math.max(280, width * 0.48)));
  const box = { left: 52, right: width - 16, top: 22, bottom: height - 52 };
  const logs = all.map((p) => Math.log10(p.error));
  const [low, high] = [Math.floor(Math.min(...logs) - 0.15), Math.ceil(Math.max(...logs) + 0.15)];
  const x = (error: number) => box.left + ((Math.log10(error) - low) / (high - low)) * (box.right - box.left);
  const y = (share: number) => box.bottom - share * (box.bottom - box.top);
  const description = all.map((p) => `${p.pair}, ${p.condition}: error ${significant(p.error)}, preferred by ${fixed(100 * p.share, 0)}%`).join("; ");
  const svg = figure(width, height, "Error of each stimulus against the share of participants who preferred it", `${description}.`);

  for (const share of [0, 0.25, 0.5, 0.75, 1]) {
    svg.append(
      s("line", { class: share === 0.5 ? "chance" : "grid", x1: box.left, x2: box.right, y1: y(share), y2: y(share) }),
      s("text", { class: "tick", x: box.left - 8, y: y(share) + 4, "text-anchor": "end" }, `${100 * share}%`),
    );
  }
  for (let decade = low; decade <= high; decade++) {
    const at = x(10 ** decade);
    svg.append(
      s("line", { class: "axis", x1: at, x2: at, y1: box.bottom, y2: box.bottom + 5 }),
      s("text", { class: "tick", x: at, y: box.bottom + 20, "text-anchor": decade === high ? "end" : "middle" }, significant(10 ** decade, 1)),
    );
  }
  svg.append(
    s("line", { class: "axis", x1: box.left, x2: box.right, y1: box.bottom, y2: box.bottom }),
    s("text", { class: "label", x: (box.left + box.right) / 2, y: height - 8, "text-anchor": "middle" }, "RMSE in penumbra, share of full scale (log axis)"),
    s("text", { class: "label", x: 4, y: 12 }, "preferred it"),
  );
  for (const pair of new Set(all.map((p) => p.pair))) {
    const [a, b] = all.filter((p) => p.pair === pair);
    if (a !== undefined && b !== undefined) svg.append(s("line", { class: "join", x1: x(a.error), y1: y(a.share), x2: x(b.error), y2: y(b.share) }));
  }
  const labels: Array<{ x: number; y: number }> = [];
  for (const p of [...all].sort((a, b) => a.share - b.share)) {
    const [cx, cy] = [x(p.error), y(p.share)];
    const right = cx < (box.left + box.right) / 2;
    // A label moves up until it stands free of those before it.
    let at = cy + 4;
    while (labels.some((l) => Math.abs(l.x - cx) < 150 && Math.abs(l.y - at) < 15)) at -= 15;
    labels.push({ x: cx, y: at });
    svg.append(
      s("line", { class: p.target ? "whisker target" : "whisker", x1: cx, x2: cx, y1: y(p.interval.low), y2: y(p.interval.high) }),
      p.target ? s("circle", { class: "dot target", cx, cy, r: 5.5 }) : s("rect", { class: "dot", x: cx - 5, y: cy - 5, width: 10, height: 10 }),
      s("text", { class: p.target ? "name target" : "name", x: right ? cx + 11 : cx - 11, y: at, "text-anchor": right ? "start" : "end" }, `${p.pair} · ${p.condition}`),
    );
  }
  return svg;
}
