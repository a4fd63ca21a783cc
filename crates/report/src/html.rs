//! The report as one page: no script, no network, light and dark, printable.

use crate::document::{Cell, Document, Piece, Row, Section, Table};

const STYLE: &str = concat!(include_str!("style.css"), include_str!("shared.css"));

/// Writes a document as one self-contained HTML file.
pub fn html(document: &Document) -> String {
    let sections: String = document.sections.iter().map(section).collect();
    let title = escaped(&document.title);
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <meta name=\"generator\" content=\"kelir\">\n<title>{title} · report</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main class=\"report\">\n\
         <header>\n<h1>{title}</h1>\n<p class=\"quiet\">{}</p>\n</header>\n{sections}</main>\n</body>\n</html>\n",
        escaped(&document.subtitle)
    )
}

fn section(section: &Section) -> String {
    let pieces: String = section.pieces.iter().map(piece).collect();
    format!("<section>\n<h2>{}</h2>\n{pieces}</section>\n", escaped(&section.title))
}

fn piece(piece: &Piece) -> String {
    match piece {
        Piece::Heading(heading) => format!("<h3>{}</h3>\n", escaped(heading)),
        Piece::Text(paragraph) => format!("<p>{}</p>\n", prose(paragraph)),
        Piece::Warning(warning) => format!("<p class=\"warning\" role=\"note\">{}</p>\n", escaped(warning)),
        Piece::List(items) => {
            let items: String = items.iter().map(|item| format!("<li>{}</li>\n", prose(item))).collect();
            format!("<ul>\n{items}</ul>\n")
        }
        Piece::Table(table) => table_of(table),
        // The one thing that is not escaped: SVG that kelir drew, its texts escaped by the drawing.
        Piece::Figure(figure) => {
            format!(
                "<figure>\n{}\n<figcaption>{}</figcaption>\n</figure>\n",
                figure.svg,
                escaped(&figure.caption)
            )
        }
    }
}

fn table_of(table: &Table) -> String {
    let class =
        |k: usize| if table.columns.get(k).is_some_and(|c| c.numeric) { " class=\"number\"" } else { "" };
    let head: String = table
        .columns
        .iter()
        .enumerate()
        .map(|(k, column)| format!("<th scope=\"col\"{}>{}</th>", class(k), escaped(&column.name)))
        .collect();
    let rows: String = table
        .rows
        .iter()
        .map(|row| match row {
            Row::Group(name) => {
                let span = table.columns.len();
                format!(
                    "<tr class=\"group\"><th scope=\"rowgroup\" colspan=\"{span}\">{}</th></tr>\n",
                    escaped(name)
                )
            }
            Row::Cells(cells) => {
                let cells: String = cells
                    .iter()
                    .enumerate()
                    .map(|(k, cell)| {
                        let name = table.columns.get(k).map(|c| c.name.as_str()).unwrap_or_default();
                        match k {
                            0 => format!("<th scope=\"row\">{}</th>", content(cell)),
                            _ if cell.shown.is_empty() => "<td class=\"none\"></td>".to_owned(),
                            _ => format!(
                                "<td{} data-name=\"{}\">{}</td>",
                                class(k),
                                escaped(name),
                                content(cell)
                            ),
                        }
                    })
                    .collect();
                format!("<tr>{cells}</tr>\n")
            }
        })
        .collect();
    let caption = if table.caption.is_empty() {
        String::new()
    } else {
        format!("<caption>{}</caption>\n", escaped(&table.caption))
    };
    format!("<table>\n{caption}<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table>\n")
}

fn content(cell: &Cell) -> String {
    let shown = escaped(&cell.shown);
    let shown = match &cell.exact {
        Some(exact) => format!("<data value=\"{}\">{shown}</data>", escaped(exact)),
        None => shown,
    };
    match &cell.note {
        Some(note) => format!("{shown}<span class=\"note\">{}</span>", escaped(note)),
        None => shown,
    }
}

/// A sentence, in which no line breaks within "p = 0.04" or "3 × 10⁻⁴".
fn prose(text: &str) -> String {
    escaped(text).replace(" = ", "\u{a0}=\u{a0}").replace(" × 10", "\u{a0}×\u{a0}10")
}

/// Text that HTML shows as it is, in elements and in quoted attributes.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // No character of HTML.
            c if c.is_control() && !matches!(c, '\n' | '\t') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_escaped_in_elements_and_attributes() {
        let evil = "\"><script>alert('1')</script>&\u{0}";
        let cell = Cell { shown: evil.into(), exact: Some(evil.into()), note: Some(evil.into()) };
        let table = Table::new(
            evil,
            &[evil, evil],
            vec![Row::Group(evil.into()), Row::Cells(vec![cell.clone(), cell])],
        );
        let pieces = vec![
            Piece::Heading(evil.into()),
            Piece::Text(evil.into()),
            Piece::Warning(evil.into()),
            Piece::List(vec![evil.into()]),
            Piece::Table(table),
        ];
        let document = Document {
            title: evil.into(),
            subtitle: evil.into(),
            sections: vec![Section::new(evil, pieces)],
        };
        let page = html(&document);
        assert!(!page.contains("<script") && !page.contains('\u{0}'), "{page}");
        assert_eq!(page.matches("&lt;script&gt;").count(), 19, "every text is there once, in every place");
        assert!(page.contains("&quot;&gt;"));
    }
}
