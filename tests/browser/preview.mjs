// Looks at a study as a preview: from a link to the end, and begins again.
// Argument (JSON): {url}. Last line of output (JSON): {ribbon, code, kept, complaints}.
import { launch } from "./chromium.mjs";

const task = JSON.parse(process.argv[2]);
const browser = await launch();
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  const complaints = [];
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.goto(task.url);
  const hooks = ["consent-agree", "start", "choice-left", "completion-code"];
  const ready = page.locator(hooks.map((hook) => `[data-testid="${hook}"]:visible:not([aria-disabled])`).join(","));
  const ribbon = await page.getByTestId("ribbon").textContent();
  for (let steps = 0; steps < 200; steps += 1) {
    await ready.first().waitFor({ timeout: 60_000 });
    const hook = await ready.first().getAttribute("data-testid");
    if (hook === "completion-code") break;
    // What comes too early is ignored: it is pressed until something else is shown.
    await ready.first().click();
    await page.waitForTimeout(800);
  }
  const code = (await page.getByTestId("completion-code").textContent()).trim();
  await page.getByTestId("ribbon").getByRole("button").click();
  await page.getByTestId("consent-agree").waitFor();
  // When the last input counted is no answer.
  const kept = await page.evaluate(() => [...Object.keys(localStorage), ...Object.keys(sessionStorage)].filter((key) => key.startsWith("kelir:") && key !== "kelir:counted"));
  console.log(JSON.stringify({ ribbon, code, kept, complaints }));
} finally {
  await browser.close();
}
