/** A visit: consent, instructions, trials as they are decided, the completion code. */
import { initJsPsych, type JsPsych } from "jspsych";
import { h, paragraphs } from "../shared/dom.ts";
import { Refused } from "../shared/http.ts";
import type { Trial } from "./api.ts";
import { measureRefresh } from "./display.ts";
import { inLanguage, type Reading } from "./language.ts";
import type { Pixels } from "./layout.ts";
import { say } from "./notice.ts";
import { askAgain, consentContent, display, Ended, instructionsContent, showThanks } from "./pages.ts";
import { position } from "./plan.ts";
import type { Session } from "./session.ts";
import { atSize, pickSize } from "./sizes.ts";
import { openLoader, type Pictures, type Progress, type Sized, Unusable } from "./stimuli.ts";
import TextPage, { showPage } from "./text-page.ts";
import { loadKind, UnknownKind } from "./trials/kinds.ts";
import { rulesOf, type TrialModule } from "./trials/module.ts";
import { offerNext, type Tab } from "./whose.ts";
import { words } from "./words/index.ts";

type TimelineArray = Extract<Parameters<JsPsych["run"]>[0], unknown[]>;
/** jsPsych's description of one page or trial. */
type Node = Record<string, unknown> & { on_finish: () => Promise<void> };

/** How long a page may take before it says what it waits for, ms. */
const PATIENCE_MS = 400;

export class Visit {
  readonly #found: Reading;
  readonly #session: Session;
  readonly #tab: Tab;
  readonly #jsPsych = initJsPsych({ display_element: display });
  readonly #loader = openLoader(
    (slow) => this.#tell({ slow }),
    (progress) => this.#tell({ progress }),
  );
  /** What is known of the pictures on their way. */
  #coming: Coming = { slow: false, sentence: null, progress: { here: 0, of: 0, bytes: 0 } };
  #refresh: Promise<number | null> | null = null;
  #instructed = false;

  constructor(study: Reading, session: Session, tab: Tab) {
    this.#found = study;
    this.#session = session;
    this.#tab = tab;
  }

  /** The study as it was when the session began, in its language; before that, as it is now. */
  get #study(): Reading {
    const { state } = this.#session;
    return state === null ? this.#found : inLanguage(state.study, state.language);
  }

  async run(): Promise<void> {
    if (this.#session.state?.status !== "completed") {
      const kinds = await Promise.all(this.#study.trial_kinds.map(kindOf));
      // What comes next is asked when a page or a trial is over: jsPsych runs on into what has been added to its timeline by then.
      const timeline: Node[] = [];
      const step = async () => {
        const node = await this.#next(kinds, step);
        if (node !== null) timeline.push(node);
      };
      await step();
      if (timeline.length > 0) await this.#jsPsych.run(timeline as unknown as TimelineArray);
    }
    await this.#finish();
  }

  /** The page or trial to show now; null when all is answered. */
  async #next(kinds: readonly TrialModule[], on_finish: () => Promise<void>): Promise<Node | null> {
    if (this.#session.state?.consented !== true) return this.#consent(on_finish);
    if (!this.#instructed && !this.#session.begun) return this.#instructions(kinds, on_finish);
    this.#known();
    await this.#session.takeAgain();
    await this.#fetch();
    const trial = this.#session.remaining[0] ?? (await this.#left());
    return trial === null ? null : this.#trial(trial, await this.#kindFor(trial), on_finish);
  }

  #consent(on_finish: () => Promise<void>): Node {
    return {
      type: TextPage,
      heading: this.#study.title,
      content: () => consentContent(this.#study, this.#session.state === null),
      button: words("consent-agree"),
      testid: "consent-agree",
      rules: rulesOf(this.#study),
      action: async () => {
        await this.#session.consent(this.#study.reading);
        this.#tab.has(this.#session.id);
        await this.#fetch();
      },
      on_load: noTabStop,
      on_finish,
    };
  }

  #instructions(kinds: readonly TrialModule[], on_finish: () => Promise<void>): Node {
    this.#instructed = true;
    return {
      type: TextPage,
      heading: words("instructions-title"),
      content: () =>
        instructionsContent(
          this.#study,
          kinds.map((kind) => kind.legend),
        ),
      button: words("instructions-start"),
      testid: "start",
      rules: rulesOf(this.#study),
      on_load: () => {
        noTabStop();
        void this.#measure();
        const [first] = this.#session.remaining;
        if (first !== undefined) void this.#preload(first, true);
      },
      action: () => this.#measure(),
      on_finish,
    };
  }

  #trial(trial: Trial, kind: TrialModule, on_finish: () => Promise<void>): Node {
    const parameters = kind.parameters({
      study: this.#study,
      trial,
      position: position(this.#session.state ?? { trials: [], more: false, most_trials: 0 }, trial),
      load: () => this.#load(trial, kind),
      sound: (aloud) => this.#sound(trial, aloud),
      refreshPeriod: () => this.#measure(),
      onOnset: (decode) => {
        const next = this.#session.remaining[1];
        if (next !== undefined) void this.#preload(next, decode);
      },
      onChoice: (data) => {
        const { name: trial_type, version: plugin_version } = kind.plugin.info;
        this.#session.answer(trial, { ...data, time_elapsed: this.#jsPsych.getTotalTime(), trial_type, plugin_version });
      },
    });
    return {
      ...parameters,
      type: kind.plugin,
      on_load: noTabStop,
      on_finish: () => {
        this.#loader.release(trial);
        return on_finish();
      },
    };
  }

  /** The module of a trial's kind, if this display can show what is decided: rather no trial than half a study. */
  async #kindFor(trial: Trial): Promise<TrialModule> {
    const ahead = await Promise.all(this.#session.remaining.map(async (trial) => ({ trial, kind: await kindOf(trial.trial) })));
    for (const { trial, kind } of ahead) {
      const missing = kind.roles.find((role) => trial.shown[role] === undefined);
      if (missing !== undefined) throw new Unusable(words("picture-missing"));
      const why = kind.refusal?.(trial, await this.#measure()) ?? null;
      if (why !== null) throw new Ended(words("display-title"), [why, `${words("display-other")} ${words("kept")}`]);
    }
    return kindOf(trial.trial);
  }

  /**
   * A trial that is left once every answer has been sent: one to be taken again, or one that the server decides on from the answers;
   * null when all is answered.
   */
  async #left(): Promise<Trial | null> {
    const screen = this.#jsPsych.getDisplayElement() ?? cleared();
    const deciding = { screen, heading: words("deciding-title"), sentence: words("deciding") };
    await this.#stored(this.#session.state?.more === true ? deciding : finishing(screen));
    await patiently(deciding, this.#session.grown());
    screen.replaceChildren();
    return this.#session.remaining[0] ?? null;
  }

  /** Resolves when every answer is stored or its trial is to be taken again; one that is refused for good is said, and tried again as often as one likes. */
  async #stored(waiting: Patience): Promise<void> {
    for (;;) {
      await patiently(waiting, this.#session.settled());
      this.#known();
      const refused = this.#session.outbox.refused.map((entry) => entry.refused ?? "");
      if ((await this.#session.takeAgain()) || refused.length === 0) return;
      await askAgain(waiting.screen, refused, this.#session.id);
      await this.#session.outbox.retryRefused();
    }
  }

  /** Ends the visit where the server does not know the session any more: a reload begins anew. */
  #known(): void {
    if (this.#session.gone) throw new Ended(words("gone-title"), [words("gone")]);
  }

  /** Trials at the size that fits the window now; without those of a kind that is not known, which is said when their turn comes. */
  async #sized(trials: readonly Trial[]): Promise<Sized[]> {
    const picked = new Map<string, Pixels>();
    const sized: Sized[] = [];
    for (const trial of trials) {
      const kind = await loadKind(trial.trial).catch(() => null);
      if (kind === null) continue;
      const pixels = picked.get(trial.trial) ?? pickSize(kind, this.#study);
      picked.set(trial.trial, pixels);
      sized.push(atSize(trial, pixels));
    }
    return sized;
  }

  /** Fetches what is left to show. */
  async #fetch(): Promise<void> {
    this.#loader.ahead(await this.#sized(this.#session.remaining));
  }

  async #preload(trial: Trial, decode: boolean): Promise<void> {
    for (const sized of await this.#sized([trial])) this.#loader.preload(sized, decode);
  }

  /** A trial's pictures, at the size that fits the window when they are here. */
  #load(trial: Trial, kind: TrialModule): Promise<Pictures> {
    const now = () => atSize(trial, pickSize(kind, this.#study));
    const load = async () => {
      for (let sized = now(); ; ) {
        const pictures = await this.#loader.load(sized, kind.begins?.(trial) ?? {});
        const then = sized;
        sized = now();
        if (sized.shown === then.shown) return pictures;
      }
    };
    return this.#watched(load());
  }

  /** Whether a trial's pictures are what they should be, once that is known; where they aren't, it is said why they come once more. */
  async #sound(trial: Trial, aloud: boolean): Promise<boolean> {
    const known = this.#loader.sound(trial);
    const isSound = await (aloud ? this.#watched(known) : known);
    if (!isSound) say("trial", words("pictures-again"));
    return isSound;
  }

  /** What comes with the pictures; a page says how far they are when they are long in coming. */
  async #watched<T>(work: Promise<T>): Promise<T> {
    const sentence = h("p", { role: "status" });
    const slow = setTimeout(() => {
      showPage(this.#jsPsych.getDisplayElement() ?? cleared(), words("deciding-title"), [sentence]);
      this.#tell({ sentence });
    }, PATIENCE_MS);
    try {
      return await work;
    } finally {
      clearTimeout(slow);
      this.#tell({ sentence: null });
    }
  }

  /** Says what there is to say of the pictures on their way: how far they are to who waits for them. */
  #tell(news: Partial<Coming>): void {
    Object.assign(this.#coming, news);
    const { slow, sentence, progress } = this.#coming;
    const { here, of, bytes } = progress;
    say("pictures", slow ? words("pictures-slow") : null);
    if (sentence !== null) sentence.textContent = words("pictures-coming", { here, of, mb: bytes / 1e6 });
  }

  #measure(): Promise<number | null> {
    this.#refresh ??= measureRefresh();
    return this.#refresh;
  }

  /** Waits until every answer is stored, then asks for the code: it exists only then. */
  async #finish(): Promise<void> {
    const screen = cleared();
    const waiting = finishing(screen);
    try {
      await this.#stored(waiting);
      showThanks(screen, this.#study, await patiently(waiting, this.#session.complete()));
      if (this.#found.per_visit) offerNext(screen, this.#session, this.#tab);
    } catch (error) {
      if (!(error instanceof Refused) || error.code !== "incomplete") throw error;
      // The server misses a trial that we believed stored. Its word counts: where its plan shows the gap, a reload asks again.
      await this.#session.refresh();
      if (this.#session.remaining.length === 0 && this.#session.state?.more !== true) throw error;
      location.reload();
    }
  }
}

/** Whether the line is slow, where it is said to who waits how far the pictures are, and how far they are. */
interface Coming {
  slow: boolean;
  sentence: HTMLElement | null;
  progress: Progress;
}

/** What a page says when it keeps somebody waiting. */
interface Patience {
  screen: HTMLElement;
  heading: string;
  sentence: string;
}

const finishing = (screen: HTMLElement): Patience => ({ screen, heading: words("finishing-title"), sentence: words("finishing") });

/** Says what is waited for, where it takes longer than a moment. */
async function patiently<T>({ screen, heading, sentence }: Patience, work: Promise<T>): Promise<T> {
  const slow = setTimeout(() => showPage(screen, heading, paragraphs([sentence])), PATIENCE_MS);
  try {
    return await work;
  } finally {
    clearTimeout(slow);
  }
}

/** An empty screen of its own. */
function cleared(): HTMLElement {
  const screen = h("div", {});
  display.replaceChildren(screen);
  return screen;
}

/** A kind's module; a page that doesn't know it is older than the study. */
async function kindOf(kind: string): Promise<TrialModule> {
  try {
    return await loadKind(kind);
  } catch (error) {
    if (!(error instanceof UnknownKind)) throw error;
    throw new Ended(words("updated-title"), [words("updated"), words("kept")], error);
  }
}

/** jsPsych makes its container a tab stop; the page has its own. */
const noTabStop = () => display.removeAttribute("tabindex");
