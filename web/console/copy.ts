/** Every number can be copied as it is: in full precision, by a click on it or a table at a time. */
import { h } from "../shared/dom.ts";

/** A number as shown, with the one behind it. */
export function number(shown: string, exact: number | string | null | undefined): HTMLElement {
  const value = exact === null || exact === undefined ? null : String(exact);
  return value === null ? h("span", {}, shown) : h("data", { class: "copy", value, title: `${value} (click to copy)` }, shown);
}

/** A short text that is copied by its button. */
export function copyButton(label: string, text: () => string, attributes: Record<string, string> = {}): HTMLButtonElement {
  const button = h("button", { type: "button", ...attributes }, label);
  button.addEventListener("click", () => void copy(text(), button));
  return button;
}

/** Tab-separated text of a table, numbers in full precision: what a spreadsheet or R reads. */
export function tableText(table: HTMLTableElement): string {
  const cell = (td: HTMLTableCellElement) => {
    const exact = [...td.querySelectorAll<HTMLDataElement>("data.copy")].map((data) => data.value);
    const words = [...td.childNodes].map((node) => (node instanceof Element && node.classList.contains("note") ? ` (${node.textContent})` : node.textContent));
    return exact.length > 0 ? exact.join(" ") : words.join("").trim();
  };
  return [...table.rows].map((row) => [...row.cells].map(cell).join("\t")).join("\n");
}

/** Copies and says so in place, for a moment. */
async function copy(text: string, at: HTMLElement): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
    at.dataset.copied = "copied";
  } catch {
    at.dataset.copied = "not copied: select it and copy by hand";
  }
  setTimeout(() => delete at.dataset.copied, 1200);
}

/** Makes every `number` on the page copy itself when clicked, unless the click ends a selection. */
export function copyOnClick(): void {
  document.addEventListener("click", (event) => {
    const data = event.target instanceof Element ? event.target.closest<HTMLDataElement>("data.copy") : null;
    if (data !== null && getSelection()?.isCollapsed !== false) void copy(data.value, data);
  });
}
