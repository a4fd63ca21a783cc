//! Is a difference on the scale more than chance? The signs of observers' scores are flipped.

use super::scale::{fit, score};
use super::{Estimator, Observer, ScaleOptions, Wins, graph, pool};
use crate::linalg;
use crate::random::Random;
use crate::{Result, StatsError};

/// Up to so many observers with a score every pattern of signs is tried.
pub const EXACT_FLIPS_TO: usize = 16;
/// Sums that are equal but for rounding count as equal.
const ROUNDING: f64 = 1e-9;

/// The p of a sign-flip test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Flipped {
    pub p: f64,
    /// The smallest p that the test can give.
    pub smallest: f64,
    pub exact: bool,
}

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

/// For each column of scores, how often signs drawn anew make their sum as large as it is: over all patterns of signs where few observers have a
/// score, else over `flips` random ones, the same for every column.
pub(super) fn flip(columns: &[Vec<f64>], flips: usize, seed: u64) -> Vec<Flipped> {
    let largest = |column: &[f64]| column.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let scored = |column: &[f64]| {
        let floor = ROUNDING * largest(column);
        column.iter().copied().filter(|x| x.abs() > floor).collect::<Vec<f64>>()
    };
    let mut found: Vec<Option<Flipped>> = columns
        .iter()
        .map(|column| Some(scored(column)).filter(|s| s.len() <= EXACT_FLIPS_TO).map(|s| every_pattern(&s)))
        .collect();
    let sampled: Vec<usize> = (0..columns.len()).filter(|&i| found[i].is_none()).collect();
    let mut reached = vec![0usize; columns.len()];
    let observers = columns.first().map_or(0, Vec::len);
    let mut signs = vec![0; observers.div_ceil(64)];
    for replicate in 0..if sampled.is_empty() { 0 } else { flips } {
        let mut random = Random::stream(seed, replicate as u64);
        signs.fill_with(|| random.next_u64());
        let signed = |(k, x): (usize, &f64)| if signs[k / 64] >> (k % 64) & 1 == 1 { *x } else { -x };
        for &i in &sampled {
            let sum: f64 = columns[i].iter().enumerate().map(signed).sum();
            reached[i] += usize::from(sum.abs() >= columns[i].iter().sum::<f64>().abs() * (1.0 - ROUNDING));
        }
    }
    let smallest = 1.0 / (1.0 + flips as f64);
    for i in sampled {
        found[i] = Some(Flipped { p: (1.0 + reached[i] as f64) * smallest, smallest, exact: false });
    }
    found.into_iter().flatten().collect()
}

/// The test over all 2ⁿ patterns of signs, one sign held, as their mirror images give the same size.
fn every_pattern(scores: &[f64]) -> Flipped {
    let Some((first, rest)) = scores.split_first() else {
        return Flipped { p: 1.0, smallest: 1.0, exact: true };
    };
    let size = scores.iter().sum::<f64>().abs();
    let size = size - ROUNDING * scores.iter().map(|x| x.abs()).sum::<f64>();
    let patterns = 1usize << rest.len();
    let signed = |pattern: usize| {
        let of = |(k, x): (usize, &f64)| if pattern >> k & 1 == 1 { *x } else { -*x };
        first + rest.iter().enumerate().map(of).sum::<f64>()
    };
    let reached = (0..patterns).filter(|&pattern| signed(pattern).abs() >= size).count();
    Flipped { p: reached as f64 / patterns as f64, smallest: 1.0 / patterns as f64, exact: true }
}
