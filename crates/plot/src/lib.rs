//! kelir's figures: points, lines, intervals and reference lines on linear, logarithmic or named axes, as SVG text.
//!
//! Labels stand beside what they name in place of a legend; the palette is Okabe and Ito's, told apart by the colour-blind, and each series has a
//! marker of its own, so that a figure reads in grey too.

mod axis;
mod draw;
mod forest;
mod labels;

pub use axis::{Axis, Scale};
pub use draw::svg;
pub use forest::{Estimate, Forest, forest};

/// A point, and its interval if it has one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// Where on the horizontal axis, in its unit.
    pub x: f64,
    /// Where on the vertical axis, in its unit.
    pub y: f64,
    /// Lower and upper end of a vertical interval.
    pub interval: Option<[f64; 2]>,
    /// Written beside the point.
    pub label: Option<String>,
}

/// Points that belong together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Written at the end of the line, or beside the last point; empty for none.
    pub name: String,
    /// In the order in which a line joins them.
    pub points: Vec<Point>,
    /// Joined by a line.
    pub line: bool,
    /// Each point marked.
    pub markers: bool,
    /// The line is dashed.
    pub dashed: bool,
    /// A bar from the axis's lower end to each point, its label above it; for points one apart.
    pub bars: bool,
}

/// A reference line right across the figure.
#[derive(Clone, Debug, PartialEq)]
pub enum Rule {
    /// At this height, with its name.
    Horizontal(f64, String),
    /// At this place, with its name.
    Vertical(f64, String),
}

/// A figure to draw with [`svg`](fn@svg).
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Above the figure, and its accessible name.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// What is drawn; the colours go round after seven.
    pub series: Vec<Series>,
    /// Reference lines.
    pub rules: Vec<Rule>,
    /// Width and height, px; at least 200 × 150.
    pub size: [u32; 2],
}

/// What cannot be drawn, and why.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum PlotError {
    /// A coordinate is NaN or infinite.
    #[error("{what} = {value}: only finite numbers can be drawn")]
    NotFinite {
        /// Which coordinate.
        what: String,
        /// Its value.
        value: f64,
    },
    /// A logarithmic axis has no place for it.
    #[error("{what} = {value}: a logarithmic axis holds numbers above 0")]
    NotPositive {
        /// Which coordinate.
        what: String,
        /// Its value.
        value: f64,
    },
    /// A range that holds nothing.
    #[error("range of {axis:?} = {low}..{high}: its end must lie above its start")]
    Range {
        /// The axis's label.
        axis: String,
        /// Start.
        low: f64,
        /// End.
        high: f64,
    },
    /// Too small to hold its axes.
    #[error("size = {0}x{1}: a figure is at least 200x150 and at most 10000x10000 px")]
    Size(u32, u32),
}
