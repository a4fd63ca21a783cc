// The researcher's routes of the mock server: three versions of one study, its report as Rust writes one of the source paper's counts, and a study
// that nobody has taken yet.
import { readFileSync } from "node:fs";
import type { components } from "../api/schema.ts";
import { problem, type Results } from "./mock-server.ts";
import { type Material, study } from "./mock-study.ts";

type Schemas = components["schemas"];

const hash = (beginning: string) => beginning.padEnd(64, "9");
/** Versions of the study, the current one first. */
export const versions = { current: hash("c0ffee00"), before: hash("beef0123"), pilot: hash("a11ce456") };

const people = (started: number, in_progress: number, completed: number): Schemas["Participants"] => ({ started, in_progress, completed });
const studies: Schemas["StudySummary"][] = [
  {
    ...{ id: study.id, title: study.title, version: versions.current, file_hash: hash("f11e"), status: "ready", progress: null, reason: null, warnings: [] },
    ...{ most_trials: 5, participants: people(36, 2, 32) },
  },
  {
    ...{ id: "empty", title: "A study that nobody has taken", version: null, file_hash: hash("0"), status: "preparing", most_trials: 3, participants: people(0, 0, 0) },
    ...{ progress: { done: 3, total: 10, stimulus: "still-arjuna (mc)" }, reason: null, warnings: [] },
  },
];

const version = (version: string, day: number, participants: Schemas["Participants"], answers: number): Schemas["StudyVersion"] => ({
  ...{ version, design_hash: hash("de51"), title: study.title, is_current: version === versions.current, participants, answers, stimuli: 10 },
  ...{ first_served_at: `2026-0${day}-04T09:12:00Z`, last_served_at: `2026-0${day + 1}-03T18:40:00Z` },
});
const served: Record<string, Schemas["StudyVersion"][]> = {
  [study.id]: [version(versions.current, 5, people(36, 2, 32), 161), version(versions.before, 3, people(21, 0, 18), 93), version(versions.pilot, 1, people(4, 0, 3), 16)],
  empty: [{ ...version(hash("e111"), 5, people(0, 0, 0), 0), is_current: true, title: "A study that nobody has taken" }],
};

const errors = (rmse: number) => ({ count: 197136, bias: rmse / 40, rmse, p999: 5 * rmse, max: 9 * rmse });
const provenance = (condition: string, i: number) => ({
  scene_sha256: "6a1f0c".padEnd(64, "3"),
  ...(condition === "pa" ? { technique: "pa", table: "u32" } : { technique: "mc", spp: 1024, seed: 7 }),
  ...{ version: "0.1.0", backend: "cpu", adapter: "2 threads", white: 812.25, size: [592, 333], pixel: "area", output: "still", camera: null },
  error: {
    reference: { technique: "mc", spp: 65536, seed: 1 },
    frames: [0],
    all: errors(2e-4 * (1 + i)),
    penumbra: errors(condition === "pa" ? 9.2e-5 * (1 + 0.4 * i) : 1.3e-3 * (1 + 0.3 * i)),
    floor: 7.9e-5,
  },
  counts: { pixels: 197136, pixels_penumbra: 30512 },
});

function stimuliOf({ trials }: Material): Schemas["Stimulus"][] {
  const blocks = ["stills", "photographs", "animation"];
  return trials.flatMap(({ block_index, item_index, shown }, i) => {
    const block = blocks[block_index] ?? "";
    const one = (role: string, condition: string, technique: string) => ({
      ...{ item: `${block}-${item_index + 1}`, condition, size: [...study.size], sha256: shown[role]?.sha256 ?? "", pixels_sha256: hash("b17"), provenance: provenance(technique, i) },
    });
    return [one("left", "pa", "pa"), one("right", block === "photographs" ? "simulated-photo" : "mc", "mc")];
  });
}

/** What the address chose: the versions whose answers are in, and what they showed differently. */
function chosen(id: string, asked: string, pooledWith: string | null) {
  const all = served[id] ?? [];
  const named = asked === "current" ? all.find((v) => v.is_current) : all.find((v) => v.version.startsWith(asked));
  if (named === undefined) return null;
  const others = all.filter((v) => v !== named && (pooledWith === "all" || (pooledWith ?? "").split(",").includes(v.version)));
  const counts = ({ version, participants, answers }: Schemas["StudyVersion"]): Schemas["PooledVersion"] => ({ version, sessions: participants.started, answers });
  const pooled = [named, ...others];
  const pilot = pooled.length > 1 && pooled.some((v) => v.version === versions.pilot);
  const sum = (of: keyof Schemas["Participants"]) => pooled.reduce((n, v) => n + v.participants[of], 0);
  return {
    version: named.version,
    pooled: pooled.map(counts),
    different_stimuli: pilot ? [{ item: "stills-1", condition: "mc", versions: [versions.pilot] }] : [],
    other_versions: all.filter((v) => !pooled.includes(v)).map(counts),
    participants: people(sum("started"), sum("in_progress"), sum("completed")),
  };
}

/** A report as it is written: `crates/report` holds this file to it. */
export const written: Schemas["Document"] = JSON.parse(readFileSync(new URL("document.json", import.meta.url), "utf8"));
const nobody: Schemas["Section"] = {
  title: "In short",
  pieces: [
    { kind: "heading", content: "Found" },
    { kind: "list", content: ["0 began."] },
  ],
  reference: false,
};
const standing = (taken: boolean): Schemas["Standing"] => ({
  summary: taken ? "41 began, 32 completed, 3 in progress, 1 left out by your rules, 31 judged." : "0 began.",
  judged: taken ? 31 : 0,
  unfinished: 0,
  repeated: [],
  pilots: 0,
  simulated: 0,
  with: [],
  flagged: taken ? [{ flag: "repeated_id", meaning: "the same id had begun the study before", sessions: 1, excludes: false }] : [],
  balance: { items: taken ? 5 : 0, doubled_places: 0, uneven: [] },
  balance_summary: taken ? "Of each item's judged answers the target came first in half, give or take the odd one." : "",
});
const excluded: Schemas["Excluded"][] = [
  {
    session_id: "01936d2e-5b1a-7c3e-9a53-0d4b1f2a6c11",
    reasons: [
      { reason: "too_fast", trials: 4, allowed: 1 },
      { reason: "straight_lining", trials: 5 },
    ],
    why: "4 answers too fast, 1 allowed; the same side in all 5 trials",
    is_completed: true,
  },
];

export const results =
  (stuff: Material): Results =>
  (path, query) => {
    if (path === "/api/v1/studies") {
      // Two pages of one study each: who reads only the first sees half.
      const at = Number(query.get("cursor") ?? 0);
      const page: Schemas["StudyList"] = { items: studies.slice(at, at + 1), next_cursor: at + 1 < studies.length ? String(at + 1) : null };
      return [200, page];
    }
    const [, id = "", rest = ""] = path.match(/^\/api\/v1\/studies\/([^/]+)\/versions(\/.+)?$/) ?? [];
    const found = studies.find((s) => s.id === id);
    if (found === undefined) return null;
    if (rest === "") {
      const page: Schemas["VersionList"] = { items: served[id] ?? [], next_cursor: null };
      return [200, page];
    }
    const [, asked = "", what] = rest.match(/^\/([^/]+)\/(.+)$/) ?? [];
    const choice = chosen(id, asked, query.get("with"));
    if (choice === null) return problem(404, "not_found", "There is no such version.");
    const taken = choice.participants.started > 0;
    const common = { study: id, title: found.title, ...choice, standing: standing(taken), stimuli: taken ? stimuliOf(stuff) : [] };
    if (what === "results") {
      const reply: Schemas["StudyResults"] = {
        ...common,
        display: "Pictures are made at 592 × 333 pixels.",
        downloads: [
          { size: [592, 333], bytes: 4_800_000, is_heavy: false },
          { size: [1008, 567], bytes: 13_900_000, is_heavy: true },
        ],
        excluded: taken ? excluded : [],
        blocks: [],
      };
      return [200, reply];
    }
    if (what === "document") {
      const subtitle = `Report of the study ${id}, version ${choice.version.slice(0, 12)}, by kelir 0.1.0`;
      const reply: Schemas["Document"] = { title: found.title, subtitle, sections: taken ? written.sections : [nobody] };
      return [200, reply];
    }
    return null;
  };
