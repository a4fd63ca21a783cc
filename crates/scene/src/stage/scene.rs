//! A scene file that shows a stage.

use kelir_reader::Problem;

use super::Stage;
use super::moving::Placed;
use crate::timeline::Timeline;

/// A valid scene of a stage, still or moving.
#[derive(Debug)]
pub struct StageScene {
    pub(crate) label: String,
    pub(crate) sha256: String,
    pub(crate) toml: String,
    pub(crate) placed: Placed,
    pub(crate) timeline: Option<Timeline>,
    pub(crate) warnings: Vec<Problem>,
}

impl StageScene {
    /// What messages call it: the file that it was read from.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// What may be a mistake in it or in the files that it names, though it can be drawn.
    pub fn warnings(&self) -> &[Problem] {
        &self.warnings
    }

    /// SHA-256, in hexadecimal, over its values, every file that it names and every level that was made of one.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// The scene as TOML that reads to the same scene.
    pub fn to_toml(&self) -> &str {
        &self.toml
    }

    /// The scene as written, without its timeline.
    pub fn still(&self) -> Stage {
        self.placed.still.clone()
    }

    /// How the scene moves, if it does.
    pub fn timeline(&self) -> Option<&Timeline> {
        self.timeline.as_ref()
    }

    /// The scene at an instant of its timeline; as written when there is none.
    pub fn at(&self, time_s: f64) -> Stage {
        match &self.timeline {
            Some(timeline) => self.placed.at(timeline, timeline.instant_s(time_s)),
            None => self.still(),
        }
    }
}
