/** Trying a study: what the link makes of this visit, and the ribbon that says so. */
import { h } from "../shared/dom.ts";
import { fetchVisit, type VisitKind } from "./api.ts";
import { persist } from "./notice.ts";
import { action } from "./pages.ts";
import { words } from "./words/index.ts";

/** A link that asks for nothing of the kind needs no question to the server. */
export async function visitOf(study: string): Promise<VisitKind> {
  const search = new URLSearchParams(location.search);
  if (!search.has("preview") && !search.has("pilot")) return "participant";
  // The language is the page's own, and no part of a signed link.
  search.delete("lang");
  return (await persist(() => fetchVisit(study, `?${search}`))).visit;
}

/** Says on every page that nobody takes part here; a preview begins again with a reload, for nothing is kept. */
export function showRibbon(visit: VisitKind): void {
  if (visit === "participant") return;
  const restart = visit === "preview" ? [action(words("trying-restart"), () => location.reload())] : [];
  document.documentElement.dataset.trying = visit;
  document.body.append(h("aside", { id: "ribbon", "data-testid": "ribbon" }, h("span", {}, words(visit === "preview" ? "trying-preview" : "trying-pilot")), ...restart));
}
