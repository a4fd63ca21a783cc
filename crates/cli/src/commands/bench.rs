//! `kelir bench`: what kelir measures of itself.

use std::path::PathBuf;

use anyhow::{Result, bail};
use kelir_render::bench::{Case, frames};
use kelir_render::file;
use kelir_stats::numerics;

use super::drawing::{Drawing, render_error};
use crate::bad_input;
use crate::output::{print, table};

/// Subcommands of `kelir bench`.
#[derive(clap::Subcommand)]
pub enum Command {
    /// Frames a second without file output, beside the time to fill such a frame with a constant.
    Frames {
        #[command(flatten)]
        drawing: Drawing,
        /// Frames of each case.
        #[arg(long, default_value_t = 200)]
        frames: usize,
        /// Also write the figures as JSON.
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
    },
    /// How exact the numbers are, against values that were not derived from them.
    Numerics {
        /// The statistics: distributions against mpmath, moments and F against NIST.
        #[arg(long, required = true)]
        stats: bool,
    },
}

/// Runs the command.
pub fn run(command: Command) -> Result<()> {
    match command {
        Command::Frames { drawing, frames, json } => run_frames(&drawing, frames, json),
        Command::Numerics { stats: _ } => run_numerics(),
    }
}

fn run_frames(drawing: &Drawing, count: usize, json: Option<PathBuf>) -> Result<()> {
    if count == 0 {
        return Err(bad_input("frames = 0: at least one frame is drawn"));
    }
    let mut scene = drawing.load()?;
    let view = drawing.view(&scene.still());
    let cases = [Case::Slid, Case::Posed, Case::LampMoved, Case::NothingSkipped];
    let report = frames(&mut scene, &drawing.technique(), drawing.backend, &view, count, &cases)
        .map_err(render_error)?;
    let [width, height] = report.size;
    print(&format!("{width}x{height}, {} frames a case, {}\n", report.frames, report.adapter))?;
    let rows: Vec<Vec<String>> = report
        .cases
        .iter()
        .map(|case| {
            let name = match case.case {
                Case::Slid => "puppet slid",
                Case::Posed => "puppet posed",
                Case::LampMoved => "lamp moved",
                Case::NothingSkipped => "nothing skipped",
            };
            let steps: Vec<String> =
                case.steps_ms.iter().map(|(step, ms)| format!("{step} {ms:.2}")).collect();
            vec![
                name.to_owned(),
                format!("{:.1}", case.fps),
                format!("{:.3}", case.median_ms),
                format!("{:.3}", case.p99_ms),
                format!("{:.3}", case.floor_ms),
                format!("{:.1}", case.ratio),
                steps.join(", "),
            ]
        })
        .collect();
    print(&table(
        &["case", "frames/s", "median ms", "p99 ms", "fill ms", "median/fill", "steps, ms"],
        &rows,
    ))?;
    if let Some(path) = json {
        file::write_atomic(&path, serde_json::to_string_pretty(&report)?.as_bytes()).map_err(render_error)?;
    }
    Ok(())
}

fn run_numerics() -> Result<()> {
    print("Distributions against mpmath: the worst relative error of each function\n")?;
    let rows: Vec<Vec<String>> = numerics::worst_errors()?
        .iter()
        .map(|row| {
            vec![
                row.function.to_owned(),
                format!("{:e}", row.size_to),
                row.points.to_string(),
                format!("{:.1e}", row.relative_error),
                format!("{:?}", row.arguments),
            ]
        })
        .collect();
    print(&table(&["function", "sizes to", "points", "relative error", "at"], &rows))?;
    print("\nNIST StRD: digits shared with the certified value, and the most that f64 inputs allow\n")?;
    let certified = numerics::nist()?;
    let rows: Vec<Vec<String>> = certified
        .iter()
        .map(|row| {
            let digits = [row.digits(), row.ceiling()].map(|digits| format!("{digits:.1}"));
            vec![row.set.to_owned(), row.statistic.to_owned(), digits[0].clone(), digits[1].clone()]
        })
        .collect();
    print(&table(&["set", "statistic", "digits", "ceiling"], &rows))?;
    if let Some(short) = certified.iter().find(|row| row.digits() < row.ceiling() - 0.5) {
        bail!("{} {} falls short of its ceiling", short.set, short.statistic);
    }
    Ok(())
}
