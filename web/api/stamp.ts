/** Whether `schema.ts` is what the generator makes of `openapi.json`, told from its first line alone: no second TypeScript has to be installed for that. */
import { createHash } from "node:crypto";

/** What the generated file depends on, and what was generated. */
export interface Inputs {
  /** The text of `openapi.json`. */
  document: string;
  /** The text of the generator's lock file: another version may write something else. */
  lock: string;
}

const hash = (...texts: string[]) => createHash("sha256").update(JSON.stringify(texts)).digest("hex");

/** The generated file: one line that says what it was made from, then `body`. */
export function stamped({ document, lock }: Inputs, body: string): string {
  return `// Generated from openapi.json by \`npm run types\`; do not edit. ${hash(document, lock)} ${hash(body)}\n${body}`;
}

/** What is wrong with a generated file; null when it is what the inputs give. */
export function fault({ document, lock }: Inputs, file: string): string | null {
  const [line = "", ...rest] = file.split("\n");
  const [made, body] = line.split(" ").slice(-2);
  if (body !== hash(rest.join("\n"))) return "was edited by hand, or was not generated at all";
  return made === hash(document, lock) ? null : "is older than openapi.json or the generator";
}
