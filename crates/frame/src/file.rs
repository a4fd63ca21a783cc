//! Files that are whole or absent.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use crate::RenderError;

/// A part that nobody has written to for so long was left by a process that was killed.
const ABANDONED: Duration = Duration::from_secs(60);
/// A folder waits longer for its next file: a frame may take minutes.
const ABANDONED_FOLDER: Duration = Duration::from_secs(3600);

/// Writes `bytes` beside `path` and renames: whoever is interrupted leaves no half-written file, at most `NAME.PROCESS.NUMBER.part`, which
/// a later write of the same file removes. Missing folders are made. What a link leads to is written; a device or pipe is written to as it is.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), RenderError> {
    if is_special(path) {
        return std::fs::write(path, bytes).map_err(|source| named(path, source));
    }
    let place = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let part = part_of(&place)?;
    let written = std::fs::write(&part.path, bytes).and_then(|()| std::fs::rename(&part.path, &place));
    written.map_err(|source| named(path, source))
}

/// Whether there is something that is neither file nor folder, in whose place no file may be put: a device, a pipe.
fn is_special(path: &Path) -> bool {
    path.metadata().is_ok_and(|about| !about.is_file() && !about.is_dir())
}

/// Tries whether a file can be written, and leaves nothing of it: what can't be is told before anything is drawn.
///
/// Errors: what the system says, and a folder in the file's place.
pub fn try_writing(path: &Path) -> Result<(), RenderError> {
    if is_special(path) {
        return Ok(());
    }
    let part = part_of(path)?;
    std::fs::File::create(&part.path).map(drop).map_err(|source| named(path, source))
}

fn part_of(path: &Path) -> Result<Part, RenderError> {
    if path.is_dir() {
        return Err(named(path, std::io::ErrorKind::IsADirectory.into()));
    }
    Part::beside(path)
}

/// The error of a path.
pub(super) fn named(path: &Path, source: std::io::Error) -> RenderError {
    RenderError::Io { path: path.display().to_string(), source }
}

/// A name beside a path under which it is made, and the folders that had to be made for it. What of these is left empty goes when it is dropped.
#[derive(Debug)]
pub(super) struct Part {
    pub path: PathBuf,
    made: Vec<PathBuf>,
}

impl Part {
    pub(super) fn beside(path: &Path) -> Result<Self, RenderError> {
        static SERIAL: AtomicU64 = AtomicU64::new(0);
        let folders = path.ancestors().skip(1).filter(|folder| !folder.as_os_str().is_empty());
        let made: Vec<PathBuf> = folders.take_while(|folder| !folder.exists()).map(Path::to_owned).collect();
        if let Some(folder) = made.first() {
            std::fs::create_dir_all(folder).map_err(|source| named(path, source))?;
        }
        remove_abandoned(path);
        let mut name = path.file_name().unwrap_or_default().to_os_string();
        name.push(format!(".{}.{}.part", std::process::id(), SERIAL.fetch_add(1, Ordering::Relaxed)));
        Ok(Self { path: path.with_file_name(name), made })
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        let _ = if self.path.is_dir() {
            std::fs::remove_dir_all(&self.path)
        } else {
            std::fs::remove_file(&self.path)
        };
        // Only empty folders can be removed so.
        self.made.iter().for_each(|folder| drop(std::fs::remove_dir(folder)));
    }
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
        let Ok(about) = entry.metadata() else { continue };
        let age = about.modified().ok().and_then(|at| at.elapsed().ok()).unwrap_or_default();
        let _ = match about.is_dir() {
            true if age > ABANDONED_FOLDER => std::fs::remove_dir_all(entry.path()),
            false if age > ABANDONED => std::fs::remove_file(entry.path()),
            _ => Ok(()),
        };
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

    /// As root, a file in a device's place would be all that is left of it.
    #[cfg(target_os = "linux")]
    #[test]
    fn devices_and_links_stay_what_they_are() {
        let folder = tempfile::tempdir().unwrap();
        let link = |name: &str, target: &Path| {
            let path = folder.path().join(name);
            std::os::unix::fs::symlink(target, &path).unwrap();
            path
        };
        let full = link("full.png", Path::new("/dev/full"));
        try_writing(&full).unwrap();
        assert!(write_atomic(&full, b"x").unwrap_err().to_string().contains("full.png"));
        let file = folder.path().join("file.png");
        std::fs::write(&file, b"one").unwrap();
        write_atomic(&link("link.png", &file), b"two").unwrap();
        assert_eq!(std::fs::read(&file).unwrap(), b"two");
        assert!(full.is_symlink() && folder.path().join("link.png").is_symlink());
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

    /// Renamed over, `/dev/null` would be a file from then on.
    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_not_replaced() {
        use std::os::unix::fs::FileTypeExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("socket");
        let _listens = std::os::unix::net::UnixListener::bind(&path).unwrap();
        assert!(write_atomic(&path, b"one").is_err());
        assert!(std::fs::metadata(&path).unwrap().file_type().is_socket());
        write_atomic(Path::new("/dev/null"), b"one").unwrap();
    }

    #[test]
    fn what_cannot_be_written_is_told_before_it_is_made() {
        let folder = tempfile::tempdir().unwrap();
        let taken = folder.path().join("taken");
        std::fs::write(&taken, b"").unwrap();
        for path in [taken.join("a.png"), folder.path().to_owned()] {
            assert!(try_writing(&path).is_err(), "{}", path.display());
        }
        // A try leaves neither its part nor the folders that were made for it.
        try_writing(&folder.path().join("new/newer/a.png")).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
