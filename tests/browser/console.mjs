// Reads the researcher's console as a person would: signs in, opens the study, reads the report.
// Argument (JSON): {base, study, shots, password}. Last line of output (JSON): {refused, blocks: {<title>: exact t}, missing, control, complaints}:
// `missing` is what of the server's document is not on the page, `control` the same of a document with one section more.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { missing } from "../../web/test/browser/laid-out.mjs";
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
  const rows = page.locator("#report-who-preferred-what tbody tr");
  await rows.first().waitFor();
  await shot("study");
  const blocks = Object.fromEntries(await rows.evaluateAll((all) => all.map((row) => [row.cells[0].firstChild.textContent, row.cells[6].querySelector("data")?.value ?? null])));
  const written = await page.evaluate(async (study) => (await fetch(`/api/v1/studies/${study}/versions/current/document`)).json(), task.study);
  const extra = { ...written, sections: [...written.sections, { title: "One more", pieces: [], reference: false }] };
  answer = { refused, blocks, missing: await page.evaluate(missing, written), control: await page.evaluate(missing, extra), complaints };
} finally {
  await browser.close();
}
console.log(JSON.stringify(answer));
