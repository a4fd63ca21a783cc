// What the browser tests share: a bundle built for them, a Chromium, the mock server, and a participant's steps.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before } from "node:test";
import { results } from "../mock-results.ts";
import { startMock } from "../mock-server.ts";
import { material, study } from "../mock-study.ts";
import { launch, sizes } from "./chromium.mjs";

const dist = mkdtempSync(join(tmpdir(), "kelir-web-"));
/** Where the bundle that the tests build is. */
export const bundle = dist;
let browser;
before(async () => {
  execFileSync("node", ["build.mjs", dist]);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  rmSync(dist, { recursive: true });
});

/** A mock server and a page on it; errors on the page, content-policy ones too, fail the test. */
export async function visit(t, { options = sizes.desktop, query = "", chromium = browser, stuff = material(), init, ...server } = {}) {
  const mock = await startMock({ dist, results: results(stuff), stuff, ...server });
  const context = await chromium.newContext(options);
  const page = await context.newPage();
  if (init !== undefined) await page.addInitScript(...init);
  const problems = [];
  page.on("pageerror", (error) => problems.push(error.message));
  page.on("console", (message) => message.type() === "error" && !/Failed to load resource/.test(message.text()) && problems.push(message.text()));
  t.after(async () => {
    await context.close();
    await mock.close();
    assert.deepEqual(problems, []);
  });
  const url = `${mock.url}/study/${study.id}${query}`;
  await page.goto(url, { waitUntil: "commit" });
  return { mock, context, page, problems, url, hook: (id) => page.getByTestId(id) };
}

/** Resolves when what is on the page has been painted: what is pressed earlier is no answer. */
export const painted = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** Waits for trial `i`, counted from 0. */
export async function position(page, i, of = "5") {
  await page.getByText(`${i + 1} of ${of}`, { exact: true }).waitFor();
  await painted(page);
}

/** From the first page to the first trial. */
export async function begin({ hook, page }, of = "5") {
  await hook("consent-agree").click();
  await hook("start").click();
  await position(page, 0, of);
}

/** Answers the trials `from` to `to`. */
export async function answer({ hook, page }, from, to, choice = "left", of = "5") {
  for (let i = from; i < to; i++) {
    await position(page, i, of);
    await hook(`choice-${choice}`).waitFor();
    await painted(page);
    await hook(`choice-${choice}`).click();
  }
}

/** Each session's choices by trial. */
export const stored = (mock) => [...mock.sessions.values()].map((s) => [...s.answers].map(([i, body]) => [i, JSON.parse(body).choice]));

/** The stored answers of the first session. */
export const rows = (mock) => [...[...mock.sessions.values()][0].answers.values()].map((body) => JSON.parse(body));
