/** Where two equal pictures go, in whole device pixels, so that the browser never resamples what it need not. */

export interface Space {
  /** Stimulus pixels. */
  width: number;
  height: number;
  /** CSS pixels that the pair may fill, outlines' room already taken off. */
  roomWidth: number;
  roomHeight: number;
  devicePixelRatio: number;
}

export interface Layout {
  arrangement: "side" | "stack";
  /** Device pixels per stimulus pixel: 1, or less where two don't fit. */
  scale: number;
  /** CSS pixels. */
  width: number;
  height: number;
  gap: number;
}

/** At least 5% of the width between the pictures, and room for their two outlines. */
const GAP_SHARE = 0.05;
const GAP_MIN_CSS = 28;

/** Side by side where that is at least as large, else stacked; never above native size. */
export function fitPair(space: Space): Layout {
  const side = arrange(space, "side");
  if (side.scale === 1) return side;
  const stack = arrange(space, "stack");
  return stack.scale > side.scale ? stack : side;
}

function arrange({ width, height, roomWidth, roomHeight, devicePixelRatio: dpr }: Space, arrangement: "side" | "stack"): Layout {
  const side = arrangement === "side";
  const [roomW, roomH] = [Math.floor(roomWidth * dpr), Math.floor(roomHeight * dpr)];
  const sized = (w: number) => ({ w, h: Math.round((height * w) / width), gap: Math.ceil(Math.max(GAP_MIN_CSS * dpr, GAP_SHARE * w)) });
  const fits = ({ w, h, gap }: ReturnType<typeof sized>) =>
    side ? 2 * w + gap <= roomW && h <= roomH : w <= roomW && 2 * h + gap <= roomH;
  // A picture never vanishes, however small the window.
  let size = sized(width);
  while (!fits(size) && size.w > 16) size = sized(size.w - 1);
  return { arrangement, scale: size.w / width, width: size.w / dpr, height: size.h / dpr, gap: size.gap / dpr };
}

/** sRGB code (0 to 255) of a linear luminance, IEC 61966-2-1. */
export function srgbCode(linear: number): number {
  const l = Math.min(1, Math.max(0, linear));
  const encoded = l <= 0.0031308 ? 12.92 * l : 1.055 * l ** (1 / 2.4) - 0.055;
  return Math.round(255 * encoded);
}

/** Black or white, whichever reads better on a grey of this luminance (WCAG 2 contrast). */
export function inkOn(linear: number): "black" | "white" {
  return (linear + 0.05) / 0.05 >= 1.05 / (linear + 0.05) ? "black" : "white";
}
