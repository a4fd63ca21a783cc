//! Every version of a study that was ever served, so that data can be read without its file.

use crate::clock;
use crate::error::StoreError;
use crate::sqlite::Store;
use kelir_study::StudyDefinition;
use sqlx::Row;

/// A stored version of a study.
#[derive(Clone, Debug)]
pub struct StudyVersion {
    /// Hash of the definition.
    pub config_hash: String,
    /// The definition itself.
    pub study: StudyDefinition,
    /// When it was last loaded, ISO-8601 UTC.
    pub loaded_at: String,
}

impl Store {
    /// Stores a study's version, and that it is the one in use now.
    pub async fn put_study(&self, study: &StudyDefinition) -> Result<(), StoreError> {
        sqlx::query(
            "INSERT INTO studies (study_id, config_hash, config, loaded_at) VALUES ($1, $2, $3, $4)
             ON CONFLICT (study_id, config_hash) DO UPDATE SET loaded_at = excluded.loaded_at",
        )
        .bind(&study.id)
        .bind(study.config_hash())
        .bind(study.canonical_json())
        .bind(clock::now())
        .execute(&self.writer)
        .await?;
        Ok(())
    }

    /// The versions of a study, the one loaded last first; empty for an unknown study.
    pub async fn study_versions(&self, study_id: &str) -> Result<Vec<StudyVersion>, StoreError> {
        let rows = sqlx::query(
            "SELECT config_hash, config, loaded_at FROM studies WHERE study_id = $1 ORDER BY loaded_at DESC, rowid DESC",
        )
        .bind(study_id)
        .fetch_all(&self.reader)
        .await?;
        rows.iter()
            .map(|row| {
                let config: String = row.try_get("config")?;
                Ok(StudyVersion {
                    config_hash: row.try_get("config_hash")?,
                    study: serde_json::from_str(&config).map_err(|e| StoreError::corrupt("study", e))?,
                    loaded_at: row.try_get("loaded_at")?,
                })
            })
            .collect()
    }

    /// Ids of all studies ever loaded, sorted.
    pub async fn study_ids(&self) -> Result<Vec<String>, StoreError> {
        Ok(sqlx::query_scalar("SELECT DISTINCT study_id FROM studies ORDER BY study_id")
            .fetch_all(&self.reader)
            .await?)
    }
}
