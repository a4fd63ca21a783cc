//! What kinds of trials share in which one of two stimuli is chosen.

use super::{Checked, Choice, Observation, Placed, Role, Shown, TrialName, TrialRules};
use crate::schema::{FieldError, Record, Sound};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::sync::LazyLock;

/// An answer as it is stored.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Answer<'a> {
    #[serde(borrow)]
    choice: Cow<'a, str>,
    /// Null where the page sent none that can be.
    rt_ms: Option<f64>,
}

/// A kind of trial in which one of two stimuli is chosen. What a page sends has `choice`, a role's name, and `rt`.
pub(super) struct ChoiceOfTwo {
    pub(super) name: TrialName,
    pub(super) roles: &'static [Role; 2],
    /// How the two stand to each other.
    pub(super) layout: &'static str,
    /// What a page sends.
    pub(super) record: LazyLock<Record>,
}

impl TrialRules for ChoiceOfTwo {
    fn name(&self) -> TrialName {
        self.name
    }

    fn roles(&self) -> &'static [Role] {
        self.roles
    }

    fn layout(&self) -> &'static str {
        self.layout
    }

    fn plan(&self, item: &str, target: &str, other: &str, target_first: bool) -> Shown<'static> {
        let conditions = if target_first { [target, other] } else { [other, target] };
        let placed = |condition: &str| Placed {
            item: Cow::Owned(item.to_owned()),
            condition: Cow::Owned(condition.to_owned()),
        };
        self.roles.iter().copied().zip(conditions.map(placed)).collect()
    }

    fn check(&self, sent: &Value) -> Result<Checked, Vec<FieldError>> {
        let Sound { value, broken } = self.record.sound(sent);
        let no_answer = |field: &String| field.is_empty() || field == "choice";
        if broken.iter().any(no_answer) {
            let of = |error: &FieldError| matches!(error.pointer.as_str(), "" | "/choice");
            return Err(self.record.check(sent).into_iter().filter(of).collect());
        }
        let answer = json!({ "choice": value["choice"], "rt_ms": value["rt"] });
        let whole = |error: kelir_jcs::Error| {
            vec![FieldError { pointer: String::new(), value: None, rule: error.to_string() }]
        };
        let stimulus_size = serde_json::from_value(value["stimulus_size"].clone()).ok().flatten();
        Ok(Checked { answer: kelir_jcs::canonical(answer).map_err(whole)?, stimulus_size })
    }

    fn record(&self) -> &Record {
        &self.record
    }

    fn observe<'a>(&self, shown: &Shown<'a>, answer: &str) -> Result<Observation<'a>, String> {
        let answer: Answer<'_> = serde_json::from_str(answer).map_err(|error| error.to_string())?;
        let chose_first = answer.choice == self.roles[0].as_str();
        if !chose_first && answer.choice != self.roles[1].as_str() {
            return Err(format!("{:?} was chosen, which was not shown", answer.choice));
        }
        self.chose(shown, chose_first, answer.rt_ms.unwrap_or(f64::NAN))
            .ok_or_else(|| "a role has no stimulus".to_owned())
    }

    fn chosen(&self, answer: &str) -> Option<Role> {
        let answer: Answer<'_> = serde_json::from_str(answer).ok()?;
        Role::named(&answer.choice)
    }

    fn chose<'a>(&self, shown: &Shown<'a>, chose_first: bool, rt_ms: f64) -> Option<Observation<'a>> {
        let (first, second) = (shown.get(&self.roles[0])?, shown.get(&self.roles[1])?);
        Some(Observation::Choice(Choice {
            item: first.item.clone(),
            first_condition: first.condition.clone(),
            second_condition: second.condition.clone(),
            chose_first,
            rt_ms,
        }))
    }

    fn simulate(&self, chose_first: bool, rt_ms: f64) -> Value {
        let role = self.roles[usize::from(!chose_first)];
        json!({ "choice": role.as_str(), "rt": rt_ms, "trial_type": self.name.as_str() })
    }
}
