/** A pair on the screen, until it is answered. */
import type { TrialType } from "jspsych";
import { h } from "../../../shared/dom.ts";
import type { Rules } from "../../inputs/guard.ts";
import { fitPair, type Layout, type Offered } from "../../layout.ts";
import type { Picture } from "../../stimuli.ts";
import { words } from "../../words/index.ts";
import { roomWithin, showAt, shownAt, toWholePixels } from "../shared/place.ts";
import { Player, played } from "../shared/player.ts";
import { Taking } from "../shared/taking.ts";
import type { Info } from "./info.ts";

export type Side = "left" | "right";
export type Pair = Record<Side, Picture>;

const SIDES: readonly Side[] = ["left", "right"];

/** Keys follow how the pair stands. ← and → go on meaning the first and the second of a stacked one: a window may change after the instructions. */
const KEYS: Record<Layout["arrangement"], Record<string, Side>> = {
  side: { ArrowLeft: "left", ArrowRight: "right" },
  stack: { ArrowUp: "left", ArrowDown: "right", ArrowLeft: "left", ArrowRight: "right" },
};

export class Stage {
  readonly #trial: TrialType<Info>;
  readonly #pair: Pair;
  readonly #root: HTMLElement;
  readonly #heading: HTMLHeadingElement;
  readonly #footer: HTMLElement;
  readonly #box: HTMLElement;
  readonly #buttons: Record<Side, HTMLButtonElement>;
  readonly #paint: Record<Side, CanvasRenderingContext2D | null>;
  readonly #listening = new AbortController();
  #layout: Layout;
  /** The answer, and how it comes about. */
  readonly taking: Taking<Side>;

  constructor(display: HTMLElement, trial: TrialType<Info>, pair: Pair) {
    this.#trial = trial;
    this.#pair = pair;
    const surface = (picture: Picture) => {
      if (picture.kind === "still") return { element: picture.image, context: null };
      const [width, height] = picture.pixels;
      const canvas = h("canvas", { width, height });
      return { element: canvas, context: canvas.getContext("2d", { alpha: false }) };
    };
    const [left, right] = [surface(pair.left), surface(pair.right)];
    const button = (side: Side, label: string, picture: HTMLElement) =>
      h("button", { type: "button", class: "picture", "aria-label": label, "data-testid": `choice-${side}`, "data-sha256": pair[side].sha256 }, picture);
    this.#buttons = { left: button("left", words("choice-left"), left.element), right: button("right", words("choice-right"), right.element) };
    this.#paint = { left: left.context, right: right.context };
    this.#heading = h("h1", { tabindex: -1 }, trial.question);
    this.#footer = h("p", { class: "position", "aria-live": "polite" });
    this.#box = h("div", { class: "pair", role: "group", "aria-label": trial.question }, this.#buttons.left, this.#buttons.right);
    this.#root = h("section", { class: "trial" }, this.#heading, this.#box, this.#footer);
    display.replaceChildren(this.#root);
    this.#layout = this.#fit();
    this.taking = new Taking({
      ...{ root: this.#root, buttons: this.#buttons, keys: () => KEYS[this.#layout.arrangement], geometry: () => this.#shown() },
      ...{ pixels: pair.left.pixels, rules: trial.rules as Rules, simulated: trial.simulated === true },
    });
    addEventListener(
      "resize",
      () => {
        this.#layout = this.#fit();
        this.taking.resized();
      },
      { signal: this.#listening.signal },
    );
  }

  /** Paints the pair and resolves at the frame after, the first at which it has been on the screen, with what tells how animations were played until then. */
  async show(periodMs: number): Promise<() => ReturnType<typeof played<Side>>> {
    const players = SIDES.flatMap((side) => {
      const [picture, context] = [this.#pair[side], this.#paint[side]];
      return picture.kind === "still" || context === null ? [] : [[side, new Player(picture, context, periodMs)] as const];
    });
    const draw = (now: number) => {
      for (const [, player] of players) player.draw(now);
    };
    const decoded = SIDES.flatMap((side) => {
      const picture = this.#pair[side];
      return picture.kind === "still" ? [picture.image.decode()] : [];
    });
    await Promise.all(decoded); // a decoded picture may have been dropped since; this is at once otherwise
    await new Promise<void>((resolve) => {
      requestAnimationFrame((now) => {
        draw(now);
        this.#box.classList.add("shown");
        this.#footer.textContent = this.#trial.position ?? "";
        this.#heading.focus({ preventScroll: true });
        requestAnimationFrame((painted) => {
          this.taking.open(painted);
          resolve();
          if (players.length === 0) return;
          const loop = (at: number) => {
            if (this.#listening.signal.aborted) return;
            draw(at);
            requestAnimationFrame(loop);
          };
          loop(painted);
        });
      });
    });
    return () => played(players);
  }

  /** Outlines the choice. */
  mark(side: Side): void {
    this.#buttons[side].classList.add("chosen");
  }

  clear(): void {
    this.#listening.abort();
    this.taking.close();
    this.#root.remove();
  }

  /** How the pair stands. */
  #shown() {
    const { scale, css_width_px, ...display } = shownAt(this.#layout);
    return { scale, css_width_px, arrangement: this.#layout.arrangement, ...display };
  }

  /** Sizes and places the pictures in whole device pixels. They stay those that are there, however the window changes. */
  #fit(): Layout {
    const offered = { sizes: [this.#pair.left.pixels], fit: this.#trial.fit as Offered["fit"] };
    const layout = fitPair(offered, roomWithin(this.#root, this.#heading, this.#footer));
    this.#box.classList.toggle("stack", layout.arrangement === "stack");
    this.#box.style.gap = `${layout.gap}px`;
    for (const button of Object.values(this.#buttons)) showAt(button.firstElementChild as HTMLElement, layout);
    toWholePixels(this.#box, this.#buttons.left);
    return layout;
  }
}
