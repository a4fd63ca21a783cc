// What is on the screen, pixel by pixel.
import { inflateSync } from "node:zlib";

/** RGB rows of an 8-bit PNG with any filter (PNG 3rd ed., 9.2). */
export function pixels(png) {
  const width = png.readUInt32BE(16);
  const height = png.readUInt32BE(20);
  const channels = png[25] === 6 ? 4 : 3;
  const parts = [];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
    if (png.toString("latin1", at + 4, at + 8) === "IDAT") parts.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
  }
  const raw = inflateSync(Buffer.concat(parts));
  const stride = width * channels;
  const out = Buffer.alloc(stride * height);
  const paeth = (a, b, c) => {
    const p = a + b - c;
    const [pa, pb, pc] = [Math.abs(p - a), Math.abs(p - b), Math.abs(p - c)];
    return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
  };
  for (let y = 0; y < height; y++) {
    const filter = raw[y * (stride + 1)];
    for (let i = 0; i < stride; i++) {
      const a = i >= channels ? out[y * stride + i - channels] : 0;
      const b = y > 0 ? out[(y - 1) * stride + i] : 0;
      const c = i >= channels && y > 0 ? out[(y - 1) * stride + i - channels] : 0;
      const guess = [0, a, b, (a + b) >> 1, paeth(a, b, c)][filter];
      out[y * stride + i] = raw[y * (stride + 1) + 1 + i] + guess;
    }
  }
  return { width, height, at: (x, y) => [...out.subarray((y * width + x) * channels, (y * width + x) * channels + 3)] };
}

/** What is on the screen now, in device pixels. */
export async function screenOf({ context, page }) {
  const shot = await (await context.newCDPSession(page)).send("Page.captureScreenshot", { format: "png" });
  return pixels(Buffer.from(shot.data, "base64"));
}

/** How many of a stimulus's pixels the screen shows otherwise, `dx` device pixels to the right of (x0, y0). */
export function differing(screen, stimulus, x0, y0, dx = 0) {
  let n = 0;
  for (let y = 0; y < stimulus.height; y++) for (let x = 1; x < stimulus.width - 1; x++) if (String(screen.at(x0 + x + dx, y0 + y)) !== String(stimulus.at(x, y))) n += 1;
  return n;
}
