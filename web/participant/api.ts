/** The participant's half of the HTTP interface; its types are the server's own document. */
import type { components } from "../api/schema.ts";
import { Foreign, type Options, Refused, request } from "../shared/http.ts";

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
/** A preview is no session: it has its own addresses, where nothing is stored. */
const session = (id: string) => `${v1}/${id.startsWith("preview-") ? "previews" : "sessions"}/${encodeURIComponent(id)}`;

/** Asks, and takes only what can be the server's answer: it has all of `fields`. A yes without them is somebody else's. */
async function ask<T extends object>(path: string, fields: readonly (keyof T & string)[], options: Options = {}): Promise<T> {
  const answer: unknown = await request(path, options);
  const has = (field: string) => typeof answer === "object" && answer !== null && field in answer;
  if (!fields.every(has)) throw new Foreign(`an answer without ${fields.join(" and ")}`);
  return answer as T;
}

export const fetchStudy = (study: string) => ask<Study>(`${v1}/studies/${encodeURIComponent(study)}`, ["id", "texts", "trial_kinds"]);

/** What a link makes of a visit. */
export type VisitKind = Schemas["VisitKind"]["visit"];

export const fetchVisit = (study: string, search: string) => request<Schemas["VisitKind"]>(`${v1}/studies/${encodeURIComponent(study)}/visit${search}`);

/** Begins a session; asked again with the same key, the server knows that it is the same one. */
export const createSession = (study: string, body: Schemas["NewSession"], key: string) =>
  ask<Schemas["CreatedSession"]>(`${v1}/studies/${encodeURIComponent(study)}/sessions`, ["session_id", "token"], { method: "POST", body, headers: { "idempotency-key": key } });

/** Where a session stands; while answers are unsent here, its plan stays. */
export const fetchState = (who: Credentials, unsent: number) => ask<State>(`${session(who.session_id)}${unsent === 0 ? "" : `?unsent=${unsent}`}`, ["session_id", "trials"], { token: who.token });

export const giveConsent = (who: Credentials) => ask<State>(`${session(who.session_id)}/consent`, ["session_id", "trials"], { method: "POST", token: who.token });

/** The method by which answers get through. */
let method: "PUT" | "POST" = "PUT";

/** Sends the JSON of an answer to a trial of `plan`; `known` of its trials are known here, and those decided since come back. */
export async function putAnswer(who: Credentials, trialIndex: number, text: string, plan?: string, known?: number): Promise<Acknowledgement> {
  const query = String(new URLSearchParams({ ...(known === undefined ? {} : { known: String(known) }), ...(plan === undefined ? {} : { plan }) }));
  const path = `${session(who.session_id)}/trials/${trialIndex}${query === "" ? "" : `?${query}`}`;
  const send = () => ask<Acknowledgement>(path, ["acknowledged"], { method, token: who.token, text, keepalive: true });
  try {
    return await send();
  } catch (error) {
    if (!(error instanceof Refused) || !isAboutMethod(error)) throw error;
    method = method === "PUT" ? "POST" : "PUT";
    return send();
  }
}

/** Whether it may be the method that is not liked: some networks let no PUT pass. */
const isAboutMethod = ({ status, foreign }: Refused) => status === 405 || status === 501 || (status === 403 && foreign);

export const complete = (who: Credentials) => ask<Completion>(`${session(who.session_id)}/completion`, ["completion_code"], { method: "POST", token: who.token });
