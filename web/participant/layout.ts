/** Where one picture or two equal ones go, in whole device pixels, so that the browser never resamples what it need not. */

export interface Space {
  /** Stimulus pixels. */
  width: number;
  height: number;
  /** CSS pixels that the pictures may fill, outlines' room already taken off. */
  roomWidth: number;
  roomHeight: number;
  devicePixelRatio: number;
}

/** The size of a picture as shown. */
export interface Size {
  /** Device pixels per stimulus pixel: 1, or less where there is no room. */
  scale: number;
  /** CSS pixels. */
  width: number;
  height: number;
}

export interface Layout extends Size {
  arrangement: "side" | "stack";
  /** CSS pixels. */
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

/** One picture, at native size where there is room, else as large as fits. */
export function fitOne(space: Space): Size {
  const [roomW, roomH] = room(space);
  const { w, h } = shrink(space, ({ w, h }) => w <= roomW && h <= roomH);
  return { scale: w / space.width, width: w / space.devicePixelRatio, height: h / space.devicePixelRatio };
}

function arrange(space: Space, arrangement: "side" | "stack"): Layout {
  const dpr = space.devicePixelRatio;
  const [roomW, roomH] = room(space);
  const gap = (w: number) => Math.ceil(Math.max(GAP_MIN_CSS * dpr, GAP_SHARE * w));
  const { w, h } = shrink(space, ({ w, h }) => (arrangement === "side" ? 2 * w + gap(w) <= roomW && h <= roomH : w <= roomW && 2 * h + gap(w) <= roomH));
  return { arrangement, scale: w / space.width, width: w / dpr, height: h / dpr, gap: gap(w) / dpr };
}

/** The room in whole device pixels. */
const room = ({ roomWidth, roomHeight, devicePixelRatio: dpr }: Space): [number, number] => [Math.floor(roomWidth * dpr), Math.floor(roomHeight * dpr)];

/** The largest size in whole device pixels that fits; a picture never vanishes, however small the window. */
function shrink({ width, height }: Space, fits: (size: { w: number; h: number }) => boolean): { w: number; h: number } {
  const sized = (w: number) => ({ w, h: Math.round((height * w) / width) });
  let size = sized(width);
  while (!fits(size) && size.w > 16) size = sized(size.w - 1);
  return size;
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
