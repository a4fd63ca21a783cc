// The plain comparison for `kelir bench load`: Express and better-sqlite3 (WAL, synchronous = FULL), one INSERT a request, the same rows.
// server.mjs FILE: listens on a free port of this machine and prints it.
import { createHash, randomUUID } from "node:crypto";
import Database from "better-sqlite3";
import express from "express";

const db = new Database(process.argv[2]);
db.pragma("journal_mode = WAL");
db.pragma("synchronous = FULL");
db.exec(`
  CREATE TABLE sessions (session_id TEXT PRIMARY KEY, token_hash TEXT, trials TEXT, consented_at TEXT);
  CREATE TABLE responses (response_id INTEGER PRIMARY KEY, session_id TEXT, trial_index INTEGER, block_id TEXT, pair_id TEXT, left_sha256 TEXT,
    right_sha256 TEXT, left_condition TEXT, right_condition TEXT, choice TEXT, chosen_condition TEXT, rt_ms REAL, received_at TEXT, payload TEXT,
    payload_hash TEXT, UNIQUE (session_id, trial_index));
`);
const sha256 = (text) => createHash("sha256").update(text).digest("hex");
const hash = "a".repeat(64);
const plan = JSON.stringify(Array.from({ length: 5 }, (_, i) => ({ block_id: "stills", pair_id: `still-${i}`, left: "pa", right: "mc", left_sha256: hash, right_sha256: hash })));
const begin = db.prepare("INSERT INTO sessions VALUES (?, ?, ?, NULL)");
const consent = db.prepare("UPDATE sessions SET consented_at = ? WHERE session_id = ?");
const find = db.prepare("SELECT token_hash, trials FROM sessions WHERE session_id = ?");
const store = db.prepare(
  `INSERT OR IGNORE INTO responses (session_id, trial_index, block_id, pair_id, left_sha256, right_sha256, left_condition, right_condition, choice,
   chosen_condition, rt_ms, received_at, payload, payload_hash) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)`,
);

const app = express();
app.use(express.json({ limit: "1mb" }));
app.post("/api/v1/studies/:study/sessions", (_request, response) => {
  const [session_id, token] = [randomUUID(), randomUUID()];
  begin.run(session_id, sha256(token), plan);
  response.status(201).json({ session_id, token });
});
app.post("/api/v1/sessions/:id/consent", (request, response) => {
  consent.run(new Date().toISOString(), request.params.id);
  response.json({});
});
app.put("/api/v1/sessions/:id/trials/:trial", (request, response) => {
  const session = find.get(request.params.id);
  if (session?.token_hash !== sha256((request.headers.authorization ?? "").slice(7))) return response.status(401).end();
  const [trial, body] = [JSON.parse(session.trials)[+request.params.trial], request.body];
  const [payload, now] = [JSON.stringify(body), new Date().toISOString()];
  const chosen = body.choice === "left" ? trial.left : trial.right;
  const shown = [trial.block_id, trial.pair_id, trial.left_sha256, trial.right_sha256, trial.left, trial.right];
  store.run(request.params.id, +request.params.trial, ...shown, body.choice, chosen, body.rt, now, payload, sha256(payload));
  response.json({ acknowledged: true });
});
const server = app.listen(0, "127.0.0.1", () => console.log(`http://127.0.0.1:${server.address().port}`));
