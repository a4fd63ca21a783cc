/** One participant's session: what the server knows of it, and what still waits here to be sent. */
import { backoffMs, pause } from "../shared/backoff.ts";
import { Refused } from "../shared/http.ts";
import * as api from "./api.ts";
import { describeDisplay } from "./display.ts";
import { persist, say } from "./notice.ts";
import { Outbox } from "./outbox.ts";
import { Ended } from "./pages.ts";
import { remaining, withAnswered } from "./plan.ts";
import type { Store } from "./storage.ts";
import { words } from "./words/index.ts";

/** What a browser remembers of a session. */
interface Remembered extends api.Credentials {
  reloads: number;
}

/** What lay in storage, if it can be a session: anybody may have written there. */
function remembered(kept: Partial<Remembered> | null): Remembered | null {
  const { session_id, token, reloads } = typeof kept === "object" && kept !== null ? kept : {};
  return typeof session_id === "string" && typeof token === "string" ? { session_id, token, reloads: typeof reloads === "number" ? reloads : 0 } : null;
}

/** Why there is no session, as a page of its own where it is the link's doing. */
function noSession(error: unknown): unknown {
  const code = error instanceof Refused ? error.code : "";
  if (code === "already_finished") return new Ended(words("finished-title"), [words("finished")], error);
  if (code === "already_begun") return new Ended(words("begun-elsewhere-title"), [words("begun-elsewhere")], error);
  if (code === "invalid_field") return new Ended(words("link-title"), [words("link")], error);
  return error;
}

/** Stands between a session's key and its id once it is left. */
const LEFT = "#";

export class Session {
  readonly #studyId: string;
  readonly #key: string;
  readonly #params: Record<string, string>;
  readonly #store: Store;
  #who: Remembered | null;
  #outbox: Outbox;
  /** What the server said last, with the answers that it has acknowledged since. */
  state: api.State | null = null;
  /** Whether the server has said that it does not know the session. */
  gone = false;
  /** Trials that are taken again because their answers were refused. */
  readonly #again = new Set<number>();
  /** Whether the server has another plan for the session than the one told. */
  #replanned = false;
  /** Whether the page can't go on before its answers are stored. */
  #waiting = false;

  constructor(studyId: string, key: string, params: Record<string, string>, store: Store) {
    this.#studyId = studyId;
    this.#key = key;
    this.#params = params;
    this.#store = store;
    this.#who = remembered(store.read(key));
    this.#outbox = this.#openOutbox();
  }

  get id(): string {
    return this.#who?.session_id ?? "";
  }

  /** Answers that are not stored yet. */
  get outbox(): Outbox {
    return this.#outbox;
  }

  /** What is left to show of what is decided. */
  get remaining(): api.Trial[] {
    return remaining(this.state?.trials ?? [], this.outbox.indices);
  }

  /** Whether anything has been answered, stored or not. */
  get begun(): boolean {
    return this.outbox.waiting.length > 0 || (this.state?.trials ?? []).some((trial) => trial.answered);
  }

  /** What the server says of the session that this browser knows; one that the server doesn't know any more is forgotten. */
  async look(): Promise<api.State | null> {
    if (this.#who === null) return null;
    const who = this.#who;
    try {
      this.state = await persist(() => api.fetchState(who, this.outbox.waiting.length));
    } catch (error) {
      if (!(error instanceof Refused) || ![401, 403, 404, 410].includes(error.status)) throw error;
      this.#forget();
    }
    return this.state;
  }

  /** Takes the session up, and sends what waits. */
  resume(): void {
    if (this.#who !== null) this.#remember({ ...this.#who, reloads: this.#who.reloads + 1 });
    addEventListener("online", () => void this.outbox.flush());
    addEventListener("beforeunload", (event) => {
      if (!this.#store.durable && this.outbox.waiting.length > 0) event.preventDefault();
    });
    void this.outbox.flush();
  }

  /** Leaves the session to whom it belongs: whoever is here begins anew, and what waits of the other is still sent. */
  leave(): void {
    if (this.#who !== null) this.#store.write(`${this.#key}${LEFT}${this.#who.session_id}`, this.#who);
    this.#forget();
  }

  #forget(): void {
    this.#store.remove(this.#key);
    this.#store.remove(this.#startKey);
    this.#who = null;
    this.state = null;
    this.#outbox = this.#openOutbox();
  }

  /** Where the key is kept by which the server knows that a session begun again is the same one. */
  get #startKey(): string {
    return this.#key.replace("kelir:session:", "kelir:start:");
  }

  /** Nothing is stored of anybody before this. */
  async consent(language: string): Promise<void> {
    if (this.#who === null) {
      const { token, ...state } = await this.#create(language);
      this.#remember({ session_id: state.session_id, token, reloads: 0 });
      this.#store.remove(this.#startKey);
      this.#outbox = this.#openOutbox();
    }
    const who = this.#known();
    this.state = await persist(() => api.giveConsent(who));
  }

  /** Begins a session. Its key stays until the reply is here, so that a lost reply makes no second session; in another language it is another one. */
  async #create(language: string): Promise<api.Schemas["CreatedSession"]> {
    const key = this.#store.read<string>(this.#startKey) ?? randomKey();
    this.#store.write(this.#startKey, key);
    try {
      return await persist(() => api.createSession(this.#studyId, { params: this.#params, display: describeDisplay(language) }, `${key}-${language}`));
    } catch (error) {
      // A final no: the next try is another one.
      this.#store.remove(this.#startKey);
      throw noSession(error);
    }
  }

  /** Keeps an answer and sends it. */
  answer(trial: api.Trial, data: Record<string, unknown>): void {
    const answer = { ...data, reload_count: this.#who?.reloads ?? 0, timestamp: new Date().toISOString() };
    say("trial", null);
    this.outbox.put(trial.trial_index, answer as unknown as api.Answer, this.state?.plan);
  }

  /** Resolves when every answer is stored, or refused for good. */
  async settled(): Promise<void> {
    this.#waiting = true;
    try {
      await this.outbox.settled();
    } finally {
      this.#waiting = false;
    }
  }

  /**
   * Gives up each answer that was refused for the first time, and asks for the plan that the session has by now: what was given up is left to be taken
   * again. Says whether there was any.
   */
  async takeAgain(): Promise<boolean> {
    const again = this.outbox.refused.filter(({ index }) => !this.#again.has(index));
    for (const { index } of again) {
      this.#again.add(index);
      this.outbox.discard(index);
    }
    if (again.length > 0) {
      say("answers", null);
      say("trial", words("answer-again"));
    }
    const replanned = this.#replanned;
    if (replanned) {
      this.#replanned = false;
      await this.refresh();
      say("trial", words("answer-other"));
    }
    return again.length > 0 || replanned;
  }

  /** Waits until the server, which has all answers, has decided on more trials or says that there are no more. */
  async grown(): Promise<void> {
    for (let tries = 1; this.state?.more === true && this.remaining.length === 0; tries++) {
      await this.refresh();
      if (this.state.more && this.remaining.length === 0) await pause(backoffMs(tries));
    }
  }

  /** Asks the server again: its word counts. */
  async refresh(): Promise<void> {
    const who = this.#known();
    this.state = await persist(() => api.fetchState(who, this.outbox.waiting.length));
  }

  complete(): Promise<api.Completion> {
    const who = this.#known();
    return persist(() => api.complete(who));
  }

  /** Sends nothing more (another tab has taken over). */
  stop(): void {
    this.outbox.stop();
  }

  /** Sends what earlier visits on this device left behind, such as another participant's last answers before the line went. */
  rescue(): void {
    for (const other of this.#store.keys("kelir:session:")) {
      const who = remembered(this.#store.read(other));
      if (other === this.#key || who === null) continue;
      const left = new Outbox(`kelir:outbox:${who.session_id}`, this.#store, {
        ...timers,
        onStored: () => {},
        onOtherPlan: () => {},
        onLine: () => {},
        send: (index, body, plan) => api.putAnswer(who, index, body, plan),
      });
      if (left.waiting.length > 0) void left.flush();
      else if (other.includes(LEFT)) this.#store.remove(other);
    }
  }

  #known(): Remembered {
    if (this.#who === null) throw new Error("there is no session yet");
    return this.#who;
  }

  #remember(who: Remembered): void {
    this.#who = who;
    this.#store.write(this.#key, who);
  }

  #openOutbox(): Outbox {
    const who = this.#who;
    return new Outbox(`kelir:outbox:${who?.session_id ?? "none"}`, this.#store, {
      ...timers,
      send: async (index, body, plan) => {
        try {
          return await api.putAnswer(who as Remembered, index, body, plan, this.state?.trials.length);
        } catch (error) {
          if (error instanceof Refused && error.code === "unauthorized") this.gone = true;
          throw error;
        }
      },
      onStored: (index, acknowledged) => {
        if (this.state === null) return;
        const trials = withAnswered(this.state.trials, index, acknowledged?.trials);
        this.state = { ...this.state, trials, more: acknowledged?.more ?? this.state.more };
      },
      onOtherPlan: () => (this.#replanned = true),
      onLine: (line) => {
        const kept = this.#store.durable ? (this.#waiting ? "answers-kept-waiting" : "answers-kept") : this.#waiting ? "answers-held-waiting" : "answers-held";
        const refused = this.#waiting ? "answers-refused-waiting" : "answers-refused";
        // While a retry is under way the sentence stays: it would flicker otherwise.
        if (line !== "sending") say("answers", line === "waiting" ? words(kept) : line === "refused" ? words(refused) : null);
      },
    });
  }
}

const timers = {
  setTimer: (run: () => void, ms: number) => setTimeout(run, ms),
  clearTimer: (timer: unknown) => clearTimeout(timer as number),
  random: Math.random,
};

/** A text that nobody else has. */
const randomKey = () => Array.from({ length: 4 }, () => Math.random().toString(36).slice(2)).join("");
