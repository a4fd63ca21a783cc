/** Two pictures at once, beside or above each other: which one? */
import { common, type TrialModule } from "../module.ts";
import plugin from "./plugin.ts";

export default {
  plugin,
  roles: ["left", "right"],
  legend: {
    title: "kind-two-alternative",
    answers: [
      { keys: ["←"], label: "key-left" },
      { keys: ["→"], label: "key-right" },
    ],
  },
  parameters: (given) => ({ ...common(given), left: given.trial.shown.left?.sha256, right: given.trial.shown.right?.sha256 }),
} satisfies TrialModule;
