//! From the layout of before there were versions: each session gets the version of what it was shown, its trials become rows of their own.

use crate::error::StoreError;
use crate::files::Files;
use crate::pixels;
use crate::plans::{PlannedTrial, StimulusHashes, insert_trials};
use crate::stimuli::{StudyStimulus, read_json};
use crate::versions::put_version;
use kelir_study::trials::{Role, TrialKind};
use kelir_study::{StudyDefinition, Trial};
use rusqlite::{Connection, OptionalExtension, params};
use serde::Deserialize;
use serde_json::{Value, json};
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

/// Rows of so many texts.
fn rows<const N: usize>(
    tx: &Connection,
    query: &str,
    of: impl rusqlite::Params,
) -> Result<Vec<[String; N]>, StoreError> {
    let texts = |row: &rusqlite::Row<'_>| {
        let mut texts = [const { String::new() }; N];
        for (column, text) in texts.iter_mut().enumerate() {
            *text = row.get(column)?;
        }
        Ok(texts)
    };
    Ok(tx.prepare(query)?.query_map(of, texts)?.collect::<Result<_, _>>()?)
}

/// A study's file and the hash it was stored under.
struct OldFile {
    study: StudyDefinition,
    old_hash: String,
    loaded_at: String,
}

/// Brings everything over, in its caller's transaction; nothing where that has been done.
pub(crate) fn from_first_layout(tx: &Connection, files: &Files) -> Result<(), StoreError> {
    let waiting = "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = 'study_stimuli'";
    if tx.query_row(waiting, [], |row| row.get::<_, i64>(0))? == 0 {
        return Ok(());
    }
    tx.execute_batch("PRAGMA defer_foreign_keys = ON")?;
    let pixels = hash_pixels(tx, files)?;
    for file in old_files(tx)? {
        bring_over(tx, &file, &pixels)?;
    }
    tx.execute_batch(
        "DROP TABLE study_stimuli; ALTER TABLE sessions DROP COLUMN trials; ALTER TABLE sessions DROP COLUMN trial_count;",
    )?;
    Ok(())
}

/// Hashes of files → hashes of what they show.
type PixelHashes = HashMap<String, String>;

/// Fills in what stored pictures show. One whose file is gone or damaged is known by its bytes alone: what it showed cannot be told any more.
fn hash_pixels(tx: &Connection, files: &Files) -> Result<PixelHashes, StoreError> {
    let mut hashes = PixelHashes::new();
    let read = |name: &str| files.get(name).ok().flatten();
    for [sha256, media_type] in rows(tx, "SELECT sha256, media_type FROM stimuli", [])? {
        let found = read(&sha256).and_then(|bytes| pixels::of(&media_type, &bytes, &read).ok());
        let (pixels, [width, height]) = match found {
            Some(pixels) => (pixels.sha256, pixels.size),
            None => (format!("file:{sha256}"), [0, 0]),
        };
        tx.execute(
            "UPDATE stimuli SET pixels_sha256 = ?2, width = ?3, height = ?4 WHERE sha256 = ?1",
            params![sha256, pixels, width, height],
        )?;
        hashes.insert(sha256, pixels);
    }
    Ok(hashes)
}

/// The stored files, those loaded first first.
fn old_files(tx: &Connection) -> Result<Vec<OldFile>, StoreError> {
    let query = "SELECT file_hash, definition, loaded_at FROM study_files ORDER BY loaded_at, rowid";
    rows(tx, query, [])?
        .into_iter()
        .map(|[old_hash, definition, loaded_at]| {
            let mut definition = read_json(definition)?;
            // Every block was of the one kind that there was.
            for block in definition["blocks"].as_array_mut().into_iter().flatten() {
                block["trial"] = json!(TrialKind::TwoAlternative.name());
            }
            let study = serde_json::from_value(definition).map_err(|e| StoreError::corrupt("study", e))?;
            Ok(OldFile { study, old_hash, loaded_at })
        })
        .collect()
}

fn bring_over(tx: &Connection, file: &OldFile, pixels: &PixelHashes) -> Result<(), StoreError> {
    let study = &file.study;
    let file_hash = study.file_hash();
    tx.execute(
        "UPDATE study_files SET file_hash = ?3, definition = ?4 WHERE study_id = ?1 AND file_hash = ?2",
        params![study.id, file.old_hash, file_hash, study.to_json()],
    )?;
    let old = [&study.id, &file.old_hash];
    let sessions = "SELECT session_id, trials, created_at FROM sessions WHERE study_id = ?1 AND file_hash = ?2 ORDER BY session_id";
    // Many sessions saw the same pictures: each version is written once, with the time of its last session.
    let mut known = BTreeMap::<BTreeSet<(String, String, String)>, String>::new();
    for [session_id, trials, created_at] in rows(tx, sessions, old)? {
        let trials: Vec<OldTrial> =
            serde_json::from_str(&trials).map_err(|e| StoreError::corrupt("trials", e))?;
        let shown: BTreeSet<_> = trials
            .iter()
            .flat_map(|t| [(&t.pair_id, &t.left, &t.left_sha256), (&t.pair_id, &t.right, &t.right_sha256)])
            .map(|(item, condition, sha256)| (item.clone(), condition.clone(), sha256.clone()))
            .collect();
        let version = match known.get(&shown) {
            Some(version) => version.clone(),
            None => {
                let stimuli = stimuli(tx, study, &shown, pixels)?;
                let version = put_version(tx, study, &file_hash, &stimuli, &created_at)?;
                known.insert(shown, version.clone());
                version
            }
        };
        tx.execute(
            "UPDATE versions SET last_served_at = max(last_served_at, ?3) WHERE study_id = ?1 AND version = ?2",
            [&study.id, &version, &created_at],
        )?;
        tx.execute(
            "UPDATE sessions SET version = ?2, file_hash = ?3 WHERE session_id = ?1",
            [&session_id, &version, &file_hash],
        )?;
        let planned: Vec<PlannedTrial> = trials.into_iter().map(|trial| new_trial(trial, pixels)).collect();
        insert_trials(tx, &session_id, &planned, &created_at, 0)?;
    }
    // What it showed last, with sessions or without.
    let last = "SELECT pair_id, condition, sha256 FROM study_stimuli JOIN renders USING (job_key) WHERE study_id = ?1 AND file_hash = ?2";
    let shown: BTreeSet<_> = rows(tx, last, old)?.into_iter().map(<(String, String, String)>::from).collect();
    if shown.len() == study.blocks.iter().map(|block| 2 * block.items.len()).sum::<usize>() {
        let stimuli = stimuli(tx, study, &shown, pixels)?;
        put_version(tx, study, &file_hash, &stimuli, &file.loaded_at)?;
    }
    Ok(())
}

/// What was shown, with how it was made where that is still known.
fn stimuli(
    tx: &Connection,
    study: &StudyDefinition,
    shown: &BTreeSet<(String, String, String)>,
    pixels: &PixelHashes,
) -> Result<Vec<StudyStimulus>, StoreError> {
    let mut stimuli = Vec::new();
    for (item, condition, sha256) in shown {
        // A missing stimulus used to be planned as an empty hash.
        let Some(pixels_sha256) = pixels.get(sha256) else { continue };
        let query = "SELECT provenance FROM renders WHERE sha256 = ?1 ORDER BY created_at DESC LIMIT 1";
        let provenance: Option<String> = tx.query_row(query, [sha256], |row| row.get(0)).optional()?;
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
    PlannedTrial { trial, stimuli, larger: Vec::new() }
}
