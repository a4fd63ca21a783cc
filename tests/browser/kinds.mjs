// Takes studies of any kind of trial as people would, and looks at what stands on the screen.
// Argument (JSON): {base, shots, visits: [{name, study, viewport, dpr, input, …}]}, of each visit also
//   choices: [role, …], or targets: [pixels_sha256, …] with right: [whether to choose one of them, …];
//   shoot: the two-interval trial whose steps are screenshots; reload: [trials shown twice]; reload_after, offline: [trials answered so];
//   ask_early: the trial at which completion is asked for.
// Last line of output (JSON): per visit {name, code, trials: [{position, shown, again?, widths, choice}], log, early, said, complaints}.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { launch } from "./chromium.mjs";
import { withPixelsHash } from "./pixels.mjs";

const task = JSON.parse(process.argv[2]);
mkdirSync(task.shots, { recursive: true });
const browser = await launch();
const visits = [];
try {
  for (const visit of task.visits) visits.push(await take(visit));
} finally {
  await browser.close();
}
console.log(JSON.stringify(visits));

/** One participant from the welcome to the code. */
async function take({ name, study, viewport, dpr = 1, input, choices, targets, right, shoot, reload = [], reload_after = [], offline = [], ask_early }) {
  const touch = input === "touch";
  const context = await browser.newContext({ viewport, deviceScaleFactor: dpr, hasTouch: touch, isMobile: touch });
  const page = await context.newPage();
  const [trials, log, complaints] = [[], [], []];
  let token;
  page.on("console", (message) => message.type() === "error" && !message.text().includes("ERR_INTERNET_DISCONNECTED") && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => (token ??= request.headers().authorization));
  page.on("response", async (response) => {
    const { pathname } = new URL(response.url());
    if (pathname.startsWith("/api/v1/sessions/") && !pathname.includes("/stimuli/")) log.push({ method: response.request().method(), path: pathname, status: response.status() });
  });
  await page.addInitScript(withPixelsHash);
  await page.addInitScript(record);
  const shot = (label) => page.screenshot({ path: join(task.shots, `participant-${label}-${viewport.width}x${viewport.height}.png`) });
  await page.goto(`${task.base}/study/${study}?PROLIFIC_PID=${name}`);

  let early = null;
  let said = null;
  for (;;) {
    if (trials.length === shoot && trials.length > 0) await steps(page, shot);
    const hook = page
      .locator(`:is([data-testid="consent-agree"], [data-testid="start"], [data-testid="completion-code"], .trial:not([data-done]) [data-testid^="choice-"]):visible:not([aria-disabled])`)
      .first();
    await hook.waitFor({ timeout: 60_000 });
    const id = await hook.getAttribute("data-testid");
    if (id === "completion-code") {
      const code = (await hook.textContent()).trim();
      await context.close();
      return { name, code, trials, log, early, said, complaints };
    }
    if (!id.startsWith("choice-")) {
      // A second click of a double one is none: this button, and what follows it never, is pressed until the page goes on.
      const button = page.getByTestId(id);
      const gone = () =>
        button.waitFor({ state: "detached", timeout: 1000 }).then(
          () => true,
          () => false,
        );
      do await press(page, input, button, { timeout: 1000 }).catch(() => {});
      while (!(await gone()));
      continue;
    }
    const index = trials.length;
    const trial = await look(page);
    if (reload.includes(index)) {
      await page.reload();
      await hook.waitFor();
      trial.again = await look(page);
    }
    if (index === ask_early) early = await completion(log, token);
    trial.choice = choices?.[index] ?? Object.keys(trial.shown).find((role) => targets.includes(trial.shown[role]) === right[index]);
    if (offline.includes(index)) await context.setOffline(true);
    await page.locator(".trial").evaluate((element) => (element.dataset.done = ""));
    await choose(page, input, trial.choice, index);
    await pressed(page, input, trial.choice, `${name}, trial ${index}`);
    trials.push(trial);
    if (offline.includes(index)) {
      await page.getByText("No connection.").waitFor();
      await page.getByRole("heading", { name: "One moment" }).waitFor();
      said = await page.locator("#notice").textContent();
      await shot("offline");
      await context.setOffline(false);
    } else if (reload_after.includes(index)) await page.reload();
    await page.waitForFunction(() => document.querySelector(".trial[data-done]") === null);
  }
}

/** In the page: keeps a copy of what stands on the screen in each interval. */
function record() {
  const roles = { "First image": "first", "Second image": "second" };
  let last = "";
  globalThis.seen = {};
  const look = () => {
    const text = document.querySelector(".spoken")?.textContent ?? "";
    const canvas = document.querySelector(".intervals canvas");
    if (text === last) return;
    last = text;
    if (canvas === null || roles[text] === undefined) return;
    const copy = new OffscreenCanvas(canvas.width, canvas.height);
    copy.getContext("2d").drawImage(canvas, 0, 0);
    globalThis.seen[roles[text]] = { copy, width: canvas.getBoundingClientRect().width };
  };
  new MutationObserver(look).observe(document, { subtree: true, childList: true, characterData: true });
}

/** Where the trial stands, and of each role the pixels that were on the screen, by their hash, and how wide they stood in CSS px. */
async function look(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return page.evaluate(async () => {
    const sides = [...document.querySelectorAll(".pair .picture")].map((button) => {
      const image = button.firstElementChild;
      return [button.dataset.testid.slice(7), { source: image, size: [image.naturalWidth, image.naturalHeight], width: image.getBoundingClientRect().width }];
    });
    const intervals = Object.entries(globalThis.seen).map(([role, { copy, width }]) => [role, { source: copy, size: [copy.width, copy.height], width }]);
    const roles = sides.length > 0 ? sides : intervals;
    globalThis.seen = {};
    return {
      position: document.querySelector(".position").textContent,
      shown: Object.fromEntries(await Promise.all(roles.map(async ([role, { source, size }]) => [role, await globalThis.pixelsHash(source, ...size)]))),
      widths: Object.fromEntries(roles.map(([role, { width }]) => [role, width])),
    };
  });
}

/** Screenshots of each step of a two-interval trial, each taken while it lasted. */
async function steps(page, shot) {
  const spoken = (text) => page.waitForFunction((text) => document.querySelector(".spoken")?.textContent === text, text);
  await page.waitForFunction(() => / of /.test(document.querySelector(".position")?.textContent ?? ""));
  for (const [step, text] of [
    ["fixation", ""],
    ["first", "First image"],
    ["mask", ""],
    ["second", "Second image"],
    ["response", "Please choose: first or second"],
  ]) {
    await spoken(text);
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    await shot(`two-interval-${step}`);
    if ((await page.locator(".spoken").textContent()) !== text) throw new Error(`the screenshot of ${step} came too late`);
  }
}

/** Answers a trial. */
async function choose(page, input, role, index) {
  const keys = { left: ["ArrowLeft"], right: ["ArrowRight"], first: ["1", "ArrowLeft"], second: ["2", "ArrowRight"] }[role];
  if (input === "keyboard") return page.keyboard.press(keys[index % keys.length]);
  return press(page, input, page.getByTestId(`choice-${role}`));
}

/** Presses again, as people do, where a press did nothing within seconds; says what stood there. */
async function pressed(page, input, role, where) {
  const button = page.locator(".trial[data-done]").getByTestId(`choice-${role}`);
  for (;;) {
    const gone = await button.waitFor({ state: "detached", timeout: 5000 }).then(
      () => true,
      () => false,
    );
    if (gone || input === "keyboard") return;
    const stands = await button.evaluate((b) => [b.outerHTML.slice(0, 300), JSON.stringify(b.getBoundingClientRect())]).catch(String);
    console.error(`${where}: a press (${input}) did nothing: ${stands}`);
    await press(page, input, button, { timeout: 1000 }).catch(() => {});
  }
}

/** Presses a button. */
async function press(page, input, button, patience = {}) {
  if (input === "keyboard") return button.press("Enter", patience);
  if (input === "touch") return button.tap(patience);
  if (input === "mouse") return button.click(patience);
  // A pen: what its driver would tell Chromium.
  await button.scrollIntoViewIfNeeded(patience);
  const box = await button.boundingBox(patience);
  const session = await page.context().newCDPSession(page);
  const at = { x: box.x + box.width / 2, y: box.y + box.height / 2, button: "left", clickCount: 1, pointerType: "pen" };
  for (const type of ["mousePressed", "mouseReleased"]) await session.send("Input.dispatchMouseEvent", { type, ...at });
  await session.detach();
}

/** Asks for the completion code past the page. */
async function completion(log, token) {
  const session = log.map(({ path }) => path.match(/^\/api\/v1\/sessions\/[^/]+/)[0])[0];
  const answer = await fetch(`${task.base}${session}/completion`, { method: "POST", headers: { authorization: token } });
  const { code, more, completion_code } = await answer.json();
  return { status: answer.status, code, more, completion_code };
}
