import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { test } from "node:test";
import { hash, sha256 } from "../participant/sha256.ts";

test("agrees with OpenSSL at every length around a block's edges", () => {
  for (const length of [0, 1, 55, 56, 57, 63, 64, 65, 119, 120, 1000, 100_003]) {
    const bytes = Uint8Array.from({ length }, (_, i) => (i * 31 + 7) & 255);
    assert.equal(sha256(bytes), createHash("sha256").update(bytes).digest("hex"), `length ${length}`);
  }
});

test("one flipped bit changes it", async () => {
  const bytes = new Uint8Array(100);
  const before = await hash(bytes);
  assert.equal(before, sha256(bytes));
  bytes[50] = 1;
  assert.notEqual(await hash(bytes), before);
});
