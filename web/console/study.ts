/** One study: who took part, what they chose, what they were shown. */
import { h } from "../shared/dom.ts";
import { clockTime, count, fixed, pValue } from "../shared/format.ts";
import { isTemporary, Refused } from "../shared/http.ts";
import { type Block, csvAddress, fetchPaper, fetchReport, fetchResults, fetchStudies, type Participants, reportAddress, type Results, type StudyRow } from "./api.ts";
import { copyButton, number, tableText } from "./copy.ts";
import { gallery } from "./gallery.ts";
import { drawPaper, PAPER_STUDY } from "./paper.ts";
import { choiceDistribution } from "./plots.ts";
import { drawReport } from "./report.ts";

/** Between two looks at the server, ms. */
const POLL_MS = 5000;

/** Shows a study in `root` and keeps it current until `signal` aborts. Rejects when the first look fails. */
export async function showStudy(root: HTMLElement, id: string, signal: AbortSignal): Promise<void> {
  const sections = new Map<string, { shown: string; element: HTMLElement }>();
  const updated = h("p", { class: "updated", role: "status" });
  const body = h("div", { class: "study" });

  /** Draws a section again only when its data have changed, so that a refresh disturbs nobody. */
  const section = (name: string, data: unknown, draw: () => Array<Node | string>) => {
    const shown = JSON.stringify(data);
    const known = sections.get(name);
    if (known?.shown === shown) return;
    const element = known?.element ?? body.appendChild(h("section", { class: name }));
    element.replaceChildren(...draw());
    sections.set(name, { shown, element });
  };

  // The full report resamples participants, which takes the server a while: it is asked for only when answers have come.
  const report = h("section", { class: "report" }, h("h2", {}, "Beyond the t-test"), h("p", { class: "quiet" }, "Resampling participants; this takes a moment."));
  let judged = "";
  const judge = (results: Results) => {
    const answers = JSON.stringify([results.blocks, results.stimuli]);
    if (answers === judged) return;
    judged = answers;
    if (!report.isConnected) body.append(report);
    fetchReport(id).then(
      (found) => !signal.aborted && report.replaceChildren(...drawReport(found, Math.min(760, Math.max(280, body.clientWidth)))),
      (error: unknown) => {
        if (signal.aborted) return;
        judged = "";
        // A server without this route still has the paper's test.
        if (error instanceof Refused && error.status === 404) report.remove();
      },
    );
  };

  const look = () => Promise.all([fetchResults(id), fetchStudies()]);
  const draw = ([results, studies]: [Results, StudyRow[]]) => {
    document.title = `${results.title} · kelir`;
    section("head", [results.title, results.config_hash, results.other_versions], () => head(results));
    section("status", studies.find((row) => row.id === id)?.detail ?? null, () => status(studies.find((row) => row.id === id)));
    section("participants", results.participants, () => participants(results.participants, id));
    section("choices", [results.blocks, results.scale], () => choices(results.blocks, results.scale ?? null));
    judge(results);
    section("stimuli", results.stimuli, () => [h("h2", {}, "Stimuli"), ...(results.stimuli.length > 0 ? gallery(results.stimuli) : [h("p", { class: "empty" }, "None are made yet. The server makes them when it starts.")])]);
    section("data", id, () => data(id));
    updated.textContent = `Updated ${clockTime(new Date())}`;
    updated.classList.remove("stale");
  };

  draw(await look());
  if (signal.aborted) return;
  root.replaceChildren(updated, body);
  if (id === PAPER_STUDY) {
    const paper = h("section", { class: "paper" });
    fetchPaper().then(
      (found) => {
        paper.replaceChildren(...drawPaper(found));
        body.lastElementChild?.before(paper);
      },
      () => undefined, // a server without this route
    );
  }

  const refresh = async () => {
    if (document.hidden || signal.aborted) return;
    try {
      const seen = await look();
      if (!signal.aborted) draw(seen);
    } catch (error) {
      if (signal.aborted) return;
      if (!isTemporary(error)) return location.reload();
      const since = updated.textContent?.replace(/^Updated /, "") ?? "";
      if (!updated.classList.contains("stale")) updated.textContent = `The server doesn't answer. These are the numbers of ${since}; it is asked again every ${POLL_MS / 1000} seconds.`;
      updated.classList.add("stale");
    }
  };
  const timer = setInterval(() => void refresh(), POLL_MS);
  document.addEventListener("visibilitychange", () => void refresh(), { signal });
  signal.addEventListener("abort", () => clearInterval(timer));
}

function head({ title, study, config_hash, other_versions }: Results): Node[] {
  const others = (other_versions ?? []).reduce((sum, version) => sum + version.sessions, 0);
  return [
    h("h1", { tabindex: -1 }, title),
    h("p", { class: "quiet" }, `${study} · version `, number(config_hash.slice(0, 12), config_hash)),
    ...(others > 0 ? [h("p", { class: "quiet" }, `${count(others, "session")} of other versions of this study ${others === 1 ? "is" : "are"} stored too and left out here.`)] : []),
    invitation(study),
  ];
}

/** Says what keeps participants out, if anything does. */
function status(row: StudyRow | undefined): Node[] {
  const text = statusText(row);
  return text === null ? [] : [h("p", { class: "banner", role: "status" }, text)];
}

/** A study's readiness in words; null when participants can come. */
export function statusText(row: StudyRow | undefined): string | null {
  if (row?.status === "failed") return `The stimuli could not be made, so nobody can take part: ${typeof row.detail === "string" ? row.detail : "the server's log says why"}.`;
  if (row?.status !== "preparing") return null;
  const detail = row.detail;
  const far = detail !== null && typeof detail === "object" ? `: ${detail.done} of ${detail.total} ready` : "";
  return `The stimuli are being made${far}. Participants who come now are asked to wait.`;
}

/** The participants' link: the one thing that moves a study on. */
function invitation(study: string): HTMLElement {
  const address = `${location.origin}/study/${encodeURIComponent(study)}`;
  return h("p", { class: "invitation" }, h("a", { href: address, target: "_blank", rel: "noopener" }, address), copyButton("Copy the participants' link", () => address, { class: "primary" }));
}

function participants({ started, in_progress, completed }: Participants, id: string): Node[] {
  const figure = (n: number, label: string, testid: string) => h("div", { class: "figure" }, h("strong", { "data-testid": testid }, number(n.toLocaleString("en"), n)), h("span", {}, label));
  const left = Math.max(0, started - in_progress - completed);
  const heading = h("h2", {}, "Participants");
  if (started === 0) {
    return [heading, h("p", { class: "empty" }, `Nobody has taken part yet. Send people the link above, or open it yourself to try the study: /study/${id}.`)];
  }
  return [
    heading,
    h("div", { class: "figures" }, figure(completed, "completed", "participants-completed"), figure(in_progress, "in progress", "participants-in-progress"), figure(started, "started", "participants-started")),
    ...(left > 0 ? [h("p", { class: "quiet" }, `${count(left, "participant")} left before the end.`)] : []),
  ];
}

/** The conditions' positions in words, best first: they are there at once, where the report takes its time. */
function positions(scale: NonNullable<Results["scale"]>): HTMLElement {
  const best = scale.conditions.map((name, i) => ({ name, jod: scale.jod[i] ?? 0 })).sort((a, b) => b.jod - a.jod);
  const shown = best.flatMap(({ name, jod }, i) => [i > 0 ? ", " : "", `${name} `, number(fixed(jod, 2), jod)]);
  return h("p", { "data-testid": "scale" }, "All conditions on one scale, in JOD: ", ...shown, ".");
}

function choices(blocks: readonly Block[], scale: NonNullable<Results["scale"]> | null): Node[] {
  const table = resultsTable(blocks);
  return [
    h("h2", {}, "Choices"),
    h("div", { class: "plots" }, ...blocks.map(blockFigure)),
    h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table of choices" }, table),
    h("p", { class: "quiet" }, "Number of choices of the target per participant, over those who answered every pair of the block. Two-tailed one-sample t-test against chance, half the pairs. ", copyButton("Copy the table", () => tableText(table), { class: "link" })),
    ...(scale === null ? [] : [positions(scale)]),
  ];
}

function blockFigure(block: Block): HTMLElement {
  const [first, second] = block.conditions;
  const what = `${first} against ${second}, ${count(block.items, "pair")} of ${block.kind === "still" ? "stills" : "animations"}`;
  const plot =
    block.n > 0
      ? choiceDistribution(block)
      : h("p", { class: "empty" }, (block.incomplete ?? 0) > 0 ? "Nobody has answered every pair of this block yet." : "No answers yet. The plot appears with the first participant who answers this block.");
  return h("figure", { class: "block" }, h("figcaption", {}, h("strong", {}, block.title), h("span", { class: "quiet" }, what)), plot);
}

function resultsTable(blocks: readonly Block[]): HTMLTableElement {
  const heads = ["Block", "Target", "n", "Mean", "SD", "Chance", "t", "df", "p"];
  const row = (block: Block) => {
    const cell = (text: string, exact: number | null) => h("td", {}, number(text, exact));
    const hooks = { "data-testid": `block-${block.id}`, "data-n": block.n, "data-mean": block.mean, "data-sd": block.sd, "data-t": block.t, "data-df": block.df, "data-p": block.p };
    return h(
      "tr",
      hooks,
      h("th", { scope: "row" }, block.title, ...(block.note ? [h("span", { class: "note" }, block.note)] : [])),
      h("td", { class: "word" }, block.target),
      cell(String(block.n), block.n),
      cell(fixed(block.mean, 3), block.mean),
      cell(fixed(block.sd, 3), block.sd),
      cell(fixed(block.mu, 1), block.mu),
      cell(fixed(block.t, 3), block.t),
      cell(block.df === null ? "–" : String(block.df), block.df),
      cell(pValue(block.p), block.p),
    );
  };
  const head = h("thead", {}, h("tr", {}, ...heads.map((name, i) => h("th", { scope: "col", class: i < 2 ? "word" : null }, name))));
  return h("table", {}, head, h("tbody", {}, ...blocks.map(row)));
}

function data(id: string): Node[] {
  const link = (file: "responses" | "codebook" | "pairs", text: string) => h("a", { href: csvAddress(id, file), download: `${id}-${file}.csv` }, text);
  const report = (ending: "html" | "md", text: string) => h("a", { href: reportAddress(id, ending), download: `${id}-report.${ending}` }, text);
  return [
    h("h2", {}, "Report and data"),
    h("p", {}, report("html", "Download report (HTML)"), ": everything on this page and the methods, in one file that prints well. ", report("md", "Download report (Markdown)"), ": the same for a repository or a paper."),
    h("p", {}, link("responses", "Responses (CSV)"), ": one row a trial, as it was stored. ", link("codebook", "Codebook (CSV)"), ": what each column means. ", link("pairs", "Pairs (CSV)"), ": the choices as pwcmp reads them."),
    h("p", { class: "quiet" }, "The same from the command line: ", h("code", {}, `kelir stats ${id} --format csv`), ", ", h("code", {}, `kelir report ${id} -o report.html`)),
  ];
}
