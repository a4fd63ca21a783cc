/** jsPsych plugin: two pictures in one place, one after the other and each for its time; which one? */
import type { JsPsych, JsPsychPlugin, TrialType } from "jspsych";
import type { Schemas } from "../../api.ts";
import { rounded } from "../../clock.ts";
import type { Pictures } from "../../stimuli.ts";
import { SIMULATED } from "../module.ts";
import { answered } from "../shared/answer.ts";
import { FALLBACK_PERIOD_MS } from "../shared/player.ts";
import type { Choice } from "../shared/taking.ts";
import { type Info, info } from "./info.ts";
import { inFrames, type PerStep, requested, STEPS } from "./sequence.ts";
import { type Interval, type Intervals, Stage } from "./stage.ts";

export default class TwoIntervalPlugin implements JsPsychPlugin<Info> {
  static info = info;
  readonly #jsPsych: JsPsych;

  constructor(jsPsych: JsPsych) {
    this.#jsPsych = jsPsych;
  }

  async trial(display: HTMLElement, trial: TrialType<Info>, onLoad?: () => void): Promise<Record<string, unknown>> {
    const [pictures, measured] = await Promise.all([trial.load() as Promise<Pictures>, trial.refresh_period() as Promise<number | null>]);
    const periodMs = measured ?? FALLBACK_PERIOD_MS;
    const requested_ms = requested(trial.settings);
    const stage = new Stage(display, trial, pictures as Intervals);
    await stage.prepare();
    onLoad?.();
    const { shown, film, restarts } = await stage.show(inFrames(requested_ms, periodMs), periodMs);
    trial.on_onset?.(true);

    const tell = (choice: Choice<Interval>) =>
      ({
        choice: choice.role,
        ...stage.taking.told(choice, measured),
        min_visible_ms: Math.min(shown.ms.first, shown.ms.second),
        requested_ms,
        shown_frames: shown.frames,
        shown_ms: shown.ms,
        restarts,
        ...film,
      }) satisfies Schemas["TwoIntervalAnswer"];
    return answered(this.#jsPsych, trial, stage, tell);
  }

  /** `data-only` answers at random at once; `visual` shows the sequence and clicks. */
  simulate(trial: TrialType<Info>, mode: "data-only" | "visual", options: { data?: object }, onLoad?: () => void): void {
    const made = {
      choice: Math.random() < 0.5 ? "first" : "second",
      rt: this.#jsPsych.randomization.sampleExGaussian(600, 100, 1 / 300, true),
      ...options.data,
    };
    if (mode === "data-only") {
      onLoad?.();
      const data = { ...this.#planned(trial), ...made };
      trial.on_choice?.(data);
      this.#jsPsych.finishTrial(data);
      return;
    }
    const display = this.#jsPsych.getDisplayElement();
    const click = (decode: boolean) => {
      trial.on_onset?.(decode);
      const target = display.querySelector<HTMLElement>(`[data-testid="choice-${made.choice}"]`);
      if (target !== null) this.#jsPsych.pluginAPI.clickTarget(target, made.rt);
    };
    void this.trial(display, { ...trial, ...SIMULATED, on_onset: click }, onLoad).then((data) => this.#jsPsych.finishTrial(data));
  }

  /** The data of a trial that goes as it was asked for, on a display that nobody measured. */
  #planned(trial: TrialType<Info>): Record<string, unknown> {
    const requested_ms = requested(trial.settings);
    const shown_frames = inFrames(requested_ms, FALLBACK_PERIOD_MS);
    const shown_ms = Object.fromEntries(STEPS.map((step) => [step, rounded(shown_frames[step] * FALLBACK_PERIOD_MS)])) as PerStep;
    return {
      ...{ onset: performance.now(), input: "mouse", stimulus_size: [trial.width, trial.height], scale: 1, css_width_px: (trial.width ?? 0) / devicePixelRatio },
      ...{ device_pixel_ratio: devicePixelRatio, viewport: [innerWidth, innerHeight], refresh_hz: null, hidden_ms: 0 },
      ...{ min_visible_ms: Math.min(shown_ms.first, shown_ms.second), requested_ms, shown_frames, shown_ms, restarts: 0 },
    };
  }
}
