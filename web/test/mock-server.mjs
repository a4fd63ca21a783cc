// The HTTP interface as the web pages see it, in memory, with faults on request: for the tests and for looking at the pages
// without the server (`node test/mock-server.mjs DIST PORT`). Its answers are shaped like the server's; its numbers are made up.
import { randomUUID } from "node:crypto";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join } from "node:path";
import { pathToFileURL } from "node:url";
import { shadow, sha256 } from "./samples.mjs";

const TYPES = { ".js": "text/javascript; charset=utf-8", ".css": "text/css; charset=utf-8", ".svg": "image/svg+xml", ".txt": "text/plain; charset=utf-8" };
const CSP =
  "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'";

const HEADERS = {
  "content-security-policy": CSP,
  "cross-origin-opener-policy": "same-origin",
  "cross-origin-embedder-policy": "require-corp",
  "cross-origin-resource-policy": "same-origin",
};

export const study = {
  id: "shadow-puppets",
  title: "Shadows on a screen",
  question: "Which image is more likely to be real?",
  surround: 0.2,
  size: [592, 333],
  estimated_minutes: 3,
  texts: {
    welcome: [
      "In this study you look at pairs of pictures of shadow puppets behind a cloth screen. In each pair you choose the one that you think is more likely to be real.",
      "There are no right answers to learn and nothing to prepare.",
    ],
    consent: [
      "Taking part is voluntary. You can stop at any time by closing this page, and you need not say why.",
      "We store your choices, how long each took, and the size and refresh rate of your display. We don't store your name or address.",
      "The answers are analysed together with those of other people and may be published without anything that identifies you.",
    ],
    instructions: ["Two pictures appear beside each other, or below each other on a narrow screen.", "Choose one by clicking or touching it, or with the arrow keys. Take the time you need, but trust your first impression."],
    debriefing: [
      "All pictures were computed. In some pairs one was drawn by a fast method and the other by a slow, accurate one; in others one was passed through a simulated camera, to look like a photograph.",
      "We want to know whether people can tell them apart.",
    ],
    thanks: ["You have finished. Thank you for your time and your eyes."],
  },
};

/** Pictures and plan: three still pairs of each of two blocks and one animation, as small as the tests like them. */
export function material({ frames = 24, fps = 12 } = {}) {
  const bytes = new Map();
  const add = (type, data) => {
    const hash = sha256(data);
    bytes.set(hash, { type, data });
    return { sha256: hash, url: `/stimuli/${hash}` };
  };
  const still = (options) => add("image/png", shadow(options));
  const animation = (options) => {
    const list = Array.from({ length: frames }, (_, i) => still({ ...options, turn: 0.3 * Math.sin((2 * Math.PI * i) / frames) }).sha256);
    return add("application/vnd.kelir.animation+json", Buffer.from(JSON.stringify({ fps, loop: true, width: 592, height: 333, frames: list })));
  };
  const pair = (block_id, block_index, pair_index, kind, left, right) => ({ block_id, block_index, pair_index, kind, left, right, width: 592, height: 333 });
  const trials = [
    pair("stills", 0, 0, "still", still({ turn: 0.1 }), still({ turn: 0.1, noise: 0.1 })),
    pair("stills", 0, 1, "still", still({ turn: -0.3, soft: 20, noise: 0.1 }), still({ turn: -0.3, soft: 20 })),
    pair("photographs", 1, 0, "still", still({ turn: 0.5 }), still({ turn: 0.5, noise: 0.25 })),
    pair("photographs", 1, 1, "still", still({ turn: 0.9, soft: 12 }), still({ turn: 0.9, soft: 12, noise: 0.25 })),
    pair("animation", 2, 0, "animation", animation({ soft: 8 }), animation({ soft: 8, noise: 0.1 })),
  ].map((trial, trial_index) => ({ trial_index, ...trial }));
  return { bytes, trials };
}

/**
 * Starts the server. `fault(request)` may return `{ status, body?, after? }` to answer in its place (`after: true` lets the
 * request do its work first, as when an acknowledgement is lost), or `"hang up"`.
 */
export async function startMock({ dist, port = 0, fault = () => null, results = null, stuff = material() } = {}) {
  const sessions = new Map();
  const log = [];
  let researcher = false;

  const state = (s) => {
    const trials = stuff.trials.map((t) => ({ ...t, answered: s.answers.has(t.trial_index) }));
    const next = trials.find((t) => !t.answered);
    return {
      session_id: s.id,
      study_id: study.id,
      status: s.code ? "completed" : s.consented ? "in_progress" : "consent",
      consented: s.consented,
      trials: s.consented ? trials : [],
      next_trial: s.consented ? (next?.trial_index ?? null) : null,
      ...(s.code ? { completion_code: s.code } : {}),
    };
  };
  const error = (status, code, message) => [status, { error: { code, message } }];

  /** `[status, json, headers?]` */
  const api = (method, path, body, token) => {
    if (method === "GET" && path === `/api/v1/studies/${study.id}`) return [200, study];
    if (method === "POST" && path === `/api/v1/studies/${study.id}/sessions`) {
      const s = { id: randomUUID(), token: randomUUID(), consented: false, answers: new Map(), code: null, body };
      sessions.set(s.id, s);
      return [201, { ...state(s), token: s.token }];
    }
    const [, id, rest = ""] = path.match(/^\/api\/v1\/sessions\/([^/]+)(\/.*)?$/) ?? [];
    if (id !== undefined) {
      const s = sessions.get(id);
      if (s === undefined || token !== s.token) return error(401, "unauthorized", "This session is not known here.");
      if (method === "GET" && rest === "") return [200, state(s)];
      if (method === "POST" && rest === "/consent") {
        s.consented = true;
        return [200, state(s)];
      }
      const index = Number(rest.match(/^\/trials\/(\d+)$/)?.[1] ?? NaN);
      if (method === "PUT" && index in stuff.trials) {
        const stored = s.answers.get(index);
        if (stored !== undefined && stored !== JSON.stringify(body)) return error(409, "already_answered", "This trial has an answer; the first one stands.");
        s.answers.set(index, JSON.stringify(body));
        return [200, { acknowledged: true, next_trial: state(s).next_trial }];
      }
      if (method === "POST" && rest === "/complete") {
        if (s.answers.size < stuff.trials.length) return error(409, "incomplete", "Some trials have no answer yet.");
        s.code ??= "LAKON-7Q4F";
        return [200, { completion_code: s.code, ...(s.body?.params?.PROLIFIC_PID ? { redirect: "https://app.prolific.com/submissions/complete?cc=LAKON7Q4F" } : {}) }];
      }
    }
    if (method === "POST" && path === "/api/v1/login") {
      researcher = body?.password === "wayang";
      return researcher ? [204, null, { "set-cookie": "kelir_session=mock; HttpOnly; SameSite=Strict; Path=/" }] : error(401, "wrong_password", "That is not the password.");
    }
    if (method === "POST" && path === "/api/v1/logout") {
      researcher = false;
      return [204, null];
    }
    if (path.startsWith("/api/v1/admin/")) {
      if (!researcher) return error(401, "unauthorized", "Sign in first.");
      const made = results?.(path, [...sessions.values()], stuff);
      if (made) return made;
    }
    return error(404, "not_found", "There is nothing here.");
  };

  const server = createServer(async (req, res) => {
    const chunks = [];
    for await (const chunk of req) chunks.push(chunk);
    const text = Buffer.concat(chunks).toString();
    const body = text ? JSON.parse(text) : undefined;
    const { pathname: path } = new URL(req.url, "http://mock");
    const token = req.headers.authorization?.replace(/^Bearer /, "");
    const send = (status, type, data, headers = {}) => {
      res.writeHead(status, { "content-type": type, ...HEADERS, ...headers });
      res.end(data);
    };
    const json = ([status, data, headers = {}]) => send(status, "application/json", data === null ? "" : JSON.stringify(data), { "cache-control": "no-store", ...headers });
    const planned = fault({ method: req.method, path, body });
    if (planned === "hang up") return req.socket.destroy();
    if (planned && !planned.after) return json([planned.status, planned.body ?? { error: { code: "mock", message: "A planned fault." } }]);
    if (path.startsWith("/api/")) {
      log.push({ method: req.method, path, body });
      const answer = api(req.method, path, body, token);
      return planned?.after ? req.socket.destroy() : json(answer);
    }
    if (path.startsWith("/stimuli/")) {
      const stimulus = stuff.bytes.get(path.slice(9));
      if (stimulus === undefined) return json(error(404, "not_found", "No such stimulus."));
      return send(200, stimulus.type, stimulus.data, { "cache-control": "public, max-age=31536000, immutable" });
    }
    const page = path.startsWith("/study/") ? "participant.html" : path.startsWith("/console") ? "console.html" : null;
    try {
      if (page) return send(200, "text/html; charset=utf-8", await readFile(join(dist, page)));
      if (path.startsWith("/assets/")) return send(200, TYPES[extname(path)], await readFile(join(dist, "assets", path.slice(8))));
    } catch {
      // not found, below
    }
    json(error(404, "not_found", "There is nothing here."));
  });
  await new Promise((resolve) => server.listen(port, "127.0.0.1", resolve));
  const close = () => new Promise((resolve) => (server.closeAllConnections(), server.close(resolve)));
  return { url: `http://127.0.0.1:${server.address().port}`, sessions, log, close, stuff };
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const { results } = await import("./mock-results.mjs");
  const { url } = await startMock({ dist: process.argv[2], port: Number(process.argv[3] ?? 8090), results });
  console.log(`${url}/study/${study.id}\n${url}/console (password: wayang)`);
}
