import assert from "node:assert/strict";
import { test } from "node:test";
import { Foreign, isTemporary, Refused, refusal, request } from "../shared/http.ts";

test("the server's problem document is read, a proxy's page is not", () => {
  const problem = { type: "about:blank", title: "Conflict", status: 409, code: "already_answered", detail: "It stands." };
  const ours = refusal(409, JSON.stringify(problem), null);
  assert.deepEqual([ours.status, ours.code, ours.message], [409, "already_answered", "It stands."]);
  // The last of these is another server's problem document: it has no code that we could know.
  assert.equal(refusal(502, '{"code":"AccessDenied","message":"Forbidden","requestId":"1"}', null).code, "http_502", "a cloud's gateway");
  assert.equal(refusal(403, '{"code":"not_found","status":404,"title":"Not Found"}', null).code, "http_403", "of another answer");
  for (const text of ["<html>Bad gateway</html>", "{}", '{"code":null}', '{"code":7}', "null", "", '"code"', "[]", '{"title":"Bad Gateway","status":502}']) {
    const foreign = refusal(502, text, null);
    assert.deepEqual([foreign.code, foreign.message], ["http_502", "The server answered with status 502."], text);
  }
});

test("every field that is wrong is named with its value and its rule", () => {
  const errors = [
    { pointer: "/rt", value: -1, rule: "must be a number from 0 to 86400000" },
    { pointer: "/choice", rule: 'must be "left" or "right"' },
    { pointer: "/onset", value: null, rule: "must be a number" },
  ];
  const found = refusal(422, JSON.stringify({ status: 422, code: "invalid_field", detail: "The answer has faults.", errors }), null);
  assert.equal(found.message, 'The answer has faults. /rt = -1: must be a number from 0 to 86400000. /choice: must be "left" or "right". /onset = null: must be a number.');
  assert.equal(refusal(422, '{"status":422,"code":"invalid_field","title":"Unprocessable","errors":7}', null).message, "Unprocessable");
});

test("what may be tried again", () => {
  const temporary = (status: number) => isTemporary(new Refused(status, "", ""));
  assert.deepEqual([400, 401, 404, 408, 409, 422, 429, 500, 502, 503].map(temporary), [false, false, false, true, false, false, true, true, true, true]);
  assert.ok(isTemporary(new TypeError("failed to fetch")));
});

test("Retry-After in seconds, capped; dates and nonsense are ignored", () => {
  const wait = (header: string | null) => refusal(429, "", header).retryAfterMs;
  assert.deepEqual([wait("7"), wait("99999"), wait("-1"), wait("Wed, 21 Oct 2026 07:28:00 GMT"), wait(null)], [7000, 120_000, null, null, null]);
});

test("what a proxy or a sign-in page says is not the server's word: it may be otherwise later", async (t) => {
  assert.ok(isTemporary(refusal(403, "<html>Blocked</html>", null)) && isTemporary(refusal(404, "", null)));
  assert.ok(!isTemporary(refusal(404, '{"status":404,"code":"not_found"}', null)));
  const answers: Response[] = [];
  t.mock.method(globalThis, "fetch", async () => answers.shift());
  answers.push(new Response("<!doctype html><title>Welcome to our hotel</title>", { headers: { "content-type": "text/html" } }));
  await assert.rejects(request("/x"), (error) => error instanceof Foreign && isTemporary(error));
});

test("a request that outlives its page is small: browsers refuse the others as if the line were lost", async (t) => {
  const kept: unknown[] = [];
  t.mock.method(globalThis, "fetch", async (_: string, { keepalive }: RequestInit) => {
    kept.push(keepalive);
    return new Response("{}");
  });
  for (const length of [100, 16 << 10, (16 << 10) + 1]) await request("/x", { method: "PUT", text: "x".repeat(length), keepalive: true });
  assert.deepEqual(kept, [true, true, false]);
});
