/**
 * Makes `performance.now()` what the standard says it is: a clock that never goes back. Where it does all the same (after sleep, or where
 * something blurs it), an answer would seem to come before its picture, and would not count until the clock has caught up.
 */
export function steady(clock: () => number): () => number {
  let last = Number.NEGATIVE_INFINITY;
  let shift = 0;
  return () => {
    const now = clock() + shift;
    if (now < last) shift += last - now;
    return (last = Math.max(last, now));
  };
}

if (typeof window !== "undefined") performance.now = steady(performance.now.bind(performance));
