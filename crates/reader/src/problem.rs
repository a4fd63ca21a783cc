//! What is wrong with a file: every problem, each naming file, place, field, value and rule.

use std::fmt;
use std::ops::Deref;

use serde::{Deserialize, Serialize};

use crate::place::Place;

/// One thing that is wrong with a file or with one that it names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Problem {
    /// The file that has to be mended, as the caller named it.
    pub file: String,
    /// Where in it: `puppets[1].position_m[2]`, `line 3, column 5` where the text is no TOML, or empty for the file as a whole.
    pub field: String,
    /// The value as written, shortened; `None` when there is none.
    pub value: Option<String>,
    /// The rule that it breaks.
    pub rule: String,
    /// Where the value begins, or the table that lacks it; `None` where no text is at hand.
    pub place: Option<Place>,
}

impl Problem {
    /// A problem of a value whose text is not at hand.
    pub fn new(
        file: impl Into<String>,
        field: impl Into<String>,
        value: Option<String>,
        rule: impl Into<String>,
    ) -> Problem {
        Problem { file: file.into(), field: field.into(), value, rule: rule.into(), place: None }
    }
}

impl fmt::Display for Problem {
    /// `file:line:column: field = value: rule`, on one line.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.file)?;
        if let Some(Place { line, column }) = self.place {
            write!(f, ":{line}:{column}")?;
        }
        f.write_str(": ")?;
        // A field that is the place itself is not said again.
        let is_place = self.place.is_some_and(|place| place.to_string() == self.field);
        match (if is_place { "" } else { &self.field }, &self.value) {
            ("", None) => {}
            ("", Some(value)) => write!(f, "{value}: ")?,
            (field, None) => write!(f, "{field}: ")?,
            (field, Some(value)) => write!(f, "{field} = {value}: ")?,
        }
        f.write_str(&self.rule)
    }
}

/// Why a file was refused: at least one problem, in the order of the reading.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Problems(Vec<Problem>);

impl Problems {
    /// Panics when `problems` is empty: nothing is refused for no reason.
    pub fn new(problems: Vec<Problem>) -> Problems {
        assert!(!problems.is_empty(), "a file is refused for a reason");
        Problems(problems)
    }
}

impl Deref for Problems {
    type Target = [Problem];

    fn deref(&self) -> &[Problem] {
        &self.0
    }
}

impl From<Problems> for Vec<Problem> {
    fn from(problems: Problems) -> Vec<Problem> {
        problems.0
    }
}

impl fmt::Display for Problems {
    /// One problem a line.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for (i, problem) in self.0.iter().enumerate() {
            let end = if i == 0 { "" } else { "\n" };
            write!(f, "{end}{problem}")?;
        }
        Ok(())
    }
}
