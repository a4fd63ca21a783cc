//! Where a scene's files come from.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::limits;

/// Files that a scene may name.
///
/// `path` always comes normalised from the assets' root: `puppets/arjuna.svg`, '/'-separated, never absolute, with no
/// `.` or `..` in it. (Paths in a scene are relative to the scene file, those in a manifest to the manifest; the scene
/// crate resolves them and refuses what would leave the root.)
pub trait Assets {
    /// The bytes of a file. Errors are shown to the user beside the path.
    fn read(&self, path: &str) -> io::Result<Vec<u8>>;
}

impl<A: Assets + ?Sized> Assets for &A {
    fn read(&self, path: &str) -> io::Result<Vec<u8>> {
        (**self).read(path)
    }
}

/// Files in memory, by path from the root.
impl Assets for BTreeMap<String, Vec<u8>> {
    fn read(&self, path: &str) -> io::Result<Vec<u8>> {
        self.get(path).cloned().ok_or_else(|| io::ErrorKind::NotFound.into())
    }
}

/// Regular files below a folder; links that lead out of it are refused.
#[derive(Clone, Debug)]
pub struct DirAssets {
    root: PathBuf,
}

impl DirAssets {
    /// Files below `root`.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into() }
    }
}

impl Assets for DirAssets {
    fn read(&self, path: &str) -> io::Result<Vec<u8>> {
        let root = self.root.canonicalize()?;
        let file = root.join(path).canonicalize()?;
        if !file.starts_with(&root) {
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, "leads out of the scene's folder"));
        }
        read_file(&file, limits::IMAGE_BYTES)
    }
}

/// A regular file's bytes. Refuses folders and devices, and reads one byte beyond `most` at the utmost.
pub(crate) fn read_file(file: &Path, most: usize) -> io::Result<Vec<u8>> {
    if !std::fs::metadata(file)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "is not a regular file"));
    }
    let mut bytes = Vec::new();
    std::fs::File::open(file)?.take(most as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// `path` relative to the file `from`, normalised from the root; the rule that it breaks otherwise.
pub(crate) fn resolve(from: &str, path: &str) -> Result<String, &'static str> {
    if path.is_empty() {
        return Err("a path must not be empty");
    }
    if path.len() > 1024 || path.contains('\0') {
        return Err("a path has at most 1024 bytes and no NUL");
    }
    if path.contains('\\') || path.contains(':') {
        return Err("a path is relative and '/'-separated, without '\\' or ':'");
    }
    if path.starts_with('/') {
        return Err("a path is relative to the file that names it, never absolute");
    }
    let mut parts: Vec<&str> = from.split('/').filter(|p| !p.is_empty()).collect();
    parts.pop();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                if parts.pop().is_none() {
                    return Err("a path must not leave the folder of the scenes and puppets");
                }
            }
            part => parts.push(part),
        }
    }
    if parts.is_empty() { Err("a path must name a file") } else { Ok(parts.join("/")) }
}

/// The assets' root of a scene file and the scene's path from it: the parent of a folder named `scenes`
/// (so that `../puppets/x.svg` works), else the scene's own folder.
pub(crate) fn root_of(scene: &Path) -> (PathBuf, String) {
    let file = scene.file_name().map_or(String::new(), |f| f.to_string_lossy().into_owned());
    let folder = match scene.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
        _ => PathBuf::from("."),
    };
    // "." or a link has no name of its own: ask the file system for it.
    let folder = folder.canonicalize().unwrap_or(folder);
    match (folder.file_name(), folder.parent()) {
        (Some(name), Some(parent)) if name == "scenes" => (parent.to_path_buf(), format!("scenes/{file}")),
        _ => (folder, file),
    }
}
