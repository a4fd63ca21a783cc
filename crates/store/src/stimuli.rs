//! Stimuli: bytes made once, with where they came from.

use crate::clock;
use crate::error::StoreError;
use crate::files::is_sha256;
use crate::pixels;
use crate::sqlite::Store;
use crate::threads::{blocking, patiently};
use rusqlite::params;
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
    /// Hash of its decoded pixels.
    pub pixels_sha256: String,
    /// [width, height] in pixels.
    pub size: [u32; 2],
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

/// What one item of a study shows under one condition at one size.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyStimulus {
    /// Item's id.
    pub item: String,
    /// Condition's name.
    pub condition: String,
    /// Hash of the stimulus.
    pub sha256: String,
    /// Hash of its decoded pixels.
    pub pixels_sha256: String,
    /// [width, height] in pixels.
    pub size: [u32; 2],
    /// How it was made, with its measured error.
    pub provenance: Value,
}

impl Store {
    /// Stores bytes and returns what is known of them; file first, row second, so that a row never points at nothing. The frames that a
    /// manifest names are to be stored before it.
    ///
    /// # Errors
    /// They are no picture and no animation ([`StoreError::Undecodable`]), or they cannot be stored.
    pub async fn put_stimulus(&self, media_type: &str, bytes: Vec<u8>) -> Result<StimulusInfo, StoreError> {
        let (files, size_bytes, kind) = (self.files.clone(), bytes.len() as u64, media_type.to_owned());
        let (sha256, pixels) = patiently(move || {
            let frame = |name: &str| files.get(name).ok().flatten();
            let pixels = pixels::of(&kind, &bytes, &frame).map_err(StoreError::Undecodable)?;
            Ok((files.put(&bytes)?, pixels))
        })
        .await?;
        let (media_type, pixels_sha256) = (media_type.to_owned(), pixels.sha256);
        let info = StimulusInfo { sha256, media_type, size_bytes, pixels_sha256, size: pixels.size };
        self.write(move |writer| {
            let [width, height] = info.size;
            writer.execute(
                "INSERT INTO stimuli (sha256, media_type, size_bytes, created_at, pixels_sha256, width, height)
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)
                 ON CONFLICT (sha256) DO UPDATE SET pixels_sha256 = excluded.pixels_sha256, width = excluded.width, height = excluded.height",
                params![info.sha256, info.media_type, size_bytes as i64, clock::now(), info.pixels_sha256, width, height],
            )?;
            Ok(info)
        })
        .await
    }

    /// The bytes of this hash and their media type, checked against the hash; `None` for an unknown one.
    ///
    /// # Errors
    /// [`StoreError::Damaged`] when the file is not what was stored.
    pub async fn stimulus(&self, sha256: &str) -> Result<Option<(String, Vec<u8>)>, StoreError> {
        if !is_sha256(sha256) {
            return Ok(None);
        }
        let row = sqlx::query_scalar("SELECT media_type FROM stimuli WHERE sha256 = $1")
            .bind(sha256)
            .fetch_optional(&self.reader)
            .await?;
        let Some(media_type) = row else { return Ok(None) };
        let (files, wanted) = (self.files.clone(), sha256.to_owned());
        Ok(blocking(move || files.get(&wanted)).await?.map(|bytes| (media_type, bytes)))
    }

    /// What is known of a stored stimulus; `None` for an unknown one.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn stimulus_info(&self, sha256: &str) -> Result<Option<StimulusInfo>, StoreError> {
        let row = sqlx::query("SELECT * FROM stimuli WHERE sha256 = $1 AND pixels_sha256 IS NOT NULL")
            .bind(sha256)
            .fetch_optional(&self.reader)
            .await?;
        row.map(|row| {
            Ok(StimulusInfo {
                sha256: sha256.to_owned(),
                media_type: row.try_get("media_type")?,
                size_bytes: row.try_get::<i64, _>("size_bytes")? as u64,
                pixels_sha256: row.try_get("pixels_sha256")?,
                size: [row.try_get("width")?, row.try_get("height")?],
            })
        })
        .transpose()
    }

    /// The finished job with this key; `None` for an unknown one.
    ///
    /// # Errors
    /// The database cannot be read.
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
    ///
    /// # Errors
    /// The database refuses, as it does a stimulus that is not stored.
    pub async fn put_render(&self, render: &Render) -> Result<(), StoreError> {
        let render = render.clone();
        self.write(move |writer| {
            writer.execute(
                "INSERT INTO renders (job_key, sha256, provenance, created_at) VALUES (?1, ?2, ?3, ?4)
                 ON CONFLICT (job_key) DO UPDATE SET sha256 = excluded.sha256, provenance = excluded.provenance,
                 created_at = excluded.created_at",
                params![render.job_key, render.sha256, render.provenance.to_string(), clock::now()],
            )?;
            Ok(())
        })
        .await
    }

    /// What a version of a study shows, by item, condition and rising size.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn version_stimuli(
        &self,
        study_id: &str,
        version: &str,
    ) -> Result<Vec<StudyStimulus>, StoreError> {
        let rows = sqlx::query(
            "SELECT * FROM version_stimuli WHERE study_id = $1 AND version = $2 ORDER BY item_id, condition, width, height",
        )
        .bind(study_id)
        .bind(version)
        .fetch_all(&self.reader)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(StudyStimulus {
                    item: row.try_get("item_id")?,
                    condition: row.try_get("condition")?,
                    sha256: row.try_get("sha256")?,
                    pixels_sha256: row.try_get("pixels_sha256")?,
                    size: [row.try_get("width")?, row.try_get("height")?],
                    provenance: read_json(row.try_get("provenance")?)?,
                })
            })
            .collect()
    }
}

pub(crate) fn read_json(text: String) -> Result<Value, StoreError> {
    serde_json::from_str(&text).map_err(|e| StoreError::corrupt("provenance", e))
}
