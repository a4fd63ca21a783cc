import assert from "node:assert/strict";
import { test } from "node:test";
import { steady } from "../participant/steady.ts";

test("a clock that jumps back goes on from where it was, at its own pace, and is never before a frame that was shown", () => {
  let time = 0;
  const { now, atLeast } = steady(() => time);
  const at = (t: number) => {
    time = t;
    return now();
  };
  assert.deepEqual([10, 20, 5, 15, 2, 4].map(at), [10, 20, 20, 30, 30, 32]);
  atLeast(100);
  assert.deepEqual([at(4), at(10)], [100, 106]);
});
