/** The stimuli as participants see them, and where each came from. */
import { h } from "../shared/dom.ts";
import { significant } from "../shared/format.ts";
import type { Measured, Stimulus } from "./api.ts";
import { number } from "./copy.ts";

/** Every pair with its conditions side by side. */
export function gallery(stimuli: readonly Stimulus[]): HTMLElement[] {
  const pairs = new Map<string, Stimulus[]>();
  for (const stimulus of stimuli) {
    pairs.set(stimulus.pair, [...(pairs.get(stimulus.pair) ?? []), stimulus]);
  }
  return [...pairs].map(([name, members]) =>
    h("section", { class: "pair" }, h("h3", {}, name), h("div", { class: "conditions" }, ...members.map(card))),
  );
}

function card(stimulus: Stimulus): HTMLElement {
  const { error, ...rest } = stimulus.provenance;
  const facts = flatten(rest);
  return h(
    "figure",
    { class: "stimulus" },
    picture(stimulus),
    h(
      "figcaption",
      {},
      h("strong", {}, stimulus.condition),
      ...errorOf(stimulus),
      h(
        "details",
        {},
        h("summary", {}, "Where it came from"),
        h("dl", {}, ...[["sha256", stimulus.sha256] as [string, unknown], ...facts, ...flatten(error ?? {}, "error")].flatMap(([name, value]) => [h("dt", {}, words(name)), h("dd", {}, shown(value))])),
      ),
    ),
  );
}

/** What is known of a stimulus's error: against a reference, or its own spread, or nothing (a picture from elsewhere). */
function errorOf({ provenance: { error, standard_error: own } }: Stimulus): HTMLElement[] {
  if (error) return measured(error);
  if (!own) return [h("span", { class: "fact" }, "error not known")];
  return [h("span", { class: "fact" }, "standard error where sampled: RMS ", number(significant(own.rms_sampled), own.rms_sampled), ", max ", number(significant(own.max), own.max), " of full scale")];
}

/** The error in a line: where shadows are soft, because that is where techniques differ. */
function measured({ reference, penumbra, floor }: Measured): HTMLElement[] {
  const { technique, ...knobs } = reference;
  const detail = Object.entries(knobs).flatMap(([name, value]) => (typeof value === "number" || typeof value === "string" ? [`${words(name)} ${value}`] : []));
  return [
    h("span", { class: "fact" }, "penumbra error: RMSE ", number(significant(penumbra.rmse), penumbra.rmse), ", max ", number(significant(penumbra.max), penumbra.max), " of full scale"),
    h("span", { class: "fact" }, `against ${[technique, ...detail].join(", ")}`, ...(floor === null ? [] : [", whose own error is ", number(significant(floor), floor)])),
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

/** `{ a: { b: 1 } }` as `[["a.b", 1]]`; lists of plain values stay in one piece. */
export function flatten(value: unknown, name = ""): Array<[string, unknown]> {
  if (Array.isArray(value) && value.every((item) => item === null || typeof item !== "object")) return [[name, value.join(", ")]];
  if (value !== null && typeof value === "object") {
    return Object.entries(value).flatMap(([key, inner]) => flatten(inner, name === "" ? key : `${name}.${key}`));
  }
  return value === undefined || value === null ? [] : [[name, value]];
}

/** A still as it is; an animation as its first frame, with a button that plays it. */
function picture({ sha256, pair, condition }: Stimulus): HTMLElement {
  const image = h("img", { alt: `${pair}, ${condition}`, decoding: "async", src: address(sha256) });
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
