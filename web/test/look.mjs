// Screenshots of every page at desktop and phone size, from the mock server: `node --import ./test/typescript.mjs test/look.mjs DIST OUT [participant|interval|console]`.
import { mkdir } from "node:fs/promises";
import { join } from "node:path";
import { launch, sizes } from "./browser/chromium.mjs";
import { results, versions } from "./mock-results.ts";
import { startMock } from "./mock-server.ts";
import { intervals, material, study } from "./mock-study.ts";

const [dist, out, only] = process.argv.slice(2);
await mkdir(out, { recursive: true });
const browser = await launch();

async function participant(name, options) {
  const mock = await startMock({ dist });
  const context = await browser.newContext(options);
  const page = await context.newPage();
  const shot = (step) => page.screenshot({ path: join(out, `participant-${step}-${name}.png`) });
  page.on("pageerror", (error) => console.log("page error:", error.message));
  page.on("console", (m) => m.type() === "error" && console.log("console:", m.text()));
  await page.goto(`${mock.url}/study/${study.id}`);
  const hook = (id) => page.getByTestId(id);
  await hook("consent-agree").waitFor();
  await shot("1-consent");
  await page.screenshot({ path: join(out, `participant-1-consent-full-${name}.png`), fullPage: true });
  await hook("consent-agree").click();
  await hook("start").waitFor();
  await shot("2-instructions");
  await hook("start").click();
  for (let i = 0; i < 5; i++) {
    await page.getByText(`${i + 1} of 5`).waitFor();
    await hook("choice-left").waitFor({ state: "visible" });
    if (i === 0 || i === 4) await shot(`3-trial-${i + 1}`);
    if (i === 0) {
      const box = await hook("choice-left").boundingBox();
      await page.mouse.move(box.x + 50, box.y + 50);
      await shot("3-trial-hover");
    }
    if (i === 4) await page.waitForTimeout(1500);
    const click = name === "desktop" && i % 2 ? page.keyboard.press("ArrowRight") : hook("choice-left").click();
    await click;
    if (i === 1) await shot("3-trial-chosen");
  }
  await hook("completion-code").waitFor();
  await shot("4-thanks");
  const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  if (wide) console.log(name, "scrolls sideways");
  console.log(name, mock.log.filter((l) => l.method === "PUT").at(-1).text);
  await context.close();
  await mock.close();
}

async function interval(name, options) {
  const stuff = intervals({ stills: 1, settings: { fixation_ms: 2500, first_ms: 2500, mask_ms: 2500, second_ms: 2500 } });
  const mock = await startMock({ dist, stuff, grow: { start: 1, most: 43 } });
  const context = await browser.newContext(options);
  const page = await context.newPage();
  const shot = (step) => page.screenshot({ path: join(out, `interval-${step}-${name}.png`) });
  await page.goto(`${mock.url}/study/${study.id}`);
  await page.getByTestId("consent-agree").click();
  await page.getByTestId("start").waitFor();
  await shot("1-instructions");
  await page.getByTestId("start").click();
  await page.locator("canvas").waitFor();
  for (const step of ["2-fixation", "3-first", "4-mask", "5-second"]) {
    await page.waitForTimeout(step === "2-fixation" ? 1200 : 2500);
    await shot(step);
  }
  const first = page.getByTestId("choice-first");
  await first.waitFor({ state: "visible" });
  await shot("6-response");
  await page.keyboard.press("Tab");
  await shot("6-response-focus");
  await first.click();
  await page.waitForTimeout(60);
  await shot("7-chosen");
  await context.close();
  await mock.close();
}

async function console_(name, options, scheme) {
  const stuff = material();
  const mock = await startMock({ dist, stuff, results: results(stuff) });
  const context = await browser.newContext({ ...options, colorScheme: scheme });
  const page = await context.newPage();
  const shot = (step, full = false) => page.screenshot({ path: join(out, `console-${step}-${name}-${scheme}.png`), fullPage: full });
  page.on("pageerror", (error) => console.log("page error:", error.message));
  page.on("console", (m) => m.type() === "error" && console.log("console:", m.text()));
  await page.goto(`${mock.url}/console`);
  await page.getByTestId("login-password").waitFor();
  await shot("1-login");
  await page.getByTestId("login-password").fill("wrong");
  await page.getByTestId("login-submit").click();
  await page.getByText("not the password").waitFor();
  await shot("1-login-wrong");
  await page.getByTestId("login-password").fill("wayang");
  await page.getByTestId("login-submit").click();
  await page.getByRole("heading", { name: "Studies" }).waitFor();
  await shot("2-studies");
  const pooled = `${study.id}?version=${versions.before.slice(0, 12)}&with=${versions.current.slice(0, 12)},${versions.pilot.slice(0, 12)}`;
  for (const [label, id] of [
    [study.id, study.id],
    ["empty", "empty"],
    ["pooled", pooled],
  ]) {
    await page.goto(`${mock.url}/console/studies/${id}`);
    await page.locator(".report h2").first().waitFor();
    await page.waitForTimeout(1000);
    await shot(`3-study-${label}`, true);
    if (label === "pooled") await shot("4-pooled-top");
    if (await page.evaluate(() => document.documentElement.scrollWidth > innerWidth)) console.log(name, id, "scrolls sideways");
  }
  await context.close();
  await mock.close();
}

for (const [name, options] of Object.entries(sizes)) {
  if (only === undefined || only === "participant") await participant(name, options);
  if (only === undefined || only === "interval") await interval(name, options);
  if (only === undefined || only === "console") for (const scheme of ["light", "dark"]) await console_(name, { ...options, deviceScaleFactor: 1 }, scheme);
}
await browser.close();
