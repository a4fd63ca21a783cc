//! P-values adjusted for many tests, in the order they came in; each adjusted p is compared with α itself.

use crate::{Result, StatsError};

/// Holm (1979): the chance of any false rejection is at most α, whatever the dependence.
///
/// # Errors
/// [`StatsError::InvalidElement`] for a value outside [0, 1].
pub fn holm(p: &[f64]) -> Result<Vec<f64>> {
    let order = ascending(p)?;
    let mut adjusted = vec![0.0; p.len()];
    let mut running = 0.0_f64;
    for (rank, &index) in order.iter().enumerate() {
        running = running.max(((p.len() - rank) as f64 * p[index]).min(1.0));
        adjusted[index] = running;
    }
    Ok(adjusted)
}

/// Hochberg (1988): sharper than Holm, for independent or positively dependent tests.
///
/// # Errors
/// [`StatsError::InvalidElement`] for a value outside [0, 1].
pub fn hochberg(p: &[f64]) -> Result<Vec<f64>> {
    step_up(p, |rank| (p.len() - rank) as f64)
}

/// Benjamini & Hochberg (1995): the expected share of false rejections is at most α, for independent or positively
/// dependent tests.
///
/// # Errors
/// [`StatsError::InvalidElement`] for a value outside [0, 1].
pub fn benjamini_hochberg(p: &[f64]) -> Result<Vec<f64>> {
    step_up(p, |rank| p.len() as f64 / (rank + 1) as f64)
}

/// From the largest p down, the smallest of factor · p so far.
fn step_up(p: &[f64], factor: impl Fn(usize) -> f64) -> Result<Vec<f64>> {
    let order = ascending(p)?;
    let mut adjusted = vec![0.0; p.len()];
    let mut running = 1.0_f64;
    for (rank, &index) in order.iter().enumerate().rev() {
        running = running.min(factor(rank) * p[index]);
        adjusted[index] = running;
    }
    Ok(adjusted)
}

fn ascending(p: &[f64]) -> Result<Vec<usize>> {
    if let Some(index) = p.iter().position(|p| !(0.0..=1.0).contains(p)) {
        let value = p[index];
        return Err(StatsError::InvalidElement { name: "p", index, value, rule: "must lie in [0, 1]" });
    }
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| p[a].total_cmp(&p[b]));
    Ok(order)
}
