//! Is a difference on the scale more than chance? What each observer says of it, as a score whose sign can be flipped.

use super::scale::{fit, score};
use super::{Estimator, Observer, ScaleOptions, Wins, graph, pool};
use crate::linalg;
use crate::{Result, StatsError};

/// What each observer says of "a and b stand at one place": their score for the difference, where all conditions but these two are at their
/// best, less what follows from the other conditions' scores (the effective score of Hemerik, Goeman & Finos 2020). Its sign is as likely one
/// as the other if the two are at one place, whatever an observer's choices have in common.
pub(super) fn scores(
    all: &Wins,
    observers: &[&Observer],
    options: ScaleOptions,
    [a, b]: [usize; 2],
) -> Result<Vec<f64>> {
    let n = all.conditions();
    // b's comparisons become a's; those of the two with each other say nothing of the others.
    let merged = |i: usize| {
        let place = if i == b { a } else { i };
        place - usize::from(place > b)
    };
    let mut rest = Wins::new(n - 1);
    for i in 0..n {
        for j in (0..n).filter(|&j| merged(i) != merged(j)) {
            rest.add(merged(i), merged(j), all.count(i, j))?;
        }
    }
    let mut at = vec![0.0; n];
    if n > 2 {
        let estimator = match graph::unbeaten(&rest) {
            None if options.estimator != Estimator::Jeffreys => Estimator::MaximumLikelihood,
            _ => Estimator::Jeffreys,
        };
        let found = fit(&rest, options.model, estimator, &vec![0.0; n - 2])?;
        at = (0..n).map(|i| merged(i).checked_sub(1).map_or(0.0, |k| found.at[k])).collect();
    }
    // Rows of the information in the difference (half a step of a up, half of b down) and in the merged positions, the first of them fixed.
    let q = n.saturating_sub(2);
    let (_, information) = score(all, options.model, &at);
    let (mut cross, mut nuisance) = (vec![0.0; q], vec![0.0; q * q]);
    for i in 0..n {
        for j in 0..n {
            let (Some(row), Some(column)) = (merged(i).checked_sub(1), merged(j).checked_sub(1)) else {
                continue;
            };
            nuisance[row * q + column] += information[i * n + j];
        }
        if let Some(row) = merged(i).checked_sub(1) {
            cross[row] += 0.5 * (information[a * n + i] - information[b * n + i]);
        }
    }
    if q > 0 {
        let l = linalg::cholesky(&nuisance, q)
            .ok_or(StatsError::NotConverged { what: "the test of a difference" })?;
        linalg::solve(&l, q, &mut cross);
    }
    observers
        .iter()
        .map(|observer| {
            let (gradient, _) = score(&pool(n, [*observer])?, options.model, &at);
            let others: f64 =
                (0..n).filter_map(|i| Some(cross[merged(i).checked_sub(1)?] * gradient[i])).sum();
            Ok(0.5 * (gradient[a] - gradient[b]) - others)
        })
        .collect()
}
