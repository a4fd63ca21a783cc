// The researcher's page in a real browser against the mock server.
import assert from "node:assert/strict";
import { test } from "node:test";
import { results } from "../mock-results.ts";
import { study } from "../mock-study.ts";
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
  const described = await v.page.locator("svg.plot").evaluateAll((all) => all.map((svg) => svg.querySelector("title")?.textContent !== "" && (svg.querySelector("desc")?.textContent ?? "").length > 20));
  assert.ok(described.length >= 4 && described.every(Boolean), JSON.stringify(described));
  // A study without the paper's name has no such section, and an empty one says what is to come.
  await v.page.goto(`${v.mock.url}/console/studies/empty`);
  await v.page.getByText("appear here with the first answers").waitFor();
  assert.equal(await v.hook("paper-animation-mc").count(), 0);
});

test("data never become markup", async (t) => {
  const evil = "<img src=x onerror=alert(1)>";
  const hostile = (path, sessions, stuff) => {
    const [status, body] = results(path, sessions, stuff) ?? [];
    return status ? [status, JSON.parse(JSON.stringify(body).replaceAll("Shadows on a screen", evil).replaceAll('"Stills"', JSON.stringify(evil)))] : null;
  };
  const v = await visit(t, { results: hostile });
  await v.page.goto(`${v.mock.url}/console`);
  await v.hook("login-password").fill("wayang");
  await v.hook("login-submit").click();
  await v.page.getByText(evil).first().click();
  await v.hook("block-stills").waitFor();
  assert.equal(await v.page.locator("img[src=x]").count(), 0);
  assert.ok((await v.page.getByText(evil).count()) >= 2);
});
