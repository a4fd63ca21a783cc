/** Buttons say that they can't be pressed for as long as a press would not count. */

/** Says whether `buttons` can be pressed. */
export function offer(buttons: readonly HTMLButtonElement[], can: boolean): void {
  for (const button of buttons) {
    if (can) button.removeAttribute("aria-disabled");
    else button.setAttribute("aria-disabled", "true");
  }
}

/** Offers each of `buttons` once its `wait` (ms) is over, unless `signal` aborts before. What counts is judged where it is pressed; this only tells of it. */
export function offered(buttons: readonly HTMLButtonElement[], wait: (button: HTMLButtonElement) => number, signal?: AbortSignal): void {
  const look = () => {
    if (signal?.aborted === true) return;
    const waits = buttons.map((button) => [button, wait(button)] as const);
    for (const [button, left] of waits) offer([button], left <= 0);
    const next = Math.min(...waits.map(([, left]) => left).filter((left) => left > 0));
    if (Number.isFinite(next)) setTimeout(look, Math.max(1, Math.ceil(next)));
  };
  look();
}
