/** The participant's half of the HTTP interface; its types are the server's own document. */
import type { components } from "../api/schema.ts";
import { request } from "../shared/http.ts";

export type Schemas = components["schemas"];
export type Study = Schemas["Study"];
export type State = Schemas["SessionState"];
export type Trial = Schemas["Trial"];
export type StimulusRef = Schemas["StimulusRef"];
export type Acknowledgement = Schemas["Acknowledgement"];
export type Completion = Schemas["Completion"];
/** What is sent for one trial, as its kind asks; times in ms. */
export type Answer = Schemas["Answer"];

/** Who is asking: the session and its secret. */
export interface Credentials {
  session_id: string;
  token: string;
}

const v1 = "/api/v1";
const session = (id: string) => `${v1}/sessions/${encodeURIComponent(id)}`;

export const fetchStudy = (study: string) => request<Study>(`${v1}/studies/${encodeURIComponent(study)}`);

export const createSession = (study: string, body: Schemas["NewSession"]) =>
  request<Schemas["CreatedSession"]>(`${v1}/studies/${encodeURIComponent(study)}/sessions`, { method: "POST", body });

export const fetchState = (who: Credentials) => request<State>(session(who.session_id), { token: who.token });

export const giveConsent = (who: Credentials) => request<State>(`${session(who.session_id)}/consent`, { method: "POST", token: who.token });

/** Sends the JSON of an answer; `known` trials of the plan are known here, and those decided since come back. */
export const putAnswer = (who: Credentials, trialIndex: number, text: string, known?: number) =>
  request<Acknowledgement>(`${session(who.session_id)}/trials/${trialIndex}${known === undefined ? "" : `?known=${known}`}`, { method: "PUT", token: who.token, text, keepalive: true });

export const complete = (who: Credentials) => request<Completion>(`${session(who.session_id)}/completion`, { method: "POST", token: who.token });
