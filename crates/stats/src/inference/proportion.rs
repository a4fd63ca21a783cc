//! Intervals of a proportion.

use super::{Interval, check_successes, tail_of};
use crate::Result;
use crate::distributions::{Beta, normal};

/// Wilson's score interval (1927), without continuity correction: covers close to its level on average.
///
/// # Errors
/// [`crate::StatsError::TooFew`] without a trial; [`crate::StatsError::Invalid`] for more successes than trials or a
/// level outside (0, 1).
pub fn wilson(successes: u64, n: u64, level: f64) -> Result<Interval> {
    check_successes(successes, n)?;
    let [low, high] = score_interval(successes as f64, n as f64, normal::quantile_sf(tail_of(level)?)?);
    Ok(Interval { low, high, level })
}

/// Wilson's ends for x successes in n trials, whole or not, at the normal deviate z.
pub(crate) fn score_interval(x: f64, n: f64, z: f64) -> [f64; 2] {
    let z2 = z * z;
    let root = z * (z2 / 4.0 + x * (n - x) / n).sqrt();
    let middle = x + z2 / 2.0;
    // The end near 0 as a quotient, because middle − root cancels there: their product is x² (n + z²) / n.
    let low = if x == 0.0 { 0.0 } else { x * x / n / (middle + root) };
    let high = if x == n { 1.0 } else { (middle + root) / (n + z2) };
    [low, high]
}

/// The exact interval of Clopper & Pearson (1934): covers at least its level.
///
/// # Errors
/// As [`wilson`].
pub fn clopper_pearson(successes: u64, n: u64, level: f64) -> Result<Interval> {
    check_successes(successes, n)?;
    let tail = tail_of(level)?;
    let (x, failures) = (successes as f64, (n - successes) as f64);
    let low = if successes == 0 { 0.0 } else { Beta::new(x, failures + 1.0)?.quantile(tail)? };
    let high = if successes == n { 1.0 } else { Beta::new(x + 1.0, failures)?.quantile_sf(tail)? };
    Ok(Interval { low, high, level })
}

/// Jeffreys' interval: the central one of Beta(x + ½, n − x + ½), with 0 (1) as its end when there is no success (no
/// failure), after Brown, Cai & DasGupta (2001).
///
/// # Errors
/// As [`wilson`].
pub fn jeffreys(successes: u64, n: u64, level: f64) -> Result<Interval> {
    check_successes(successes, n)?;
    let tail = tail_of(level)?;
    let posterior = Beta::new(successes as f64 + 0.5, (n - successes) as f64 + 0.5)?;
    let low = if successes == 0 { 0.0 } else { posterior.quantile(tail)? };
    let high = if successes == n { 1.0 } else { posterior.quantile_sf(tail)? };
    Ok(Interval { low, high, level })
}
