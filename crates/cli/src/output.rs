//! What goes to standard output.

use std::io::Write;
use std::path::PathBuf;

use anyhow::Result;
use clap::ValueEnum;
use kelir_render::file::{try_writing, write_atomic};
use kelir_report::{Terminator, csv_table};
use serde::Serialize;

/// How results are printed.
#[derive(clap::Args, Clone, Copy)]
pub(crate) struct Printed {
    /// Print one JSON document, in full precision.
    #[arg(long, conflicts_with = "format")]
    json: bool,
    #[arg(long, value_enum, default_value = "table")]
    format: Format,
}

impl Printed {
    /// The form asked for.
    pub(crate) fn form(self) -> Format {
        if self.json { Format::Json } else { self.format }
    }
}

/// A form of results.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Format {
    /// Aligned columns.
    Table,
    /// As `--json`.
    #[value(hide = true)]
    Json,
    /// Comma-separated, full precision, one header line.
    Csv,
}

/// `--json` of commands that take long and may also leave their figures in a file.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Figures {
    /// Print one JSON document in place of the text, in full precision; with FILE, write it there beside the text.
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-")]
    json: Option<PathBuf>,
}

impl Figures {
    /// Errors: a file that can't be written, told before the work.
    pub(crate) fn try_writing(&self) -> Result<()> {
        match &self.json {
            Some(path) if !self.printed() => Ok(try_writing(path)?),
            _ => Ok(()),
        }
    }

    /// Prints a text, unless the figures stand in its place.
    pub(crate) fn say(&self, text: &str) -> Result<()> {
        if self.printed() { Ok(()) } else { print(text) }
    }

    /// Prints what the figures were measured on; to standard error where a document stands in place of the text.
    pub(crate) fn note(&self, text: &str) -> Result<()> {
        if self.printed() {
            writeln!(std::io::stderr(), "{}", text.trim_start())?;
            return Ok(());
        }
        print(text)
    }

    /// Prints or writes the figures, if they are asked for.
    pub(crate) fn give(&self, figures: &impl Serialize) -> Result<()> {
        match &self.json {
            None => Ok(()),
            Some(_) if self.printed() => print_json(figures),
            Some(path) => {
                let text = serde_json::to_string_pretty(figures)?;
                Ok(write_atomic(path, text.as_bytes())?)
            }
        }
    }

    fn printed(&self) -> bool {
        self.json.as_ref().is_some_and(|path| path.as_os_str() == "-")
    }
}

/// Prints one JSON document.
pub(crate) fn print_json(document: &impl Serialize) -> Result<()> {
    print(&serde_json::to_string_pretty(document)?)
}

/// Prints a document and a final newline; a closed pipe (`kelir … | head`) is no failure.
pub(crate) fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match writeln!(out, "{}", text.trim_end()) {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        other => Ok(other?),
    }
}

/// Columns aligned: words to the left, numbers to the right.
pub(crate) fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        let cells = rows.iter().map(|row| row[column].chars().count());
        cells.chain([header[column].chars().count()]).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let numeric = |column: usize| {
        rows.iter().all(|row| row[column].parse::<f64>().is_ok() || matches!(row[column].as_str(), "–" | ""))
    };
    let numbers: Vec<bool> = (0..header.len()).map(numeric).collect();
    let line = |cells: &[String]| {
        let padded = cells.iter().zip(&widths).zip(&numbers).map(|((cell, width), number)| {
            if *number { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
        });
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    let head: Vec<String> = header.iter().map(|title| (*title).to_owned()).collect();
    let lines: Vec<String> = std::iter::once(line(&head)).chain(rows.iter().map(|row| line(row))).collect();
    lines.join("\n")
}

/// A header and rows as CSV.
pub(crate) fn csv(header: &[&str], rows: &[Vec<String>]) -> String {
    csv_table(Terminator::Any(b'\n'), header, rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_align_right_and_words_left() {
        let rows = [vec!["a".to_owned(), "1.5".to_owned()], vec!["bcd".to_owned(), "–".to_owned()]];
        assert_eq!(table(&["name", "t"], &rows), "name    t\na     1.5\nbcd     –");
    }

    #[test]
    fn csv_quotes_what_needs_it() {
        assert_eq!(csv(&["a"], &[vec!["x,\"y\"".to_owned()]]), "a\n\"x,\"\"y\"\"\"\n");
    }
}
