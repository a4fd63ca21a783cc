//! Stimuli: bytes made once, with where they came from.

use crate::clock;
use crate::error::StoreError;
use crate::files::is_sha256;
use crate::sqlite::Store;
use serde::Serialize;
use serde_json::Value;
use sqlx::Row;

/// What is known of stored bytes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct StimulusInfo {
    /// SHA-256 of the bytes.
    pub sha256: String,
    /// Media type to serve them as.
    pub media_type: String,
    /// Size in bytes.
    pub size_bytes: u64,
}

/// A finished rendering job.
#[derive(Clone, Debug, PartialEq)]
pub struct Render {
    /// Hash over all that went into the job.
    pub job_key: String,
    /// What came of it.
    pub sha256: String,
    /// How it was made, with its measured error.
    pub provenance: Value,
}

/// What one pair of a study shows under one condition.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StudyStimulus {
    /// Pair's id.
    pub pair: String,
    /// Condition's name.
    pub condition: String,
    /// Hash of the stimulus.
    pub sha256: String,
    /// How it was made, with its measured error.
    pub provenance: Value,
}

impl Store {
    /// Stores bytes and returns their hash; file first, row second, so that a row never points at nothing.
    pub async fn put_stimulus(&self, media_type: &str, bytes: Vec<u8>) -> Result<String, StoreError> {
        let (files, size) = (self.files.clone(), bytes.len() as i64);
        let sha256 = blocking(move || files.put(&bytes)).await?;
        sqlx::query(
            "INSERT INTO stimuli (sha256, media_type, size_bytes, created_at) VALUES ($1, $2, $3, $4)
             ON CONFLICT (sha256) DO NOTHING",
        )
        .bind(&sha256)
        .bind(media_type)
        .bind(size)
        .bind(clock::now())
        .execute(&self.writer)
        .await?;
        Ok(sha256)
    }

    /// The bytes of this hash and what they are, checked against the hash; `None` for an unknown one.
    ///
    /// # Errors
    /// [`StoreError::Damaged`] when the file is not what was stored.
    pub async fn stimulus(&self, sha256: &str) -> Result<Option<(StimulusInfo, Vec<u8>)>, StoreError> {
        if !is_sha256(sha256) {
            return Ok(None);
        }
        let row = sqlx::query("SELECT media_type, size_bytes FROM stimuli WHERE sha256 = $1")
            .bind(sha256)
            .fetch_optional(&self.reader)
            .await?;
        let Some(row) = row else { return Ok(None) };
        let info = StimulusInfo {
            sha256: sha256.to_owned(),
            media_type: row.try_get("media_type")?,
            size_bytes: row.try_get::<i64, _>("size_bytes")? as u64,
        };
        let (files, wanted) = (self.files.clone(), sha256.to_owned());
        Ok(blocking(move || files.get(&wanted)).await?.map(|bytes| (info, bytes)))
    }

    /// The finished job with this key.
    pub async fn render(&self, job_key: &str) -> Result<Option<Render>, StoreError> {
        let row = sqlx::query("SELECT sha256, provenance FROM renders WHERE job_key = $1")
            .bind(job_key)
            .fetch_optional(&self.reader)
            .await?;
        row.map(|row| {
            Ok(Render {
                job_key: job_key.to_owned(),
                sha256: row.try_get("sha256")?,
                provenance: read_json(row.try_get("provenance")?)?,
            })
        })
        .transpose()
    }

    /// Notes a finished job; its stimulus must be stored already. Made again (after damage), the newer one counts.
    pub async fn put_render(&self, render: &Render) -> Result<(), StoreError> {
        sqlx::query(
            "INSERT INTO renders (job_key, sha256, provenance, created_at) VALUES ($1, $2, $3, $4)
             ON CONFLICT (job_key) DO UPDATE SET sha256 = excluded.sha256, provenance = excluded.provenance,
             created_at = excluded.created_at",
        )
        .bind(&render.job_key)
        .bind(&render.sha256)
        .bind(render.provenance.to_string())
        .bind(clock::now())
        .execute(&self.writer)
        .await?;
        Ok(())
    }

    /// Notes which job a pair of a study shows under a condition.
    pub async fn put_study_stimulus(
        &self,
        study_id: &str,
        config_hash: &str,
        pair_id: &str,
        condition: &str,
        job_key: &str,
    ) -> Result<(), StoreError> {
        sqlx::query(
            "INSERT INTO study_stimuli (study_id, config_hash, pair_id, condition, job_key) VALUES ($1, $2, $3, $4, $5)
             ON CONFLICT (study_id, config_hash, pair_id, condition) DO UPDATE SET job_key = excluded.job_key",
        )
        .bind(study_id)
        .bind(config_hash)
        .bind(pair_id)
        .bind(condition)
        .bind(job_key)
        .execute(&self.writer)
        .await?;
        Ok(())
    }

    /// What the pairs of a study's version show, by pair and condition.
    pub async fn study_stimuli(
        &self,
        study_id: &str,
        config_hash: &str,
    ) -> Result<Vec<StudyStimulus>, StoreError> {
        let rows = sqlx::query(
            "SELECT pair_id, condition, sha256, provenance FROM study_stimuli JOIN renders USING (job_key)
             WHERE study_id = $1 AND config_hash = $2 ORDER BY pair_id, condition",
        )
        .bind(study_id)
        .bind(config_hash)
        .fetch_all(&self.reader)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(StudyStimulus {
                    pair: row.try_get("pair_id")?,
                    condition: row.try_get("condition")?,
                    sha256: row.try_get("sha256")?,
                    provenance: read_json(row.try_get("provenance")?)?,
                })
            })
            .collect()
    }
}

fn read_json(text: String) -> Result<Value, StoreError> {
    serde_json::from_str(&text).map_err(|e| StoreError::corrupt("provenance", e))
}

/// File work off the async threads.
async fn blocking<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, StoreError> + Send + 'static,
) -> Result<T, StoreError> {
    match tokio::task::spawn_blocking(work).await {
        Ok(result) => result,
        Err(error) => Err(StoreError::corrupt("file task", error)),
    }
}
