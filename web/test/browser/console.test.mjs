// The researcher's page in a real browser against the mock server.
import assert from "node:assert/strict";
import { test } from "node:test";
import { results, versions } from "../mock-results.ts";
import { problem } from "../mock-server.ts";
import { material, study } from "../mock-study.ts";
import { visit } from "./visit.mjs";

test("sign in, the numbers in full precision, back works, sign out", async (t) => {
  const v = await visit(t);
  await v.page.goto(`${v.mock.url}/console/studies/${study.id}`);
  await v.hook("login-password").fill("wayang");
  await v.hook("login-submit").click();
  const row = v.hook("block-stills");
  assert.equal(await row.getAttribute("data-t"), "-1.4375905768565218");
  assert.equal(await row.getAttribute("data-p"), "0.16056941534857747");
  await v.page.getByRole("link", { name: "kelir" }).click();
  await v.page.getByRole("heading", { name: "Studies" }).waitFor();
  await v.page.goBack();
  await row.waitFor();
  await v.page.getByRole("button", { name: "Sign out" }).click();
  await v.hook("login-password").waitFor();
  await v.page.reload();
  await v.hook("login-password").waitFor();
});

test("the full report and the paper come with their exact numbers and described plots", async (t) => {
  const v = await visit(t);
  await v.page.goto(`${v.mock.url}/console/studies/${study.id}`);
  await v.hook("login-password").fill("wayang");
  await v.hook("login-submit").click();
  const block = v.hook("report-photographs");
  assert.equal(await block.getAttribute("data-p-holm"), "0.000611346");
  assert.equal(await block.getAttribute("data-g"), "0.726");
  assert.equal(await v.hook("paper-animation-mc").getAttribute("data-t"), "-3.98348229826");
  await v.page.getByText("No whole number of participants from 25 to 40 gives −3.293").waitFor();
  const described = await v.page
    .locator("svg.plot")
    .evaluateAll((all) => all.map((svg) => svg.querySelector("title")?.textContent !== "" && (svg.querySelector("desc")?.textContent ?? "").length > 20));
  assert.ok(described.length >= 4 && described.every(Boolean), JSON.stringify(described));
  // A study without the paper's name has no such section, and an empty one says what is to come.
  await v.page.goto(`${v.mock.url}/console/studies/empty`);
  await v.page.getByText("appear here with the first answers").waitFor();
  assert.equal(await v.hook("paper-animation-mc").count(), 0);
});

test("data never become markup", async (t) => {
  const evil = "<img src=x onerror=alert(1)>";
  const stuff = material();
  const hostile = (path, query) => {
    const [status, body] = results(stuff)(path, query) ?? [];
    return status ? [status, JSON.parse(JSON.stringify(body).replaceAll("Shadows on a screen", evil).replaceAll('"Stills"', JSON.stringify(evil)))] : null;
  };
  const v = await visit(t, { stuff, results: hostile });
  await v.page.goto(`${v.mock.url}/console`);
  await v.hook("login-password").fill("wayang");
  await v.hook("login-submit").click();
  await v.page.getByText(evil).first().click();
  await v.hook("block-stills").waitFor();
  assert.equal(await v.page.locator("img[src=x]").count(), 0);
  assert.ok((await v.page.getByText(evil).count()) >= 2);
});

const [current, before, pilot] = [versions.current, versions.before, versions.pilot].map((hash) => hash.slice(0, 12));

/** Signs in on a page of the study. */
async function open(v, query = "") {
  await v.page.goto(`${v.mock.url}/console/studies/${study.id}${query}`);
  await v.hook("login-password").fill("wayang");
  await v.hook("login-submit").click();
  await v.page.getByRole("heading", { name: study.title }).waitFor();
}

const completed = (v) => v.hook("participants-completed").locator("data").getAttribute("value");
const links = (v) => v.page.locator("a[download]").evaluateAll((all) => all.map((a) => a.getAttribute("href")));

test("every page of a list is read", async (t) => {
  const v = await visit(t);
  await v.page.goto(`${v.mock.url}/console/studies`);
  await v.hook("login-password").fill("wayang");
  await v.hook("login-submit").click();
  await v.page.getByRole("link", { name: "A study that nobody has taken" }).waitFor();
  assert.equal(await v.page.locator("tbody tr").count(), 2);
});

test("the current version is what one sees first, with all versions and their counts", async (t) => {
  const v = await visit(t);
  await open(v);
  assert.equal(await completed(v), "32");
  assert.equal(await v.hook("pooled").count(), 0);
  const cells = await v.hook(`version-${before}`).locator("td").allTextContents();
  assert.deepEqual(cells.slice(1), ["18", "21", "93", "10", "2026-03-04 to 2026-04-03"]);
  assert.match((await v.hook(`version-${current}`).textContent()) ?? "", /current/);
  await v.page.getByText("25 sessions of other versions of this study are stored too and left out here.").waitFor();
  for (const href of await links(v)) assert.match(href, new RegExp(`/studies/${study.id}/versions/${versions.current}/`));
});

test("by keyboard: another version, one pooled with it; the address keeps it, links follow, back goes back", async (t) => {
  const v = await visit(t);
  await open(v);
  await v.page.getByRole("radio", { name: `${current} current` }).focus();
  await v.page.keyboard.press("ArrowDown");
  const [own, other] = [before, pilot].map((version) => v.page.getByRole("checkbox", { name: `Pool the answers of version ${version}` }));
  assert.equal(await own.isDisabled(), true, "a version is not pooled with itself");
  await other.focus();
  await v.page.keyboard.press("Space");
  assert.equal(new URL(v.page.url()).search, "", "nothing happens before it is asked for");
  await v.page.getByRole("button", { name: "Show these answers" }).focus();
  await v.page.keyboard.press("Enter");
  const banner = v.hook("pooled");
  await banner.waitFor();
  assert.equal(new URL(v.page.url()).search, `?version=${before}&with=${pilot}`);
  const said = (await banner.textContent()) ?? "";
  for (const part of [`${before}: 21 participants, 93 answers`, `${pilot}: 4 participants, 16 answers`, `stills-1, mc: other pixels in ${pilot}`]) assert.ok(said.includes(part), said);
  assert.equal(await completed(v), "21");
  assert.equal(await v.page.getByText("not the same in all pooled versions").count(), 1);
  const hrefs = await links(v);
  assert.equal(hrefs.length, 10);
  for (const href of hrefs) assert.ok(href.includes(`/versions/${versions.before}/`) && href.endsWith(`?with=${versions.pilot}`), href);
  await v.hook("report-stills").waitFor();
  assert.ok(
    v.mock.log.some((call) => call.path.endsWith(`/versions/${versions.before}/report`) && call.query === `?with=${versions.pilot}`),
    "the report is of the same answers",
  );

  await v.page.reload();
  await banner.waitFor();
  assert.equal(await completed(v), "21");
  assert.equal(await other.isChecked(), true);
  await v.page.goBack();
  await banner.waitFor({ state: "detached" });
  assert.equal(await completed(v), "32");
});

test("versions that showed the same are said to; an old one alone is said to be old", async (t) => {
  const v = await visit(t);
  await open(v, `?with=${before}`);
  await v.page.getByText("All of them showed the same stimuli.").waitFor();
  await v.page.goto(`${v.mock.url}/console/studies/${study.id}?version=${before}`);
  await v.page.getByText("which is not the current one").waitFor();
  await v.page.goto(`${v.mock.url}/console/studies/${study.id}?version=00000000`);
  await v.page.getByText("There is no such version of this study").waitFor();
  await v.page.getByRole("link", { name: "The current version" }).click();
  await v.hook("block-stills").waitFor();
  assert.equal(await completed(v), "32");
});

test("new answers change the counts and not what somebody is just choosing", async (t) => {
  const stuff = material();
  let late = 0;
  const growing = (path, query) => {
    const [status, body] = results(stuff)(path, query) ?? [];
    if (status && path.endsWith("/versions")) return [status, { ...body, items: body.items.map((item) => ({ ...item, answers: item.answers + late })) }];
    return status ? [status, body] : null;
  };
  const v = await visit(t, { stuff, results: growing });
  await open(v);
  await v.page.getByRole("radio", { name: pilot }).check();
  await v.page.getByRole("checkbox", { name: `Pool the answers of version ${before}` }).check();
  late = 7;
  await v.page.evaluate(() => document.dispatchEvent(new Event("visibilitychange")));
  await v.hook(`version-${before}`).getByText("100", { exact: true }).waitFor();
  assert.equal(await v.page.getByRole("radio", { name: pilot }).isChecked(), true);
  assert.equal(await v.page.getByRole("checkbox", { name: `Pool the answers of version ${before}` }).evaluate((box) => box.checked && box === document.activeElement), true);
});

test("a study whose first version is still being made has a page", async (t) => {
  const stuff = material();
  const unborn = (path, query) => {
    if (path === "/api/v1/studies/empty/versions") return [200, { items: [], next_cursor: null }];
    if (path.startsWith("/api/v1/studies/empty/versions/")) return problem(404, "not_found", "There is no such version.");
    return results(stuff)(path, query);
  };
  const v = await visit(t, { stuff, results: unborn });
  await v.page.goto(`${v.mock.url}/console/studies/empty`);
  await v.hook("login-password").fill("wayang");
  await v.hook("login-submit").click();
  await v.page.getByRole("heading", { name: "A study that nobody has taken" }).waitFor();
  await v.page.getByText("The stimuli are being made: 3 of 10 ready.").waitFor();
  await v.page.getByText("0 began.").first().waitFor();
});
