//! QUEST+: the stimulus that is expected to tell most (Watson 2017, Journal of Vision 17(3):10).

use super::Procedure;
use kelir_stats::psychometric::{Belief, BeliefGrid, Curve, Estimate};
use kelir_stats::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A QUEST+ procedure before its first trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct QuestPlusRule {
    /// What can be shown and what is thought possible. Thresholds should reach past where any observer's is, or the interval is cut there.
    pub grid: BeliefGrid,
    /// Ends after so many trials …
    pub trials: u32,
    /// … or once the threshold's posterior standard deviation is below this, in the stimulus's unit.
    #[serde(default)]
    pub precise_enough: Option<f64>,
}

/// A running QUEST+ procedure.
#[derive(Clone, Debug)]
pub struct QuestPlus {
    rule_trials: u32,
    precise_enough: f64,
    belief: Belief,
    /// The stimulus to show now, by index.
    next: usize,
    trials: u32,
    contradicted: bool,
}

impl QuestPlus {
    /// A procedure at its start. Errors name the key: those of [`Belief::new`], `trials`, `precise_enough`.
    pub fn new(rule: QuestPlusRule) -> Result<Self> {
        if rule.trials == 0 {
            return Err(StatsError::Invalid { name: "trials", value: 0.0, rule: "must be at least 1" });
        }
        let precise_enough = rule.precise_enough.unwrap_or(0.0);
        if !(precise_enough.is_finite() && precise_enough >= 0.0) {
            let rule = "must be finite and not below 0";
            return Err(StatsError::Invalid { name: "precise_enough", value: precise_enough, rule });
        }
        let belief = Belief::new(rule.grid)?;
        let next = belief.most_informative();
        Ok(Self { rule_trials: rule.trials, precise_enough, belief, next, trials: 0, contradicted: false })
    }

    /// Trials answered.
    pub fn trials(&self) -> u32 {
        self.trials
    }

    /// The threshold (F = ½, unscaled) with its equal-tailed credible interval. Errors: a level outside (0, 1).
    pub fn threshold(&self, level: f64) -> Result<Estimate> {
        self.belief.threshold(level)
    }

    /// The width, likewise.
    pub fn width(&self, level: f64) -> Result<Estimate> {
        self.belief.width(level)
    }

    /// The lapse rate, likewise.
    pub fn lapse(&self, level: f64) -> Result<Estimate> {
        self.belief.lapse(level)
    }

    /// The curve of the posterior means.
    pub fn curve(&self) -> Curve {
        self.belief.mean_curve()
    }

    /// Whether an answer came that no curve of the grid can give; it was left out.
    pub fn contradicted(&self) -> bool {
        self.contradicted
    }

    fn ended(&self) -> bool {
        self.trials >= self.rule_trials
            || (self.precise_enough > 0.0
                && self.trials > 0
                && self.belief.threshold(0.95).is_ok_and(|e| e.standard_deviation < self.precise_enough))
    }
}

impl Procedure for QuestPlus {
    fn stimulus(&self) -> Option<f64> {
        (!self.ended()).then(|| self.belief.grid().stimuli[self.next])
    }

    fn answer(&mut self, correct: bool) {
        if self.ended() {
            return;
        }
        self.trials += 1;
        // Only a grid without lapses and without guesses can be contradicted.
        self.contradicted |= self.belief.update(self.next, correct).is_err();
        self.next = self.belief.most_informative();
    }
}
