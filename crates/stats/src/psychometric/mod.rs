//! Psychometric functions: how the proportion of correct answers grows with the stimulus.
//!
//! ψ(x) = γ + (1 − λ − γ) F(x), with the guess rate γ fixed by the task, the lapse rate λ estimated, and F one of three [`Sigmoid`]s given by its
//! *threshold* (where F = ½) and *width* (from F = .05 to F = .95), as in psignifit 4. [`fit`](fn@fit) maximises the likelihood,
//! [`profile_intervals`] reads its intervals off it, [`posterior`](fn@posterior) integrates a grid with psignifit's priors, [`goodness_of_fit`] asks whether
//! the curve holds the data at all, and [`Belief`] is the running posterior behind adaptive procedures.

mod belief;
mod fit;
mod goodness;
mod likelihood;
mod observers;
mod posterior;
mod priors;
mod profile;
mod sigmoid;
#[cfg(test)]
mod tests;

pub use belief::{Belief, BeliefGrid, Estimate};
pub use fit::{Curve, Fit, fit};
pub use goodness::{GoodnessOfFit, goodness_of_fit};
pub use observers::{ResampledThreshold, resampled_threshold};
pub use posterior::{ParameterPosterior, Posterior, ThresholdPosterior, posterior};
pub use profile::{ProfileInterval, ProfileIntervals, profile_intervals};
pub use sigmoid::{Scaling, Sigmoid};

use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The answers at one stimulus level.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Level {
    /// The stimulus, in any unit in which the proportion of correct answers rises with x (negate one that falls; take log10 of an intensity
    /// for [`Sigmoid::Weibull`]).
    pub x: f64,
    /// Correct answers, ≤ `trials`.
    pub correct: u64,
    /// Answers, ≤ 1,000,000.
    pub trials: u64,
}

/// What is known of the lapse rate λ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Lapse {
    /// Estimated with the prior Beta(1, 10): mean .09, density falling from 0.
    #[default]
    Prior,
    /// Known, in [0, 1 − guess).
    Fixed(f64),
}

/// The task and the curve that is fitted to it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Task {
    /// The curve.
    pub sigmoid: Sigmoid,
    /// Guess rate γ: 1/m with m alternatives, 0 for a yes–no task without false alarms. In [0, 1).
    pub guess: f64,
    /// Lapse rate λ.
    pub lapse: Lapse,
    /// Whether answers may scatter more than the binomial: η ∈ [0, 1) is estimated, where η² is the correlation of two answers at a level
    /// (beta-binomial), with the prior Beta(1, 10) on η.
    pub overdispersion: bool,
}

impl Default for Task {
    /// Two alternatives, Gaussian, lapses with their prior, no overdispersion.
    fn default() -> Self {
        Self { sigmoid: Sigmoid::Gaussian, guess: 0.5, lapse: Lapse::Prior, overdispersion: false }
    }
}

impl Task {
    fn check(&self) -> Result<()> {
        let guess = StatsError::probability("guess", self.guess)?;
        if guess >= 1.0 {
            return Err(StatsError::Invalid { name: "guess", value: guess, rule: "must lie in [0, 1)" });
        }
        if let Lapse::Fixed(lapse) = self.lapse {
            StatsError::probability("lapse", lapse)?;
            if lapse + guess >= 1.0 {
                let rule = "must leave the curve room: guess + lapse < 1";
                return Err(StatsError::Invalid { name: "lapse", value: lapse, rule });
            }
        }
        Ok(())
    }

    /// The range of λ.
    fn lapse_bounds(&self) -> (f64, f64) {
        match self.lapse {
            Lapse::Prior => (0.0, 0.5f64.min(1.0 - self.guess)),
            Lapse::Fixed(lapse) => (lapse, lapse),
        }
    }
}

/// The levels that have trials, equal ones merged, in rising order, with the range of x and the smallest step. Checked.
struct Levels {
    levels: Vec<Level>,
    low: f64,
    high: f64,
    step: f64,
}

impl Levels {
    fn new(given: &[Level]) -> Result<Self> {
        for (index, level) in given.iter().enumerate() {
            if !level.x.is_finite() {
                let rule = "must be finite";
                return Err(StatsError::InvalidElement { name: "levels.x", index, value: level.x, rule });
            }
            if level.correct > level.trials || level.trials > 1_000_000 {
                let (value, rule) = (level.correct as f64, "must not exceed trials, nor these a million");
                return Err(StatsError::InvalidElement { name: "levels.correct", index, value, rule });
            }
        }
        let mut levels: Vec<Level> = given.iter().copied().filter(|l| l.trials > 0).collect();
        levels.sort_by(|a, b| a.x.total_cmp(&b.x));
        levels.dedup_by(|next, kept| {
            let same = next.x == kept.x;
            if same {
                kept.correct += next.correct;
                kept.trials += next.trials;
            }
            same
        });
        if levels.len() < 2 {
            return Err(StatsError::TooFew { name: "distinct levels", len: levels.len() as u64, needed: 2 });
        }
        let (low, high) = (levels[0].x, levels[levels.len() - 1].x);
        let step = levels.windows(2).map(|w| w[1].x - w[0].x).fold(f64::INFINITY, f64::min);
        if !(high - low).is_finite() || step < 1e-12 * (high - low) {
            let rule = "must not differ by less than 1e-12 of their range";
            return Err(StatsError::Invalid { name: "levels.x", value: step, rule });
        }
        Ok(Self { levels, low, high, step })
    }

    fn spread(&self) -> f64 {
        self.high - self.low
    }
}
