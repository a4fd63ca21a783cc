/** Stimuli, fetched, checked against their hash and decoded before anybody sees them. */
import { backoffMs, pause } from "../shared/backoff.ts";
import type { StimulusRef, Trial } from "./api.ts";
import { hash } from "./sha256.ts";
import { words } from "./words/index.ts";

/** The manifest of an animation stimulus (`application/vnd.kelir.animation+json`). */
export interface Manifest {
  fps: number;
  loop: boolean;
  width: number;
  height: number;
  /** One hash a frame; equal frames share theirs. */
  frames: string[];
}

export type Picture =
  | { kind: "still"; image: HTMLImageElement }
  | { kind: "animation"; manifest: Manifest; frames: ImageBitmap[] };

/** A trial's pictures by role. */
export type Pictures = Record<string, Picture>;

/** A stimulus that can't be had: the server hasn't got it, or its bytes are not what the plan says. */
export class Unusable extends Error {}

export interface Loader {
  /** Gets a trial's stimuli while something else is on the screen; decodes them too, unless that could disturb an animation. */
  preload(trial: Trial, decode: boolean): void;
  /** All its stimuli, ready to be painted. Rejects with `Unusable` when trying again would not help. */
  load(trial: Trial): Promise<Pictures>;
  /** Frees what `load` made for a trial that is over. */
  release(trial: Trial): void;
}

/** `onWaiting` hears `true` when the line keeps us waiting, and `false` when it is back. */
export function openLoader(onWaiting: (waiting: boolean) => void): Loader {
  const cache = new Map<string, Promise<Blob>>();
  const ready = new Map<number, Promise<Pictures>>();
  const slots = limit(6);

  const bytes = (ref: StimulusRef): Promise<Blob> => {
    let blob = cache.get(ref.sha256);
    if (blob === undefined) {
      blob = slots(() => fetchVerified(ref, onWaiting));
      cache.set(ref.sha256, blob);
      blob.catch(() => cache.delete(ref.sha256));
    }
    return blob;
  };

  const manifest = async (ref: StimulusRef): Promise<Manifest> => checked(JSON.parse(await (await bytes(ref)).text()));
  const frame = (sha256: string) => bytes({ sha256, url: `/stimuli/${sha256}` });

  const still = async (ref: StimulusRef): Promise<Picture> => {
    const image = new Image();
    image.alt = "";
    image.draggable = false;
    image.src = URL.createObjectURL(await bytes(ref));
    await image.decode();
    return { kind: "still", image };
  };

  const animation = async (ref: StimulusRef): Promise<Picture> => {
    const description = await manifest(ref);
    const distinct = new Map<string, Promise<ImageBitmap>>();
    for (const sha256 of new Set(description.frames)) {
      distinct.set(sha256, frame(sha256).then((blob) => createImageBitmap(blob)));
    }
    const frames = await Promise.all(description.frames.map((sha256) => distinct.get(sha256) as Promise<ImageBitmap>));
    return { kind: "animation", manifest: description, frames };
  };

  const make = async (trial: Trial): Promise<Pictures> => {
    const picture = trial.kind === "still" ? still : animation;
    const all = Object.entries(trial.shown).map(async ([role, ref]) => [role, await picture(ref)] as const);
    return Object.fromEntries(await Promise.all(all));
  };

  const load = (trial: Trial): Promise<Pictures> => {
    let pictures = ready.get(trial.trial_index);
    if (pictures === undefined) {
      pictures = make(trial);
      ready.set(trial.trial_index, pictures);
      pictures.catch(() => ready.delete(trial.trial_index)); // `load` meets the same error again where it can be said
    }
    return pictures;
  };

  return {
    preload(trial, decode) {
      if (decode) return void load(trial);
      for (const ref of Object.values(trial.shown)) {
        const fetched = trial.kind === "still" ? bytes(ref) : manifest(ref).then((m) => Promise.all(m.frames.map(frame)));
        fetched.catch(() => undefined);
      }
    },
    load,
    release(trial) {
      const made = ready.get(trial.trial_index);
      ready.delete(trial.trial_index);
      void made?.then((pictures) => {
        for (const picture of Object.values(pictures)) {
          if (picture.kind === "still") URL.revokeObjectURL(picture.image.src);
          else for (const bitmap of picture.frames) bitmap.close();
        }
      });
    },
  };
}

/** Fetches until the line lets it through; bytes that don't hash right are asked for twice more, past every cache. */
async function fetchVerified(ref: StimulusRef, onWaiting: (waiting: boolean) => void): Promise<Blob> {
  let failures = 0;
  let wrong = 0;
  for (;;) {
    let response: Response | null = null;
    try {
      response = await fetch(ref.url, { cache: wrong > 0 ? "reload" : "default" });
      if (response.ok) {
        const type = response.headers.get("content-type") ?? "";
        const body = await response.arrayBuffer();
        if ((await hash(new Uint8Array(body))) === ref.sha256) {
          if (failures > 0) onWaiting(false);
          return new Blob([body], { type });
        }
        wrong += 1;
        if (wrong > 2) throw new Unusable(words("picture-damaged"));
        continue;
      }
    } catch (error) {
      if (error instanceof Unusable) throw error;
    }
    if (response !== null && response.status >= 400 && response.status < 500 && response.status !== 408 && response.status !== 429) {
      throw new Unusable(words("picture-refused", { status: response.status }));
    }
    failures += 1;
    if (failures > 1) onWaiting(true);
    await pause(backoffMs(failures));
  }
}

function checked(manifest: Partial<Manifest>): Manifest {
  const { fps, frames } = manifest;
  if (typeof fps !== "number" || !(fps > 0) || !Array.isArray(frames) || frames.length === 0) {
    throw new Unusable(words("picture-damaged"));
  }
  return { loop: true, width: 0, height: 0, ...manifest, fps, frames };
}

/** Runs at most `n` at once. */
function limit(n: number): <T>(job: () => Promise<T>) => Promise<T> {
  let running = 0;
  const queue: Array<() => void> = [];
  return async (job) => {
    if (running >= n) await new Promise<void>((resolve) => queue.push(resolve));
    running += 1;
    try {
      return await job();
    } finally {
      running -= 1;
      queue.shift()?.();
    }
  };
}
