//! Autocorrelation and one-way analysis of variance.

use serde::Serialize;
use utoipa::ToSchema;

use super::Moments;
use crate::distributions::FisherF;
use crate::distributions::dd::Dd;
use crate::{Result, StatsError};

/// The correlation of a series with itself `lag` steps later: Σ dᵢ dᵢ₊ₗ / Σ dᵢ², d being the deviations from the mean
/// of the whole series (NIST's definition); exact on f64 inputs, then rounded.
///
/// # Errors
/// [`StatsError::TooFew`] unless there are more than `lag` values (and two at least), [`StatsError::ZeroVariance`],
/// [`StatsError::InvalidElement`] for a value that is not finite.
pub fn autocorrelation(values: &[f64], lag: usize) -> Result<f64> {
    let needed = (lag as u64).saturating_add(1).max(2);
    if (values.len() as u64) < needed {
        return Err(StatsError::TooFew { name: "values", len: values.len() as u64, needed });
    }
    Moments::of(values)?.spread("values", "the autocorrelation")?;
    let values = rescaled(values, values);
    let mean = mean(&values);
    let deviation = |&x: &f64| Dd::from(x) - mean;
    let sum =
        |pairs: &mut dyn Iterator<Item = (Dd, Dd)>| pairs.fold(Dd::from(0.0), |sum, (a, b)| sum + a * b);
    let products = sum(&mut values.iter().map(deviation).zip(values[lag..].iter().map(deviation)));
    let squares = sum(&mut values.iter().map(|x| (deviation(x), deviation(x))));
    Ok((products / squares).value())
}

/// A one-way analysis of variance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct OneWayAnova {
    /// Groups − 1.
    pub df_between: f64,
    /// Values − groups.
    pub df_within: f64,
    /// Mean square between groups, over that within.
    pub f: f64,
    /// P(F ≥ f) when all groups have the same mean.
    pub p: f64,
    /// Share of the sum of squares that lies between the groups.
    pub r_squared: f64,
    /// √ mean square within groups, in the units of the values.
    pub residual_sd: f64,
}

/// Tests whether independent normal groups of equal spread have one mean (any sizes ≥ 1, more values than groups).
///
/// # Errors
/// [`StatsError::TooFew`] below two groups, for an empty group, or without a value to spare;
/// [`StatsError::ZeroVariance`] when no group varies within itself; [`StatsError::InvalidElement`].
pub fn one_way_anova(groups: &[&[f64]]) -> Result<OneWayAnova> {
    if groups.len() < 2 {
        return Err(StatsError::TooFew { name: "groups", len: groups.len() as u64, needed: 2 });
    }
    let mut varies = false;
    for group in groups {
        varies |= Moments::of(group)?.sd.is_some_and(|sd| sd > 0.0);
    }
    let all: Vec<f64> = groups.concat();
    let (n, k) = (all.len() as f64, groups.len() as f64);
    if n <= k {
        return Err(StatsError::TooFew {
            name: "values",
            len: all.len() as u64,
            needed: groups.len() as u64 + 1,
        });
    }
    if !varies {
        return Err(StatsError::ZeroVariance {
            name: "each group",
            len: all.len() as u64,
            value: all[0],
            undefined: "F",
        });
    }
    let grand = mean(&rescaled(&all, &all));
    let (mut between, mut within) = (Dd::from(0.0), Dd::from(0.0));
    for group in groups {
        let group = rescaled(group, &all);
        let mean = mean(&group);
        let shift = mean - grand;
        between = between + shift * shift * (group.len() as f64).into();
        within = group.iter().fold(within, |sum, &x| sum + (Dd::from(x) - mean) * (Dd::from(x) - mean));
    }
    let (df_between, df_within) = (k - 1.0, n - k);
    let mean_square = within / df_within.into();
    let f = (between / df_between.into() / mean_square).value();
    Ok(OneWayAnova {
        df_between,
        df_within,
        f,
        p: FisherF::new(df_between, df_within)?.sf(f)?,
        r_squared: (between / (between + within)).value(),
        residual_sd: mean_square.value().sqrt() / power_of_two(&all),
    })
}

fn mean(values: &[f64]) -> Dd {
    values.iter().fold(Dd::from(0.0), |sum, &x| sum + x.into()) / (values.len() as f64).into()
}

/// The values times the power of two that makes the largest of `of` about 1, so that no square over- or underflows.
fn rescaled(values: &[f64], of: &[f64]) -> Vec<f64> {
    let scale = power_of_two(of);
    values.iter().map(|x| x * scale).collect()
}

fn power_of_two(values: &[f64]) -> f64 {
    let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    2f64.powi(-(largest.log2().floor() as i32).clamp(-1000, 1000))
}
