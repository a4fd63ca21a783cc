// A headless Firefox, driven by Marionette, its own remote control: nothing has to be installed beside it.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";

const executable = process.env.FIREFOX ?? ["/usr/bin/firefox-esr", "/usr/bin/firefox"].find(existsSync);

/** Whether there is a Firefox on this machine. */
export const hasFirefox = executable !== undefined;

const PREFERENCES = {
  "marionette.port": 0,
  "browser.shell.checkDefaultBrowser": false,
  "browser.aboutwelcome.enabled": false,
  "datareporting.policy.dataSubmissionEnabled": false,
  "app.update.enabled": false,
};

/** Starts a Firefox on fresh settings, with `preferences` beside those that keep it quiet. */
export async function launchFirefox({ preferences = {}, width = 1280, height = 800 } = {}) {
  const profile = mkdtempSync(join(tmpdir(), "kelir-firefox-"));
  const lines = Object.entries({ ...PREFERENCES, ...preferences }).map(([name, value]) => `user_pref(${JSON.stringify(name)}, ${JSON.stringify(value)});`);
  writeFileSync(join(profile, "user.js"), lines.join("\n"));
  const process_ = spawn(executable, ["--headless", "--marionette", "--no-remote", "--profile", profile, `--width=${width}`, `--height=${height}`], {
    stdio: "ignore",
    env: { ...process.env, MOZ_HEADLESS_WIDTH: String(Math.max(1366, width)), MOZ_HEADLESS_HEIGHT: String(Math.max(768, height)) }, // the screen's
  });
  const ended = new Promise((resolve) => process_.once("exit", resolve));
  const close = async () => {
    process_.kill();
    await ended;
    rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
  };
  try {
    const port = await portOf(profile);
    const send = await marionette(port);
    await send("WebDriver:NewSession", { capabilities: { alwaysMatch: { acceptInsecureCerts: false } } });
    return { ...driver(send), close };
  } catch (error) {
    await close();
    throw error;
  }
}

/** The port that Firefox wrote down, once it listens. */
async function portOf(profile) {
  const file = join(profile, "MarionetteActivePort");
  for (let tries = 0; tries < 1200; tries++) {
    const port = existsSync(file) ? Number(readFileSync(file, "utf8")) : 0;
    if (port > 0) return port;
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  throw new Error("Firefox did not start within two minutes");
}

/** Marionette's protocol: `LENGTH:[type, id, command, parameters]` there, `LENGTH:[type, id, error, result]` back. */
function marionette(port) {
  const socket = connect(port, "127.0.0.1");
  const waiting = new Map();
  let last = 0;
  let buffer = Buffer.alloc(0);
  return new Promise((ready, failed) => {
    const send = (command, parameters = {}) =>
      new Promise((resolve, reject) => {
        waiting.set(++last, { resolve, reject });
        const message = JSON.stringify([0, last, command, parameters]);
        socket.write(`${Buffer.byteLength(message)}:${message}`);
      });
    const hear = (message) => {
      if (!Array.isArray(message)) return ready(send); // the greeting
      const [, id, error, result] = message;
      const { resolve, reject } = waiting.get(id) ?? {};
      waiting.delete(id);
      if (error === null) resolve?.(result);
      else reject?.(new Error(`${error.error}: ${error.message}`));
    };
    socket.on("data", (data) => {
      buffer = Buffer.concat([buffer, data]);
      for (;;) {
        const colon = buffer.indexOf(":");
        const length = Number(buffer.subarray(0, Math.max(0, colon)).toString());
        if (colon < 0 || buffer.length < colon + 1 + length) return;
        const text = buffer.subarray(colon + 1, colon + 1 + length).toString();
        buffer = buffer.subarray(colon + 1 + length);
        hear(JSON.parse(text));
      }
    });
    const lost = (error) => {
      failed(error);
      for (const { reject } of waiting.values()) reject(error);
    };
    socket.on("error", lost);
    socket.on("close", () => lost(new Error("Firefox has gone")));
  });
}

/** What tests do with a page. */
function driver(send) {
  const evaluate = async (body, ...args) =>
    (
      await send("WebDriver:ExecuteAsyncScript", {
        script: `const done = arguments[arguments.length - 1]; Promise.resolve((${body})(...[...arguments].slice(0, -1))).then(done);`,
        args,
        scriptTimeout: 60_000,
        newSandbox: false,
        sandbox: null,
      })
    ).value;
  const until = async (body, ...args) => {
    for (let tries = 0; tries < 600; tries++) {
      const found = await evaluate(body, ...args);
      if (found) return found;
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`it did not come to this: ${body} of ${JSON.stringify(args)}`);
  };
  /** Where an element's middle is, once it is there. */
  const middle = (testid) =>
    until((id) => {
      const element = document.querySelector(`[data-testid="${id}"]`);
      if (element === null || element.getAttribute("aria-disabled") === "true" || getComputedStyle(element).visibility === "hidden") return null;
      element.scrollIntoView({ block: "nearest" });
      const { x, y, width, height } = element.getBoundingClientRect();
      return { x: Math.round(x + width / 2), y: Math.round(y + height / 2) };
    }, testid);
  const perform = (actions) => send("WebDriver:PerformActions", { actions });
  const pointer = (actions, pointerType = "mouse") => perform([{ type: "pointer", id: pointerType, parameters: { pointerType }, actions }]);
  const press = [
    { type: "pointerDown", button: 0 },
    { type: "pointerUp", button: 0 },
  ];
  return {
    goto: (url) => send("WebDriver:Navigate", { url }),
    evaluate,
    until,
    middle,
    /** Presses the pointer where `at` is, after each of the `pauses`, ms. */
    async presses({ x, y }, pauses, pointerType = "mouse") {
      await pointer([{ type: "pointerMove", x, y, duration: 0 }, ...pauses.flatMap((duration) => [{ type: "pause", duration }, ...press])], pointerType);
    },
    async click(testid) {
      await this.presses(await middle(testid), [0]);
    },
    /** A key, such as `\uE012` for ←, down and up after each of the `pauses`, ms. */
    keys: (value, pauses) =>
      perform([
        {
          type: "key",
          id: "keyboard",
          actions: pauses.flatMap((duration) => [
            { type: "pause", duration },
            { type: "keyDown", value },
            { type: "keyUp", value },
          ]),
        },
      ]),
    screenshot: async () => Buffer.from((await send("WebDriver:TakeScreenshot", { full: false })).value, "base64"),
  };
}
