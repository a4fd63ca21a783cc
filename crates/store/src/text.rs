//! Stored texts as they stand, for whoever proves that nobody changed them.

use sqlx::Row;
use sqlx::sqlite::SqliteRow;
use std::borrow::Cow;

/// A stored text to the byte, for what was tampered with need not be UTF-8.
pub(crate) fn bytes<'a>(row: &'a SqliteRow, column: &str) -> Result<Option<&'a [u8]>, sqlx::Error> {
    row.try_get_unchecked(column)
}

/// A stored text, to compare with.
pub(crate) fn text<'a>(row: &'a SqliteRow, column: &str) -> Result<Cow<'a, str>, sqlx::Error> {
    Ok(String::from_utf8_lossy(bytes(row, column)?.unwrap_or_default()))
}
