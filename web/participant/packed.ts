/** What a stimulus arrives as: a line of JSON, then its pictures one after another, each but the first a step from the one before. */
import type { Bell } from "./bell.ts";
import { playsThrough } from "./forecast.ts";
import { words } from "./words/index.ts";

/** A stimulus's first line. */
export interface Head {
  width: number;
  height: number;
  /** Frames a second; 0 for a still. */
  fps: number;
  loop: boolean;
  /** Which picture each frame shows. */
  frames: number[];
  /** Media type of the pictures. */
  picture_type: string;
  /** Length of each picture. */
  picture_bytes: number[];
}

/** The bytes of a stimulus that arrived can't be shown. */
export class Unusable extends Error {}

/** Bytes that were shown, or would have been, turned out wrong; they are on their way once more. */
export class Damaged extends Error {}

type Bytes = Uint8Array<ArrayBuffer>;

/** Takes a stimulus apart as its bytes come. */
export class Unpacking {
  #head: Head | null = null;
  #pictures: Array<{ start: number; end: number; shownMs: number }> = [];
  #next = 0;

  /** Of each picture where its bytes begin and end, and when its first frame is shown, ms from the film's; none before the head is here. */
  get pictures(): ReadonlyArray<{ start: number; end: number; shownMs: number }> {
    return this.#pictures;
  }

  /** The head, once `here`, the bytes from the first on, has all of it. */
  head(here: Bytes): Head | null {
    const line = this.#head === null ? here.indexOf(10) : -1;
    if (line < 0) return this.#head;
    const head = parsed(here.subarray(0, line));
    let end = line + 1;
    this.#pictures = head.picture_bytes.map((length, picture) => {
      const start = end;
      end += length;
      return { start, end, shownMs: (1000 * head.frames.indexOf(picture)) / head.fps };
    });
    this.#head = head;
    return head;
  }

  /** The next picture that `here` has all of; null where there is none. */
  next(here: Bytes): Blob | null {
    const head = this.head(here);
    const picture = this.#pictures[this.#next];
    if (head === null || picture === undefined || picture.end > here.length) return null;
    this.#next += 1;
    return new Blob([here.subarray(picture.start, picture.end)], { type: head.picture_type });
  }
}

function parsed(line: Bytes): Head {
  let head: Partial<Head> & { format?: number };
  try {
    head = JSON.parse(new TextDecoder().decode(line));
  } catch {
    throw new Unusable(words("picture-damaged"));
  }
  const { format, fps, frames = [], picture_bytes = [] } = head;
  const right = format === 2 && typeof fps === "number" && fps >= 0 && frames.length > 0 && frames.every((frame) => frame in picture_bytes);
  if (!right) throw new Unusable(words("picture-damaged"));
  return head as Head;
}

/** A still's image, decoded. */
export async function still(bytes: Bytes): Promise<HTMLImageElement> {
  const picture = new Unpacking().next(bytes);
  if (picture === null) throw new Unusable(words("picture-damaged"));
  const image = new Image();
  image.alt = "";
  image.draggable = false;
  image.src = URL.createObjectURL(picture);
  await image.decode();
  return image;
}

/** How many pictures of a film are decoded while another is drawn. */
const AHEAD = 4;

/**
 * An animation whose pictures are decoded as they come, each to a bitmap; equal frames share theirs. A step's upper half is what is brighter, its lower
 * half what is darker. The canvas adds and takes away by itself: what is read back from one is falsified by browsers that guard against fingerprints.
 */
export class Film {
  readonly #bell: Bell;
  readonly #unpacking = new Unpacking();
  readonly #pictures: ImageBitmap[] = [];
  #here: Bytes = new Uint8Array(0);
  #head: Head | null = null;
  #decodingMs = 0;
  #isClosed = false;
  /** Whether its bytes are the right ones (null), or why it can't be shown; undefined before all have come. */
  #verdict: { wrong: unknown } | undefined;
  /** What kept it from being decoded. */
  #failure: { error: unknown } | undefined;

  /** Rings `bell` whenever something has changed. */
  constructor(bell: Bell) {
    this.#bell = bell;
    const failed = (error: unknown) => (this.#failure = { error });
    void this.#decode()
      .catch(failed)
      .then(() => bell.ring());
  }

  /** Null before it is here. */
  get head(): Head | null {
    return this.#head;
  }

  /** The pictures that are decoded. */
  get pictures(): readonly ImageBitmap[] {
    return this.#pictures;
  }

  get isDecoded(): boolean {
    return this.#pictures.length === this.#head?.picture_bytes.length;
  }

  /** Whether all its bytes are here and the right ones. */
  get isSound(): boolean {
    return this.#verdict !== undefined && this.#verdict.wrong === null;
  }

  /** Throws what keeps it from being shown. What can't be decoded may have come wrong, which is known once all is here. */
  check(): void {
    if (this.#verdict !== undefined && this.#verdict.wrong !== null) throw this.#verdict.wrong;
    if (this.isSound && this.#failure !== undefined) throw this.#failure.error;
  }

  /** What a frame shows, if that is decoded. */
  frame(index: number): ImageBitmap | undefined {
    return this.#pictures[this.#head?.frames[index] ?? -1];
  }

  /** Whether every picture will be there at its time if the film begins in `beginMs` and its bytes go on coming at `rate`, bytes a millisecond. */
  playsThrough(rate: number, beginMs: number): boolean {
    const decoded = this.#pictures.length;
    const pictures = this.#unpacking.pictures.map(({ end, shownMs }) => ({ end, dueMs: beginMs + shownMs }));
    return decoded > 0 && playsThrough({ here: this.#here.length, rate, decoded, decodeMs: this.#decodingMs / decoded, pictures });
  }

  /** Hears which bytes are here, from the first on. */
  hear(here: Bytes): void {
    this.#here = here;
    this.#bell.ring();
  }

  /** Hears that all its bytes are the right ones (null), or why it can't be shown; what is heard first holds. */
  settle(wrong: unknown): void {
    this.#verdict ??= { wrong };
    this.#bell.ring();
  }

  /** Frees its pictures; it can't be shown any more. */
  close(): void {
    this.#isClosed = true;
    this.#verdict = { wrong: new Error("the film was closed") };
    for (const picture of this.#pictures) picture.close();
    this.#bell.ring();
  }

  async #decode(): Promise<void> {
    const head = await this.#bell.found(() => this.#coming(this.#unpacking.head(this.#here)));
    const { width, height } = head;
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [width, height];
    const context = canvas.getContext("2d", { alpha: false });
    if (context === null) throw new Unusable(words("picture-damaged"));
    context.imageSmoothingEnabled = false;
    this.#head = head;
    const decoding: Array<Promise<ImageBitmap>> = [];
    let since = 0;
    const next = () => {
      while (decoding.length < AHEAD) {
        const picture = this.#unpacking.next(this.#here);
        if (picture === null) break;
        const decoded = createImageBitmap(picture);
        decoded.catch(() => undefined); // whoever waits for it meets the error
        decoding.push(decoded);
      }
      since = performance.now();
      return this.#coming(decoding.shift() ?? null);
    };
    for (let index = 0; index < head.picture_bytes.length; index++) {
      const picture = await this.#bell.found(next);
      const draw = (how: GlobalCompositeOperation, top: number) => {
        context.globalCompositeOperation = how;
        context.drawImage(picture, 0, top, width, height, 0, 0, width, height);
      };
      if (index === 0) draw("copy", 0);
      else {
        draw("lighter", 0);
        draw("difference", height);
      }
      picture.close();
      const drawn = await createImageBitmap(canvas);
      if (this.#isClosed) return drawn.close();
      this.#pictures.push(drawn);
      this.#decodingMs += performance.now() - since;
      this.#bell.ring();
    }
  }

  /** What there is of the film; null where it is still to come. */
  #coming<T>(found: T | null): T | null {
    if (this.#isClosed) this.check();
    if (found === null && this.isSound) throw new Unusable(words("picture-damaged"));
    return found;
  }
}
