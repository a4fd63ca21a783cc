/** Whether participants can come, in words. */
import type { StudySummary } from "./api.ts";

/** A study's readiness; null when participants can come. */
export function statusText({ status, progress, reason }: StudySummary): string | null {
  if (status === "failed") return `Nobody can take part: ${reason ?? "the server's log says why"}.`;
  if (status !== "preparing") return null;
  const far = progress ? `: ${progress.done} of ${progress.total} ready` : "";
  return `The stimuli are being made${far}. Participants who come now are asked to wait.`;
}
