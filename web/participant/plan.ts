/** Which trial comes next: the server's plan, less what it has and what still waits here to be sent. */
import type { Trial } from "./api.ts";

/** The trials that are neither stored on the server nor waiting in this browser, in order. */
export function remaining(trials: readonly Trial[], waiting: ReadonlySet<number>): Trial[] {
  return trials
    .filter((trial) => !trial.answered && !waiting.has(trial.trial_index))
    .sort((a, b) => a.trial_index - b.trial_index);
}

/** "7 of 25": where a trial stands in the whole plan, counted from one. */
export function position(trials: readonly Trial[], trial: Trial): { number: number; of: number } {
  const before = trials.filter((other) => other.trial_index < trial.trial_index).length;
  return { number: before + 1, of: trials.length };
}

/** The plan with one more answer stored. */
export function withAnswered(trials: readonly Trial[], index: number): Trial[] {
  return trials.map((trial) => (trial.trial_index === index ? { ...trial, answered: true } : trial));
}
