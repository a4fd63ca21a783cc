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
const FORMULAS: [char; 10] = ['=', '+', '-', '@', '\t', '\r', '\u{ff1d}', '\u{ff0b}', '\u{ff0d}', '\u{ff20}'];

/// A cell of any table that kelir writes: text that a spreadsheet would take for a formula gets an apostrophe before it; quoted where needed
/// (RFC 4180).
pub fn csv_cell(cell: &str) -> String {
    let number = cell.parse::<f64>().is_ok() && cell.starts_with('-');
    let cell = if cell.starts_with(FORMULAS) && !number { format!("'{cell}") } else { cell.to_owned() };
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
        assert_eq!(quoted("\r=1"), "\"'\r=1\"");
        assert_eq!(quoted("a＝b"), "a＝b");
    }
}
