/** Small plots as SVG: each has a title and a description, and its labels stand where they belong. */

import { s } from "../shared/dom.ts";
import { fixed } from "../shared/format.ts";
import type { Block } from "./api.ts";

let plots = 0;

/** An SVG of this size with a title and a description for those who don't see it. */
export function figure(width: number, height: number, title: string, description: string): SVGSVGElement {
  const id = `plot-${plots++}`;
  return s(
    "svg",
    { viewBox: `0 0 ${width} ${height}`, class: "plot", role: "img", "aria-labelledby": `${id}-title ${id}-desc` },
    s("title", { id: `${id}-title` }, title),
    s("desc", { id: `${id}-desc` }, description),
  );
}

/** How many participants chose the target how often, where the mean is, and where chance would put it. */
export function choiceDistribution(block: Block): SVGSVGElement {
  const [width, height] = [340, 204];
  const box = { left: 12, right: width - 12, top: 44, bottom: height - 42 };
  const counts = Array.from({ length: block.items + 1 }, (_, k) => block.counts[String(k)] ?? 0);
  const most = Math.max(1, ...counts);
  const slot = (box.right - box.left) / (block.items + 1);
  const x = (choices: number) => box.left + slot * (choices + 0.5);
  const y = (n: number) => box.bottom - ((box.bottom - box.top - 22) * n) / most;
  const summary = counts.map((n, k) => `${n} chose ${block.target} ${k} times`).join(", ");
  const mean = block.mean ?? null;
  const summed = mean === null ? "" : ` Mean ${fixed(mean, 3)}, chance ${fixed(block.mu, 1)}.`;
  const svg = figure(width, height, `${block.title}: choices of ${block.target}`, `${summary}.${summed}`);

  const bar = Math.min(64, slot * 0.62);
  counts.forEach((n, k) => {
    svg.append(
      s("rect", { class: "bar", x: x(k) - bar / 2, y: y(n), width: bar, height: Math.max(0, box.bottom - y(n)) }),
      s("text", { class: "tick", x: x(k), y: box.bottom + 17, "text-anchor": "middle" }, k),
    );
  });
  svg.append(
    s("line", { class: "axis", x1: box.left, x2: box.right, y1: box.bottom, y2: box.bottom }),
    s("text", { class: "label", x: (box.left + box.right) / 2, y: height - 6, "text-anchor": "middle" }, `choices of ${block.target}, of ${block.items}`),
    s("line", { class: "chance", x1: x(block.mu), x2: x(block.mu), y1: box.top - 8, y2: box.bottom }),
  );
  // Two labels on one line: each on its own side, so that they never meet.
  const after = mean === null || mean <= block.mu;
  const chance = after ? { x: x(block.mu) + 6, "text-anchor": "start" } : { x: x(block.mu) - 6, "text-anchor": "end" };
  svg.append(s("text", { class: "label", y: box.top - 12, ...chance }, "chance"));
  if (mean !== null) {
    const at = x(mean);
    const label = after ? { x: Math.max(box.left, at - 8), "text-anchor": at < 84 ? "start" : "end" } : { x: at + 8, "text-anchor": at > width - 84 ? "end" : "start" };
    svg.append(
      s("line", { class: "mean", x1: at, x2: at, y1: box.top - 20, y2: box.bottom }),
      s("text", { class: "mean-label", y: box.top - 28, ...(at < 84 || at > width - 84 ? { ...label, x: Math.min(Math.max(at, box.left), box.right) } : label) }, `mean ${fixed(mean, 3)}`),
    );
  }
  // Above the lines, with a halo, so that they can be read where a line crosses.
  svg.append(...counts.map((n, k) => s("text", { class: "value", x: x(k), y: y(n) - 6, "text-anchor": "middle" }, n)));
  return svg;
}
