//! What participants read of a study, in its own language and in others.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The language of a file that names none.
const UNNAMED: &str = "en";

/// What participants read; each text is a list of plain paragraphs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Texts {
    /// First page.
    pub welcome: Vec<String>,
    /// What taking part means.
    pub consent: Vec<String>,
    /// What to do, with the keys.
    pub instructions: Vec<String>,
    /// What was shown and measured, told afterwards.
    pub debriefing: Vec<String>,
    /// Last words, beside the completion code.
    pub thanks: Vec<String>,
}

/// What participants read of a study, in another language than its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Translation {
    /// Title.
    pub title: String,
    /// The question over every trial.
    pub question: String,
    /// What participants read.
    pub texts: Texts,
}

pub(crate) fn unnamed() -> String {
    UNNAMED.to_owned()
}

pub(crate) fn is_unnamed(language: &str) -> bool {
    language == UNNAMED
}
