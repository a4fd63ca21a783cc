//! Kinds of trials: what each shows in which role, what an answer to it is, and what that answer says.
//!
//! Adding one is a variant of [`TrialKind`], with what the compiler then asks for in this file and a file of its own beside it, and a
//! folder of its name in `web/participant/trials/`. Nothing else in the house knows which kinds there are; a test holds it to that.

mod choice;
mod events;
mod taken;
#[cfg(test)]
mod tests;
mod two_alternative;
mod two_interval;

pub use events::{EventKind, Ignored, TrialEvent};
pub use taken::{Arrangement, FrameLog, Geometry, Input, Length, Pixels, Taken};
pub use two_alternative::{Side, TwoAlternativeAnswer};
pub use two_interval::{Intervals, StepFrames, StepTimes, TwoIntervalAnswer, Which};

use crate::fields::SECTION;
use crate::schema::{FieldError, Record, worded};
use kelir_reader::Fields;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;
use std::borrow::Cow;
use std::collections::BTreeMap;
use utoipa::ToSchema;

/// How a trial asks, with the settings of its kind: a block's `trial` and `[blocks.trial_settings]`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(tag = "trial", content = "trial_settings", rename_all = "kebab-case")]
pub enum TrialKind {
    /// Two pictures at once, beside or below each other; which one?
    #[default]
    TwoAlternative,
    /// One picture, then another; which one?
    TwoInterval(Intervals),
}

/// The settings of a trial's kind, as its page needs them.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(untagged)]
pub enum TrialSettings {
    /// Of a two-interval trial.
    TwoInterval(Intervals),
}

/// The answer to a trial, as its kind asks. Keys beside these are kept as they come.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub enum Answer {
    /// To a two-alternative trial.
    TwoAlternative(TwoAlternativeAnswer),
    /// To a two-interval trial.
    TwoInterval(TwoIntervalAnswer),
}

worded! {
    /// The names of the kinds of trials.
    pub enum TrialName {
        /// two pictures at once, beside or below each other; which one?
        TwoAlternative = "two-alternative",
        /// one picture, then another; which one?
        TwoInterval = "two-interval",
    }
}

worded! {
    /// The place that a stimulus has in its trial.
    pub enum Role {
        /// on the left, or above
        Left = "left",
        /// on the right, or below
        Right = "right",
        /// in the first interval
        First = "first",
        /// in the second interval
        Second = "second",
    }
}

impl Role {
    /// The role of this name.
    pub fn named(name: &str) -> Option<Role> {
        Role::ALL.iter().copied().find(|role| role.as_str() == name)
    }
}

/// Which condition of which item a role shows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Placed<'a> {
    /// Item's id.
    #[serde(borrow)]
    pub item: Cow<'a, str>,
    /// Condition's name.
    #[serde(borrow)]
    pub condition: Cow<'a, str>,
}

/// What a trial shows, by role.
pub type Shown<'a> = BTreeMap<Role, Placed<'a>>;

/// Reads what a trial shows into texts of its own.
pub(crate) fn owned<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Shown<'static>, D::Error> {
    let own = |text: Cow<'de, str>| Cow::Owned(text.into_owned());
    let shown = Shown::<'de>::deserialize(deserializer)?.into_iter();
    Ok(shown.map(|(role, p)| (role, Placed { item: own(p.item), condition: own(p.condition) })).collect())
}

/// An answer that can be stored.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Checked {
    /// What was answered, as canonical JSON: it is stored and hashed as it is.
    pub answer: String,
    /// The size at which the page says that it showed the stimuli, [width, height] in their pixels.
    pub stimulus_size: Option<[u32; 2]>,
}

/// What the statistics take from an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Observation<'a> {
    /// One of two conditions of an item was chosen.
    Choice(Choice<'a>),
}

/// A choice between two conditions of one item.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice<'a> {
    /// Item's id.
    pub item: Cow<'a, str>,
    /// The condition that stood first: on the left, or in the first interval.
    pub first_condition: Cow<'a, str>,
    /// The other condition.
    pub second_condition: Cow<'a, str>,
    /// Whether the first was chosen.
    pub chose_first: bool,
    /// Response time in ms; NaN where it is not known.
    pub rt_ms: f64,
}

/// What every kind of trial knows.
pub trait TrialRules: Sync {
    /// The kind's name in study files and data.
    fn name(&self) -> TrialName;

    /// The roles that its stimuli have, in the order shown.
    fn roles(&self) -> &'static [Role];

    /// How its stimuli stand to each other, as words after "two pictures".
    fn layout(&self) -> &'static str;

    /// What is shown where, with the target before or after the other condition.
    fn plan(&self, item: &str, target: &str, other: &str, target_first: bool) -> Shown<'static>;

    /// What a page sent, as an answer. Only what was chosen is asked of it: whatever else a browser, its clock or a network made of it can be
    /// stored, and [`Record::sound`] of the kind's record tells what can be used.
    ///
    /// # Errors
    /// Why it is no answer.
    fn check(&self, sent: &Value) -> Result<Checked, Vec<FieldError>>;

    /// What a page sends: the columns of its rows, their types, units, ranges and meanings.
    fn record(&self) -> &Record;

    /// What a stored answer says.
    ///
    /// # Errors
    /// Why it says nothing, as a sentence.
    fn observe<'a>(&self, shown: &Shown<'a>, answer: &str) -> Result<Observation<'a>, String>;

    /// The role chosen by a stored answer; `None` where there is none.
    fn chosen(&self, answer: &str) -> Option<Role>;

    /// What the choice of the first or the second stimulus says, without an answer's text; `None` where a role has no stimulus.
    fn chose<'a>(&self, shown: &Shown<'a>, chose_first: bool, rt_ms: f64) -> Option<Observation<'a>>;

    /// The answer of somebody who chooses the first or the second stimulus after `rt_ms`, as a page sends it.
    fn simulate(&self, chose_first: bool, rt_ms: f64) -> Value;
}

impl TrialKind {
    /// One of each kind, with the settings that a study file gets when it names none.
    pub fn all() -> [TrialKind; 2] {
        [TrialKind::TwoAlternative, TrialKind::TwoInterval(Intervals::default())]
    }

    /// What this kind knows.
    pub fn rules(&self) -> &'static dyn TrialRules {
        match self {
            TrialKind::TwoAlternative => &two_alternative::RULES,
            TrialKind::TwoInterval(_) => &two_interval::RULES,
        }
    }

    /// The kind's name in study files and data.
    pub fn name(&self) -> &'static str {
        self.rules().name().as_str()
    }

    /// Its settings for the page; `None` for a kind that has none.
    pub fn settings(&self) -> Option<TrialSettings> {
        match self {
            TrialKind::TwoAlternative => None,
            TrialKind::TwoInterval(intervals) => Some(TrialSettings::TwoInterval(intervals.clone())),
        }
    }

    /// How it shows its pictures, for a paper's methods: words after "the two pictures were shown".
    pub fn presentation(&self) -> String {
        match self {
            TrialKind::TwoAlternative => two_alternative::PRESENTATION.to_owned(),
            TrialKind::TwoInterval(intervals) => two_interval::presentation(intervals),
        }
    }

    /// Reads a block's `trial` and `[blocks.trial_settings]`; `None` where something is wrong, which has been reported.
    pub(crate) fn read(block: &mut Fields<'_>) -> Option<TrialKind> {
        let names = TrialKind::all().map(|kind| format!("\"{}\"", kind.name())).join(" or ");
        let asked = block.defaulted("trial", &names, TrialKind::default(), |v| {
            TrialKind::all().into_iter().find(|kind| v.as_str() == Some(kind.name()))
        });
        match asked? {
            TrialKind::TwoInterval(_) => two_interval::read(block).map(TrialKind::TwoInterval),
            TrialKind::TwoAlternative => match block.given("trial_settings", SECTION) {
                Some(settings) => settings.refuse("this kind of trial has no settings"),
                None => Some(TrialKind::TwoAlternative),
            },
        }
    }
}

/// The rules of the kind of this name, as rows name it.
pub fn rules(name: &str) -> Option<&'static dyn TrialRules> {
    TrialKind::all().into_iter().map(|kind| kind.rules()).find(|rules| rules.name().as_str() == name)
}
