//! The one binary of kelir. Exit codes: 0 done, 1 something failed, 2 the input is wrong and nothing was written.

mod commands;
mod log;
mod output;
mod progress;

use std::io::Write;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use kelir_render::Isa;

/// A platform for perceptual studies of shadows: render, ask, store, judge.
#[derive(Parser)]
#[command(name = "kelir", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Serve the studies: participants' pages, the researcher's console, stimuli.
    Serve(commands::serve::Args),
    /// Draw one image of a scene.
    Render(commands::render::Args),
    /// Draw the frames of a scene's timeline.
    Animate(commands::animate::Args),
    /// Write a study of your own to begin with: a folder that `kelir serve --data` serves.
    New(commands::new::Args),
    /// What draws, and what can be turned on it.
    Technique(commands::technique::Args),
    /// Look at scene files.
    #[command(subcommand)]
    Scene(commands::scene::Command),
    /// Meshes: files checked and brought in, levels of detail made and measured.
    #[command(subcommand)]
    Mesh(commands::mesh::Command),
    /// Look at study files.
    #[command(subcommand)]
    Study(commands::study::Command),
    /// Measure kelir itself: frames a second, the exactness of its numbers.
    #[command(subcommand)]
    Bench(commands::bench::Command),
    /// Judge the answers of a study, or numbers of your own.
    Stats(commands::stats::Args),
    /// Write a study's report: one HTML file, or Markdown with its figures.
    Report(commands::report::Args),
    /// Write a study's answers as tables.
    Export(commands::export::Args),
    /// Prove that the stored answers are what was written.
    #[command(subcommand)]
    Chain(commands::chain::Command),
    /// How many participants a study needs: simulated observers take it and are judged by its report.
    Power(commands::power::Args),
    /// A published result, computed again, with what it left out.
    Paper(commands::paper::Args),
}

/// The input is wrong: exit code 2, nothing written.
#[derive(Debug)]
pub struct BadInput(pub String);

impl std::fmt::Display for BadInput {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for BadInput {}

/// Turns a library's complaint about its input into [`BadInput`].
pub fn bad_input(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow::Error::new(BadInput(error.to_string()))
}

/// Mesa's device-select layer looks for a display and complains on stderr; kelir orders the adapters itself. The variable that silences it has to
/// stand before the program begins, so it begins anew with it. Where that fails, there is a complaint more.
#[cfg(all(unix, feature = "gpu"))]
fn without_device_select() {
    use std::os::unix::process::CommandExt;
    const SILENT: &str = "NODEVICE_SELECT";
    if std::env::var_os(SILENT).is_none()
        && let Ok(kelir) = std::env::current_exe()
    {
        let mut words = std::env::args_os();
        let name = words.next().unwrap_or_else(|| "kelir".into());
        let _ = std::process::Command::new(kelir).arg0(name).args(words).env(SILENT, "1").exec();
    }
}

/// The command line; `--time -1` is a value that its own rule refuses, not a flag `-1` that nobody meant.
fn command_line() -> clap::Command {
    fn with_negative_numbers(command: clap::Command) -> clap::Command {
        command
            .mut_args(
                |arg| if arg.get_action().takes_values() { arg.allow_negative_numbers(true) } else { arg },
            )
            .mut_subcommands(with_negative_numbers)
    }
    with_negative_numbers(Cli::command())
}

fn main() -> ExitCode {
    let command =
        Cli::from_arg_matches(&command_line().get_matches()).unwrap_or_else(|error| error.exit()).command;
    #[cfg(all(unix, feature = "gpu"))]
    if matches!(command, Command::Render(_) | Command::Animate(_) | Command::Bench(_)) {
        without_device_select();
    }
    match Isa::forced().map_err(bad_input).and_then(|_| run(command)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // A closed terminal is no reason for another exit code.
            let _ = writeln!(std::io::stderr(), "kelir: {}", said(&error));
            if error.is::<BadInput>() { ExitCode::from(2) } else { ExitCode::FAILURE }
        }
    }
}

fn run(command: Command) -> anyhow::Result<()> {
    match command {
        Command::Serve(args) => commands::serve::run(args),
        Command::Render(args) => commands::render::run(args),
        Command::Animate(args) => commands::animate::run(args),
        Command::New(args) => commands::new::run(&args),
        Command::Technique(args) => commands::technique::run(&args),
        Command::Scene(command) => commands::scene::run(command),
        Command::Mesh(command) => commands::mesh::run(command),
        Command::Study(command) => commands::study::run(command),
        Command::Bench(command) => commands::bench::run(command),
        Command::Stats(args) => commands::stats::run(args),
        Command::Report(args) => commands::report::run(args),
        Command::Export(args) => commands::export::run(&args),
        Command::Chain(command) => commands::chain::run(command),
        Command::Power(args) => commands::power::run(&args),
        Command::Paper(args) => commands::paper::run(args),
    }
}

/// An error with its causes, each said once: many say their cause themselves.
fn said(error: &anyhow::Error) -> String {
    let mut said = String::new();
    for cause in error.chain().map(ToString::to_string).filter(|cause| !cause.is_empty()) {
        if said.is_empty() {
            said = cause;
        } else if !said.contains(&cause) {
            said = format!("{said}: {cause}");
        }
    }
    said
}

#[cfg(test)]
mod tests {
    use super::said;
    use anyhow::{Context, anyhow};

    #[test]
    fn causes_are_said_once() {
        let plain = anyhow!("no such file").context("reading x");
        assert_eq!(said(&plain), "reading x: no such file");
        let twice = anyhow!("no such file").context("reading x: no such file");
        assert_eq!(said(&twice), "reading x: no such file");
        let io: anyhow::Result<()> = Err(std::io::Error::other("in use")).context("cannot listen: in use");
        assert_eq!(io.map_err(|error| said(&error)), Err("cannot listen: in use".to_owned()));
    }
}
