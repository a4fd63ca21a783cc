/** One participant's session: what the server knows of it, and what still waits here to be sent. */
import { backoffMs, pause } from "../shared/backoff.ts";
import { Refused } from "../shared/http.ts";
import * as api from "./api.ts";
import { describeDisplay } from "./display.ts";
import { persist, say } from "./notice.ts";
import { Outbox } from "./outbox.ts";
import { remaining, withAnswered } from "./plan.ts";
import type { Store } from "./storage.ts";
import { words } from "./words/index.ts";

/** What a browser remembers of a session. */
interface Remembered extends api.Credentials {
  reloads: number;
}

export class Session {
  readonly #studyId: string;
  readonly #key: string;
  readonly #params: Record<string, string>;
  readonly #store: Store;
  #who: Remembered | null;
  #outbox: Outbox;
  /** What the server said last, with the answers that it has acknowledged since. */
  state: api.State | null = null;
  /** Whether the page can't go on before its answers are stored. */
  #waiting = false;

  constructor(studyId: string, key: string, params: Record<string, string>, store: Store) {
    this.#studyId = studyId;
    this.#key = key;
    this.#params = params;
    this.#store = store;
    this.#who = store.read<Remembered>(key);
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

  /** Takes up a session this browser knows; one that the server doesn't know any more is forgotten. */
  async resume(): Promise<void> {
    if (this.#who !== null) {
      const who = this.#who;
      try {
        this.state = await persist(() => api.fetchState(who));
        this.#remember({ ...who, reloads: who.reloads + 1 });
      } catch (error) {
        if (!(error instanceof Refused) || ![401, 403, 404, 410].includes(error.status)) throw error;
        this.#store.remove(this.#key);
        this.#who = null;
        this.#outbox = this.#openOutbox();
      }
    }
    addEventListener("online", () => void this.outbox.flush());
    addEventListener("beforeunload", (event) => {
      if (!this.#store.durable && this.outbox.waiting.length > 0) event.preventDefault();
    });
    void this.outbox.flush();
  }

  /** Nothing is stored of anybody before this. */
  async consent(language: string): Promise<void> {
    if (this.#who === null) {
      const { token, ...state } = await persist(() => api.createSession(this.#studyId, { params: this.#params, display: describeDisplay(language) }));
      this.#remember({ session_id: state.session_id, token, reloads: 0 });
      this.#outbox = this.#openOutbox();
    }
    const who = this.#known();
    this.state = await persist(() => api.giveConsent(who));
  }

  /** Keeps an answer and sends it. */
  answer(trial: api.Trial, data: Record<string, unknown>): void {
    const answer = { ...data, reload_count: this.#who?.reloads ?? 0, timestamp: new Date().toISOString() };
    this.outbox.put(trial.trial_index, answer as unknown as api.Answer);
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
    this.state = await persist(() => api.fetchState(who));
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
      const who = this.#store.read<Remembered>(other);
      if (other === this.#key || who === null) continue;
      const left = new Outbox(`kelir:outbox:${who.session_id}`, this.#store, {
        ...timers,
        onStored: () => {},
        onLine: () => {},
        send: (index, body) => api.putAnswer(who, index, body),
      });
      if (left.waiting.length > 0) void left.flush();
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
      send: (index, body) => api.putAnswer(who as Remembered, index, body, this.state?.trials.length),
      onStored: (index, acknowledged) => {
        if (this.state === null) return;
        const trials = withAnswered(this.state.trials, index, acknowledged?.trials);
        this.state = { ...this.state, trials, more: acknowledged?.more ?? this.state.more };
      },
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
