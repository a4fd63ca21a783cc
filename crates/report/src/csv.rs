//! One row a number, for a spreadsheet or R.

use crate::{Sample, StudyReport, numbers};

/// Columns of [`csv`].
const HEADER: &str = "sample,block,analysis,statistic,value,low,high,level,p,n,note";

/// Every number in full precision, one a row, with a header line; RFC 4180 with `\n` between lines.
///
/// `sample` is `screened`, or `everybody` for the same with the excluded; `block` is empty for what is of the whole study.
pub fn csv(report: &StudyReport) -> String {
    let mut out = HEADER.to_owned();
    for number in numbers(report) {
        let exact = |x: Option<f64>| x.map_or_else(String::new, |x| x.to_string());
        let sample = match number.sample {
            Sample::Screened => "screened",
            Sample::Everybody => "everybody",
        };
        let cells = [
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
        ];
        out.push('\n');
        out.push_str(&cells.map(|cell| csv_cell(&cell)).join(","));
    }
    out
}

/// What a spreadsheet takes for the beginning of a formula; those in full width (＝＋－＠) are read like the plain ones in East Asian settings.
const FORMULAS: [char; 11] =
    ['=', '+', '-', '@', '\t', '\r', '\n', '\u{ff1d}', '\u{ff0b}', '\u{ff0d}', '\u{ff20}'];

/// What parts cells besides a comma: a spreadsheet whose decimals have one reads tables so, quotes or not.
const PARTS: [char; 2] = [';', '\t'];

/// A cell of any table that kelir writes: text that a spreadsheet would take for a formula gets an apostrophe before it, behind a semicolon or
/// tab too; quoted where needed (RFC 4180).
pub fn csv_cell(cell: &str) -> String {
    let is_number = cell.parse().is_ok_and(f64::is_finite) && cell.starts_with('-');
    let mut shown = String::with_capacity(cell.len());
    for (at, part) in cell.split_inclusive(PARTS).enumerate() {
        if part.starts_with(FORMULAS) && !(at == 0 && is_number) {
            shown.push('\'');
        }
        shown.push_str(part);
    }
    let cell = shown;
    if cell.contains([',', '"', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell }
}

#[cfg(test)]
mod tests {
    use super::csv_cell as quoted;

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
    }
}
