/** What we know of the participant's display. */
import { refreshPeriod } from "./clock.ts";
import { visible } from "./trials/shared/hidden.ts";

/**
 * Measures the refresh period over some sixty animation frames, while little else happens; begins again where the page was hidden
 * meanwhile, and gives null where a visible page gets too few frames.
 */
export async function measureRefresh(): Promise<number | null> {
  for (;;) {
    await visible();
    const times = await frameTimes();
    const period = refreshPeriod(times);
    if (period !== null || !document.hidden) return period;
  }
}

/** When the next animation frames are, ms; fewer than asked for where they don't come. */
function frameTimes(): Promise<number[]> {
  return new Promise((resolve) => {
    const times: number[] = [];
    const deadline = setTimeout(() => resolve(times), 3000);
    const step = (now: number) => {
      times.push(now);
      if (times.length <= 60) requestAnimationFrame(step);
      else {
        clearTimeout(deadline);
        resolve(times);
      }
    };
    requestAnimationFrame(step);
  });
}

/** Sent once, when the session is made; with the language in which the study is read. */
export function describeDisplay(language: string): Record<string, unknown> {
  return {
    resolution: [Math.round(screen.width * devicePixelRatio), Math.round(screen.height * devicePixelRatio)],
    viewport: [innerWidth, innerHeight],
    device_pixel_ratio: devicePixelRatio,
    color_depth: screen.colorDepth,
    wide_gamut: matchMedia("(color-gamut: p3)").matches,
    high_dynamic_range: matchMedia("(dynamic-range: high)").matches,
    touch: matchMedia("(pointer: coarse)").matches,
    reduced_motion: matchMedia("(prefers-reduced-motion: reduce)").matches,
    forced_colors: matchMedia("(forced-colors: active)").matches,
    language,
    browser_languages: navigator.languages.slice(0, 16),
    user_agent: navigator.userAgent,
  };
}
