//! `kelir bench coverage`: how often the report's intervals hold the truth of simulated studies.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Result, bail};
use kelir_stats::simulate::{CELLS, Coverage, CoverageCell, Shown, coverage, shortfalls};

use crate::output::{Figures, table};

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Simulated studies of each interval in each of the 12 cells; of a threshold, whose interval takes long, an eighth as many.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    rounds: u64,
    /// What all chance comes from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    pub(crate) figures: Figures,
}

/// A threshold's study takes so many times longer than the others'.
const SLOWER: u64 = 8;

/// Runs the benchmark: an error where an interval falls below its bar.
pub(super) fn run(args: &Args) -> Result<()> {
    let jobs: Vec<(Shown, CoverageCell)> =
        Shown::ALL.into_iter().flat_map(|shown| CELLS.map(|cell| (shown, cell))).collect();
    let found = simulate(&jobs, args)?;
    let figures = &args.figures;
    figures.say(&format!(
        "How often 95% intervals hold the truth, in %, ± Monte-Carlo standard error; seed {}. Choices: of a scale between each two conditions, of a threshold at each level.\n",
        args.seed
    ))?;
    let mut header = vec!["participants", "choices", "share", "correlation", "at least"];
    header.extend(Shown::ALL.iter().map(|shown| shown.name()));
    let of = |shown: Shown| found.iter().filter(move |c| c.shown == shown);
    let mut rows: Vec<Vec<String>> = CELLS
        .iter()
        .map(|cell| {
            let CoverageCell { participants, pairs, share, icc } = cell;
            let least = 100.0 * cell.least();
            let mut row =
                vec![participants.to_string(), pairs.to_string(), share.to_string(), icc.to_string()];
            row.push(format!("{least:.0}"));
            row.extend(Shown::ALL.iter().flat_map(|s| of(*s).filter(|c| c.cell == *cell).map(one)));
            row
        })
        .collect();
    let mut mean =
        vec!["on average".to_owned(), String::new(), String::new(), String::new(), "94".to_owned()];
    mean.extend(Shown::ALL.iter().map(|shown| {
        format!("{:.1}", 100.0 * of(*shown).map(|c| c.rate.rate).sum::<f64>() / CELLS.len() as f64)
    }));
    rows.push(mean);
    figures.say(&table(&header, &rows))?;
    figures.give(&found)?;
    let short = shortfalls(&found);
    if !short.is_empty() {
        bail!("intervals hold too little:\n{}", short.join("\n"));
    }
    Ok(())
}

/// "94.1 ± 0.7", and how many studies had no interval.
fn one(found: &Coverage) -> String {
    let without = match found.rate.undefined {
        0 => String::new(),
        n => format!(" ({n} without)"),
    };
    format!("{:.1} ± {:.1}{without}", 100.0 * found.rate.rate, 100.0 * found.error())
}

/// Every job, on all threads; what comes out does not depend on how many there are.
fn simulate(jobs: &[(Shown, CoverageCell)], args: &Args) -> Result<Vec<Coverage>> {
    let bar = crate::progress::bar(jobs.len() as u64, "cells");
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some((shown, cell)) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
            let rounds = match shown {
                Shown::Share | Shown::Scale => args.rounds,
                Shown::ResampledThreshold | Shown::PosteriorThreshold => args.rounds.div_ceil(SLOWER),
            };
            let one = coverage(*shown, cell, rounds, args.seed);
            found.lock().expect("no thread panics while it holds this").push(one);
            bar.inc(1);
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    bar.finish_and_clear();
    Ok(found.into_inner().expect("threads have ended well").into_iter().collect::<Result<_, _>>()?)
}
