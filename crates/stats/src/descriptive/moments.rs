//! Mean, variance and standard deviation.

use serde::Serialize;
use utoipa::ToSchema;

use crate::distributions::dd::Dd;
use crate::{Result, StatsError};

/// Size, mean and spread of a sample, in the units of its values.
///
/// Two passes in double-double over values scaled by a power of two: the result is that of exact arithmetic on the
/// `f64` inputs, rounded. (One-pass and Welford's formulas lose digits on NIST's Mavro and Michelso sets.)
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Moments {
    /// How many values.
    pub n: u64,
    /// Arithmetic mean.
    pub mean: f64,
    /// Standard deviation with n − 1 in the denominator; `None` for a single value.
    pub sd: Option<f64>,
    /// The smallest value.
    pub min: f64,
    /// The largest value.
    pub max: f64,
    /// The mean's exact rest, so that mean − μ keeps its digits.
    #[serde(skip)]
    mean_rest: f64,
}

impl Moments {
    /// Of a list of finite values.
    ///
    /// # Errors
    /// [`StatsError::TooFew`] when empty, [`StatsError::InvalidElement`] for a value that is not finite.
    pub fn of(values: &[f64]) -> Result<Self> {
        Self::weighted("values", values.iter().map(|&value| (value, 1)))
    }

    /// Of a table of (value, how often): a million equal answers cost as much as one.
    ///
    /// # Errors
    /// [`StatsError::TooFew`] when all counts are 0, [`StatsError::InvalidElement`] for a value that is not finite.
    pub fn from_counts(counts: &[(f64, u64)]) -> Result<Self> {
        Self::weighted("counts", counts.iter().copied())
    }

    /// (mean − μ), correctly rounded from the exact mean.
    pub(crate) fn above(&self, mu: f64) -> f64 {
        (Dd { hi: self.mean, lo: self.mean_rest } - mu.into()).value()
    }

    /// The standard deviation when it can divide.
    ///
    /// # Errors
    /// [`StatsError::TooFew`] for one value, [`StatsError::ZeroVariance`] when all are the same,
    /// [`StatsError::Invalid`] when it overflows.
    pub(crate) fn spread(&self, name: &'static str, undefined: &'static str) -> Result<f64> {
        match self.sd {
            None => Err(StatsError::TooFew { name, len: self.n, needed: 2 }),
            Some(sd) if sd.is_infinite() => Err(StatsError::Invalid {
                name: "sd",
                value: sd,
                rule: "must not overflow: scale the values down",
            }),
            Some(0.0) => Err(StatsError::ZeroVariance { name, len: self.n, value: self.min, undefined }),
            Some(sd) => Ok(sd),
        }
    }

    fn weighted(name: &'static str, pairs: impl Iterator<Item = (f64, u64)> + Clone) -> Result<Self> {
        let (mut n, mut min, mut max) = (0_u64, f64::INFINITY, f64::NEG_INFINITY);
        for (index, (value, count)) in pairs.clone().enumerate() {
            if !value.is_finite() {
                return Err(StatsError::InvalidElement { name, index, value, rule: "must be finite" });
            }
            if count > 0 {
                n = n.checked_add(count).filter(|&n| n <= 1 << 53).ok_or(StatsError::Invalid {
                    name: "n",
                    value: n as f64 + count as f64,
                    rule: "must be at most 2^53",
                })?;
                min = min.min(value);
                max = max.max(value);
            }
        }
        if n == 0 {
            return Err(StatsError::TooFew { name, len: 0, needed: 1 });
        }
        if min == max {
            return Ok(Self { n, mean: min, sd: (n > 1).then_some(0.0), min, max, mean_rest: 0.0 });
        }
        // The largest magnitude becomes about 1: no square over- or underflows.
        let exponent = (min.abs().max(max.abs()).log2().floor() as i32).clamp(-1000, 1000);
        let (down, up) = (2f64.powi(-exponent), 2f64.powi(exponent));
        let pairs = pairs.filter(|&(_, count)| count > 0);
        let sum = |f: &dyn Fn(f64) -> Dd| {
            pairs
                .clone()
                .fold(Dd::from(0.0), |sum, (value, count)| sum + f(value * down) * (count as f64).into())
        };
        let mean = sum(&|x| x.into()) / (n as f64).into();
        let squares = sum(&|x| {
            let d = Dd::from(x) - mean;
            d * d
        });
        let variance = squares / ((n - 1) as f64).into();
        let mean = Dd { hi: mean.hi * up, lo: mean.lo * up };
        Ok(Self { n, mean: mean.hi, sd: Some(variance.value().sqrt() * up), min, max, mean_rest: mean.lo })
    }
}
