/** What we know of the participant's display. */
import { refreshPeriod } from "./clock.ts";

/** Measures the refresh period over some sixty animation frames, while little else happens; null when the page is hidden all along. */
export function measureRefresh(): Promise<number | null> {
  return new Promise((resolve) => {
    const times: number[] = [];
    const deadline = setTimeout(() => finish(), 3000);
    const finish = () => {
      clearTimeout(deadline);
      resolve(refreshPeriod(times));
    };
    const step = (now: number) => {
      times.push(now);
      if (times.length > 60) finish();
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  });
}

/** Sent once, when the session is made. */
export function describeDisplay(): Record<string, unknown> {
  return {
    resolution: [Math.round(screen.width * devicePixelRatio), Math.round(screen.height * devicePixelRatio)],
    viewport: [innerWidth, innerHeight],
    device_pixel_ratio: devicePixelRatio,
    color_depth: screen.colorDepth,
    wide_gamut: matchMedia("(color-gamut: p3)").matches,
    high_dynamic_range: matchMedia("(dynamic-range: high)").matches,
    touch: matchMedia("(pointer: coarse)").matches,
    reduced_motion: matchMedia("(prefers-reduced-motion: reduce)").matches,
    language: navigator.language,
    user_agent: navigator.userAgent,
  };
}
