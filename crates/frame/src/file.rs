//! Files that are whole or absent.

use std::path::Path;
use std::time::Duration;

use crate::RenderError;

/// A part that nobody has written to for so long was left by a process that was killed.
const ABANDONED: Duration = Duration::from_secs(60);

/// Writes `bytes` beside `path` and renames: whoever is interrupted leaves no half-written file, at most `NAME.PROCESS.NUMBER.part`, which
/// a later write of the same file removes. Missing folders are made.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), RenderError> {
    use std::sync::atomic::{AtomicU64, Ordering};
    static SERIAL: AtomicU64 = AtomicU64::new(0);
    let named = |source| RenderError::Io { path: path.display().to_string(), source };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(named)?;
    }
    remove_abandoned(path);
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.{}.part", std::process::id(), SERIAL.fetch_add(1, Ordering::Relaxed)));
    let part = path.with_file_name(name);
    let written = std::fs::write(&part, bytes).and_then(|()| std::fs::rename(&part, path));
    written.map_err(|source| {
        let _ = std::fs::remove_file(&part);
        named(source)
    })
}

/// Removes what killed processes left of `path`. What can't be looked at or removed is left alone.
fn remove_abandoned(path: &Path) {
    let (Some(name), Some(folder)) = (path.file_name().and_then(|n| n.to_str()), path.parent()) else {
        return;
    };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let is_part = |file: &str| {
        let numbers = file.strip_prefix(name).and_then(|f| f.strip_prefix('.')?.strip_suffix(".part"));
        numbers
            .and_then(|n| n.split_once('.'))
            .is_some_and(|(process, number)| process.parse::<u32>().is_ok() && number.parse::<u64>().is_ok())
    };
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        if !entry.file_name().to_str().is_some_and(is_part) {
            continue;
        }
        let written = entry.metadata().and_then(|m| m.modified());
        if written.is_ok_and(|at| at.elapsed().is_ok_and(|age| age > ABANDONED)) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
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

    #[test]
    fn removes_what_a_killed_process_left_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, age: Duration| {
            let file = std::fs::File::create(folder.path().join(name)).unwrap();
            file.set_modified(std::time::SystemTime::now() - age).unwrap();
        };
        let old = 2 * ABANDONED;
        file("a.png.17.0.part", old);
        let kept = ["a.png.17.1.part", "a.png.notes.0.part", "ba.png.17.0.part", "a.png.17.0.parts"];
        file(kept[0], Duration::ZERO);
        kept[1..].iter().for_each(|name| file(name, old));
        write_atomic(&folder.path().join("a.png"), b"one").unwrap();
        let mut left: Vec<String> = std::fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        let mut expected = vec!["a.png"];
        expected.extend(kept);
        expected.sort_unstable();
        assert_eq!(left, expected);
    }
}
