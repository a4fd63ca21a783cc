/** What happened while trials were taken, kept until the next answer carries it away. */
import type { Schemas } from "../../api.ts";
import { rounded } from "../../clock.ts";

export type TrialEvent = Schemas["TrialEvent"];
type Kept = Omit<TrialEvent, "time_ms"> & { at: number };

/** So many events go with an answer, at most so many of them ignored inputs. */
const MOST = 200;
const MOST_IGNORED = 100;
/** Resizes that follow each other more quickly are one, ms: a window that is dragged sends sixty a second. */
const ONE_RESIZE_MS = 100;

/** Bounded: what comes after is only counted. */
export class EventLog {
  #kept: Kept[] = [];
  #dropped = 0;

  add(event: Omit<Kept, "at">, at = performance.now()): void {
    const last = this.#kept[this.#kept.length - 1];
    if (event.event === "resize" && last?.event === "resize" && at - last.at < ONE_RESIZE_MS) this.#kept.pop();
    const ignored = event.event === "ignored" ? this.#kept.filter((kept) => kept.event === "ignored").length : 0;
    if (this.#kept.length >= MOST || ignored >= MOST_IGNORED) this.#dropped += 1;
    else this.#kept.push({ ...event, at });
  }

  /** What was kept, in ms since a trial's onset (negative: before it), and how many there were beyond; begins anew. */
  carry(onset: number): { events?: TrialEvent[]; events_dropped?: number } {
    const events = [...this.#kept].sort((a, b) => a.at - b.at).map(({ at, ...event }) => ({ ...event, time_ms: rounded(at - onset) }));
    const dropped = this.#dropped;
    [this.#kept, this.#dropped] = [[], 0];
    return { ...(events.length > 0 && { events }), ...(dropped > 0 && { events_dropped: dropped }) };
  }

  /** Hears what happens to the page. */
  follow(view: Window): void {
    const page = view.document;
    view.addEventListener("blur", ({ target }) => target === view && this.add({ event: "blur" }));
    view.addEventListener("focus", ({ target }) => target === view && this.add({ event: "focus" }));
    page.addEventListener("visibilitychange", () => this.add({ event: page.hidden ? "hidden" : "visible" }));
    page.addEventListener("fullscreenchange", () => this.add({ event: page.fullscreenElement === null ? "fullscreen_exit" : "fullscreen_enter" }));
    // Older Safari has neither `screen.orientation` nor its event; there the resize tells of a rotation.
    view.screen.orientation?.addEventListener?.("change", () => this.add({ event: "orientation", orientation: view.screen.orientation.type }));
  }
}

let log: EventLog | null = null;

/** The page's log, which begins with the first trial: nothing is kept of anybody before consent. */
export function eventLog(): EventLog {
  if (log === null) {
    log = new EventLog();
    log.follow(window);
  }
  return log;
}
