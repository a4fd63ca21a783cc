/** The participant's page: one study, from consent to the completion code. */
import "./steady.ts";
import { Refused } from "../shared/http.ts";
import * as api from "./api.ts";
import { choose, inLanguage, type Reading } from "./language.ts";
import { inkOn, srgbCode } from "./layout.ts";
import { notice, persist } from "./notice.ts";
import { action, display, Ended, lastPage } from "./pages.ts";
import { Session } from "./session.ts";
import { Unusable } from "./stimuli.ts";
import { openStore, sessionKey } from "./storage.ts";
import { openTabs } from "./tabs.ts";
import { showPage } from "./text-page.ts";
import { showRibbon, visitOf } from "./trying.ts";
import { Visit } from "./visit.ts";
import { settle, Tab } from "./whose.ts";
import { speak, spoken, words } from "./words/index.ts";
import "./style.css";

speak(spoken(navigator.language));

const studyId = decodeURIComponent(location.pathname.match(/^\/study\/([^/]+)/)?.[1] ?? "");
const query = new URLSearchParams(location.search);
/** What the link says of the participant, within what the server takes; an id that is too long stays so, and is refused aloud. `lang` is the page's own. */
const params = Object.fromEntries(
  [...query]
    .filter(([name]) => name !== "lang" && [...name].length <= 64)
    .map(([name, value]) => [name, [...value].slice(0, 1024).join("")])
    .slice(0, 64),
);

/** How long the page may stand empty, ms; then it has at least a heading, above which a notice says what is waited for. */
const EMPTY_MS = 400;

async function start(): Promise<void> {
  const empty = setTimeout(() => display.childElementCount === 0 && showPage(display, words("deciding-title"), []), EMPTY_MS);
  const visit = await visitOf(studyId);
  const kept = visit !== "preview";
  const key = kept ? sessionKey(studyId, params) : `kelir:preview:${crypto.getRandomValues(new Uint32Array(2)).join("-")}`;
  let session: Session | null = null;
  const tabs = openTabs(key, () => {
    session?.stop();
    lastPage(words("moved-title"), [words("moved")]);
  });
  let study: api.Study;
  let elsewhere: boolean;
  try {
    [study, elsewhere] = await Promise.all([persist(() => api.fetchStudy(studyId)), tabs.taken()]);
  } catch (error) {
    if (!(error instanceof Refused) || error.status !== 404) throw error;
    return lastPage(words("no-study-title"), [words("no-study")]);
  }
  let read = dressed(study, choose(study, query.get("lang"), navigator.languages));
  showRibbon(visit);
  const store = openStore(() => (kept ? localStorage : memoryOnly()));
  session = new Session(study.id, key, params, store);
  const tab = new Tab(
    key,
    openStore(() => (kept ? sessionStorage : memoryOnly())),
  );
  await settle(session, tab, study.per_visit, elsewhere);
  clearTimeout(empty);
  tabs.claim();
  session.resume();
  if (session.state !== null) tab.has(session.id);
  // A page that is brought back as it was may be of long ago: the server's word counts.
  addEventListener("pageshow", ({ persisted }) => persisted && store.durable && location.reload());
  // A session keeps the texts and the question that it began with.
  if (session.state !== null) read = dressed(session.state.study, session.state.language);
  session.rescue();
  await new Visit(read, session, tab).run();
}

/** The study as it reads in a language; the page speaks that, too. */
function dressed(study: api.Study, language: string): Reading {
  const read = inLanguage(study, language);
  speak(language);
  dress(read);
  return read;
}

/** In place of a storage: a preview leaves nothing behind. */
function memoryOnly(): Storage {
  throw new Error("a preview keeps nothing");
}

/** Gives the page its title, the grey that surrounds everything, and an ink that can be read on it. */
function dress({ title, surround }: api.Study): void {
  document.title = title;
  const code = srgbCode(surround);
  document.documentElement.style.setProperty("--surround", `rgb(${code} ${code} ${code})`);
  document.documentElement.dataset.ink = inkOn(surround);
}

/** The end of a visit that can't go on, with what to do. */
function stop(error: unknown): void {
  console.error(error);
  const again = action(words("reload"), () => location.reload());
  const known = error instanceof Refused || error instanceof Unusable ? error.message : words("stopped");
  if (error instanceof Refused && error.code === "link_refused") lastPage(words("link-title"), [error.message]);
  else if (error instanceof Ended) lastPage(error.heading, error.texts, again);
  else lastPage(words("stopped-title"), [`${known} ${words("kept")}`], again);
}

/** Whether an error is this page's own, and none of an extension's. */
const isOurs = (error: unknown) => (error instanceof TypeError || error instanceof ReferenceError) && (error.stack ?? "").includes("/assets/participant");

if (document.documentElement.dataset.refused === undefined) {
  document.documentElement.dataset.started = "";
  document.getElementById("boot")?.remove();
  document.body.append(display, notice);
  // What fails where nobody waits for it, such as a function that a browser lacks, would leave the page standing without a word.
  addEventListener("error", ({ error }) => isOurs(error) && stop(error));
  addEventListener("unhandledrejection", ({ reason }) => isOurs(reason) && stop(reason));
  start().catch(stop);
}
