//! What other participants would have made of the threshold.

use super::fit::{ml_bounds, penalised, search};
use super::{Level, Levels, Task};
use crate::clustered::{Bootstrap, BootstrapMethod, bootstrap};
use crate::optimise::maximise;
use crate::{Result, StatsError};

/// The interval of the threshold (unscaled, F = ½) from resampled participants: each brings all their answers along, so that it holds
/// whatever the answers of one have in common, which [`posterior`](super::posterior()) takes for independent. The estimate is the maximum of the
/// likelihood with λ's prior, without overdispersion, over everybody's answers together; percentile method; deterministic for a seed.
///
/// `participants`: the levels each of them answered. Errors: those of [`fit`](super::fit()) and of [`bootstrap`].
pub fn resampled_threshold(
    participants: &[Vec<Level>],
    task: &Task,
    replicates: usize,
    level: f64,
    seed: u64,
) -> Result<Bootstrap> {
    task.check()?;
    let task = Task { overdispersion: false, ..*task };
    let all: Vec<Level> = participants.iter().flatten().copied().collect();
    let levels = Levels::new(&all)?;
    let bounds = ml_bounds(&levels, &task);
    let whole = search(&levels, &task, &bounds)?;
    // Places instead of levels: a resample is then no more than sums.
    let place = |x: f64| levels.levels.partition_point(|l| l.x < x);
    let people: Vec<Vec<(usize, u64, u64)>> = participants
        .iter()
        .map(|own| own.iter().filter(|l| l.trials > 0).map(|l| (place(l.x), l.correct, l.trials)).collect())
        .collect();
    let mut drawn: Vec<Level> = levels.levels.clone();
    bootstrap(&people, replicates, level, seed, BootstrapMethod::Percentile, |sample| {
        drawn.iter_mut().for_each(|l| (l.correct, l.trials) = (0, 0));
        for &(place, correct, trials) in sample.iter().flat_map(|own| own.iter()) {
            drawn[place].correct += correct;
            drawn[place].trials += trials;
        }
        // From everybody's curve a resample's is a few Newton steps away.
        maximise(&whole.at, &bounds, |at| penalised(&drawn, &task, at)).map(|found| found.at[0])
    })
    .map_err(|error| match error {
        StatsError::NoSolution { reason, .. } => {
            StatsError::NoSolution { what: "the threshold's interval", reason }
        }
        other => other,
    })
}
