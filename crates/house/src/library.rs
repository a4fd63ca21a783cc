//! Where study files, scenes and pictures are read from: the data folder first, then what is built in.

use crate::remembered::{Known, Remembered, SceneFacts};
use kelir_scene::{AnyScene, Assets};
use kelir_store::sha256_hex;
use kelir_study::Problem;
use rust_embed::RustEmbed;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

#[derive(RustEmbed)]
#[folder = "$CARGO_MANIFEST_DIR/../../stimuli"]
pub(crate) struct BuiltIn;

/// Files laid out like `stimuli/`: `studies/x.toml`, `scenes/y.toml`, `puppets/…`. A file of the data folder hides a
/// built-in one of the same path.
#[derive(Clone, Debug)]
pub struct Library {
    folder: PathBuf,
    /// What was learnt of scenes that were read: reading one rasterises its puppets, which takes a while.
    known: Arc<Mutex<HashMap<String, SceneFacts>>>,
    /// What earlier starts learnt, where this one may keep it.
    remembered: Option<Arc<Mutex<Remembered>>>,
}

impl Library {
    /// The library of a data folder.
    pub fn new(folder: &Path) -> Library {
        Library { folder: folder.to_owned(), known: Arc::default(), remembered: None }
    }

    /// The library of a server's data folder, which keeps in it what it learns of scenes.
    pub fn remembering(folder: &Path) -> Library {
        let remembered = Some(Arc::new(Mutex::new(Remembered::load(folder))));
        Library { remembered, ..Library::new(folder) }
    }

    /// What ships inside the binary alone.
    pub fn built_in() -> Library {
        // No folder has an empty path.
        Library::new(Path::new(""))
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
            if std::fs::metadata(&file)?.is_file() {
                return std::fs::read(file);
            }
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

    /// What there is to know of the scene at a path of the library, as it was when it was first read.
    pub(crate) fn scene_facts(&self, path: &str) -> Result<SceneFacts, Vec<Problem>> {
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(facts) = known().get(path) {
            return Ok(facts.clone());
        }
        let facts = match self.recalled(path) {
            Some(facts) => facts,
            None => self.learnt(path)?,
        };
        known().insert(path.to_owned(), facts.clone());
        Ok(facts)
    }

    /// What an earlier start learnt of a scene whose files are still the same.
    fn recalled(&self, path: &str) -> Option<SceneFacts> {
        let remembered = self.remembered.as_ref()?.lock().unwrap_or_else(PoisonError::into_inner);
        remembered.facts(path, |file| self.read(file).ok().map(|bytes| sha256_hex(&bytes)))
    }

    /// What a scene is, read anew.
    fn learnt(&self, path: &str) -> Result<SceneFacts, Vec<Problem>> {
        let reading = Reading { library: self, files: Mutex::default() };
        let scene = self.scene_by(path, &reading)?;
        let facts = SceneFacts {
            sha256: scene.sha256().to_owned(),
            moves: scene.timeline().is_some(),
            warnings: scene.warnings().to_vec(),
        };
        if let Some(remembered) = &self.remembered {
            let files = reading.files.into_inner().unwrap_or_else(PoisonError::into_inner);
            let known = Known { files, facts: facts.clone() };
            remembered.lock().unwrap_or_else(PoisonError::into_inner).keep(&self.folder, path, known);
        }
        Ok(facts)
    }

    /// Reads and checks the scene at a path of the library.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn scene(&self, path: &str) -> Result<AnyScene, Vec<Problem>> {
        self.scene_by(path, self)
    }

    fn scene_by(&self, path: &str, files: &dyn Assets) -> Result<AnyScene, Vec<Problem>> {
        let whole = |rule: String| vec![Problem::new(path, "scene", None, rule)];
        let bytes = files.read(path).map_err(|error| whole(error.to_string()))?;
        let text = String::from_utf8(bytes).map_err(|_| whole("is no UTF-8 text".to_owned()))?;
        let path = normalise(path).ok_or_else(|| whole("leads out of the study's folders".to_owned()))?;
        AnyScene::parse(&path, &text, files).map_err(Vec::from)
    }
}

impl Assets for Library {
    fn read(&self, path: &str) -> io::Result<Vec<u8>> {
        Library::read(self, path)
    }
}

/// The library, noting what is read from it.
struct Reading<'a> {
    library: &'a Library,
    files: Mutex<BTreeMap<String, String>>,
}

impl Assets for Reading<'_> {
    fn read(&self, path: &str) -> io::Result<Vec<u8>> {
        let bytes = self.library.read(path)?;
        let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        files.insert(path.to_owned(), sha256_hex(&bytes));
        Ok(bytes)
    }
}

/// The library path of what a file names relative to itself.
pub(crate) fn beside(file: &str, path: &str) -> String {
    match file.rsplit_once('/') {
        Some((folder, _)) => format!("{folder}/{path}"),
        None => path.to_owned(),
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
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

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
