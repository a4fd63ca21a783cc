//! One stimulus to make, and who makes it.

use crate::library::{Library, beside};
use kelir_study::{Block, Condition, Item, StudyDefinition};
use serde_json::Value;

/// One stimulus to make: a pair of a study under one of its conditions at one of its sizes.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The study.
    pub study: &'a StudyDefinition,
    /// The pair's block.
    pub block: &'a Block,
    /// The pair.
    pub pair: &'a Item,
    /// The condition's name.
    pub name: &'a str,
    /// The condition.
    pub condition: &'a Condition,
    /// Place of its size among the study's.
    pub rank: usize,
    /// The size [width, height] in pixels.
    pub size: [u32; 2],
}

impl Task<'_> {
    /// How many times as wide it is as the study's smallest size.
    pub fn magnification(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.study.size[0])
    }

    /// Pair and condition in words, and the size where the study has several.
    pub(crate) fn in_words(&self) -> String {
        let [width, height] = self.size;
        match self.study.sizes() {
            [_] => format!("{} ({})", self.pair.id, self.name),
            _ => format!("{} ({}, {width} × {height})", self.pair.id, self.name),
        }
    }

    /// The study's file in the library.
    pub fn study_file(&self) -> String {
        format!("studies/{}.toml", self.study.id)
    }

    /// The pair's scene in the library.
    pub fn scene_file(&self) -> Option<String> {
        self.pair.scene.as_ref().map(|scene| beside(&self.study_file(), scene))
    }
}

/// A finished stimulus.
#[derive(Clone, Debug)]
pub struct Made {
    /// Media type of `bytes`.
    pub media_type: String,
    /// What is shown, or the manifest of an animation.
    pub bytes: Vec<u8>,
    /// Media type and bytes of what the manifest names by hash.
    pub attachments: Vec<(String, Vec<u8>)>,
    /// How it was made, with its measured error.
    pub provenance: Value,
}

/// Draws stimuli: the door to the renderer, so that tests can stand something else in it.
pub trait Maker: Send + Sync + 'static {
    /// A text that is equal for two tasks exactly when they would make the same stimulus.
    ///
    /// # Errors
    /// What is wrong with the task's scene or condition.
    fn identity(&self, task: &Task<'_>, library: &Library) -> Result<String, String>;

    /// Makes the stimulus. `progress` takes the part that is done, 0..=1, and what is being done.
    ///
    /// # Errors
    /// Why it cannot be made.
    fn make(
        &self,
        task: &Task<'_>,
        library: &Library,
        progress: &mut (dyn FnMut(f64, &str) + Send),
    ) -> Result<Made, String>;
}

/// Every stimulus of a study, in the order of its file, each by rising size.
pub(crate) fn tasks(study: &StudyDefinition) -> Vec<Task<'_>> {
    let mut tasks = Vec::new();
    for block in &study.blocks {
        for pair in &block.items {
            for name in &block.conditions {
                let Some(condition) = study.conditions.get(name) else { continue };
                for (rank, size) in study.sizes().iter().copied().enumerate() {
                    tasks.push(Task { study, block, pair, name, condition, rank, size });
                }
            }
        }
    }
    tasks
}
