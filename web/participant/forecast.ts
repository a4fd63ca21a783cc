/** Whether a film that is still on its way can begin: every picture must be here and decoded before its time. Pure: numbers in, a forecast out. */

/** This part of the measured rate is counted on. */
const SURE = 0.85;
/** So long before its time a picture must be ready, ms. */
const SPARE_MS = 100;
/** A rate that was measured for less is none, ms. */
const LEAST_MS = 500;
/** "Lately", ms. */
const RECENT_MS = 1000;

/** What is known of a film on its way. */
export interface OnItsWay {
  /** Bytes that are here, and how many come in a millisecond. */
  here: number;
  rate: number;
  /** Pictures that are decoded, and how long one takes, ms. */
  decoded: number;
  decodeMs: number;
  /** Of each picture: which byte is its last, and when it is shown first, ms from now if the trial begins now. */
  pictures: ReadonlyArray<{ end: number; dueMs: number }>;
}

/** Whether every picture is decoded before its time if the trial begins now and the line goes on nearly as it does. */
export function playsThrough({ here, rate, decoded, decodeMs, pictures }: OnItsWay): boolean {
  let readyMs = 0;
  return pictures.slice(decoded).every(({ end, dueMs }) => {
    const comesMs = end <= here ? 0 : (end - here) / (SURE * rate);
    readyMs = Math.max(readyMs, comesMs) + decodeMs;
    return readyMs + SPARE_MS <= dueMs;
  });
}

/** How fast bytes come. */
export class Rate {
  /** Bytes in all by a time, ms: since a second ago, and at the first of them. */
  #lately: Array<readonly [number, number]> = [];
  #first: readonly [number, number] | null = null;
  #total = 0;

  add(bytes: number, now: number): void {
    this.#total += bytes;
    this.#first ??= [now, this.#total];
    this.#lately.push([now, this.#total]);
    while ((this.#lately[1]?.[0] ?? now) <= now - RECENT_MS) this.#lately.shift();
  }

  /** Bytes a millisecond: lately or all the time, whichever is less; 0 while that can't be said. The first bytes say nothing: nobody knows since when they came. */
  at(now: number): number {
    if (this.#first === null || now - this.#first[0] < LEAST_MS) return 0;
    const since = ([from, had]: readonly [number, number]) => (this.#total - had) / (now - from);
    const recent = this.#lately.filter(([at]) => at <= now - RECENT_MS).pop() ?? this.#lately[0] ?? this.#first;
    return Math.min(since(this.#first), since(recent));
  }
}
