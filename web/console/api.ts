/** The researcher's half of the HTTP interface; its types are the server's own document. */
import type { components } from "../api/schema.ts";
import { request } from "../shared/http.ts";

type Schemas = components["schemas"];
export type Participants = Schemas["Participants"];
export type StudySummary = Schemas["StudySummary"];
export type StudyVersion = Schemas["StudyVersion"];
export type Results = Schemas["StudyResults"];
/** A report as it is written. */
export type Report = Schemas["Document"];
export type Section = Schemas["Section"];
export type Table = Schemas["Table"];
export type Stimulus = Schemas["Stimulus"];

const v1 = "/api/v1";

export const login = (password: string) => request<void>(`${v1}/auth/session`, { method: "POST", body: { password } satisfies Schemas["SignIn"] });
export const logout = () => request<void>(`${v1}/auth/session`, { method: "DELETE" });
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
  | "document"
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
export const fetchReport = (selection: Selection) => request<Report>(addressOf(selection, "document"), { timeoutMs: 120_000 });

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
