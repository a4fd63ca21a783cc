//! The house: what a study is when it is served or analysed, whoever asks: what it shows, whether it can be served, what came of it.
//!
//! No module looks back up the way that a study goes, `remembered → library → task → render → check` and `weight`, and on to `making`, which has
//! what is missing drawn; nor up the way of its answers, `versions → selection → results → pairs`, `participants` and `events → export`.

mod check;
mod drawing;
mod events;
mod export;
mod library;
pub mod links;
pub mod making;
mod pairs;
mod participants;
mod picture;
mod remembered;
mod render;
pub mod results;
mod secret;
pub mod selection;
pub mod shipped;
mod table;
mod task;
pub mod versions;
mod weight;
mod workbook;

pub use check::{StudyFileError, library_of};
pub use events::events_table;
pub use export::{ExportError, codebook_csv, responses_csv, responses_table, spreadsheet};
pub use library::Library;
pub use pairs::pairs_csv;
pub use participants::participants_table;
pub use render::{RenderMaker, techniques_in_words};
pub use secret::random_token;
pub use table::{Table, codebook_of};
pub use task::{Made, Maker, Task};
pub use weight::{Download, HEAVY_BYTES, SLOW_BITS_PER_S, TAIL, Weight};
pub use workbook::workbook;
