//! Plans: what each trial of a session shows, appended as it is decided.

use crate::answer_row::ShownStimulus;
use crate::error::StoreError;
use crate::sqlite::Store;
use kelir_study::trials::Role;
use rusqlite::{Connection, OptionalExtension, params};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The beginning of a slot's plan with the stimuli filled in.
#[derive(Clone, Debug)]
pub struct PlannedSession {
    /// Seed of the plan.
    pub seed: String,
    /// The first trials, and whether answers will decide others.
    pub next: NextTrials,
}

/// What comes next in a session.
#[derive(Clone, Debug, Default)]
pub struct NextTrials {
    /// The trials that follow those decided before.
    pub trials: Vec<PlannedTrial>,
    /// Whether answers will decide others.
    pub more: bool,
}

/// The hashes of a stimulus.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StimulusHashes {
    /// Hash of the file.
    pub sha256: String,
    /// Hash of its decoded pixels.
    pub pixels_sha256: String,
}

/// One trial of a session: what is shown in which role.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlannedTrial {
    /// The trial as the study plans it.
    #[serde(flatten)]
    pub trial: kelir_study::Trial,
    /// The stimulus of each of its roles, at the study's smallest size.
    pub stimuli: BTreeMap<Role, StimulusHashes>,
    /// The same at each further size, by rising width; none where the study has one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub larger: Vec<SizedStimuli>,
}

/// The stimuli of a trial at one size.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SizedStimuli {
    /// [width, height] in pixels.
    pub size: [u32; 2],
    /// The stimulus of each role.
    pub stimuli: BTreeMap<Role, StimulusHashes>,
}

impl PlannedTrial {
    /// What is shown at a size, as a row of answers says it; at the smallest where none is said, or none that the study has.
    ///
    /// # Errors
    /// A role has no stimulus.
    pub fn shown(&self, size: Option<[u32; 2]>) -> Result<BTreeMap<Role, ShownStimulus>, StoreError> {
        let larger = self.larger.iter().find(|larger| Some(larger.size) == size);
        let stimuli = larger.map_or(&self.stimuli, |larger| &larger.stimuli);
        let of = |(role, placed): (&Role, &kelir_study::trials::Placed<'_>)| {
            let hashes = stimuli.get(role).ok_or_else(|| {
                let message =
                    format!("item {} has no stimulus of condition {}", placed.item, placed.condition);
                StoreError::corrupt("trial", message)
            })?;
            let shown = ShownStimulus {
                item: placed.item.to_string(),
                condition: placed.condition.to_string(),
                sha256: hashes.sha256.clone(),
                pixels_sha256: hashes.pixels_sha256.clone(),
            };
            Ok((*role, shown))
        };
        self.trial.shown.iter().map(of).collect()
    }
}

impl Store {
    /// The trials of a session that are decided so far, in order.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn trials(&self, session_id: &str) -> Result<Vec<PlannedTrial>, StoreError> {
        self.trials_from(session_id, 0).await
    }

    /// Those from this index on.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn trials_from(&self, session_id: &str, from: u32) -> Result<Vec<PlannedTrial>, StoreError> {
        let session_id = session_id.to_owned();
        self.readers.read(move |connection| decided(connection, &session_id, from)).await
    }

    /// One trial of a session; `None` where none of this index is decided.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn trial(
        &self,
        session_id: &str,
        trial_index: u32,
    ) -> Result<Option<PlannedTrial>, StoreError> {
        let session_id = session_id.to_owned();
        self.readers.read(move |connection| trial(connection, &session_id, trial_index)).await
    }

    /// Which plan a session has: when its first trial was decided, ISO-8601 UTC; `None` for an unknown session.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn plan(&self, session_id: &str) -> Result<Option<String>, StoreError> {
        let session_id = session_id.to_owned();
        self.readers.read(move |connection| plan_of(connection, &session_id)).await
    }

    /// The first trial of a session that is decided and has no answer; `None` where there is none.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn next_trial(&self, session_id: &str) -> Result<Option<u32>, StoreError> {
        let session_id = session_id.to_owned();
        self.readers.read(move |connection| next_trial(connection, &session_id)).await
    }
}

pub(crate) fn next_trial(connection: &Connection, session_id: &str) -> Result<Option<u32>, StoreError> {
    // Where the answers have no gap, as they seldom have, the trials before their end need no second look.
    let mut answers = connection.prepare_cached(
        "SELECT CASE count(*) WHEN max(trial_index) + 1 THEN count(*) ELSE 0 END FROM answers WHERE session_id = ?1",
    )?;
    let from: u32 = answers.query_row([session_id], |row| row.get(0))?;
    let mut query = connection.prepare_cached(
        "SELECT trial_index FROM session_trials t WHERE session_id = ?1 AND trial_index >= ?2
         AND NOT EXISTS (SELECT 1 FROM answers a WHERE a.session_id = ?1 AND a.trial_index = t.trial_index)
         AND NOT EXISTS (SELECT 1 FROM responses r WHERE r.session_id = ?1 AND r.trial_index = t.trial_index)
         ORDER BY trial_index LIMIT 1",
    )?;
    Ok(query.query_row((session_id, from), |row| row.get(0)).optional()?)
}

/// A plan that is decided anew is so after a time of silence, so that no two of a session begin at one moment.
pub(crate) fn plan_of(connection: &Connection, session_id: &str) -> Result<Option<String>, StoreError> {
    let mut query = connection
        .prepare_cached("SELECT decided_at FROM session_trials WHERE session_id = ?1 AND trial_index = 0")?;
    Ok(query.query_row([session_id], |row| row.get(0)).optional()?)
}

pub(crate) fn trial(
    connection: &Connection,
    session_id: &str,
    trial_index: u32,
) -> Result<Option<PlannedTrial>, StoreError> {
    let mut query = connection
        .prepare_cached("SELECT trial FROM session_trials WHERE session_id = ?1 AND trial_index = ?2")?;
    let trial: Option<String> = query.query_row((session_id, trial_index), |row| row.get(0)).optional()?;
    trial.as_deref().map(read).transpose()
}

fn read(trial: &str) -> Result<PlannedTrial, StoreError> {
    serde_json::from_str(trial).map_err(|e| StoreError::corrupt("trial", e))
}

pub(crate) fn decided(
    connection: &Connection,
    session_id: &str,
    from: u32,
) -> Result<Vec<PlannedTrial>, StoreError> {
    let mut query = connection.prepare_cached(
        "SELECT trial FROM session_trials WHERE session_id = ?1 AND trial_index >= ?2 ORDER BY trial_index",
    )?;
    let mut rows = query.query((session_id, from))?;
    let mut trials = Vec::new();
    while let Some(row) = rows.next()? {
        trials.push(read(row.get_ref(0)?.as_str().map_err(rusqlite::Error::from)?)?);
    }
    Ok(trials)
}

/// Takes the plan of a session away that has no answer yet; the database refuses for any other.
pub(crate) fn forget_trials(writer: &Connection, session_id: &str) -> Result<(), StoreError> {
    writer.execute("DELETE FROM session_trials WHERE session_id = ?1", [session_id])?;
    Ok(())
}

/// Appends trials, decided now from the study's answers up to `after_seq`.
pub(crate) fn insert_trials(
    writer: &Connection,
    session_id: &str,
    trials: &[PlannedTrial],
    now: &str,
    after_seq: i64,
) -> Result<(), StoreError> {
    let mut insert = writer.prepare_cached(
        "INSERT INTO session_trials (session_id, trial_index, trial, decided_at, after_seq) VALUES (?1, ?2, ?3, ?4, ?5)",
    )?;
    for planned in trials {
        let trial = serde_json::to_string(planned).map_err(|e| StoreError::corrupt("trial", e))?;
        insert.execute(params![session_id, planned.trial.trial_index, trial, now, after_seq])?;
    }
    Ok(())
}
