/**
 * Answers on their way to the server. Each is written to storage before it is sent and leaves it only when the server
 * has acknowledged it (an acknowledgement means committed), so neither a reload nor a lost line loses one.
 */
import { backoffMs } from "../shared/backoff.ts";
import { isTemporary, Refused } from "../shared/http.ts";
import type { Acknowledgement, Answer } from "./api.ts";
import type { Store } from "./storage.ts";

export interface Waiting {
  index: number;
  /** The JSON that is sent, to the byte: the server tells a resend from another answer by it. */
  body: string;
  /** The plan that its trial was shown of, where the server tells plans apart. */
  plan?: string | undefined;
  /** What the answer was in full, once its body is only what it says itself. */
  whole?: string;
  /** Set when the server refused it for good: it is kept, and not sent again by itself. */
  refused?: string;
}

/** What is found in storage: entries of pages loaded before an update hold the answer, whose JSON was made when it was sent. */
type Kept = Waiting | { index: number; answer: Answer; refused?: string };

function upgraded(kept: Kept): Waiting {
  if ("body" in kept) return kept;
  const { answer, ...rest } = kept;
  return { ...rest, body: JSON.stringify(answer) };
}

/** Whether something that lay in storage can be an entry: anybody may have written there. */
const isEntry = (kept: (Partial<Waiting> & { answer?: unknown }) | null): kept is Kept =>
  typeof kept === "object" && kept !== null && typeof kept.index === "number" && (typeof kept.body === "string" || typeof kept.answer === "object");

/** An answer without its logs: what is refused or too long in full may pass so. Null where that is no less. */
export function light(body: string): string | null {
  try {
    const fields = Object.entries(JSON.parse(body) as Answer).filter(([, value]) => typeof value !== "object");
    const short = JSON.stringify(Object.fromEntries(fields));
    return short.length < body.length ? short : null;
  } catch {
    return null;
  }
}

/** After how many vain tries through something that refuses what it carries an answer goes without its logs. */
const TRIES_IN_FULL = 3;

/** What the outside may want to say about the line. */
export type Line = "idle" | "sending" | "waiting" | "refused";

export interface Hooks {
  send(index: number, body: string, plan?: string): Promise<Acknowledgement>;
  /** The server has this trial: our answer, which it acknowledged, or (`null`) an earlier one that stands. */
  onStored(index: number, acknowledged: Acknowledgement | null): void;
  /** The session has another plan by now than the one that was answered: the answer is none, and is gone. */
  onOtherPlan(): void;
  onLine(line: Line): void;
  setTimer(run: () => void, ms: number): unknown;
  clearTimer(timer: unknown): void;
  random(): number;
}

export class Outbox {
  readonly #key: string;
  readonly #store: Store;
  readonly #hooks: Hooks;
  #sending = false;
  #stopped = false;
  #failures = 0;
  #timer: unknown = null;
  #idle: Array<() => void> = [];

  constructor(key: string, store: Store, hooks: Hooks) {
    this.#key = key;
    this.#store = store;
    this.#hooks = hooks;
  }

  /** Everything not acknowledged yet, in trial order. */
  get waiting(): Waiting[] {
    const kept = this.#store.read<unknown>(this.#key);
    return (Array.isArray(kept) ? kept : []).filter(isEntry).map(upgraded);
  }

  get indices(): Set<number> {
    return new Set(this.waiting.map((entry) => entry.index));
  }

  get refused(): Waiting[] {
    return this.waiting.filter((entry) => entry.refused !== undefined);
  }

  /** Keeps an answer and starts sending. The first answer to a trial stands. */
  put(index: number, answer: Answer, plan?: string): void {
    if (!this.indices.has(index)) {
      this.#write([...this.waiting, { index, body: JSON.stringify(answer), plan }].sort((a, b) => a.index - b.index));
    }
    void this.flush();
  }

  /** Sends what waits, now. Call it at the start, when the line is back, and for "try again". */
  async flush(): Promise<void> {
    if (this.#sending || this.#stopped) return;
    this.#clearTimer();
    this.#sending = true;
    try {
      for (let next = this.#next(); next !== undefined && !this.#stopped; next = this.#next()) {
        this.#hooks.onLine("sending");
        if (!(await this.#deliver(next))) return;
      }
    } finally {
      this.#sending = false;
    }
    if (this.#stopped) return;
    this.#hooks.onLine(this.refused.length > 0 ? "refused" : "idle");
    this.#settle();
  }

  /** Resolves when nothing waits that can still be sent; what the server refused is in `refused`. */
  settled(): Promise<void> {
    return new Promise((resolve) => {
      this.#idle.push(resolve);
      void this.flush();
    });
  }

  /** Gives refused answers another chance. */
  retryRefused(): Promise<void> {
    this.#write(this.waiting.map(({ refused: _, ...entry }) => entry));
    return this.flush();
  }

  /** Gives up an answer that was refused: its trial is to be taken again. */
  discard(index: number): void {
    this.#write(this.waiting.filter((entry) => entry.index !== index || entry.refused === undefined));
  }

  /** Sends nothing more (another tab has taken over). */
  stop(): void {
    this.#stopped = true;
    this.#clearTimer();
  }

  /** True when the entry left the queue or was set aside, false when it has to wait. */
  async #deliver(entry: Waiting): Promise<boolean> {
    const { index, body, plan } = entry;
    let acknowledged: Acknowledgement;
    try {
      acknowledged = await this.#hooks.send(index, body, plan);
    } catch (error) {
      const code = error instanceof Refused && error.status === 409 ? error.code : "";
      if (code === "already_answered" || code === "plan_changed") {
        this.#remove(index);
        if (code === "already_answered") this.#hooks.onStored(index, null);
        else this.#hooks.onOtherPlan();
        return true;
      }
      const short = entry.whole === undefined ? light(body) : null;
      if (isTemporary(error)) {
        this.#failures += 1;
        const refusing = error instanceof Refused && error.foreign && error.status < 500 && this.#failures >= TRIES_IN_FULL;
        if (refusing && short !== null) this.#replace({ ...entry, body: short, whole: body });
        const asked = error instanceof Refused ? (error.retryAfterMs ?? 0) : 0;
        const wait = Math.max(asked, backoffMs(this.#failures, this.#hooks.random));
        this.#timer = this.#stopped ? null : this.#hooks.setTimer(() => void this.flush(), wait);
        this.#hooks.onLine("waiting");
        return false;
      }
      const reason = error instanceof Error ? error.message : String(error);
      this.#replace(short === null ? { ...entry, refused: reason } : { ...entry, body: short, whole: body });
      return true;
    }
    this.#failures = 0;
    this.#remove(index);
    this.#hooks.onStored(index, acknowledged);
    return true;
  }

  #next(): Waiting | undefined {
    return this.waiting.find((entry) => entry.refused === undefined);
  }

  #remove(index: number): void {
    this.#write(this.waiting.filter((entry) => entry.index !== index));
  }

  #replace(changed: Waiting): void {
    this.#write(this.waiting.map((entry) => (entry.index === changed.index ? changed : entry)));
  }

  #write(entries: Waiting[]): void {
    if (entries.length === 0) this.#store.remove(this.#key);
    else this.#store.write(this.#key, entries);
  }

  #clearTimer(): void {
    if (this.#timer !== null) this.#hooks.clearTimer(this.#timer);
    this.#timer = null;
  }

  #settle(): void {
    for (const resolve of this.#idle.splice(0)) resolve();
  }
}
