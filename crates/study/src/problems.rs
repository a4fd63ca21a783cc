//! What is wrong with a study file: every problem, each with file, field, value and rule.

use std::fmt;

/// One thing that is wrong in a study file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The file as the caller named it.
    pub file: String,
    /// Path of the field, such as `blocks[1].items[0].scene`; `line 3, column 5` where the text is no TOML.
    pub field: String,
    /// The offending value as TOML, absent where the field is missing.
    pub value: Option<String>,
    /// The rule that the value breaks.
    pub rule: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.value {
            Some(value) => write!(f, "{}: {} = {}: {}", self.file, self.field, value, self.rule),
            None => write!(f, "{}: {}: {}", self.file, self.field, self.rule),
        }
    }
}

/// Every problem of one study file, in the order of the file; printed one a line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct StudyErrors(pub Vec<Problem>);

impl fmt::Display for StudyErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.0.iter().enumerate() {
            if i > 0 {
                f.write_str("\n")?;
            }
            problem.fmt(f)?;
        }
        Ok(())
    }
}
