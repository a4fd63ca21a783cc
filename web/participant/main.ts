/** The participant's page: one study, from consent to the completion code. */
import { Refused } from "../shared/http.ts";
import * as api from "./api.ts";
import { choose, inLanguage } from "./language.ts";
import { inkOn, srgbCode } from "./layout.ts";
import { notice, persist } from "./notice.ts";
import { action, askToTakeOver, display, Ended, lastPage } from "./pages.ts";
import { Session } from "./session.ts";
import { Unusable } from "./stimuli.ts";
import { openStore, sessionKey } from "./storage.ts";
import { openTabs } from "./tabs.ts";
import { Visit } from "./visit.ts";
import { speak, spoken, words } from "./words/index.ts";
import "./style.css";

document.body.append(display, notice);
speak(spoken(navigator.language));

const studyId = decodeURIComponent(location.pathname.match(/^\/study\/([^/]+)/)?.[1] ?? "");
const query = new URLSearchParams(location.search);
/** What the link says of the participant, within what the server takes; `lang` is the page's own. */
const params = Object.fromEntries(
  [...query].filter(([name, value]) => name !== "lang" && new Blob([name]).size <= 64 && new Blob([value]).size <= 512).slice(0, 64),
);

async function start(): Promise<void> {
  const key = sessionKey(studyId, params);
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
  study = dressed(study, choose(study, query.get("lang"), navigator.languages));
  if (elsewhere) await askToTakeOver();
  tabs.claim();
  session = new Session(study.id, key, params, openStore(() => localStorage));
  await session.resume();
  if (session.state !== null) {
    // A session keeps the texts and the question that it began with.
    study = dressed(session.state.study, session.state.language);
  }
  if (session.state?.status !== "completed") session.rescue();
  await new Visit(study, session).run();
}

/** The study as it reads in a language; the page speaks that, too. */
function dressed(study: api.Study, language: string): api.Study {
  const read = inLanguage(study, language);
  speak(language);
  document.title = read.title;
  dress(read.surround);
  return read;
}

/** Sets the grey that surrounds everything, and an ink that can be read on it. */
function dress(surround: number): void {
  const code = srgbCode(surround);
  document.documentElement.style.setProperty("--surround", `rgb(${code} ${code} ${code})`);
  document.documentElement.dataset.ink = inkOn(surround);
}

start().catch((error: unknown) => {
  console.error(error);
  const again = action(words("reload"), () => location.reload());
  if (error instanceof Ended) return lastPage(error.heading, error.texts, again);
  const known = error instanceof Refused || error instanceof Unusable ? error.message : words("stopped");
  lastPage(words("stopped-title"), [`${known} ${words("kept")}`], again);
});
