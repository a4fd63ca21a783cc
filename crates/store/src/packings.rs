//! What browsers get of stored stimuli, made once and kept beside them.

use crate::error::StoreError;
use crate::packing::{PACKER, pack, unpacked};
use crate::sqlite::Store;
use crate::stimuli::{StimulusInfo, blocking};
use sqlx::Row;

/// A stored stimulus as browsers get it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Packing {
    /// SHA-256 of the packed bytes, which name their file.
    pub packed_sha256: String,
    /// How many they are.
    pub size_bytes: u64,
}

impl Store {
    /// The packing of a stored stimulus, made where there is none yet or its file is gone; `None` for an unknown stimulus.
    ///
    /// # Errors
    /// [`StoreError::Undecodable`] where the packing would not show the very pixels; the stimulus cannot be read, or its packing not be kept.
    pub async fn packing(&self, sha256: &str) -> Result<Option<Packing>, StoreError> {
        let row = sqlx::query("SELECT packed_sha256, size_bytes FROM packings WHERE sha256 = $1 AND packer = $2")
            .bind(sha256)
            .bind(PACKER)
            .fetch_optional(&self.reader)
            .await?;
        if let Some(row) = row {
            let (packed_sha256, size_bytes) =
                (row.try_get("packed_sha256")?, row.try_get::<i64, _>("size_bytes")? as u64);
            if self.files.has(&packed_sha256, size_bytes) {
                return Ok(Some(Packing { packed_sha256, size_bytes }));
            }
        }
        match self.stimulus_info(sha256).await? {
            Some(info) => self.make_packing(info).await.map(Some),
            None => Ok(None),
        }
    }

    async fn make_packing(&self, info: StimulusInfo) -> Result<Packing, StoreError> {
        let (files, StimulusInfo { sha256, media_type, pixels_sha256, .. }) = (self.files.clone(), info);
        let name = sha256.clone();
        let wrong = StoreError::Undecodable;
        let (packed_sha256, size_bytes) = blocking(move || {
            let frame = |name: &str| files.get(name).ok().flatten();
            let stored = files.get(&name)?.ok_or_else(|| wrong("is not there".to_owned()))?;
            let packed = pack(&media_type, &stored, &frame).map_err(wrong)?;
            if unpacked(&packed).map_err(wrong)?.sha256 != pixels_sha256 {
                return Err(wrong("does not come out of its packing as it is".to_owned()));
            }
            Ok((files.put(&packed)?, packed.len() as u64))
        })
        .await?;
        sqlx::query("INSERT OR REPLACE INTO packings (sha256, packer, packed_sha256, size_bytes) VALUES ($1, $2, $3, $4)")
            .bind(&sha256)
            .bind(PACKER)
            .bind(&packed_sha256)
            .bind(size_bytes as i64)
            .execute(&self.writer)
            .await?;
        Ok(Packing { packed_sha256, size_bytes })
    }

    /// Forgets a packing whose file turned out damaged: it is made anew when it is asked for next.
    ///
    /// # Errors
    /// The database refuses.
    pub async fn forget_packing(&self, sha256: &str) -> Result<(), StoreError> {
        sqlx::query("DELETE FROM packings WHERE sha256 = $1").bind(sha256).execute(&self.writer).await?;
        Ok(())
    }

    /// The bytes of a file by its name, as they are on disk: what is read for every request is checked in the background, not here.
    ///
    /// # Errors
    /// The file cannot be read.
    pub async fn file(&self, sha256: &str) -> Result<Option<Vec<u8>>, StoreError> {
        let (files, wanted) = (self.files.clone(), sha256.to_owned());
        blocking(move || files.read(&wanted)).await
    }

    /// The media type of stored bytes, and whether anybody may have them who knows their hash; `None` for unknown ones.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn stimulus_access(&self, sha256: &str) -> Result<Option<(String, bool)>, StoreError> {
        let row = sqlx::query("SELECT media_type, coalesce(open_until > $2, 0) AS open FROM stimuli WHERE sha256 = $1")
            .bind(sha256)
            .bind(crate::clock::now())
            .fetch_optional(&self.reader)
            .await?;
        row.map(|row| Ok((row.try_get("media_type")?, row.try_get("open")?))).transpose()
    }
}
