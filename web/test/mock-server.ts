// The HTTP interface as the web pages see it, in memory, with faults on request: for the tests and for looking at the pages
// without the server (`node --import ./test/typescript.mjs test/mock-server.ts DIST PORT`). Its answers have the server's types; its numbers are made up.
import { randomUUID } from "node:crypto";
import { readFile } from "node:fs/promises";
import { createServer, type IncomingMessage, type ServerResponse } from "node:http";
import type { AddressInfo } from "node:net";
import { extname, join } from "node:path";
import { pathToFileURL } from "node:url";
import type { components } from "../api/schema.ts";
import type { Acknowledgement, Completion, State, Study, Trial } from "../participant/api.ts";
import { type Material, material, type Planned, study } from "./mock-study.ts";

type Schemas = components["schemas"];

const TYPES: Record<string, string> = { ".js": "text/javascript; charset=utf-8", ".css": "text/css; charset=utf-8", ".svg": "image/svg+xml", ".txt": "text/plain; charset=utf-8" };
const CSP = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'";

const HEADERS = {
  "content-security-policy": CSP,
  "cross-origin-opener-policy": "same-origin",
  "cross-origin-embedder-policy": "require-corp",
  "cross-origin-resource-policy": "same-origin",
};

/** A session as the mock keeps it: answers by trial, to the byte. */
export interface Session {
  id: string;
  token: string;
  /** By which it was begun. */
  key: string | undefined;
  consented: boolean;
  /** How often its plan was decided anew: every other one is the mirror of the first. */
  replans: number;
  answers: Map<number, string>;
  code: string | null;
  body: Schemas["NewSession"];
}

/** `[status, JSON or null, headers?]` */
type Reply = [number, unknown, Record<string, string>?];
type Fault = { status?: number; body?: unknown; html?: string; after?: boolean } | "hang up" | "stall" | "half" | null;
export type Results = (path: string, query: URLSearchParams) => Reply | null;

export interface Options {
  dist: string;
  port?: number;
  /** May answer in the server's place (`after: true` lets the request do its work first, as when an acknowledgement is lost). */
  fault?: (request: { method: string; path: string; body: unknown }) => Fault;
  results?: Results | null;
  stuff?: Material;
  /** An adaptive plan: so many trials are decided at the start, one more with each answer, and `most` is promised. */
  grow?: { start: number; most: number } | null;
  /** Gives out a stimulus's bytes in the server's place, from one byte on. */
  serve?: ((stimulus: { sha256: string; data: Buffer; from: number }, response: ServerResponse) => void) | null;
  /** Whether it gives out parts of a stimulus. */
  ranges?: boolean;
  /** A script that runs before the page's own. */
  spoil?: string;
  /** When an answer counts. */
  response?: Study["response"];
  /** In which sizes pictures are shown. */
  shownAs?: Study["display"];
  /** Each visit is somebody else's. */
  perVisit?: boolean;
  /** What a link makes of a visit that asks to be another than a participant's. */
  visitKind?: Schemas["VisitKind"]["visit"];
  /** Texts in place of the study's, in every language. */
  texts?: Partial<Study["texts"]>;
}

export const problem = (status: number, code: Schemas["ProblemCode"], detail: string, more: Partial<Schemas["Problem"]> = {}): Reply => {
  const body: Schemas["Problem"] = { type: "about:blank", title: code, status, code, detail, ...more };
  return [status, body];
};

export async function startMock({
  dist,
  port = 0,
  fault = () => null,
  results = null,
  stuff = material(),
  grow = null,
  response = study.response,
  shownAs = study.display,
  perVisit = false,
  serve = null,
  ranges = true,
  spoil = "",
  texts = {},
  visitKind = "participant",
}: Options) {
  const sessions = new Map<string, Session>();
  const log: Array<{ method: string; path: string; query: string; text: string; key: string | undefined }> = [];
  let researcher = false;

  const worded = <T extends Pick<Study, "texts">>(told: T): T => ({ ...told, texts: { ...told.texts, ...texts } });
  const translations = Object.fromEntries(Object.entries(study.translations).map(([language, told]) => [language, worded(told)]));
  const found = (): Study => ({ ...worded(study), translations, response, display: shownAs, per_visit: perVisit, trial_kinds: [...new Set(stuff.trials.map((trial) => trial.trial))] });
  const decided = (s: Session): Trial[] => {
    const count = grow === null ? stuff.trials.length : Math.min(stuff.trials.length, grow.start + s.answers.size);
    const trials = s.replans % 2 === 0 ? stuff.trials : stuff.trials.map(mirrored);
    return trials.slice(0, count).map((trial) => ({ ...trial, answered: s.answers.has(trial.trial_index) }));
  };
  const more = (s: Session) => decided(s).length < stuff.trials.length;
  const next = (s: Session) => decided(s).find((trial) => !trial.answered)?.trial_index ?? null;
  const state = (s: Session): State => ({
    session_id: s.id,
    study_id: study.id,
    study: found(),
    language: Object.hasOwn(study.translations, String(s.body.display?.language)) ? String(s.body.display?.language) : study.language,
    status: s.code ? "completed" : s.consented ? "in_progress" : "consent",
    named: s.body.params?.PROLIFIC_PID !== undefined,
    consented: s.consented,
    trials: s.consented ? decided(s) : [],
    plan: String(s.replans),
    more: more(s),
    most_trials: grow?.most ?? stuff.trials.length,
    next_trial: s.consented ? next(s) : null,
    ...(s.code ? { completion_code: s.code } : {}),
  });

  const ofSession = (method: string, s: Session, rest: string, query: URLSearchParams, text: string): Reply | null => {
    if (method === "GET" && rest === "") return [200, state(s)];
    if (method === "POST" && rest === "/consent") {
      s.consented = true;
      return [200, state(s)];
    }
    const index = Number(rest.match(/^\/trials\/(\d+)$/)?.[1] ?? NaN);
    if ((method === "PUT" || method === "POST") && index < decided(s).length) {
      if ((query.get("plan") ?? String(s.replans)) !== String(s.replans)) return problem(409, "plan_changed", "The session has another plan by now.");
      const stored = s.answers.get(index);
      if (stored !== undefined && stored !== text) return problem(409, "already_answered", "This trial has an answer already; the first one stands.");
      s.answers.set(index, text);
      const known = query.get("known");
      const reply: Acknowledgement = { acknowledged: true, next_trial: next(s), more: more(s), trials: known === null ? [] : decided(s).slice(Number(known)) };
      return [200, reply];
    }
    if (method === "POST" && rest === "/completion") {
      const missing = decided(s).flatMap((trial) => (trial.answered ? [] : [trial.trial_index]));
      if (missing.length > 0 || more(s)) return problem(409, "incomplete", "Some trials have no answer yet.", { missing, more: more(s) });
      s.code ??= "LAKON-7Q4F";
      const reply: Completion = { completion_code: s.code, ...(s.body.params?.PROLIFIC_PID ? { redirect: "https://app.prolific.com/submissions/complete?cc=LAKON7Q4F" } : {}) };
      return [200, reply];
    }
    return null;
  };

  const signIn = (method: string, body: unknown): Reply | null => {
    const mine = { "set-cookie": "kelir_session=mock; HttpOnly; SameSite=Strict; Path=/" };
    if (method === "POST") {
      researcher = (body as Schemas["SignIn"] | undefined)?.password === "wayang";
      return researcher ? [204, null, mine] : problem(401, "wrong_password", "That is not the password.");
    }
    if (method === "DELETE") {
      researcher = false;
      return [204, null];
    }
    const name: Schemas["SignedIn"] = { name: "researcher" };
    return researcher ? [200, name] : problem(401, "unauthorized", "Sign in first.");
  };

  const api = (method: string, path: string, query: URLSearchParams, text: string, token: string | undefined, key: string | undefined): Reply => {
    const body: unknown = text === "" ? undefined : JSON.parse(text);
    if (method === "GET" && path === `/api/v1/studies/${study.id}`) {
      return [200, found()];
    }
    if (method === "GET" && path === `/api/v1/studies/${study.id}/visit`) {
      const signed = ["preview", "pilot", "exp", "key", "sig"];
      if (query.has("sig") && [...query.keys()].some((name) => !signed.includes(name))) return problem(403, "link_refused", "This link has been changed.");
      const kind: Schemas["VisitKind"] = { visit: visitKind };
      return [200, kind];
    }
    if (method === "POST" && path === `/api/v1/studies/${study.id}/sessions`) {
      const same = key === undefined ? undefined : [...sessions.values()].find((other) => other.key === key && !other.consented);
      const s: Session = same ?? {
        id: `${visitKind === "preview" ? "preview-" : ""}${randomUUID()}`,
        token: randomUUID(),
        key,
        consented: false,
        replans: 0,
        answers: new Map(),
        code: null,
        body: body as Session["body"],
      };
      s.token = randomUUID();
      sessions.set(s.id, s);
      const created: Schemas["CreatedSession"] = { ...state(s), token: s.token };
      return [201, created];
    }
    const [, id, rest = ""] = path.match(/^\/api\/v1\/(?:sessions|previews)\/([^/]+)(\/.*)?$/) ?? [];
    if (id !== undefined) {
      const s = sessions.get(id);
      if (s === undefined || token !== s.token) return problem(401, "unauthorized", "This session is not known here.");
      return ofSession(method, s, rest, query, text) ?? problem(404, "not_found", "There is nothing here.");
    }
    if (path === "/api/v1/auth/session") return signIn(method, body) ?? problem(405, "method_not_allowed", "Not like this.");
    const reply = results?.(path, query) ?? problem(404, "not_found", "There is nothing here.");
    return reply[0] < 400 && !researcher ? problem(401, "unauthorized", "Sign in first.") : reply;
  };

  const server = createServer(async (req, res) => {
    const text = await read(req);
    const method = req.method ?? "GET";
    const { pathname: path, searchParams: query, search } = new URL(req.url ?? "/", "http://mock");
    const send = (status: number, type: string, data: string | Buffer, headers: Record<string, string> = {}) => {
      res.writeHead(status, { "content-type": type, ...HEADERS, ...headers });
      res.end(data);
    };
    const json = ([status, data, headers = {}]: Reply) =>
      send(status, status < 400 ? "application/json" : "application/problem+json", data === null ? "" : JSON.stringify(data), { "cache-control": "no-store", ...headers });
    const planned = fault({ method, path, body: text === "" ? undefined : JSON.parse(text) });
    if (planned === "hang up") return void req.socket.destroy();
    if (planned === "stall") return;
    if (planned === "half") return void res.writeHead(200, { "content-type": "application/json", "content-length": 500 }).write('{"acknowledged":');
    if (planned?.html !== undefined) return send(planned.status ?? 200, "text/html", planned.html);
    if (planned !== null && planned.after !== true) return json(planned.body === undefined ? problem(planned.status ?? 500, "internal", "A planned fault.") : [planned.status ?? 500, planned.body]);
    if (path.startsWith("/api/")) {
      const key = req.headers["idempotency-key"]?.toString();
      log.push({ method, path, query: search, text, key });
      const answer = api(method, path, query, text, req.headers.authorization?.replace(/^Bearer /, ""), key);
      return planned?.after === true ? void req.socket.destroy() : json(answer);
    }
    if (path.startsWith("/stimuli/")) {
      const stimulus = stuff.bytes.get(path.slice(9));
      if (stimulus === undefined) return json(problem(404, "not_found", "No such stimulus."));
      const headers = { "cache-control": "public, max-age=31536000, immutable", etag: `"${path.slice(9)}"` };
      if (serve === null) return send(200, "application/vnd.kelir.stimulus", stimulus.data, headers);
      const { length } = stimulus.data;
      const from = Number((ranges ? req.headers.range : undefined)?.match(/^bytes=(\d+)-$/)?.[1] ?? 0);
      const part: Record<string, string> = from > 0 ? { "content-range": `bytes ${from}-${length - 1}/${length}` } : {};
      res.writeHead(from > 0 ? 206 : 200, { ...HEADERS, ...headers, ...part, "content-type": "application/vnd.kelir.stimulus", "content-length": length - from });
      return serve({ sha256: path.slice(9), data: stimulus.data, from }, res);
    }
    const page = path.startsWith("/study/") ? "participant.html" : path.startsWith("/console") ? "console.html" : null;
    try {
      if (page !== null)
        return send(
          200,
          "text/html; charset=utf-8",
          (await readFile(join(dist, page), "utf8")).replace("<script", () => `${spoil === "" ? "" : '<script src="/assets/spoil.js"></script>'}<script`),
        );
      if (path === "/assets/spoil.js") return send(200, TYPES[".js"] ?? "", spoil);
      if (path.startsWith("/assets/")) return send(200, TYPES[extname(path)] ?? "application/octet-stream", await readFile(join(dist, "assets", path.slice(8))));
    } catch {
      // not found, below
    }
    json(problem(404, "not_found", "There is nothing here."));
  });
  await new Promise<void>((resolve) => server.listen(port, "127.0.0.1", resolve));
  const close = () =>
    new Promise((resolve) => {
      server.closeAllConnections();
      server.close(resolve);
    });
  return { url: `http://127.0.0.1:${(server.address() as AddressInfo).port}`, sessions, log, close, stuff };
}

/** The pair with its sides exchanged; a trial that has no sides stays. */
const mirrored = (trial: Planned): Planned => {
  const { left, right } = trial.shown;
  return left === undefined || right === undefined ? trial : { ...trial, shown: { left: right, right: left } };
};

async function read(request: IncomingMessage): Promise<string> {
  const chunks: Buffer[] = [];
  for await (const chunk of request) chunks.push(chunk as Buffer);
  return Buffer.concat(chunks).toString();
}

if (import.meta.url === pathToFileURL(process.argv[1] ?? "").href) {
  const { results } = await import("./mock-results.ts");
  const { url } = await startMock({ dist: process.argv[2] ?? "", port: Number(process.argv[3] ?? 8090), results: results(material()) });
  console.log(`${url}/study/${study.id}\n${url}/console (password: wayang)`);
}
