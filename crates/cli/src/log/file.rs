//! A file that stays below a size.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use kelir_store::private_file;

/// Is appended to; once it is full it is put aside under the name `….1`, in place of the one that was put aside before.
pub(super) struct BoundedFile {
    path: PathBuf,
    most_bytes: u64,
    open: Option<(File, u64)>,
}

impl BoundedFile {
    /// The file is opened when something is written, and anew after it could not be written.
    pub(super) fn new(path: &Path, most_bytes: u64) -> BoundedFile {
        BoundedFile { path: path.to_owned(), most_bytes, open: None }
    }

    fn opened(&mut self, more: u64) -> io::Result<(File, u64)> {
        let (file, bytes) = match self.open.take() {
            Some(open) => open,
            None => append(&self.path)?,
        };
        if bytes == 0 || bytes + more <= self.most_bytes {
            return Ok((file, bytes));
        }
        let mut aside = self.path.clone().into_os_string();
        aside.push(".1");
        std::fs::rename(&self.path, aside)?;
        append(&self.path)
    }
}

impl Write for BoundedFile {
    /// Writes a line whole or not at all: nobody wants the half of one.
    fn write(&mut self, line: &[u8]) -> io::Result<usize> {
        let more = line.len() as u64;
        let (mut file, bytes) = self.opened(more)?;
        file.write_all(line)?;
        self.open = Some((file, bytes + more));
        Ok(line.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Opens a file at its end; says how long it is.
fn append(path: &Path) -> io::Result<(File, u64)> {
    let file = private_file().append(true).open(path)?;
    let bytes = file.metadata()?.len();
    Ok((file, bytes))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;

    #[test]
    fn it_stays_below_its_size_and_keeps_what_was_last_said() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("server.log");
        for run in 0..2 {
            let mut file = BoundedFile::new(&path, 100);
            (0..50).for_each(|line| writeln!(file, "{run} {line:05}").unwrap());
        }
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
        let (aside, now) = (read("server.log.1"), read("server.log"));
        assert!(aside.len() <= 100 && now.len() <= 100);
        let last = format!("{aside}{now}");
        assert!(last.ends_with("1 00049\n") && last.lines().count() > 12, "{last}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn what_goes_away_is_made_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("later/server.log");
        let mut file = BoundedFile::new(&path, 100);
        assert!(file.write_all(b"lost\n").is_err());
        std::fs::create_dir(folder.path().join("later")).unwrap();
        file.write_all(b"kept\n").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "kept\n");
    }
}
