/** What a kind of trial is to the rest of the page: one folder whose `index.ts` exports one `TrialModule`. */
import { type JsPsych, type JsPsychPlugin, ParameterType, type PluginInfo } from "jspsych";
import type { Study, Trial } from "../api.ts";
import type { Rules } from "../inputs/guard.ts";
import type { Offered, Room, Size } from "../layout.ts";
import type { Begins, Pictures } from "../stimuli.ts";
import type { Plain } from "../words/index.ts";

export interface TrialModule {
  /** The jsPsych plugin that shows it; its name is the kind's. */
  readonly plugin: (new (jsPsych: JsPsych) => JsPsychPlugin<never>) & { readonly info: PluginInfo };
  /** The names of its stimuli in a trial's `shown`. */
  readonly roles: readonly string[];
  /** In which of the sizes that are offered its stimuli are shown, and how large, in a room. */
  readonly fit: (offered: Offered, room: Room) => Size;
  /** What the page of instructions shows of it; of a study where that depends on how its pictures would stand now. */
  readonly legend: Legend | ((study: Study) => Legend);
  /** The plugin's parameters for one trial. */
  parameters(given: Given): Record<string, unknown>;
  /** When its animations begin, by role, ms after the trial does; at once where it says nothing. */
  begins?(trial: Trial): Begins;
  /** Why a display that redraws every `periodMs` (null: not known) can't show the trial as it is asked for; null where it can. */
  refusal?(trial: Trial, periodMs: number | null): string | null;
}

/** Its words are messages without arguments, said when the page is shown. */
export interface Legend {
  /** Said only where a study has several kinds of trial. */
  title: Plain;
  /** How an answer is given with a finger alone, and with a mouse and keys. */
  how?: { touch: Plain; click: Plain };
  /** Whether the answers stand below each other. */
  stacked?: boolean;
  /** The keys of each answer, in the order in which they lie on the keyboard. */
  answers: ReadonlyArray<{ keys: readonly string[]; label: Plain }>;
}

/** What the page gives to every kind of trial. */
export interface Given {
  study: Study;
  trial: Trial;
  /** Where the trial stands, as "7 of 25". */
  position: string;
  /** The stimuli by role, at the size that fits now: ready to be shown from `begins` on. */
  load(): Promise<Pictures>;
  /** Whether what was loaded has turned out to be what the plan says; where it has not, the trial ends without an answer and is shown again. A page says what is waited for where that is asked for. */
  sound(aloud: boolean): Promise<boolean>;
  /** The display's refresh period in ms; null where it could not be measured. */
  refreshPeriod(): Promise<number | null>;
  /** The pictures have been on the screen: the next trial's may be fetched, and decoded too unless that would disturb these. */
  onOnset(decode: boolean): void;
  /** The answer is given: from now on it must not be lost. */
  onChoice(data: Record<string, unknown>): void;
}

/** Parameters that every kind's plugin has. */
export const commonParameters = <const>{
  /** The question above the pictures. */
  question: { type: ParameterType.STRING, default: undefined },
  /** Where the trial stands, as "7 of 25". */
  position: { type: ParameterType.STRING, default: "" },
  /** Stimulus pixels of the smallest size; all pictures of a trial have one size. */
  width: { type: ParameterType.INT, default: undefined },
  height: { type: ParameterType.INT, default: undefined },
  /** What is done with more room than their size fills: "native", "integer" or "fill". */
  fit: { type: ParameterType.STRING, default: "native" },
  /** Gives a promise of the pictures by role, ready to be shown. */
  load: { type: ParameterType.FUNCTION, default: undefined },
  /** Gives a promise of whether the bytes of what was loaded are the right ones, which says what it waits for where its argument is true. */
  sound: { type: ParameterType.FUNCTION, default: async () => true },
  /** Gives a promise of the display's refresh period in ms, or of null where it could not be measured. */
  refresh_period: { type: ParameterType.FUNCTION, default: undefined },
  /** Called once the pictures have been on the screen, with whether the next ones may be decoded now: the time to preload them. */
  on_onset: { type: ParameterType.FUNCTION, default: () => {} },
  /** Called with the trial's data at the choice, or when its pictures are known to be right: from then on it must not be lost. */
  on_choice: { type: ParameterType.FUNCTION, default: () => {} },
  /** When an answer counts: `min_visible_ms`, `min_gap_ms`. */
  rules: { type: ParameterType.OBJECT, default: { min_visible_ms: 0, min_gap_ms: 0 } },
  /** Whether a script may answer. */
  simulated: { type: ParameterType.BOOL, default: false },
  /** How long the choice keeps its outline, ms. */
  feedback_ms: { type: ParameterType.INT, default: 150 },
};

/** Data that every kind's plugin gives. */
export const commonData = <const>{
  /** From the first painted frame that could be answered to the choice, ms. */
  rt: { type: ParameterType.FLOAT },
  /** `performance.now()` of that frame, ms. */
  onset: { type: ParameterType.FLOAT },
  /** "mouse", "touch", "pen" or "keyboard". */
  input: { type: ParameterType.STRING },
  /** Device pixels per stimulus pixel, pinch zoom included: 1 is native. */
  scale: { type: ParameterType.FLOAT },
  /** The size at which the stimuli were shown, in their pixels. */
  stimulus_size: { type: ParameterType.INT, array: true },
  /** Width at which a stimulus stood, CSS px, pinch zoom included. */
  css_width_px: { type: ParameterType.FLOAT },
  device_pixel_ratio: { type: ParameterType.FLOAT },
  /** CSS pixels, width and height. */
  viewport: { type: ParameterType.INT, array: true },
  /** Measured, Hz; null where it could not be. */
  refresh_hz: { type: ParameterType.FLOAT },
  /** Time that the page was hidden between onset and choice, ms. */
  hidden_ms: { type: ParameterType.FLOAT },
  /** The shortest time that any of the trial's stimuli was visible before the answer, ms. */
  min_visible_ms: { type: ParameterType.FLOAT },
  /** 1 where the stimuli stood otherwise at onset, and then how. */
  geometry_changed: { type: ParameterType.INT },
  at_onset: { type: ParameterType.OBJECT },
  /** What happened to the page since the last answer, and how much more there was. */
  events: { type: ParameterType.OBJECT, array: true },
  events_dropped: { type: ParameterType.INT },
  /** Of animations only: frames that were never shown, or too late. */
  missed_frames: { type: ParameterType.INT },
  /** Of animations only: how each was played, by role. */
  frames: { type: ParameterType.OBJECT },
};

/** Parameters of a trial that a script answers. */
export const SIMULATED = { simulated: true, rules: { min_visible_ms: 0, min_gap_ms: 0 } };

/** When an input counts in a study. */
export const rulesOf = ({ response }: Pick<Study, "response">): Rules => ({ min_visible_ms: response?.min_visible_ms ?? 0, min_gap_ms: response?.min_gap_ms ?? 0 });

/** Values of the common parameters. */
export const common = ({ study, trial, position, load, sound, refreshPeriod, onOnset, onChoice }: Given) => ({
  ...{ question: study.question, position, width: trial.width, height: trial.height, fit: study.display.fit },
  ...{ load, sound, refresh_period: refreshPeriod, on_onset: onOnset, on_choice: onChoice, rules: rulesOf(study) },
});
