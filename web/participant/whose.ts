/** Whose visit it is: on a shared computer a study that was begun may be somebody else's. */
import { h, paragraphs } from "../shared/dom.ts";
import { action, display } from "./pages.ts";
import type { Session } from "./session.ts";
import type { Store } from "./storage.ts";
import { showPage } from "./text-page.ts";
import { words } from "./words/index.ts";

/** What a tab remembers of its visit, through reloads. */
export class Tab {
  readonly #key: string;
  readonly #store: Store;

  constructor(key: string, store: Store) {
    this.#key = key.replace("kelir:session:", "kelir:visit:");
    this.#store = store;
  }

  /** Whether this page is a reload of one that had the session, or one that was gone back to. */
  goesOn(session: string): boolean {
    return this.#store.read<string>(this.#key) === session && arrival() !== "navigate";
  }

  has(session: string): void {
    this.#store.write(this.#key, session);
  }

  leave(): void {
    this.#store.remove(this.#key);
  }
}

/** How the page was come by: "navigate", "reload" or "back_forward". */
function arrival(): string {
  const [entry] = performance.getEntriesByType?.("navigation") ?? [];
  return (entry as PerformanceNavigationTiming | undefined)?.type ?? "navigate";
}

/**
 * Settles whether the session that this browser remembers goes on. A reload does, and so does a link that names the person: who has that
 * link is that person. Of others it is asked; a code is shown to none of them, and in a kiosk (`perVisit`) nothing is told at all.
 */
export async function settle(session: Session, tab: Tab, perVisit: boolean, elsewhere: boolean): Promise<void> {
  const mine = tab.goesOn(session.id);
  if (perVisit && !mine && !elsewhere) session.leave();
  const state = await session.look();
  if (state === null) {
    if (elsewhere) await ask("elsewhere", false);
    return;
  }
  const told = state.named && !perVisit;
  const finished = state.status === "completed";
  let goesOn = mine || told || (!finished && state.status === "consent");
  if (elsewhere) goesOn = await ask("elsewhere", !told);
  else if (!goesOn && !finished) goesOn = await ask("begun", true);
  if (!goesOn) session.leave();
}

const QUESTIONS = <const>{
  begun: { title: "begun-title", text: "begun", yes: "begun-continue" },
  elsewhere: { title: "elsewhere-title", text: "elsewhere", yes: "elsewhere-continue" },
};

/** Asks whether to go on; `true` for yes, `false` for "I am someone else". */
function ask(what: keyof typeof QUESTIONS, maybeOthers: boolean): Promise<boolean> {
  const { title, text, yes } = QUESTIONS[what];
  return new Promise((resolve) => {
    const buttons = [action(words(yes), () => resolve(true))];
    if (maybeOthers) buttons.push(action(words("someone-else"), () => resolve(false)));
    const texts = [words(text), ...(maybeOthers ? [words("someone-else-note")] : [])];
    const screen = h("div", {});
    display.replaceChildren(screen);
    showPage(screen, words(title), paragraphs(texts), h("div", { class: "choices" }, ...buttons));
    document.title = words(title);
  });
}

/** How long a kiosk shows somebody's code while nobody touches anything, ms. */
const SHOWN_MS = 120_000;

/** At the end in a kiosk: back to the start for the next person, by a button, or by itself once nobody is there any more. */
export function offerNext(screen: HTMLElement, session: Session, tab: Tab): void {
  const next = () => {
    session.leave();
    tab.leave();
    location.replace(location.href);
  };
  let timer = setTimeout(next, SHOWN_MS);
  for (const event of ["pointerdown", "pointermove", "keydown"]) {
    addEventListener(event, () => {
      clearTimeout(timer);
      timer = setTimeout(next, SHOWN_MS);
    });
  }
  screen.querySelector(".actions")?.append(action(words("next-person"), next));
}
