/** The researcher's page: sign in, a list of studies, one study. Addresses are real: back, reload and links work. */
import { h } from "../shared/dom.ts";
import { Refused } from "../shared/http.ts";
import { fetchIntegrity, fetchStudies, login, logout, type StudySummary } from "./api.ts";
import { copyOnClick, number } from "./copy.ts";
import { statusText } from "./status.ts";
import { showStudy, UnknownVersion } from "./study.ts";
import "./style.css";

const main = h("main", {});
const header = h("header", {}, h("a", { class: "brand", href: "/console/studies" }, "kelir"));
document.body.append(header, main);

const signOut = h("button", { type: "button", class: "link", onclick: () => void leave() }, "Sign out");
const warning = h("aside", { class: "problem", role: "status", "aria-label": "Integrity" });
let shown = new AbortController();
/** The page that is shown, without its fragment. */
let page = "";
const asked = () => location.pathname + location.search;

/** Shows what the address says. */
async function show(): Promise<void> {
  shown.abort();
  shown = new AbortController();
  const { signal } = shown;
  page = asked();
  const path = location.pathname.replace(/\/+$/, "");
  const study = path.match(/^\/console\/studies\/([^/]+)$/)?.[1];
  try {
    if (study !== undefined) await showStudy(main, { id: decodeURIComponent(study), search: new URLSearchParams(location.search), go, signal });
    else if (path === "/console" || path === "/console/studies") await showStudies(path === "/console");
    else if (path === "/console/login") return go("/console", true);
    else message("There is no such page", "The studies are one step back.", link("/console/studies", "All studies"));
    if (!signedIn()) header.append(signOut);
    void warn().catch(() => undefined);
  } catch (error) {
    if (signal.aborted) return;
    if (error instanceof Refused && (error.status === 401 || error.status === 403)) return showLogin();
    if (error instanceof UnknownVersion) {
      return message("There is no such version of this study", `No version, or more than one, begins with ${error.message}.`, link(path, "The current version"));
    }
    if (error instanceof Refused && error.status === 404) {
      return message("There is no such study here", "It may have been renamed. Studies are files in the server's data folder.", link("/console/studies", "All studies"));
    }
    const again = h("button", { type: "button", class: "primary", onclick: () => void show() }, "Try again");
    message("The server doesn't answer as it should", error instanceof Error ? error.message : String(error), again);
  }
  main.querySelector<HTMLElement>("h1")?.focus({ preventScroll: true });
}

/** What the server found damaged, above every page. */
async function warn(): Promise<void> {
  const { faults } = await fetchIntegrity();
  warning.replaceChildren(...faults.map((fault) => h("p", {}, fault)));
  if (faults.length > 0) main.before(warning);
  else warning.remove();
}

const signedIn = () => header.contains(signOut);

/** Goes to another page of the console without loading anything anew. */
function go(path: string, replace = false): void {
  if (replace) history.replaceState(null, "", path);
  else history.pushState(null, "", path);
  scrollTo(0, 0);
  void show();
}

function link(path: string, text: string): HTMLAnchorElement {
  return h("a", { href: path }, text);
}

function message(heading: string, text: string, action: HTMLElement): void {
  document.title = `${heading} · kelir`;
  main.replaceChildren(h("section", { class: "message" }, h("h1", { tabindex: -1 }, heading), h("p", {}, text), h("p", {}, action)));
}

function showLogin(): void {
  document.title = "Sign in · kelir";
  signOut.remove();
  const field = h("input", { type: "password", id: "password", name: "password", autocomplete: "current-password", required: true, "data-testid": "login-password" });
  const problem = h("p", { class: "problem", role: "alert" });
  const submit = h("button", { class: "primary", "data-testid": "login-submit" }, "Sign in");
  const form = h(
    "form",
    { class: "login" },
    h("h1", {}, "Sign in"),
    h("label", { for: "password" }, "Researcher's password"),
    field,
    problem,
    submit,
    h("p", { class: "quiet" }, "Whoever started this server knows it: the terminal says how to sign in."),
  );
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    submit.disabled = true;
    problem.textContent = "";
    try {
      await login(field.value);
      await show();
    } catch (error) {
      problem.textContent = explain(error);
      field.select();
      field.focus();
    } finally {
      submit.disabled = false;
    }
  });
  main.replaceChildren(form);
  field.focus();
}

function explain(error: unknown): string {
  if (!(error instanceof Refused)) return "The server doesn't answer. Is it running?";
  if (error.status === 401 || error.status === 403) return "That is not the password. Please try again.";
  return error.message;
}

async function leave(): Promise<void> {
  shown.abort();
  await logout().catch(() => undefined);
  signOut.remove();
  showLogin();
}

/** The list; a list of one is its one study, when nobody asked for the list itself. */
async function showStudies(forward: boolean): Promise<void> {
  const studies = await fetchStudies();
  const [only] = studies;
  if (forward && only !== undefined && studies.length === 1) return go(address(only), true);
  document.title = "Studies · kelir";
  const row = (study: StudySummary) => {
    const { completed, in_progress, started } = study.participants;
    return h(
      "tr",
      {},
      h("th", { scope: "row" }, link(address(study), study.title), h("span", { class: "note" }, study.id), ...[statusText(study)].map((text) => text !== null && h("span", { class: "note" }, text))),
      ...[completed, in_progress, started].map((n) => h("td", {}, number(n.toLocaleString("en"), n))),
    );
  };
  const table = h(
    "table",
    {},
    h("thead", {}, h("tr", {}, h("th", { scope: "col", class: "word" }, "Study"), ...["Completed", "In progress", "Started"].map((name) => h("th", { scope: "col" }, name)))),
    h("tbody", {}, ...studies.map(row)),
  );
  const content =
    studies.length > 0
      ? h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Studies" }, table)
      : h("p", { class: "empty" }, "There is no study yet. Put a study file into the folder studies of the server's data folder, and start the server again.");
  main.replaceChildren(h("section", {}, h("h1", { tabindex: -1 }, "Studies"), content));
}

const address = (study: StudySummary) => `/console/studies/${encodeURIComponent(study.id)}`;

document.addEventListener("click", (event) => {
  const anchor = event.target instanceof Element ? event.target.closest("a") : null;
  const plain = event.button === 0 && !event.metaKey && !event.ctrlKey && !event.shiftKey && !event.altKey;
  if (anchor === null || !plain || anchor.target !== "" || anchor.hasAttribute("download")) return;
  if (anchor.origin !== location.origin || !/^\/console(\/|$)/.test(anchor.pathname)) return;
  // To a part of this page the browser goes by itself.
  if (anchor.hash !== "" && anchor.pathname + anchor.search === page) return;
  event.preventDefault();
  go(anchor.pathname + anchor.search + anchor.hash);
});
copyOnClick();
addEventListener("popstate", () => asked() !== page && void show());
void show();
