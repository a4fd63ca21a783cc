//! The report for a terminal: 100 columns, no colours.

use crate::document::{Cell, Document, Piece, Row, Table};

/// Columns of the terminal that are used.
const WIDTH: usize = 100;

/// Writes a document as plain text, without its figures and without its reference sections (methods, hashes, literature).
pub fn text(document: &Document) -> String {
    let mut out = String::new();
    let mut say = |line: &str| {
        out.push_str(line.trim_end());
        out.push('\n');
    };
    for line in wrapped(&plain(&document.title), WIDTH, "") {
        say(&line);
    }
    for line in wrapped(&plain(&document.subtitle), WIDTH, "") {
        say(&line);
    }
    for section in document.sections.iter().filter(|section| !section.reference) {
        say("");
        let title = plain(&section.title);
        say(&title);
        say(&"─".repeat(title.chars().count().min(WIDTH)));
        for (k, piece) in section.pieces.iter().enumerate() {
            if k > 0 && !matches!(piece, Piece::Figure(_)) {
                say("");
            }
            match piece {
                Piece::Heading(heading) => say(&format!("{}:", plain(heading))),
                Piece::Text(paragraph) => wrapped(&plain(paragraph), WIDTH, "").iter().for_each(|l| say(l)),
                Piece::Warning(warning) => {
                    wrapped(&format!("! {}", plain(warning)), WIDTH, "  ").iter().for_each(|l| say(l))
                }
                Piece::List(items) => {
                    for item in items {
                        wrapped(&format!("• {}", plain(item)), WIDTH, "  ").iter().for_each(|l| say(l));
                    }
                }
                Piece::Table(table) => lines_of(table).iter().for_each(|l| say(l)),
                Piece::Figure(_) => {}
            }
        }
    }
    out
}

/// Without what could steer a terminal: a title from a study file may hold anything.
fn plain(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Lines of at most `width` characters, broken at spaces; lines after the first begin with `indent`.
fn wrapped(text: &str, width: usize, indent: &str) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let length = line.chars().count();
        if length > indent.chars().count() && length + 1 + word.chars().count() > width {
            lines.push(std::mem::replace(&mut line, indent.to_owned()));
        }
        if !line.is_empty() && !line.ends_with(' ') {
            line.push(' ');
        }
        line.push_str(word);
    }
    lines.push(line);
    lines
}

/// A table whose columns are aligned; the first column gives way when the rest needs the room.
fn lines_of(table: &Table) -> Vec<String> {
    let cells: Vec<&[Cell]> = table
        .rows
        .iter()
        .filter_map(|row| match row {
            Row::Cells(cells) => Some(cells.as_slice()),
            Row::Group(_) => None,
        })
        .collect();
    let length = |text: &str| text.chars().count();
    let mut widths: Vec<usize> = (0..table.columns.len())
        .map(|k| {
            let shown = cells.iter().filter_map(|row| row.get(k)).map(|cell| length(&plain(&cell.shown)));
            shown.chain([length(&plain(&table.columns[k].name))]).max().unwrap_or(0)
        })
        .collect();
    // Wide columns of words are wrapped, the widest first, until the line fits.
    let gaps = 2 * widths.len().saturating_sub(1);
    while widths.iter().sum::<usize>() + gaps > WIDTH {
        let words = (0..widths.len()).filter(|k| !table.columns[*k].numeric);
        let Some(widest) = words.max_by_key(|k| widths[*k]).filter(|k| widths[*k] > 12) else { break };
        widths[widest] -= 1;
    }
    let line = |texts: &[String]| -> Vec<String> {
        let columns: Vec<Vec<String>> = texts.iter().zip(&widths).map(|(t, w)| wrapped(t, *w, "")).collect();
        let height = columns.iter().map(Vec::len).max().unwrap_or(1);
        (0..height)
            .map(|row| {
                let padded =
                    columns.iter().zip(&widths).zip(&table.columns).map(|((lines, width), column)| {
                        let text = lines.get(row).map_or("", String::as_str);
                        if column.numeric { format!("{text:>width$}") } else { format!("{text:<width$}") }
                    });
                padded.collect::<Vec<_>>().join("  ")
            })
            .collect()
    };
    let mut lines = Vec::new();
    if !table.caption.is_empty() {
        lines.extend(wrapped(&plain(&table.caption), WIDTH, ""));
    }
    let names: Vec<String> = table.columns.iter().map(|c| plain(&c.name)).collect();
    lines.extend(line(&names));
    lines.push("─".repeat((widths.iter().sum::<usize>() + gaps).min(WIDTH)));
    for row in &table.rows {
        match row {
            Row::Group(name) => lines.push(format!("[{}]", plain(name))),
            Row::Cells(cells) => {
                lines.extend(line(&cells.iter().map(|cell| plain(&cell.shown)).collect::<Vec<_>>()));
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_at_spaces_and_long_words_stand_alone() {
        assert_eq!(wrapped("• one two three", 9, "  "), ["• one two", "  three"]);
        assert_eq!(wrapped("aaaaaaaaaaaa b", 4, ""), ["aaaaaaaaaaaa", "b"]);
        assert_eq!(plain("a\u{1b}[31mb\nc"), "a [31mb c");
    }

    #[test]
    fn a_wide_table_wraps_its_words_and_keeps_its_numbers_whole() {
        let row = |name: &str, number: &str| Row::Cells(vec![Cell::text(name), Cell::text(number)]);
        let rows = vec![Row::Group("group".into()), row(&"word ".repeat(40), "1.5"), row("b", "−12.25")];
        let lines = lines_of(&Table::new("", &["name", "value#"], rows));
        assert!(lines.iter().all(|line| line.chars().count() <= WIDTH), "{lines:#?}");
        assert!(lines.last().unwrap_or(&String::new()).ends_with("−12.25"), "{lines:#?}");
        assert!(lines.iter().any(|line| line.trim_end().ends_with("   1.5")), "{lines:#?}");
    }
}
