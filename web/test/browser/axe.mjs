// axe-core on a page as it stands, in whichever browser.
import { readFileSync } from "node:fs";

const source = readFileSync(new URL(import.meta.resolve("axe-core")), "utf8");

/** A function's text, to be called in the page: what axe finds against WCAG 2.2 AA and good practice, as sentences. */
export const violations = `async () => {
  ${source};
  const { violations } = await axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"] });
  return violations.flatMap(({ id, help, nodes }) => nodes.map(({ target, failureSummary }) => id + " (" + help + "): " + target.join(" ") + ": " + failureSummary.split("\\n").slice(1).join("; ").trim()));
}`;
