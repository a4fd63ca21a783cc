/** The kinds of trial: each folder here with an `index.ts`. */
import type { TrialModule } from "./module.ts";

/** A kind that this page was built without: the page is older than the study. */
export class UnknownKind extends Error {}

/**
 * The module of a kind. esbuild finds the folders by this import's pattern and puts them all into the page's one script,
 * so nothing has to be fetched here, and a lost line can't keep a trial from beginning.
 */
export async function loadKind(kind: string): Promise<TrialModule> {
  let found: { default: TrialModule };
  try {
    found = await import(`./${kind}/index.ts`);
  } catch (error) {
    throw new UnknownKind(kind, { cause: error });
  }
  return found.default;
}
