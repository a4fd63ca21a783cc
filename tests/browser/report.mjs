// Looks at a report's file in a browser without a network, at desktop and phone size, in light and dark, and on paper.
// Argument (JSON): {file, shots}. Last line of output (JSON): {pages: [{width, overflow, letters}], wider, dark, light, requests, complaints}.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { launch } from "./chromium.mjs";

const task = JSON.parse(process.argv[2]);
mkdirSync(task.shots, { recursive: true });
const browser = await launch();
const complaints = [];
const requests = [];
let answer;
try {
  const context = await browser.newContext({ offline: true, javaScriptEnabled: true });
  const page = await context.newPage();
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  page.on("request", (request) => requests.push(request.url()));
  await page.goto(pathToFileURL(task.file).href);
  // How far anything sticks out to the right, and the smallest letters of a figure, in px as shown.
  const overflow = () => page.evaluate(() => Math.max(...[...document.querySelectorAll("body *")].map((e) => e.getBoundingClientRect().right)) - document.documentElement.clientWidth);
  const letters = () => page.evaluate(() => Math.min(...[...document.querySelectorAll("figure svg")].map((svg) => 13 * (svg.getBoundingClientRect().width / svg.viewBox.baseVal.width))));
  const pages = [];
  for (const [width, height] of [
    [1280, 800],
    [390, 844],
  ]) {
    await page.setViewportSize({ width, height });
    pages.push({ width, overflow: await overflow(), letters: await letters() });
    await page.screenshot({ path: join(task.shots, `report-${width}x${height}.png`), fullPage: true });
  }
  // The top down to the end of the first figure.
  await page.setViewportSize({ width: 900, height: 800 });
  const height = await page.evaluate(() => Math.ceil(document.querySelector("figure").getBoundingClientRect().bottom) + 24);
  await page.screenshot({ path: join(task.shots, "report-top.png"), fullPage: true, clip: { x: 0, y: 0, width: 900, height } });
  const ground = () => page.evaluate(() => [getComputedStyle(document.documentElement).backgroundColor, getComputedStyle(document.querySelector("figure svg > rect")).fill]);
  const light = await ground();
  await page.emulateMedia({ colorScheme: "dark" });
  const dark = await ground();
  await page.screenshot({ path: join(task.shots, "report-dark.png") });
  await page.emulateMedia({ colorScheme: "light", media: "print" });
  await page.pdf({ path: join(task.shots, "report.pdf"), format: "A4" });
  // Control: something that is too wide is seen.
  await page.evaluate(() => document.body.insertAdjacentHTML("beforeend", "<div style='width: 3000px'>.</div>"));
  answer = { pages, wider: await overflow(), light, dark, requests, complaints };
} finally {
  await browser.close();
}
console.log(JSON.stringify(answer));
