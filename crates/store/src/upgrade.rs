//! From the layout of before there were versions: each session gets the version of what it was shown, its trials become rows of their own.

use crate::error::StoreError;
use crate::files::Files;
use crate::pixels;
use crate::plans::{PlannedTrial, StimulusHashes, insert_trials};
use crate::stimuli::{StudyStimulus, blocking, read_json};
use crate::versions::put_version;
use kelir_study::trials::{Role, TrialKind};
use kelir_study::{StudyDefinition, Trial};
use serde::Deserialize;
use serde_json::{Value, json};
use sqlx::Row;
use sqlx::sqlite::SqliteConnection;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// A trial as sessions used to hold it.
#[derive(Deserialize)]
struct OldTrial {
    trial_index: u32,
    block_id: String,
    block_index: u32,
    pair_id: String,
    pair_index: u32,
    kind: kelir_study::Kind,
    left: String,
    right: String,
    left_sha256: String,
    right_sha256: String,
}

/// A study's file and the hash it was stored under.
struct OldFile {
    study: StudyDefinition,
    old_hash: String,
    loaded_at: String,
}

/// Brings everything over, in its caller's transaction; nothing where that has been done.
pub(crate) async fn from_first_layout(tx: &mut SqliteConnection, files: &Files) -> Result<(), StoreError> {
    let waiting = "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = 'study_stimuli'";
    if sqlx::query_scalar::<_, i64>(waiting).fetch_one(&mut *tx).await? == 0 {
        return Ok(());
    }
    sqlx::query("PRAGMA defer_foreign_keys = ON").execute(&mut *tx).await?;
    let pixels = hash_pixels(tx, files).await?;
    for file in old_files(tx).await? {
        bring_over(tx, &file, &pixels).await?;
    }
    for done in [
        "DROP TABLE study_stimuli",
        "ALTER TABLE sessions DROP COLUMN trials",
        "ALTER TABLE sessions DROP COLUMN trial_count",
    ] {
        sqlx::query(done).execute(&mut *tx).await?;
    }
    Ok(())
}

/// Hashes of files → hashes of what they show.
type PixelHashes = HashMap<String, String>;

/// Fills in what stored pictures show. One whose file is gone or damaged is known by its bytes alone: what it showed cannot be told any more.
async fn hash_pixels(tx: &mut SqliteConnection, files: &Files) -> Result<PixelHashes, StoreError> {
    let mut hashes = PixelHashes::new();
    let rows = sqlx::query("SELECT sha256, media_type FROM stimuli").fetch_all(&mut *tx).await?;
    for row in rows {
        let (sha256, media_type): (String, String) = (row.try_get("sha256")?, row.try_get("media_type")?);
        let (files, name) = (files.clone(), sha256.clone());
        let found = blocking(move || {
            let read = |name: &str| files.get(name).ok().flatten();
            let bytes = read(&name);
            Ok(bytes.and_then(|bytes| pixels::of(&media_type, &bytes, &read).ok()))
        })
        .await?;
        let (pixels, [width, height]) = match found {
            Some(pixels) => (pixels.sha256, pixels.size),
            None => (format!("file:{sha256}"), [0, 0]),
        };
        sqlx::query("UPDATE stimuli SET pixels_sha256 = $2, width = $3, height = $4 WHERE sha256 = $1")
            .bind(&sha256)
            .bind(&pixels)
            .bind(width)
            .bind(height)
            .execute(&mut *tx)
            .await?;
        hashes.insert(sha256, pixels);
    }
    Ok(hashes)
}

/// The stored files, those loaded first first.
async fn old_files(tx: &mut SqliteConnection) -> Result<Vec<OldFile>, StoreError> {
    let rows =
        sqlx::query("SELECT file_hash, definition, loaded_at FROM study_files ORDER BY loaded_at, rowid");
    let rows = rows.fetch_all(tx).await?;
    rows.iter()
        .map(|row| {
            let mut definition = read_json(row.try_get("definition")?)?;
            // Every block was of the one kind that there was.
            for block in definition["blocks"].as_array_mut().into_iter().flatten() {
                block["trial"] = json!(TrialKind::TwoAlternative.name());
            }
            let study = serde_json::from_value(definition).map_err(|e| StoreError::corrupt("study", e))?;
            Ok(OldFile { study, old_hash: row.try_get("file_hash")?, loaded_at: row.try_get("loaded_at")? })
        })
        .collect()
}

async fn bring_over(
    tx: &mut SqliteConnection,
    file: &OldFile,
    pixels: &PixelHashes,
) -> Result<(), StoreError> {
    let study = &file.study;
    let file_hash = study.file_hash();
    sqlx::query(
        "UPDATE study_files SET file_hash = $3, definition = $4 WHERE study_id = $1 AND file_hash = $2",
    )
    .bind(&study.id)
    .bind(&file.old_hash)
    .bind(&file_hash)
    .bind(study.to_json())
    .execute(&mut *tx)
    .await?;
    let sessions = sqlx::query(
        "SELECT session_id, trials, created_at FROM sessions WHERE study_id = $1 AND file_hash = $2 ORDER BY session_id",
    );
    let sessions = sessions.bind(&study.id).bind(&file.old_hash).fetch_all(&mut *tx).await?;
    // Many sessions saw the same pictures: each version is written once, with the time of its last session.
    let mut known = BTreeMap::<BTreeSet<(String, String, String)>, String>::new();
    for row in &sessions {
        let session_id: String = row.try_get("session_id")?;
        let created_at: String = row.try_get("created_at")?;
        let trials: Vec<OldTrial> =
            serde_json::from_str(row.try_get("trials")?).map_err(|e| StoreError::corrupt("trials", e))?;
        let shown: BTreeSet<_> = trials
            .iter()
            .flat_map(|t| [(&t.pair_id, &t.left, &t.left_sha256), (&t.pair_id, &t.right, &t.right_sha256)])
            .map(|(item, condition, sha256)| (item.clone(), condition.clone(), sha256.clone()))
            .collect();
        let version = match known.get(&shown) {
            Some(version) => version.clone(),
            None => {
                let stimuli = stimuli(tx, study, &shown, pixels).await?;
                let version = put_version(tx, study, &file_hash, &stimuli, &created_at).await?;
                known.insert(shown, version.clone());
                version
            }
        };
        let served = "UPDATE versions SET last_served_at = max(last_served_at, $3) WHERE study_id = $1 AND version = $2";
        sqlx::query(served).bind(&study.id).bind(&version).bind(&created_at).execute(&mut *tx).await?;
        sqlx::query("UPDATE sessions SET version = $2, file_hash = $3 WHERE session_id = $1")
            .bind(&session_id)
            .bind(&version)
            .bind(&file_hash)
            .execute(&mut *tx)
            .await?;
        let planned: Vec<PlannedTrial> = trials.into_iter().map(|trial| new_trial(trial, pixels)).collect();
        insert_trials(tx, &session_id, &planned, &created_at, 0).await?;
    }
    // What it showed last, with sessions or without.
    let last = sqlx::query(
        "SELECT pair_id, condition, sha256 FROM study_stimuli JOIN renders USING (job_key) WHERE study_id = $1 AND file_hash = $2",
    );
    let last = last.bind(&study.id).bind(&file.old_hash).fetch_all(&mut *tx).await?;
    let shown: BTreeSet<_> = last
        .iter()
        .map(|row| Ok((row.try_get("pair_id")?, row.try_get("condition")?, row.try_get("sha256")?)))
        .collect::<Result<_, StoreError>>()?;
    if shown.len() == study.blocks.iter().map(|block| 2 * block.items.len()).sum::<usize>() {
        let stimuli = stimuli(tx, study, &shown, pixels).await?;
        put_version(tx, study, &file_hash, &stimuli, &file.loaded_at).await?;
    }
    Ok(())
}

/// What was shown, with how it was made where that is still known.
async fn stimuli(
    tx: &mut SqliteConnection,
    study: &StudyDefinition,
    shown: &BTreeSet<(String, String, String)>,
    pixels: &PixelHashes,
) -> Result<Vec<StudyStimulus>, StoreError> {
    let mut stimuli = Vec::new();
    for (item, condition, sha256) in shown {
        // A missing stimulus used to be planned as an empty hash.
        let Some(pixels_sha256) = pixels.get(sha256) else { continue };
        let query = "SELECT provenance FROM renders WHERE sha256 = $1 ORDER BY created_at DESC LIMIT 1";
        let provenance: Option<String> =
            sqlx::query_scalar(query).bind(sha256).fetch_optional(&mut *tx).await?;
        stimuli.push(StudyStimulus {
            item: item.clone(),
            condition: condition.clone(),
            sha256: sha256.clone(),
            pixels_sha256: pixels_sha256.clone(),
            size: study.size,
            provenance: provenance.map_or(Ok(Value::Object(Default::default())), read_json)?,
        });
    }
    Ok(stimuli)
}

fn new_trial(old: OldTrial, pixels: &PixelHashes) -> PlannedTrial {
    let trial = TrialKind::TwoAlternative;
    let hashes = |sha256: String| {
        let pixels_sha256 = pixels.get(&sha256).cloned().unwrap_or_default();
        StimulusHashes { sha256, pixels_sha256 }
    };
    let stimuli = [(Role::Left, hashes(old.left_sha256)), (Role::Right, hashes(old.right_sha256))].into();
    let trial = Trial {
        trial_index: old.trial_index,
        // Whichever is the target: the left one comes first.
        shown: trial.rules().plan(&old.pair_id, &old.left, &old.right, true),
        trial,
        block_id: old.block_id,
        block_index: old.block_index,
        item_id: old.pair_id,
        item_index: old.pair_index,
        repeat: 0,
        kind: old.kind,
    };
    PlannedTrial { trial, stimuli }
}
