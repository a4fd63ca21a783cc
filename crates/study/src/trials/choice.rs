//! What kinds of trials share in which one of two stimuli is chosen.

use super::{Checked, Choice, Observation, Placed, Role, Shown};
use crate::schema::{FieldError, Record};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::borrow::Cow;

/// An answer as it is stored.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Answer<'a> {
    #[serde(borrow)]
    choice: Cow<'a, str>,
    rt_ms: f64,
}

/// The two conditions in their roles.
pub(super) fn plan(
    roles: [Role; 2],
    item: &str,
    target: &str,
    other: &str,
    target_first: bool,
) -> Shown<'static> {
    let conditions = if target_first { [target, other] } else { [other, target] };
    let placed = |condition: &str| Placed {
        item: Cow::Owned(item.to_owned()),
        condition: Cow::Owned(condition.to_owned()),
    };
    roles.into_iter().zip(conditions.map(placed)).collect()
}

/// Checks what was sent against the kind's schema, which holds `choice` and `rt`.
pub(super) fn check(schema: &Record, sent: &Value) -> Result<Checked, Vec<FieldError>> {
    let errors = schema.check(sent);
    if !errors.is_empty() {
        return Err(errors);
    }
    let answer = Answer {
        choice: sent["choice"].as_str().unwrap_or_default().into(),
        rt_ms: sent["rt"].as_f64().unwrap_or_default(),
    };
    let whole = |rule| vec![FieldError { pointer: String::new(), value: None, rule }];
    let json = serde_json::to_value(&answer).map_err(|error| whole(error.to_string()))?;
    Ok(Checked { answer: kelir_jcs::canonical(json).map_err(|error| whole(error.to_string()))? })
}

/// What a stored answer says.
pub(super) fn observe<'a>(
    roles: [Role; 2],
    shown: &Shown<'a>,
    answer: &str,
) -> Result<Observation<'a>, String> {
    let answer: Answer<'_> = serde_json::from_str(answer).map_err(|error| error.to_string())?;
    let chose_first = answer.choice == roles[0].as_str();
    if !chose_first && answer.choice != roles[1].as_str() {
        return Err(format!("{:?} was chosen, which was not shown", answer.choice));
    }
    chose(roles, shown, chose_first, answer.rt_ms).ok_or_else(|| "a role has no stimulus".to_owned())
}

/// What the choice of the first or the second stimulus says.
pub(super) fn chose<'a>(
    roles: [Role; 2],
    shown: &Shown<'a>,
    chose_first: bool,
    rt_ms: f64,
) -> Option<Observation<'a>> {
    let (first, second) = (shown.get(&roles[0])?, shown.get(&roles[1])?);
    Some(Observation::Choice(Choice {
        item: first.item.clone(),
        first_condition: first.condition.clone(),
        second_condition: second.condition.clone(),
        chose_first,
        rt_ms,
    }))
}

/// The role chosen.
pub(super) fn chosen(answer: &str) -> Option<Role> {
    let answer: Answer<'_> = serde_json::from_str(answer).ok()?;
    Role::named(&answer.choice)
}
