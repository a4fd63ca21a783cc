/** One way to talk to the server: JSON in, JSON out, and errors that say whether trying again can help. */

/** The server answered, and the answer is no. */
export class Refused extends Error {
  readonly status: number;
  /** `snake_case` code of the server's error body, or `http_<status>`. */
  readonly code: string;
  /** Milliseconds the server asked us to wait, if it did. */
  readonly retryAfterMs: number | null;

  constructor(status: number, code: string, message: string, retryAfterMs: number | null = null) {
    super(message);
    this.status = status;
    this.code = code;
    this.retryAfterMs = retryAfterMs;
  }
}

/** Whether the same request may succeed later: no answer at all, a timeout, too many requests, or the server's fault. */
export function isTemporary(error: unknown): boolean {
  return !(error instanceof Refused) || error.status === 408 || error.status === 429 || error.status >= 500;
}

export interface Options {
  method?: "GET" | "POST" | "PUT";
  token?: string | undefined;
  body?: unknown;
  /** Lets the request outlive the page. */
  keepalive?: boolean;
  timeoutMs?: number;
}

/** Sends a request and reads the JSON of a 2xx answer (`undefined` when it has no body); throws `Refused` or a network error. */
export async function request<T>(path: string, options: Options = {}): Promise<T> {
  const abort = new AbortController();
  const timer = setTimeout(() => abort.abort(new Error("no answer in time")), options.timeoutMs ?? 15_000);
  try {
    const response = await fetch(path, {
      method: options.method ?? "GET",
      headers: {
        accept: "application/json",
        ...(options.token === undefined ? {} : { authorization: `Bearer ${options.token}` }),
        ...(options.body === undefined ? {} : { "content-type": "application/json" }),
      },
      cache: "no-store",
      credentials: "same-origin",
      keepalive: options.keepalive ?? false,
      signal: abort.signal,
      ...(options.body === undefined ? {} : { body: JSON.stringify(options.body) }),
    });
    const text = await response.text();
    if (response.ok) return (text === "" ? undefined : JSON.parse(text)) as T;
    throw refusal(response.status, text, response.headers.get("retry-after"));
  } finally {
    clearTimeout(timer);
  }
}

/** Reads the server's error body; anything else (a proxy's page) keeps its status only. */
export function refusal(status: number, text: string, retryAfter: string | null): Refused {
  const seconds = retryAfter === null ? NaN : Number(retryAfter);
  const wait = Number.isFinite(seconds) && seconds >= 0 ? Math.min(seconds, 120) * 1000 : null;
  try {
    const { error } = JSON.parse(text) as { error?: { code?: unknown; message?: unknown } };
    if (typeof error?.code === "string") return new Refused(status, error.code, String(error.message ?? error.code), wait);
  } catch {
    // not JSON
  }
  return new Refused(status, `http_${status}`, `The server answered with status ${status}.`, wait);
}
