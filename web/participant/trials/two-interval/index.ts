/** Two pictures in one place, one after the other: which one? */

import { fitOne } from "../../layout.ts";
import { common, type TrialModule } from "../module.ts";
import plugin from "./plugin.ts";
import { begins, refusal } from "./sequence.ts";

export default {
  plugin,
  roles: ["first", "second"],
  fit: fitOne,
  legend: {
    title: "kind-two-interval",
    how: { touch: "how-interval-touch", click: "how-interval-click" },
    answers: [
      { keys: ["←", "1"], label: "key-first" },
      { keys: ["→", "2"], label: "key-second" },
    ],
  },
  parameters: (given) => ({
    ...common(given),
    settings: given.trial.settings,
    surround: given.study.surround,
    trial_index: given.trial.trial_index,
  }),
  begins: ({ settings }) => begins(settings),
  refusal: ({ settings }, periodMs) => refusal(settings, periodMs),
} satisfies TrialModule;
