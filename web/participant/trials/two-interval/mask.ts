/** A mask of grey blocks, the same for the same seed. */
import { srgbCode } from "../../layout.ts";

/** So many blocks stand along the shorter side. */
const BLOCKS = 32;

/** RGBA rows. The blocks' luminances are spread evenly, as far below the surround as above it, so that their mean is the surround's. */
export function mask({ width, height, surround, seed }: { width: number; height: number; surround: number; seed: number }): Uint8ClampedArray<ArrayBuffer> {
  const block = Math.max(1, Math.round(Math.min(width, height) / BLOCKS));
  const reach = Math.min(surround, 1 - surround);
  const random = generator(seed);
  const across = Math.ceil(width / block);
  const codes = Array.from({ length: across * Math.ceil(height / block) }, () => srgbCode(surround + reach * (2 * random() - 1)));
  const rgba = new Uint8ClampedArray(4 * width * height);
  for (let y = 0, at = 0; y < height; y++) {
    for (let x = 0; x < width; x++, at += 4) {
      rgba.fill(codes[Math.floor(y / block) * across + Math.floor(x / block)] ?? 0, at, at + 3);
      rgba[at + 3] = 255;
    }
  }
  return rgba;
}

/** A trial's seed: what it shows and when. */
export function seedOf(sha256s: readonly string[], trialIndex: number): number {
  return sha256s.reduce((seed, sha256) => Math.imul(seed, 31) + parseInt(sha256.slice(0, 8), 16), trialIndex + 1) >>> 0;
}

/** Numbers in [0, 1): mulberry32, of which 32 bits of state are enough for a pattern. */
function generator(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}
