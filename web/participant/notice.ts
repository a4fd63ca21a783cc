/** One sentence about the line at the edge of the screen, or none. */
import { backoffMs, pause } from "../shared/backoff.ts";
import { h } from "../shared/dom.ts";
import { Foreign, isTemporary, Refused } from "../shared/http.ts";
import { words } from "./words/index.ts";

export const notice = h("p", { id: "notice", role: "status" });

type About = "trial" | "answers" | "page" | "pictures";

const troubles = new Map<About, string>();
let over = false;

/** Says a sentence about one thing, or that there is nothing more to say of it. */
export function say(about: About, sentence: string | null): void {
  if (over) return;
  if (sentence === null) troubles.delete(about);
  else troubles.set(about, sentence);
  const text = troubles.get("trial") ?? [...troubles.values()][0] ?? "";
  if (notice.textContent === text) return;
  notice.textContent = text;
  document.documentElement.style.setProperty("--notice", `${notice.offsetHeight}px`);
}

/** Says nothing more: the page says itself how the visit has ended. */
export function hush(): void {
  for (const about of [...troubles.keys()]) say(about, null);
  over = true;
}

/** Tries until the server answers yes or a final no; says so when it takes longer. */
export async function persist<T>(ask: () => Promise<T>): Promise<T> {
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
  if (error instanceof Foreign || (error instanceof Refused && error.foreign && error.status < 500)) return words("line-foreign");
  if (!(error instanceof Refused)) return words("line-down");
  if (error.code === "not_ready") return words("not-ready");
  if (error.code === "stimuli_failed") return words("stimuli-failed");
  return words("server-busy");
}
