/** The steps of a two-interval trial, in whole frames of the measured refresh. Pure: times in, steps out. */
import { rounded } from "../../clock.ts";
import { words } from "../../words/index.ts";

export const STEPS = ["fixation", "first", "mask", "second"] as const;
export type Step = (typeof STEPS)[number];
export type PerStep = Record<Step, number>;

const perStep = (value: (step: Step) => number) => Object.fromEntries(STEPS.map((step) => [step, value(step)])) as PerStep;

/** The requested durations, ms, of a trial's `settings`; throws where they are none. */
export function requested(settings: unknown): PerStep {
  const found = typeof settings === "object" && settings !== null ? (settings as Record<string, unknown>) : {};
  return perStep((step) => {
    const ms = found[`${step}_ms`];
    const least = step === "first" || step === "second" ? Number.MIN_VALUE : 0;
    if (typeof ms !== "number" || !(ms >= least) || !Number.isFinite(ms)) throw new Error(`${step}_ms = ${JSON.stringify(ms)}: must be a duration in ms`);
    return ms;
  });
}

/** When the pictures are shown, ms from the beginning: by the requested durations. */
export function begins(settings: unknown): Record<"first" | "second", number> {
  const ms = requested(settings);
  return { first: ms.fixation, second: ms.fixation + ms.first + ms.mask };
}

/** So many whole frames are nearest to each duration: at least one, but for what is left out. */
export function inFrames(ms: PerStep, periodMs: number): PerStep {
  return perStep((step) => (ms[step] === 0 ? 0 : Math.max(1, Math.round(ms[step] / periodMs))));
}

/** The first duration that this refresh misses by more than half a frame; null where it can show all. */
export function missed(ms: PerStep, periodMs: number): Step | null {
  const frames = inFrames(ms, periodMs);
  // A measured period is a mean: what is half a frame but for rounding passes.
  return STEPS.find((step) => Math.abs(frames[step] * periodMs - ms[step]) > periodMs / 2 + 1e-6) ?? null;
}

/** Why a display with this refresh (null: not known) can't show a trial with these `settings`, for the participant; null where it can. */
export function refusal(settings: unknown, periodMs: number | null): string | null {
  if (periodMs === null) return words("refresh-unknown");
  const ms = requested(settings);
  const step = missed(ms, periodMs);
  return step === null ? null : words("refresh-missed", { ms: ms[step], period_ms: periodMs });
}

/**
 * Which step is on at each animation frame of the browser. A step's frames are counted from the one at which it was painted,
 * in whole refreshes: a frame that the browser drops shortens nothing, is made up for where the step still lasts, and is seen
 * in what was shown.
 */
export class SequenceClock {
  readonly #plan: PerStep;
  readonly #periodMs: number;
  readonly #frames = perStep(() => 0);
  readonly #ms = perStep(() => 0);
  /** Index into `STEPS` of the step that is on; −1 before the first. */
  #at = -1;
  #last = 0;

  constructor(plan: PerStep, periodMs: number) {
    this.#plan = plan;
    this.#periodMs = periodMs;
  }

  /** The step for the refresh at `now` (ms); null when all are over. */
  tick(now: number): Step | null {
    const current = STEPS[this.#at];
    if (current !== undefined) {
      this.#frames[current] += Math.max(0, Math.round((now - this.#last) / this.#periodMs));
      this.#ms[current] += now - this.#last;
    }
    this.#last = now;
    if (current !== undefined && this.#frames[current] < this.#plan[current]) return current;
    const next = STEPS.findIndex((step, i) => i > this.#at && this.#plan[step] > 0);
    this.#at = next < 0 ? STEPS.length : next;
    return STEPS[this.#at] ?? null;
  }

  /** What each step got, in refreshes and in ms between the frames at which it and the next one were painted. */
  shown(): { frames: PerStep; ms: PerStep } {
    return { frames: { ...this.#frames }, ms: perStep((step) => rounded(this.#ms[step])) };
  }
}
