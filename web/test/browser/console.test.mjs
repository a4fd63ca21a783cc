// The researcher's page in a real browser against the mock server.
import assert from "node:assert/strict";
import { test } from "node:test";
import { results, versions, written } from "../mock-results.ts";
import { problem } from "../mock-server.ts";
import { material, study } from "../mock-study.ts";
import { missing } from "./laid-out.mjs";
import { visit } from "./visit.mjs";

test("sign in, the numbers in full precision, back works, sign out", async (t) => {
  const v = await visit(t);
  await v.page.goto(`${v.mock.url}/console/studies/${study.id}`);
  await v.hook("login-password").fill("wayang");
  await v.hook("login-submit").click();
  // R 4.2.2: t.test(rep(0:2, c(12, 14, 6)), mu = 1).
  const row = v.page.locator("#report-who-preferred-what tbody tr").first();
  const [t_, p] = await Promise.all(["−1.438", "0.1606"].map((shown) => row.getByText(shown).first().getAttribute("value")));
  assert.ok(Math.abs(Number(t_) / -1.4375905768565216 - 1) < 1e-12 && Math.abs(Number(p) / 0.16056863389412473 - 1) < 1e-12, `${t_} ${p}`);
  await v.page.getByRole("link", { name: "kelir" }).click();
  await v.page.getByRole("heading", { name: "Studies" }).waitFor();
  await v.page.goBack();
  await row.waitFor();
  await v.page.goto(`${v.mock.url}/console/studies/empty`);
  await v.page.locator("#report-in-short").getByText("0 began.").waitFor();
  await v.page.getByRole("button", { name: "Sign out" }).click();
  await v.hook("login-password").waitFor();
  await v.page.reload();
  await v.hook("login-password").waitFor();
});

test("every heading, sentence, cell and figure of the document is on the page, each number with its exact value", async (t) => {
  const v = await visit(t);
  await open(v);
  await v.page.getByRole("heading", { name: "How to cite" }).waitFor();
  assert.deepEqual(await v.page.evaluate(missing, written), []);
  // Controls: one number less, another word, a figure without a mark are each found.
  const spoilt = (spoil) => {
    const other = structuredClone(written);
    spoil(other.sections);
    return v.page.evaluate(missing, other);
  };
  const cellsOf = (sections) => sections.flatMap(({ pieces }) => pieces).find(({ kind }) => kind === "table").content.rows[0].content;
  const found = [
    await spoilt((sections) => (cellsOf(sections)[2].exact = "33")),
    await spoilt((sections) => (cellsOf(sections)[3].shown = "0.8126")),
    await spoilt((sections) => sections[0].pieces.push({ kind: "warning", content: "Beware." })),
    await spoilt((sections) => {
      const figure = sections.flatMap(({ pieces }) => pieces).find(({ kind }) => kind === "figure").content;
      figure.svg = figure.svg.replace("</svg>", "<circle/></svg>");
    }),
  ].map((sentences) => sentences.map((sentence) => sentence.split(": ")[1]));
  assert.deepEqual(found, [["exact values"], ["cells"], ["sentences"], ["marks of a figure"]]);
});

test("a number, a table and the methods are copied as they are", async (t) => {
  const v = await visit(t);
  await v.context.grantPermissions(["clipboard-read", "clipboard-write"]);
  await open(v);
  const copied = () => v.page.evaluate(() => navigator.clipboard.readText());
  const section = v.page.locator("#report-who-preferred-what");
  const t_ = section.getByText("−1.438").first();
  await t_.click();
  await v.page.getByText("−1.438").and(v.page.locator("[data-copied=copied]")).waitFor();
  assert.equal(await copied(), await t_.getAttribute("value"));
  await section.getByRole("button", { name: "Copy the table" }).click();
  await section.locator("button[data-copied=copied]").waitFor();
  const lines = (await copied()).split("\n").map((line) => line.split("\t"));
  assert.deepEqual([lines[0]?.slice(0, 4), lines[1]?.[2], lines.length], [["block", "counted", "n", "mean"], "32", 4]);
  assert.equal(lines[1]?.[6], await t_.getAttribute("value"));
  await v.page.locator("#report-methods").getByRole("button", { name: "Copy the text" }).click();
  await v.page.locator("#report-methods button[data-copied=copied]").waitFor();
  assert.match(await copied(), /with the seed \d+ for resampling/);
});

test("of a changed report only the parts that changed are drawn again, and it is asked for once at a time", async (t) => {
  const stuff = material();
  let late = 0;
  const growing = (path, query) => {
    const [status, body] = results(stuff)(path, query) ?? [];
    if (path.endsWith("/results")) return [status, { ...body, participants: { ...body.participants, completed: body.participants.completed + late } }];
    if (!path.endsWith("/document")) return status ? [status, body] : null;
    const [first, ...rest] = body.sections;
    return [200, { ...body, sections: late === 0 ? body.sections : [{ ...first, pieces: [{ kind: "text", content: `${late} more` }] }, ...rest.slice(0, -1)] }];
  };
  const v = await visit(t, { stuff, results: growing });
  await open(v);
  await v.page.getByRole("heading", { name: "How to cite" }).waitFor();
  await v.page.evaluate(() => (window.kept = [...document.querySelectorAll(".report section")]));
  const asked = () => v.mock.log.filter(({ path }) => path.endsWith("/document")).length;
  const look = () => v.page.evaluate(() => document.dispatchEvent(new Event("visibilitychange")));
  await look();
  await v.page.waitForTimeout(300);
  assert.equal(asked(), 1, "nothing has changed");
  late = 7;
  await look();
  await v.page.getByText("7 more").waitFor();
  assert.equal(asked(), 2);
  assert.deepEqual(await v.page.evaluate(() => [...document.querySelectorAll(".report section")].map((section) => window.kept.indexOf(section))), [...Array(written.sections.length).keys()]);
  assert.equal(await v.page.getByRole("heading", { name: "How to cite" }).count(), 0, "what the report has no more is gone");
  assert.equal(await v.page.getByRole("navigation", { name: "On this page" }).getByText("How to cite").count(), 0);
});

test("the parts of the page have addresses; going to one loads nothing anew", async (t) => {
  const v = await visit(t);
  await open(v);
  const seen = (id) => v.page.locator(`#${id}`).evaluate((section) => Math.abs(section.getBoundingClientRect().top) < 60);
  assert.equal(await seen("report-methods"), false);
  await v.page.getByRole("navigation", { name: "On this page" }).getByRole("link", { name: "Methods" }).click();
  await v.page.waitForFunction(() => location.hash === "#report-methods");
  assert.equal(await seen("report-methods"), true);
  const looks = v.mock.log.length;
  await v.page.goBack();
  await v.page.waitForFunction(() => location.hash === "");
  assert.equal(v.mock.log.length, looks);
  await v.page.goto(`${v.mock.url}/console/studies/${study.id}#report-response-times`);
  await v.page.reload();
  await v.page.locator("#report-response-times").waitFor();
  assert.equal(await seen("report-response-times"), true);
});

test("a report that cannot be made says so and is asked for again", async (t) => {
  const stuff = material();
  let broken = true;
  const v = await visit(t, {
    stuff,
    results: (path, query) => (broken && path.endsWith("/document") ? problem(409, "paused", "The data are damaged.") : results(stuff)(path, query)),
  });
  await open(v);
  await v.page.getByText("The report could not be made: The data are damaged.").waitFor();
  broken = false;
  await v.page.evaluate(() => document.dispatchEvent(new Event("visibilitychange")));
  await v.page.getByRole("heading", { name: "How to cite" }).waitFor();
  v.problems.length = 0; // the refused request is said in the browser's console too
});

test("data never become markup", async (t) => {
  const evil = "<img src=x onerror=alert(1)>";
  const stuff = material();
  const nothing = '<svg xmlns="http://www.w3.org/2000/svg"';
  // Whatever a figure's text comes to hold, a figure is all that comes of it.
  const drawings = [
    `${nothing} onload="alert(1)" viewBox="0 0 9 9"><title>One</title><script>alert(1)</script><a href="javascript:alert(1)"><text>leads away</text></a><foreignObject><img xmlns="http://www.w3.org/1999/xhtml" src="x" onerror="alert(1)"/></foreignObject><style>* { display: none }</style><circle id="login-password" style="r: 9px" class="banner" r="2" onclick="alert(1)"/></svg>`,
    `${nothing}><text>never closed</svg>`,
    '<html xmlns="http://www.w3.org/1999/xhtml"><script>alert(1)</script></html>',
  ];
  const row = { kind: "cells", content: [{ shown: evil, exact: evil, note: evil }] };
  const everywhere = [
    ...["heading", "text", "warning"].map((kind) => ({ kind, content: evil })),
    { kind: "list", content: [evil] },
    { kind: "table", content: { caption: evil, columns: [{ name: evil, numeric: true }], rows: [{ kind: "group", content: evil }, row] } },
    ...drawings.map((svg) => ({ kind: "figure", content: { name: evil, caption: evil, svg } })),
  ];
  const hostile = (path, query) => {
    const [status, body] = results(stuff)(path, query) ?? [];
    if (path.endsWith("/document")) return [200, { ...body, subtitle: evil, sections: [{ title: evil, pieces: everywhere, reference: false }] }];
    return status ? [status, JSON.parse(JSON.stringify(body).replaceAll("Shadows on a screen", evil))] : null;
  };
  const v = await visit(t, { stuff, results: hostile });
  await v.page.goto(`${v.mock.url}/console`);
  await v.hook("login-password").fill("wayang");
  await v.hook("login-submit").click();
  await v.page.getByText(evil).first().click();
  await v.page.locator(".report figure svg").waitFor();
  assert.equal(await v.page.locator("img[src=x], script:not([src]), [onerror], [onload], [onclick], .report :is(style, a, foreignObject, [id=login-password], [style])").count(), 0);
  const said = (await v.page.locator(".report").innerText()).split(evil).length - 1;
  assert.equal(said, 14, "every text is there, once in every place");
  assert.deepEqual(await v.page.locator(".report figure svg").evaluateAll((all) => all.map((svg) => svg.outerHTML)), ['<svg viewBox="0 0 9 9"><title>One</title><circle r="2"></circle></svg>']);
  assert.equal(await v.page.getByText("This figure can't be shown here").count(), 2);
  assert.deepEqual(
    v.problems.splice(0).filter((problem) => !problem.startsWith("Applying inline style violates")),
    [],
    "the policy keeps styles out while a figure is parsed",
  );
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
  await v.page.getByRole("heading", { name: "How to cite" }).waitFor();
  assert.ok(
    v.mock.log.some((call) => call.path.endsWith(`/versions/${versions.before}/document`) && call.query === `?with=${versions.pilot}`),
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
  await v.page.getByRole("heading", { name: "How to cite" }).waitFor();
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
  await v.page.getByText("Send people the link above").waitFor();
});
