//! The server that is attacked: always at one port, killed and started again, its log kept.

use super::wire::{Wire, request};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::NamedTempFile;

/// A server that is not back by then will not come.
const PATIENCE: Duration = Duration::from_secs(120);

/// A running server and its data folder; killed when dropped.
pub struct Victim {
    child: Child,
    /// What stands before its command.
    before: Vec<String>,
    /// Where no part of it can fill up or be counted.
    log: NamedTempFile,
    /// Where it listens on 127.0.0.1.
    pub port: u16,
    /// Its data folder.
    pub data: PathBuf,
}

impl Victim {
    /// Starts a server on a folder and waits until the study `small` can be taken.
    ///
    /// # Errors
    /// It does not start.
    pub fn start(data: &Path) -> Result<Victim, String> {
        Victim::start_by(data, &[])
    }

    /// The same by a command that runs what follows it.
    ///
    /// # Errors
    /// It does not start.
    pub fn start_by(data: &Path, before: &[String]) -> Result<Victim, String> {
        let log = NamedTempFile::new().map_err(|error| error.to_string())?;
        let (port, before) = (crate::free_port(), before.to_vec());
        let child = spawn(data, port, &before, &log)?;
        let victim = Victim { child, before, log, port, data: data.to_owned() };
        victim.wait()?;
        Ok(victim)
    }

    /// `kill -9`, and another start; how long that took until the study could be taken.
    ///
    /// # Errors
    /// It does not come back.
    pub fn kill_and_restart(&mut self) -> Result<Duration, String> {
        self.end();
        let begun = Instant::now();
        self.child = spawn(&self.data, self.port, &self.before, &self.log)?;
        self.wait()?;
        Ok(begun.elapsed())
    }

    /// Asks it to stop (SIGTERM).
    ///
    /// # Errors
    /// It ends otherwise than well.
    pub fn terminate(&mut self) -> Result<(), String> {
        let asked = Command::new("kill").arg(self.id().to_string()).status();
        asked.map_err(|error| format!("kill: {error}"))?;
        let status = self.child.wait().map_err(|error| error.to_string())?;
        if status.success() { Ok(()) } else { Err(format!("asked to stop, the server ended with {status}")) }
    }

    /// The database.
    pub fn database(&self) -> PathBuf {
        self.data.join("kelir.sqlite")
    }

    /// Its process.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Descriptors that it holds.
    pub fn descriptors(&self) -> usize {
        std::fs::read_dir(format!("/proc/{}/fd", self.id())).map_or(0, Iterator::count)
    }

    /// What it said on standard error, since the first start.
    pub fn log(&self) -> String {
        let said = std::fs::read(&self.log).unwrap_or_default();
        String::from_utf8_lossy(&said).into_owned()
    }

    /// The status of a GET; 0 where there is no answer.
    pub fn status(&self, path: &str) -> u16 {
        Wire::new(self.port).send(&request("GET", path, &[], None)).map_or(0, |reply| reply.status)
    }

    /// Waits until a GET is answered with this status.
    ///
    /// # Errors
    /// It never is.
    pub fn wait_for(&self, path: &str, status: u16) -> Result<(), String> {
        let begun = Instant::now();
        while self.status(path) != status {
            if begun.elapsed() > PATIENCE {
                return Err(format!("{path} is not answered {status}"));
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        Ok(())
    }

    fn wait(&self) -> Result<(), String> {
        self.wait_for("/api/v1/studies/small", 200)
    }

    fn end(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Victim {
    fn drop(&mut self) {
        self.end();
    }
}

fn spawn(data: &Path, port: u16, before: &[String], log: &NamedTempFile) -> Result<Child, String> {
    let failed = |error| format!("the server does not start: {error}");
    let binary = crate::binary().into_os_string();
    let mut words = before.iter().map(Into::into).chain([binary]);
    let mut command = Command::new(words.next().unwrap_or_default());
    command.args(words).args(["serve", "--listen", &format!("127.0.0.1:{port}"), "--data"]).arg(data);
    // A copy of one descriptor: each start writes on where the one before it ended.
    let log = log.as_file().try_clone().map_err(failed)?;
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(log).spawn().map_err(failed)
}
