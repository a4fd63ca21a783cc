//! What browsers get of stored stimuli, made once and kept beside them.

use crate::clock;
use crate::error::StoreError;
use crate::packing::{PACKER, pack, unpacked};
use crate::sqlite::Store;
use crate::stimuli::StimulusInfo;
use crate::threads::{blocking, patiently};
use rusqlite::{OptionalExtension, Row, params};

/// A stored stimulus as browsers get it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Packing {
    /// SHA-256 of the packed bytes, which name their file.
    pub packed_sha256: String,
    /// How many they are.
    pub size_bytes: u64,
}

/// What browsers get of all that a version shows at one size.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackedSize {
    /// [width, height] in pixels.
    pub size: [u32; 2],
    /// How many stimuli.
    pub stimuli: u64,
    /// Their packed bytes, each filled up to the longest of its item.
    pub bytes: u64,
}

impl Store {
    /// What browsers get of a version of a study at each of its sizes, by rising width; nothing where some of it has not been packed.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn packed_sizes(&self, study_id: &str, version: &str) -> Result<Vec<PackedSize>, StoreError> {
        let (study_id, version) = (study_id.to_owned(), version.to_owned());
        let sizes = "WITH items AS (
                SELECT v.width, v.height, count(*) AS shown, count(p.size_bytes) AS packed, max(p.size_bytes) AS longest
                FROM version_stimuli v LEFT JOIN packings p ON p.sha256 = v.sha256 AND p.packer = ?3
                WHERE v.study_id = ?1 AND v.version = ?2 GROUP BY v.item_id, v.width, v.height
            )
            SELECT width, height, sum(shown), sum(shown * longest) FROM items
            WHERE NOT EXISTS (SELECT 1 FROM items WHERE packed < shown) GROUP BY width, height ORDER BY width";
        let row = |row: &Row<'_>| {
            let whole = |at| row.get::<_, i64>(at).map(i64::unsigned_abs);
            Ok(PackedSize { size: [row.get(0)?, row.get(1)?], stimuli: whole(2)?, bytes: whole(3)? })
        };
        let read = self.readers.read(move |reader| {
            let mut query = reader.prepare_cached(sizes)?;
            Ok(query.query_map(params![study_id, version, PACKER], row)?.collect::<Result<_, _>>()?)
        });
        read.await
    }

    /// The packing of a stored stimulus, made where there is none yet or its file is gone; `None` for an unknown stimulus.
    ///
    /// # Errors
    /// [`StoreError::Undecodable`] where the packing would not show the very pixels; the stimulus cannot be read, or its packing not be kept.
    pub async fn packing(&self, sha256: &str) -> Result<Option<Packing>, StoreError> {
        let (name, found) = (
            sha256.to_owned(),
            "SELECT packed_sha256, size_bytes FROM packings WHERE sha256 = ?1 AND packer = ?2",
        );
        let known = self.readers.read(move |reader| {
            let packing = |row: &Row<'_>| {
                Ok(Packing { packed_sha256: row.get(0)?, size_bytes: row.get::<_, i64>(1)? as u64 })
            };
            Ok(reader.prepare_cached(found)?.query_row(params![name, PACKER], packing).optional()?)
        });
        if let Some(packing) = known.await?.filter(|p| self.files.has(&p.packed_sha256, p.size_bytes)) {
            return Ok(Some(packing));
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
        let (packed_sha256, size_bytes) = patiently(move || {
            let frame = |name: &str| files.get(name).ok().flatten();
            let stored = files.get(&name)?.ok_or_else(|| wrong("is not there".to_owned()))?;
            let packed = pack(&media_type, &stored, &frame).map_err(wrong)?;
            if unpacked(&packed).map_err(wrong)?.sha256 != pixels_sha256 {
                return Err(wrong("does not come out of its packing as it is".to_owned()));
            }
            Ok((files.put(&packed)?, packed.len() as u64))
        })
        .await?;
        let packing = Packing { packed_sha256, size_bytes };
        self.write(move |writer| {
            writer.execute(
                "INSERT OR REPLACE INTO packings (sha256, packer, packed_sha256, size_bytes) VALUES (?1, ?2, ?3, ?4)",
                params![sha256, PACKER, packing.packed_sha256, size_bytes as i64],
            )?;
            Ok(packing)
        })
        .await
    }

    /// Forgets a packing whose file turned out damaged: it is made anew when it is asked for next.
    ///
    /// # Errors
    /// The database refuses.
    pub async fn forget_packing(&self, sha256: &str) -> Result<(), StoreError> {
        let sha256 = sha256.to_owned();
        self.write(move |writer| {
            writer.execute("DELETE FROM packings WHERE sha256 = ?1", [sha256])?;
            Ok(())
        })
        .await
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
        let sha256 = sha256.to_owned();
        let found = "SELECT media_type, coalesce(open_until > ?2, 0) FROM stimuli WHERE sha256 = ?1";
        let row = |row: &Row<'_>| Ok((row.get(0)?, row.get(1)?));
        let read = self.readers.read(move |reader| {
            Ok(reader.prepare_cached(found)?.query_row(params![sha256, clock::now()], row).optional()?)
        });
        read.await
    }
}
