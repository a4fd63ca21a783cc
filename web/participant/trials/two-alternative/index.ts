/** Two pictures at once, beside or above each other: which one? */
import { common, type TrialModule } from "../module.ts";
import plugin from "./plugin.ts";

export default {
  plugin,
  roles: ["left", "right"],
  legend: {
    title: "Two pictures at once",
    answers: [
      { keys: ["←"], label: "left image" },
      { keys: ["→"], label: "right image" },
    ],
  },
  parameters: (given) => ({ ...common(given), left: given.trial.shown.left?.sha256, right: given.trial.shown.right?.sha256 }),
} satisfies TrialModule;
