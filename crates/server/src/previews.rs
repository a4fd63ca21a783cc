//! Previews: a study taken in memory. Nothing of them is stored, and they hold no place in the design.

use crate::loaded::Begun;
use kelir_store::{NextTrials, PlannedTrial, Progress};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How many there may be at once; the one that was silent longest gives way.
const MOST: usize = 64;
/// How long a silent one is kept.
const LASTING: Duration = Duration::from_secs(2 * 3600);
/// What the ids of previews begin with.
pub(crate) const PREFIX: &str = "preview-";

/// A preview under way.
pub(crate) struct Preview {
    pub(crate) token_hash: String,
    pub(crate) begun: Begun,
    pub(crate) slot: u32,
    pub(crate) trials: Vec<PlannedTrial>,
    pub(crate) more: bool,
    /// The language that it is taken in.
    pub(crate) language: String,
    pub(crate) consented: bool,
    /// By trial index, as canonical JSON.
    pub(crate) answers: BTreeMap<u32, String>,
    pub(crate) is_finished: bool,
}

impl Preview {
    /// Takes an answer, the first one of each trial; `next` decides what follows.
    pub(crate) fn answer<E>(
        &mut self,
        trial_index: u32,
        answer: String,
        next: impl FnOnce(&Begun, u32, &Progress) -> Result<NextTrials, E>,
    ) -> Result<(), E> {
        if self.answers.contains_key(&trial_index) {
            return Ok(());
        }
        let mut answers = self.answers.clone();
        answers.insert(trial_index, answer);
        if self.more {
            let progress = Progress { trials: self.trials.clone(), answers: answers.clone() };
            let decided = next(&self.begun, self.slot, &progress)?;
            self.trials.extend(decided.trials);
            self.more = decided.more;
        }
        self.answers = answers;
        Ok(())
    }

    /// Indices of the decided trials without an answer.
    pub(crate) fn missing(&self) -> Vec<u32> {
        let indices = self.trials.iter().map(|planned| planned.trial.trial_index);
        indices.filter(|index| !self.answers.contains_key(index)).collect()
    }
}

/// All previews under way, by id.
#[derive(Default)]
pub(crate) struct Previews(Mutex<BTreeMap<String, (Instant, Preview)>>);

impl Previews {
    /// Keeps a new one; answers its id.
    pub(crate) fn begin(&self, preview: Preview) -> String {
        let id = format!("{PREFIX}{}", uuid::Uuid::new_v4().simple());
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|_, (seen, _)| seen.elapsed() < LASTING);
        while all.len() >= MOST {
            let silent = all.iter().min_by_key(|(_, (seen, _))| *seen).map(|(id, _)| id.clone());
            silent.map(|id| all.remove(&id));
        }
        all.insert(id.clone(), (Instant::now(), preview));
        id
    }

    /// Does something with the preview of this id, for who holds its token.
    pub(crate) fn with<T>(
        &self,
        id: &str,
        token_hash: &str,
        work: impl FnOnce(&mut Preview) -> T,
    ) -> Option<T> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (seen, preview) = all.get_mut(id)?;
        if preview.token_hash != token_hash {
            return None;
        }
        *seen = Instant::now();
        Some(work(preview))
    }
}
