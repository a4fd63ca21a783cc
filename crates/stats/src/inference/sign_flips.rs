//! Tests by flipping signs: of scores that would have either sign as likely, if there were nothing to find.

use crate::random::Random;
use crate::{Result, StatsError};
use serde::Serialize;
use utoipa::ToSchema;

/// Up to so many scores that are not 0 every pattern of signs is tried.
pub const EXACT_FLIPS_TO: usize = 16;
/// Sums that are equal but for rounding count as equal.
const ROUNDING: f64 = 1e-9;

/// The p of a sign-flip test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Flipped {
    /// Two-sided p: of the patterns of signs, how many make the sum as large as it is.
    pub p: f64,
    /// The smallest p that the test can give.
    pub smallest: f64,
    /// Whether every pattern was tried.
    pub exact: bool,
}

/// Two-sided test of scores that are symmetric about 0 if there is nothing to find, one a participant: over all patterns of signs up to
/// [`EXACT_FLIPS_TO`] scores that are not 0, else over `flips` random ones; deterministic for a seed. Scores of ±1 make it the sign test.
///
/// Errors: a score that is not finite; fewer than 1,000 flips.
pub fn sign_flips(scores: &[f64], flips: usize, seed: u64) -> Result<Flipped> {
    if flips < 1000 {
        let rule = "must be at least 1000";
        return Err(StatsError::Invalid { name: "flips", value: flips as f64, rule });
    }
    for score in scores {
        StatsError::finite("scores", *score)?;
    }
    Ok(flip(&[scores.to_vec()], flips, seed)[0])
}

/// For each column of scores, how often signs drawn anew make their sum as large as it is: over all patterns of signs where few observers have a
/// score, else over `flips` random ones, the same for every column.
pub(crate) fn flip(columns: &[Vec<f64>], flips: usize, seed: u64) -> Vec<Flipped> {
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    #[test]
    fn equal_scores_are_the_sign_test() {
        // Seven of nine above: R 4.2.2, binom.test(7, 9)$p.value = 0.1796875.
        let scores: Vec<f64> = (0..9).map(|k| if k < 7 { 0.5 } else { -0.5 }).chain([0.0; 4]).collect();
        let found = sign_flips(&scores, 1000, 1).unwrap();
        assert_eq!((found.p, found.exact), (0.1796875, true));
        assert_eq!(sign_flips(&[0.0, 0.0], 1000, 1).unwrap().p, 1.0);
        // Many: drawn, and never below what so many draws can tell.
        let many = sign_flips(&[1.0; 40], 1999, 1).unwrap();
        assert_eq!((many.p, many.smallest, many.exact), (1.0 / 2000.0, 1.0 / 2000.0, false));
        assert!(sign_flips(&scores, 999, 1).is_err() && sign_flips(&[f64::NAN], 1000, 1).is_err());
    }
}
