import assert from "node:assert/strict";
import { test } from "node:test";
import { Unpacking, Unusable } from "../participant/packed.ts";

/** A stimulus of pictures with these bytes, and what follows them. */
function packed(pictures: number[][], tail = 5, more: object = {}): Uint8Array<ArrayBuffer> {
  const head = { format: 2, width: 1, height: 1, fps: 10, loop: true, frames: [...pictures.keys()], picture_type: "image/webp", picture_bytes: pictures.map(({ length }) => length), ...more };
  return new Uint8Array([...new TextEncoder().encode(`${JSON.stringify(head)}\n`), ...pictures.flat(), ...Array<number>(tail).fill(0)]);
}

/** Takes all pictures that there are. */
function taken(unpacking: Unpacking, here: Uint8Array<ArrayBuffer>): Blob[] {
  const blobs: Blob[] = [];
  for (let next = unpacking.next(here); next !== null; next = unpacking.next(here)) blobs.push(next);
  return blobs;
}
const read = (blobs: Blob[]) => Promise.all(blobs.map(async (blob) => [...new Uint8Array(await blob.arrayBuffer())]));

// A line feed among a picture's bytes ends no head.
const pictures = [[10, 1, 2, 3], [4], [], [10, 10, 6], [7, 8, 9, 11, 12]];
const whole = packed(pictures);
const ends = pictures.map((_, i) => whole.length - 5 - pictures.slice(i + 1).flat().length);

test("at every cut of the bytes those pictures are there that are whole, and the rest comes with the rest", async () => {
  for (let cut = 0; cut <= whole.length; cut++) {
    const unpacking = new Unpacking();
    const first = taken(unpacking, whole.subarray(0, cut));
    assert.equal(first.length, ends.filter((end) => end <= cut).length, `after ${cut} bytes`);
    assert.deepEqual(await read([...first, ...taken(unpacking, whole)]), pictures, `cut after ${cut} bytes`);
  }
});

test("byte by byte each picture comes with its last byte, once", async () => {
  const unpacking = new Unpacking();
  const came: number[] = [];
  const blobs: Blob[] = [];
  for (let cut = 0; cut <= whole.length; cut++) {
    const now = taken(unpacking, whole.subarray(0, cut));
    came.push(...now.map(() => cut));
    blobs.push(...now);
  }
  assert.deepEqual(came, ends);
  assert.deepEqual(await read(blobs), pictures);
  assert.deepEqual([...new Set(blobs.map(({ type }) => type))], ["image/webp"]);
  assert.equal(taken(unpacking, whole.subarray(0, 20)).length, 0, "less again, as when it comes once more, gives nothing twice");
});

test("it says where each picture ends and when it is shown first", () => {
  const unpacking = new Unpacking();
  assert.deepEqual([unpacking.head(whole.subarray(0, 30)), unpacking.pictures], [null, []]);
  const twice = packed([[1], [2, 3]], 0, { frames: [0, 0, 0, 1, 0, 1], fps: 20 });
  assert.equal(unpacking.head(twice)?.width, 1);
  const first = twice.length - 3;
  assert.deepEqual(unpacking.pictures, [
    { start: first, end: first + 1, shownMs: 0 },
    { start: first + 1, end: first + 3, shownMs: 150 },
  ]);
});

test("a head that is none is refused", () => {
  const text = (line: string) => new Uint8Array(new TextEncoder().encode(line));
  for (const bytes of [text("<html>\n"), text("{}\n"), packed([[1]], 0, { format: 1 }), packed([[1]], 0, { frames: [1] }), packed([[1]], 0, { frames: [] }), packed([[1]], 0, { fps: -1 })]) {
    assert.throws(() => new Unpacking().next(bytes), Unusable);
  }
});
