/** What a trial is given and what its data hold, as jsPsych asks for it. */
import { ParameterType } from "jspsych";
import { commonData, commonParameters } from "../module.ts";

export const info = <const>{
  name: "two-alternative",
  version: "1.3.0",
  parameters: commonParameters,
  data: {
    ...commonData,
    /** "left" or "right". */
    choice: { type: ParameterType.STRING },
    /** "side" or "stack". */
    arrangement: { type: ParameterType.STRING },
  },
};

export type Info = typeof info;
