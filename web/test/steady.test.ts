import assert from "node:assert/strict";
import { test } from "node:test";
import { steady } from "../participant/steady.ts";

test("a clock that jumps back goes on from where it was, at its own pace", () => {
  const times = [10, 20, 5, 15, 15, 2, 4, 1000];
  const now = steady(() => times.shift() ?? 0);
  assert.deepEqual(Array.from({ length: 8 }, now), [10, 20, 20, 30, 30, 30, 32, 1028]);
});
