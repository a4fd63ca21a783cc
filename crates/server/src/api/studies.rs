//! Studies and their versions.

use kelir_house::versions::StudyVersion;
use kelir_report::Participants;
use kelir_study::schema::{Column, worded};
use kelir_study::trials::TrialName;
use kelir_study::{Fit, ResponseRules, Texts, Translation};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use utoipa::ToSchema;

/// What a study says of itself before anybody takes part.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Study {
    /// Its id, as in addresses.
    pub id: String,
    /// Title.
    pub title: String,
    /// The question over every trial.
    pub question: String,
    /// Linear luminance of the grey around the stimuli, 0 to 1.
    pub surround: f64,
    /// Stimulus size [width, height] in pixels; the smallest where there are several.
    #[schema(min_items = 2, max_items = 2, value_type = Vec<u32>)]
    pub size: [u32; 2],
    /// In which sizes stimuli are made and shown.
    pub display: Display,
    /// What participants read.
    pub texts: Texts,
    /// The language of title, question and texts (BCP 47).
    pub language: String,
    /// The same in other languages, by tag.
    pub translations: BTreeMap<String, Translation>,
    /// How long taking part is said to take, in minutes.
    pub estimated_minutes: u32,
    /// When an input counts as a response.
    pub response: ResponseRules,
    /// Whether each visit is somebody else's, as on a laboratory's computer.
    pub per_visit: bool,
    /// Kinds of trial, in the order of first use.
    pub trial_kinds: Vec<TrialName>,
}

/// In which sizes stimuli are made and shown.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Display {
    /// Sizes [width, height] at which each stimulus is made, in pixels, by rising width.
    #[schema(min_items = 1)]
    pub sizes: Vec<[u32; 2]>,
    /// What a page does with more room than a size fills.
    pub fit: Fit,
}

worded! {
    /// Whether participants can come.
    pub enum StudyStatus {
        /// They can.
        Ready = "ready",
        /// Its stimuli are still being made.
        Preparing = "preparing",
        /// Its stimuli could not be made.
        Failed = "failed",
    }
}

/// How far the stimuli are.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Progress {
    /// Stimuli that are ready.
    pub done: usize,
    /// Stimuli in all.
    pub total: usize,
    /// What is being made now.
    pub stimulus: String,
}

/// A study as the researchers' list has it.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct StudySummary {
    /// Its id, as in addresses.
    pub id: String,
    /// Title.
    pub title: String,
    /// The version that is served; null while its stimuli are not all made.
    #[schema(required)]
    pub version: Option<String>,
    /// SHA-256 of what the study file says.
    pub file_hash: String,
    /// Whether participants can come.
    pub status: StudyStatus,
    /// Of a study that is being prepared: how far it is, once it has begun.
    #[schema(required)]
    pub progress: Option<Progress>,
    /// Of a study that failed: why.
    #[schema(required)]
    pub reason: Option<String>,
    /// What may be a mistake in its file, and is served all the same.
    pub warnings: Vec<String>,
    /// Most trials that a participant sees.
    pub most_trials: usize,
    /// How many people take part in the version that is served.
    pub participants: Participants,
}

/// One page of the studies.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct StudyList {
    /// The studies on it.
    pub items: Vec<StudySummary>,
    /// What to ask with for the next page; null on the last one.
    #[schema(required)]
    pub next_cursor: Option<String>,
}

/// One page of the versions of a study.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct VersionList {
    /// The versions of a study on it.
    pub items: Vec<StudyVersion>,
    /// What to ask with for the next page; null on the last one.
    #[schema(required)]
    pub next_cursor: Option<String>,
}

/// What the columns of a table are.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct Codebook {
    /// The columns, in the table's order.
    pub columns: Vec<Column>,
}
