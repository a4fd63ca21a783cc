/** The stimuli as participants see them, and where each came from. */
import { h } from "../shared/dom.ts";
import { significant } from "../shared/format.ts";
import type { Results, Stimulus } from "./api.ts";
import { number } from "./copy.ts";
import { flatten, measuredError, standardError } from "./provenance.ts";

/** Every item with its conditions side by side; what pooled versions showed differently is marked. */
export function gallery(stimuli: readonly Stimulus[], different: Results["different_stimuli"]): HTMLElement[] {
  const items = new Map<string, Stimulus[]>();
  for (const stimulus of stimuli) {
    items.set(stimulus.item, [...(items.get(stimulus.item) ?? []), stimulus]);
  }
  const differs = ({ item, condition }: Stimulus) => different.some((other) => other.item === item && other.condition === condition);
  const larger = (than: Stimulus) => stimuli.filter(({ item, condition, size }) => item === than.item && condition === than.condition && width(size) > width(than.size));
  return [...items].map(([name, members]) =>
    h("section", { class: "pair" }, h("h3", {}, name), h("div", { class: "conditions" }, ...smallest(members).map((stimulus) => card(stimulus, larger(stimulus), differs(stimulus))))),
  );
}

const width = ([width = 0]: readonly number[]) => width;

/** Stimuli that are made in several sizes, each at its smallest. */
export const smallest = <T extends Pick<Stimulus, "item" | "condition" | "size">>(stimuli: readonly T[]): T[] =>
  stimuli.filter((one) => !stimuli.some((other) => other.item === one.item && other.condition === one.condition && width(other.size) < width(one.size)));

function card(stimulus: Stimulus, larger: readonly Stimulus[], differs: boolean): HTMLElement {
  const facts: Array<[string, unknown]> = [["sha256", stimulus.sha256], ...flatten({ pixels_sha256: stimulus.pixels_sha256 }), ...flatten(stimulus.provenance)];
  return h(
    "figure",
    { class: "stimulus" },
    picture(stimulus),
    h(
      "figcaption",
      {},
      h("strong", {}, stimulus.condition),
      ...(differs ? [h("span", { class: "warning" }, "not the same in all pooled versions")] : []),
      ...errorOf(stimulus),
      ...(larger.length === 0 ? [] : [h("span", { class: "fact" }, `${stimulus.size.join(" × ")} px; also at `, ...links(larger))]),
      h("details", {}, h("summary", {}, "Where it came from"), h("dl", {}, ...facts.flatMap(([name, value]) => [h("dt", {}, words(name)), h("dd", {}, shown(value))]))),
    ),
  );
}

/** The same at other sizes, each to look at; an animation's is its list of frames. */
const links = (others: readonly Stimulus[]) =>
  others.flatMap(({ size, sha256 }, i) => [...(i > 0 ? [", "] : []), h("a", { href: address(sha256), target: "_blank", rel: "noopener" }, size.join(" × "))]);

/** What is known of a stimulus's error: against a reference, where shadows are soft (there techniques differ), or its own spread, or nothing. */
function errorOf({ provenance }: Stimulus): HTMLElement[] {
  const measured = measuredError(provenance);
  const own = standardError(provenance);
  if (measured === null && own === null) return [h("span", { class: "fact" }, "error not known")];
  if (measured === null)
    return [h("span", { class: "fact" }, "standard error where sampled: RMS ", number(significant(own?.rms), own?.rms), ", max ", number(significant(own?.max), own?.max), " of full scale")];
  const { reference, penumbra, floor } = measured;
  const { technique, ...knobs } = reference;
  const detail = Object.entries(knobs).flatMap(([name, value]) => (typeof value === "number" || typeof value === "string" ? [`${words(name)} ${value}`] : []));
  return [
    h("span", { class: "fact" }, "penumbra error: RMSE ", number(significant(penumbra.rmse), penumbra.rmse), ", max ", number(significant(penumbra.max), penumbra.max), " of full scale"),
    h("span", { class: "fact" }, `against ${[String(technique), ...detail].join(", ")}`, ...(floor === null ? [] : [", whose own error is ", number(significant(floor), floor)])),
  ];
}

const address = (sha256: string) => `/stimuli/${encodeURIComponent(sha256)}`;
const words = (name: string) => name.replaceAll("_", " ").replaceAll(".", " · ");
const shown = (value: unknown) =>
  typeof value === "number" && !Number.isInteger(value)
    ? number(significant(value), value)
    : typeof value === "string" && /^[0-9a-f]{64}$/.test(value)
      ? number(value.slice(0, 12), value)
      : number(String(value), String(value));

/** A still as it is; an animation as its first frame, with a button that plays it. */
function picture({ sha256, item, condition }: Stimulus): HTMLElement {
  const image = h("img", { alt: `${item}, ${condition}`, decoding: "async", src: address(sha256) });
  const holder = h("div", { class: "picture" }, image);
  image.addEventListener(
    "error",
    async () => {
      try {
        const manifest = (await (await fetch(address(sha256))).json()) as { fps: number; frames: string[] };
        holder.append(player(image, manifest));
      } catch {
        holder.replaceChildren(h("p", { class: "missing" }, "This stimulus is not stored here."));
      }
    },
    { once: true },
  );
  return holder;
}

function player(image: HTMLImageElement, { fps, frames }: { fps: number; frames: string[] }): HTMLButtonElement {
  const source = (i: number) => address(frames[i % frames.length] ?? "");
  const label = `Play ${frames.length} frames at ${fps} fps`;
  const button = h("button", { type: "button", class: "play" }, label);
  image.src = source(0);
  let since: number | null = null;
  const step = (now: number) => {
    if (since === null || !image.isConnected) return;
    image.src = source(Math.floor(((now - since) * fps) / 1000));
    requestAnimationFrame(step);
  };
  button.addEventListener("click", async () => {
    if (since !== null) {
      since = null;
      button.textContent = label;
      return;
    }
    button.textContent = "Loading the frames";
    await Promise.all([...new Set(frames)].map((frame) => Object.assign(new Image(), { src: address(frame) }).decode()));
    button.textContent = "Stop";
    since = performance.now();
    requestAnimationFrame(step);
  });
  return button;
}
