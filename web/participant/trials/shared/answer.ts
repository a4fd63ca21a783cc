/** How a trial ends, whatever its kind: with its answer, or with none where its pictures had come wrong. */
import type { JsPsych } from "jspsych";
import type { Schemas } from "../../api.ts";
import type { Choice, Taking } from "./taking.ts";

type Chosen = Schemas["Role"];

interface Stage<Role extends Chosen> {
  readonly taking: Taking<Role>;
  mark(role: Role): void;
  clear(): void;
}

/** What of a plugin's parameters says how it ends. */
interface Ends {
  sound?: ((aloud: boolean) => Promise<boolean>) | undefined;
  on_choice?: ((data: object) => void) | undefined;
  feedback_ms?: number | null | undefined;
}

/** Resolves when the trial is over, with what `tell` made of the choice at once; with nothing in it where it has to be shown again. */
export async function answered<Role extends Chosen>(jsPsych: JsPsych, trial: Ends, stage: Stage<Role>, tell: (choice: Choice<Role>) => Record<string, unknown>): Promise<Record<string, unknown>> {
  const sound = async (aloud: boolean) => (await trial.sound?.(aloud)) ?? true;
  const choosing = stage.taking.choice();
  const choice = await Promise.race([choosing, sound(false).then((isSound) => (isSound ? choosing : null))]);
  let data: Record<string, unknown> = {};
  if (choice !== null) {
    const told = tell(choice);
    stage.mark(choice.role);
    const marked = new Promise<void>((resolve) => jsPsych.pluginAPI.setTimeout(resolve, trial.feedback_ms ?? 150));
    if (await sound(true)) {
      data = told;
      trial.on_choice?.(data);
      await marked;
    }
  }
  stage.clear();
  return data;
}
