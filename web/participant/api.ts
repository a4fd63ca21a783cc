/** The participant's half of the HTTP interface. */
import { request } from "../shared/http.ts";

/** What a study says of itself before anybody takes part. */
export interface Study {
  id: string;
  title: string;
  question: string;
  /** Linear luminance of the grey around the pictures, 0 to 1. */
  surround: number;
  size: [number, number];
  texts: Record<"welcome" | "consent" | "instructions" | "debriefing" | "thanks", string[]>;
  estimated_minutes: number;
}

/** The bytes of one stimulus: where they are and what they hash to. */
export interface StimulusRef {
  sha256: string;
  url: string;
}

export interface Trial {
  trial_index: number;
  block_id: string;
  block_index: number;
  pair_index: number;
  kind: "still" | "animation";
  left: StimulusRef;
  right: StimulusRef;
  /** Stimulus pixels. */
  width: number;
  height: number;
  answered: boolean;
}

export interface State {
  session_id: string;
  study_id: string;
  status: "consent" | "in_progress" | "completed";
  consented: boolean;
  trials: Trial[];
  next_trial: number | null;
  completion_code?: string | null;
  redirect?: string | null;
}

export interface Completion {
  completion_code: string;
  redirect?: string | null;
}

/** What is sent for one trial; times in ms. */
export interface Answer {
  choice: "left" | "right";
  /** From the first painted frame to the choice. */
  rt: number;
  /** `performance.now()` of the first painted frame. */
  onset: number;
  [column: string]: unknown;
}

/** Who is asking: the session and its secret. */
export interface Credentials {
  session_id: string;
  token: string;
}

const v1 = "/api/v1";
const session = (id: string) => `${v1}/sessions/${encodeURIComponent(id)}`;

export const fetchStudy = (study: string) => request<Study>(`${v1}/studies/${encodeURIComponent(study)}`);

export const createSession = (study: string, body: { params: Record<string, string>; display: Record<string, unknown> }) =>
  request<State & { token: string }>(`${v1}/studies/${encodeURIComponent(study)}/sessions`, { method: "POST", body });

export const fetchState = (who: Credentials) => request<State>(session(who.session_id), { token: who.token });

export const giveConsent = (who: Credentials) =>
  request<State>(`${session(who.session_id)}/consent`, { method: "POST", token: who.token });

export const putAnswer = (who: Credentials, trialIndex: number, body: Answer) =>
  request<{ acknowledged: boolean; next_trial: number | null }>(`${session(who.session_id)}/trials/${trialIndex}`, {
    method: "PUT",
    token: who.token,
    body,
    keepalive: true,
  });

export const complete = (who: Credentials) =>
  request<Completion>(`${session(who.session_id)}/complete`, { method: "POST", token: who.token });
