/** Two pictures at once, beside or above each other: which one? */
import type { Study } from "../../api.ts";
import { fitPair } from "../../layout.ts";
import { common, type Legend, type TrialModule } from "../module.ts";
import { roomFor } from "../shared/place.ts";
import plugin from "./plugin.ts";

const how = { touch: "how-pair-touch", click: "how-pair-click" } as const;

/** The keys lie as the pictures would stand in the window as it is. */
function legend({ question, display }: Study): Legend {
  const stacked = fitPair(display, roomFor(question)).arrangement === "stack";
  const [first, second] = stacked
    ? ([
        { keys: ["↑"], label: "key-upper" },
        { keys: ["↓"], label: "key-lower" },
      ] as const)
    : ([
        { keys: ["←"], label: "key-left" },
        { keys: ["→"], label: "key-right" },
      ] as const);
  return { title: "kind-two-alternative", how, stacked, answers: [first, second] };
}

export default {
  plugin,
  roles: ["left", "right"],
  fit: fitPair,
  legend,
  parameters: common,
} satisfies TrialModule;
