// What browsers, clocks, storages and networks do to a study. Each ends with the code, or with a sentence that says what to do.
import { problem } from "../mock-server.ts";

/** Before the page's own scripts, in the page. Timers of a second and more run twenty times as fast: nobody waits for a stall. */
export const HURRY = `{
  const later = setTimeout;
  window.setTimeout = (run, ms = 0, ...given) => later(run, ms >= 900 ? ms / 20 : ms, ...given);
}`;

const storage = (get) => `for (const name of ["localStorage", "sessionStorage"]) Object.defineProperty(window, name, { configurable: true, get: ${get} });`;
const method = (name, body) => `Storage.prototype.${name} = function (key) { ${body} };`;
const quota = 'throw new DOMException("full", "QuotaExceededError")';
const clock = (now) => `{ const was = performance.now.bind(performance); performance.now = () => (${now})(was()); }`;
const without = (...paths) =>
  paths
    .map(
      (path) =>
        `try { const at = ${path.split(".").slice(0, -1).join(".")}; Object.defineProperty(at, "${path.split(".").at(-1)}", { value: undefined, configurable: true, writable: true }); } catch {}`,
    )
    .join("\n");

/** The first `times` requests that `is` names go as `fault` says. */
const first = (times, is, fault) => () => {
  let seen = 0;
  return (request) => (is(request) && seen++ < times ? fault : null);
};
const always = (is, fault) => () => (request) => (is(request) ? fault : null);
const put = ({ method }) => method === "PUT";
const toApi = ({ path }) => path.startsWith("/api/");
const [, refusal] = problem(422, "invalid_field", "The answer has a fault.");
const portal = { status: 200, html: "<!doctype html><title>Welcome to our hotel</title>" };

/** `spoil`: script before the page's; `fault`: makes the server's; `says`: what is said in place of a code; `storesOneSession`. */
export const troubles = [
  // Storage
  { name: "storage whose mention throws", spoil: storage('() => { throw new DOMException("blocked", "SecurityError"); }') },
  { name: "no storage", spoil: storage("() => null") },
  { name: "storage that is full", spoil: method("setItem", quota) },
  {
    name: "storage that fills up later",
    spoil: `{ const set = Storage.prototype.setItem; Storage.prototype.setItem = function (key, value) { if (String(key).startsWith("kelir:outbox")) ${quota}; set.call(this, key, value); }; }`,
  },
  {
    name: "storage that gives nothing back",
    spoil: method("getItem", 'throw new Error("corrupt")') + method("key", 'throw new Error("corrupt")') + method("removeItem", 'throw new Error("corrupt")'),
  },
  { name: "storage that forgets", spoil: method("setItem", "") },
  {
    name: "nonsense in storage",
    spoil:
      'if (!sessionStorage.spoilt) { sessionStorage.spoilt = 1; localStorage.setItem("kelir:session:shadow-puppets", "[7]"); localStorage.setItem("kelir:start:shadow-puppets", "{}"); localStorage.setItem("kelir:session:other", "{\\"session_id\\":7}"); }',
  },
  // Networks
  { name: "a line that is cut twice", fault: first(2, put, "hang up") },
  { name: "an answer that stalls for ever", fault: first(1, put, "stall") },
  {
    name: "everything stalls once",
    fault: () => {
      const seen = new Set();
      return ({ method, path }) => (path.startsWith("/api/") && !seen.has(method + path) && seen.add(method + path) ? "stall" : null);
    },
  },
  { name: "half an acknowledgement", fault: first(1, put, "half") },
  { name: "a network without PUT", fault: always(put, { status: 405, html: "no" }) },
  { name: "a server's proxy without PUT", fault: always(put, { status: 405 }) },
  { name: "a firewall that blocks PUT", fault: always(put, { status: 403, html: "Blocked" }) },
  { name: "a cloud's gateway that refuses in JSON", fault: first(3, toApi, { status: 403, body: { code: "AccessDenied", message: "Forbidden" } }) },
  {
    name: "a proxy that takes no long bodies",
    fault:
      () =>
      ({ method, body }) =>
        method === "PUT" && JSON.stringify(body).includes('"viewport"') ? { status: 413, html: "too large" } : null,
  },
  { name: "a captive portal before consent", fault: first(2, toApi, portal) },
  { name: "a captive portal amid the trials", fault: first(2, put, portal) },
  { name: "a captive portal that speaks JSON", fault: first(2, toApi, { status: 200, body: {} }) },
  { name: "a captive portal before the code", fault: first(1, ({ path }) => path.endsWith("/completion"), portal) },
  { name: "a gateway that is down", fault: first(2, toApi, { status: 502, html: "Bad gateway" }) },
  { name: "a lost reply to the beginning", fault: first(1, ({ method, path }) => method === "POST" && path.endsWith("/sessions"), { after: true }), sessions: 1 },
  {
    name: "a network that says it is gone and is not",
    spoil: 'Object.defineProperty(Navigator.prototype, "onLine", { get: () => false }); addEventListener("load", () => dispatchEvent(new Event("offline")));',
  },
  { name: "an answer that is refused in full", fault: first(1, put, { status: 422, body: refusal }) },
  { name: "an answer that is refused twice, so that its trial is taken again", fault: first(2, put, { status: 422, body: refusal }) },
  {
    name: "an answer that is always refused",
    fault: always(({ method, path }) => method === "PUT" && path.endsWith("/0"), { status: 422, body: refusal }),
    says: /could not be stored.*try.* again.*send the researchers/is,
  },
  {
    name: "a server that forgot the session",
    fault:
      () =>
      ({ method }) =>
        method === "PUT" ? { status: 401, body: problem(401, "unauthorized", "No.")[1] } : null,
    says: /does not know this session any more.*reload/is,
  },
  { name: "a study that is not there", fault: always(toApi, { status: 404, body: problem(404, "not_found", "No.")[1] }), says: /no such study.*check the link/is },
  { name: "a script that does not arrive", fault: always(({ path }) => /participant.*js$/.test(path), { status: 502, html: "Bad gateway" }), says: /could not be loaded.*reload/is },
  { name: "a script in whose place a portal answers", fault: always(({ path }) => /participant.*js$/.test(path), portal), says: /could not be loaded.*reload/is },
  { name: "a script that stalls", fault: always(({ path }) => /participant.*js$/.test(path), "stall"), says: /could not be loaded.*reload/is },
  { name: "a style that does not arrive", fault: always(({ path }) => /participant.*css$/.test(path), { status: 404, html: "no" }), says: /could not be loaded.*reload/is },
  // Clocks
  { name: "a clock that jumps back now and then", spoil: clock("(t) => t - 5000 * Math.floor(t / 700)") },
  { name: "a clock of whole tenths of a second", spoil: clock("(t) => 100 * Math.floor(t / 100)") },
  { name: "a fast clock", spoil: clock("(t) => 30 * t") },
  { name: "a slow clock", spoil: clock("(t) => t / 5") },
  {
    name: "a date before its time",
    spoil:
      "{ const Now = Date; const shift = 4e11; window.Date = class extends Now { constructor(...given) { given.length ? super(...given) : super(Now.now() - shift); } static now() { return Now.now() - shift; } }; }",
  },
  // Habits
  { name: "few frames a second", spoil: "window.requestAnimationFrame = (run) => setTimeout(() => run(performance.now()), 300);" },
  {
    name: "a page that is hidden and shown",
    spoil:
      'setInterval(() => { for (const hidden of [true, false]) { Object.defineProperty(document, "hidden", { configurable: true, get: () => hidden }); document.dispatchEvent(new Event("visibilitychange")); } dispatchEvent(new Event("blur")); dispatchEvent(new Event("focus")); }, 400);',
  },
  {
    name: "a page that is brought back as it was",
    spoil: 'if (!sessionStorage.back) addEventListener("load", () => setTimeout(() => { sessionStorage.back = 1; dispatchEvent(new PageTransitionEvent("pageshow", { persisted: true })); }, 700));',
  },
  // Browsers without this and that
  {
    name: "a browser without newer functions",
    spoil: without(
      "window.BroadcastChannel",
      "crypto.subtle",
      "crypto.randomUUID",
      "Navigator.prototype.locks",
      "Navigator.prototype.clipboard",
      "Navigator.prototype.sendBeacon",
      "URL.canParse",
      "URL.parse",
      "window.structuredClone",
      "AbortSignal.timeout",
      "AbortSignal.any",
      "Array.prototype.at",
      "String.prototype.at",
      "Array.prototype.findLast",
      "Array.prototype.toSorted",
      "Array.fromAsync",
      "Object.groupBy",
      "Promise.withResolvers",
      "Set.prototype.union",
      "window.OffscreenCanvas",
      "window.requestIdleCallback",
      "window.scheduler",
      "window.visualViewport",
      "window.ResizeObserver",
      "window.IntersectionObserver",
      "window.WeakRef",
      "screen.orientation",
      "Performance.prototype.getEntriesByType",
      "Element.prototype.requestFullscreen",
      "Element.prototype.checkVisibility",
      "Iterator.prototype.map",
      "Intl.Segmenter",
      "window.CompressionStream",
      "window.PerformanceObserver",
      "performance.timeOrigin",
    ),
  },
  { name: "a browser without secure random numbers", spoil: without("window.crypto") },
  { name: "a browser before its time", spoil: without("Object.hasOwn"), says: /too old.*Safari 15\.4/is },
  { name: "a browser that fails where nobody waits", spoil: "Date.prototype.toISOString = undefined;", says: /something in this page went wrong.*another browser/is },
  {
    name: "a browser that decodes no pictures",
    spoil: "HTMLImageElement.prototype.decode = undefined; window.createImageBitmap = undefined;",
    says: /something in this page went wrong.*another browser/is,
  },
];
