//! What is wrong with a mesh file.

use std::fmt;

/// The first thing that is wrong with a file: where, what stands there, and the rule it breaks. The caller knows the file's name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// `line 12`, `vertex 7`, `accessors[3].count`; empty for the file as a whole.
    pub place: String,
    /// What stands there, shortened.
    pub value: Option<String>,
    /// The rule that it breaks.
    pub rule: String,
}

impl Fault {
    pub(crate) fn new(place: impl Into<String>, rule: impl Into<String>) -> Fault {
        Fault { place: place.into(), value: None, rule: rule.into() }
    }

    pub(crate) fn of(place: impl Into<String>, value: impl fmt::Display, rule: impl Into<String>) -> Fault {
        Fault { value: Some(shorten(&value.to_string())), ..Fault::new(place, rule) }
    }
}

/// A hostile value may be as long as its file.
fn shorten(value: &str) -> String {
    const MOST: usize = 60;
    match value.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &value[..end]),
        None => value.to_owned(),
    }
}

impl fmt::Display for Fault {
    /// `place = value: rule`, on one line.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match (self.place.as_str(), &self.value) {
            ("", None) => {}
            ("", Some(value)) => write!(f, "{value}: ")?,
            (place, None) => write!(f, "{place}: ")?,
            (place, Some(value)) => write!(f, "{place} = {value}: ")?,
        }
        f.write_str(&self.rule)
    }
}

impl std::error::Error for Fault {}
