//! Study files and versions of studies: everything that was ever served, so that data can be read without its file.

use crate::clock;
use crate::error::StoreError;
use crate::sessions::Participants;
use crate::sqlite::Store;
use crate::stimuli::StudyStimulus;
use kelir_study::StudyDefinition;
use kelir_study::versions::VersionStimulus;
use rusqlite::{Connection, params};
use sqlx::Row;
use sqlx::sqlite::SqliteRow;
use std::collections::HashMap;
use std::time::Duration;

/// A stored version of a study.
#[derive(Clone, Debug)]
pub struct StudyVersion {
    /// Its hash: of the design and of the pixels shown.
    pub version: String,
    /// Hash of the design alone.
    pub design_hash: String,
    /// The file by which it was served last.
    pub file_hash: String,
    /// That file's definition.
    pub study: StudyDefinition,
    /// When it was first served, ISO-8601 UTC.
    pub first_served_at: String,
    /// When it was last served.
    pub last_served_at: String,
}

/// What a version has gathered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VersionCounts {
    /// How many people take part.
    pub participants: Participants,
    /// Answers stored.
    pub answers: u64,
}

impl Store {
    /// Stores a study's file; known or not. Answers its hash.
    ///
    /// # Errors
    /// The database fails.
    pub async fn put_study_file(&self, study: &StudyDefinition) -> Result<String, StoreError> {
        let file_hash = study.file_hash();
        let study = study.clone();
        self.write(move |writer| put_file(writer, &study, &file_hash).map(|()| file_hash)).await
    }

    /// Stores the version that a study's file and these stimuli make, and that it is served now. What it shows is written once: a version that
    /// is known keeps its stimuli, whose pixels are the same. Answers the version.
    ///
    /// # Errors
    /// The database fails.
    pub async fn put_version(
        &self,
        study: &StudyDefinition,
        stimuli: &[StudyStimulus],
    ) -> Result<String, StoreError> {
        let file_hash = study.file_hash();
        let (study, stimuli) = (study.clone(), stimuli.to_owned());
        self.write(move |writer| {
            put_file(writer, &study, &file_hash)?;
            put_version(writer, &study, &file_hash, &stimuli, &clock::now())
        })
        .await
    }

    /// The versions of a study, the one served last first; empty for an unknown study.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn study_versions(&self, study_id: &str) -> Result<Vec<StudyVersion>, StoreError> {
        let rows = sqlx::query(
            "SELECT v.*, f.definition FROM versions v JOIN study_files f USING (study_id, file_hash)
             WHERE v.study_id = $1 ORDER BY v.last_served_at DESC, v.rowid DESC",
        )
        .bind(study_id)
        .fetch_all(&self.reader)
        .await?;
        rows.iter().map(read_version).collect()
    }

    /// The definition of a study's file.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn study_file(
        &self,
        study_id: &str,
        file_hash: &str,
    ) -> Result<Option<StudyDefinition>, StoreError> {
        let query = "SELECT definition FROM study_files WHERE study_id = $1 AND file_hash = $2";
        let definition: Option<String> =
            sqlx::query_scalar(query).bind(study_id).bind(file_hash).fetch_optional(&self.reader).await?;
        definition.map(|text| parse(&text)).transpose()
    }

    /// How many participants and answers each version of a study has; `idle` as for sessions.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn version_counts(
        &self,
        study_id: &str,
        idle: Duration,
    ) -> Result<HashMap<String, VersionCounts>, StoreError> {
        let mut counts = HashMap::<String, VersionCounts>::new();
        let people = sqlx::query(
            "SELECT version, count(*) AS started, count(completed_at) AS completed,
             count(CASE WHEN completed_at IS NULL AND last_seen_at > $2 THEN 1 END) AS in_progress
             FROM sessions WHERE study_id = $1 AND kind = 'participant' GROUP BY version",
        );
        for row in people.bind(study_id).bind(clock::before_now(idle)).fetch_all(&self.reader).await? {
            let count = |column| row.try_get::<i64, _>(column).map(|n| n as u64);
            let participants = Participants {
                started: count("started")?,
                in_progress: count("in_progress")?,
                completed: count("completed")?,
            };
            counts.entry(row.try_get("version")?).or_default().participants = participants;
        }
        for table in ["responses", "answers"] {
            let query = format!(
                "SELECT s.version, count(*) AS n FROM {table} a JOIN sessions s USING (session_id)
                 WHERE s.study_id = $1 GROUP BY s.version"
            );
            let query = sqlx::query(sqlx::AssertSqlSafe(query)).bind(study_id);
            for row in query.fetch_all(&self.reader).await? {
                counts.entry(row.try_get("version")?).or_default().answers +=
                    row.try_get::<i64, _>("n")? as u64;
            }
        }
        Ok(counts)
    }

    /// Ids of all studies ever loaded, sorted.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn study_ids(&self) -> Result<Vec<String>, StoreError> {
        Ok(sqlx::query_scalar("SELECT DISTINCT study_id FROM study_files ORDER BY study_id")
            .fetch_all(&self.reader)
            .await?)
    }
}

fn put_file(writer: &Connection, study: &StudyDefinition, file_hash: &str) -> Result<(), StoreError> {
    writer.execute(
        "INSERT INTO study_files (study_id, file_hash, definition, loaded_at) VALUES (?1, ?2, ?3, ?4)
         ON CONFLICT (study_id, file_hash) DO UPDATE SET loaded_at = excluded.loaded_at",
        params![study.id, file_hash, study.to_json(), clock::now()],
    )?;
    Ok(())
}

/// Writes the version that a stored file and these stimuli make; of one that is known, that it was served.
pub(crate) fn put_version(
    writer: &Connection,
    study: &StudyDefinition,
    file_hash: &str,
    stimuli: &[StudyStimulus],
    now: &str,
) -> Result<String, StoreError> {
    let shown: Vec<VersionStimulus> = stimuli
        .iter()
        .map(|s| VersionStimulus {
            item: s.item.clone(),
            condition: s.condition.clone(),
            size: s.size,
            pixels_sha256: s.pixels_sha256.clone(),
        })
        .collect();
    let version = study.version(&shown);
    let known = "SELECT EXISTS (SELECT 1 FROM versions WHERE study_id = ?1 AND version = ?2)";
    let known: bool = writer.query_row(known, [&study.id, &version], |row| row.get(0))?;
    writer.execute(
        "INSERT INTO versions (study_id, version, design_hash, file_hash, first_served_at, last_served_at) VALUES (?1, ?2, ?3, ?4, ?5, ?5)
         ON CONFLICT (study_id, version) DO UPDATE SET file_hash = excluded.file_hash,
         first_served_at = min(first_served_at, excluded.first_served_at), last_served_at = max(last_served_at, excluded.last_served_at)",
        params![study.id, version, study.design_hash(), file_hash, now],
    )?;
    if known {
        return Ok(version);
    }
    let mut insert = writer.prepare(
        "INSERT INTO version_stimuli (study_id, version, item_id, condition, width, height, sha256, pixels_sha256, provenance)
         VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)",
    )?;
    for StudyStimulus { item, condition, sha256, pixels_sha256, size: [width, height], provenance } in stimuli
    {
        let provenance = provenance.to_string();
        insert.execute(params![
            study.id,
            version,
            item,
            condition,
            width,
            height,
            sha256,
            pixels_sha256,
            provenance
        ])?;
    }
    Ok(version)
}

fn parse(definition: &str) -> Result<StudyDefinition, StoreError> {
    serde_json::from_str(definition).map_err(|e| StoreError::corrupt("study", e))
}

fn read_version(row: &SqliteRow) -> Result<StudyVersion, StoreError> {
    Ok(StudyVersion {
        version: row.try_get("version")?,
        design_hash: row.try_get("design_hash")?,
        file_hash: row.try_get("file_hash")?,
        study: parse(row.try_get("definition")?)?,
        first_served_at: row.try_get("first_served_at")?,
        last_served_at: row.try_get("last_served_at")?,
    })
}
