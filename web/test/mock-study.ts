// What the mock server serves: a study's words, its pictures and its plan.
import type { Study, Trial } from "../participant/api.ts";
import { type Look, png, sha256, shadowRows } from "./samples.ts";

export const study: Omit<Study, "trial_kinds"> = {
  id: "shadow-puppets",
  title: "Shadows on a screen",
  question: "Which image is more likely to be real?",
  surround: 0.2,
  size: [592, 333],
  display: { sizes: [[592, 333]], fit: "native" },
  response: { min_visible_ms: 0, min_gap_ms: 0 },
  per_visit: false,
  estimated_minutes: 3,
  texts: {
    welcome: [
      "In this study you look at pairs of pictures of shadow puppets behind a cloth screen. In each pair you choose the one that you think is more likely to be real.",
      "There are no right answers to learn and nothing to prepare.",
    ],
    consent: [
      "Taking part is voluntary. You can stop at any time by closing this page, and you need not say why.",
      "We store your choices, how long each took, and the size and refresh rate of your display. We don't store your name or address.",
      "The answers are analysed together with those of other people and may be published without anything that identifies you.",
    ],
    instructions: ["Two pictures appear beside each other, or below each other on a narrow screen.", "Choose one. Take the time you need, but trust your first impression."],
    debriefing: [
      "All pictures were computed. In some pairs one was drawn by a fast method and the other by a slow, accurate one; in others one was passed through a simulated camera, to look like a photograph.",
      "We want to know whether people can tell them apart.",
    ],
    thanks: ["You have finished. Thank you for your time and your eyes."],
  },
  language: "en",
  translations: {
    de: {
      title: "Schatten auf einer Leinwand",
      question: "Welches Bild ist eher echt?",
      texts: {
        welcome: ["In dieser Studie sehen Sie Paare von Bildern und wählen jeweils eines."],
        consent: ["Die Teilnahme ist freiwillig. Fragen beantwortet studie@example.org, mehr steht auf https://example.org/schatten."],
        instructions: ["Wählen Sie in jedem Paar ein Bild."],
        debriefing: ["Alle Bilder waren berechnet."],
        thanks: ["Das war das letzte Paar."],
      },
    },
    ar: {
      title: "ظلال على شاشة",
      question: "أي الصورتين أقرب إلى أن تكون حقيقية؟",
      texts: {
        welcome: ["في هذه الدراسة ترى أزواجًا من الصور وتختار صورة من كل زوج."],
        consent: ["المشاركة طوعية. للأسئلة: studie@example.org، والمزيد في https://example.org/shadows."],
        instructions: ["اختر صورة من كل زوج."],
        debriefing: ["كل الصور محسوبة بالحاسوب."],
        thanks: ["كان هذا الزوج الأخير."],
      },
    },
  },
};

/** A trial of the plan, before anybody answers. */
export type Planned = Omit<Trial, "answered">;

export interface Material {
  /** By hash, with the pictures (PNG) that the bytes hold. */
  bytes: Map<string, { data: Buffer; pictures: Buffer[] }>;
  trials: Planned[];
}

/** The size of the mock's pictures, and the further one of those that have two. */
type Size = readonly [number, number];
const SMALL: Size = [592, 333];
export const LARGE: Size = [1008, 567];

/** Drawing takes longer than all else here, so each look is drawn once. */
const drawn = new Map<string, Uint8Array>();
function rows(look: Look, [width, height]: Size): Uint8Array {
  const key = JSON.stringify([look, width, height]);
  const rgb = drawn.get(key) ?? shadowRows({ width, height, ...look });
  drawn.set(key, rgb);
  return rgb;
}

/** From one frame to the next: what is brighter above what is darker. */
function step(before: Uint8Array, after: Uint8Array, [width, height]: Size): Buffer {
  const less = (a: Uint8Array, b: Uint8Array) => a.map((value, i) => Math.max(0, value - (b[i] ?? 0)));
  return png(width, 2 * height, Buffer.concat([less(after, before), less(before, after)]));
}

export class Maker implements Material {
  readonly bytes: Material["bytes"] = new Map();
  readonly trials: Planned[] = [];

  still(look: Look, size = SMALL) {
    return this.#add([png(...size, rows(look, size))], 0, false, size);
  }

  /** Frames of RGB rows, packed as the server does it. */
  animation(frames: Uint8Array[], fps: number, loop = true, size = SMALL) {
    const [first = new Uint8Array(), ...others] = frames;
    return this.#add([png(...size, first), ...others.map((frame, i) => step(frames[i] as Uint8Array, frame, size))], fps, loop, size);
  }

  swinging(look: Look, frames: number, fps: number, size = SMALL) {
    return this.animation(
      Array.from({ length: frames }, (_, i) => rows({ ...look, turn: 0.3 * Math.sin((2 * Math.PI * i) / frames) }, size)),
      fps,
      true,
      size,
    );
  }

  /** Flat greys, the code rising by 4 from frame to frame, in pictures of these lengths. */
  greys(first: number, lengths: readonly number[], fps: number) {
    const [width, height] = SMALL;
    const flat = (lines: number, code: number) => Buffer.alloc(3 * width * lines, code);
    const picture = (i: number) => (i === 0 ? png(width, height, flat(height, first), lengths[0]) : png(width, 2 * height, Buffer.concat([flat(height, 4), flat(height, 0)]), lengths[i]));
    return this.#add([...lengths.keys()].map(picture), fps, true, SMALL);
  }

  trial(trial: Omit<Planned, "trial_index" | "width" | "height" | "larger"> & Partial<Pick<Planned, "larger">>): void {
    const [width, height] = SMALL;
    this.trials.push({ trial_index: this.trials.length, larger: [], ...trial, width, height });
  }

  /** As the server packs stimuli, but for the pictures' type. */
  #add(pictures: Buffer[], fps: number, loop: boolean, [width, height]: Size) {
    const head = { format: 2, width, height, fps, loop, frames: [...pictures.keys()], picture_type: "image/png", picture_bytes: pictures.map((png) => png.length) };
    const data = Buffer.concat([Buffer.from(`${JSON.stringify(head)}\n`), ...pictures, Buffer.alloc(100)]);
    const hash = sha256(data);
    this.bytes.set(hash, { data, pictures });
    return { sha256: hash, url: `/stimuli/${hash}` };
  }
}

/** Two pairs of each of two blocks and one pair of animations, as small as the tests like them. */
export function material({ frames = 12, fps = 12 } = {}): Maker {
  const made = new Maker();
  const pair = (block_index: number, item_index: number, kind: Planned["kind"], left: ReturnType<Maker["still"]>, right: ReturnType<Maker["still"]>) =>
    made.trial({ trial: "two-alternative", block_index, item_index, kind, shown: { left, right }, settings: null });
  pair(0, 0, "still", made.still({ turn: 0.1 }), made.still({ turn: 0.1, noise: 0.1 }));
  pair(0, 1, "still", made.still({ turn: -0.3, soft: 20, noise: 0.1 }), made.still({ turn: -0.3, soft: 20 }));
  pair(1, 0, "still", made.still({ turn: 0.5 }), made.still({ turn: 0.5, noise: 0.25 }));
  pair(1, 1, "still", made.still({ turn: 0.9, soft: 12 }), made.still({ turn: 0.9, soft: 12, noise: 0.25 }));
  pair(2, 0, "animation", made.swinging({ soft: 8 }, frames, fps), made.swinging({ soft: 8, noise: 0.1 }, frames, fps));
  return made;
}

/** A pair of stills and one of animations in two sizes each, and what the study says of them. */
export function inTwoSizes(): Material {
  const made = new Maker();
  const [width, height] = LARGE;
  const trial = (kind: Planned["kind"], picture: (look: Look, size?: Size) => ReturnType<Maker["still"]>) => {
    const pair = (size?: Size) => ({ left: picture({ turn: 0.1 }, size), right: picture({ turn: 0.1, noise: 0.1 }, size) });
    made.trial({ trial: "two-alternative", block_index: 0, item_index: 0, kind, shown: pair(), larger: [{ width, height, shown: pair(LARGE) }], settings: null });
  };
  trial("still", (look, size) => made.still(look, size));
  trial("animation", (look, size) => made.swinging(look, 3, 6, size));
  return made;
}

/** What a study in two sizes says of them. */
export const twoSizes = (fit: Study["display"]["fit"]): Study["display"] => ({ sizes: [[...SMALL], [...LARGE]], fit });

/** Durations of the mock's two-interval trials, ms. */
export const durations = { fixation_ms: 200, first_ms: 300, mask_ms: 100, second_ms: 250 };

/** Trials of the kind two-interval: so many stills, then `animations` of animations. */
export function intervals({ stills = 2, animations = 0, settings = durations } = {}): Material {
  const made = new Maker();
  const trial = (kind: Planned["kind"], item_index: number, first: ReturnType<Maker["still"]>, second: ReturnType<Maker["still"]>) =>
    made.trial({ trial: "two-interval", block_index: 0, item_index, kind, shown: { first, second }, settings });
  for (let i = 0; i < stills; i++) trial("still", i, made.still({ turn: 0.1 * i }), made.still({ turn: 0.1 * i, noise: 0.1 }));
  for (let i = 0; i < animations; i++) trial("animation", stills + i, made.swinging({ soft: 8 }, 6, 12), made.swinging({ soft: 8, noise: 0.1 }, 6, 12));
  return made;
}
