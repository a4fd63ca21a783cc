/** One way to talk to the server: JSON in, JSON out, and errors that say whether trying again can help. */
import type { components } from "../api/schema.ts";

type Problem = components["schemas"]["Problem"];

/** The server answered, and the answer is no. */
export class Refused extends Error {
  readonly status: number;
  /** `snake_case` code of the server's problem document, or `http_<status>`. */
  readonly code: string;
  /** Milliseconds the server asked us to wait, if it did. */
  readonly retryAfterMs: number | null;

  constructor(status: number, code: string, message: string, retryAfterMs: number | null = null) {
    super(message);
    this.status = status;
    this.code = code;
    this.retryAfterMs = retryAfterMs;
  }

  /** Whether something between us and the server said no, such as a proxy: it does not know what the server would say. */
  get foreign(): boolean {
    return this.code.startsWith("http_");
  }
}

/** Something said yes that is not our server, such as the sign-in page of a hotel's network. */
export class Foreign extends Error {}

/** Whether the same request may succeed later: no answer at all, one that is not the server's, a timeout, too many requests, or the server's fault. */
export function isTemporary(error: unknown): boolean {
  return !(error instanceof Refused) || error.foreign || error.status === 408 || error.status === 429 || error.status >= 500;
}

/** Most bytes that a request may have which outlives its page: browsers take 64 KiB of all of these together, and refuse the rest like a lost line. */
const KEEPALIVE_BYTES = 16 << 10;

export interface Options {
  method?: "GET" | "POST" | "PUT" | "DELETE";
  token?: string | undefined;
  /** Sent as JSON. */
  body?: unknown;
  /** JSON that is written already: sent to the byte. */
  text?: string;
  /** Lets the request outlive the page. */
  keepalive?: boolean;
  timeoutMs?: number;
  /** More headers. */
  headers?: Record<string, string>;
}

/** Sends a request and reads the JSON of a 2xx answer (`undefined` when it has no body); throws `Refused`, `Foreign` or a network error. */
export async function request<T>(path: string, options: Options = {}): Promise<T> {
  const abort = new AbortController();
  const timer = setTimeout(() => abort.abort(new Error("no answer in time")), options.timeoutMs ?? 15_000);
  const body = options.body === undefined ? options.text : JSON.stringify(options.body);
  try {
    const response = await fetch(path, {
      method: options.method ?? "GET",
      headers: {
        accept: "application/json, application/problem+json",
        ...(options.token === undefined ? {} : { authorization: `Bearer ${options.token}` }),
        ...(body === undefined ? {} : { "content-type": "application/json" }),
        ...options.headers,
      },
      cache: "no-store",
      credentials: "same-origin",
      keepalive: options.keepalive === true && (body ?? "").length <= KEEPALIVE_BYTES,
      signal: abort.signal,
      ...(body === undefined ? {} : { body }),
    });
    const text = await response.text();
    if (response.ok) return (text === "" ? undefined : json(text)) as T;
    throw refusal(response.status, text, response.headers.get("retry-after"));
  } finally {
    clearTimeout(timer);
  }
}

function json(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch (error) {
    throw new Foreign("an answer that is no JSON", { cause: error });
  }
}

/** Reads the server's problem document; anything else (a proxy's page) keeps its status only. */
export function refusal(status: number, text: string, retryAfter: string | null): Refused {
  const seconds = retryAfter === null ? NaN : Number(retryAfter);
  const wait = Number.isFinite(seconds) && seconds >= 0 ? Math.min(seconds, 120) * 1000 : null;
  const problem = parsed(status, text);
  if (problem === null) return new Refused(status, `http_${status}`, `The server answered with status ${status}.`, wait);
  return new Refused(status, problem.code, explain(problem), wait);
}

/** What is read of a problem document: a later server's codes may be others than those that we know. */
type Read = Partial<Omit<Problem, "code">> & { code: string };

/** A problem document of ours has a code and says the answer's status; what firewalls and gateways say in JSON does not. */
function parsed(status: number, text: string): Read | null {
  try {
    const found: unknown = JSON.parse(text);
    const isProblem = typeof found === "object" && found !== null && "code" in found && "status" in found && found.status === status;
    return isProblem && typeof found.code === "string" ? { ...found, code: found.code, status } : null;
  } catch {
    return null;
  }
}

/** What went wrong, then each field: "/rt = -1: must be …". */
function explain({ code, title, detail, errors }: Read): string {
  const fields = (Array.isArray(errors) ? errors : []).map(({ pointer, rule, ...rest }) => `${pointer}${"value" in rest ? ` = ${JSON.stringify(rest.value)}` : ""}: ${rule}.`);
  return [detail ?? title ?? code, ...fields].join(" ");
}
