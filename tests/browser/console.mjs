// Reads the researcher's console as a person would: signs in, opens the study, reads the table.
// Argument (JSON): {base, study, shots, password}. Last line of output (JSON): {refused, blocks: {<id>: {t, p, text}}, complaints}.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { launch } from "./chromium.mjs";

const task = JSON.parse(process.argv[2]);
mkdirSync(task.shots, { recursive: true });
const browser = await launch();
const complaints = [];
let answer;
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  page.on("pageerror", (error) => complaints.push(String(error)));
  const shot = async (label) => {
    for (const [width, height] of [
      [1280, 800],
      [390, 844],
    ]) {
      await page.setViewportSize({ width, height });
      await page.screenshot({ path: join(task.shots, `console-${label}-${width}x${height}.png`), fullPage: true });
    }
    await page.setViewportSize({ width: 1280, height: 800 });
  };
  await page.goto(`${task.base}/console`);
  await page.getByTestId("login-password").fill("not the password");
  await page.getByTestId("login-submit").click();
  const alert = page.getByRole("alert").filter({ hasText: /\S/ });
  await alert.first().waitFor();
  const refused = (await alert.first().textContent()).trim();
  await shot("login");
  await page.getByTestId("login-password").fill(task.password);
  await page.getByTestId("login-submit").click();
  await page.getByTestId("login-password").waitFor({ state: "detached" });
  await page.goto(`${task.base}/console/studies`);
  await page
    .getByRole("link", { name: /puppets|screen/i })
    .first()
    .waitFor();
  await shot("studies");
  await page.goto(`${task.base}/console/studies/${task.study}`);
  const rows = page.locator('[data-testid^="block-"]');
  await rows.first().waitFor();
  await shot("study");
  const blocks = {};
  for (const row of await rows.all()) {
    const id = (await row.getAttribute("data-testid")).slice("block-".length);
    blocks[id] = { t: await row.getAttribute("data-t"), p: await row.getAttribute("data-p"), text: await row.innerText() };
  }
  answer = { refused, blocks, complaints };
} finally {
  await browser.close();
}
console.log(JSON.stringify(answer));
