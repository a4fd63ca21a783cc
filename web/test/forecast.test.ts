import assert from "node:assert/strict";
import { test } from "node:test";
import { type OnItsWay, playsThrough, Rate } from "../participant/forecast.ts";
import { PICTURES } from "./samples.ts";

/** Four pictures of 1000 bytes, one a second. */
const pictures = [1, 2, 3, 4].map((n) => ({ end: 1000 * n, dueMs: 1000 * (n - 1) }));
const film = (known: Partial<OnItsWay>): OnItsWay => ({ here: 1000, rate: 1, decoded: 1, decodeMs: 0, pictures, ...known });

test("a film begins when its line brings every picture a tenth of a second before its time, were it 15% slower", () => {
  // The second picture needs 1000 bytes in 900 ms: 1.111 bytes a millisecond are 85% of 1.307. The fourth needs less: 3000 in 2900 ms, 1.217.
  assert.ok(playsThrough(film({ rate: 1.31 })));
  assert.ok(!playsThrough(film({ rate: 1.3 })));
  // With half of the second one here it is the fourth that decides: 2500 bytes in 2900 ms, 85% of 1.0142.
  assert.ok(playsThrough(film({ here: 1500, rate: 1.02 })));
  assert.ok(!playsThrough(film({ here: 1500, rate: 1.01 })));
});

test("a line too slow waits, and one that brings nothing is never counted on", () => {
  assert.ok(!playsThrough(film({ here: 3999, rate: 0 })));
  assert.ok(playsThrough(film({ here: 4000, rate: 0 })), "all is here");
  // 85% of 0.1 bytes a millisecond bring 246 in the 2900 ms that the last picture has.
  assert.ok(playsThrough(film({ here: 3760, rate: 0.1 })));
  assert.ok(!playsThrough(film({ here: 3750, rate: 0.1 })));
});

test("what is here but not decoded takes its time", () => {
  // The fourth is decoded after three times so long, and has 2900 ms; the second has 900.
  assert.ok(playsThrough(film({ here: 4000, decodeMs: 900 })));
  assert.ok(!playsThrough(film({ here: 4000, decodeMs: 901 })));
  assert.ok(playsThrough(film({ here: 4000, decodeMs: 1400, decoded: 2 })), "1400 ms for the third, 2800 for the fourth");
  assert.ok(!playsThrough(film({ here: 4000, decodeMs: 1460, decoded: 2 })));
  assert.ok(!playsThrough(film({ here: 4000, decoded: 0 })), "no film begins without its first picture");
});

test("a film that begins later may begin to come later", () => {
  const later = pictures.map(({ end, dueMs }) => ({ end, dueMs: dueMs + 1500 }));
  assert.ok(!playsThrough(film({ rate: 0.9 })));
  assert.ok(playsThrough(film({ rate: 0.9, pictures: later })));
});

/** Its pictures as they lie behind a head of 649 bytes. */
const BUILT = PICTURES.map((_, i) => ({ end: PICTURES.slice(0, i + 1).reduce((sum, length) => sum + length, 649), dueMs: (1000 * i) / 30 }));

/** The bytes of a pair such as the built-in one after which it begins, over a line of so many bytes a millisecond that its two films share. */
function beginsAfter(rate: number): number {
  for (let here = 0; here <= (BUILT.at(-1)?.end ?? 0); here += 1000) {
    const decoded = BUILT.filter((picture) => picture.end <= here).length;
    if (playsThrough({ here, rate: rate / 2, decoded, decodeMs: 10, pictures: BUILT })) return 2 * here;
  }
  return Number.NaN;
}

/** How many of its pictures come after their time when it begins after so many bytes. */
function late(begun: number, rate: number): number {
  return BUILT.filter(({ end, dueMs }) => (end - begun / 2) / (rate / 2) > dueMs).length;
}

test("a pair such as the built-in one begins after 2.5 MB at 9 Mbit/s, and later on a slower line; nothing is late even where it slows down by a tenth", () => {
  for (const [mbits, least, most] of [
    [9, 2.2e6, 2.5e6],
    [3, 3.4e6, 3.6e6],
    [1.6, 3.7e6, 3.9e6],
  ] as const) {
    const rate = (mbits * 1e6) / 8 / 1000;
    const begun = beginsAfter(rate);
    assert.ok(begun >= least && begun <= most, `${begun} bytes at ${mbits} Mbit/s`);
    assert.equal(late(begun, rate), 0);
    assert.equal(late(begun, 0.9 * rate), 0);
    assert.ok(late(begun - 6e5, rate) > 0, "0.6 MB sooner would have been too soon");
  }
});

/** A line measured: bytes by time, ms. */
function measured(...came: Array<[number, number]>): Rate {
  const rate = new Rate();
  for (const [at, bytes] of came) rate.add(bytes, at);
  return rate;
}
const every100ms = (from: number, to: number, bytes: number) => Array.from({ length: (to - from) / 100 + 1 }, (_, i): [number, number] => [from + 100 * i, bytes]);

test("a rate is what came lately or all the time, whichever is less", () => {
  // The first bytes are not counted: 50 bytes every 100 ms since.
  assert.equal(measured([0, 9999], ...every100ms(100, 2000, 50)).at(2000), 0.5);
  // 20 × 50 bytes in 2 s, then 10 × 10 in one: lately 0.1.
  assert.equal(measured([0, 50], ...every100ms(100, 2000, 50), ...every100ms(2100, 3000, 10)).at(3000), 0.1);
  // The other way round: 0.5 lately, but (200 + 500) bytes in 3 s in all.
  assert.equal(measured([0, 10], ...every100ms(100, 2000, 10), ...every100ms(2100, 3000, 50)).at(3000), 700 / 3000);
});

test("a line that stalls has no rate, nor one that was looked at for less than half a second", () => {
  const line = measured(...every100ms(0, 2000, 50));
  assert.equal(line.at(2500), 0.25);
  assert.equal(line.at(3000), 0);
  assert.equal(measured(...every100ms(0, 400, 50)).at(499), 0);
  assert.equal(measured(...every100ms(0, 500, 50)).at(500), 0.5);
  assert.equal(new Rate().at(1e6), 0);
});
