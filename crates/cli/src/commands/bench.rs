//! `kelir bench`: what kelir measures of itself.

use std::path::{Path, PathBuf};

use anyhow::Result;
use kelir_render::file;

use super::drawing::{Drawing, render_error};

mod accuracy;
mod frames;
mod load;
mod numerics;
mod rows;

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
        /// Also a table over pixels, mask size, emitters, puppets, samples and threads.
        #[arg(long)]
        scaling: bool,
        /// Also write the figures as JSON.
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
    },
    /// Error against time: every technique over its knobs, against Monte Carlo and, on crops, the oracle.
    Accuracy(accuracy::Args),
    /// How exact the numbers are, against values that were not derived from them: the renderer's stress cases against the oracle, unless
    /// an option asks for something else.
    Numerics {
        /// The statistics: distributions against mpmath, moments and F against NIST.
        #[arg(long)]
        stats: bool,
        /// What is not exact (tilted planes, several planes, disks, the dome) over the knob that buys the error down.
        #[arg(long)]
        curves: bool,
        /// Leave out masks of more texels a side: 8192 takes minutes.
        #[arg(long, value_name = "SIDE", default_value_t = 8192)]
        most: usize,
        /// Also write the figures as JSON (not of --stats).
        #[arg(long, value_name = "FILE", conflicts_with = "stats")]
        json: Option<PathBuf>,
    },
    /// Durable answers a second, against Express and better-sqlite3 that store the same rows; how long a thousand people wait; whether starts and
    /// answers slow down as sessions gather.
    Load(load::Args),
    /// How long judging a million answers takes, from the database to the researcher's page.
    Rows(rows::Args),
}

/// Runs the command.
pub fn run(command: Command) -> Result<()> {
    match command {
        Command::Frames { drawing, frames, scaling, json } => {
            frames::run(&drawing, frames, scaling, json.as_deref())
        }
        Command::Accuracy(args) => accuracy::run(&args),
        Command::Numerics { stats: true, .. } => numerics::statistics(),
        Command::Numerics { curves: true, json, .. } => numerics::curves(json.as_deref()),
        Command::Numerics { most, json, .. } => numerics::renderer(most, json.as_deref()),
        Command::Load(args) => load::run(&args),
        Command::Rows(args) => rows::run(&args),
    }
}

fn write_json(path: Option<&Path>, report: &impl serde::Serialize) -> Result<()> {
    match path {
        Some(path) => {
            file::write_atomic(path, serde_json::to_string_pretty(report)?.as_bytes()).map_err(render_error)
        }
        None => Ok(()),
    }
}
