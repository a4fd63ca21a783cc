//! Folders of files that are whole or absent.

use std::path::{Path, PathBuf};

use crate::RenderError;
use crate::file::{Part, named, write_atomic};

/// A folder under way: its files gather in a part beside it (within it, where it is there already) until they are all there. Dropped before that, it
/// leaves what was there as it was.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    part: Part,
}

impl Folder {
    /// Begins the folder `path`. Errors: what the system says, and a file in its place.
    pub fn begin(path: &Path) -> Result<Self, RenderError> {
        if path.exists() && !path.is_dir() {
            return Err(named(path, std::io::ErrorKind::NotADirectory.into()));
        }
        let part = Part::beside(&if path.is_dir() { path.join("frames") } else { path.to_owned() })?;
        std::fs::create_dir(&part.path).map_err(|source| named(path, source))?;
        Ok(Self { path: path.to_owned(), part })
    }

    /// Adds a file.
    pub fn add(&self, name: &str, bytes: &[u8]) -> Result<(), RenderError> {
        let path = self.part.path.join(name);
        std::fs::write(&path, bytes).map_err(|source| named(&path, source))
    }

    /// Puts the files in their place, and last `index`, which says that the folder is whole. Of an older one whatever is `ours` and not among them
    /// goes; other files stay.
    pub fn finish(self, index: &str, bytes: &[u8], ours: impl Fn(&str) -> bool) -> Result<(), RenderError> {
        let at = |source| named(&self.path, source);
        if !self.path.exists() {
            self.add(index, bytes)?;
            return std::fs::rename(&self.part.path, &self.path).map_err(at);
        }
        match std::fs::remove_file(self.path.join(index)) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(at(error)),
            _ => {}
        }
        for entry in std::fs::read_dir(&self.path).map_err(at)? {
            let entry = entry.map_err(at)?;
            if entry.file_name().to_str().is_some_and(&ours) {
                std::fs::remove_file(entry.path()).map_err(at)?;
            }
        }
        for entry in std::fs::read_dir(&self.part.path).map_err(at)? {
            let entry = entry.map_err(at)?;
            std::fs::rename(entry.path(), self.path.join(entry.file_name())).map_err(at)?;
        }
        write_atomic(&self.path.join(index), bytes)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    fn files(folder: &Path) -> Vec<String> {
        let names =
            std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

    fn make(path: &Path, frames: usize) -> Folder {
        let folder = Folder::begin(path).unwrap();
        (0..frames).for_each(|k| folder.add(&format!("frame-{k}"), &[frames as u8]).unwrap());
        folder
    }

    #[test]
    fn a_folder_is_the_old_one_or_the_new_one() {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("a/film");
        let ours = |name: &str| name.starts_with("frame-");
        // Given up, it leaves nothing, not even what it would have stood in.
        drop(make(&path, 2));
        assert!(files(root.path()).is_empty());
        make(&path, 3).finish("index", b"3", ours).unwrap();
        assert_eq!(files(&path), ["frame-0", "frame-1", "frame-2", "index"]);
        std::fs::write(path.join("notes.txt"), b"mine").unwrap();
        // Given up, it leaves the old one whole.
        drop(make(&path, 2));
        assert_eq!(std::fs::read(path.join("frame-0")).unwrap(), [3]);
        assert_eq!(files(&path), ["frame-0", "frame-1", "frame-2", "index", "notes.txt"]);
        // What the new one has not is gone; what is no frame stays.
        make(&path, 1).finish("index", b"1", ours).unwrap();
        assert_eq!(files(&path), ["frame-0", "index", "notes.txt"]);
        assert_eq!(std::fs::read(path.join("frame-0")).unwrap(), [1]);
        assert_eq!(files(root.path()), ["a"]);
        assert_eq!(files(path.parent().unwrap()), ["film"]);
        let error = Folder::begin(&path.join("notes.txt")).unwrap_err().to_string();
        assert!(error.contains("notes.txt"), "{error}");
    }
}
