import assert from "node:assert/strict";
import { test } from "node:test";
import { InputGuard, type Press, QuickPresses, type Rules } from "../participant/inputs/guard.ts";
import { Inputs } from "../participant/inputs/watch.ts";

const EDITION_2: Rules = { min_visible_ms: 200, min_gap_ms: 500 };
const EDITION_1: Rules = { min_visible_ms: 0, min_gap_ms: 0 };

/** What the guard says of a press, and counts it where it counts. */
const answer = (guard: InputGuard, press: Press, rules = EDITION_2, more: { visibleMs?: number; detail?: number; trusted?: boolean } = {}) => {
  const verdict = guard.verdict({ press, trusted: true, detail: 1, visibleMs: 1000, ...more }, rules);
  if (verdict === null) guard.count(press.id, press.at);
  return verdict;
};

/** A key that goes down and up again. */
const tap = (guard: InputGuard, id: string, at: number, rules = EDITION_2, more = {}) => {
  const verdict = answer(guard, guard.down(id, at), rules, more);
  guard.up(id, at + 20);
  return verdict;
};

test("the rules' edges: what is 200 ms visible and 500 ms after the last input counts, a millisecond earlier does not", () => {
  const guard = new InputGuard();
  assert.equal(tap(guard, "key:ArrowLeft", 1000, EDITION_2, { visibleMs: 199 }), "early");
  assert.equal(tap(guard, "key:ArrowRight", 1400, EDITION_2, { visibleMs: 200 }), null);
  assert.equal(tap(guard, "key:ArrowLeft", 1899), "gap");
  assert.equal(tap(guard, "mouse:1", 1900), null, "the gap is counted from the last input that counted");
});

test("nothing counts before the stimulus is there, whatever the rules", () => {
  assert.equal(tap(new InputGuard(), "key:ArrowLeft", 10, EDITION_1, { visibleMs: -1 }), "early");
  assert.equal(tap(new InputGuard(), "key:ArrowLeft", 10, EDITION_1, { visibleMs: Number.NEGATIVE_INFINITY }), "early");
  assert.equal(tap(new InputGuard(), "key:ArrowLeft", 10, EDITION_1, { visibleMs: 0 }), null);
});

test("the second click of a double click, and what a script makes, never count", () => {
  for (const rules of [EDITION_1, EDITION_2]) {
    const guard = new InputGuard();
    assert.equal(tap(guard, "mouse:1", 1000, rules), null);
    for (const detail of [2, 3]) assert.equal(tap(guard, "mouse:1", 5000, rules, { detail }), "double");
    assert.equal(tap(guard, "mouse:1", 9000, rules, { trusted: false }), "untrusted");
    assert.equal(tap(guard, "mouse:1", 9500, rules), null);
  }
});

test("quick touches at one place are a series, as a mouse's clicks are; later or elsewhere another begins", () => {
  const quick = new QuickPresses();
  const counts = [
    [1000, 100],
    [1180, 110],
    [1660, 90],
    [2160, 90],
    [2400, 145],
    [2500, 300],
    [2600, 300],
  ].map(([at = 0, x = 0]) => quick.count(at, x, 50));
  assert.deepEqual(counts, [1, 2, 3, 1, 1, 1, 2]);
  const box = (left: number) => ({ left, right: left + 100, top: 0, bottom: 100 });
  assert.deepEqual(
    [box(250), box(350), box(351)].map((at) => quick.left(2700, at)),
    [400, 400, 0],
  );
  assert.deepEqual(
    [3099, 3100, 9000].map((at) => quick.left(at, box(250))),
    [1, 0, 0],
  );
});

test("a key that is held answers once, whatever its repeats look like", () => {
  const repeats: Record<string, (guard: InputGuard, at: number) => Press> = {
    "as the browser says": (guard, at) => guard.down("key:ArrowLeft", at, true),
    "as downs without a word": (guard, at) => guard.down("key:ArrowLeft", at),
    "as pairs of down and up": (guard, at) => {
      guard.up("key:ArrowLeft", at);
      return guard.down("key:ArrowLeft", at);
    },
    "as pairs with time between": (guard, at) => {
      guard.up("key:ArrowLeft", at - 20);
      return guard.down("key:ArrowLeft", at);
    },
  };
  for (const [form, repeat] of Object.entries(repeats)) {
    for (const rules of [EDITION_1, EDITION_2]) {
      const guard = new InputGuard();
      assert.equal(answer(guard, guard.down("key:ArrowLeft", 0), rules), null);
      const counted = Array.from({ length: 600 }, (_, i) => answer(guard, repeat(guard, 660 + 30 * i), rules)).filter((verdict) => verdict === null);
      assert.equal(counted.length, 0, form);
      guard.up("key:ArrowLeft", 19_000);
      assert.equal(answer(guard, guard.down("key:ArrowLeft", 19_600), rules), null, `${form}: let go, it answers again`);
    }
  }
});

test("another input counts only once the last one that counted is let go", () => {
  const guard = new InputGuard();
  assert.equal(answer(guard, guard.down("key:ArrowLeft", 0)), null);
  assert.equal(tap(guard, "key:ArrowRight", 1000), "held");
  assert.equal(tap(guard, "touch:5", 1500), "held");
  guard.up("key:ArrowLeft", 1600);
  assert.equal(tap(guard, "key:ArrowRight", 1700), null);
});

test("a release that nobody heard of holds nothing up for good", () => {
  const blurred = new InputGuard();
  answer(blurred, blurred.down("key:ArrowLeft", 0));
  blurred.letGo();
  assert.equal(tap(blurred, "key:ArrowLeft", 700), null);
  const lost = new InputGuard();
  answer(lost, lost.down("key:ArrowLeft", 0));
  assert.equal(tap(lost, "key:ArrowRight", 2400), "held");
  assert.equal(tap(lost, "key:ArrowRight", 3000), null);
});

test("without rules of its own a study takes answers as quickly as people give them", () => {
  const guard = new InputGuard();
  const verdicts = Array.from({ length: 10 }, (_, i) => tap(guard, i % 2 === 0 ? "key:ArrowLeft" : "key:ArrowRight", 150 * i, EDITION_1));
  assert.deepEqual(verdicts, Array(10).fill(null));
  const same = new InputGuard();
  assert.deepEqual(
    Array.from({ length: 5 }, (_, i) => tap(same, "key:ArrowLeft", 200 * i, EDITION_1)),
    Array(5).fill(null),
  );
});

test("a click that no key and no pointer made, as a screen reader's, is an input like any other", () => {
  const page = new Inputs();
  const click = (event: Partial<PointerEvent>) => page.click({ isTrusted: true, detail: 0, timeStamp: performance.now(), ...event } as PointerEvent);
  const judge = (event: Partial<PointerEvent>, rules = EDITION_1) => page.judge(click(event), rules, 1000);
  assert.equal(judge({}), null);
  assert.equal(judge({}), null, "and again");
  assert.equal(judge({}, EDITION_2), "gap");
  assert.equal(judge({ isTrusted: false }), "untrusted");
  assert.equal(click({}).input, "keyboard");
  assert.equal(click({ detail: 1, pointerType: "pen" }).input, "pen");
  assert.equal(click({ detail: 1 }).input, "mouse");
});
