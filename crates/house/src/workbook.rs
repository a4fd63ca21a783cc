//! Tables as a spreadsheet (.xlsx): numbers are numbers whatever the reader's language, texts are texts and nothing else.

use crate::table::{Table, codebook_of};
use kelir_report::visible;
use kelir_study::schema::Column;
use rust_xlsxwriter::{DocProperties, ExcelDateTime, Format, Workbook, Worksheet, XlsxError};

/// Rows of a sheet, its header among them; what goes beyond stands in a further sheet.
const MOST_ROWS: usize = 1_048_576;
/// Characters of a cell.
const MOST_CHARACTERS: usize = 32_767;

/// The tables as a file, a sheet each, and a sheet that says what their columns are. The same tables give the same bytes.
///
/// # Errors
/// The file cannot be put together.
pub fn workbook(tables: &[Table]) -> Result<Vec<u8>, XlsxError> {
    with_most_rows(tables, MOST_ROWS)
}

fn with_most_rows(tables: &[Table], most_rows: usize) -> Result<Vec<u8>, XlsxError> {
    let mut workbook = Workbook::new();
    // The time of writing would make each file another.
    let epoch = ExcelDateTime::from_ymd(1980, 1, 1)?;
    workbook.set_properties(&DocProperties::new().set_creation_datetime(&epoch));
    for table in tables.iter().chain([&codebook(tables)]) {
        // A table without rows is a sheet with its header.
        let parts: Vec<&[Vec<String>]> = match table.rows.len() {
            0 => vec![&[]],
            _ => table.rows.chunks(most_rows - 1).collect(),
        };
        for (part, rows) in (1..).zip(parts) {
            let name = if part == 1 { table.name.to_owned() } else { format!("{} {part}", table.name) };
            let sheet = workbook.add_worksheet();
            sheet.set_name(name)?.set_freeze_panes(1, 0)?;
            write(sheet, &table.columns, rows)?;
        }
    }
    workbook.save_to_buffer()
}

/// What every column of the tables is, under the name of its table.
fn codebook(tables: &[Table]) -> Table {
    let mut all = codebook_of(&[]);
    let meaning = "Sheet that the column is in.".to_owned();
    all.columns.insert(0, Column { name: "table".to_owned(), meaning, ..all.columns[0].clone() });
    for table in tables {
        let rows = codebook_of(&table.columns).rows.into_iter();
        all.rows.extend(rows.map(|row| std::iter::once(table.name.to_owned()).chain(row).collect()));
    }
    all
}

fn write(sheet: &mut Worksheet, columns: &[Column], rows: &[Vec<String>]) -> Result<(), XlsxError> {
    let bold = Format::new().set_bold();
    for (at, column) in (0..).zip(columns) {
        sheet.write_string_with_format(0, at, plain(&column.name), &bold)?;
    }
    for (line, row) in (1..).zip(rows) {
        for ((at, cell), column) in (0..).zip(row).zip(columns) {
            let number = match column.kind.as_str() {
                "number" | "integer" => cell.parse().ok().filter(|x: &f64| x.is_finite()),
                _ => None,
            };
            match (number, cell.is_empty()) {
                (_, true) => {}
                (Some(x), _) => drop(sheet.write_number(line, at, x)?),
                (None, _) => drop(sheet.write_string(line, at, plain(cell))?),
            }
        }
    }
    Ok(())
}

/// A text in which nothing is hidden, as long as a cell may be.
fn plain(text: &str) -> String {
    let shown = visible(text, &[]);
    match shown.char_indices().nth(MOST_CHARACTERS) {
        Some(_) => shown.chars().take(MOST_CHARACTERS - 1).chain(['…']).collect(),
        None => shown,
    }
}

#[cfg(test)]
mod tests;
