/** Which trial comes next: the server's plan, less what it has and what still waits here to be sent. */
import type { State, Trial } from "./api.ts";
import { words } from "./words/index.ts";

/** The trials that are neither stored on the server nor waiting in this browser, in order. */
export function remaining(trials: readonly Trial[], waiting: ReadonlySet<number>): Trial[] {
  return trials.filter((trial) => !trial.answered && !waiting.has(trial.trial_index)).sort((a, b) => a.trial_index - b.trial_index);
}

/** "7 of 25": where a trial stands in the whole plan, counted from one; "7 of at most 43" while others are still to be decided. */
export function position({ trials, more, most_trials }: Pick<State, "trials" | "more" | "most_trials">, trial: Trial): string {
  const number = trials.filter((other) => other.trial_index < trial.trial_index).length + 1;
  return more ? words("position-growing", { number, most: most_trials }) : words("position", { number, all: trials.length });
}

/** The plan with one more answer stored, and the trials that were decided by it. */
export function withAnswered(trials: readonly Trial[], index: number, decided: readonly Trial[] = []): Trial[] {
  const known = new Set(trials.map((trial) => trial.trial_index));
  const all = [...trials, ...decided.filter((trial) => !known.has(trial.trial_index))];
  return all.map((trial) => (trial.trial_index === index ? { ...trial, answered: true } : trial));
}
