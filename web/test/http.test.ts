import assert from "node:assert/strict";
import { test } from "node:test";
import { isTemporary, Refused, refusal } from "../shared/http.ts";

test("the server's error body is read, a proxy's page is not", () => {
  const ours = refusal(409, '{"error":{"code":"already_answered","message":"It stands."}}', null);
  assert.deepEqual([ours.status, ours.code, ours.message], [409, "already_answered", "It stands."]);
  for (const text of ["<html>Bad gateway</html>", "{}", '{"error":null}', '{"error":{"code":7}}', "null", ""]) {
    assert.equal(refusal(502, text, null).code, "http_502", text);
  }
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
