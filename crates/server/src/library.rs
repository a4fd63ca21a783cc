//! Where study files, scenes and pictures are read from: the data folder first, then what is built in.

use crate::error::StudyFileError;
use kelir_study::StudyDefinition;
use rust_embed::RustEmbed;
use std::collections::BTreeSet;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

#[derive(RustEmbed)]
#[folder = "$CARGO_MANIFEST_DIR/../../stimuli"]
struct BuiltIn;

/// Files laid out like `stimuli/`: `studies/x.toml`, `scenes/y.toml`, `puppets/…`. A file of the data folder hides a
/// built-in one of the same path.
#[derive(Clone, Debug)]
pub struct Library {
    folder: PathBuf,
}

impl Library {
    /// The library of a data folder.
    pub fn new(folder: &Path) -> Library {
        Library { folder: folder.to_owned() }
    }

    /// The bytes at a '/'-separated path below the library's root; `..` may not leave it.
    ///
    /// # Errors
    /// There is no such file, or the path leads out of the library.
    pub fn read(&self, path: &str) -> io::Result<Vec<u8>> {
        let path = normalise(path).ok_or_else(|| {
            io::Error::new(ErrorKind::PermissionDenied, "the path leads out of the study's folders")
        })?;
        if let Ok(root) = self.folder.canonicalize()
            && let Ok(file) = root.join(&path).canonicalize()
        {
            // A link may not lead out either.
            if !file.starts_with(&root) {
                let message = "the path leads out of the study's folders";
                return Err(io::Error::new(ErrorKind::PermissionDenied, message));
            }
            return std::fs::read(file);
        }
        match BuiltIn::get(&path) {
            Some(file) => Ok(file.data.into_owned()),
            None => Err(io::Error::new(ErrorKind::NotFound, "there is no such file")),
        }
    }

    /// Paths of all study files, sorted.
    pub fn study_files(&self) -> Vec<String> {
        let built_in = BuiltIn::iter().map(|path| path.into_owned());
        let own = std::fs::read_dir(self.folder.join("studies")).into_iter().flatten().flatten();
        let own = own
            .filter_map(|entry| entry.file_name().into_string().ok())
            .map(|name| format!("studies/{name}"));
        let all: BTreeSet<String> = built_in.chain(own).collect();
        all.into_iter()
            .filter(|path| {
                path.ends_with(".toml") && path.matches('/').count() == 1 && path.starts_with("studies/")
            })
            .collect()
    }

    /// Reads and checks the study file at `path`.
    ///
    /// # Errors
    /// It cannot be read, or everything that is wrong with it.
    pub fn study(&self, path: &str) -> Result<StudyDefinition, StudyFileError> {
        let unreadable = |source| StudyFileError::Unreadable { path: PathBuf::from(path), source };
        let bytes = self.read(path).map_err(unreadable)?;
        let text = String::from_utf8(bytes)
            .map_err(|_| unreadable(io::Error::new(ErrorKind::InvalidData, "the file is no UTF-8 text")))?;
        Ok(StudyDefinition::parse(path, &text)?)
    }

    /// The library path of something that a study file names relative to itself.
    pub fn beside_study(path: &str) -> String {
        format!("studies/{path}")
    }
}

/// Resolves `.` and `..`; `None` for what is absolute, leaves the root or is no plain path.
fn normalise(path: &str) -> Option<String> {
    let mut parts: Vec<&str> = Vec::new();
    for part in path.split('/') {
        match part {
            "." => {}
            ".." => {
                parts.pop()?;
            }
            "" => return None,
            part if part.contains(['\\', '\0', ':']) => return None,
            part => parts.push(part),
        }
    }
    (!parts.is_empty()).then(|| parts.join("/"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn own_files_hide_built_in_ones_and_nothing_outside_is_read() {
        let dir = tempfile::tempdir().unwrap();
        let data = dir.path().join("data");
        std::fs::create_dir_all(data.join("studies")).unwrap();
        std::fs::write(dir.path().join("secret.toml"), "secret").unwrap();
        std::fs::write(data.join("studies/mine.toml"), "mine").unwrap();
        std::os::unix::fs::symlink("../../secret.toml", data.join("studies/link.toml")).unwrap();
        let library = Library::new(&data);
        assert_eq!(library.read("scenes/../studies/./mine.toml").unwrap(), b"mine");
        for path in [
            "../secret.toml",
            "studies/../../secret.toml",
            "/etc/passwd",
            "studies/link.toml",
            "a\\b",
            "",
            "a//b",
        ] {
            let error = library.read(path).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::PermissionDenied, "{path}");
        }
        assert!(library.study_files().contains(&"studies/mine.toml".to_owned()));
        std::fs::write(data.join("studies/shadow-puppets.toml"), "title = 1").unwrap();
        assert!(library.study("studies/shadow-puppets.toml").is_err());
    }
}
