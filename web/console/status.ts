/** Whether participants can come, in words. */
import type { StudySummary } from "./api.ts";

/** A study's readiness, and what may be wrong with it; null when participants can come and nothing is to be said. */
export function statusText({ status, progress, reason, warnings }: StudySummary): string | null {
  if (status === "failed") return `Nobody can take part: ${reason ?? "the server's log says why"}.`;
  if (status === "ready") return warnings.length === 0 ? null : `Participants can come. This may be a mistake: ${warnings.join(" ")}`;
  const far = progress ? `: ${progress.done} of ${progress.total} ready` : "";
  return `The stimuli are being made${far}. Participants who come now are asked to wait.`;
}
