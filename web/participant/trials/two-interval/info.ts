/** What a trial is given and what its data hold, as jsPsych asks for it. */
import { ParameterType } from "jspsych";
import { commonData, commonParameters } from "../module.ts";

export const info = <const>{
  name: "two-interval",
  version: "1.2.0",
  parameters: {
    ...commonParameters,
    /** `fixation_ms`, `first_ms`, `mask_ms` and `second_ms`; no fixation and no mask where they are 0. */
    settings: { type: ParameterType.OBJECT, default: undefined },
    /** Linear luminance of the grey around the pictures, 0 to 1. */
    surround: { type: ParameterType.FLOAT, default: undefined },
    /** With the stimuli's hashes, what the mask is made from. */
    trial_index: { type: ParameterType.INT, default: 0 },
  },
  data: {
    ...commonData,
    /** "first" or "second". */
    choice: { type: ParameterType.STRING },
    /** Durations by step, ms: as asked for. */
    requested_ms: { type: ParameterType.OBJECT },
    /** Durations by step as shown, in frames of the measured refresh. */
    shown_frames: { type: ParameterType.OBJECT },
    /** Durations by step as shown, between frame times, ms. */
    shown_ms: { type: ParameterType.OBJECT },
    /** How often the trial began again, because the page was hidden before the response screen. */
    restarts: { type: ParameterType.INT },
  },
};

export type Info = typeof info;
