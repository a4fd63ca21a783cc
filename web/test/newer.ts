// What the oldest browsers have not, by name, from MDN's table of browsers (`@mdn/browser-compat-data`).
import { createRequire } from "node:module";

interface Entry {
  __compat?: { support: Record<string, Support | Support[]> };
  [name: string]: unknown;
}
interface Support {
  version_added: string | boolean | null;
  flags?: unknown;
  prefix?: string;
  alternative_name?: string;
}

const require = createRequire(import.meta.url);
/** The oldest browsers that the pages are made for. */
export const oldest = require("../browsers.json") as { Safari: string; Firefox: string; Chrome: string };
const data = require("@mdn/browser-compat-data") as { api: Entry; javascript: { builtins: Entry } };

const number = (version: string) => {
  const [major = 0, minor = 0] = version.replace("≤", "").split(".").map(Number);
  return major * 1000 + minor;
};

/** Whether each of the oldest browsers has it, by its own name and without a switch. */
function everywhere({ __compat }: Entry): boolean {
  return Object.entries({ ...oldest, Safari_iOS: oldest.Safari }).every(([browser, version]: [string, string]) => {
    const support = __compat?.support[browser.toLowerCase()] ?? [];
    return [support]
      .flat()
      .some(({ version_added: added, flags, prefix, alternative_name: other }) => typeof added === "string" && added !== "preview" && !flags && !prefix && !other && number(added) <= number(version));
  });
}

const has = new Set<string>();
const hasNot = new Set<string>();
/** Notes an object's members, each alone and as the object's; `Intl` holds objects itself. */
function note(object: string, entry: Entry, depth: number): void {
  for (const [member, inner] of Object.entries(entry) as [string, Entry][]) {
    if (inner.__compat === undefined) continue;
    const own = member.replace(/_(static|event)$/, "");
    const set = everywhere(inner) ? has : hasNot;
    set.add(own);
    if (object !== "") set.add(`${object}.${own}`);
    if (depth > 1) note(own, inner, depth - 1);
  }
}
note("", data.api, 2);
note("", data.javascript.builtins, 3);

/** Names that mean nothing to some of the oldest browsers: no object there has a member of that name, or not that object (`AbortSignal.timeout`). */
export const newer: ReadonlySet<string> = new Set([...hasNot].filter((name) => !has.has(name)));

/** Newer names in a script: functions that are called, and objects that are made or asked. A field may be called whatever it likes. */
export function unsupported(script: string): string[] {
  const called = [...script.matchAll(/\.([A-Za-z_$][\w$]*)(?:\?\.)?\(/g)].map(([, name]) => name ?? "");
  const objects = [...script.matchAll(/(?<![\w$.])(?:new ([A-Z][\w$]*)|([A-Z][\w$]*)\??\.)/g)].map(([, made, asked]) => made ?? asked ?? "");
  const asked = [...script.matchAll(/(?<![\w$.])([A-Z][\w$]*\.[A-Za-z_$][\w$]*)\(/g)].map(([, name]) => name ?? "");
  const expressions = script.match(/\(\?<[=!]/g) ?? [];
  return [...new Set([...[...called, ...objects, ...asked].filter((name) => name.length > 2 && newer.has(name)), ...expressions])];
}
