/** Time as the display has it: the measured refresh, and which frame of an animation belongs to which moment. */

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

/** What is logged of an animation: what was shown when. */
export interface FrameLog {
  fps: number;
  refresh_hz: number;
  /** Refreshes from the first frame to the choice. */
  refreshes: number;
  /** Animation frames drawn, and passed over without being drawn. */
  shown: number;
  skipped: number;
  /** Frames never drawn, or later than their time by more than a refresh. */
  missed_frames: number;
  /** Refreshes at which the browser did not let us draw. */
  missed_refreshes: number;
  longest_interval_ms: number;
  /** Each frame drawn: its number, counted on through loops, and ms since the first; the first `MOST_DRAWS` of them. */
  draws: Array<[number, number]>;
}

const MOST_DRAWS = 600;

/** A clock's reading is exact to this part of a refresh. */
const JITTER = 0.1;

/**
 * Which frame to draw at each animation frame of the browser: the one whose time this refresh is nearest to. It depends on
 * the time since the first frame alone, so no refresh rate, steady or not, makes a film faster or slower, and nothing adds up.
 */
export class AnimationClock {
  readonly #fps: number;
  readonly #frames: number;
  readonly #loop: boolean;
  readonly #periodMs: number;
  /** Half a refresh, so that a frame due at a refresh is not left to the clock's jitter; never more than half a frame. */
  readonly #nearestMs: number;
  #first: number | null = null;
  #last = 0;
  /** The last frame that was drawn, and the last whose time had come. */
  #count = -1;
  #due = -1;
  #log = { refreshes: 0, shown: 0, skipped: 0, late: 0, missed: 0, longest: 0, draws: [] as Array<[number, number]> };

  constructor(options: { fps: number; frames: number; loop: boolean; periodMs: number }) {
    this.#fps = options.fps;
    this.#frames = options.frames;
    this.#loop = options.loop;
    this.#periodMs = options.periodMs;
    this.#nearestMs = Math.min(options.periodMs, 1000 / options.fps) / 2;
  }

  /** The frame for the refresh at `now`, ms; the last one stays while the one whose time it is isn't here. −1 before there was any. */
  tick(now: number, isHere: (frame: number) => boolean = () => true): number {
    if (this.#first === null) this.#first = this.#last = now;
    this.#interval(now - this.#last);
    this.#last = now;
    const elapsed = now - this.#first;
    const due = Math.floor(((elapsed + this.#nearestMs) * this.#fps) / 1000);
    this.#due = Math.max(this.#due, this.#loop ? due : Math.min(due, this.#frames - 1));
    if (this.#due > this.#count && isHere(this.#due % this.#frames)) this.#draw(this.#due, elapsed);
    return this.#count % this.#frames;
  }

  log(): FrameLog {
    const { refreshes, shown, late, missed, longest, draws } = this.#log;
    // Those that are still waited for are missed too.
    const skipped = this.#log.skipped + this.#due - this.#count;
    return {
      fps: this.#fps,
      refresh_hz: rounded(1000 / this.#periodMs),
      refreshes,
      shown,
      skipped,
      missed_frames: skipped + late,
      missed_refreshes: missed,
      longest_interval_ms: rounded(longest),
      draws: [...draws],
    };
  }

  #interval(ms: number): void {
    const steps = Math.max(0, Math.round(ms / this.#periodMs));
    this.#log.refreshes += steps;
    this.#log.missed += Math.max(0, steps - 1);
    this.#log.longest = Math.max(this.#log.longest, ms);
  }

  #draw(count: number, elapsed: number): void {
    const behind = elapsed - (1000 * count) / this.#fps;
    this.#log.shown += 1;
    this.#log.skipped += count - this.#count - 1;
    if (behind > (1 + JITTER) * this.#periodMs) this.#log.late += 1;
    if (this.#log.draws.length < MOST_DRAWS) this.#log.draws.push([count, rounded(elapsed)]);
    this.#count = count;
  }
}
