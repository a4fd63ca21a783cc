/** Buttons say that they can't be pressed yet for as long as a press would not count. */

/** Marks `buttons` until `wait` (ms) is over. What counts is judged where it is pressed; this only tells of it. */
export function offered(buttons: readonly HTMLButtonElement[], wait: () => number, signal?: AbortSignal): void {
  const look = () => {
    const left = signal?.aborted === true ? 0 : wait();
    for (const button of buttons) {
      if (left > 0) button.setAttribute("aria-disabled", "true");
      else button.removeAttribute("aria-disabled");
    }
    if (left > 0) setTimeout(look, Math.max(1, Math.ceil(left)));
  };
  look();
}
