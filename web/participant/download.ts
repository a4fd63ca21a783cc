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

export interface Watcher {
  /** `true` when the line keeps us waiting, `false` when it is back. */
  onWaiting(waiting: boolean): void;
  /** So many bytes more are here (fewer where they have to come again). */
  onBytes(more: number): void;
}

/** What has come of a stimulus so far. */
interface Part {
  chunks: Uint8Array<ArrayBuffer>[];
  length: number;
  etag: string | null;
}

/** Fetches until the line lets it through; bytes that don't hash right are asked for twice more, past every cache. */
export async function download(ref: StimulusRef, watcher: Watcher, stallMs = STALL_MS): Promise<Uint8Array<ArrayBuffer>> {
  const part: Part = { chunks: [], length: 0, etag: null };
  const restart = () => {
    watcher.onBytes(-part.length);
    [part.chunks, part.length, part.etag] = [[], 0, null];
  };
  let wrong = 0;
  for (let failures = 0; ; ) {
    const before = part.length;
    const status = await more(ref.url, part, { watcher, restart, stallMs, fresh: wrong > 0 }).catch(() => null);
    if (status === "whole") {
      const bytes = joined(part);
      if ((await hash(bytes)) === ref.sha256) {
        if (failures > 1) watcher.onWaiting(false);
        return bytes;
      }
      restart();
      wrong += 1;
      if (wrong > 2) throw new Unusable(words("picture-damaged"));
      continue;
    }
    if (status === 416) restart();
    else if (status !== null && status >= 400 && status < 500 && status !== 408 && status !== 429) throw new Unusable(words("picture-refused", { status }));
    // A line that brings something is tried again at once.
    failures = part.length > before ? 1 : failures + 1;
    if (failures > 1) watcher.onWaiting(true);
    await pause(backoffMs(failures));
  }
}

/** Asks for what is missing. Gives "whole" when nothing is any more, or the status of a refusal; rejects when the line breaks or stalls. */
async function more(url: string, part: Part, { watcher, restart, stallMs, fresh }: { watcher: Watcher; restart(): void; stallMs: number; fresh: boolean }): Promise<"whole" | number> {
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
    if (response.status !== 206) restart();
    part.etag = response.headers.get("etag");
    const announced = Number(response.headers.get("content-length") ?? NaN);
    const whole = part.length + announced;
    const reader = response.body?.getReader();
    for (;;) {
      const { done, value } = reader === undefined ? { done: true, value: undefined } : await reader.read();
      if (done || value === undefined) break;
      alive();
      part.chunks.push(value as Uint8Array<ArrayBuffer>);
      part.length += value.length;
      watcher.onBytes(value.length);
    }
    if (part.length < whole) throw new Error("the line broke"); // some browsers take a body that was cut short for a whole one
    return "whole";
  } finally {
    clearTimeout(timer);
  }
}

function joined({ chunks, length }: Part): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(length);
  let at = 0;
  for (const chunk of chunks) {
    bytes.set(chunk, at);
    at += chunk.length;
  }
  return bytes;
}
