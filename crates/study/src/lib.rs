//! People asked: what a study is, who sees what in which order, and what their answers add up to.
//!
//! Pure: no IO but the text a caller hands in, no clock, no randomness but from stated seeds.

mod conduct;
mod definition;
mod display;
mod fields;
mod languages;
mod parse;
mod primary;
#[cfg(test)]
mod reference;

pub mod adaptive;
pub mod analysis;
pub mod answers;
pub mod columns;
pub mod plan;
pub mod power;
pub mod report;
pub mod schema;
pub mod screening;
pub mod trials;
pub mod versions;
pub mod visits;

pub use conduct::{NEWEST_EDITION, Repeat, ResponseRules, SessionRules};
pub use definition::{
    Block, Completion, Condition, Direction, GUESS, Item, Kind, Pictures, Psychometric, Screening,
    StudyDefinition,
};
pub use display::{DisplayRules, Fit};
pub use kelir_reader::{Problem, Problems};
pub use languages::{Texts, Translation};
pub use plan::{Decision, Procedures, Trial, TrialPlan, next_trials};
pub use primary::{PrimaryEndpoint, PrimaryTest};
pub use trials::TrialKind;
