/** The researcher's half of the HTTP interface; its types are the server's own document. */
import type { components } from "../api/schema.ts";
import { request } from "../shared/http.ts";

type Schemas = components["schemas"];
export type Participants = Schemas["Participants"];
export type StudySummary = Schemas["StudySummary"];
export type StudyVersion = Schemas["StudyVersion"];
export type Results = Schemas["StudyResults"];
export type Report = Schemas["StudyReport"];
/** A block's choices of the target per participant, and the paper's test of them. */
export type Block = Schemas["BlockSummary"];
export type BlockReport = Schemas["BlockReport"];
export type Stimulus = Schemas["Stimulus"];
export type Interval = Schemas["Interval"];
export type Proportion = Schemas["Proportion"];
export type Coefficient = Schemas["Coefficient"];
/** The paper's tests, computed again. */
export type Paper = Schemas["Replication"];
export type Comparison = Schemas["Comparison"];

const v1 = "/api/v1";

export const login = (password: string) => request<void>(`${v1}/auth/session`, { method: "POST", body: { password } satisfies Schemas["SignIn"] });
export const logout = () => request<void>(`${v1}/auth/session`, { method: "DELETE" });
export const fetchPaper = () => request<Paper>(`${v1}/papers/taylor-cameron`);
/** What is damaged of all that the server stores. */
export const fetchIntegrity = () => request<Schemas["IntegrityReport"]>(`${v1}/integrity`);
export const fetchStudies = () => all<StudySummary>(`${v1}/studies`);
export const fetchVersions = (study: string) => all<StudyVersion>(`${v1}/studies/${encodeURIComponent(study)}/versions`);

/** A link by which who has it tries a study. */
export const makeLink = (study: string, visit: Schemas["Trying"]) =>
  request<Schemas["Link"]>(`${v1}/studies/${encodeURIComponent(study)}/links`, { method: "POST", body: { visit } satisfies Schemas["NewLink"] });

/** Whose answers are meant: one version of a study, and the versions whose answers are pooled with its. */
export interface Selection {
  study: string;
  /** A version's whole hash, or `current`. */
  version: string;
  /** Whole hashes. */
  pooled: readonly string[];
}

type Ending =
  | "results"
  | "report"
  | "report.html"
  | "report.md"
  | "responses.csv"
  | "pairs.csv"
  | "codebook.csv"
  | "participants.csv"
  | "participants_codebook.csv"
  | "events.csv"
  | "events_codebook.csv"
  | "export.xlsx";

/** Where something of a selection is. */
export function addressOf({ study, version, pooled }: Selection, ending: Ending): string {
  const query = pooled.length === 0 ? "" : `?with=${pooled.map(encodeURIComponent).join(",")}`;
  return `${v1}/studies/${encodeURIComponent(study)}/versions/${encodeURIComponent(version)}/${ending}${query}`;
}

export const fetchResults = (selection: Selection) => request<Results>(addressOf(selection, "results"));
export const fetchReport = (selection: Selection) => request<Report>(addressOf(selection, "report"), { timeoutMs: 120_000 });

/** A list's items, page by page. */
async function all<Item>(address: string): Promise<Item[]> {
  const items: Item[] = [];
  for (let cursor: string | null = null; ; ) {
    const page: Page<Item> = await request(cursor === null ? address : `${address}?cursor=${encodeURIComponent(cursor)}`);
    items.push(...page.items);
    cursor = page.next_cursor;
    if (cursor === null) return items;
  }
}

/** Any of the server's lists. */
type Page<Item> = Omit<Schemas["StudyList"], "items"> & { items: Item[] };
