/** Whether the page can be seen. */

/** Resolves when the page is visible: at once where it is. */
export function visible(): Promise<void> {
  return new Promise((resolve) => {
    const look = () => {
      if (document.hidden) return;
      document.removeEventListener("visibilitychange", look);
      resolve();
    };
    document.addEventListener("visibilitychange", look);
    look();
  });
}

/** Adds up how long the page is hidden, ms, from now until `signal` aborts. */
export function hiddenTime(signal: AbortSignal): () => number {
  let sum = 0;
  let since = document.hidden ? performance.now() : null;
  document.addEventListener(
    "visibilitychange",
    () => {
      const now = performance.now();
      if (since !== null) sum += now - since;
      since = document.hidden ? now : null;
    },
    { signal },
  );
  return () => sum + (since === null ? 0 : performance.now() - since);
}
