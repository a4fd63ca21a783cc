//! Who somebody is: the parameter of their link that names them.

use crate::conduct::SessionRules;
use std::collections::BTreeMap;

/// Parameters by which recruiting panels name their participants, in order of preference.
pub const ID_PARAMETERS: [&str; 4] = ["PROLIFIC_PID", "workerId", "subject_id", "id"];

/// Bytes of the longest id, as UTF-8.
pub const LONGEST_ID: usize = 512;

/// A parameter of a link by its name. One in other letters (small for capital) is the same name, unless the exact one is there too.
pub(crate) fn parameter<'a>(
    params: &'a BTreeMap<String, String>,
    name: &str,
) -> Option<(&'a String, &'a String)> {
    let same = |(known, _): &(&String, &String)| known.to_lowercase() == name.to_lowercase();
    params.get_key_value(name).or_else(|| params.iter().find(same))
}

/// An id that cannot be taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RefusedId {
    /// The parameter.
    pub name: String,
    /// What it says.
    pub value: String,
    /// The rule that it breaks.
    pub rule: String,
}

impl SessionRules {
    /// The parameter that names the participant, with the id as it was sent; `None` where the link names nobody.
    ///
    /// # Errors
    /// The id is empty, too long, or holds control characters.
    pub fn identify<'a>(
        &self,
        params: &'a BTreeMap<String, String>,
    ) -> Result<Option<(&'a str, &'a str)>, RefusedId> {
        let names: Vec<&str> = match &self.id {
            Some(name) => vec![name],
            None => ID_PARAMETERS.to_vec(),
        };
        let found: Vec<(&String, &String)> =
            names.iter().filter_map(|name| parameter(params, name)).collect();
        let filled = found.iter().find(|(_, value)| !value.is_empty());
        let Some((name, value)) = filled.or(found.first()) else { return Ok(None) };
        if (1..=LONGEST_ID).contains(&value.len()) && !value.contains(char::is_control) {
            return Ok(Some((name, value)));
        }
        Err(RefusedId {
            name: (*name).clone(),
            value: (*value).clone(),
            rule: format!(
                "names the participant and must be 1 to {LONGEST_ID} bytes of UTF-8 without control characters"
            ),
        })
    }
}
