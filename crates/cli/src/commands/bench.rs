//! `kelir bench`: what kelir measures of itself.

use anyhow::Result;
use kelir_render::Isa;

use super::drawing::Drawing;
use crate::output::Figures;

mod accuracy;
mod coverage;
mod frames;
#[cfg(feature = "gpu")]
mod gpu;
mod load;
mod numerics;
mod rows;

/// Subcommands of `kelir bench`.
#[derive(clap::Subcommand)]
pub(crate) enum Command {
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
        #[command(flatten)]
        figures: Figures,
    },
    /// Error against time: every technique over its knobs, against Monte Carlo and, on crops, the oracle.
    Accuracy(accuracy::Args),
    /// Whether the GPU draws what the native code draws, by every technique and with what must not pass, and how fast and exact both are: a
    /// minute or two. Fails where a comparison does not hold.
    #[cfg(feature = "gpu")]
    Gpu(gpu::Args),
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
        #[command(flatten)]
        figures: Figures,
    },
    /// How often the report's intervals hold the truth of simulated studies, in 12 fixed cells; fails below the bars. Takes minutes.
    Coverage(coverage::Args),
    /// Durable answers a second, against Express and better-sqlite3 that store the same rows; how long a thousand people wait; whether starts and
    /// answers slow down as sessions gather.
    Load(load::Args),
    /// How long judging a million answers takes, from the database to the researcher's page.
    Rows(rows::Args),
}

impl Command {
    fn figures(&self) -> &Figures {
        match self {
            Self::Frames { figures, .. } | Self::Numerics { figures, .. } => figures,
            Self::Accuracy(args) => &args.figures,
            Self::Coverage(args) => &args.figures,
            #[cfg(feature = "gpu")]
            Self::Gpu(args) => &args.figures,
            Self::Load(args) => &args.figures,
            Self::Rows(args) => &args.figures,
        }
    }
}

/// Runs the command.
pub(crate) fn run(command: Command) -> Result<()> {
    let figures = command.figures().clone();
    figures.try_writing()?;
    measure(command)?;
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    figures.note(&format!("\nMeasured with instruction set {} on {threads} threads.", Isa::provenance()))
}

fn measure(command: Command) -> Result<()> {
    match command {
        Command::Frames { drawing, frames, scaling, figures } => {
            frames::run(&drawing, frames, scaling, &figures)
        }
        Command::Accuracy(args) => accuracy::run(&args),
        Command::Coverage(args) => coverage::run(&args),
        #[cfg(feature = "gpu")]
        Command::Gpu(args) => gpu::run(&args),
        Command::Numerics { stats: true, figures, .. } => numerics::statistics(&figures),
        Command::Numerics { curves: true, figures, .. } => numerics::curves(&figures),
        Command::Numerics { most, figures, .. } => numerics::renderer(most, &figures),
        Command::Load(args) => load::run(&args),
        Command::Rows(args) => rows::run(&args),
    }
}
