// The pages in a real browser against the mock server: `npm run test:browser` (needs Chromium; CHROMIUM names another one).
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { inflateSync } from "node:zlib";
import { launch, sizes } from "./browser.mjs";
import { startMock, study } from "./mock-server.mjs";
import { results } from "./mock-results.mjs";

const dist = mkdtempSync(join(tmpdir(), "kelir-web-"));
let browser;
before(async () => {
  execFileSync("node", ["build.mjs", dist]);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  rmSync(dist, { recursive: true });
});

/** A mock server and a page on it; errors on the page, content-policy ones too, fail the test. */
async function visit(t, { options = sizes.desktop, query = "", chromium = browser, ...server } = {}) {
  const mock = await startMock({ dist, results, ...server });
  const context = await chromium.newContext(options);
  const page = await context.newPage();
  const problems = [];
  page.on("pageerror", (error) => problems.push(error.message));
  page.on("console", (message) => message.type() === "error" && !/Failed to load resource/.test(message.text()) && problems.push(message.text()));
  t.after(async () => {
    await context.close();
    await mock.close();
    assert.deepEqual(problems, []);
  });
  const url = `${mock.url}/study/${study.id}${query}`;
  await page.goto(url);
  return { mock, context, page, problems, url, hook: (id) => page.getByTestId(id) };
}

const position = (page, i) => page.getByText(`${i + 1} of 5`, { exact: true }).waitFor();

/** From the first page to the first trial. */
async function begin({ hook, page }) {
  await hook("consent-agree").click();
  await hook("start").click();
  await position(page, 0);
}

/** Answers the trials `from` to `to`. */
async function answer({ hook, page }, from, to, side = "left") {
  for (let i = from; i < to; i++) {
    await position(page, i);
    await hook(`choice-${side}`).click();
  }
}

const stored = (mock) => [...mock.sessions.values()].map((s) => [...s.answers].map(([i, body]) => [i, JSON.parse(body).choice]));

test("a whole visit: every answer once, the code only at the end, nothing stored before consent", async (t) => {
  const v = await visit(t, { query: "?PROLIFIC_PID=p1&STUDY_ID=s1&SESSION_ID=x1" });
  await v.hook("consent-agree").waitFor();
  assert.equal(v.mock.sessions.size, 0);
  await begin(v);
  assert.equal(await v.hook("completion-code").count(), 0);
  await answer(v, 0, 5);
  assert.equal(await v.hook("completion-code").textContent(), "LAKON-7Q4F");
  assert.deepEqual(stored(v.mock), [[[0, "left"], [1, "left"], [2, "left"], [3, "left"], [4, "left"]]]);
  const [session] = v.mock.sessions.values();
  assert.deepEqual(session.body.params, { PROLIFIC_PID: "p1", STUDY_ID: "s1", SESSION_ID: "x1" });
  assert.equal(await v.page.getByRole("link", { name: "Return to prolific.com" }).count(), 1);
  const row = JSON.parse(session.answers.get(0));
  assert.equal(row.input, "mouse");
  assert.equal(row.scale, 1);
  assert.ok(row.rt > 0 && row.onset > 0 && row.time_elapsed > 0);
  assert.ok(row.refresh_hz > 20 && row.refresh_hz < 400);
  const { frames } = JSON.parse(session.answers.get(4));
  assert.equal(frames.left.fps, 12);
  assert.equal(frames.left.hold, Math.round(frames.left.refresh_hz / 12));
});

test("the keyboard alone is enough, and arrows mean sides", async (t) => {
  const v = await visit(t);
  await v.hook("consent-agree").waitFor();
  assert.equal(await v.page.evaluate(() => document.activeElement?.tagName), "H1");
  await v.hook("consent-agree").focus();
  await v.page.keyboard.press("Enter");
  await v.hook("start").waitFor();
  await v.page.keyboard.press("Tab");
  assert.equal(await v.page.evaluate(() => document.activeElement?.getAttribute("data-testid")), "start", "one tab stop from heading to action");
  await v.page.keyboard.press("Enter");
  for (const [i, key] of ["ArrowRight", "ArrowLeft"].entries()) {
    await position(v.page, i);
    await v.page.keyboard.press(key);
  }
  await position(v.page, 2);
  await v.page.keyboard.press("Tab");
  await v.page.keyboard.press("Tab");
  await v.page.keyboard.press("Enter");
  await position(v.page, 3);
  await v.page.keyboard.press("Alt+ArrowLeft").catch(() => {});
  assert.deepEqual(stored(v.mock), [[[0, "right"], [1, "left"], [2, "right"]]]);
  const [session] = v.mock.sessions.values();
  assert.deepEqual([0, 2].map((i) => JSON.parse(session.answers.get(i)).input), ["keyboard", "keyboard"]);
});

test("pictures have their labels, and the page says where it is", async (t) => {
  const v = await visit(t);
  await begin(v);
  assert.equal(await v.page.getByRole("button", { name: "Left image" }).count(), 1);
  assert.equal(await v.page.getByRole("button", { name: "Right image" }).count(), 1);
  assert.equal(await v.page.locator("[aria-live=polite]").textContent(), "1 of 5");
  assert.equal(await v.page.evaluate(() => document.activeElement?.textContent), study.question);
});

test("a reload resumes at the next trial; after the end it shows the code again", async (t) => {
  const v = await visit(t);
  await begin(v);
  await answer(v, 0, 2);
  await position(v.page, 2);
  await v.page.reload();
  await position(v.page, 2);
  await answer(v, 2, 5, "right");
  await v.hook("completion-code").waitFor();
  await v.page.reload();
  assert.equal(await v.hook("completion-code").textContent(), "LAKON-7Q4F");
  assert.deepEqual(stored(v.mock), [[[0, "left"], [1, "left"], [2, "right"], [3, "right"], [4, "right"]]]);
  const [session] = v.mock.sessions.values();
  assert.deepEqual([0, 2].map((i) => JSON.parse(session.answers.get(i)).reload_count), [0, 1]);
});

test("another participant's link starts another session, the first one's resumes his", async (t) => {
  const v = await visit(t, { query: "?PROLIFIC_PID=a" });
  await begin(v);
  await answer(v, 0, 1);
  await v.page.goto(v.url.replace("=a", "=b"));
  await v.hook("consent-agree").waitFor();
  await v.page.goto(v.url);
  await position(v.page, 1);
});

test("a lost line: the sentence is calm and true, the study goes on, all arrives", async (t) => {
  let down = false;
  const v = await visit(t, { fault: ({ method }) => (down && method === "PUT" ? "hang up" : null) });
  await begin(v);
  down = true;
  await answer(v, 0, 2);
  await position(v.page, 2);
  await v.page.getByText("No connection. Your answers are kept here and sent later; you can go on.").waitFor();
  assert.deepEqual(stored(v.mock), [[]]);
  // What waits survives a reload.
  await v.page.reload();
  await position(v.page, 2);
  await answer(v, 2, 5);
  await v.page.getByText("Almost done").waitFor();
  assert.equal(await v.hook("completion-code").count(), 0, "no code while answers wait");
  down = false;
  assert.equal(await v.hook("completion-code").textContent(), "LAKON-7Q4F");
  assert.equal(stored(v.mock)[0].length, 5);
  assert.equal(await v.page.locator("#notice").textContent(), "");
});

test("what one participant left unsent goes out with the next one's visit", async (t) => {
  let down = false;
  const v = await visit(t, { query: "?PROLIFIC_PID=a", fault: ({ method }) => (down && method === "PUT" ? "hang up" : null) });
  await begin(v);
  down = true;
  await answer(v, 0, 1, "right");
  await position(v.page, 1);
  await v.page.goto("about:blank");
  assert.deepEqual(stored(v.mock), [[]]);
  down = false;
  await v.page.goto(v.url.replace("=a", "=b"));
  await v.hook("consent-agree").click();
  await v.hook("start").waitFor();
  assert.deepEqual(stored(v.mock), [[[0, "right"]], []]);
});

test("pictures that are long in coming are announced", async (t) => {
  const v = await visit(t);
  await v.page.route("**/stimuli/**", async (route) => {
    await new Promise((resolve) => setTimeout(resolve, 2500));
    await route.continue();
  });
  await v.hook("consent-agree").click();
  await v.hook("start").click();
  await v.page.getByText("The next pictures are on their way").waitFor();
  await position(v.page, 0);
  assert.equal(await v.page.locator("#notice").textContent(), "");
});

test("a lost acknowledgement costs nothing and doubles nothing", async (t) => {
  const lost = new Set();
  const fault = ({ method, path }) => (method === "PUT" && !lost.has(path) && lost.add(path) ? { after: true } : null);
  const v = await visit(t, { fault });
  await begin(v);
  await answer(v, 0, 5);
  await v.hook("completion-code").waitFor();
  assert.deepEqual(stored(v.mock), [[[0, "left"], [1, "left"], [2, "left"], [3, "left"], [4, "left"]]]);
});

test("an answer that the server refuses for good is kept and said, and no code is shown", async (t) => {
  let refuse = true;
  const body = { error: { code: "invalid_answer", message: "rt = -1: a response time is not negative." } };
  const v = await visit(t, { fault: ({ method, path }) => (refuse && method === "PUT" && path.endsWith("/trials/1") ? { status: 422, body } : null) });
  await begin(v);
  await answer(v, 0, 5);
  await v.page.getByText("One answer could not be stored").waitFor();
  assert.equal(await v.hook("completion-code").count(), 0);
  refuse = false;
  await v.page.getByRole("button", { name: "Try again" }).click();
  assert.equal(await v.hook("completion-code").textContent(), "LAKON-7Q4F");
});

test("a second tab says so and may take over; the first one stops", async (t) => {
  const v = await visit(t);
  await begin(v);
  await answer(v, 0, 1);
  await position(v.page, 1);
  const second = await v.context.newPage();
  await second.goto(v.url);
  await second.getByText("This study is open in another tab").waitFor();
  await second.getByRole("button", { name: "Continue here" }).click();
  await position(second, 1);
  await v.page.getByText("Continued in another tab").waitFor();
  await v.page.keyboard.press("ArrowRight");
  await second.getByTestId("choice-left").click();
  await position(second, 2);
  assert.deepEqual(stored(v.mock), [[[0, "left"], [1, "left"]]]);
});

test("a session that the server has forgotten starts again from consent", async (t) => {
  const v = await visit(t);
  await begin(v);
  v.mock.sessions.clear();
  await v.page.reload();
  await v.hook("consent-agree").waitFor();
});

test("wrong bytes are never shown", async (t) => {
  const v = await visit(t);
  await v.hook("consent-agree").waitFor();
  const { sha256 } = v.mock.stuff.trials[0].left;
  const { sha256: other } = v.mock.stuff.trials[1].left;
  v.mock.stuff.bytes.set(sha256, v.mock.stuff.bytes.get(other));
  await v.hook("consent-agree").click();
  await v.hook("start").click();
  await v.page.getByText("The study has stopped").waitFor();
  assert.equal(await v.hook("choice-left").count(), 0);
  assert.equal(v.problems.length, 1, "the console says why");
  v.problems.length = 0;
});

/** RGB rows of an 8-bit PNG with any filter (PNG 3rd ed., 9.2). */
function pixels(png) {
  const width = png.readUInt32BE(16);
  const height = png.readUInt32BE(20);
  const channels = png[25] === 6 ? 4 : 3;
  const parts = [];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
    if (png.toString("latin1", at + 4, at + 8) === "IDAT") parts.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
  }
  const raw = inflateSync(Buffer.concat(parts));
  const stride = width * channels;
  const out = Buffer.alloc(stride * height);
  const paeth = (a, b, c) => {
    const p = a + b - c;
    const [pa, pb, pc] = [Math.abs(p - a), Math.abs(p - b), Math.abs(p - c)];
    return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
  };
  for (let y = 0; y < height; y++) {
    const filter = raw[y * (stride + 1)];
    for (let i = 0; i < stride; i++) {
      const a = i >= channels ? out[y * stride + i - channels] : 0;
      const b = y > 0 ? out[(y - 1) * stride + i] : 0;
      const c = i >= channels && y > 0 ? out[(y - 1) * stride + i - channels] : 0;
      const guess = [0, a, b, (a + b) >> 1, paeth(a, b, c)][filter];
      out[y * stride + i] = raw[y * (stride + 1) + 1 + i] + guess;
    }
  }
  return { width, height, at: (x, y) => [...out.subarray((y * width + x) * channels, (y * width + x) * channels + 3)] };
}

// A real scale factor: Chromium's emulated one places pictures in whole CSS pixels, which no display does.
for (const dpr of [1, 1.25, 1.5, 2, 2.625]) {
  test(`at ${dpr} device pixels to a CSS pixel the screen shows exactly the stimulus's pixels`, async (t) => {
    const chromium = await launch([`--force-device-scale-factor=${dpr}`, "--window-size=1280,800"]);
    t.after(() => chromium.close());
    const v = await visit(t, { chromium, options: { viewport: null } });
    await begin(v);
    await v.hook("choice-left").waitFor();
    assert.equal(await v.page.evaluate(() => devicePixelRatio), dpr);
    const shot = await (await v.context.newCDPSession(v.page)).send("Page.captureScreenshot", { format: "png" });
    const screen = pixels(Buffer.from(shot.data, "base64"));
    for (const side of ["left", "right"]) {
      const stimulus = pixels(v.mock.stuff.bytes.get(v.mock.stuff.trials[0][side].sha256).data);
      const box = await v.hook(`choice-${side}`).boundingBox();
      const [x0, y0] = [Math.round(box.x * dpr), Math.round(box.y * dpr)];
      const differing = (dx) => {
        let n = 0;
        for (let y = 0; y < 333; y++) for (let x = 1; x < 591; x++) if (String(screen.at(x0 + x + dx, y0 + y)) !== String(stimulus.at(x, y))) n += 1;
        return n;
      };
      assert.equal(differing(0), 0, side);
      assert.ok(differing(1) > 1000, "one pixel off would be seen");
    }
  });
}

test("nothing scrolls sideways down to 320 pixels, and the page can be zoomed", async (t) => {
  const v = await visit(t, { options: { viewport: { width: 320, height: 568 }, hasTouch: true, isMobile: true } });
  const wide = () => v.page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  const zoom = await v.page.locator("meta[name=viewport]").getAttribute("content");
  assert.doesNotMatch(zoom, /maximum-scale|user-scalable/);
  await v.hook("consent-agree").waitFor();
  assert.equal(await wide(), 0);
  await v.hook("consent-agree").tap();
  await v.hook("start").waitFor();
  assert.equal(await wide(), 0);
  await v.hook("start").tap();
  for (let i = 0; i < 5; i++) {
    await position(v.page, i);
    assert.equal(await wide(), 0);
    const [left, right] = [await v.hook("choice-left").boundingBox(), await v.hook("choice-right").boundingBox()];
    assert.ok(right.y >= left.y + left.height * 1.05 && right.y + right.height <= 568, JSON.stringify([left, right]));
    await v.hook("choice-right").tap();
  }
  await v.hook("completion-code").waitFor();
  assert.equal(await wide(), 0);
  const [session] = v.mock.sessions.values();
  const row = JSON.parse(session.answers.get(0));
  assert.deepEqual([row.input, row.arrangement], ["touch", "stack"]);
  assert.ok(Math.abs(row.scale - 292 / 592) < 1e-9, String(row.scale));
});

test("a study that is not there says so", async (t) => {
  const v = await visit(t);
  await v.page.goto(v.url.replace(study.id, "nothing"));
  await v.page.getByText("There is no such study").waitFor();
});

test("console: sign in, the numbers in full precision, back works, sign out", async (t) => {
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

test("console: the full report and the paper come with their exact numbers and described plots", async (t) => {
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

test("console: data never become markup", async (t) => {
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
