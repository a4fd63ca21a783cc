/** One study: who took part, what they chose, what they were shown. */
import { h } from "../shared/dom.ts";
import { clockTime, count, fixed } from "../shared/format.ts";
import { isTemporary, Refused } from "../shared/http.ts";
import { addressOf, fetchReport, fetchResults, fetchStudies, fetchVersions, makeLink, type Report, type Results, type Selection, type StudySummary, type StudyVersion } from "./api.ts";
import { copyButton, number } from "./copy.ts";
import { layOut, nameOf } from "./document.ts";
import { gallery } from "./gallery.ts";
import { statusText } from "./status.ts";
import { pooledBanner, selectionOf, short, VersionList } from "./versions.ts";

/** Between two looks at the server, ms. */
const POLL_MS = 5000;

export interface Asked {
  id: string;
  /** Which versions: see `selectionOf`. */
  search: URLSearchParams;
  /** Goes to another page of the console. */
  go(address: string): void;
  signal: AbortSignal;
}

/** What there is to see; no results where no version was ever ready. */
interface Seen {
  summary: StudySummary | undefined;
  versions: StudyVersion[];
  selection: Selection;
  results: Results | null;
}

/** A version that the address names and the study hasn't got. */
export class UnknownVersion extends Error {}

/** Shows a study in `root` and keeps it current until `signal` aborts. Rejects when the first look fails. */
export async function showStudy(root: HTMLElement, { id, search, go, signal }: Asked): Promise<void> {
  const sections = new Map<string, { shown: string; element: HTMLElement }>();
  const updated = h("p", { class: "updated", role: "status" });
  const body = h("div", { class: "study" });

  /** Draws a section again only when its data have changed, so that a refresh disturbs nobody. */
  const section = (name: string, data: unknown, draw: () => Array<Node | string>, into: Element = body) => {
    const shown = JSON.stringify(data);
    const known = sections.get(name);
    if (known?.shown === shown) return known.element;
    const element = known?.element ?? into.appendChild(h("section", { class: name, id: name }));
    element.replaceChildren(...draw());
    sections.set(name, { shown, element });
    return element;
  };

  // The report resamples participants, which takes the server a while: it is asked for only when something has changed, and once at a time.
  const contents = h("nav", { class: "contents", "aria-label": "On this page" });
  const report = h("div", { class: "report" }, h("p", { class: "quiet", role: "status" }, "Resampling participants; this takes a moment."));
  let judged = "";
  let judging = false;
  let list: VersionList | null = null;
  const judge = async (selection: Selection, results: Results) => {
    const answers = JSON.stringify(results);
    if (judging || answers === judged) return;
    judging = true;
    try {
      const found = await fetchReport(selection);
      if (signal.aborted) return;
      const first = judged === "";
      judged = answers;
      write(found);
      if (first) document.getElementById(decodeURIComponent(location.hash.slice(1)))?.scrollIntoView();
    } catch (error) {
      // Asked for again at the next look; what is there stays.
      if (judged === "") report.replaceChildren(h("p", { class: "empty" }, `The report could not be made: ${error instanceof Error ? error.message : error} It is asked for again in a moment.`));
    } finally {
      judging = false;
    }
  };
  const write = ({ subtitle, sections: parts }: Report) => {
    const about = section("report-about", subtitle, () => [h("p", { class: "quiet" }, subtitle)], report);
    const drawn = [about, ...parts.map((part) => section(nameOf(part), part, () => layOut(part), report))];
    const inOrder = drawn.length === report.children.length && drawn.every((element, i) => report.children[i] === element);
    if (!inOrder) report.replaceChildren(...drawn);
    const links = contentsOf(body);
    const named = (nodes: Iterable<Node>) => Array.from(nodes, ({ textContent }) => textContent).join("\n");
    if (named(links) !== named(contents.children)) contents.replaceChildren(...links);
  };

  const draw = ({ summary, versions, selection, results }: Seen) => {
    const title = results?.title ?? summary?.title ?? id;
    document.title = `${title} (${id}) · kelir`;
    const status = summary === undefined ? null : statusText(summary);
    section("head", [title, results?.version, results?.other_versions], () => head(id, title, results));
    section("status", [status, results?.pooled, results?.different_stimuli], () => [
      ...(status === null ? [] : [h("p", { class: "banner", role: "status" }, status)]),
      ...(results === null ? [] : pooledBanner(results, versions)),
    ]);
    section(
      "versions",
      versions.map(({ version, is_current }) => [version, is_current]),
      () => {
        list = new VersionList(selection, versions, go);
        return versions.length < 2 ? [] : [h("h2", {}, "Versions"), list.element];
      },
    );
    list?.recount(versions);
    section("participants", [results?.participants], () => participants(results));
    if (results !== null) {
      const { stimuli, different_stimuli, display, downloads } = results;
      if (!report.isConnected) body.append(contents, report);
      void judge(selection, results);
      section("stimuli", [stimuli, different_stimuli, display, downloads], () => [
        h("h2", {}, "Stimuli"),
        h("p", { class: "quiet", "data-testid": "display" }, display),
        ...downloaded(downloads),
        ...(stimuli.length > 0 ? gallery(stimuli, different_stimuli) : [h("p", { class: "empty" }, "None are made yet. The server makes them when it starts.")]),
      ]);
      section("data", [results.version, selection.pooled], () => data({ ...selection, version: results.version }));
    }
    updated.textContent = `Updated ${clockTime(new Date())}`;
    updated.classList.remove("stale");
  };

  const look = () => see(id, search);
  draw(await look());
  if (signal.aborted) return;
  root.replaceChildren(updated, body);

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

/** Looks at the server: the study's versions, and the results of those that the address names. */
async function see(id: string, search: URLSearchParams): Promise<Seen> {
  const [studies, versions] = await Promise.all([fetchStudies(), fetchVersions(id)]);
  const selection = selectionOf(id, search, versions);
  if ("unknown" in selection) throw new UnknownVersion(selection.unknown);
  try {
    return { summary: studies.find((row) => row.id === id), versions, selection, results: await fetchResults(selection) };
  } catch (error) {
    if (versions.length > 0 || !(error instanceof Refused) || isTemporary(error)) throw error;
    return { summary: studies.find((row) => row.id === id), versions, selection, results: null };
  }
}

function head(id: string, title: string, results: Results | null): Node[] {
  const others = (results?.other_versions ?? []).reduce((sum, version) => sum + version.sessions, 0);
  return [
    h("h1", { tabindex: -1 }, title),
    h("p", { class: "quiet" }, id, ...(results === null ? [] : [" · version ", number(short(results.version), results.version)])),
    ...(others > 0 ? [h("p", { class: "quiet" }, `${count(others, "session")} of other versions of this study ${others === 1 ? "is" : "are"} stored too and left out here.`)] : []),
    invitation(id),
    rehearsal(id),
  ];
}

/** The participants' link: the one thing that moves a study on. */
function invitation(study: string): HTMLElement {
  const address = `${location.origin}/study/${encodeURIComponent(study)}`;
  return h(
    "p",
    { class: "invitation" },
    h("a", { href: address, target: "_blank", rel: "noopener" }, address),
    copyButton("Copy the participants' link", () => address, { class: "primary" }),
  );
}

/** Trying a study without spoiling it. Colleagues who do not sign in need a signed link. */
function rehearsal(study: string): HTMLElement {
  const preview = h("a", { href: `/study/${encodeURIComponent(study)}?preview`, target: "_blank", rel: "noopener", "data-testid": "preview" }, "Preview");
  const made = h("span", { role: "status" });
  const link = (visit: "pilot" | "preview", label: string) => {
    const make = async () => {
      try {
        const { path, expires_at_s } = await makeLink(study, visit);
        const address = `${location.origin}${path}`;
        made.replaceChildren(
          h("code", {}, address),
          " ",
          copyButton("Copy it", () => address),
          ` Good until ${new Date(expires_at_s * 1000).toLocaleString("en")}.`,
        );
      } catch {
        made.textContent = "The link could not be made. Please try again.";
      }
    };
    return h("button", { type: "button", "data-testid": `${visit}-link`, onclick: () => void make() }, label);
  };
  return h(
    "p",
    { class: "quiet rehearsal" },
    "Try it: ",
    preview,
    " (nothing is stored), or make a ",
    link("pilot", "Pilot link"),
    " (stored, left out of every analysis) or a ",
    link("preview", "Preview link"),
    " for somebody who does not sign in. ",
    made,
  );
}

/** How many take part just now. Who of them is judged, and why not, the report says. */
function participants(results: Results | null): Node[] {
  const { started, in_progress, completed } = results?.participants ?? { started: 0, in_progress: 0, completed: 0 };
  const figure = (n: number, label: string, testid: string) => h("div", { class: "figure" }, h("strong", { "data-testid": testid }, number(n.toLocaleString("en"), n)), h("span", {}, label));
  const begin = "Send people the link above; to try the study yourself, use Preview.";
  return [
    h(
      "div",
      { class: "figures" },
      figure(completed, "completed", "participants-completed"),
      figure(in_progress, "in progress", "participants-in-progress"),
      figure(started, "started", "participants-started"),
    ),
    ...(started === 0 ? [h("p", { class: "empty" }, begin)] : []),
  ];
}

/** Links to the parts of the page. */
function contentsOf(body: Element): Node[] {
  const headings = [...body.querySelectorAll("section[id] > h2")];
  return headings.map((heading) => h("a", { href: `#${encodeURIComponent(heading.parentElement?.id ?? "")}` }, heading.textContent));
}

/** What participants download, and what can be done where that is much. */
function downloaded(downloads: Results["downloads"]): Node[] {
  if (downloads.length === 0) return [];
  const several = downloads.length > 1;
  const each = downloads.flatMap(({ size, bytes }, i) => [i > 0 ? " or " : "", number(`${fixed(bytes / 1e6, 1)} MB`, bytes), ...(several ? [` (${size.join(" × ")})`] : [])]);
  const heavy = downloads.filter(({ is_heavy }) => is_heavy).map(({ size }) => size.join(" × "));
  const advice = `${several ? `At ${heavy.join(" and ")} that` : "That"} takes more than half a minute on a slow line (1.6 Mbit/s). Pixels are bytes: fewer items, shorter films or fewer frames a second help${several ? ", and so does leaving a size out" : ""}.`;
  return [h("p", { class: "quiet", "data-testid": "downloads" }, "A participant downloads ", ...each, several ? ", by the size that fits the window. " : ". ", heavy.length > 0 ? advice : "")];
}

/** Files of exactly what the page shows, whatever is served later. */
function data(selection: Selection): Node[] {
  const { study, version, pooled } = selection;
  const name = `${study}-${short(version)}${pooled.length > 0 ? "-pooled" : ""}`;
  const file = (ending: Parameters<typeof addressOf>[1], text: string) => h("a", { href: addressOf(selection, ending), download: `${name}-${ending}` }, text);
  return [
    h("h2", {}, "Report and data"),
    h(
      "p",
      {},
      file("report.html", "Download report (HTML)"),
      ": everything on this page and the methods, in one file that prints well. ",
      file("report.md", "Download report (Markdown)"),
      ": the same for a repository or a paper.",
    ),
    h(
      "p",
      {},
      file("responses.csv", "Responses (CSV)"),
      ": one row a trial, as it was stored. ",
      file("codebook.csv", "Codebook (CSV)"),
      ": what each column means. ",
      file("pairs.csv", "Pairs (CSV)"),
      ": the choices as pwcmp reads them. ",
      file("events.csv", "Events (CSV)"),
      ": lost focus, resizes, inputs that did not count (",
      file("events_codebook.csv", "codebook"),
      ").",
    ),
    h("p", {}, file("participants.csv", "Participants (CSV)"), ": one row a session, with codes, times and browsers. ", file("participants_codebook.csv", "Codebook of participants (CSV)"), "."),
    h(
      "p",
      {},
      file("export.xlsx", "All tables (Excel)"),
      ": for a spreadsheet, in any language. The CSV files are for R, Python and other programs; a spreadsheet set to a decimal comma misreads their numbers.",
    ),
    h(
      "p",
      { class: "quiet" },
      "The same of the current version from the command line: ",
      h("code", {}, `kelir stats ${study} --format csv`),
      ", ",
      h("code", {}, `kelir report ${study} -o report.html`),
    ),
  ];
}
