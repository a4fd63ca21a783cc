//! Sensitivity in forced choice.

use serde::Serialize;
use utoipa::ToSchema;

use super::{Interval, check_successes, clopper_pearson};
use crate::distributions::normal;
use crate::{Result, StatsError};

/// What to do when all (or none) of the answers are correct, so that d′ would be infinite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ExtremeRates {
    /// Refuse them.
    Refuse,
    /// (correct + ½) / (n + 1), for every rate (log-linear; Hautus 1995).
    LogLinear,
    /// 0 becomes 1/(2n) and n becomes 1 − 1/(2n) (Macmillan & Kaplan 1985).
    HalfTrial,
}

/// Sensitivity of an observer in two-alternative forced choice.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Dprime {
    /// √2 Φ⁻¹(proportion correct), in standard deviations of the internal noise; negative below chance.
    pub dprime: f64,
    /// The proportion that was used, after the correction.
    pub proportion: f64,
    /// Standard error by the delta method.
    pub se: f64,
    /// The exact (Clopper–Pearson) interval of the uncorrected proportion, transformed; may end at ±∞.
    pub interval: Interval,
}

/// d′ of an unbiased observer in 2AFC (Green & Swets 1966; Macmillan & Creelman 2005, eq. 7.2).
///
/// # Errors
/// [`StatsError::TooFew`] without a trial; [`StatsError::Invalid`] for more correct than trials or a level outside
/// (0, 1); [`StatsError::NoSolution`] for an extreme rate with [`ExtremeRates::Refuse`].
pub fn dprime_2afc(correct: u64, n: u64, extremes: ExtremeRates, level: f64) -> Result<Dprime> {
    check_successes(correct, n)?;
    let (x, trials) = (correct as f64, n as f64);
    let extreme = correct == 0 || correct == n;
    let proportion = match extremes {
        ExtremeRates::LogLinear => (x + 0.5) / (trials + 1.0),
        ExtremeRates::HalfTrial if extreme => (x - 0.5).abs() / trials,
        ExtremeRates::Refuse if extreme => {
            return Err(StatsError::NoSolution { what: "d′", reason: "all answers or none are correct" });
        }
        _ => x / trials,
    };
    let z = normal::inverse(proportion);
    let root_2 = std::f64::consts::SQRT_2;
    let se = root_2 * (proportion * (1.0 - proportion) / trials).sqrt() / normal::density(z);
    let rates = clopper_pearson(correct, n, level)?;
    let interval = Interval {
        low: root_2 * normal::inverse(rates.low),
        high: root_2 * normal::inverse(rates.high),
        level,
    };
    Ok(Dprime { dprime: root_2 * z, proportion, se, interval })
}
