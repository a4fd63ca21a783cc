//! The report in Markdown, for a repository or pandoc.

use crate::document::{Cell, Document, Piece, Row, Table};
use base64::prelude::{BASE64_STANDARD, Engine};

/// Where a Markdown report has its figures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Figures {
    /// In the text itself, as data addresses: one file that stands alone.
    Embedded,
    /// Beside it, in the folder of this name.
    Folder(String),
}

/// A Markdown report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Markdown {
    /// The text.
    pub text: String,
    /// The figures that belong beside it: path relative to the text, and SVG. Empty where they are embedded.
    pub files: Vec<(String, String)>,
}

/// Writes a document as Markdown (CommonMark with GitHub's tables).
pub fn markdown(document: &Document, figures: &Figures) -> Markdown {
    let mut text = format!("# {}\n\n{}\n", escaped(&document.title), escaped(&document.subtitle));
    let mut files = Vec::new();
    for section in &document.sections {
        text.push_str(&format!("\n## {}\n", escaped(&section.title)));
        for piece in &section.pieces {
            text.push('\n');
            match piece {
                Piece::Heading(heading) => text.push_str(&format!("### {}\n", escaped(heading))),
                Piece::Text(paragraph) => text.push_str(&format!("{}\n", escaped(paragraph))),
                Piece::Warning(warning) => {
                    text.push_str(&format!("> **Read with care.** {}\n", escaped(warning)))
                }
                Piece::List(items) => {
                    for item in items {
                        text.push_str(&format!("- {}\n", escaped(item)));
                    }
                }
                Piece::Table(table) => text.push_str(&table_of(table)),
                Piece::Figure(figure) => {
                    let address = match figures {
                        Figures::Embedded => {
                            format!("data:image/svg+xml;base64,{}", BASE64_STANDARD.encode(&figure.svg))
                        }
                        Figures::Folder(folder) => {
                            let path = format!("{folder}/{}.svg", figure.name);
                            files.push((path.clone(), figure.svg.clone()));
                            path
                        }
                    };
                    let caption = escaped(&figure.caption);
                    text.push_str(&format!("![{caption}](<{address}>)\n\n*{caption}*\n"));
                }
            }
        }
    }
    Markdown { text, files }
}

fn table_of(table: &Table) -> String {
    let mut out = String::new();
    if !table.caption.is_empty() {
        out.push_str(&format!("{}\n\n", escaped(&table.caption)));
    }
    let mut line = |cells: Vec<String>| out.push_str(&format!("| {} |\n", cells.join(" | ")));
    line(table.columns.iter().map(|c| escaped(&c.name)).collect());
    line(table.columns.iter().map(|c| if c.numeric { "---:" } else { "---" }.to_owned()).collect());
    for row in &table.rows {
        match row {
            Row::Group(name) => {
                let rest = std::iter::repeat_n(String::new(), table.columns.len().saturating_sub(1));
                line(std::iter::once(format!("**{}**", escaped(name))).chain(rest).collect());
            }
            Row::Cells(cells) => line(cells.iter().map(cell_of).collect()),
        }
    }
    out
}

fn cell_of(cell: &Cell) -> String {
    match &cell.note {
        Some(note) => format!("{} ({})", escaped(&cell.shown), escaped(note)),
        None => escaped(&cell.shown),
    }
}

/// Text that Markdown shows as it is: no markup, no HTML, no table cell and no paragraph ends within it.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '\\' | '`' | '*' | '_' | '[' | ']' | '|' | '~' | '#' | '!' | '$' => {
                out.push('\\');
                out.push(c);
            }
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_in_a_text_is_markup() {
        assert_eq!(escaped("<script>| *a* [b](c)\n# d"), "&lt;script&gt;\\| \\*a\\* \\[b\\](c) \\# d");
    }
}
