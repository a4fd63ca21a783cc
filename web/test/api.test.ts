import assert from "node:assert/strict";
import { test } from "node:test";
import { fetchState } from "../participant/api.ts";

test("a page that comes back says what it has not sent, so that the plan of those answers stays", async (t) => {
  const asked: string[] = [];
  t.mock.method(globalThis, "fetch", async (path: string) => {
    asked.push(path);
    return new Response('{"session_id":"s","trials":[]}');
  });
  const who = { session_id: "s", token: "t" };
  await fetchState(who, 0);
  await fetchState(who, 2);
  assert.deepEqual(asked, ["/api/v1/sessions/s", "/api/v1/sessions/s?unsent=2"]);
});
