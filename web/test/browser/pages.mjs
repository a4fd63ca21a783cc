// Every page of the participant and of the console, one after the other, for tests that look at each.
import { versions } from "../mock-results.ts";
import { problem } from "../mock-server.ts";
import { intervals, material, study } from "../mock-study.ts";
import { painted } from "./visit.mjs";

const one = () => ({ ...material(), trials: material().trials.slice(0, 1) });

/** To the first pair, looked at on the way. */
async function trial(v, look = async () => undefined) {
  await v.hook("consent-agree").waitFor();
  await look("consent");
  await v.hook("consent-agree").click();
  await v.hook("start").waitFor();
  await look("instructions");
  await v.hook("start").click();
  await v.hook("choice-left").waitFor({ state: "visible" });
  await painted(v.page);
  await look("trial");
}

/** To the code of a study of one pair. */
async function through(v, look) {
  await trial(v, look);
  await v.hook("choice-left").click();
  await v.hook("completion-code").waitFor();
}

/** Participants' visits: what the server is, and where `look(name)` is called. */
export const visits = {
  "from consent to the panel's page": {
    query: "PROLIFIC_PID=5f2",
    stuff: one,
    async walk(v, look) {
      await through(v, look);
      await look("return");
    },
  },
  "one picture after the other, and a code to copy": {
    stuff: () => intervals({ stills: 1 }),
    async walk(v, look) {
      await v.hook("consent-agree").click();
      await v.hook("start").click();
      await v.hook("choice-first").waitFor({ state: "visible" });
      await painted(v.page);
      await look("response");
      await v.hook("choice-first").click();
      await v.hook("completion-code").waitFor();
      await look("code");
    },
  },
  "another tab has it": {
    stuff: one,
    async walk(v, look) {
      await v.hook("consent-agree").click();
      await v.hook("start").waitFor();
      const second = await v.context.newPage();
      await second.goto(v.url);
      await second.getByRole("button").first().waitFor();
      await look("elsewhere", second);
      await second.getByRole("button").first().click();
      await v.page.bringToFront();
      await v.page.locator('main:not(:has([data-testid="start"]))').waitFor();
      await look("moved");
    },
  },
  "somebody comes to a study that was begun": {
    stuff: one,
    async walk(v, look) {
      await v.hook("consent-agree").click();
      await v.hook("start").waitFor();
      await v.page.goto(v.url);
      await v.page.locator(".choices .action").last().waitFor();
      await look("welcome back");
    },
  },
  "a kiosk's end": {
    stuff: one,
    server: { perVisit: true },
    async walk(v, look) {
      await through(v);
      await look("for the next person");
    },
  },
  ...Object.fromEntries(
    ["preview", "pilot"].map((visitKind) => [
      `a ${visitKind}, with its ribbon`,
      {
        query: visitKind,
        stuff: one,
        server: { visitKind },
        async walk(v, look) {
          await through(v, look);
          await look("code");
        },
      },
    ]),
  ),
  "pictures on their way": {
    stuff: one,
    server: { fault: ({ path }) => (path.startsWith("/stimuli/") ? "stall" : null) },
    async walk(v, look) {
      await v.hook("consent-agree").click();
      await v.hook("start").click();
      await v.page.locator(".page [role=status]").waitFor();
      await look("progress");
    },
  },
  "no line when the page comes": {
    stuff: one,
    server: { fault: ({ path }) => (path.startsWith("/api/") ? "hang up" : null) },
    async walk(v, look) {
      await v.page.locator(".page h1").waitFor();
      await v.page.locator("#notice:not(:empty)").waitFor();
      await look("offline");
    },
  },
  "pictures that are still being made": {
    stuff: one,
    server: { fault: ({ path }) => (path.startsWith("/api/") ? { status: 503, body: problem(503, "not_ready", "Not yet.")[1] } : null) },
    async walk(v, look) {
      await v.page.locator(".page h1").waitFor();
      await v.page.locator("#notice:not(:empty)").waitFor();
      await look("not ready");
    },
  },
  "no line at the end": {
    stuff: one,
    server: { fault: ({ method }) => (method === "PUT" ? "hang up" : null) },
    async walk(v, look) {
      await trial(v);
      await v.hook("choice-left").click();
      await v.page.locator(".page h1").waitFor();
      await v.page.locator("#notice:not(:empty)").waitFor();
      await look("waiting to be stored");
    },
  },
  "an answer that is refused for good": {
    stuff: one,
    server: { fault: ({ method }) => (method === "PUT" ? { status: 422, body: problem(422, "invalid_field", "The answer has a fault.")[1] } : null) },
    async walk(v, look) {
      await trial(v);
      await v.page.locator(".trial").evaluate((element) => (element.dataset.done = ""));
      await v.hook("choice-left").click();
      await v.page.locator(".trial:not([data-done]) .pair.shown").waitFor();
      await look("once more");
      await v.hook("choice-left").click();
      await v.page.locator(".page .action").waitFor();
      await look("refused");
    },
  },
  "something went wrong": {
    stuff: one,
    server: { spoil: "HTMLImageElement.prototype.decode = undefined;" },
    async walk(v, look) {
      await v.hook("consent-agree").click();
      await v.hook("start").click();
      await v.page.locator(".page .action:not([data-testid])").waitFor();
      await look("stopped");
    },
  },
  "a session that the server has forgotten": {
    stuff: one,
    server: { fault: ({ method }) => (method === "PUT" ? { status: 401, body: problem(401, "unauthorized", "No.")[1] } : null) },
    async walk(v, look) {
      await trial(v);
      await v.hook("choice-left").click();
      await v.page.locator(".page .action").waitFor();
      await look("forgotten");
    },
  },
  "a browser before its time": {
    stuff: one,
    server: { spoil: "delete HTMLScriptElement.prototype.noModule;" },
    async walk(v, look) {
      await v.page.locator("#boot").waitFor();
      await look("too old");
    },
  },
  "a script that does not arrive": {
    stuff: one,
    server: { fault: ({ path }) => (/participant.*js$/.test(path) ? { status: 502, html: "Bad gateway" } : null) },
    async walk(v, look) {
      await v.page.locator("#boot").waitFor();
      await look("not loaded");
    },
  },
  "no such study": {
    stuff: one,
    async walk(v, look) {
      await v.page.goto(v.url.replace(study.id, "nowhere"));
      await v.page.locator("h1").waitFor();
      await look("no study");
    },
  },
};

/** The console's pages, before and after signing in. */
export async function consolePages(v, look) {
  const open = (path) => v.page.goto(`${v.mock.url}/console${path}`);
  await open("/studies");
  await v.hook("login-password").fill("wrong");
  await v.hook("login-submit").click();
  await v.page.locator(".problem:not(:empty)").waitFor();
  await look("sign in");
  await v.hook("login-password").fill("wayang");
  await v.hook("login-submit").click();
  await v.page.getByRole("heading", { name: "Studies" }).waitFor();
  await look("studies");
  await open(`/studies/${study.id}`);
  await v.page.getByRole("heading", { name: "How to cite" }).waitFor();
  await look("study");
  await open(`/studies/${study.id}?version=${versions.before.slice(0, 12)}&with=${versions.current.slice(0, 12)}`);
  await v.page.getByRole("heading", { name: "How to cite" }).waitFor();
  await look("versions pooled");
  await open("/studies/empty");
  await v.page.locator(".empty").first().waitFor();
  await look("empty study");
  await open("/studies/nowhere");
  await v.page.locator(".message").waitFor();
  await look("no such study");
  await open("/nowhere");
  await v.page.locator(".message").waitFor();
  await look("no such page");
}
