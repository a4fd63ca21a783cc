import assert from "node:assert/strict";
import { test } from "node:test";
import { count, dateSpan, fixed, significant } from "../shared/format.ts";

test("the paper's numbers look as the paper prints them, with a true minus", () => {
  assert.deepEqual([fixed(0.8125, 3), fixed(-1.4375905, 3), fixed(4.208834, 3)], ["0.813", "−1.438", "4.209"]);
  assert.notEqual(fixed(-1.4375905, 3), "-1.438", "a hyphen is no minus");
});

test("what is missing or unbounded has a sign of its own", () => {
  assert.deepEqual([fixed(null, 3), fixed(undefined, 3), fixed(NaN, 3)], ["–", "–", "–"]);
  assert.deepEqual([fixed(Infinity, 3), significant(-Infinity), significant(null)], ["∞", "−∞", "–"]);
});

test("nothing is shown as minus zero", () => {
  assert.equal(fixed(-0.0004, 3), "0.000");
  assert.equal(fixed(-0.0006, 3), "−0.001");
});

test("significant digits, plain where that reads well", () => {
  assert.deepEqual(
    [0.00821, 12.345, 123456, 1234567, -0.5, 0.000203782, 1e-300, 0].map((x) => significant(x)),
    ["0.00821", "12.3", "123456", "1.23 × 10⁶", "−0.500", "2.04 × 10⁻⁴", "1.00 × 10⁻³⁰⁰", "0"],
  );
});

test("counts", () => {
  assert.deepEqual([count(1, "pair"), count(0, "pair"), count(1200, "pair")], ["1 pair", "0 pairs", "1,200 pairs"]);
});

test("days, one or two", () => {
  assert.equal(dateSpan("2026-05-04T09:12:00Z", "2026-06-03T18:40:00Z"), "2026-05-04 to 2026-06-03");
  assert.equal(dateSpan("2026-05-04T09:12:00Z", "2026-05-04T23:59:59Z"), "2026-05-04");
});
