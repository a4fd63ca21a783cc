//! Two pictures at once; which one?

use super::choice::ChoiceOfTwo;
use super::{Role, Taken, TrialName};
use crate::schema::{Record, worded};
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;
use utoipa::ToSchema;

worded! {
    /// One of the two pictures.
    pub enum Side {
        /// the left or upper one
        Left = "left",
        /// the right or lower one
        Right = "right",
    }
}

/// What a page sends for a two-alternative trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct TwoAlternativeAnswer {
    /// The picture chosen.
    pub choice: Side,
    /// How the trial was taken.
    #[serde(flatten)]
    pub taken: Taken,
}

/// How the pictures are shown, for a paper's methods.
pub(super) const PRESENTATION: &str =
    "beside each other, or below each other in a narrow window (two-alternative forced choice)";

/// What the kind knows.
pub(super) static RULES: ChoiceOfTwo = ChoiceOfTwo {
    name: TrialName::TwoAlternative,
    roles: &[Role::Left, Role::Right],
    layout: "side by side, or one above the other in a narrow window",
    record: LazyLock::new(Record::of::<TwoAlternativeAnswer>),
};
