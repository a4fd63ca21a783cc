//! How often a preference is found.

use super::{Rate, at_least, check_runs};
use crate::inference::t_test_from_counts;
use crate::normal;
use crate::random::Random;
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A survey in which each participant chooses one of two in some pairs, as in the paper.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct PreferenceDesign {
    /// Participants analysed.
    pub participants: u64,
    /// Pairs each of them judges.
    pub pairs: u64,
    /// True probability of choosing the target, over participants.
    pub preference: f64,
    /// True intraclass correlation of a participant's choices (the paper's blocks: .09 and .17).
    #[serde(default)]
    pub icc: f64,
    /// Share of trials answered by a coin.
    #[serde(default)]
    pub lapse: f64,
    /// Level of the test.
    #[serde(default = "five_percent")]
    pub alpha: f64,
}

fn five_percent() -> f64 {
    0.05
}

/// How often the design finds a preference; with `preference` = ½ these are the tests' false alarms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct PreferencePower {
    /// By the t-test over participants' counts (the paper's), which takes a study where all counts are alike and not at chance as found.
    pub t_test: Rate,
    /// By the normal test over trials as if these were independent: what not to do.
    pub per_trial: Rate,
}

impl PreferenceDesign {
    fn check(&self) -> Result<()> {
        at_least("participants", self.participants, 2)?;
        at_least("pairs", self.pairs, 1)?;
        for (name, value) in [("preference", self.preference), ("icc", self.icc), ("lapse", self.lapse)] {
            StatsError::probability(name, value)?;
        }
        StatsError::open_probability("alpha", self.alpha)?;
        let trials = self.participants.saturating_mul(self.pairs);
        if trials > 100_000_000 {
            let rule = "participants × pairs must not exceed 10^8";
            return Err(StatsError::Invalid { name: "pairs", value: self.pairs as f64, rule });
        }
        Ok(())
    }

    /// `counts[k]` participants chose the target k times. Participants come one after the other, so that a larger study is the smaller one and more.
    fn counts(&self, random: &mut Random) -> Vec<u64> {
        let mut counts = vec![0; self.pairs as usize + 1];
        for _ in 0..self.participants {
            let p = random.beta(self.preference, self.icc);
            let p = (1.0 - self.lapse) * p + 0.5 * self.lapse;
            counts[random.binomial(self.pairs, p) as usize] += 1;
        }
        counts
    }

    fn outcome(&self, run: u64, seed: u64) -> (bool, bool) {
        let counts = self.counts(&mut Random::stream(seed, run));
        let table: Vec<(f64, u64)> = (0..).map(f64::from).zip(counts.iter().copied()).collect();
        let chance = 0.5 * self.pairs as f64;
        let found = match t_test_from_counts(&table, chance) {
            Ok(test) => test.p < self.alpha,
            // All counts alike: no variance, and a difference from chance is beyond doubt.
            Err(_) => counts.iter().zip(0u64..).any(|(&n, k)| n > 0 && k as f64 != chance),
        };
        let trials = self.participants as f64 * self.pairs as f64;
        let hits: f64 = table.iter().map(|(k, n)| k * *n as f64).sum();
        let z = (hits - 0.5 * trials).abs() / (0.25 * trials).sqrt();
        (found, 2.0 * normal::cdf(-z) < self.alpha)
    }
}

/// Simulates `runs` studies and tests each. Errors: a design outside its ranges; no runs.
pub fn preference_power(design: &PreferenceDesign, runs: u64, seed: u64) -> Result<PreferencePower> {
    design.check()?;
    check_runs(runs)?;
    let outcomes: Vec<(bool, bool)> = (0..runs).map(|run| design.outcome(run, seed)).collect();
    Ok(PreferencePower {
        t_test: Rate::of(outcomes.iter().map(|o| Some(o.0))),
        per_trial: Rate::of(outcomes.iter().map(|o| Some(o.1))),
    })
}

/// The fewest participants with which the t-test's simulated power reaches `power`, up to `most`; `None` if even these don't.
///
/// `design.participants` is ignored. Searched by bisection on the same simulated people, so exact to the simulation's noise.
/// Errors: as [`preference_power`]; a power outside (0, 1).
pub fn participants_needed(
    design: &PreferenceDesign,
    power: f64,
    most: u64,
    runs: u64,
    seed: u64,
) -> Result<Option<u64>> {
    StatsError::open_probability("power", power)?;
    let reaches = |participants| -> Result<bool> {
        Ok(preference_power(&PreferenceDesign { participants, ..*design }, runs, seed)?.t_test.rate >= power)
    };
    let (mut low, mut high) = (2, 4);
    while !reaches(high.min(most.max(2)))? {
        if high >= most {
            return Ok(None);
        }
        low = high;
        high *= 2;
    }
    high = high.min(most.max(2));
    while low + 1 < high {
        let middle = low + (high - low) / 2;
        if reaches(middle)? { high = middle } else { low = middle }
    }
    Ok(Some(if reaches(low)? { low } else { high }))
}
