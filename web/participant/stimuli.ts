/** Stimuli, fetched in the order in which they are needed, checked against their hash and decoded before anybody sees them. */
import type { StimulusRef, Trial } from "./api.ts";
import { download } from "./download.ts";
import { animation, type Head, still } from "./packed.ts";

export { Unusable } from "./packed.ts";

export type Picture =
  | { kind: "still"; image: HTMLImageElement }
  | { kind: "animation"; manifest: Pick<Head, "fps" | "loop">; frames: ImageBitmap[] };

/** A trial's pictures by role. */
export type Pictures = Record<string, Picture>;

/** How far the pictures that are known of are. */
export interface Progress {
  here: number;
  of: number;
  /** Bytes that have come. */
  bytes: number;
}

export interface Loader {
  /** Gets the stimuli of these trials, the first ones first, while other things are on the screen. */
  ahead(trials: readonly Trial[]): void;
  /** Gets a trial's stimuli while something else is on the screen; decodes them too, unless that could disturb an animation. */
  preload(trial: Trial, decode: boolean): void;
  /** All its stimuli, ready to be painted. Rejects with `Unusable` when trying again would not help. */
  load(trial: Trial): Promise<Pictures>;
  /** Frees what `load` made for a trial that is over. */
  release(trial: Trial): void;
}

/** Requests under way at once: a trial's two. More would make its pictures wait for those of later trials. */
const AT_ONCE = 2;
/** Bytes held for later trials; beyond them nothing is fetched ahead. */
const MOST_AHEAD = 64e6;

type Bytes = Uint8Array<ArrayBuffer>;
interface Wanted {
  ref: StimulusRef;
  /** The first trial that shows it. */
  trial: number;
  state: "waiting" | "coming" | "here";
  bytes: Promise<Bytes>;
  begin(): void;
}

/** `onWaiting` hears `true` when the line keeps us waiting, and `false` when it is back; `onProgress` hears of everything that comes. */
export function openLoader(onWaiting: (waiting: boolean) => void, onProgress: (progress: Progress) => void = () => {}): Loader {
  const wanted = new Map<string, Wanted>();
  const ready = new Map<number, Promise<Pictures>>();
  /** Trials whose pictures are waited for: these are fetched whatever is held already. */
  const urgent = new Set<number>();
  const progress: Progress = { here: 0, of: 0, bytes: 0 };
  let held = 0;
  let running = 0;

  const onBytes = (more: number) => {
    progress.bytes += more;
    onProgress({ ...progress });
  };

  /** Begins what is wanted first, as far as there is room. */
  const pump = () => {
    const waiting = [...wanted.values()].filter(({ state }) => state === "waiting").sort((a, b) => a.trial - b.trial);
    for (const next of waiting) {
      if (running >= AT_ONCE || (held > MOST_AHEAD && !urgent.has(next.trial))) return;
      next.begin();
    }
  };

  const want = (ref: StimulusRef, trial: number): Wanted => {
    const known = wanted.get(ref.sha256);
    if (known !== undefined) {
      if (known.state === "waiting") known.trial = Math.min(known.trial, trial);
      return known;
    }
    let begin: Wanted["begin"] = () => {};
    const bytes = new Promise<Bytes>((resolve, reject) => {
      begin = () => {
        running += 1;
        entry.state = "coming";
        download(ref, { onWaiting, onBytes })
          .then((bytes) => {
            entry.state = "here";
            held += bytes.length;
            progress.here += 1;
            onBytes(0);
            resolve(bytes);
          })
          .catch((error: unknown) => {
            wanted.delete(ref.sha256);
            progress.of -= 1;
            onBytes(0);
            reject(error);
          })
          .finally(() => {
            running -= 1;
            pump();
          });
      };
    });
    bytes.catch(() => undefined); // `load` meets the same error again where it can be said
    const entry: Wanted = { ref, trial, state: "waiting", bytes, begin };
    wanted.set(ref.sha256, entry);
    progress.of += 1;
    onBytes(0);
    return entry;
  };

  const fetching = (trial: Trial) => Object.values(trial.shown).map((ref) => want(ref, trial.trial_index));

  const picture = async (trial: Trial, ref: StimulusRef): Promise<Picture> => {
    const bytes = await want(ref, trial.trial_index).bytes;
    if (trial.kind === "still") return { kind: "still", image: await still(bytes) };
    const { head, frames } = await animation(bytes);
    return { kind: "animation", manifest: head, frames };
  };

  const load = (trial: Trial): Promise<Pictures> => {
    const known = ready.get(trial.trial_index);
    if (known !== undefined) return known;
    const all = Object.entries(trial.shown).map(async ([role, ref]) => [role, await picture(trial, ref)] as const);
    const pictures = Promise.all(all).then((made) => Object.fromEntries(made));
    ready.set(trial.trial_index, pictures);
    pictures.catch(() => ready.delete(trial.trial_index)); // the next `load` tries again
    pump();
    return pictures;
  };

  return {
    ahead(trials) {
      trials.forEach(fetching);
      pump();
    },
    preload(trial, decode) {
      if (decode) return void load(trial);
      fetching(trial);
      pump();
    },
    load(trial) {
      urgent.add(trial.trial_index);
      return load(trial);
    },
    release(trial) {
      const made = ready.get(trial.trial_index);
      ready.delete(trial.trial_index);
      urgent.delete(trial.trial_index);
      for (const ref of Object.values(trial.shown)) {
        const entry = wanted.get(ref.sha256);
        // A later trial that shows it too gets it out of the browser's cache.
        if (entry?.state !== "here" || held <= MOST_AHEAD / 2) continue;
        wanted.delete(ref.sha256);
        void entry.bytes.then((bytes) => {
          held -= bytes.length;
          pump();
        });
      }
      void made?.then((pictures) => {
        for (const picture of Object.values(pictures)) {
          if (picture.kind === "still") URL.revokeObjectURL(picture.image.src);
          else for (const bitmap of picture.frames) bitmap.close();
        }
      });
    },
  };
}
