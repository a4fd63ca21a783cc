//! Running other programs, each as a named step with its time.

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context, Result, bail};

/// The repository's root.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the root").to_path_buf()
}

/// Cargo's target folder, as the environment has it.
pub(crate) fn target_dir() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// `cargo ARGS` in the root.
pub(crate) fn cargo(args: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(args);
    command
}

/// `npm ARGS` in `folder`.
pub(crate) fn npm(folder: &str, args: &[&str]) -> Command {
    let mut command = Command::new("npm");
    command.args(args).args(["--no-fund", "--no-audit"]).current_dir(root().join(folder));
    command
}

/// Runs one step to its end; a failing step ends the task and names the command that repeats it.
pub(crate) fn step(name: &str, mut command: Command) -> Result<()> {
    eprintln!("── {name}");
    let begun = Instant::now();
    let status = command.status().with_context(|| format!("{name}: cannot start {command:?}"))?;
    if !status.success() {
        bail!("{name} failed ({status}); repeat it alone with: {command:?}");
    }
    eprintln!("── {name}: {:.0} s", begun.elapsed().as_secs_f64());
    Ok(())
}

/// Runs `cargo test` like [`step`] and ends with the sum over its binaries: one line that says how much was tested.
pub(crate) fn tests(name: &str, mut command: Command) -> Result<()> {
    eprintln!("── {name}");
    let begun = Instant::now();
    let mut child = command.stdout(Stdio::piped()).spawn().with_context(|| format!("{name}: {command:?}"))?;
    let lines = BufReader::new(child.stdout.take().expect("the pipe was asked for")).lines();
    let mut sums = Counts::default();
    let mut out = std::io::stdout().lock();
    for line in lines {
        let line = line?;
        sums.add(&line);
        writeln!(out, "{line}")?;
    }
    let status = child.wait()?;
    eprintln!("── {name}: {:.0} s", begun.elapsed().as_secs_f64());
    writeln!(out, "{} passed, {} failed, {} skipped", sums.passed, sums.failed, sums.ignored)?;
    if !status.success() {
        bail!("{name} failed ({status}); repeat it alone with: {command:?}");
    }
    Ok(())
}

/// What the test binaries counted.
#[derive(Debug, Default, PartialEq)]
struct Counts {
    passed: u64,
    failed: u64,
    ignored: u64,
}

impl Counts {
    /// Reads `test result: ok. 12 passed; 0 failed; 1 ignored; …`; any other line is none of it.
    fn add(&mut self, line: &str) {
        let Some((_, counts)) = line.strip_prefix("test result: ").and_then(|rest| rest.split_once(". "))
        else {
            return;
        };
        for part in counts.split("; ") {
            let Some((number, what)) = part.split_once(' ') else { continue };
            let Ok(number) = number.parse::<u64>() else { continue };
            match what {
                "passed" => self.passed += number,
                "failed" => self.failed += number,
                "ignored" => self.ignored += number,
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod unit {
    use super::*;

    #[test]
    fn result_lines_are_summed_and_others_are_not() {
        let mut counts = Counts::default();
        counts.add(
            "test result: ok. 12 passed; 0 failed; 1 ignored; 0 measured; 76 filtered out; finished in 0.80s",
        );
        counts.add("test result: FAILED. 3 passed; 2 failed; 0 ignored; 0 measured; 0 filtered out");
        counts.add("test a::b ... ok");
        counts.add("9 passed; 9 failed");
        assert_eq!(counts, Counts { passed: 15, failed: 2, ignored: 1 });
    }
}
