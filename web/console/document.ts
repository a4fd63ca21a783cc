/** A report as the server writes it, laid out: every heading, word, number and figure is the document's own. */
import { h } from "../shared/dom.ts";
import type { Section, Table } from "./api.ts";
import { copyButton, number, tableText } from "./copy.ts";
import { drawing } from "./drawing.ts";

type Piece = Section["pieces"][number];
type Row = Table["rows"][number];
type Cell = Extract<Row, { kind: "cells" }>["content"][number];

/** A section's name in addresses and on the page. */
export const nameOf = ({ title }: Pick<Section, "title">): string => `report-${title.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-")}`;

/** A section under its heading; one of sentences alone can be copied whole, as methods are. */
export function layOut({ title, pieces }: Section): Node[] {
  const prose = pieces.every(({ kind }) => kind !== "table" && kind !== "figure" && kind !== "warning");
  const words = () => pieces.map(inWords).join("\n\n");
  return [h("h2", {}, title), ...pieces.flatMap((piece) => laid(piece, title)), ...(prose ? [h("p", {}, copyButton("Copy the text", words, { class: "link" }))] : [])];
}

function laid(piece: Piece, where: string): Node[] {
  switch (piece.kind) {
    case "heading":
      return [h("h3", {}, piece.content)];
    case "text":
      return [h("p", {}, piece.content)];
    case "warning":
      return [h("p", { class: "banner", role: "note" }, piece.content)];
    case "list":
      return [h("ul", {}, ...piece.content.map((item) => h("li", {}, item)))];
    case "table":
      return laidTable(piece.content, where);
    case "figure": {
      const { caption, svg } = piece.content;
      const figure = drawing(svg) ?? h("p", { class: "empty" }, "This figure can't be shown here. The downloaded report has it.");
      return [h("figure", {}, scrolling(`Figure: ${caption}`, figure), h("figcaption", { class: "quiet" }, caption))];
    }
  }
}

const inWords = (piece: Piece): string => (piece.kind === "list" ? piece.content.join("\n") : typeof piece.content === "string" ? piece.content : "");

/** What may be wider than a phone scrolls by itself, by keyboard too; a group and no region, or each table were a landmark. */
const scrolling = (label: string, content: Element) => h("div", { class: "scroll", tabindex: 0, role: "group", "aria-label": label }, content);

function laidTable({ caption, columns, rows }: Table, where: string): Node[] {
  const word = (column: number) => (columns[column]?.numeric === true ? null : "word");
  const cell = (of: Cell, column: number) =>
    column === 0 ? h("th", { scope: "row" }, ...content(of)) : h("td", { class: of.shown === "" ? "none" : word(column), "data-name": of.shown === "" ? null : columns[column]?.name }, ...content(of));
  const line = (row: Row) => (row.kind === "group" ? h("tr", { class: "group" }, h("th", { scope: "rowgroup", colspan: columns.length }, row.content)) : h("tr", {}, ...row.content.map(cell)));
  const table = h(
    "table",
    {},
    caption !== "" && h("caption", {}, caption),
    h("thead", {}, h("tr", {}, ...columns.map(({ name }, column) => h("th", { scope: "col", class: column === 0 ? "word" : word(column) }, name)))),
    h("tbody", {}, ...rows.map(line)),
  );
  return [
    scrolling(`Table: ${caption || where}`, table),
    h(
      "p",
      {},
      copyButton("Copy the table", () => tableText(table), { class: "link" }),
    ),
  ];
}

/** What a cell shows, with the number behind it to copy. */
const content = ({ shown, exact, note }: Cell): Node[] => [
  ...(typeof exact === "string" ? [number(shown, exact)] : [document.createTextNode(shown)]),
  ...(typeof note === "string" ? [h("span", { class: "note" }, note)] : []),
];
