//! What other participants would have made of the threshold.

use super::fit::{STARTS, describe, ml_bounds, penalised, search, starts};
use super::{Curve, Level, Levels, Task};
use crate::clustered::{Bootstrap, BootstrapMethod, bootstrap};
use crate::optimise::{Maximum, maximise};
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A threshold's interval from resampled participants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ResampledThreshold {
    /// The interval.
    #[serde(flatten)]
    pub bootstrap: Bootstrap,
    /// Resamples whose threshold or width ended on the edge of the range that is searched, or whose threshold could be any number: their
    /// participants did not show the curve, and the interval may be wider than it is here.
    pub at_bound: usize,
}

/// The interval of the threshold (unscaled, F = ½) from resampled participants: each brings all their answers along, so that it holds
/// whatever the answers of one have in common, which [`posterior`](super::posterior()) takes for independent. The estimate is the maximum of the
/// likelihood with λ's prior, without overdispersion, over everybody's answers together, and so it is for each resample, searched as widely;
/// [`BootstrapMethod::Symmetric`]; deterministic for a seed.
///
/// `participants`: the levels each of them answered. Errors: those of [`fit`](super::fit()) and of [`bootstrap`].
pub fn resampled_threshold(
    participants: &[Vec<Level>],
    task: &Task,
    replicates: usize,
    level: f64,
    seed: u64,
) -> Result<ResampledThreshold> {
    task.check()?;
    let task = Task { overdispersion: false, ..*task };
    let all: Vec<Level> = participants.iter().flatten().copied().collect();
    let levels = Levels::new(&all)?;
    let bounds = ml_bounds(&levels, &task);
    let whole = search(&levels, &task, &bounds)?;
    let grid = Grid::new(&levels, &task, &bounds);
    // Places instead of levels: a resample is then no more than sums.
    let place = |x: f64| levels.levels.partition_point(|l| l.x < x);
    let people: Vec<Vec<(usize, u64, u64)>> = participants
        .iter()
        .map(|own| own.iter().filter(|l| l.trials > 0).map(|l| (place(l.x), l.correct, l.trials)).collect())
        .collect();
    let mut drawn: Vec<Level> = levels.levels.clone();
    // The first sample is everybody, and no resample.
    let mut at_bound: Option<usize> = None;
    let found = |sample: &[&Vec<(usize, u64, u64)>]| {
        drawn.iter_mut().for_each(|l| (l.correct, l.trials) = (0, 0));
        for &(place, correct, trials) in sample.iter().flat_map(|own| own.iter()) {
            drawn[place].correct += correct;
            drawn[place].trials += trials;
        }
        let climb = |at: &Vec<f64>| maximise(at, &bounds, |at| penalised(&drawn, &task, at));
        let tops = grid.hills(&drawn).into_iter().filter_map(climb).chain(climb(&whole.at));
        let best: Maximum = tops.max_by(|a, b| a.value.total_cmp(&b.value))?;
        let found = describe(&Levels { levels: drawn.clone(), ..levels }, &task, &bounds, &best);
        // On a level ridge the threshold is any number, whichever one was reached.
        let unbound = found.at_bound.iter().any(|name| name == "threshold" || name == "width")
            || found.standard_errors[0].is_none();
        at_bound = Some(at_bound.map_or(0, |n| n + usize::from(unbound)));
        Some(best.at[0])
    };
    let bootstrap = bootstrap(&people, replicates, level, seed, BootstrapMethod::Symmetric, found);
    let bootstrap = bootstrap.map_err(|error| match error {
        StatsError::NoSolution { reason, .. } => {
            StatsError::NoSolution { what: "the threshold's interval", reason }
        }
        other => other,
    })?;
    Ok(ResampledThreshold { bootstrap, at_bound: at_bound.unwrap_or_default() })
}

/// The coarse grid of curves with the logarithms of their proportions, so that a resample's likelihood at all of them is a few sums.
struct Grid {
    starts: Vec<Vec<f64>>,
    /// For each start its ln prior, and for each level (ln ψ, ln(1 − ψ)).
    logs: Vec<(f64, Vec<(f64, f64)>)>,
}

impl Grid {
    fn new(levels: &Levels, task: &Task, bounds: &[(f64, f64)]) -> Grid {
        let starts = starts(levels, bounds, 0.0);
        let logs = starts.iter().map(|at| {
            let curve = Curve::from_parameters(task, at);
            let of = |level: &Level| {
                let psi = curve.proportion(level.x).clamp(1e-300, 1.0 - 1e-16);
                (psi.ln(), (-psi).ln_1p())
            };
            (penalised(&[], task, at).value, levels.levels.iter().map(of).collect())
        });
        Grid { logs: logs.collect(), starts }
    }

    /// The grid's points that are higher than all beside them: one in each hill's reach.
    fn hills(&self, drawn: &[Level]) -> Vec<&Vec<f64>> {
        let height = |(prior, logs): &(f64, Vec<(f64, f64)>)| {
            let of = |(l, logs): (&Level, &(f64, f64))| {
                l.correct as f64 * logs.0 + (l.trials - l.correct) as f64 * logs.1
            };
            prior + drawn.iter().zip(logs).map(of).sum::<f64>()
        };
        let heights: Vec<f64> = self.logs.iter().map(height).collect();
        let [thresholds, widths, lapses] = STARTS;
        let strides = [widths * lapses, lapses, 1];
        let is_hill = |cell: usize| {
            let at = [cell / strides[0], cell / strides[1] % widths, cell % lapses];
            (0..3).all(|axis| {
                let below = at[axis] == 0 || heights[cell - strides[axis]] < heights[cell];
                let last = at[axis] + 1 == [thresholds, widths, lapses][axis];
                below && (last || heights[cell + strides[axis]] <= heights[cell])
            })
        };
        (0..heights.len()).filter(|&cell| is_hill(cell)).map(|cell| &self.starts[cell]).collect()
    }
}
