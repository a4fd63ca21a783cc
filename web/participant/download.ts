/** Getting a stimulus's bytes over any line, and holding them to their hash. */
import { backoffMs, pause } from "../shared/backoff.ts";
import type { StimulusRef } from "./api.ts";
import { Unusable } from "./packed.ts";
import { hash } from "./sha256.ts";
import { words } from "./words/index.ts";

/** A request that brings nothing for so long is given up and asked again, from where it was, ms. */
export const STALL_MS = 10_000;

const STIMULUS = "application/vnd.kelir.stimulus";
const PROBLEM = "application/problem+json";

type Bytes = Uint8Array<ArrayBuffer>;

export interface Watcher {
  /** `true` when the line keeps us waiting, `false` when it is back. */
  onWaiting(waiting: boolean): void;
  /** So many bytes more are here (fewer where they have to come again), and which: from the first on, not held to their hash yet. */
  onBytes(more: number, here: Bytes): void;
  /** Bytes that were here turned out wrong. */
  onWrong(): void;
}

/** What has come of a stimulus so far, in one buffer. */
class Part {
  etag: string | null = null;
  length = 0;
  #buffer: Bytes = new Uint8Array(0);
  /** So many bytes have come at least once. */
  #known = 0;

  get here(): Bytes {
    return this.#buffer.subarray(0, this.length);
  }

  /** Makes room for so many bytes in all. */
  reserve(length: number): void {
    if (!(length > this.#buffer.length)) return;
    const larger = new Uint8Array(length);
    larger.set(this.#buffer.subarray(0, this.#known));
    this.#buffer = larger;
  }

  /** Takes what comes next; `false` where something else had come in its place before. */
  add(chunk: Uint8Array): boolean {
    const end = this.length + chunk.length;
    if (end > this.#buffer.length) this.reserve(2 * end);
    const again = this.#buffer.subarray(this.length, Math.min(end, this.#known));
    const isSame = again.every((byte, i) => byte === chunk[i]);
    this.#buffer.set(chunk, this.length);
    this.length = end;
    this.#known = isSame ? Math.max(this.#known, end) : end;
    return isSame;
  }

  /** All of it comes once more. */
  rewind(): void {
    [this.etag, this.length] = [null, 0];
  }
}

/** Fetches until the line lets it through; bytes that don't hash right are asked for twice more, past every cache. */
export async function download(ref: StimulusRef, watcher: Watcher, stallMs = STALL_MS): Promise<Bytes> {
  let part = new Part();
  let wrong = 0;
  for (let failures = 0; ; ) {
    const before = part.length;
    const status = await more(ref.url, part, { watcher, stallMs, fresh: wrong > 0 }).catch(() => null);
    if (status === "whole") {
      if ((await hash(part.here)) === ref.sha256) {
        if (failures > 1) watcher.onWaiting(false);
        return part.here;
      }
      watcher.onWrong();
      restart(part, watcher);
      part = new Part();
      wrong += 1;
      if (wrong > 2) throw new Unusable(words("picture-damaged"));
      continue;
    }
    if (status === 416) restart(part, watcher);
    else if (status !== null && status >= 400 && status < 500 && status !== 408 && status !== 429) throw new Unusable(words("picture-refused", { status }));
    // A line that brings something is tried again at once.
    failures = part.length > before ? 1 : failures + 1;
    if (failures > 1) watcher.onWaiting(true);
    await pause(backoffMs(failures));
  }
}

function restart(part: Part, watcher: Watcher): void {
  const lost = part.length;
  part.rewind();
  watcher.onBytes(-lost, part.here);
}

/** Asks for what is missing. Gives "whole" when nothing is any more, or the status of a refusal; rejects when the line breaks or stalls. */
async function more(url: string, part: Part, { watcher, stallMs, fresh }: { watcher: Watcher; stallMs: number; fresh: boolean }): Promise<"whole" | number> {
  const abort = new AbortController();
  let timer = setTimeout(() => abort.abort(), stallMs);
  const alive = () => {
    clearTimeout(timer);
    timer = setTimeout(() => abort.abort(), stallMs);
  };
  try {
    const resume = part.length > 0 && part.etag !== null ? { range: `bytes=${part.length}-`, "if-range": part.etag } : null;
    const response = await fetch(url, { signal: abort.signal, cache: fresh ? "reload" : "default", ...(resume === null ? {} : { headers: resume }) });
    alive();
    const type = response.headers.get("content-type") ?? "";
    // What a proxy or a sign-in page says is not the server's word: it may be otherwise later.
    if (!type.startsWith(response.ok ? STIMULUS : PROBLEM) && response.status !== 416) throw new Error("another server's answer");
    if (!response.ok) return response.status;
    if (response.status !== 206) restart(part, watcher);
    part.etag = response.headers.get("etag");
    const announced = Number(response.headers.get("content-length") ?? NaN);
    const whole = part.length + announced;
    part.reserve(whole);
    const reader = response.body?.getReader();
    for (;;) {
      const { done, value } = reader === undefined ? { done: true, value: undefined } : await reader.read();
      if (done || value === undefined) break;
      alive();
      if (!part.add(value)) watcher.onWrong();
      watcher.onBytes(value.length, part.here);
    }
    if (part.length < whole) throw new Error("the line broke"); // some browsers take a body that was cut short for a whole one
    return "whole";
  } finally {
    clearTimeout(timer);
  }
}
