//! One row a number, for a spreadsheet or R.

use crate::{Sample, StudyReport, numbers};
use ::csv::{Terminator, WriterBuilder};

/// Columns of [`csv`](fn@csv).
const HEADER: [&str; 11] =
    ["sample", "block", "analysis", "statistic", "value", "low", "high", "level", "p", "n", "note"];

/// Every number in full precision, one a row, with a header line; RFC 4180 with `\n` after each line.
///
/// `sample` is `screened`, or `everybody` for the same with the excluded; `block` is empty for what is of the whole study.
pub fn csv(report: &StudyReport) -> String {
    let rows = numbers(report).into_iter().map(|number| {
        // An end beyond everything is no number: its note says so.
        let exact = |x: Option<f64>| x.filter(|x| x.is_finite()).map_or_else(String::new, |x| x.to_string());
        let sample = match number.sample {
            Sample::Screened => "screened",
            Sample::Everybody => "everybody",
        };
        [
            sample.to_owned(),
            number.block,
            number.analysis.to_owned(),
            number.statistic,
            exact(number.value),
            exact(number.interval.map(|i| i.low)),
            exact(number.interval.map(|i| i.high)),
            exact(number.interval.map(|i| i.level)),
            exact(number.p),
            number.n.map_or_else(String::new, |n| n.to_string()),
            number.note,
        ]
    });
    csv_table(Terminator::Any(b'\n'), HEADER, rows)
}

/// What a spreadsheet takes for the beginning of a formula; those in full width (＝＋－＠) are read like the plain ones in East Asian settings.
const FORMULAS: [char; 11] =
    ['=', '+', '-', '@', '\t', '\r', '\n', '\u{ff1d}', '\u{ff0b}', '\u{ff0d}', '\u{ff20}'];

/// What parts cells besides a comma: a spreadsheet whose decimals have one reads tables so, quotes or not.
const PARTS: [char; 2] = [';', '\t'];

/// Any table that kelir writes as CSV: cells quoted where needed (RFC 4180), `end` after each line, and no formula for a spreadsheet.
pub fn csv_table(
    end: Terminator,
    header: impl IntoIterator<Item: AsRef<str>>,
    rows: impl IntoIterator<Item: IntoIterator<Item: AsRef<str>>>,
) -> String {
    const IN_MEMORY: &str = "memory takes every row";
    let mut out = WriterBuilder::new().flexible(true).terminator(end).from_writer(Vec::new());
    out.write_record(header.into_iter().map(|text| cell(text.as_ref()))).expect(IN_MEMORY);
    for row in rows {
        out.write_record(row.into_iter().map(|text| cell(text.as_ref()))).expect(IN_MEMORY);
    }
    String::from_utf8(out.into_inner().expect(IN_MEMORY)).expect("cells are text")
}

/// A text in which nothing is hidden: characters that control (but for `kept`), or that turn the direction of what is around them, stand as their
/// numbers.
pub fn visible(text: &str, kept: &[char]) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        let is_none = matches!(c, '\u{fffe}' | '\u{ffff}');
        if (c.is_control() || turns || is_none) && !kept.contains(&c) {
            shown.push_str(&format!("⟨U+{:04X}⟩", u32::from(c)));
        } else {
            shown.push(c);
        }
    }
    shown
}

/// What a cell of CSV may hold, quoted.
const WHITE: [char; 3] = ['\t', '\r', '\n'];

/// A cell in which nothing is hidden and that is no formula.
fn cell(text: &str) -> String {
    no_formula(&visible(text, &WHITE))
}

/// A cell whose text a spreadsheet would take for a formula gets an apostrophe before it, behind a semicolon or tab too.
fn no_formula(cell: &str) -> String {
    let is_number = cell.parse().is_ok_and(f64::is_finite) && cell.starts_with('-');
    let mut shown = String::with_capacity(cell.len());
    for (at, part) in cell.split_inclusive(PARTS).enumerate() {
        if part.starts_with(FORMULAS) && !(at == 0 && is_number) {
            shown.push('\'');
        }
        shown.push_str(part);
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quoted(cell: &str) -> String {
        let table = csv_table(Terminator::Any(b'\n'), ["a"], [[cell]]);
        table.strip_prefix("a\n").and_then(|rest| rest.strip_suffix('\n')).expect("two lines").to_owned()
    }

    #[test]
    fn cells_are_quoted_and_no_formula_gets_through() {
        assert_eq!(quoted("a,\"b\""), "\"a,\"\"b\"\"\"");
        assert_eq!(quoted("=1+1"), "'=1+1");
        assert_eq!(quoted("-2+cmd"), "'-2+cmd");
        assert_eq!(quoted("-1.5e-3"), "-1.5e-3");
        for formula in ["＝1+1", "＋1", "－1", "＠SUM(A1)", "+1", "@x", "\tx", "-cmd", "-"] {
            assert_eq!(quoted(formula), format!("'{formula}"));
        }
        for word in ["-inf", "-nan", "-infinity"] {
            assert_eq!(quoted(word), format!("'{word}"), "no number, but a name to a spreadsheet");
        }
        assert_eq!(quoted("\n=1"), "\"'\n=1\"");
        assert_eq!(
            quoted("a;=1+1;-2;b"),
            "a;'=1+1;'-2;b",
            "where decimals have a comma, a semicolon parts cells"
        );
        assert_eq!(quoted("a\t@x"), "a\t'@x");
        assert_eq!(quoted("one; =two"), "one; =two");
        assert_eq!(quoted("\r=1"), "\"'\r=1\"");
        assert_eq!(quoted("a＝b"), "a＝b");
        assert_eq!(quoted("a\0b\u{202e}c\u{1b}[31m"), "a⟨U+0000⟩b⟨U+202E⟩c⟨U+001B⟩[31m");
        assert_eq!(quoted("\u{202e}=1"), "⟨U+202E⟩=1");
    }
}
