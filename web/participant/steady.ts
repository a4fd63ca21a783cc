/**
 * Makes `performance.now()` what the standard says it is: a clock that never goes back, and the one by which frames are timed. Where it is
 * not (after sleep, or where something blurs it), an answer would seem to come before its picture, and would not count until the clock has
 * caught up.
 */
export function steady(clock: () => number): { now(): number; atLeast(time: number): void } {
  let last = Number.NEGATIVE_INFINITY;
  let shift = 0;
  const atLeast = (time: number) => {
    const now = clock() + shift;
    if (now < time) shift += time - now;
  };
  const now = () => {
    atLeast(last);
    last = clock() + shift;
    return last;
  };
  return { now, atLeast };
}

const page = typeof window === "undefined" ? null : steady(performance.now.bind(performance));
if (page !== null) {
  performance.now = page.now;
  requestAnimationFrame(page.atLeast);
}

/** A frame has this time: the page's clock is not behind it from now on. */
export const frameAt = (time: number) => page?.atLeast(time);
