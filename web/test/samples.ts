// Pictures for the mock server: a soft shadow on cloth, drawn here, so that no fixture has to be kept.
import { createHash } from "node:crypto";
import { crc32, deflateSync } from "node:zlib";

function chunk(type: string, data: Buffer): Buffer {
  const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
  const out = Buffer.alloc(body.length + 8);
  out.writeUInt32BE(data.length, 0);
  body.copy(out, 4);
  out.writeUInt32BE(crc32(body), body.length + 4);
  return out;
}

/** An 8-bit RGB PNG of `rgb` (row by row), of `length` bytes if that is more than it takes: a chunk that means nothing fills it up. */
export function png(width: number, height: number, rgb: Uint8Array, length = 0): Buffer {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, 2, 0, 0, 0], 8);
  const raw = Buffer.alloc((width * 3 + 1) * height);
  for (let y = 0; y < height; y++) raw.set(rgb.subarray(y * width * 3, (y + 1) * width * 3), y * (width * 3 + 1) + 1);
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  const parts = [signature, chunk("IHDR", header), chunk("IDAT", deflateSync(raw, { level: 1 })), chunk("IEND", Buffer.alloc(0))];
  const missing = length - parts.reduce((sum, part) => sum + part.length, 0) - 12;
  if (missing >= 0) parts.splice(2, 0, chunk("fiLl", Buffer.alloc(missing)));
  return Buffer.concat(parts);
}

export interface Look {
  width?: number;
  height?: number;
  turn?: number;
  soft?: number;
  noise?: number;
  seed?: number;
}

/** A leaf-shaped puppet with a row of holes, turned by `turn` radians, with edges `soft` pixels wide. */
export function shadow(look: Look = {}): Buffer {
  const { width = 592, height = 333 } = look;
  return png(width, height, shadowRows(look));
}

/** Its rows, RGB. */
export function shadowRows({ width = 592, height = 333, turn = 0, soft = 6, noise = 0, seed = 1 }: Look = {}): Uint8Array {
  const rgb = new Uint8Array(width * height * 3);
  let state = seed >>> 0 || 1;
  const random = () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
  const step = (d: number) => 1 / (1 + Math.exp(-d / (soft / 3)));
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const dx = (x - width / 2) * Math.cos(turn) + (y - height * 0.54) * Math.sin(turn);
      const dy = -(x - width / 2) * Math.sin(turn) + (y - height * 0.54) * Math.cos(turn);
      const leaf = Math.hypot(dx, (dy + 20) / 1.5) - 78 + 18 * Math.cos(6 * Math.atan2(dy, dx));
      const hole = Math.hypot(((dx + 400) % 40) - 20, ((dy + 400) % 44) - 22) - 8;
      const rod = Math.max(Math.abs(dx) - 3, 40 - dy);
      const dark = Math.max(Math.min(1 - step(leaf), step(hole)), 1 - step(rod));
      const vignette = 1 - 0.55 * (((x - width / 2) / width) ** 2 + ((y - height / 2) / height) ** 2) * 2;
      const weave = 1 + 0.03 * (((x >> 1) + (y >> 1)) % 2) + noise * (random() - 0.5);
      const light = (0.06 + 0.94 * (1 - dark)) * vignette * weave;
      for (const [i, tint] of [238, 205, 150].entries()) rgb[(y * width + x) * 3 + i] = Math.min(255, Math.max(0, tint * light));
    }
  }
  return rgb;
}

export const sha256 = (bytes: Uint8Array): string => createHash("sha256").update(bytes).digest("hex");

/** Lengths of an animation's pictures, bytes, as they are of the built-in study's. */
export const PICTURES = [
  155390, 16856, 23252, 26570, 28794, 30392, 31724, 32750, 33440, 34306, 34934, 35528, 36124, 36606, 36992, 37088, 37464, 37318, 37180, 36718, 36380, 35946, 35190, 34352, 33488, 32256, 30814, 29098,
  26982, 23972, 18564, 18550, 23752, 26598, 28556, 29978, 31186, 32122, 32870, 33606, 34600, 35318, 35896, 36600, 36820, 37130, 37054, 37182, 37106, 36906, 36564, 36146, 35466, 34666, 33700, 32360,
  31008, 29226, 26788, 23362,
];
