/** jsPsych plugin: a page of text with one action. Its content is DOM nodes, so a study's texts can never become markup. */
import { type JsPsychPlugin, ParameterType, type TrialType } from "jspsych";
import { h } from "../shared/dom.ts";
import type { Rules } from "./inputs/guard.ts";
import { offered } from "./inputs/offered.ts";
import { inputs } from "./inputs/watch.ts";

const info = <const>{
  name: "text-page",
  version: "1.0.0",
  parameters: {
    heading: { type: ParameterType.STRING, default: undefined },
    /** Gives the page's nodes. */
    content: { type: ParameterType.FUNCTION, default: undefined },
    /** The action's words. */
    button: { type: ParameterType.STRING, default: undefined },
    /** When a press of the button counts: a double click must not press the next page's too. */
    rules: { type: ParameterType.OBJECT, default: { min_visible_ms: 0, min_gap_ms: 0 } },
    testid: { type: ParameterType.STRING, default: "continue" },
    /** May give a promise; the page goes on when it resolves. */
    action: { type: ParameterType.FUNCTION, default: () => {} },
  },
  data: {
    /** Time on the page, ms. */
    rt: { type: ParameterType.FLOAT },
  },
};

type Info = typeof info;

export default class TextPagePlugin implements JsPsychPlugin<Info> {
  static info = info;

  trial(display: HTMLElement, trial: TrialType<Info>, onLoad?: () => void): Promise<Record<string, unknown>> {
    const start = performance.now();
    const button = h("button", { type: "button", class: "action", "data-testid": trial.testid ?? "continue" }, trial.button);
    showPage(display, trial.heading, trial.content() as Node[], button);
    onLoad?.();
    const rules = trial.rules as Rules;
    offered([button], () => inputs.wait(rules, button));
    let pressed = false;
    return new Promise((resolve, reject) => {
      button.addEventListener("click", async (event) => {
        if (pressed || inputs.judge(inputs.click(event), rules, Number.POSITIVE_INFINITY) !== null) return;
        pressed = true;
        button.setAttribute("aria-disabled", "true");
        try {
          await trial.action?.();
          resolve({ rt: performance.now() - start });
        } catch (error) {
          reject(error);
        }
      });
    });
  }
}

/** Puts a page of text on the screen and the focus on its heading. */
export function showPage(display: HTMLElement, heading: string, content: Node[], action?: HTMLElement): void {
  const title = h("h1", { tabindex: -1 }, heading);
  const page = h("section", { class: "page" }, h("div", { class: "text" }, title, ...content));
  if (action !== undefined) page.append(h("div", { class: "actions" }, action));
  display.replaceChildren(page);
  scrollTo(0, 0);
  title.focus({ preventScroll: true });
}
