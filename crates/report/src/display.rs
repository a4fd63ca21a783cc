//! In which sizes participants saw the stimuli.

use crate::StudyReport;
use crate::document::{Cell, Piece, Row, Table};
use crate::format::{MISSING, fixed};
use serde::Serialize;
use utoipa::ToSchema;

/// How often stimuli were shown at a size, and how large that was on participants' displays.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct ShownAt {
    /// [width, height] in the stimuli's own pixels; [0, 0] where that was never known.
    pub size: [u32; 2],
    /// Answers given to stimuli of this size, of those who are judged.
    pub answers: u64,
    /// Least and greatest device pixels a stimulus pixel, 1 being native; null where no page said so.
    pub scale: Option<[f64; 2]>,
    /// Least and greatest width, CSS px; null where no page said so.
    pub css_width_px: Option<[f64; 2]>,
}

impl ShownAt {
    /// Together with others of the same size.
    pub fn with(self, other: ShownAt) -> ShownAt {
        let both = |a: Option<[f64; 2]>, b: Option<[f64; 2]>| match (a, b) {
            (Some([low, high]), Some([l, h])) => Some([low.min(l), high.max(h)]),
            (a, b) => a.or(b),
        };
        ShownAt {
            size: self.size,
            answers: self.answers + other.answers,
            scale: both(self.scale, other.scale),
            css_width_px: both(self.css_width_px, other.css_width_px),
        }
    }
}

/// Three decimals at most: 1, 0.869, 197.333.
fn plain(x: f64) -> String {
    fixed(x, 3).trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A size in words; nothing where it is not known.
pub(crate) fn size([width, height]: [u32; 2]) -> String {
    if width == 0 { String::new() } else { format!("{width} × {height}") }
}

/// The rule by which a size is chosen, and what was shown by it.
pub(crate) fn pieces(report: &StudyReport) -> Vec<Piece> {
    let mut pieces = vec![Piece::Text(report.design.display_in_words())];
    let range = |range: Option<[f64; 2]>| match range {
        None => Cell::text(MISSING),
        Some([low, high]) if low == high => Cell::number(plain(low), low),
        Some([low, high]) => Cell {
            shown: format!("{} to {}", plain(low), plain(high)),
            exact: Some(format!("{low} {high}")),
            note: None,
        },
    };
    let rows = report.shown.iter().map(|shown| {
        Row::Cells(vec![
            Cell::text(size(shown.size)),
            Cell::whole(shown.answers),
            range(shown.scale),
            range(shown.css_width_px),
        ])
    });
    let columns = ["shown at, px", "answers#", "device px a picture px#", "width, CSS px#"];
    if !report.shown.is_empty() {
        pieces.push(Piece::Table(Table::new("", &columns, rows.collect())));
    }
    pieces
}
