//! One picture, then another; which one?

use super::choice::ChoiceOfTwo;
use super::{Role, Taken, TrialName};
use crate::fields::{SECTION, number};
use crate::schema::{Record, worded};
use kelir_reader::Fields;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;
use utoipa::ToSchema;

/// How long each step of a two-interval trial is asked to last, in ms. A page rounds each to whole frames of its display.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Intervals {
    /// A cross in the middle, 0 (none) to 10000.
    #[schema(minimum = 0, maximum = 10000)]
    pub fixation_ms: f64,
    /// The first stimulus, 1 to 60000.
    #[schema(minimum = 1, maximum = 60000)]
    pub first_ms: f64,
    /// Noise in its place, 0 (none) to 10000.
    #[schema(minimum = 0, maximum = 10000)]
    pub mask_ms: f64,
    /// The second stimulus, 1 to 60000.
    #[schema(minimum = 1, maximum = 60000)]
    pub second_ms: f64,
}

impl Default for Intervals {
    fn default() -> Intervals {
        Intervals { fixation_ms: 500.0, first_ms: 500.0, mask_ms: 250.0, second_ms: 500.0 }
    }
}

worded! {
    /// One of the two intervals.
    pub enum Which {
        /// the one that came first
        First = "first",
        /// the one that came second
        Second = "second",
    }
}

/// A duration for each step of the trial, in ms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct StepTimes {
    /// The fixation cross.
    #[schema(minimum = 0, maximum = 1e9, extensions(("x-unit" = json!("ms"))))]
    pub fixation: f64,
    /// The first stimulus.
    #[schema(minimum = 0, maximum = 1e9, extensions(("x-unit" = json!("ms"))))]
    pub first: f64,
    /// The mask between.
    #[schema(minimum = 0, maximum = 1e9, extensions(("x-unit" = json!("ms"))))]
    pub mask: f64,
    /// The second stimulus.
    #[schema(minimum = 0, maximum = 1e9, extensions(("x-unit" = json!("ms"))))]
    pub second: f64,
}

/// A number of whole frames for each step of the trial.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct StepFrames {
    /// The fixation cross.
    pub fixation: u32,
    /// The first stimulus.
    pub first: u32,
    /// The mask between.
    pub mask: u32,
    /// The second stimulus.
    pub second: u32,
}

/// What a page sends for a two-interval trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct TwoIntervalAnswer {
    /// The interval chosen.
    pub choice: Which,
    /// How long each step was asked to last: fixation, first, mask, second.
    #[serde(default)]
    pub requested_ms: Option<StepTimes>,
    /// Whole frames of the display's measured refresh that each step was to last.
    #[serde(default)]
    pub shown_frames: Option<StepFrames>,
    /// How long each step lasted, between the times of the frames that began and ended it.
    #[serde(default)]
    pub shown_ms: Option<StepTimes>,
    /// How often the sequence began again because the page was hidden in the midst of it.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 1000000)]
    pub restarts: Option<u32>,
    /// How the trial was taken.
    #[serde(flatten)]
    pub taken: Taken,
}

/// `[blocks.trial_settings]`; `None` where something is wrong, which has been reported.
pub(super) fn read(block: &mut Fields<'_>) -> Option<Intervals> {
    let usual = Intervals::default();
    let Some(node) = block.given("trial_settings", SECTION) else { return Some(usual) };
    let mut fields = node.table()?;
    let mut step = |key, rule, low, high, usual| fields.defaulted(key, rule, usual, |v| number(v, low, high));
    let found = (
        step("fixation_ms", "milliseconds from 0 to 10000", 0.0, 1e4, usual.fixation_ms),
        step("first_ms", "milliseconds from 1 to 60000", 1.0, 6e4, usual.first_ms),
        step("mask_ms", "milliseconds from 0 to 10000", 0.0, 1e4, usual.mask_ms),
        step("second_ms", "milliseconds from 1 to 60000", 1.0, 6e4, usual.second_ms),
    );
    fields.done();
    let (fixation_ms, first_ms, mask_ms, second_ms) = found;
    Some(Intervals {
        fixation_ms: fixation_ms?,
        first_ms: first_ms?,
        mask_ms: mask_ms?,
        second_ms: second_ms?,
    })
}

/// How the pictures are shown, for a paper's methods.
pub(super) fn presentation(i: &Intervals) -> String {
    format!(
        "one after the other (two-interval forced choice): a fixation cross for {} ms, the first picture for {} ms, a mask for {} ms and \
         the second picture for {} ms, each rounded to whole frames of the participant's display",
        i.fixation_ms, i.first_ms, i.mask_ms, i.second_ms
    )
}

/// What the kind knows.
pub(super) static RULES: ChoiceOfTwo = ChoiceOfTwo {
    name: TrialName::TwoInterval,
    roles: &[Role::First, Role::Second],
    layout: "one after the other",
    record: LazyLock::new(Record::of::<TwoIntervalAnswer>),
};
