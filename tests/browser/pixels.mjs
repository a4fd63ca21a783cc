// What is on the screen, as the store knows it: the hash of a still's decoded pixels.

/** To be run in each page, before its own scripts. */
export function withPixelsHash() {
  /** `pixels_sha256` of what stands in an image or on a canvas. */
  globalThis.pixelsHash = async (source, width, height) => {
    const context = new OffscreenCanvas(width, height).getContext("2d");
    context.drawImage(source, 0, 0);
    const rows = context.getImageData(0, 0, width, height).data;
    const head = new TextEncoder().encode(`kelir-pixels/1\n${width} ${height} 1 0 false\n`);
    const hash = new Uint8Array(await crypto.subtle.digest("SHA-256", await new Blob([head, rows]).arrayBuffer()));
    return Array.from(hash, (byte) => byte.toString(16).padStart(2, "0")).join("");
  };
}
