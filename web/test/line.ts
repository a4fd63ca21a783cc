/** A slow line, shared fairly by what comes over it at a time. */
import type { ServerResponse } from "node:http";

const TICK_MS = 10;

export class Line {
  /** Bytes a second. */
  rate: number;
  /** Bytes that have gone out. */
  sent = 0;
  #after: { bytes: number; run: () => void } | null = null;
  readonly #sending = new Map<ServerResponse, Buffer>();
  readonly #timer: NodeJS.Timeout;

  constructor(rate: number) {
    this.rate = rate;
    let last = performance.now();
    this.#timer = setInterval(() => {
      const now = performance.now();
      this.#send((this.rate * (now - last)) / 1000);
      last = now;
    }, TICK_MS);
  }

  /** Sends bytes, as the line allows, and ends the response. */
  send(data: Buffer, response: ServerResponse): void {
    response.once("close", () => this.#sending.delete(response));
    response.flushHeaders();
    this.#sending.set(response, data);
  }

  /** Does something once so many bytes have gone out. */
  after(bytes: number, run: () => void): void {
    this.#after = { bytes, run };
  }

  /** Sends no more of what is on its way now. */
  hold(): void {
    this.#sending.clear();
  }

  close(): void {
    clearInterval(this.#timer);
  }

  #send(bytes: number): void {
    const share = Math.floor(bytes / Math.max(1, this.#sending.size));
    if (share === 0) return;
    for (const [response, data] of [...this.#sending]) {
      const now = data.subarray(0, share);
      this.sent += now.length;
      response.write(now);
      this.#sending.set(response, data.subarray(share));
      if (data.length > share) continue;
      this.#sending.delete(response);
      response.end();
    }
    if (this.#after === null || this.sent < this.#after.bytes) return;
    this.#after.run();
    this.#after = null;
  }
}
