//! Up-down staircases: Levitt's transformed and Kaernbach's weighted ones.

use super::Procedure;
use kelir_stats::psychometric::{Level, Posterior, Task, posterior};
use kelir_stats::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// What a staircase does with the answers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Track {
    /// Harder after `down` correct answers in a row, easier after each wrong one: converges where P(correct) = .5^(1/down) (Levitt 1971):
    /// .5, .707, .794, .841 for 1, 2, 3, 4.
    Transformed {
        /// Correct answers in a row for one step down, 1 to 10.
        down: u32,
    },
    /// Harder by a step after each correct answer, easier by step × p/(1 − p) after each wrong one: converges where P(correct) = p, any p
    /// (Kaernbach 1991).
    Weighted {
        /// The proportion to track, in (0, 1).
        target: f64,
    },
}

/// A staircase before its first trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct StaircaseRule {
    /// Which answers move it.
    pub track: Track,
    /// The first stimulus.
    pub start: f64,
    /// Step sizes, each used until the next reversal and the last one from then on. Above 0, in the stimulus's unit.
    pub steps: Vec<f64>,
    /// The hardest stimulus there is.
    pub lowest: f64,
    /// The easiest.
    pub highest: f64,
    /// Ends after so many reversals …
    pub reversals: u32,
    /// … and in any case after so many trials.
    pub trials: u32,
}

/// A running staircase.
#[derive(Clone, Debug, PartialEq)]
pub struct Staircase {
    rule: StaircaseRule,
    stimulus: f64,
    in_a_row: u32,
    last_move: Option<Move>,
    /// What was shown and whether the answer was correct.
    answers: Vec<(f64, bool)>,
    reversals: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Move {
    Easier,
    Harder,
}

/// Where a staircase ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Bracket {
    /// The mean of the stimuli at the reversals counted; off by up to half a step.
    pub threshold: f64,
    /// Their standard deviation over √(n/2). Reversals come in pairs that depend on each other, so this is a rough guide:
    /// [`Staircase::posterior`] has the interval.
    pub standard_error: f64,
    /// Reversals counted: those at the last step size, an even number of them.
    pub reversals: u32,
}

impl Track {
    /// The proportion of correct answers at which it settles.
    pub fn converges_at(self) -> f64 {
        match self {
            Self::Transformed { down } => 0.5f64.powf(1.0 / f64::from(down)),
            Self::Weighted { target } => target,
        }
    }

    /// The step up over the step down that a reversal-free balance needs.
    fn up_over_down(self) -> f64 {
        match self {
            Self::Transformed { .. } => 1.0,
            Self::Weighted { target } => target / (1.0 - target),
        }
    }
}

impl Staircase {
    /// A staircase at its start. Errors name the key: `down`, `target`, `steps`, `start`, `lowest`, `highest`, `reversals`, `trials`.
    pub fn new(rule: StaircaseRule) -> Result<Self> {
        let invalid = |name, value, rule| Err(StatsError::Invalid { name, value, rule });
        match rule.track {
            Track::Transformed { down } if !(1..=10).contains(&down) => {
                return invalid("down", f64::from(down), "must lie in 1..=10");
            }
            Track::Weighted { target } if !(target > 0.0 && target < 1.0) => {
                return invalid("target", target, "must lie strictly between 0 and 1");
            }
            _ => {}
        }
        if rule.steps.is_empty() {
            return Err(StatsError::TooFew { name: "steps", len: 0, needed: 1 });
        }
        for (index, &value) in rule.steps.iter().enumerate() {
            if !(value.is_finite() && value > 0.0) {
                let rule = "must be finite and above 0";
                return Err(StatsError::InvalidElement { name: "steps", index, value, rule });
            }
        }
        if !(rule.lowest.is_finite() && rule.highest.is_finite() && rule.lowest < rule.highest) {
            return invalid("lowest", rule.lowest, "must be finite and below highest");
        }
        if !(rule.lowest..=rule.highest).contains(&rule.start) {
            return invalid("start", rule.start, "must lie between lowest and highest");
        }
        if rule.reversals == 0 {
            return invalid("reversals", 0.0, "must be at least 1");
        }
        if rule.trials == 0 {
            return invalid("trials", 0.0, "must be at least 1");
        }
        let stimulus = rule.start;
        Ok(Self { rule, stimulus, in_a_row: 0, last_move: None, answers: Vec::new(), reversals: Vec::new() })
    }

    /// The stimuli at which it turned, in order.
    pub fn reversals(&self) -> &[f64] {
        &self.reversals
    }

    /// Trials answered.
    pub fn trials(&self) -> u32 {
        self.answers.len() as u32
    }

    /// The answers by stimulus, rising; stimuli that differ by rounding alone are one.
    pub fn levels(&self) -> Vec<Level> {
        let mut answers = self.answers.clone();
        answers.sort_by(|a, b| a.0.total_cmp(&b.0));
        let rounding = 1e-9 * self.rule.steps.iter().copied().fold(f64::INFINITY, f64::min);
        let mut levels: Vec<Level> = Vec::new();
        for (x, correct) in answers {
            match levels.last_mut() {
                Some(last) if x - last.x <= rounding => {
                    last.trials += 1;
                    last.correct += u64::from(correct);
                }
                _ => levels.push(Level { x, correct: u64::from(correct), trials: 1 }),
            }
        }
        levels
    }

    /// The psychometric function through all answers with posterior intervals of probability `level` (psignifit's priors): the staircase
    /// then only chose the stimuli. Profile-likelihood intervals are too short here: few stimuli lie far from the threshold.
    ///
    /// Errors: those of [`posterior`], such as fewer than two different stimuli so far.
    pub fn posterior(&self, task: &Task, level: f64) -> Result<Posterior> {
        posterior(&self.levels(), task, level, &[])
    }

    /// The stimulus where P(correct) is [`Track::converges_at`], from the reversals at the last step size; `None` before two of them.
    pub fn estimate(&self) -> Option<Bracket> {
        // The step shrinks at each of the first len − 1 reversals; these still belong to the coarse walk.
        let settled = self.reversals.get(self.rule.steps.len() - 1..).unwrap_or(&[]);
        let counted = &settled[settled.len() % 2..];
        if counted.len() < 2 {
            return None;
        }
        let n = counted.len() as f64;
        let threshold = counted.iter().sum::<f64>() / n;
        let variance = counted.iter().map(|x| (x - threshold).powi(2)).sum::<f64>() / (n - 1.0);
        Some(Bracket {
            threshold,
            standard_error: (variance / (n / 2.0)).sqrt(),
            reversals: counted.len() as u32,
        })
    }

    fn step(&mut self, direction: Move) {
        if self.last_move.is_some_and(|last| last != direction) {
            self.reversals.push(self.stimulus);
        }
        self.last_move = Some(direction);
        let size = self.rule.steps[self.reversals.len().min(self.rule.steps.len() - 1)];
        let change = match direction {
            Move::Easier => size * self.rule.track.up_over_down(),
            Move::Harder => -size,
        };
        self.stimulus = (self.stimulus + change).clamp(self.rule.lowest, self.rule.highest);
    }
}

impl Procedure for Staircase {
    fn stimulus(&self) -> Option<f64> {
        let ended = self.reversals.len() >= self.rule.reversals as usize || self.trials() >= self.rule.trials;
        (!ended).then_some(self.stimulus)
    }

    fn answer(&mut self, correct: bool) {
        if self.stimulus().is_none() {
            return;
        }
        self.answers.push((self.stimulus, correct));
        let needed = match self.rule.track {
            Track::Transformed { down } => down,
            Track::Weighted { .. } => 1,
        };
        if !correct {
            self.in_a_row = 0;
            self.step(Move::Easier);
        } else {
            self.in_a_row += 1;
            if self.in_a_row >= needed {
                self.in_a_row = 0;
                self.step(Move::Harder);
            }
        }
    }
}
