/** One study, one tab: a second tab learns of the first, and may take over. */

type Message = { kind: "anyone" | "here" | "mine"; tab: string };

export interface Tabs {
  /** Whether another tab of this browser has the session open; asks and waits a moment for an answer. */
  taken(): Promise<boolean>;
  /** This tab has the session from now on; every other tab hears `lost`. */
  claim(): void;
}

/** How long an open tab has to answer: it only has to post one message. */
const ANSWER_MS = 150;

/** Null where a browser has no such line, or refuses it (private windows). */
function open(key: string): BroadcastChannel | null {
  try {
    return new BroadcastChannel(key);
  } catch {
    return null;
  }
}

/** Opens the line between the tabs of `key`; `lost` is called when another tab takes over. */
export function openTabs(key: string, lost: () => void): Tabs {
  const tab = `${Date.now()}-${Math.random()}`;
  const channel = open(key);
  let mine = false;
  let heard: (() => void) | null = null;
  channel?.addEventListener("message", ({ data }: MessageEvent<Message>) => {
    if (data.tab === tab) return;
    if (data.kind === "anyone" && mine) channel.postMessage({ kind: "here", tab } satisfies Message);
    if (data.kind === "here") heard?.();
    if (data.kind === "mine" && mine) {
      mine = false;
      lost();
    }
  });
  return {
    taken: () =>
      new Promise((resolve) => {
        if (channel === null) return resolve(false);
        const timer = setTimeout(() => resolve(false), ANSWER_MS);
        heard = () => {
          clearTimeout(timer);
          resolve(true);
        };
        channel.postMessage({ kind: "anyone", tab } satisfies Message);
      }),
    claim() {
      mine = true;
      channel?.postMessage({ kind: "mine", tab } satisfies Message);
    },
  };
}
