// Every page of the participant and of the console, one after the other, for tests that look at each.
import { versions } from "../mock-results.ts";
import { intervals, material, study } from "../mock-study.ts";
import { painted } from "./visit.mjs";

const one = () => ({ ...material(), trials: material().trials.slice(0, 1) });

/** Participants' visits: what the server is, and where `look(name)` is called. */
export const visits = {
  "from consent to the panel's page": {
    query: "PROLIFIC_PID=5f2",
    stuff: one,
    async walk(v, look) {
      await v.hook("consent-agree").waitFor();
      await look("consent");
      await v.hook("consent-agree").click();
      await v.hook("start").waitFor();
      await look("instructions");
      await v.hook("start").click();
      await v.hook("choice-left").waitFor({ state: "visible" });
      await painted(v.page);
      await look("trial");
      await v.hook("choice-left").click();
      await v.hook("completion-code").waitFor();
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
  await v.hook("report-photographs").waitFor();
  await v.page.locator(".paper h2").waitFor();
  await look("study");
  await open(`/studies/${study.id}?version=${versions.before.slice(0, 12)}&with=${versions.current.slice(0, 12)}`);
  await v.hook("report-photographs").waitFor();
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
