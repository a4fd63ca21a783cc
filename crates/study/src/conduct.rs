//! How a study is conducted: when a response counts, and whose visit is whose.

use crate::fields::{SECTION, number, text};
use kelir_reader::{Fields, Node};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The newest edition of the study file's defaults.
pub const NEWEST_EDITION: u32 = 2;

/// When an input counts as the response to a trial. What does not count is logged with its time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ResponseRules {
    /// How long the stimulus must have been visible, in ms, 0 to 60000.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_visible_ms: Option<f64>,
    /// How long after the last input that counted, in ms, 0 to 60000.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_gap_ms: Option<f64>,
}

impl ResponseRules {
    /// The rules with the defaults of an edition: 200 ms visible and 500 ms apart from edition 2 on, none before.
    pub fn of_edition(self, edition: u32) -> ResponseRules {
        let (visible, gap) = if edition >= 2 { (200.0, 500.0) } else { (0.0, 0.0) };
        ResponseRules {
            min_visible_ms: Some(self.min_visible_ms.unwrap_or(visible)),
            min_gap_ms: Some(self.min_gap_ms.unwrap_or(gap)),
        }
    }

    pub(crate) fn read(fields: &mut Fields<'_>) -> Option<ResponseRules> {
        let Some(node) = fields.given("response", SECTION) else { return Some(ResponseRules::default()) };
        let mut fields = node.table()?;
        let mut ms = |key| fields.may(key, "milliseconds from 0 to 60000", |v| number(v, 0.0, 60_000.0));
        let rules = ResponseRules { min_visible_ms: ms("min_visible_ms"), min_gap_ms: ms("min_gap_ms") };
        fields.done();
        Some(rules)
    }
}

/// What happens when somebody comes whose id has a session in this study already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum Repeat {
    /// A new session, flagged as a repeat.
    #[default]
    Flag,
    /// The session that is there goes on.
    Resume,
    /// Nobody takes part twice.
    Refuse,
}

/// Whose visit is whose.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct SessionRules {
    /// What happens to an id that comes again.
    #[serde(default, skip_serializing_if = "is_default")]
    pub repeat: Repeat,
    /// Whether each visit is somebody else's, as on a laboratory's computer: nothing is resumed without being asked for.
    #[serde(default, skip_serializing_if = "is_default")]
    pub per_visit: bool,
    /// The parameter of the participant's link that names the participant; absent: the first that is there of those that panels use.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// Parameters of the participant's link that stand in the table of participants, besides the one that names the participant.
    #[serde(default, skip_serializing_if = "is_default")]
    pub params: Vec<String>,
}

impl SessionRules {
    pub(crate) fn read(fields: &mut Fields<'_>) -> Option<SessionRules> {
        let Some(node) = fields.given("session", SECTION) else { return Some(SessionRules::default()) };
        let mut fields = node.table()?;
        let repeat = fields.may("repeat", "\"flag\", \"resume\" or \"refuse\"", |v| match v.as_str()? {
            "flag" => Some(Repeat::Flag),
            "resume" => Some(Repeat::Resume),
            "refuse" => Some(Repeat::Refuse),
            _ => None,
        });
        let per_visit = fields.may("per_visit", "true or false", Node::as_bool);
        let id = fields.may("id", "the name of a parameter, of 1 to 64 characters", |v| text(v, 64));
        let params = fields.may("params", "at most 64 different names of 1 to 64 characters", |v| {
            let names: Vec<String> = v.as_array()?.iter().map(|v| text(v, 64)).collect::<Option<_>>()?;
            let different: std::collections::BTreeSet<&String> = names.iter().collect();
            (names.len() <= 64 && different.len() == names.len()).then_some(names)
        });
        fields.done();
        Some(SessionRules {
            repeat: repeat.unwrap_or_default(),
            per_visit: per_visit.unwrap_or(false),
            id,
            params: params.unwrap_or_default(),
        })
    }
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
