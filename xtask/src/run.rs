//! Running other programs, each as a named step with its time.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use anyhow::{Context, Result, bail};

/// The repository's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the root").to_path_buf()
}

/// Cargo's target folder, as the environment has it.
pub fn target_dir() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// `cargo ARGS` in the root.
pub fn cargo(args: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(args);
    command
}

/// `npm ARGS` in `folder`.
pub fn npm(folder: &str, args: &[&str]) -> Command {
    let mut command = Command::new("npm");
    command.args(args).args(["--no-fund", "--no-audit"]).current_dir(root().join(folder));
    command
}

/// Runs one step to its end; a failing step ends the task and names the command that repeats it.
pub fn step(name: &str, mut command: Command) -> Result<()> {
    eprintln!("── {name}");
    let begun = Instant::now();
    let status = command.status().with_context(|| format!("{name}: cannot start {command:?}"))?;
    if !status.success() {
        bail!("{name} failed ({status}); repeat it alone with: {command:?}");
    }
    eprintln!("── {name}: {:.0} s", begun.elapsed().as_secs_f64());
    Ok(())
}
