/** The participant's page: one study, from consent to the completion code. */
import { initJsPsych } from "jspsych";
import { backoffMs, pause } from "../shared/backoff.ts";
import { h, paragraphs } from "../shared/dom.ts";
import { isTemporary, Refused } from "../shared/http.ts";
import * as api from "./api.ts";
import { describeDisplay, measureRefresh } from "./display.ts";
import { inkOn, srgbCode } from "./layout.ts";
import { Outbox } from "./outbox.ts";
import { position, remaining, withAnswered } from "./plan.ts";
import { openLoader, type Pair, Unusable } from "./stimuli.ts";
import { openStore, sessionKey } from "./storage.ts";
import { openTabs } from "./tabs.ts";
import TextPage, { showPage } from "./text-page.ts";
import TwoAlternative from "./two-alternative.ts";
import "./style.css";

/** What a browser remembers of a session. */
interface Remembered extends api.Credentials {
  reloads: number;
}

const display = h("main", { id: "study" });
const notice = h("p", { id: "notice", role: "status" });
document.body.append(display, notice);

const studyId = decodeURIComponent(location.pathname.match(/^\/study\/([^/]+)/)?.[1] ?? "");
/** What the link says of the participant, within what the server takes. */
const params = Object.fromEntries(
  [...new URLSearchParams(location.search)].filter(([name, value]) => new Blob([name]).size <= 64 && new Blob([value]).size <= 512).slice(0, 64),
);
const store = openStore(() => localStorage);
const key = sessionKey(studyId, params);

/** Says one sentence about the line, or nothing. */
const troubles = new Map<"answers" | "page" | "pictures", string>();
function say(about: "answers" | "page" | "pictures", sentence: string | null): void {
  if (sentence === null) troubles.delete(about);
  else troubles.set(about, sentence);
  const text = [...troubles.values()][0] ?? "";
  if (notice.textContent !== text) notice.textContent = text;
}

/** Tries until the server answers yes or a final no; says so when it takes longer. */
async function persist<T>(ask: () => Promise<T>): Promise<T> {
  for (let failures = 1; ; failures++) {
    try {
      const answer = await ask();
      say("page", null);
      return answer;
    } catch (error) {
      if (!isTemporary(error)) throw error;
      say("page", hindrance(error));
      const asked = error instanceof Refused ? (error.retryAfterMs ?? 0) : 0;
      await pause(Math.max(asked, backoffMs(failures)));
    }
  }
}

/** What keeps us waiting, in words that are true of it. */
function hindrance(error: unknown): string {
  if (!(error instanceof Refused)) return "No connection. Nothing is lost: this page goes on by itself when it is back.";
  if (error.code === "not_ready" || error.code === "stimuli_failed") return error.message;
  return "The server is busy. Nothing is lost: this page goes on by itself in a moment.";
}

/** A page that ends the visit, with at most one thing to do. */
function lastPage(heading: string, texts: string[], action?: HTMLElement): void {
  const screen = h("div", {});
  display.replaceChildren(screen);
  showPage(screen, heading, paragraphs(texts), action);
  document.title = heading;
}

async function start(): Promise<void> {
  const tabs = openTabs(key, () => {
    session?.outbox.stop();
    lastPage("Continued in another tab", ["You went on with this study in another tab or window. You can close this one."]);
  });
  let session: Session | null = null;
  let study: api.Study;
  let elsewhere: boolean;
  try {
    [study, elsewhere] = await Promise.all([persist(() => api.fetchStudy(studyId)), tabs.taken()]);
  } catch (error) {
    if (!(error instanceof Refused) || error.status !== 404) throw error;
    return lastPage("There is no such study", ["Please check the link you were given, or ask the person who sent it to you."]);
  }
  document.title = study.title;
  dress(study.surround);
  if (elsewhere) await askToTakeOver();
  tabs.claim();
  session = new Session(study);
  await session.run();
}

/** Sets the grey that surrounds everything, and an ink that can be read on it. */
function dress(surround: number): void {
  const code = srgbCode(surround);
  document.documentElement.style.setProperty("--surround", `rgb(${code} ${code} ${code})`);
  document.documentElement.dataset.ink = inkOn(surround);
}

function askToTakeOver(): Promise<void> {
  return new Promise((resolve) => {
    const button = h("button", { type: "button", class: "action", onclick: () => resolve() }, "Continue here");
    lastPage("This study is open in another tab", ["Please go on there, or continue in this one from where you are."], button);
  });
}

class Session {
  readonly study: api.Study;
  outbox: Outbox;
  #who: Remembered | null;
  #state: api.State | null = null;
  #lost = false;
  readonly #loader = openLoader((waiting) =>
    say("pictures", waiting ? "The pictures take longer to arrive. Nothing is lost; it goes on by itself." : null),
  );
  #refresh: Promise<number | null> | null = null;

  constructor(study: api.Study) {
    this.study = study;
    this.#who = store.read<Remembered>(key);
    this.outbox = this.#openOutbox();
  }

  async run(): Promise<void> {
    if (this.#who !== null) await this.#resume();
    addEventListener("online", () => void this.outbox.flush());
    addEventListener("beforeunload", (event) => {
      if (!store.durable && this.outbox.waiting.length > 0) event.preventDefault();
    });
    if (this.#state?.status === "completed") return this.#finish();
    void this.outbox.flush();
    rescue();

    const jsPsych = initJsPsych({ display_element: display });
    const { texts, title, question } = this.study;
    const consent = {
      type: TextPage,
      heading: title,
      content: () => [
        ...paragraphs(texts.welcome),
        h("h2", {}, "Your consent"),
        ...paragraphs(texts.consent),
        h("p", { class: "quiet" }, "If you would rather not take part, close this page: nothing has been stored. ", printLink()),
      ],
      button: "I agree and take part",
      testid: "consent-agree",
      action: () => this.#consent(),
      // jsPsych makes its container a tab stop; the page has its own.
      on_load: () => display.removeAttribute("tabindex"),
    };
    const instructions = {
      type: TextPage,
      heading: "How it works",
      content: () => [...paragraphs(texts.instructions), keys()],
      button: "Start",
      testid: "start",
      on_load: () => {
        display.removeAttribute("tabindex");
        this.#measure();
        const first = this.#remaining()[0];
        if (first !== undefined) this.#loader.preload(first, true);
      },
      action: () => this.#measure(),
    };
    // The plan is the server's, so the parameters are read when a trial begins.
    const current = () => this.#remaining()[0] as api.Trial;
    let over: api.Trial | null = null;
    const trial = {
      type: TwoAlternative,
      question,
      position: () => {
        const { number, of } = position(this.#trials, current());
        return `${number} of ${of}`;
      },
      left: () => current().left.sha256,
      right: () => current().right.sha256,
      width: () => current().width,
      height: () => current().height,
      load: () => this.#load(current()),
      refresh_period: () => this.#measure(),
      on_onset: () => {
        const [now, next] = this.#remaining();
        if (next !== undefined) this.#loader.preload(next, now?.kind !== "animation");
      },
      on_load: () => display.removeAttribute("tabindex"),
      on_choice: (data: Record<string, unknown>) => {
        const answered = current();
        this.#answered(answered, { ...data, time_elapsed: jsPsych.getTotalTime() });
        over = answered;
      },
      on_finish: () => {
        if (over !== null) this.#loader.release(over);
      },
    };
    try {
      await jsPsych.run([
        { timeline: [consent], conditional_function: () => this.#state?.consented !== true },
        { timeline: [instructions], conditional_function: () => !this.#trials.some((t) => t.answered) && this.outbox.waiting.length === 0 },
        {
          timeline: [trial],
          conditional_function: () => this.#remaining().length > 0,
          loop_function: () => this.#remaining().length > 0,
        },
      ]);
    } catch (error) {
      if (this.#lost) return;
      throw error;
    }
    await this.#finish();
  }

  get #trials(): api.Trial[] {
    return this.#state?.trials ?? [];
  }

  #remaining(): api.Trial[] {
    return remaining(this.#trials, this.outbox.indices);
  }

  /** A pair's pictures; says so when they are long in coming, for the screen is empty until then. */
  async #load(trial: api.Trial): Promise<Pair> {
    const slow = setTimeout(() => say("pictures", "The next pictures are on their way; please wait a moment."), 1000);
    try {
      return await this.#loader.load(trial);
    } finally {
      clearTimeout(slow);
      say("pictures", null);
    }
  }

  #measure(): Promise<number | null> {
    return (this.#refresh ??= measureRefresh());
  }

  /** Takes up a session this browser knows; a session that the server doesn't know any more is forgotten. */
  async #resume(): Promise<void> {
    const who = this.#who as Remembered;
    try {
      this.#state = await persist(() => api.fetchState(who));
      this.#remember({ ...who, reloads: who.reloads + 1 });
    } catch (error) {
      if (!(error instanceof Refused) || ![401, 403, 404, 410].includes(error.status)) throw error;
      store.remove(key);
      this.#who = null;
      this.outbox = this.#openOutbox();
    }
  }

  /** Nothing is stored of anybody before this. */
  async #consent(): Promise<void> {
    if (this.#who === null) {
      const { token, ...state } = await persist(() => api.createSession(this.study.id, { params, display: describeDisplay() }));
      this.#remember({ session_id: state.session_id, token, reloads: 0 });
      this.outbox = this.#openOutbox();
    }
    const who = this.#who as unknown as Remembered;
    this.#state = await persist(() => api.giveConsent(who));
  }

  #remember(who: Remembered): void {
    this.#who = who;
    store.write(key, who);
  }

  #openOutbox(): Outbox {
    const who = this.#who;
    return new Outbox(`kelir:outbox:${who?.session_id ?? "none"}`, store, {
      send: (index, answer) => api.putAnswer(who as Remembered, index, answer),
      onStored: (index) => {
        if (this.#state !== null) this.#state = { ...this.#state, trials: withAnswered(this.#state.trials, index) };
      },
      onLine: (line) => {
        const kept = store.durable ? "Your answers are kept here and sent later; you can go on." : "Please keep this page open; your answers are sent later.";
        const refused = "An answer could not be stored yet. It is kept here; you can go on.";
        // While a retry is under way the sentence stays: it would flicker otherwise.
        if (line !== "sending") say("answers", line === "waiting" ? `No connection. ${kept}` : line === "refused" ? refused : null);
      },
      setTimer: (run, ms) => setTimeout(run, ms),
      clearTimer: (timer) => clearTimeout(timer as number),
      random: Math.random,
    });
  }

  #answered(trial: api.Trial, data: Record<string, unknown>): void {
    const { name: trial_type, version: plugin_version } = TwoAlternative.info;
    const more = { trial_type, plugin_version, reload_count: this.#who?.reloads ?? 0, timestamp: new Date().toISOString() };
    this.outbox.put(trial.trial_index, { ...data, ...more } as unknown as api.Answer);
  }

  /** Waits until every answer is stored, then asks for the code: it exists only then. */
  async #finish(): Promise<void> {
    const who = this.#who as Remembered;
    const screen = h("div", {});
    display.replaceChildren(screen);
    const slow = setTimeout(() => showPage(screen, "Almost done", paragraphs(["Your last answers are being stored. This takes a moment."])), 400);
    await this.outbox.settled();
    if (this.outbox.refused.length > 0) {
      clearTimeout(slow);
      return this.#sayRefused(screen);
    }
    let completion: api.Completion;
    try {
      completion = await persist(() => api.complete(who));
    } catch (error) {
      clearTimeout(slow);
      if (!(error instanceof Refused) || error.code !== "incomplete") throw error;
      // The server misses a trial that we believed stored. Its word counts: where its plan shows the gap, a reload asks again.
      this.#state = await persist(() => api.fetchState(who));
      if (this.#remaining().length === 0) throw error;
      return location.reload();
    }
    clearTimeout(slow);
    this.#thank(screen, completion);
  }

  #thank(screen: HTMLElement, { completion_code, redirect }: api.Completion): void {
    const { thanks, debriefing } = this.study.texts;
    const code = h("output", { class: "code", "data-testid": "completion-code", "aria-label": "Your completion code" }, completion_code);
    const target = safeRedirect(redirect);
    const action =
      target !== null
        ? h("a", { class: "action", href: target.href, rel: "noreferrer" }, `Return to ${target.hostname.replace(/^(app|www)\./, "")}`)
        : copyButton(completion_code);
    const content = [
      ...paragraphs(thanks),
      h("div", { class: "receipt" }, h("p", { class: "quiet" }, "All your answers are stored. Your completion code:"), code),
      h("h2", {}, "What this study is about"),
      ...paragraphs(debriefing),
    ];
    showPage(screen, "Thank you", content, action);
  }

  #sayRefused(screen: HTMLElement): void {
    const count = this.outbox.refused.length;
    const reasons = [...new Set(this.outbox.refused.map((entry) => entry.refused ?? ""))].join(" ");
    const button = h(
      "button",
      {
        type: "button",
        class: "action",
        onclick: () => void this.outbox.retryRefused().then(() => this.#finish()),
      },
      "Try again",
    );
    const content = paragraphs([
      `${count === 1 ? "One answer" : `${count} answers`} could not be stored, so there is no completion code yet. Nothing is lost: ${count === 1 ? "it is" : "they are"} kept in this browser.`,
      `If trying again does not help, please send the researchers this text: ${reasons} Session ${this.#who?.session_id ?? ""}.`,
    ]);
    showPage(screen, "One thing is missing", content, button);
  }
}

/** Sends what earlier visits on this device left behind, such as another participant's last answers before the line went. */
function rescue(): void {
  for (const other of store.keys("kelir:session:")) {
    const who = store.read<Remembered>(other);
    if (other === key || who === null) continue;
    const left = new Outbox(`kelir:outbox:${who.session_id}`, store, {
      ...{ onStored: () => {}, onLine: () => {}, setTimer: (run, ms) => setTimeout(run, ms), clearTimer: (timer) => clearTimeout(timer as number), random: Math.random },
      send: (index, answer) => api.putAnswer(who, index, answer),
    });
    if (left.waiting.length > 0) void left.flush();
  }
}

/** The two keys, shown once. */
function keys(): HTMLElement {
  const side = (key: string, label: string) =>
    h("div", { class: "side" }, h("span", { class: "sketch", "aria-hidden": "true" }), h("span", {}, h("kbd", {}, key), ` ${label}`));
  return h("div", { class: "keys" }, side("←", "left image"), side("→", "right image"));
}

function printLink(): HTMLElement {
  return h("button", { type: "button", class: "link", onclick: () => print() }, "Print this page");
}

function copyButton(text: string): HTMLButtonElement {
  const button = h("button", { type: "button", class: "action" }, "Copy the code");
  button.addEventListener("click", () => {
    void navigator.clipboard?.writeText(text).then(
      () => (button.textContent = "Copied"),
      () => (button.textContent = "Please select the code and copy it"),
    );
  });
  return button;
}

/** A panel's return address, if it is a web address at all. */
function safeRedirect(redirect: string | null | undefined): URL | null {
  if (redirect === null || redirect === undefined || !URL.canParse(redirect)) return null;
  const url = new URL(redirect);
  return url.protocol === "https:" || url.protocol === "http:" ? url : null;
}

start().catch((error: unknown) => {
  console.error(error);
  const known = error instanceof Refused || error instanceof Unusable ? error.message : "Something in this page went wrong.";
  const again = h("button", { type: "button", class: "action", onclick: () => location.reload() }, "Reload the page");
  lastPage("The study has stopped", [`${known} Answers you have given are stored or kept in this browser; reloading goes on from there.`], again);
});
