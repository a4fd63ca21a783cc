import assert from "node:assert/strict";
import { createServer, type IncomingMessage, type ServerResponse } from "node:http";
import type { AddressInfo } from "node:net";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { download } from "../participant/download.ts";
import { Unusable } from "../participant/packed.ts";
import { sha256 } from "./samples.ts";

// What a page has and Node has not.
Object.assign(globalThis, { addEventListener() {}, removeEventListener() {} });

const data = Buffer.from(Array.from({ length: 200_000 }, (_, i) => (i * 31) % 251));
const STALL_MS = 1000;

/** Serves `data` by `answers`, one a request, the last for all that follow. */
async function line(...answers: Array<(response: ServerResponse, from: number, request: IncomingMessage) => void>) {
  const ranges: Array<string | undefined> = [];
  const server = createServer((request, response) => {
    const from = Number(request.headers.range?.match(/^bytes=(\d+)-$/)?.[1] ?? 0);
    ranges.push(request.headers.range);
    const answer = answers[Math.min(ranges.length, answers.length) - 1];
    response.setHeader("etag", '"one"');
    response.setHeader("content-type", "application/vnd.kelir.stimulus");
    answer?.(response, from, request);
  });
  await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
  const url = `http://127.0.0.1:${(server.address() as AddressInfo).port}/stimulus`;
  const said: boolean[] = [];
  let bytes = 0;
  let wrong = 0;
  const watcher = {
    onWaiting: (waiting: boolean) => void said.push(waiting),
    onBytes(more: number, here: Uint8Array) {
      bytes += more;
      assert.equal(here.length, bytes, "what is counted is here");
    },
    onWrong() {
      wrong += 1;
    },
  };
  const get = (hash = sha256(data)) =>
    download({ sha256: hash, url }, watcher, STALL_MS).finally(() => {
      server.closeAllConnections();
      server.close();
    });
  return { get, ranges, said, counted: () => bytes, wrong: () => wrong };
}

const head = (response: ServerResponse, from: number) =>
  response.writeHead(from > 0 ? 206 : 200, { "content-length": data.length - from, ...(from > 0 ? { "content-range": `bytes ${from}-${data.length - 1}/${data.length}` } : {}) });
const whole = (response: ServerResponse, from: number) => void head(response, from).end(data.subarray(from));
/** Sends 50,000 bytes and then nothing any more. */
const stalled = (response: ServerResponse, from: number) => void head(response, from).write(data.subarray(from, from + 50_000));
/** Sends 50,000 bytes and hangs up. */
const broken = (response: ServerResponse, from: number) => void head(response, from).write(data.subarray(from, from + 50_000), () => setTimeout(() => response.destroy(), 50));

test("bytes come and are counted", async () => {
  const { get, ranges, counted, said } = await line(whole);
  assert.deepEqual(Buffer.from(await get()), data);
  assert.deepEqual([ranges, counted(), said], [[undefined], data.length, []]);
});

test("a request that stalls is given up and goes on from where it was; so does one that breaks", async () => {
  const { get, ranges, counted } = await line(stalled, broken, whole);
  assert.deepEqual(Buffer.from(await get()), data);
  assert.deepEqual(ranges, [undefined, "bytes=50000-", "bytes=100000-"]);
  assert.equal(counted(), data.length);
});

test("a request that is never answered is asked again", async () => {
  const silent = () => {};
  const { get, ranges, said } = await line(silent, silent, whole);
  assert.deepEqual(Buffer.from(await get()), data);
  assert.deepEqual(ranges, [undefined, undefined, undefined]);
  assert.deepEqual(said, [true, false], "who waits is told, and told when it is over");
});

test("a server without ranges sends all of it again, and nothing is counted twice", async () => {
  const { get, counted, wrong } = await line(stalled, (response) => whole(response, 0));
  assert.deepEqual(Buffer.from(await get()), data);
  assert.deepEqual([counted(), wrong()], [data.length, 0]);
});

test("bytes that come again and are others are told of, before all have come", async () => {
  const other = Buffer.from(data).fill(1, 40_000, 40_001);
  const { get, wrong } = await line(
    (response) => void head(response, 0).write(other.subarray(0, 50_000)),
    (response) => whole(response, 0),
  );
  assert.deepEqual(Buffer.from(await get()), data);
  assert.equal(wrong(), 1);
});

test("a length that is not announced, or is that of what a proxy has compressed, is no hindrance", async () => {
  const silent = await line((response) => void response.writeHead(200).write(data.subarray(0, 1000), () => response.end(data.subarray(1000))));
  assert.deepEqual(Buffer.from(await silent.get()), data);
  const small = gzipSync(data);
  const squeezed = await line((response) => void response.writeHead(200, { "content-encoding": "gzip", "content-length": small.length }).end(small));
  assert.deepEqual(Buffer.from(await squeezed.get()), data);
});

test("wrong bytes are asked for again, and never taken", async () => {
  const wrong = (response: ServerResponse) => void response.end(Buffer.alloc(10));
  const once = await line(wrong, whole);
  assert.deepEqual(Buffer.from(await once.get()), data);
  assert.equal(once.wrong(), 1);
  const always = await line(wrong);
  await assert.rejects(always.get(), Unusable);
  assert.equal(always.ranges.length, 3);
  // What was there of it at a resumption may be wrong too: it is dropped.
  const mixed = await line((response) => void response.writeHead(200, { "content-length": data.length }).write(Buffer.alloc(1000)), whole, whole);
  assert.deepEqual(Buffer.from(await mixed.get()), data);
});

test("a refusal ends it, trouble does not", async () => {
  const status = (code: number) => (response: ServerResponse) => void response.writeHead(code, { "content-type": "application/problem+json" }).end();
  await assert.rejects((await line(status(404))).get(), Unusable);
  const { get, ranges } = await line(stalled, status(416), status(503), whole);
  assert.deepEqual(Buffer.from(await get()), data);
  assert.deepEqual(ranges, [undefined, "bytes=50000-", undefined, undefined]);
});

test("what a sign-in page answers is waited out", async () => {
  const portal = (code: number) => (response: ServerResponse) => void response.writeHead(code, { "content-type": "text/html" }).end("<h1>Welcome to the hotel</h1>");
  const { get, said } = await line(portal(200), portal(403), whole);
  assert.deepEqual(Buffer.from(await get()), data);
  assert.deepEqual(said, [true, false]);
});
