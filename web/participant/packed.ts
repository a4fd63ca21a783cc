/** What a stimulus arrives as: a line of JSON, then its pictures one after another, each but the first a step from the one before. */
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

/** The head and the pictures of a stimulus. */
export function unpack(bytes: Uint8Array<ArrayBuffer>): { head: Head; pictures: Blob[] } {
  const end = bytes.indexOf(10);
  const head = checked(end < 0 ? {} : JSON.parse(new TextDecoder().decode(bytes.subarray(0, end))));
  let at = end + 1;
  const pictures = head.picture_bytes.map((length) => new Blob([bytes.subarray(at, (at += length))], { type: head.picture_type }));
  if (at > bytes.length) throw new Unusable(words("picture-damaged"));
  return { head, pictures };
}

function checked(head: Partial<Head> & { format?: number }): Head {
  const { format, fps, frames = [], picture_bytes = [] } = head;
  const right = format === 2 && typeof fps === "number" && fps >= 0 && frames.length > 0 && frames.every((frame) => frame in picture_bytes);
  if (!right) throw new Unusable(words("picture-damaged"));
  return head as Head;
}

/** A still's image, decoded. */
export async function still(bytes: Uint8Array<ArrayBuffer>): Promise<HTMLImageElement> {
  const [picture] = unpack(bytes).pictures;
  const image = new Image();
  image.alt = "";
  image.draggable = false;
  image.src = URL.createObjectURL(picture as Blob);
  await image.decode();
  return image;
}

/** How many pictures of an animation are decoded while another is drawn. */
const AHEAD = 4;

/**
 * An animation's frames, each as a bitmap; equal frames share theirs. A step's upper half is what is brighter, its lower half what is darker.
 * The canvas adds and takes away by itself: what is read back from one is falsified by browsers that guard against fingerprints.
 */
export async function animation(bytes: Uint8Array<ArrayBuffer>): Promise<{ head: Head; frames: ImageBitmap[] }> {
  const { head, pictures } = unpack(bytes);
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [head.width, head.height];
  const context = canvas.getContext("2d", { alpha: false });
  if (context === null) throw new Unusable(words("picture-damaged"));
  context.imageSmoothingEnabled = false;
  const decoding = pictures.slice(0, AHEAD).map((picture) => createImageBitmap(picture));
  const drawn: ImageBitmap[] = [];
  for (const index of pictures.keys()) {
    const next = pictures[index + AHEAD];
    if (next !== undefined) decoding.push(createImageBitmap(next));
    const picture = (await decoding[index]) as ImageBitmap;
    const draw = (how: GlobalCompositeOperation, top: number) => {
      context.globalCompositeOperation = how;
      context.drawImage(picture, 0, top, head.width, head.height, 0, 0, head.width, head.height);
    };
    if (index === 0) draw("copy", 0);
    else {
      draw("lighter", 0);
      draw("difference", head.height);
    }
    picture.close();
    drawn.push(await createImageBitmap(canvas));
  }
  return { head, frames: head.frames.map((index) => drawn[index] as ImageBitmap) };
}
