/** Which of a study's sizes a trial is shown at, and its stimuli at that size. */
import type { Study, Trial } from "./api.ts";
import type { Pixels } from "./layout.ts";
import type { Sized } from "./stimuli.ts";
import type { TrialModule } from "./trials/module.ts";
import { roomFor } from "./trials/shared/place.ts";

/** The size that suits the window as it is. */
export function pickSize(kind: Pick<TrialModule, "fit">, { display, question }: Pick<Study, "display" | "question">): Pixels {
  const [width = 0, height = 0] = display.sizes[0] ?? [];
  // Measuring costs a layout of the page.
  return display.sizes.length < 2 ? [width, height] : kind.fit(display, roomFor(question)).pixels;
}

/** A trial at one of its sizes; at the smallest where it has no such. */
export function atSize(trial: Trial, [width, height]: Pixels): Sized {
  const { trial_index, kind, shown } = trial;
  const larger = trial.larger.find((larger) => larger.width === width && larger.height === height);
  return { trial_index, kind, shown: larger?.shown ?? shown };
}
