/** In which size pictures are shown and where they go, in whole device pixels, so that the browser never resamples what it need not. */
import type { Study } from "./api.ts";

/** What pictures may fill, CSS pixels, outlines' room already taken off. */
export interface Room {
  roomWidth: number;
  roomHeight: number;
  devicePixelRatio: number;
}

/** Width and height of a picture in its own pixels. */
export type Pixels = readonly [number, number];

/** The sizes that there are, by rising width, and what is done with more room than one fills. */
export type Offered = { sizes: readonly (readonly number[])[]; fit: Study["display"]["fit"] };

/** The size of a picture as shown. */
export interface Size {
  /** Which of the sizes it has. */
  pixels: Pixels;
  /** Device pixels per stimulus pixel: 1; whole numbers above it or any, as the fit allows; less where there is no room. */
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

/** Two pictures of one size, side by side where they are at least as large so, else stacked. */
export function fitPair(offered: Offered, room: Room): Layout {
  const [side, stack] = [arrange(offered, room, "side"), arrange(offered, room, "stack")];
  return stack.width > side.width ? stack : side;
}

/** One picture. */
export function fitOne(offered: Offered, room: Room): Size {
  const [roomW, roomH] = whole(room);
  return sized(
    choose(offered, ({ w, h }) => w <= roomW && h <= roomH),
    room,
  );
}

function arrange(offered: Offered, room: Room, arrangement: "side" | "stack"): Layout {
  const dpr = room.devicePixelRatio;
  const [roomW, roomH] = whole(room);
  const gap = (w: number) => Math.ceil(Math.max(GAP_MIN_CSS * dpr, GAP_SHARE * w));
  const shown = choose(offered, ({ w, h }) => (arrangement === "side" ? 2 * w + gap(w) <= roomW && h <= roomH : w <= roomW && 2 * h + gap(w) <= roomH));
  return { arrangement, ...sized(shown, room), gap: gap(shown.w) / dpr };
}

/** The room in whole device pixels. A product such as 1.1 × 1920 may be a whole number but for rounding. */
const whole = ({ roomWidth, roomHeight, devicePixelRatio: dpr }: Room): [number, number] => [Math.floor(roomWidth * dpr + 1e-6), Math.floor(roomHeight * dpr + 1e-6)];

/** So many device pixels of a picture of so many of its own. */
interface Shown {
  pixels: Pixels;
  w: number;
  h: number;
}

const sized = ({ pixels, w, h }: Shown, { devicePixelRatio: dpr }: Room): Size => ({ pixels, scale: w / pixels[0], width: w / dpr, height: h / dpr });

/** The largest size that fits pixel for pixel, and what the study's fit makes of the room beyond it; the smallest scaled down where none fits. */
function choose({ sizes, fit }: Offered, fits: (shown: Shown) => boolean): Shown {
  const all = sizes.map(([w = 0, h = 0]) => [w, h] as const);
  const times = (pixels: Pixels, k: number): Shown => ({ pixels, w: k * pixels[0], h: k * pixels[1] });
  if (fit === "fill") return filling(all, fits);
  const native = all.filter((pixels) => fits(times(pixels, 1))).pop();
  if (native === undefined) return shrunk(all[0] ?? [LEAST, LEAST], fits);
  let k = 1;
  while (fit === "integer" && fits(times(native, k + 1))) k += 1;
  return times(native, k);
}

/** As large as fits: of the smallest size that has at least as many pixels, or of the largest. */
function filling(sizes: readonly Pixels[], fits: (shown: Shown) => boolean): Shown {
  const largest = sizes[sizes.length - 1] ?? [LEAST, LEAST];
  let w = LEAST;
  while (fits(scaled(largest, w + 1))) w += 1;
  return shrunk(sizes.find(([own]) => own >= w) ?? largest, fits, w);
}

/** A picture never vanishes, however small the window: so many device pixels remain of its width. */
const LEAST = 16;

const scaled = (pixels: Pixels, w: number): Shown => ({ pixels, w, h: Math.round((pixels[1] * w) / pixels[0]) });

/** The largest width up to `from` in whole device pixels that fits. */
function shrunk(pixels: Pixels, fits: (shown: Shown) => boolean, from = pixels[0]): Shown {
  let shown = scaled(pixels, from);
  while (!fits(shown) && shown.w > LEAST) shown = scaled(pixels, shown.w - 1);
  return shown;
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
