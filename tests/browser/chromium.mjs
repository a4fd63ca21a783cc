// Debian's Chromium, headless, with nothing that talks to the world.
import { chromium } from "playwright-core";

/** A browser on fresh, empty settings. */
export const launch = () =>
  chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });
