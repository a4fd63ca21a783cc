//! What goes wrong around a server: a disk of its own that fills, a program that holds its database.

use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use tempfile::TempDir;

/// A small disk in memory, there for whoever enters its namespace and gone with it; it asks for no rights but those to have namespaces.
pub struct Disk {
    folder: TempDir,
    /// Holds the namespace.
    holder: Child,
}

impl Disk {
    /// Makes one of so many megabytes.
    ///
    /// # Errors
    /// This machine lets nobody mount anything.
    pub fn mount(megabytes: usize) -> Result<Disk, String> {
        let failed = |error: std::io::Error| format!("no disk can be mounted: {error}");
        let folder = tempfile::tempdir().map_err(failed)?;
        let script =
            format!("mount -t tmpfs -o size={megabytes}m,mode=700 tmpfs \"$0\" && echo mounted && exec cat");
        let mut command = Command::new("unshare");
        command.args(["-rm", "sh", "-c", &script]).arg(folder.path());
        let mut holder = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().map_err(failed)?;
        let said = first_line(&mut holder);
        let disk = Disk { folder, holder };
        if said == "mounted" {
            Ok(disk)
        } else {
            Err("no disk can be mounted (unshare -rm, mount)".to_owned())
        }
    }

    /// Its folder, for programs that have entered.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// The same for everybody else.
    pub fn outside(&self) -> PathBuf {
        let inside = self.folder.path().strip_prefix("/").unwrap_or(self.folder.path());
        Path::new("/proc").join(self.holder.id().to_string()).join("root").join(inside)
    }

    /// What stands before a command that is to enter.
    pub fn enter(&self) -> Vec<String> {
        let holder = self.holder.id().to_string();
        ["nsenter", "--preserve-credentials", "-U", "-m", "-t", &holder].map(str::to_owned).to_vec()
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        end(&mut self.holder);
    }
}

/// A file that takes all the room there is until it is dropped.
pub struct Filler(PathBuf);

impl Filler {
    /// Fills a folder's disk to the last byte.
    ///
    /// # Errors
    /// Anything but a full disk comes of it.
    pub fn fill(folder: &Path) -> Result<Filler, String> {
        let filler = Filler(folder.join("filler"));
        let mut file = File::create(&filler.0).map_err(|error| error.to_string())?;
        let mut block = vec![0; 1 << 20];
        loop {
            match file.write_all(&block) {
                Ok(()) => {}
                Err(error) if error.kind() != ErrorKind::StorageFull => return Err(error.to_string()),
                Err(_) if block.len() == 1 => return Ok(filler),
                Err(_) => block.truncate(block.len() / 2),
            }
        }
    }
}

impl Drop for Filler {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

/// Another program in the midst of writing to a database, until this is dropped.
pub struct Holder {
    shell: Child,
    _open: Option<ChildStdin>,
}

impl Holder {
    /// Takes the database's lock.
    ///
    /// # Errors
    /// It cannot be had.
    pub fn lock(database: &Path) -> Result<Holder, String> {
        let failed = |error: std::io::Error| format!("sqlite3: {error}");
        let mut command = Command::new("sqlite3");
        command.args(["-cmd", ".timeout 10000"]).arg(database);
        let mut shell = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().map_err(failed)?;
        let mut open = shell.stdin.take();
        if let Some(open) = &mut open {
            open.write_all(b"BEGIN IMMEDIATE; SELECT 'held';\n").map_err(failed)?;
        }
        let said = first_line(&mut shell);
        let holder = Holder { shell, _open: open };
        if said == "held" { Ok(holder) } else { Err("sqlite3 does not get the lock".to_owned()) }
    }
}

impl Drop for Holder {
    fn drop(&mut self) {
        end(&mut self.shell);
    }
}

/// What a program says first; nothing where it has ended.
fn first_line(child: &mut Child) -> String {
    let mut line = String::new();
    if let Some(out) = &mut child.stdout {
        let _ = BufReader::new(out).read_line(&mut line);
    }
    line.trim().to_owned()
}

fn end(child: &mut Child) {
    let _ = child.kill();
    let _ = child.wait();
}
