// Kinds of trial: what the page makes of those it knows, of several in one study, and of those it does not know.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { test } from "node:test";
import { build } from "esbuild";
import { intervals, material } from "../mock-study.ts";
import { answer, begin, position, rows, stored, visit } from "./visit.mjs";

/** Both kinds in one plan. */
function mixed() {
  const [pairs, sequences] = [material(), intervals({ stills: 1 })];
  const trials = [pairs.trials[0], sequences.trials[0], pairs.trials[1]].map((trial, trial_index) => ({ ...trial, trial_index }));
  return { bytes: new Map([...pairs.bytes, ...sequences.bytes]), trials };
}

test("a study of two kinds explains both and shows both", async (t) => {
  const v = await visit(t, { stuff: mixed() });
  await v.hook("consent-agree").click();
  await v.hook("start").waitFor();
  assert.deepEqual(await v.page.locator("h2.kind").allTextContents(), ["Two pictures at once", "Two pictures, one after the other"]);
  assert.deepEqual(await v.page.locator(".keys kbd").allTextContents(), ["←", "→", "←", "1", "→", "2"]);
  await v.hook("start").click();
  await answer(v, 0, 1, "right", "3");
  await answer(v, 1, 2, "second", "3");
  await answer(v, 2, 3, "left", "3");
  await v.hook("completion-code").waitFor();
  assert.deepEqual(
    rows(v.mock).map((row) => [row.trial_type, row.choice]),
    [
      ["two-alternative", "right"],
      ["two-interval", "second"],
      ["two-alternative", "left"],
    ],
  );
});

test("a study of one kind doesn't name it", async (t) => {
  const v = await visit(t);
  await v.hook("consent-agree").click();
  await v.hook("start").waitFor();
  assert.equal(await v.page.locator("h2.kind").count(), 0);
  assert.deepEqual(await v.page.locator(".keys kbd").allTextContents(), ["←", "→"]);
});

test("a kind that the page doesn't know: it says so before anything is asked, or in the middle, and a reload goes on", async (t) => {
  const stuff = material();
  const known = stuff.trials[1].trial;
  stuff.trials[1].trial = "three-interval";
  const v = await visit(t, { stuff, grow: { start: 1, most: 5 } });
  const please = v.page.getByRole("heading", { name: "Please reload this page" });
  await please.waitFor();
  assert.equal(await v.hook("consent-agree").count(), 0);
  stuff.trials[1].trial = known;
  await v.page.getByRole("button", { name: "Reload the page" }).click();
  await begin(v, "at most 5");
  // The study is updated while somebody takes part.
  stuff.trials[1].trial = "three-interval";
  await answer(v, 0, 1, "left", "at most 5");
  await please.waitFor();
  assert.deepEqual(stored(v.mock), [[[0, "left"]]]);
  stuff.trials[1].trial = known;
  await v.page.getByRole("button", { name: "Reload the page" }).click();
  await position(v.page, 1, "at most 5");
  assert.equal(v.problems.length, 2, "the console says why");
  v.problems.length = 0;
});

test("a kind is added by its folder, and by nothing else", async (t) => {
  const root = mkdtempSync(join(tmpdir(), "kelir-kind-"));
  t.after(() => rmSync(root, { recursive: true }));
  const web = join(root, "web");
  // The console's pages are laid out by the report's sheet.
  const sheet = "crates/report/src/shared.css";
  cpSync(join("..", sheet), join(root, sheet), { recursive: true });
  for (const part of ["participant", "console", "shared", "build.mjs", "browsers.json", "package.json"]) cpSync(part, join(web, part), { recursive: true });
  symlinkSync(resolve("node_modules"), join(web, "node_modules"));
  mkdirSync(join(web, "participant/trials/added"));
  const legend = '{ title: "Added", answers: [{ keys: ["←"], label: "this" }, { keys: ["→"], label: "that" }] }';
  writeFileSync(join(web, "participant/trials/added/index.ts"), `import pair from "../two-alternative/index.ts"; export default { ...pair, legend: ${legend} };`);
  execFileSync("node", ["build.mjs", join(web, "dist")], { cwd: web });
  const stuff = material();
  stuff.trials = stuff.trials.slice(0, 1).map((trial) => ({ ...trial, trial: "added" }));
  const v = await visit(t, { stuff, dist: join(web, "dist") });
  await v.hook("consent-agree").click();
  await v.page.getByText("← this").waitFor();
  await v.hook("start").click();
  await answer(v, 0, 1, "right", "1");
  await v.hook("completion-code").waitFor();
  // The page without the folder doesn't know it: that is the test before this one.
});

test("a pen is a pen", async (t) => {
  const v = await visit(t);
  await begin(v);
  await v.hook("choice-left").waitFor();
  const cdp = await v.context.newCDPSession(v.page);
  const press = async (pointerType) => {
    const box = await v.hook("choice-left").boundingBox();
    const [x, y] = [box.x + 40, box.y + 40];
    for (const type of ["mouseMoved", "mousePressed", "mouseReleased"])
      await cdp.send("Input.dispatchMouseEvent", { type, x, y, button: type === "mouseMoved" ? "none" : "left", clickCount: 1, pointerType });
  };
  await press("pen");
  await position(v.page, 1);
  await v.hook("choice-left").waitFor({ state: "visible" });
  await press("mouse");
  await position(v.page, 2);
  assert.deepEqual(
    rows(v.mock).map((row) => row.input),
    ["pen", "mouse"],
  );
});

test("what was on the screen is stored: width, arrangement, and how long it was seen", async (t) => {
  const v = await visit(t);
  await begin(v);
  await v.hook("choice-left").waitFor({ state: "visible" });
  await v.page.evaluate(() => {
    Object.defineProperty(document, "hidden", { configurable: true, value: true });
    document.dispatchEvent(new Event("visibilitychange"));
  });
  await v.page.waitForTimeout(250);
  await v.page.evaluate(() => {
    Object.defineProperty(document, "hidden", { configurable: true, value: false });
    document.dispatchEvent(new Event("visibilitychange"));
  });
  await answer(v, 0, 2);
  await position(v.page, 2);
  const [first, second] = rows(v.mock);
  assert.deepEqual([first.css_width_px, first.arrangement, first.scale], [592, "side", 1]);
  assert.ok(first.hidden_ms >= 240 && Math.abs(first.min_visible_ms - (first.rt - first.hidden_ms)) < 0.01, JSON.stringify(first));
  assert.deepEqual([second.hidden_ms, second.min_visible_ms], [0, second.rt]);
  // An answer has these columns in this order, the additions apart.
  const added = new Set(["stimulus_size", "css_width_px", "min_visible_ms", "geometry_changed", "events"]);
  const before = [
    "choice",
    "rt",
    "onset",
    "input",
    "scale",
    "arrangement",
    "device_pixel_ratio",
    "viewport",
    "refresh_hz",
    "hidden_ms",
    "time_elapsed",
    "trial_type",
    "plugin_version",
    "reload_count",
    "timestamp",
  ];
  assert.deepEqual(
    Object.keys(first).filter((column) => !added.has(column)),
    before,
  );
});

test("scale and width are those that the participant saw, pinch zoom included", async (t) => {
  const v = await visit(t, { options: { viewport: { width: 390, height: 844 }, deviceScaleFactor: 3, hasTouch: true, isMobile: true } });
  await begin(v);
  await answer(v, 0, 1);
  await position(v.page, 1);
  const cdp = await v.context.newCDPSession(v.page);
  await cdp.send("Emulation.setPageScaleFactor", { pageScaleFactor: 2 });
  await v.page.waitForFunction(() => visualViewport.scale === 2);
  await v.page.keyboard.press("ArrowLeft");
  await v.page.waitForTimeout(300);
  const [plain, zoomed] = rows(v.mock);
  assert.deepEqual([plain.scale, plain.css_width_px], [1, 197.333]);
  assert.deepEqual([zoomed.scale, zoomed.css_width_px], [2, 394.667]);
  for (const row of [plain, zoomed]) assert.ok(Math.abs(row.css_width_px - (592 * row.scale) / row.device_pixel_ratio) < 1e-3);
});

/** jsPsych's own simulation of a kind, in a page without our server. */
async function simulate(page, kind, mode) {
  const stdin = { contents: 'import { simulate } from "./simulate.ts"; globalThis.simulate = simulate;', resolveDir: import.meta.dirname, loader: "ts" };
  const { outputFiles } = await build({ stdin, bundle: true, loader: { ".ftl": "text" }, write: false, format: "iife", target: "es2022", logLevel: "error" });
  await page.setContent("<main></main>");
  await page.addScriptTag({ content: outputFiles[0].text });
  return page.evaluate(([kind, mode]) => globalThis.simulate(kind, mode), [kind, mode]);
}

for (const [kind, roles] of [
  ["two-alternative", ["left", "right"]],
  ["two-interval", ["first", "second"]],
]) {
  for (const mode of ["data-only", "visual"]) {
    test(`${kind} simulates itself, ${mode}`, async (t) => {
      const v = await visit(t);
      const { data, told } = await simulate(await v.context.newPage(), kind, mode);
      assert.equal(data.length, 2);
      for (const row of data) {
        assert.ok(roles.includes(row.choice) && row.rt > 0 && row.scale === 1 && row.css_width_px === 64, JSON.stringify(row));
        if (kind === "two-interval") assert.ok(row.shown_frames.first >= 3 && row.shown_ms.first > 40 && row.requested_ms.first === 50, JSON.stringify(row));
      }
      assert.deepEqual(
        told,
        data.map((row) => row.choice),
        "the answer is handed on at the choice",
      );
    });
  }
}
