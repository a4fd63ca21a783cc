//! Tables of a study's data: columns that say what they are, and cells as text. CSV and spreadsheets are written from them.

use kelir_report::{Terminator, csv_table};
use kelir_study::schema::Column;

/// A table with what its columns are.
#[derive(Clone, Debug)]
pub struct Table {
    /// Its name, as of a file or a sheet.
    pub name: &'static str,
    /// Its columns, in order.
    pub columns: Vec<Column>,
    /// The cells of each row, one a column; empty: nothing.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// The table as CSV (RFC 4180), its header first.
    pub fn csv(&self) -> String {
        csv_table(Terminator::CRLF, self.columns.iter().map(|column| &column.name), &self.rows)
    }
}

/// What the columns of tables are, as a table: `column, type, unit, meaning, values`.
pub fn codebook_of(columns: &[Column]) -> Table {
    let text = |name: &str, meaning: &str| Column {
        name: name.to_owned(),
        kind: "text".to_owned(),
        unit: String::new(),
        meaning: meaning.to_owned(),
        values: Vec::new(),
    };
    let row = |column: &Column| {
        let values: Vec<String> =
            column.values.iter().map(|v| format!("{}: {}", v.value, v.meaning)).collect();
        let Column { name, kind, unit, meaning, .. } = column.clone();
        vec![name, kind, unit, meaning, values.join("; ")]
    };
    Table {
        name: "codebook",
        columns: vec![
            text("column", "Column of the table."),
            text("type", "What its cells are."),
            text("unit", "Unit of its numbers."),
            text("meaning", "What it says."),
            text("values", "The values that it can have, with their meanings."),
        ],
        rows: columns.iter().map(row).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_quoted_lines_end_with_crlf_and_no_formula_survives() {
        let column = Column {
            name: "=1+1".to_owned(),
            kind: "text".to_owned(),
            unit: String::new(),
            meaning: "a, \"b\"".to_owned(),
            values: Vec::new(),
        };
        assert_eq!(
            codebook_of(&[column]).csv(),
            "column,type,unit,meaning,values\r\n'=1+1,text,,\"a, \"\"b\"\"\",\r\n"
        );
    }
}
