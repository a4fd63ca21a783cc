/** Stimuli, fetched in the order in which they are needed, checked against their hash and decoded before anybody sees them. */
import type { StimulusRef, Trial } from "./api.ts";
import { download } from "./download.ts";
import type { Pixels } from "./layout.ts";
import { animation, type Head, still } from "./packed.ts";

export { Unusable } from "./packed.ts";

/** What is shown, with the hash of its bytes and its size in its own pixels. */
export type Picture = { sha256: string; pixels: Pixels } & ({ kind: "still"; image: HTMLImageElement } | { kind: "animation"; manifest: Pick<Head, "fps" | "loop">; frames: ImageBitmap[] });

/** A trial's pictures by role. */
export type Pictures = Record<string, Picture>;

/** How far the pictures that are known of are. */
export interface Progress {
  here: number;
  of: number;
  /** Bytes that have come. */
  bytes: number;
}

/** Of a trial what the loader needs: at the size that is to be shown. */
export type Sized = Pick<Trial, "trial_index" | "kind" | "shown">;

export interface Loader {
  /** Gets the stimuli of these trials, the first ones first, while other things are on the screen; what else has not begun to come is left. */
  ahead(trials: readonly Sized[]): void;
  /** Gets a trial's stimuli while something else is on the screen; decodes them too, unless that could disturb an animation. */
  preload(trial: Sized, decode: boolean): void;
  /** All its stimuli, ready to be painted. Rejects with `Unusable` when trying again would not help. */
  load(trial: Sized): Promise<Pictures>;
  /** Frees what `load` made for a trial that is over, at whatever size. */
  release(trial: Pick<Sized, "trial_index">): void;
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
  const ready = new Map<number, { key: string; refs: StimulusRef[]; pictures: Promise<Pictures> }>();
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

  const fetching = (trial: Sized) => Object.values(trial.shown).map((ref) => want(ref, trial.trial_index));

  const forget = (sha256: string) => {
    wanted.delete(sha256);
    progress.of -= 1;
  };

  /** Leaves what nobody waits for and has not begun: a window that changed asks for other sizes. */
  const drop = (kept: readonly Sized[]) => {
    const refs = [...kept.flatMap(({ shown }) => Object.values(shown)), ...[...ready.values()].flatMap(({ refs }) => refs)];
    const named = new Set(refs.map(({ sha256 }) => sha256));
    for (const [sha256, { state }] of [...wanted]) if (state === "waiting" && !named.has(sha256)) forget(sha256);
  };

  const picture = async (trial: Sized, ref: StimulusRef): Promise<Picture> => {
    const bytes = await want(ref, trial.trial_index).bytes;
    const { sha256 } = ref;
    if (trial.kind === "still") {
      const image = await still(bytes);
      return { sha256, pixels: [image.naturalWidth, image.naturalHeight], kind: "still", image };
    }
    const { head, frames } = await animation(bytes);
    return { sha256, pixels: [head.width, head.height], kind: "animation", manifest: head, frames };
  };

  const load = (trial: Sized): Promise<Pictures> => {
    const key = JSON.stringify(Object.values(trial.shown).map(({ sha256 }) => sha256));
    const known = ready.get(trial.trial_index);
    if (known?.key === key) return known.pictures;
    if (known !== undefined) free(trial.trial_index);
    const all = Object.entries(trial.shown).map(async ([role, ref]) => [role, await picture(trial, ref)] as const);
    const pictures = Promise.all(all).then((made) => Object.fromEntries(made));
    ready.set(trial.trial_index, { key, refs: Object.values(trial.shown), pictures });
    pictures.catch(() => ready.get(trial.trial_index)?.key === key && ready.delete(trial.trial_index)); // the next `load` tries again
    pump();
    return pictures;
  };

  /** Frees what was decoded for a trial, and its bytes where many are held. */
  const free = (trial: number) => {
    const made = ready.get(trial);
    ready.delete(trial);
    for (const { sha256 } of made?.refs ?? []) {
      const entry = wanted.get(sha256);
      if (entry?.state === "waiting") forget(sha256);
      // A later trial that shows it too gets it out of the browser's cache.
      if (entry?.state !== "here" || held <= MOST_AHEAD / 2) continue;
      wanted.delete(sha256);
      void entry.bytes.then((bytes) => {
        held -= bytes.length;
        pump();
      });
    }
    const close = (pictures: Pictures) => {
      for (const picture of Object.values(pictures)) {
        if (picture.kind === "still") URL.revokeObjectURL(picture.image.src);
        else for (const bitmap of picture.frames) bitmap.close();
      }
    };
    made?.pictures.then(close, () => undefined);
  };

  return {
    ahead(trials) {
      drop(trials);
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
    release({ trial_index }) {
      urgent.delete(trial_index);
      free(trial_index);
    },
  };
}
