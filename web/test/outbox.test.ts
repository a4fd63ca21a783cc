import assert from "node:assert/strict";
import { test } from "node:test";
import type { Acknowledgement, Answer } from "../participant/api.ts";
import { type Line, Outbox } from "../participant/outbox.ts";
import { openStore, type Store } from "../participant/storage.ts";
import { backoffMs } from "../shared/backoff.ts";
import { Refused } from "../shared/http.ts";

const answer = (choice: "left" | "right"): Answer => ({ choice, rt: 1, onset: 1 });

/** localStorage, as far as the outbox needs it. */
function disk(): Storage {
  const map = new Map<string, string>();
  return {
    get length() {
      return map.size;
    },
    clear: () => map.clear(),
    key: (i) => [...map.keys()][i] ?? null,
    getItem: (k) => map.get(k) ?? null,
    setItem: (k, v) => void map.set(k, v),
    removeItem: (k) => void map.delete(k),
  };
}

/** An outbox whose server answers as told, and whose clock only moves when asked to. */
function bench(reply: (index: number, tries: number) => unknown, store: Store = openStore(() => disks)) {
  const sent: number[] = [];
  const bodies: string[] = [];
  const stored: Array<[number, number | null]> = [];
  const plans: Array<string | undefined> = [];
  const lines: Line[] = [];
  let replans = 0;
  const timers = new Map<number, { run: () => void; ms: number }>();
  const outbox = new Outbox("box", store, {
    send: async (index, body, plan): Promise<Acknowledgement> => {
      sent.push(index);
      bodies.push(body);
      plans.push(plan);
      const result = reply(index, sent.length);
      if (result instanceof Error) throw result;
      return { acknowledged: true, next_trial: index + 1, more: false, trials: [] };
    },
    onStored: (index, acknowledged) => stored.push([index, acknowledged?.next_trial ?? null]),
    onOtherPlan: () => (replans += 1),
    onLine: (line) => lines.push(line),
    setTimer(run, ms) {
      timers.set(timers.size, { run, ms });
      return timers.size - 1;
    },
    clearTimer: (timer) => timers.delete(timer as number),
    random: () => 0.5,
  });
  const elapse = async () => {
    const due = [...timers.values()];
    timers.clear();
    for (const { run } of due) run();
    await settle();
  };
  return { outbox, sent, bodies, plans, stored, lines, replans: () => replans, timers, elapse, store };
}
const settle = () => new Promise((resolve) => setImmediate(resolve));
let disks = disk();
test.beforeEach(() => (disks = disk()));

test("an answer leaves the queue when it is acknowledged, and not before", async () => {
  const { outbox, stored, sent } = bench(() => true);
  outbox.put(0, answer("left"));
  assert.deepEqual([...outbox.indices], [0], "still kept while it is on its way");
  await outbox.settled();
  assert.deepEqual([...outbox.indices], []);
  assert.deepEqual(stored, [[0, 1]]);
  assert.deepEqual(sent, [0]);
});

test("an answer goes with the plan that it is of, also after a reload; where the session has another one by now, it is gone and that is told", async () => {
  const before = bench(() => new TypeError("offline"));
  before.outbox.put(0, answer("left"), "morning");
  before.outbox.put(1, answer("left"), "evening");
  await settle();
  before.outbox.stop();
  const { outbox, plans, stored, lines, replans } = bench((index) => (index === 0 ? new Refused(409, "plan_changed", "Another plan.") : true));
  await outbox.settled();
  assert.deepEqual(plans, ["morning", "evening"], "sent once each: no shorter one would be of another plan");
  assert.deepEqual([outbox.waiting, stored, replans()], [[], [[1, 2]], 1]);
  assert.equal(lines.at(-1), "idle");
});

test("a lost line delays and loses nothing; the order is kept", async () => {
  const { outbox, sent, lines, timers, elapse } = bench((_, tries) => (tries <= 2 ? new TypeError("failed to fetch") : true));
  outbox.put(0, answer("left"));
  await settle();
  outbox.put(1, answer("right"));
  await settle();
  assert.deepEqual([...outbox.indices], [0, 1]);
  assert.equal(lines.at(-1), "waiting");
  assert.equal(timers.size, 1, "one retry is planned, not one an answer");
  await elapse();
  assert.deepEqual(sent, [0, 0, 0, 1]);
  assert.deepEqual([...outbox.indices], []);
  assert.equal(lines.at(-1), "idle");
});

test("answers survive a reload: a new outbox on the same storage sends them", async () => {
  const first = bench(() => new TypeError("offline"));
  first.outbox.put(3, answer("left"));
  await settle();
  first.outbox.stop();
  const second = bench(() => true);
  assert.deepEqual([...second.outbox.indices], [3]);
  await second.outbox.settled();
  assert.deepEqual(second.stored, [[3, 4]]);
  // Another storage knows nothing of them: it is the storage that carries them over.
  assert.deepEqual(
    [
      ...bench(
        () => true,
        openStore(() => disk()),
      ).outbox.indices,
    ],
    [],
  );
});

for (const status of [408, 429, 500, 503]) {
  test(`status ${status} is retried`, async () => {
    const { outbox, timers, elapse } = bench((_, tries) => (tries === 1 ? new Refused(status, "x", "x") : true));
    outbox.put(0, answer("left"));
    await settle();
    assert.equal(timers.size, 1);
    await elapse();
    assert.deepEqual(outbox.waiting, []);
  });
}

for (const status of [400, 401, 404, 413, 422]) {
  test(`status ${status} is not retried by itself; the answer is kept and the next one goes on`, async () => {
    const { outbox, sent, timers, lines } = bench((index) => (index === 0 ? new Refused(status, "no", "Not like this.") : true));
    outbox.put(0, answer("left"));
    outbox.put(1, answer("right"));
    await outbox.settled();
    assert.equal(timers.size, 0);
    assert.deepEqual(sent, [0, 1]);
    assert.deepEqual(
      outbox.refused.map((e) => [e.index, e.refused]),
      [[0, "Not like this."]],
    );
    assert.equal(lines.at(-1), "refused");
  });
}

test("refused answers go out again when asked to", async () => {
  const { outbox, stored } = bench((_, tries) => (tries === 1 ? new Refused(400, "no", "no") : true));
  outbox.put(0, answer("left"));
  await outbox.settled();
  await outbox.retryRefused();
  assert.deepEqual(outbox.waiting, []);
  assert.deepEqual(stored, [[0, 1]]);
});

test("already_answered ends the matter; another conflict does not", async () => {
  const known = bench(() => new Refused(409, "already_answered", "stands"));
  known.outbox.put(0, answer("left"));
  await known.outbox.settled();
  assert.deepEqual(known.stored, [[0, null]]);
  assert.deepEqual(known.outbox.waiting, []);

  disks = disk();
  const other = bench(() => new Refused(409, "out_of_order", "no"));
  other.outbox.put(0, answer("left"));
  await other.outbox.settled();
  assert.equal(other.outbox.refused.length, 1);
});

test("a resend has the same bytes, after a reload too", async () => {
  const first = bench(() => new TypeError("offline"));
  // Key order and numbers that another round of parsing might write otherwise.
  first.outbox.put(0, { choice: "left", rt: 1e21, onset: -0, timestamp: "2026-01-01T00:00:00Z", input: "pen" });
  await settle();
  await first.elapse();
  first.outbox.stop();
  const second = bench(() => true);
  await second.outbox.settled();
  const body = '{"choice":"left","rt":1e+21,"onset":0,"timestamp":"2026-01-01T00:00:00Z","input":"pen"}';
  assert.deepEqual([...first.bodies, ...second.bodies], [body, body, body]);
});

test("answers that a page before the update left are sent, in order, refused ones when asked to", async () => {
  const old = [
    { index: 1, answer: { choice: "right", rt: 2.5, onset: 1, plugin_version: "1.0.0" } },
    { index: 3, answer: answer("left"), refused: "no" },
  ];
  disks.setItem("box", JSON.stringify(old));
  const { outbox, sent, bodies } = bench(() => true);
  assert.deepEqual([...outbox.indices], [1, 3]);
  outbox.put(2, answer("left"));
  outbox.put(1, answer("left"));
  await outbox.settled();
  assert.deepEqual(sent, [1, 2]);
  assert.equal(bodies[0], '{"choice":"right","rt":2.5,"onset":1,"plugin_version":"1.0.0"}');
  await outbox.retryRefused();
  assert.deepEqual(sent, [1, 2, 3]);
  assert.equal(disks.getItem("box"), null);
});

test("the first answer to a trial stands", async () => {
  const { outbox } = bench(() => new TypeError("offline"));
  outbox.put(0, answer("left"));
  outbox.put(0, answer("right"));
  await settle();
  assert.deepEqual(
    outbox.waiting.map((e) => JSON.parse(e.body).choice),
    ["left"],
  );
});

test("the server's own waiting time is respected", async () => {
  const { outbox, timers } = bench(() => new Refused(429, "slow_down", "x", 20_000));
  outbox.put(0, answer("left"));
  await settle();
  assert.deepEqual(
    [...timers.values()].map((t) => t.ms),
    [20_000],
  );
});

test("a store lists its keys by their beginning", () => {
  const store = openStore(() => disks);
  store.write("a:1", 1);
  store.write("a:2", 2);
  store.write("b:1", 3);
  assert.deepEqual(store.keys("a:").sort(), ["a:1", "a:2"]);
  store.remove("a:1");
  assert.deepEqual(store.keys("a:"), ["a:2"]);
});

test("a stopped outbox sends nothing more", async () => {
  const { outbox, sent, timers } = bench(() => new TypeError("offline"));
  outbox.put(0, answer("left"));
  await settle();
  outbox.stop();
  await outbox.flush();
  assert.equal(timers.size, 0);
  assert.deepEqual(sent, [0]);
});

test("waiting doubles from one second to thirty, with jitter below", () => {
  assert.deepEqual(
    [1, 2, 3, 4, 5, 6, 60].map((n) => backoffMs(n, () => 1)),
    [1000, 2000, 4000, 8000, 16_000, 30_000, 30_000],
  );
  assert.equal(
    backoffMs(3, () => 0),
    2000,
  );
});

const logged = { ...answer("left"), viewport: [1280, 800], frames: { left: { fps: 12 } } };

test("an answer that is refused with its logs is sent without them", async () => {
  const { outbox, sent, bodies, stored } = bench((_, tries) => (tries === 1 ? new Refused(413, "too_large", "too long") : true));
  outbox.put(0, logged);
  await outbox.settled();
  assert.deepEqual([sent, stored], [[0, 0], [[0, 1]]]);
  assert.deepEqual(
    bodies.map((body) => Object.keys(JSON.parse(body)).length),
    [5, 3],
  );
});

test("what something in between will not carry goes without its logs after three tries", async () => {
  const { outbox, sent, bodies, elapse } = bench((_, tries) => (tries <= 3 ? new Refused(413, "http_413", "proxy") : true));
  outbox.put(0, logged);
  await settle();
  for (let i = 0; i < 3; i++) await elapse();
  assert.deepEqual(
    [sent, bodies.map((body) => body.includes("frames"))],
    [
      [0, 0, 0, 0],
      [true, true, true, false],
    ],
  );
  assert.deepEqual(outbox.waiting, []);
});

test("a trial whose answer was refused can be taken again", async () => {
  const { outbox, bodies } = bench((_, tries) => (tries <= 1 ? new Refused(422, "invalid_field", "no") : true));
  outbox.put(0, answer("left"));
  await outbox.settled();
  outbox.discard(1);
  assert.deepEqual([...outbox.indices], [0]);
  outbox.discard(0);
  assert.deepEqual([...outbox.indices], []);
  outbox.put(0, answer("right"));
  await outbox.settled();
  assert.deepEqual([bodies.length, outbox.waiting], [2, []]);
});

test("nonsense in storage is no answer, and stops nobody", async () => {
  for (const nonsense of ["{}", "7", '"x"', "null", '[null,7,{"index":1},{"body":"{}"}]', "[[", '{"length":3}']) {
    disks = disk();
    disks.setItem("box", nonsense);
    const { outbox, sent } = bench(() => true);
    outbox.put(0, answer("left"));
    await outbox.settled();
    assert.deepEqual(sent, [0], nonsense);
  }
});
