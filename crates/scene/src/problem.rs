//! What is wrong with a scene: every problem, each naming file, field, value and rule.

use std::fmt;

/// One thing that is wrong with a scene or with a file that it names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The file that has to be mended, as the caller named it.
    pub file: String,
    /// Where in it: `puppets[1].position_m[2]`, `line 3`, or empty for the file as a whole.
    pub field: String,
    /// The value as written, shortened; `None` when there is none.
    pub value: Option<String>,
    /// The rule that it breaks.
    pub rule: String,
}

impl fmt::Display for Problem {
    /// `file: field = value: rule`, on one line.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}: ", self.file)?;
        match (self.field.as_str(), &self.value) {
            ("", None) => {}
            ("", Some(value)) => write!(f, "{value}: ")?,
            (field, None) => write!(f, "{field}: ")?,
            (field, Some(value)) => write!(f, "{field} = {value}: ")?,
        }
        f.write_str(&self.rule)
    }
}

/// Why a scene was refused: at least one problem, in the order of the files.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct SceneErrors {
    problems: Vec<Problem>,
}

impl SceneErrors {
    /// Panics when `problems` is empty: nothing is refused for no reason.
    pub(crate) fn new(problems: Vec<Problem>) -> Self {
        assert!(!problems.is_empty(), "a scene is refused for a reason");
        Self { problems }
    }

    /// Every problem; at least one.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }
}

impl fmt::Display for SceneErrors {
    /// One problem a line.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for (i, problem) in self.problems.iter().enumerate() {
            let end = if i == 0 { "" } else { "\n" };
            write!(f, "{end}{problem}")?;
        }
        Ok(())
    }
}
