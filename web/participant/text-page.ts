/** jsPsych plugin: a page of text with one action. Its content is DOM nodes, so a study's texts can never become markup. */
import { type JsPsychPlugin, ParameterType, type TrialType } from "jspsych";
import { h } from "../shared/dom.ts";

const info = <const>{
  name: "text-page",
  version: "1.0.0",
  parameters: {
    heading: { type: ParameterType.STRING, default: undefined },
    /** Gives the page's nodes. */
    content: { type: ParameterType.FUNCTION, default: undefined },
    /** The action's words. */
    button: { type: ParameterType.STRING, default: undefined },
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
    return new Promise((resolve, reject) => {
      button.addEventListener("click", async () => {
        if (button.getAttribute("aria-disabled") === "true") return;
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
