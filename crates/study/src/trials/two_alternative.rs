//! Two pictures at once; which one?

use super::{Checked, Observation, Role, Shown, Taken, TrialName, TrialRules, choice};
use crate::schema::{FieldError, Record, worded};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::sync::LazyLock;
use utoipa::ToSchema;

const ROLES: [Role; 2] = [Role::Left, Role::Right];

worded! {
    /// One of the two pictures.
    pub enum Side {
        /// the left or upper one
        Left = "left",
        /// the right or lower one
        Right = "right",
    }
}

worded! {
    /// How the two pictures stood.
    pub enum Arrangement {
        /// beside each other
        Side = "side",
        /// the right one below the left one
        Stack = "stack",
        /// side, in the word that the codebook used to have
        Beside = "beside",
        /// stack, in the word that the codebook used to have
        Below = "below",
    }
}

/// What a page sends for a two-alternative trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct TwoAlternativeAnswer {
    /// The picture chosen.
    pub choice: Side,
    /// How the two pictures stood.
    #[serde(default)]
    pub arrangement: Option<Arrangement>,
    /// How the trial was taken.
    #[serde(flatten)]
    pub taken: Taken,
}

pub(super) struct TwoAlternative;

impl TrialRules for TwoAlternative {
    fn name(&self) -> TrialName {
        TrialName::TwoAlternative
    }

    fn roles(&self) -> &'static [Role] {
        &ROLES
    }

    fn plan(&self, item: &str, target: &str, other: &str, target_first: bool) -> Shown<'static> {
        choice::plan(ROLES, item, target, other, target_first)
    }

    fn check(&self, sent: &Value) -> Result<Checked, Vec<FieldError>> {
        static SCHEMA: LazyLock<Record> = LazyLock::new(Record::of::<TwoAlternativeAnswer>);
        choice::check(&SCHEMA, sent)
    }

    fn schema(&self) -> Record {
        Record::of::<TwoAlternativeAnswer>()
    }

    fn observe<'a>(&self, shown: &Shown<'a>, answer: &str) -> Result<Observation<'a>, String> {
        choice::observe(ROLES, shown, answer)
    }

    fn chosen(&self, answer: &str) -> Option<Role> {
        choice::chosen(answer)
    }

    fn chose<'a>(&self, shown: &Shown<'a>, chose_first: bool, rt_ms: f64) -> Option<Observation<'a>> {
        choice::chose(ROLES, shown, chose_first, rt_ms)
    }

    fn simulate(&self, chose_first: bool, rt_ms: f64) -> Value {
        let choice = if chose_first { Side::Left } else { Side::Right };
        json!({ "choice": choice, "rt": rt_ms, "arrangement": Arrangement::Side, "trial_type": self.name() })
    }
}
