import assert from "node:assert/strict";
import { test } from "node:test";
import { openStore, sessionKey } from "../participant/storage.ts";

test("a browser without storage works from memory and says that it is not durable", () => {
  const store = openStore(() => {
    throw new Error("SecurityError");
  });
  store.write("a", { n: 1 });
  assert.deepEqual(store.read("a"), { n: 1 });
  assert.equal(store.durable, false);
});

test("a full disk falls back to memory without losing what is written", () => {
  const map = new Map<string, string>();
  let full = false;
  const storage = {
    getItem: (k: string) => map.get(k) ?? null,
    setItem: (k: string, v: string) => {
      if (full) throw new Error("QuotaExceededError");
      map.set(k, v);
    },
    removeItem: (k: string) => map.delete(k),
  } as unknown as Storage;
  const store = openStore(() => storage);
  store.write("a", 1);
  assert.equal(store.durable, true);
  full = true;
  store.write("a", 2);
  assert.equal(store.read("a"), 2);
  assert.equal(store.durable, false);
});

test("a storage that is emptied meanwhile takes nothing from the page that wrote it", () => {
  const map = new Map<string, string>();
  const storage = {
    getItem: (k: string) => map.get(k) ?? null,
    setItem: (k: string, v: string) => map.set(k, v),
    removeItem: (k: string) => map.delete(k),
    key: (i: number) => [...map.keys()][i] ?? null,
    get length() {
      return map.size;
    },
  } as unknown as Storage;
  const store = openStore(() => storage);
  store.write("kelir:a", 1);
  store.write("kelir:b", 1);
  store.remove("kelir:b");
  map.clear();
  assert.equal(store.read("kelir:a"), 1);
  assert.deepEqual(store.keys("kelir:"), ["kelir:a"]);
});

test("a broken entry reads as nothing", () => {
  const store = openStore(() => ({ getItem: () => "{", setItem: () => {}, removeItem: () => {} }) as unknown as Storage);
  assert.equal(store.read("a"), null);
});

test("the same link resumes, another participant's link doesn't", () => {
  const a = sessionKey("s", { PROLIFIC_PID: "1", STUDY_ID: "2" });
  assert.equal(a, sessionKey("s", { STUDY_ID: "2", PROLIFIC_PID: "1" }));
  assert.notEqual(a, sessionKey("s", { PROLIFIC_PID: "9", STUDY_ID: "2" }));
  assert.notEqual(a, sessionKey("t", { PROLIFIC_PID: "1", STUDY_ID: "2" }));
  assert.notEqual(sessionKey("s", { a: "b&c=d" }), sessionKey("s", { a: "b", c: "d" }));
});
