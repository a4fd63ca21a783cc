/** jsPsych plugin: two pictures of equal size, stills or animations; which one? By mouse, touch or the arrow keys. */
import { type JsPsych, type JsPsychPlugin, ParameterType, type TrialType } from "jspsych";
import { h } from "../shared/dom.ts";
import { AnimationClock, type FrameLog, rounded } from "./clock.ts";
import { fitPair, type Layout } from "./layout.ts";
import type { Pair, Picture } from "./stimuli.ts";

const info = <const>{
  name: "two-alternative",
  version: "1.0.0",
  parameters: {
    /** The question above the pictures. */
    question: { type: ParameterType.STRING, default: undefined },
    /** Where the trial stands, as "7 of 25". */
    position: { type: ParameterType.STRING, default: "" },
    /** Hashes of the two stimuli. */
    left: { type: ParameterType.STRING, default: undefined },
    right: { type: ParameterType.STRING, default: undefined },
    /** Stimulus pixels; both pictures have this size. */
    width: { type: ParameterType.INT, default: undefined },
    height: { type: ParameterType.INT, default: undefined },
    /** Gives a promise of the fetched, verified and decoded `Pair`. */
    load: { type: ParameterType.FUNCTION, default: undefined },
    /** Gives a promise of the display's refresh period in ms, or of null where it could not be measured. */
    refresh_period: { type: ParameterType.FUNCTION, default: undefined },
    /** Called once the pictures are on the screen: the time to preload the next pair. */
    on_onset: { type: ParameterType.FUNCTION, default: () => {} },
    /** Called with the trial's data at the choice, before its outline is shown: from then on it must not be lost. */
    on_choice: { type: ParameterType.FUNCTION, default: () => {} },
    /** How long the chosen picture keeps its outline, ms. */
    feedback_ms: { type: ParameterType.INT, default: 150 },
  },
  data: {
    /** "left" or "right". */
    choice: { type: ParameterType.STRING },
    /** From the first painted frame to the choice, ms. */
    rt: { type: ParameterType.FLOAT },
    /** `performance.now()` of the first painted frame, ms. */
    onset: { type: ParameterType.FLOAT },
    /** "mouse", "touch" or "keyboard". */
    input: { type: ParameterType.STRING },
    /** Device pixels per stimulus pixel: 1 is native. */
    scale: { type: ParameterType.FLOAT },
    /** "side" or "stack". */
    arrangement: { type: ParameterType.STRING },
    device_pixel_ratio: { type: ParameterType.FLOAT },
    /** CSS pixels, width and height. */
    viewport: { type: ParameterType.INT, array: true },
    /** Measured, Hz; null where it could not be. */
    refresh_hz: { type: ParameterType.FLOAT },
    /** Time that the page was hidden between onset and choice, ms. */
    hidden_ms: { type: ParameterType.FLOAT },
    /** Of animations only: how the left and the right one were played. */
    frames: { type: ParameterType.OBJECT },
  },
};

type Info = typeof info;
type Side = "left" | "right";
type Input = "mouse" | "touch" | "keyboard";

/** Refresh assumed where it could not be measured. */
const FALLBACK_PERIOD_MS = 1000 / 60;
/** Room around the pair for an outline, CSS px. */
const EDGE = 14;

export default class TwoAlternativePlugin implements JsPsychPlugin<Info> {
  static info = info;
  readonly #jsPsych: JsPsych;

  constructor(jsPsych: JsPsych) {
    this.#jsPsych = jsPsych;
  }

  async trial(display: HTMLElement, trial: TrialType<Info>, onLoad?: () => void): Promise<Record<string, unknown>> {
    const [pair, periodMs] = await Promise.all([
      trial.load() as Promise<Pair>,
      trial.refresh_period() as Promise<number | null>,
    ]);
    const stage = new Stage(display, trial, pair);
    onLoad?.();
    const play = await stage.show(periodMs ?? FALLBACK_PERIOD_MS);
    trial.on_onset?.();

    const { side, input, at } = await stage.choice();
    const data = {
      choice: side,
      rt: rounded(at - play.onset),
      onset: rounded(play.onset),
      input,
      ...stage.shown(),
      refresh_hz: periodMs === null ? null : rounded(1000 / periodMs),
      hidden_ms: rounded(stage.hiddenMs),
      ...(play.log() ?? {}),
    };
    trial.on_choice?.(data);
    stage.mark(side);
    await new Promise<void>((resolve) => this.#jsPsych.pluginAPI.setTimeout(resolve, trial.feedback_ms ?? 150));
    play.stop();
    stage.clear();
    return data;
  }

  /** `data-only` answers at random at once; `visual` shows the pair and clicks. */
  simulate(trial: TrialType<Info>, mode: "data-only" | "visual", options: { data?: object }, onLoad?: () => void): void {
    const made = {
      choice: Math.random() < 0.5 ? "left" : "right",
      rt: this.#jsPsych.randomization.sampleExGaussian(600, 100, 1 / 300, true),
      ...options.data,
    };
    if (mode === "data-only") {
      onLoad?.();
      const shown = { scale: 1, arrangement: "side", device_pixel_ratio: devicePixelRatio, viewport: [innerWidth, innerHeight] };
      const data = { onset: performance.now(), input: "mouse", ...shown, refresh_hz: null, hidden_ms: 0, ...made };
      trial.on_choice?.(data);
      this.#jsPsych.finishTrial(data);
      return;
    }
    const display = this.#jsPsych.getDisplayElement();
    const click = () => {
      onLoad?.();
      const target = display.querySelector<HTMLElement>(`[data-testid="choice-${made.choice}"]`);
      if (target !== null) this.#jsPsych.pluginAPI.clickTarget(target, made.rt);
    };
    void this.trial(display, trial, click).then((data) => this.#jsPsych.finishTrial(data));
  }
}

/** A pair on the screen, until it is answered. */
class Stage {
  hiddenMs = 0;
  readonly #trial: TrialType<Info>;
  readonly #pair: Pair;
  readonly #root: HTMLElement;
  readonly #heading: HTMLHeadingElement;
  readonly #footer: HTMLElement;
  readonly #box: HTMLElement;
  readonly #buttons: Record<Side, HTMLButtonElement>;
  readonly #paint: Record<Side, CanvasRenderingContext2D | null>;
  readonly #listening = new AbortController();
  #layout: Layout | null = null;
  #hiddenSince: number | null = null;
  #choose: (choice: { side: Side; input: Input; at: number }) => void = () => {};

  constructor(display: HTMLElement, trial: TrialType<Info>, pair: Pair) {
    this.#trial = trial;
    this.#pair = pair;
    const surface = (picture: Picture) => {
      if (picture.kind === "still") return { element: picture.image, context: null };
      const canvas = h("canvas", { width: trial.width, height: trial.height });
      return { element: canvas, context: canvas.getContext("2d", { alpha: false }) };
    };
    const [left, right] = [surface(pair.left), surface(pair.right)];
    const button = (side: Side, label: string, picture: HTMLElement) =>
      h("button", { type: "button", class: "picture", "aria-label": label, "data-testid": `choice-${side}`, "data-sha256": trial[side] }, picture);
    this.#buttons = { left: button("left", "Left image", left.element), right: button("right", "Right image", right.element) };
    this.#paint = { left: left.context, right: right.context };
    this.#heading = h("h1", { tabindex: -1 }, trial.question);
    this.#footer = h("p", { class: "position", "aria-live": "polite" });
    this.#box = h("div", { class: "pair", role: "group", "aria-label": trial.question }, this.#buttons.left, this.#buttons.right);
    this.#root = h("section", { class: "trial" }, this.#heading, this.#box, this.#footer);
    display.replaceChildren(this.#root);
    this.#fit();
    const { signal } = this.#listening;
    addEventListener("resize", () => this.#fit(), { signal });
    document.addEventListener("visibilitychange", () => this.#visibility(), { signal });
  }

  /** Paints the pair and resolves at the frame after: the first at which it has been on the screen. */
  async show(periodMs: number): Promise<{ onset: number; log(): { frames: Record<Side, FrameLog> } | null; stop(): void }> {
    const { left, right } = this.#pair;
    const players = (["left", "right"] as const).flatMap((side) => {
      const picture = side === "left" ? left : right;
      if (picture.kind === "still") return [];
      const { fps, loop } = picture.manifest;
      const clock = new AnimationClock({ fps, loop, frames: picture.frames.length, periodMs });
      return [{ side, clock, picture, drawn: -1 }];
    });
    const draw = (now: number) => {
      for (const player of players) {
        const frame = player.clock.tick(now);
        const bitmap = player.picture.frames[frame];
        if (frame === player.drawn || bitmap === undefined) continue;
        this.#paint[player.side]?.drawImage(bitmap, 0, 0, this.#trial.width, this.#trial.height);
        player.drawn = frame;
      }
    };
    const decoded = [left, right].flatMap((p) => (p.kind === "still" ? [p.image.decode()] : []));
    await Promise.all(decoded); // a decoded picture may have been dropped since; this is at once otherwise
    let running = true;
    const onset = await new Promise<number>((resolve) => {
      requestAnimationFrame((now) => {
        draw(now);
        this.#box.classList.add("shown");
        this.#footer.textContent = this.#trial.position ?? "";
        this.#heading.focus({ preventScroll: true });
        requestAnimationFrame((painted) => {
          resolve(painted);
          if (players.length === 0) return;
          const loop = (at: number) => {
            if (!running) return;
            draw(at);
            requestAnimationFrame(loop);
          };
          loop(painted);
        });
      });
    });
    const log = () => {
      if (players.length === 0) return null;
      return { frames: Object.fromEntries(players.map((p) => [p.side, p.clock.log()])) as Record<Side, FrameLog> };
    };
    return { onset, log, stop: () => (running = false) };
  }

  /** The first choice after onset. */
  choice(): Promise<{ side: Side; input: Input; at: number }> {
    const { signal } = this.#listening;
    const since = performance.now();
    // An event's own time is when the hand moved; our turn may come later. Nonsense from synthetic events is not trusted.
    const when = (event: Event) => (event.timeStamp >= since && event.timeStamp <= performance.now() ? event.timeStamp : performance.now());
    return new Promise((resolve) => {
      this.#choose = resolve;
      for (const side of ["left", "right"] as const) {
        let pointer: string | null = null;
        const button = this.#buttons[side];
        button.addEventListener("pointerdown", (event) => (pointer = event.pointerType), { signal });
        button.addEventListener(
          "click",
          (event) => {
            const type = (event as PointerEvent).pointerType || pointer || "mouse";
            const input = event.detail === 0 && pointer === null ? "keyboard" : type === "mouse" ? "mouse" : "touch";
            this.#choose({ side, input, at: when(event) });
          },
          { signal },
        );
      }
      document.addEventListener(
        "keydown",
        (event) => {
          if (event.repeat || event.altKey || event.ctrlKey || event.metaKey || event.shiftKey || !this.#root.isConnected) return;
          const side = event.key === "ArrowLeft" ? "left" : event.key === "ArrowRight" ? "right" : null;
          if (side === null) return;
          event.preventDefault();
          this.#choose({ side, input: "keyboard", at: when(event) });
        },
        { signal },
      );
    });
  }

  /** How the pair was shown. */
  shown(): { scale: number; arrangement: string; device_pixel_ratio: number; viewport: [number, number] } {
    return {
      scale: (this.#layout?.scale ?? 1) * (globalThis.visualViewport?.scale ?? 1),
      arrangement: this.#layout?.arrangement ?? "side",
      device_pixel_ratio: devicePixelRatio,
      viewport: [innerWidth, innerHeight],
    };
  }

  /** Outlines the choice and takes no other. */
  mark(side: Side): void {
    this.#listening.abort();
    this.#buttons[side].classList.add("chosen");
  }

  clear(): void {
    this.#root.remove();
  }

  /** Sizes and places the pictures in whole device pixels. */
  #fit(): void {
    const { width, height } = this.#trial;
    const outer = (element: HTMLElement) => {
      const { marginTop, marginBottom } = getComputedStyle(element);
      return element.getBoundingClientRect().height + parseFloat(marginTop) + parseFloat(marginBottom);
    };
    const { paddingTop, paddingBottom } = getComputedStyle(this.#root);
    const around = outer(this.#heading) + outer(this.#footer) + parseFloat(paddingTop) + parseFloat(paddingBottom);
    const dpr = devicePixelRatio;
    const layout = fitPair({
      width,
      height,
      roomWidth: document.documentElement.clientWidth - 2 * EDGE,
      roomHeight: innerHeight - around - 2 * EDGE,
      devicePixelRatio: dpr,
    });
    this.#layout = layout;
    this.#box.classList.toggle("stack", layout.arrangement === "stack");
    this.#box.style.gap = `${layout.gap}px`;
    this.#box.style.left = this.#box.style.top = "0px";
    for (const button of Object.values(this.#buttons)) {
      const picture = button.firstElementChild as HTMLElement;
      picture.style.width = `${layout.width}px`;
      picture.style.height = `${layout.height}px`;
    }
    const { left, top } = this.#buttons.left.getBoundingClientRect();
    this.#box.style.left = `${(Math.round(left * dpr) - left * dpr) / dpr}px`;
    this.#box.style.top = `${(Math.round(top * dpr) - top * dpr) / dpr}px`;
  }

  #visibility(): void {
    const now = performance.now();
    if (document.hidden) this.#hiddenSince = now;
    else if (this.#hiddenSince !== null) {
      this.hiddenMs += now - this.#hiddenSince;
      this.#hiddenSince = null;
    }
  }
}
