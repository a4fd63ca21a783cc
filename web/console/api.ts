/** The researcher's half of the HTTP interface. */
import { request } from "../shared/http.ts";

export interface Participants {
  started: number;
  in_progress: number;
  completed: number;
}

export interface StudyRow {
  id: string;
  title: string;
  participants: Participants;
  /** Whether participants can come, and if not, why. */
  status?: "ready" | "preparing" | "failed";
  /** Of `preparing` how far it is, of `failed` the reason. */
  detail?: { done: number; total: number; stimulus: string } | string | null;
}

/** A block's choices of the target per participant, and the two-tailed one-sample t-test against half the pairs. */
export interface Block {
  id: string;
  title: string;
  kind: "still" | "animation";
  conditions: [string, string];
  target: string;
  items: number;
  /** Participants who answered every pair of the block. */
  n: number;
  /** Participants who answered some, left out. */
  incomplete?: number;
  /** Number of target choices → number of participants. */
  counts: Record<string, number>;
  mean: number | null;
  sd: number | null;
  mu: number;
  t: number | null;
  df: number | null;
  p: number | null;
  note?: string | null;
}

/** Differences in units of the brightest unshadowed point. */
export interface Errors {
  count: number;
  bias: number;
  rmse: number;
  p999: number;
  max: number;
}

/** A stimulus's measured error against its reference. */
export interface Measured {
  reference: { technique: string; [knob: string]: unknown };
  frames: number[];
  all: Errors;
  penumbra: Errors;
  /** The reference's own standard error: what no measured error can go below. */
  floor: number | null;
}

/** Monte Carlo's own standard error, in the same units. */
export interface StandardError {
  rms_sampled: number;
  max: number;
}

export interface Stimulus {
  pair: string;
  condition: string;
  sha256: string;
  provenance: { technique?: string; error?: Measured | null; standard_error?: StandardError | null; [fact: string]: unknown };
}

export interface Results {
  study: string;
  title: string;
  config_hash: string;
  participants: Participants;
  blocks: Block[];
  stimuli: Stimulus[];
  /** All conditions on one axis, in JOD; null without three of them. The report has the intervals. */
  scale?: { conditions: string[]; jod: number[] } | null;
  /** Sessions of other versions of the study, which these results leave out. */
  other_versions?: Array<{ config_hash: string; sessions: number }>;
}

export interface Interval {
  low: number;
  high: number;
  level?: number;
}

/** A share of choices with Wilson's interval, and one from resampled participants where they made several choices each. */
export interface Proportion {
  chosen: number;
  trials: number;
  proportion: number;
  wilson: Interval;
  by_participant: Interval | null;
}

export interface Coefficient extends Interval {
  estimate: number;
  standard_error: number;
  p: number;
}

/** What is said of a block beside the paper's test; null where it is not defined, and then a note says why. */
export interface Analysis {
  effect: { d: number; d_interval: Interval; g: number; g_interval: Interval } | null;
  equivalence: Array<{ bounds: { points: number } | { sd: number }; p: number; interval_90: Interval }>;
  bayes: { bf01: number; bf10: number } | null;
  power: Array<{ n: number; d: number; alpha: number; power: number }>;
  detectable?: { d: number; power: number } | null;
  sign?: { n: number; successes: number; p: number } | null;
  wilcoxon?: { n: number; v: number; p: number } | null;
  binomial?: { n: number; successes: number; p: number } | null;
  proportion: Proportion | null;
  intraclass: { icc: number; design_effect: number } | null;
  robust_logit: { coefficients: Coefficient[] } | null;
  mixed_logit: { coefficients: Coefficient[]; sigma: number } | null;
  notes: string[];
}

export interface BlockReport extends Block {
  p_holm: number | null;
  analysis: Analysis;
  by_item: Array<{ id: string; target: Proportion | null }>;
  left: Proportion | null;
  rt_ms: { n: number; q1: number; median: number; q3: number } | null;
}

export interface Report {
  blocks: BlockReport[];
  blocks_with_excluded: BlockReport[] | null;
  excluded: Array<{ session_id: string; reasons: Array<{ reason: string; trials?: number; allowed?: number; answered?: number }> }>;
  scale: {
    conditions: Array<{ condition: string; jod: number; low: number; high: number }>;
    level: number;
    replicates: number;
    observers: number;
  } | null;
  scale_note: string | null;
  methods: string[];
  stimuli: Stimulus[];
  kelir_version: string;
  chain: { rows: number; head: string; broken: [number, string] | null };
}

/** One comparison of the paper, computed again. */
export interface Comparison {
  id: string;
  title: string;
  printed: { mean: number; sd: number; t: number };
  /** (choices of PA, participants). */
  counts: Array<[number, number]>;
  test: { n: number; mean: number; sd: number; mu: number; t: number; df: number; p: number };
  t_as_printed: boolean;
  p_holm: number;
  effect: { g: number; g_interval: Interval };
  equivalence_points: { p: number };
  equivalence_sd: { p: number };
  bayes: { bf01: number };
}

export interface Paper {
  comparisons: Comparison[];
  printed_t: { printed: number; participants: [number, number]; splits_with_this_t: unknown[] };
}

const admin = "/api/v1/admin/studies";

export const login = (password: string) => request<void>("/api/v1/login", { method: "POST", body: { password } });
export const logout = () => request<void>("/api/v1/logout", { method: "POST" });
export const fetchResults = (study: string) => request<Results>(`${admin}/${encodeURIComponent(study)}/results`);

export const fetchReport = (study: string) => request<Report>(`${admin}/${encodeURIComponent(study)}/report`, { timeoutMs: 120_000 });

export const fetchPaper = () => request<Paper>("/api/v1/admin/papers/taylor-cameron");

/** The list, however it is wrapped. */
export async function fetchStudies(): Promise<StudyRow[]> {
  const answer = await request<StudyRow[] | { studies: StudyRow[] }>(admin);
  return Array.isArray(answer) ? answer : answer.studies;
}

export const csvAddress = (study: string, file: "responses" | "codebook" | "pairs") => `${admin}/${encodeURIComponent(study)}/${file}.csv`;

export const reportAddress = (study: string, ending: "html" | "md") => `${admin}/${encodeURIComponent(study)}/report.${ending}`;
