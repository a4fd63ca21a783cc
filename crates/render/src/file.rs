//! Files that are whole or absent.

use std::path::Path;

use crate::RenderError;

/// Writes `bytes` beside `path` and renames: whoever is interrupted leaves no half-written file. Missing folders are made.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), RenderError> {
    use std::sync::atomic::{AtomicU64, Ordering};
    static SERIAL: AtomicU64 = AtomicU64::new(0);
    let named = |source| RenderError::Io { path: path.display().to_string(), source };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(named)?;
    }
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.{}.part", std::process::id(), SERIAL.fetch_add(1, Ordering::Relaxed)));
    let part = path.with_file_name(name);
    let written = std::fs::write(&part, bytes).and_then(|()| std::fs::rename(&part, path));
    written.map_err(|source| {
        let _ = std::fs::remove_file(&part);
        named(source)
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn writes_whole_files_and_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/b.png");
        write_atomic(&path, b"one").unwrap();
        write_atomic(&path, b"two").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path().join("a")).unwrap().count(), 1);
        // A folder in the file's place: an error that names it, and no litter.
        std::fs::create_dir(folder.path().join("a/c.png")).unwrap();
        std::fs::write(folder.path().join("a/c.png/x"), b"").unwrap();
        let error = write_atomic(&folder.path().join("a/c.png"), b"x").unwrap_err();
        assert!(error.to_string().contains("c.png"), "{error}");
        assert_eq!(std::fs::read_dir(folder.path().join("a")).unwrap().count(), 2);
    }
}
