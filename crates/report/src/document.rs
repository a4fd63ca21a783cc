//! A report as sections of paragraphs, tables and figures: what is said, whoever writes it down.

use serde::Serialize;
use utoipa::ToSchema;

/// A whole report. Every text in it is plain: writers escape.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Document {
    /// Over everything.
    pub title: String,
    /// Below the title: which study and version this is of.
    pub subtitle: String,
    /// From the top down.
    pub sections: Vec<Section>,
}

/// A part with a heading.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Section {
    /// Its heading.
    pub title: String,
    /// What stands in it.
    pub pieces: Vec<Piece>,
    /// For the page and the paper, not for the terminal.
    pub reference: bool,
}

/// Something in a section.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(tag = "kind", content = "content", rename_all = "snake_case")]
pub enum Piece {
    /// A heading below the section's.
    Heading(String),
    /// A paragraph.
    Text(String),
    /// Something that nobody must overlook.
    Warning(String),
    /// Sentences of equal rank.
    List(Vec<String>),
    /// Rows and columns.
    Table(Table),
    /// A picture.
    Figure(Figure),
}

/// Rows and columns.
#[derive(Clone, Debug, Default, PartialEq, Serialize, ToSchema)]
pub struct Table {
    /// What it holds.
    pub caption: String,
    /// Heads of the columns.
    pub columns: Vec<Column>,
    /// From the top down.
    pub rows: Vec<Row>,
}

/// The head of a column.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[schema(as = TableColumn)]
pub struct Column {
    /// What stands in it, with its unit.
    pub name: String,
    /// Whether it holds numbers, set to the right.
    pub numeric: bool,
}

/// A line of a table.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(tag = "kind", content = "content", rename_all = "snake_case")]
#[schema(as = TableRow)]
pub enum Row {
    /// A name for the rows that follow.
    Group(String),
    /// One cell a column.
    Cells(Vec<Cell>),
}

/// A place in a table.
#[derive(Clone, Debug, Default, PartialEq, Serialize, ToSchema)]
#[schema(as = TableCell)]
pub struct Cell {
    /// What is read.
    pub shown: String,
    /// The numbers behind it in full precision, space-separated; null where it is no number.
    pub exact: Option<String>,
    /// In smaller letters below; null for nothing.
    pub note: Option<String>,
}

/// A picture.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Figure {
    /// A name for a file, such as `choices`.
    pub name: String,
    /// What is seen, and what dots and lines are.
    pub caption: String,
    /// SVG with a title and a description: shapes and texts alone, no script, style, link or id; its ground is white.
    pub svg: String,
}

impl Document {
    /// Every figure, in order.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.sections.iter().flat_map(|s| &s.pieces).filter_map(|piece| match piece {
            Piece::Figure(figure) => Some(figure),
            _ => None,
        })
    }
}

/// The beginning of a hash, which tells versions apart.
pub(crate) fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

impl Section {
    pub(crate) fn new(title: impl Into<String>, pieces: Vec<Piece>) -> Section {
        Section { title: title.into(), pieces, reference: false }
    }

    pub(crate) fn reference(title: impl Into<String>, pieces: Vec<Piece>) -> Section {
        Section { reference: true, ..Section::new(title, pieces) }
    }
}

impl Table {
    /// A table whose columns are named; a name that ends in `#` is a column of numbers.
    pub(crate) fn new(caption: impl Into<String>, columns: &[&str], rows: Vec<Row>) -> Table {
        let column = |name: &&str| Column {
            name: name.trim_end_matches('#').to_owned(),
            numeric: name.ends_with('#'),
        };
        Table { caption: caption.into(), columns: columns.iter().map(column).collect(), rows }
    }
}

impl Cell {
    pub(crate) fn text(shown: impl Into<String>) -> Cell {
        Cell { shown: shown.into(), ..Cell::default() }
    }

    /// A number as shown, with the one behind it.
    pub(crate) fn number(shown: impl Into<String>, exact: f64) -> Cell {
        Cell { shown: shown.into(), exact: Some(exact.to_string()), note: None }
    }

    pub(crate) fn whole(n: u64) -> Cell {
        Cell { shown: n.to_string(), exact: Some(n.to_string()), note: None }
    }

    /// A number and its interval as shown, with the three behind them.
    pub(crate) fn estimate(shown: impl Into<String>, value: f64, low: f64, high: f64) -> Cell {
        Cell { shown: shown.into(), exact: Some(format!("{value} {low} {high}")), note: None }
    }

    /// A number that may be missing.
    pub(crate) fn maybe(value: Option<f64>, shown: impl Fn(f64) -> String) -> Cell {
        value.map_or_else(|| Cell::text(crate::format::MISSING), |x| Cell::number(shown(x), x))
    }

    pub(crate) fn noted(self, note: impl Into<String>) -> Cell {
        Cell { note: Some(note.into()), ..self }
    }
}
