/** jsPsych plugin: two pictures of equal size, stills or animations; which one? By mouse, touch, pen or the arrow keys. */
import type { JsPsych, JsPsychPlugin, TrialType } from "jspsych";
import type { Schemas } from "../../api.ts";
import { rounded } from "../../clock.ts";
import type { Pictures } from "../../stimuli.ts";
import { SIMULATED } from "../module.ts";
import { answered } from "../shared/answer.ts";
import { FALLBACK_PERIOD_MS } from "../shared/player.ts";
import { type Info, info } from "./info.ts";
import { type Pair, Stage } from "./stage.ts";

export default class TwoAlternativePlugin implements JsPsychPlugin<Info> {
  static info = info;
  readonly #jsPsych: JsPsych;

  constructor(jsPsych: JsPsych) {
    this.#jsPsych = jsPsych;
  }

  async trial(display: HTMLElement, trial: TrialType<Info>, onLoad?: () => void): Promise<Record<string, unknown>> {
    const [pictures, periodMs] = await Promise.all([trial.load() as Promise<Pictures>, trial.refresh_period() as Promise<number | null>]);
    const pair = pictures as Pair;
    const stage = new Stage(display, trial, pair);
    onLoad?.();
    const log = await stage.show(periodMs ?? FALLBACK_PERIOD_MS);
    trial.on_onset?.(pair.left.kind === "still" && pair.right.kind === "still");

    return answered(this.#jsPsych, trial, stage, (choice) => {
      const told = stage.taking.told(choice, periodMs);
      return {
        choice: choice.role,
        ...told,
        min_visible_ms: rounded(Math.max(0, told.rt - told.hidden_ms)),
        ...log(),
      } satisfies Schemas["TwoAlternativeAnswer"];
    });
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
      const where = {
        stimulus_size: [trial.width, trial.height],
        scale: 1,
        css_width_px: (trial.width ?? 0) / devicePixelRatio,
        arrangement: "side",
        device_pixel_ratio: devicePixelRatio,
        viewport: [innerWidth, innerHeight],
      };
      const data = { onset: performance.now(), input: "mouse", ...where, refresh_hz: null, hidden_ms: 0, min_visible_ms: made.rt, ...made };
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
    void this.trial(display, { ...trial, ...SIMULATED }, click).then((data) => this.#jsPsych.finishTrial(data));
  }
}
