/**
 * Stimuli, fetched in the order in which they are needed, checked against their hash and decoded before anybody sees them; but a film may begin while it
 * comes, when all of it will be there in time, and no answer counts before its hash is known.
 */
import type { StimulusRef, Trial } from "./api.ts";
import { Bell } from "./bell.ts";
import { download } from "./download.ts";
import { Rate } from "./forecast.ts";
import type { Pixels } from "./layout.ts";
import { Damaged, Film, type Head, still } from "./packed.ts";

export { Unusable } from "./packed.ts";

/** What is shown, with the hash of its bytes and its size in its own pixels. */
export type Picture = { sha256: string; pixels: Pixels } & ({ kind: "still"; image: HTMLImageElement } | { kind: "animation"; head: Head; film: Film });

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

/** When a trial's films begin, by role, ms after the trial. */
export type Begins = Readonly<Record<string, number>>;

export interface Loader {
  /** Gets the stimuli of these trials, the first ones first, while other things are on the screen; what else has not begun to come is left. */
  ahead(trials: readonly Sized[]): void;
  /** Gets a trial's stimuli while something else is on the screen; decodes them too, unless that could disturb an animation. */
  preload(trial: Sized, decode: boolean): void;
  /**
   * Its stimuli, ready to be painted: all of them, or of films so much that the rest will come in time where each begins so many ms (none: 0) after
   * the trial does. Rejects with `Unusable` when trying again would not help.
   */
  load(trial: Sized, begins: Begins): Promise<Pictures>;
  /** Whether what was loaded is what it should be, once that is known; `false` as soon as something is not, and then it can be loaded anew. */
  sound(trial: Pick<Sized, "trial_index">): Promise<boolean>;
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
  /** All of them, with the right hash. */
  bytes: Promise<Bytes>;
  /** Those that have come. */
  here: Bytes;
  rate: Rate;
  /** Whether wrong ones have come: then nothing is shown before all are known to be right. */
  isSuspect: boolean;
  films: Set<Film>;
  begin(): void;
}

/** What has been made for a trial. */
interface Ready {
  key: string;
  refs: StimulusRef[];
  /** Resolves when each has at least its first frame. */
  pictures: Promise<Pictures>;
  films: Map<string, { film: Film; rate: Rate }>;
}

/** `onWaiting` hears `true` when the line keeps us waiting, and `false` when it is back; `onProgress` hears of everything that comes. */
export function openLoader(onWaiting: (waiting: boolean) => void, onProgress: (progress: Progress) => void = () => {}): Loader {
  const wanted = new Map<string, Wanted>();
  const ready = new Map<number, Ready>();
  /** Rings when more of anything is here. */
  const bell = new Bell();
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

  /** What is done with what comes. */
  const arriving = (entry: Wanted) => ({
    onBytes(more: number, here: Bytes) {
      entry.here = here;
      if (more > 0) entry.rate.add(more, performance.now());
      for (const film of entry.films) film.hear(here);
      onBytes(more);
    },
    onWrong() {
      entry.isSuspect = true;
      for (const film of entry.films) film.settle(new Damaged("other bytes came than the study's plan says"));
      entry.films.clear();
    },
  });

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
        download(ref, { onWaiting, ...arriving(entry) })
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
    const entry: Wanted = { ref, trial, state: "waiting", bytes, here: new Uint8Array(0), rate: new Rate(), isSuspect: false, films: new Set(), begin };
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

  const picture = async (trial: Sized, role: string, ref: StimulusRef, films: Ready["films"]): Promise<Picture> => {
    const entry = want(ref, trial.trial_index);
    const { sha256 } = ref;
    if (trial.kind === "still") {
      const image = await still(await entry.bytes);
      return { sha256, pixels: [image.naturalWidth, image.naturalHeight], kind: "still", image };
    }
    const film = new Film(bell);
    films.set(role, { film, rate: entry.rate });
    if (!entry.isSuspect) {
      entry.films.add(film);
      film.hear(entry.here);
    }
    entry.bytes
      .then(
        (bytes) => {
          film.hear(bytes);
          return null;
        },
        (error: unknown) => error,
      )
      .then((wrong) => {
        film.settle(wrong);
        entry.films.delete(film);
      });
    const head = await bell.found(() => {
      film.check();
      return film.pictures.length > 0 ? film.head : null;
    });
    return { sha256, pixels: [head.width, head.height], kind: "animation", head, film };
  };

  const make = (trial: Sized): Ready => {
    const key = JSON.stringify(Object.values(trial.shown).map(({ sha256 }) => sha256));
    const known = ready.get(trial.trial_index);
    if (known?.key === key) return known;
    if (known !== undefined) free(trial.trial_index);
    const films: Ready["films"] = new Map();
    const all = Object.entries(trial.shown).map(async ([role, ref]) => [role, await picture(trial, role, ref, films)] as const);
    const pictures = Promise.all(all).then((made) => Object.fromEntries(made));
    const made = { key, refs: Object.values(trial.shown), pictures, films };
    ready.set(trial.trial_index, made);
    pictures.catch(() => discard(trial, made)); // the next `load` tries again
    pump();
    return made;
  };

  const discard = ({ trial_index }: Sized, made: Ready) => ready.get(trial_index) === made && free(trial_index);

  /** Whether a trial's films can begin: they are here and decoded, or will be in time. What is here already is decoded first, so that this disturbs nothing. */
  const canBegin = ({ films }: Ready, begins: Begins): boolean => {
    const all = [...films];
    const areHere = all.every(([, { film }]) => film.isSound);
    return all.every(([role, { film, rate }]) => film.isDecoded || (!areHere && film.playsThrough(rate.at(performance.now()), begins[role] ?? 0)));
  };

  const check = ({ films }: Ready) => {
    for (const { film } of films.values()) film.check();
  };

  const load = async (trial: Sized, begins: Begins): Promise<Pictures> => {
    for (;;) {
      const made = make(trial);
      try {
        const pictures = await made.pictures;
        await bell.found(() => {
          check(made);
          return canBegin(made, begins) || null;
        });
        return pictures;
      } catch (error) {
        if (!(error instanceof Damaged)) throw error;
        discard(trial, made);
      }
    }
  };

  const sound = async (made: Ready | undefined): Promise<boolean> => {
    if (made === undefined) return true;
    try {
      return await bell.found(() => {
        check(made);
        return [...made.films.values()].every(({ film }) => film.isSound) || null;
      });
    } catch (error) {
      if (error instanceof Damaged) return false;
      throw error;
    }
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
      }
    };
    made?.pictures.then(close, () => undefined);
    for (const { film } of made?.films.values() ?? []) film.close();
  };

  return {
    ahead(trials) {
      drop(trials);
      trials.forEach(fetching);
      pump();
    },
    preload(trial, decode) {
      if (decode) return void make(trial);
      fetching(trial);
      pump();
    },
    load(trial, begins) {
      urgent.add(trial.trial_index);
      return load(trial, begins);
    },
    sound: ({ trial_index }) => sound(ready.get(trial_index)),
    release({ trial_index }) {
      urgent.delete(trial_index);
      free(trial_index);
    },
  };
}
