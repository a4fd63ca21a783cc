// Takes a study as people would: real clicks, taps and keys in Chromium.
// Argument (JSON): {base, study, shots, participants: [{name, viewport, deviceScaleFactor, touch, input, choices, reloadAfter}]}.
// Last line of output (JSON): per participant {name, code, trials: [{choice, left, right}], console: [...]}; left and right are hashes of pixels.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { launch } from "./chromium.mjs";
import { withPixelsHash } from "./pixels.mjs";

const task = JSON.parse(process.argv[2]);
mkdirSync(task.shots, { recursive: true });
const browser = await launch();
const answers = [];
try {
  for (const participant of task.participants) answers.push(await take(participant));
} finally {
  await browser.close();
}
console.log(JSON.stringify(answers));

/** One participant from the welcome to the code. */
async function take({ name, viewport, deviceScaleFactor = 1, touch, input, choices, reloadAfter }) {
  const context = await browser.newContext({ viewport, deviceScaleFactor, hasTouch: touch, isMobile: touch });
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.addInitScript(withPixelsHash);
  const trials = [];
  const shot = async (label) => {
    const file = join(task.shots, `participant-${label}-${viewport.width}x${viewport.height}.png`);
    await page.screenshot({ path: file });
  };
  const press = (locator) => (input === "keyboard" ? locator.press("Enter") : input === "touch" ? locator.tap() : locator.click());

  await page.goto(`${task.base}/study/${task.study}?PROLIFIC_PID=${name}`);
  let code;
  for (let steps = 0; code === undefined; steps += 1) {
    if (steps > 200) throw new Error(`${name}: no completion code after 200 steps`);
    const state = await current(page);
    if (state === "choice-left") {
      // The page must fit: nothing to scroll sideways.
      const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
      if (overflow > 0) throw new Error(`${name}: the trial page scrolls sideways by ${overflow} px`);
      const [left, right] = await Promise.all(["choice-left", "choice-right"].map((id) => shown(page, id)));
      const told = await sides(page);
      await shot(`trial-${trials.length + 1}`);
      const choice = choices[trials.length];
      trials.push({ choice, left, right });
      // What is offered counts: once is enough.
      if (input === "keyboard") await page.keyboard.press(choice === "left" ? "ArrowLeft" : "ArrowRight");
      else await press(page.getByTestId(`choice-${choice}`));
      await page.waitForFunction(([l, r]) => {
        const shown = document.querySelector('[data-testid="choice-left"]');
        return !shown || shown.dataset.sha256 !== l || document.querySelector('[data-testid="choice-right"]')?.dataset.sha256 !== r;
      }, told);
      if (trials.length === reloadAfter) await page.reload();
    } else if (state === "completion-code") {
      await shot("thanks");
      code = (await page.getByTestId("completion-code").textContent()).trim();
    } else {
      await shot({ "consent-agree": "welcome", start: "instructions" }[state]);
      const button = page.getByTestId(state);
      await press(button);
      await button.waitFor({ state: "detached" });
    }
  }
  await context.close();
  return { name, code, trials, complaints };
}

/** The hash of the pixels of the picture on a button: of a still, or of whichever frame is shown. */
function shown(page, id) {
  return page.getByTestId(id).evaluate((button) => {
    const picture = button.firstElementChild;
    return globalThis.pixelsHash(picture, picture.naturalWidth ?? picture.width, picture.naturalHeight ?? picture.height);
  });
}

/** What the page was told of the two: the hashes of the bytes that it got. */
function sides(page) {
  return Promise.all(["choice-left", "choice-right"].map((id) => page.getByTestId(id).getAttribute("data-sha256")));
}

/** The test hook of the screen that is shown now. */
async function current(page) {
  const hooks = ["consent-agree", "start", "choice-left", "completion-code"];
  // What is pressed before it counts is ignored.
  const shown = page.locator(hooks.map((hook) => `[data-testid="${hook}"]:visible:not([aria-disabled])`).join(","));
  await shown.first().waitFor({ timeout: 60_000 });
  return shown.first().getAttribute("data-testid");
}
