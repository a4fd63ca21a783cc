/** Two pictures on the screen, one after the other, then the question's two buttons in their place. */
import type { TrialType } from "jspsych";
import { h } from "../../../shared/dom.ts";
import type { Rules } from "../../inputs/guard.ts";
import { fitOne, inkOn, type Offered, type Size, srgbCode } from "../../layout.ts";
import type { Picture } from "../../stimuli.ts";
import { type Plain, words } from "../../words/index.ts";
import { visible } from "../shared/hidden.ts";
import { roomWithin, showAt, shownAt, toWholePixels } from "../shared/place.ts";
import { Player, played } from "../shared/player.ts";
import { Taking } from "../shared/taking.ts";
import type { Info } from "./info.ts";
import { mask, seedOf } from "./mask.ts";
import { type PerStep, SequenceClock, type Step } from "./sequence.ts";

export type Interval = "first" | "second";
export type Intervals = Record<Interval, Picture>;

const INTERVALS: readonly Interval[] = ["first", "second"];

const KEYS: Record<string, Interval> = { ArrowLeft: "first", "1": "first", ArrowRight: "second", "2": "second" };

/** What is said to those who hear the page. */
const SPOKEN: Record<Step | "response", Plain | null> = { fixation: null, first: "spoken-first", mask: null, second: "spoken-second", response: "spoken-choose" };

/** A sequence that was shown to its end. */
export interface Shown {
  shown: { frames: PerStep; ms: PerStep };
  /** How its animations were played. */
  film: ReturnType<typeof played<Interval>>;
  /** How often the page was hidden during an interval, so that all began again. */
  restarts: number;
}

export class Stage {
  readonly #trial: TrialType<Info>;
  readonly #pictures: Intervals;
  readonly #root: HTMLElement;
  readonly #heading: HTMLHeadingElement;
  readonly #footer: HTMLElement;
  readonly #box: HTMLElement;
  readonly #canvas: HTMLCanvasElement;
  readonly #context: CanvasRenderingContext2D;
  readonly #spoken: HTMLElement;
  readonly #buttons: Record<Interval, HTMLButtonElement>;
  readonly #listening = new AbortController();
  /** All that is painted but animations, decoded: nothing has to be made while time is counted. */
  readonly #bitmaps: Partial<Record<Step, ImageBitmap>> = {};
  #size: Size;
  /** The answer, and how it comes about. */
  readonly taking: Taking<Interval>;

  constructor(display: HTMLElement, trial: TrialType<Info>, pictures: Intervals) {
    this.#trial = trial;
    this.#pictures = pictures;
    const [width, height] = pictures.first.pixels;
    this.#canvas = h("canvas", { width, height, "aria-hidden": "true" });
    this.#context = this.#canvas.getContext("2d", { alpha: false }) as CanvasRenderingContext2D;
    const button = (interval: Interval, label: string) => h("button", { type: "button", class: "action", "data-testid": `choice-${interval}`, "data-sha256": pictures[interval].sha256 }, label);
    this.#buttons = { first: button("first", words("choice-first")), second: button("second", words("choice-second")) };
    this.#heading = h("h1", { tabindex: -1 }, trial.question);
    this.#footer = h("p", { class: "position", "aria-live": "polite" });
    this.#spoken = h("p", { class: "spoken", role: "status" });
    const answers = h("div", { class: "answers", role: "group", "aria-label": trial.question }, this.#buttons.first, this.#buttons.second);
    this.#box = h("div", { class: "intervals" }, this.#canvas, answers, this.#spoken);
    this.#root = h("section", { class: "trial" }, this.#heading, this.#box, this.#footer);
    display.replaceChildren(this.#root);
    this.#size = this.#fit();
    this.taking = new Taking({
      ...{ root: this.#root, buttons: this.#buttons, keys: () => KEYS, geometry: () => shownAt(this.#size) },
      ...{ pixels: pictures.first.pixels, rules: trial.rules as Rules, simulated: trial.simulated === true },
    });
    addEventListener(
      "resize",
      () => {
        this.#size = this.#fit();
        this.taking.resized();
      },
      { signal: this.#listening.signal },
    );
  }

  /** Decodes and draws beforehand. */
  async prepare(): Promise<void> {
    const { surround = 0, trial_index = 0 } = this.#trial;
    const [width, height] = this.#pictures.first.pixels;
    for (const interval of INTERVALS) {
      const picture = this.#pictures[interval];
      if (picture.kind === "still") this.#bitmaps[interval] = await createImageBitmap(picture.image);
    }
    const seed = seedOf(
      INTERVALS.map((interval) => this.#pictures[interval].sha256),
      trial_index,
    );
    this.#bitmaps.mask = await createImageBitmap(new ImageData(mask({ width, height, surround, seed }), width, height));
    // A bitmap's first drawing may have to carry it to the graphics card. What of a film is still to come is not among them.
    const animated = INTERVALS.flatMap((interval) => {
      const picture = this.#pictures[interval];
      return picture.kind === "animation" ? picture.film.pictures : [];
    });
    for (const bitmap of [...Object.values(this.#bitmaps), ...animated]) this.#context.drawImage(bitmap, 0, 0);
    this.#blank();
  }

  /** Shows the steps, from the beginning again whenever the page is hidden before the response screen; resolves when that is painted. */
  async show(plan: PerStep, periodMs: number): Promise<Shown> {
    this.#footer.textContent = this.#trial.position ?? "";
    this.#heading.focus({ preventScroll: true });
    for (let restarts = 0; ; restarts += 1) {
      await visible();
      const seen = await this.#sequence(plan, periodMs);
      if (seen !== null) return { ...seen, restarts };
    }
  }

  /** Outlines the choice. */
  mark(interval: Interval): void {
    this.#buttons[interval].classList.add("chosen");
  }

  clear(): void {
    this.#listening.abort();
    this.taking.close();
    this.#root.remove();
    for (const bitmap of Object.values(this.#bitmaps)) bitmap.close();
  }

  /** One pass; null when the page was hidden before it was over. */
  #sequence(plan: PerStep, periodMs: number): Promise<Omit<Shown, "restarts"> | null> {
    const clock = new SequenceClock(plan, periodMs);
    const players: Partial<Record<Step, Player>> = {};
    for (const interval of INTERVALS) {
      const picture = this.#pictures[interval];
      if (picture.kind === "animation") players[interval] = new Player(picture, this.#context, periodMs);
    }
    const film = () => played(INTERVALS.flatMap((interval) => (players[interval] === undefined ? [] : [[interval, players[interval]] as const])));
    return new Promise((resolve) => {
      const over = new AbortController();
      const end = (seen: Omit<Shown, "restarts"> | null) => {
        over.abort();
        if (seen === null) this.#blank();
        resolve(seen);
      };
      document.addEventListener("visibilitychange", () => end(null), { signal: over.signal });
      let on: Step | null | undefined;
      const frame = (now: number) => {
        if (over.signal.aborted) return;
        const step = clock.tick(now);
        if (step !== on) this.#paint(step);
        on = step;
        if (step !== null) players[step]?.draw(now);
        requestAnimationFrame(step === null ? response : frame);
      };
      const response = (onset: number) => {
        if (over.signal.aborted) return;
        this.taking.open(onset);
        end({ shown: clock.shown(), film: film() });
      };
      requestAnimationFrame(frame);
    });
  }

  /** Puts a step on the screen, or the response's buttons. */
  #paint(step: Step | null): void {
    this.#box.classList.toggle("answering", step === null);
    const spoken = SPOKEN[step ?? "response"];
    this.#spoken.textContent = spoken === null ? "" : words(spoken);
    const bitmap = step === null ? undefined : this.#bitmaps[step];
    if (bitmap !== undefined) this.#context.drawImage(bitmap, 0, 0);
    else if (step === "fixation") this.#cross();
  }

  /** The surround's grey, which can't be told from the page. */
  #blank(): void {
    const code = srgbCode(this.#trial.surround ?? 0);
    this.#context.fillStyle = `rgb(${code} ${code} ${code})`;
    this.#context.fillRect(0, 0, this.#canvas.width, this.#canvas.height);
    this.#box.classList.remove("answering");
    this.#spoken.textContent = "";
  }

  /** A cross in the middle of the surround. */
  #cross(): void {
    this.#blank();
    const { width, height } = this.#canvas;
    const arm = Math.max(4, Math.round(Math.min(width, height) / 24));
    const half = Math.max(1, Math.round(arm / 6));
    const [x, y] = [Math.round(width / 2), Math.round(height / 2)];
    this.#context.fillStyle = inkOn(this.#trial.surround ?? 0);
    this.#context.fillRect(x - arm, y - half, 2 * arm, 2 * half);
    this.#context.fillRect(x - half, y - arm, 2 * half, 2 * arm);
  }

  /** Sizes and places the picture in whole device pixels. It stays the one that is there, however the window changes. */
  #fit(): Size {
    const offered = { sizes: [this.#pictures.first.pixels], fit: this.#trial.fit as Offered["fit"] };
    const size = fitOne(offered, roomWithin(this.#root, this.#heading, this.#footer));
    showAt(this.#canvas, size);
    toWholePixels(this.#box, this.#canvas);
    return size;
  }
}
