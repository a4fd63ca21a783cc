/** Time as the display has it: the measured refresh, and which frame of an animation belongs to which refresh. */

/**
 * The refresh period in ms, from timestamps of successive animation frames: the mean of the intervals near their
 * median, so that a few dropped frames don't move it. `null` when there are too few intervals to say.
 */
export function refreshPeriod(timestamps: readonly number[]): number | null {
  const intervals = timestamps.slice(1).map((t, i) => t - (timestamps[i] ?? t));
  const plausible = intervals.filter((d) => d > 2 && d < 250).sort((a, b) => a - b);
  if (plausible.length < 8) return null;
  const median = plausible[plausible.length >> 1] ?? 0;
  const near = plausible.filter((d) => Math.abs(d - median) < 0.25 * median);
  return near.reduce((sum, d) => sum + d, 0) / near.length;
}

/** To three decimals: microseconds and millihertz, which is more than a browser's clock knows. */
export const rounded = (x: number): number => Math.round(x * 1000) / 1000;

/** What is logged of an animation: enough to rebuild its frame times to within a refresh. */
export interface FrameLog {
  fps: number;
  refresh_hz: number;
  /** Refreshes that each frame is shown for. */
  hold: number;
  /** Refreshes from the first frame to the choice. */
  refreshes: number;
  /** Animation frames drawn, and passed over without being drawn. */
  shown: number;
  skipped: number;
  /** Refreshes at which the browser did not let us draw. */
  missed_refreshes: number;
  longest_interval_ms: number;
  /** How often the time between two draws was so many refreshes. */
  intervals: Record<string, number>;
  /** `[refresh, refreshes late]` of the first late draws. */
  late: Array<[number, number]>;
}

/** Which frame to draw at each animation frame of the browser. */
export class AnimationClock {
  /** Refreshes per frame: the nominal frame time as a whole multiple of the measured refresh. */
  readonly hold: number;
  readonly #fps: number;
  readonly #frames: number;
  readonly #loop: boolean;
  readonly #periodMs: number;
  #last: number | null = null;
  #refresh = 0;
  #count = -1;
  #log = { shown: 0, skipped: 0, missed: 0, longest: 0, intervals: {} as Record<string, number>, late: [] as Array<[number, number]> };

  constructor(options: { fps: number; frames: number; loop: boolean; periodMs: number }) {
    this.#fps = options.fps;
    this.#frames = options.frames;
    this.#loop = options.loop;
    this.#periodMs = options.periodMs;
    this.hold = Math.max(1, Math.round(1000 / options.fps / options.periodMs));
  }

  /** The frame for the refresh at `now` (ms); each step is rounded to whole refreshes, so errors of the period don't add up. */
  tick(now: number): number {
    if (this.#last !== null) {
      const interval = now - this.#last;
      const steps = Math.max(0, Math.round(interval / this.#periodMs));
      this.#refresh += steps;
      this.#log.longest = Math.max(this.#log.longest, interval);
      this.#log.intervals[steps] = (this.#log.intervals[steps] ?? 0) + 1;
      if (steps > 1) {
        this.#log.missed += steps - 1;
        if (this.#log.late.length < 50) this.#log.late.push([this.#refresh, steps - 1]);
      }
    }
    this.#last = now;
    const count = Math.floor(this.#refresh / this.hold);
    const position = this.#loop ? count % this.#frames : Math.min(count, this.#frames - 1);
    const moved = count - this.#count;
    if (moved > 0 && (this.#loop || this.#count < this.#frames - 1)) {
      this.#log.shown += 1;
      this.#log.skipped += moved - 1;
    }
    this.#count = count;
    return position;
  }

  log(): FrameLog {
    return {
      fps: this.#fps,
      refresh_hz: rounded(1000 / this.#periodMs),
      hold: this.hold,
      refreshes: this.#refresh,
      shown: this.#log.shown,
      skipped: this.#log.skipped,
      missed_refreshes: this.#log.missed,
      longest_interval_ms: rounded(this.#log.longest),
      intervals: { ...this.#log.intervals },
      late: [...this.#log.late],
    };
  }
}
