//! What checks of several files find, as text or as one JSON document.

use std::path::Path;

use anyhow::Result;
use kelir_study::{Problem, Problems};
use serde_json::{Value, json};

use crate::BadInput;
use crate::output::{print, print_json};

/// What was found so far. Exit code 2 once something is wrong.
pub(super) struct Checked {
    json: bool,
    files: Vec<Value>,
    problems: Vec<String>,
}

impl Checked {
    /// Nothing yet.
    pub(super) fn new(json: bool) -> Checked {
        Checked { json, files: Vec::new(), problems: Vec::new() }
    }

    /// A file that is good; `details` says what it is, for people and for programs. `warnings` are what may be a mistake all the same.
    pub(super) fn good(
        &mut self,
        file: &Path,
        details: &str,
        about: Value,
        warnings: &[Problem],
    ) -> Result<()> {
        let file = file.display().to_string();
        self.files.push(
            json!({ "file": file, "good": true, "about": about, "problems": [], "warnings": warnings }),
        );
        if self.json {
            return Ok(());
        }
        let verdict = if warnings.is_empty() { "good" } else { "good, but see below" };
        print(&format!("{file}: {verdict} ({details})"))?;
        warnings.iter().try_for_each(|warning| print(&format!("warning: {warning}")))
    }

    /// A file that is wrong.
    pub(super) fn wrong(&mut self, file: &Path, problems: &Problems) {
        self.add(file, None, problems, problems.to_string());
    }

    /// A file that can be read, and is wrong; `about` says for programs what it is.
    pub(super) fn bad(&mut self, file: &Path, about: Value, problems: &Problems) {
        self.add(file, Some(about), problems, problems.to_string());
    }

    /// A file that could not be read at all.
    pub(super) fn unreadable(&mut self, file: &Path, rule: String) {
        let problem = Problem::new(file.display().to_string(), "", None, rule.clone());
        self.add(file, None, &[problem], rule);
    }

    fn add(&mut self, file: &Path, about: Option<Value>, problems: &[Problem], text: String) {
        let mut wrong = json!({ "file": file.display().to_string(), "good": false, "problems": problems });
        if let Some(about) = about {
            wrong["about"] = about;
        }
        self.files.push(wrong);
        self.problems.push(text);
    }

    /// Prints what is left to print.
    pub(super) fn finish(self) -> Result<()> {
        if self.json {
            print_json(&self.files)?;
        }
        if self.problems.is_empty() { Ok(()) } else { Err(BadInput(self.problems.join("\n")).into()) }
    }
}
