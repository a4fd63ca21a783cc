//! Samples described: moments that reach the precision of their inputs.

mod moments;
mod series;

pub use moments::Moments;
pub use series::{OneWayAnova, autocorrelation, one_way_anova};
