//! Stimulus bytes on disk, named by their SHA-256: written whole or not at all.

use crate::error::StoreError;
use crate::private;
use sha2::{Digest, Sha256};
use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// SHA-256 of `bytes` as 64 lower-case hex digits.
pub fn sha256_hex(bytes: &[u8]) -> String {
    hex::encode(Sha256::digest(bytes))
}

/// Whether `text` has the form of a hash; nothing else may become part of a path.
pub(crate) fn is_sha256(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|b| b.is_ascii_digit() || (b'a'..=b'f').contains(&b))
}

/// A folder of content-addressed files.
#[derive(Clone, Debug)]
pub(crate) struct Files {
    root: PathBuf,
}

impl Files {
    pub(crate) fn open(root: PathBuf) -> Result<Files, StoreError> {
        private::folder(&root)?;
        Ok(Files { root })
    }

    fn path(&self, sha256: &str) -> PathBuf {
        self.root.join(&sha256[..2]).join(sha256)
    }

    /// Writes `bytes` under their hash and returns it; durable when it returns. A good copy that is there already stays.
    pub(crate) fn put(&self, bytes: &[u8]) -> Result<String, StoreError> {
        let sha256 = sha256_hex(bytes);
        let path = self.path(&sha256);
        if let Ok(Some(_)) = self.get(&sha256) {
            return Ok(sha256);
        }
        let failed = |path: &Path, source| StoreError::File { path: path.to_owned(), source };
        let folder = path.parent().unwrap_or(&self.root);
        private::folder(folder)?;
        let part = folder.join(format!(".{sha256}.{}.part", uuid::Uuid::new_v4().simple()));
        let written = private::private_file()
            .open(&part)
            .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
            .and_then(|()| fs::rename(&part, &path));
        if let Err(source) = written {
            // What is left of a failed write is of no use; that it could not be removed would hide the first error.
            let _ = fs::remove_file(&part);
            return Err(failed(&path, source));
        }
        // The names are durable once their folders are.
        for folder in [folder, &self.root] {
            File::open(folder).and_then(|f| f.sync_all()).map_err(|e| failed(folder, e))?;
        }
        Ok(sha256)
    }

    /// The bytes of this hash, `None` when there are none.
    pub(crate) fn get(&self, sha256: &str) -> Result<Option<Vec<u8>>, StoreError> {
        match self.read(sha256)? {
            Some(bytes) if sha256_hex(&bytes) != sha256 => {
                Err(StoreError::Damaged { sha256: sha256.to_owned() })
            }
            read => Ok(read),
        }
    }

    /// The bytes under this hash, unchecked.
    pub(crate) fn read(&self, sha256: &str) -> Result<Option<Vec<u8>>, StoreError> {
        if !is_sha256(sha256) {
            return Ok(None);
        }
        let path = self.path(sha256);
        match fs::read(&path) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(source) => Err(StoreError::File { path, source }),
        }
    }

    /// Whether there is a file under this hash, of this length.
    pub(crate) fn has(&self, sha256: &str, size_bytes: u64) -> bool {
        is_sha256(sha256) && fs::metadata(self.path(sha256)).is_ok_and(|file| file.len() == size_bytes)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;

    #[test]
    fn bytes_come_back_and_damage_is_seen_and_mended() {
        let dir = tempfile::tempdir().unwrap();
        let files = Files::open(dir.path().join("stimuli")).unwrap();
        // SHA-256 of "abc" as FIPS 180-2 prints it.
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(files.put(b"abc").unwrap(), abc);
        assert_eq!(files.get(abc).unwrap().unwrap(), b"abc");
        fs::write(files.path(abc), b"abd").unwrap();
        assert!(matches!(files.get(abc), Err(StoreError::Damaged { .. })));
        files.put(b"abc").unwrap();
        assert_eq!(files.get(abc).unwrap().unwrap(), b"abc");
        let parts = fs::read_dir(dir.path().join("stimuli/ba")).unwrap().count();
        assert_eq!(parts, 1, "no unfinished file is left");
    }

    #[test]
    fn a_name_that_is_no_hash_reaches_no_file() {
        let dir = tempfile::tempdir().unwrap();
        let files = Files::open(dir.path().to_owned()).unwrap();
        for name in ["", "..", "../../etc/passwd", &"g".repeat(64), &"A".repeat(64), &"é".repeat(32)] {
            assert!(files.get(name).unwrap().is_none(), "{name}");
        }
    }
}
