/** Which inputs count: none that belongs to what was on the screen before. Pure: times in, verdicts out. */

/** When an input counts as a response, ms: the study's `[response]`. */
export interface Rules {
  min_visible_ms: number;
  min_gap_ms: number;
}

/** Why an input does not count. */
export type Reason = "untrusted" | "double" | "repeat" | "held" | "early" | "gap" | "answered";

/** The beginning of an input: a key or a pointer's button that goes down. */
export interface Press {
  id: string;
  at: number;
  /** The browser says, or its missing release, that this is the last press going on. */
  repeat: boolean;
  /** How long the same key had been still; infinite for pointers. */
  quietMs: number;
  /** The input that counted last has not been let go. */
  held: boolean;
}

/** An input with what is known of it. */
export interface Attempt {
  press: Press;
  trusted: boolean;
  /** Of a click: the how-many-eth of a quick series. */
  detail: number;
  /** How long the stimulus had been visible when the press began, ms; negative before it was. */
  visibleMs: number;
}

/** A release can get lost, so a key not heard of for longer than any keyboard waits before it repeats is taken for let go, ms. */
const FORGOTTEN_MS = 2500;

/** Repeats that come as pairs of down and up are one long press: the same key counts again after half the gap without a sign of it, or this, ms. */
const QUIET_MS = 150;

/** A double touch: so soon after the one before, as a double click may be on Windows and in Chromium, ms, and within a finger's width of it, CSS px. */
const DOUBLE_MS = 500;
const DOUBLE_PX = 50;

/** Counts quick presses at one place, as a click's `detail` does: all browsers count a mouse's, and only Chromium a finger's. */
export class QuickPresses {
  #last = { at: Number.NEGATIVE_INFINITY, x: 0, y: 0, count: 0 };

  /** The how-many-eth of its series a press is. */
  count(at: number, x: number, y: number): number {
    const last = this.#last;
    const again = at - last.at < DOUBLE_MS && Math.hypot(x - last.x, y - last.y) <= DOUBLE_PX;
    this.#last = { at, x, y, count: again ? last.count + 1 : 1 };
    return this.#last.count;
  }

  /** How long a press within a box would still be a double one, ms. */
  left(at: number, { left, right, top, bottom }: Pick<DOMRect, "left" | "right" | "top" | "bottom">): number {
    const { x, y } = this.#last;
    const away = Math.hypot(Math.max(left - x, 0, x - right), Math.max(top - y, 0, y - bottom));
    return away <= DOUBLE_PX ? Math.max(0, this.#last.at + DOUBLE_MS - at) : 0;
  }
}

/** What has been pressed, let go and counted, on all pages. */
export class InputGuard {
  readonly #held = new Map<string, number>();
  readonly #released = new Map<string, number>();
  #counted: { id: string; at: number } | null = null;

  /** A key or button goes down; `repeat` is the browser's word. */
  down(id: string, at: number, repeat = false): Press {
    const key = id.startsWith("key:");
    const since = (time: number | undefined) => (time === undefined ? Number.POSITIVE_INFINITY : at - time);
    const still = this.#isHeld(id, at);
    const other = this.#counted !== null && this.#counted.id !== id && this.#isHeld(this.#counted.id, at);
    const quietMs = key ? since(this.#released.get(id)) : Number.POSITIVE_INFINITY;
    this.#held.set(id, at);
    return { id, at, repeat: repeat || (key && still), quietMs, held: other };
  }

  up(id: string, at: number): void {
    if (this.#held.delete(id)) this.#released.set(id, at);
  }

  /** Releases are not heard any more: the page has lost the focus. */
  letGo(): void {
    this.#held.clear();
  }

  /** Why an input does not count; null where it does. */
  verdict({ press, trusted, detail, visibleMs }: Attempt, rules: Rules): Reason | null {
    if (!trusted) return "untrusted";
    if (detail >= 2) return "double";
    if (press.repeat || press.quietMs < Math.max(QUIET_MS, rules.min_gap_ms / 2)) return "repeat";
    if (press.held) return "held";
    if (visibleMs < rules.min_visible_ms || visibleMs < 0) return "early";
    return this.gapLeft(press.at, rules) > 0 ? "gap" : null;
  }

  /** How long the gap after the last input that counted still lasts, ms. */
  gapLeft(at: number, { min_gap_ms }: Rules): number {
    return this.#counted === null ? 0 : Math.max(0, this.#counted.at + min_gap_ms - at);
  }

  /** An input counted at this time. */
  count(id: string, at: number): void {
    this.#counted = { id, at };
  }

  #isHeld(id: string, at: number): boolean {
    const seen = this.#held.get(id);
    return seen !== undefined && (!id.startsWith("key:") || at - seen < FORGOTTEN_MS);
  }
}
