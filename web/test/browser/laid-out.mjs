// Holds the console's page of a study to the report's document; the end-to-end tests do so with a real server's.

/** What of a document is not on the page, in the section that it belongs to; run in the page. */
export function missing({ sections }) {
  const words = (node) => node.textContent.replace(/\s+/g, " ").trim();
  const texts = (section, selector) => [...section.querySelectorAll(selector)].map(words);
  const lacks = (where, kind, wanted, found) => (JSON.stringify(wanted) === JSON.stringify(found) ? [] : [`${where}: ${kind}: ${JSON.stringify(wanted)} is not ${JSON.stringify(found)}`]);
  const report = document.querySelector(".report");
  const drawn = [...report.querySelectorAll("section")].filter((section) => section.querySelector("h2") !== null);
  const plain = (text) => text.replace(/\s+/g, " ").trim();
  return [
    ...lacks(
      "document",
      "h2",
      sections.map(({ title }) => plain(title)),
      texts(report, "h2"),
    ),
    ...sections.flatMap(({ title, pieces }, i) => {
      const of = (...kinds) => pieces.filter(({ kind }) => kinds.includes(kind)).map(({ content }) => content);
      const [section, tables, figures] = [drawn[i] ?? report, of("table"), of("figure")];
      const cells = tables.flatMap(({ rows }) => rows.flatMap((row) => (row.kind === "group" ? [{ shown: row.content }] : row.content)));
      const svgs = [...section.querySelectorAll("figure svg")];
      return [
        ...lacks(title, "headings", of("heading").map(plain), texts(section, "h3")),
        ...lacks(title, "sentences", [...of("text", "warning"), ...of("list").flat()].map(plain), texts(section, ":scope > p:not(:has(button)), li")),
        ...lacks(title, "captions", tables.map(({ caption }) => plain(caption)).filter(Boolean), texts(section, "caption")),
        ...lacks(
          title,
          "columns",
          tables.flatMap(({ columns }) => columns.map(({ name }) => plain(name))),
          texts(section, "thead th"),
        ),
        ...lacks(
          title,
          "cells",
          cells.map(({ shown, note }) => plain(shown + (note ?? ""))),
          texts(section, "tbody :is(th, td)"),
        ),
        ...lacks(
          title,
          "exact values",
          cells.flatMap(({ exact }) => exact ?? []),
          [...section.querySelectorAll("data")].map((data) => data.value),
        ),
        ...lacks(
          title,
          "figures",
          figures.map(({ caption }) => plain(caption)),
          texts(section, "figcaption"),
        ),
        // Every text of the drawing, its title and description too, and as many marks.
        ...figures.flatMap(({ svg }, k) => {
          const kept = new DOMParser().parseFromString(svg, "image/svg+xml");
          return [
            ...lacks(title, "words of a figure", texts(kept, "title, desc, text"), svgs[k] === undefined ? [] : texts(svgs[k], "title, desc, text")),
            ...lacks(title, "marks of a figure", kept.querySelectorAll("path, circle, rect").length, svgs[k]?.querySelectorAll("path, circle, rect").length ?? 0),
          ];
        }),
      ];
    }),
  ];
}
