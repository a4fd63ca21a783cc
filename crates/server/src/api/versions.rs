//! Which version of a study is meant, and which others count with it.

use super::{Problem, ProblemCode};
use kelir_house::selection::{INCLUDE_RULE, Include, RULE, SelectionError, VersionRef, With};
use serde::Deserialize;
use utoipa::IntoParams;

/// Which other versions' answers are pooled.
#[derive(Clone, Debug, Default, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub struct Pooling {
    /// Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's.
    pub with: Option<String>,
    /// Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma.
    pub include: Option<String>,
}

/// Reads the version in an address.
///
/// # Errors
/// It is neither `current` nor 8 to 64 hex digits.
pub fn version_ref(text: &str) -> Result<VersionRef, Box<Problem>> {
    text.parse().map_err(|_: SelectionError| Problem::parameter("version", text, RULE))
}

impl Pooling {
    /// The versions asked for.
    ///
    /// # Errors
    /// One of them is neither `current` nor 8 to 64 hex digits, or `all` is not alone.
    pub fn with(&self) -> Result<With, Box<Problem>> {
        let text = self.with.as_deref().unwrap_or_default();
        text.parse().map_err(|_: SelectionError| Problem::parameter("with", text, RULE))
    }

    /// The kinds of sessions asked for.
    ///
    /// # Errors
    /// One of them is none, or named twice.
    pub fn include(&self) -> Result<Include, Box<Problem>> {
        let text = self.include.as_deref().unwrap_or_default();
        text.parse().map_err(|_: SelectionError| Problem::parameter("include", text, INCLUDE_RULE))
    }
}

impl From<SelectionError> for Box<Problem> {
    fn from(error: SelectionError) -> Box<Problem> {
        match error {
            SelectionError::Store(error) => error.into(),
            SelectionError::Malformed(text) => Problem::parameter("version", &text, RULE),
            SelectionError::MalformedKinds(text) => Problem::parameter("include", &text, INCLUDE_RULE),
            SelectionError::Unknown(..) => Problem::not_found("version of this study"),
            SelectionError::NoVersion => {
                Problem::not_found("version of this study yet: its stimuli are not all made")
            }
            SelectionError::Ambiguous(beginning, _) => {
                let detail = format!("More than one version begins with {beginning}: give more digits.");
                Problem::new(ProblemCode::AmbiguousVersion, detail)
            }
        }
    }
}
