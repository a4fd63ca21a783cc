//! Scaling of pairwise comparisons: from "which of the two?" to positions on one axis, in JOD.
//!
//! One JOD ("just objectionable difference") between two conditions means that 75% of choices go to the better one (Perez-Ortiz & Mantiuk 2017).
//! Thurstone's Case V puts a cumulative Gaussian between difference and proportion, Bradley–Terry a logistic; both are fitted by maximum
//! likelihood to any connected design, complete or not. [`scale`](fn@scale) fits, [`observer_intervals`] asks how far whole observers differ,
//! [`odd_observers`] and [`circular_triads`] look at single ones.

mod flips;
mod graph;
mod intervals;
mod model;
mod observers;
mod scale;
#[cfg(test)]
mod tests;
mod triads;

pub use intervals::{ConditionInterval, DifferenceInterval, ScaleIntervals, observer_intervals};
pub use model::Model;
pub use observers::{ObserverFit, odd_observers};
pub use scale::{Estimator, Origin, Scale, ScaleOptions, scale};
pub use triads::{CircularTriads, circular_triads};

use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// How often each condition was chosen over each other one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct Wins {
    conditions: usize,
    /// Row-major n × n: entry (i, j) counts choices of i over j.
    counts: Vec<u64>,
}

impl Wins {
    /// No comparisons yet between `conditions` conditions.
    pub fn new(conditions: usize) -> Self {
        Self { conditions, counts: vec![0; conditions * conditions] }
    }

    /// Counts (winner, loser) choices, one step each. Errors: an index ≥ `conditions`; a condition against itself.
    pub fn tally(conditions: usize, choices: impl IntoIterator<Item = (usize, usize)>) -> Result<Self> {
        let mut wins = Self::new(conditions);
        for (winner, loser) in choices {
            wins.add(winner, loser, 1)?;
        }
        Ok(wins)
    }

    /// From a square matrix: `matrix[i][j]` choices of i over j. Errors: ragged rows; a filled diagonal.
    pub fn from_matrix(matrix: &[Vec<u64>]) -> Result<Self> {
        let mut wins = Self::new(matrix.len());
        for (i, row) in matrix.iter().enumerate() {
            if row.len() != matrix.len() {
                return Err(StatsError::LengthMismatch {
                    first: "the matrix",
                    first_len: matrix.len(),
                    second: "one of its rows",
                    second_len: row.len(),
                });
            }
            for (j, &times) in row.iter().enumerate().filter(|(_, times)| **times > 0) {
                wins.add(i, j, times)?;
            }
        }
        Ok(wins)
    }

    /// `winner` was chosen over `loser` `times` more times. Errors as in [`Wins::tally`].
    pub fn add(&mut self, winner: usize, loser: usize, times: u64) -> Result<()> {
        let n = self.conditions;
        for (name, index) in [("winner", winner), ("loser", loser)] {
            if index >= n {
                let rule = "must be the index of a condition";
                return Err(StatsError::Invalid { name, value: index as f64, rule });
            }
        }
        if winner == loser {
            let rule = "must differ from the winner";
            return Err(StatsError::Invalid { name: "loser", value: loser as f64, rule });
        }
        let count = &mut self.counts[winner * n + loser];
        // Counts stay exact in f64.
        *count = count.checked_add(times).filter(|c| *c < 1 << 53).ok_or(StatsError::Invalid {
            name: "times",
            value: times as f64,
            rule: "must keep the count of a pair below 2^53",
        })?;
        Ok(())
    }

    /// The number of conditions.
    pub fn conditions(&self) -> usize {
        self.conditions
    }

    /// Choices of i over j; 0 for an index out of range.
    pub fn count(&self, i: usize, j: usize) -> u64 {
        if i < self.conditions && j < self.conditions { self.counts[i * self.conditions + j] } else { 0 }
    }

    /// All choices.
    pub fn total(&self) -> u64 {
        self.counts.iter().fold(0, |sum, c| sum.saturating_add(*c))
    }

    /// These choices less some of them.
    fn without(&self, own: &Wins) -> Wins {
        let counts = self.counts.iter().zip(&own.counts).map(|(all, own)| all - own).collect();
        Wins { conditions: self.conditions, counts }
    }

    /// The compared pairs (i < j) with the choices of each.
    fn pairs(&self) -> Vec<Pair> {
        let n = self.conditions;
        (0..n)
            .flat_map(|i| (i + 1..n).map(move |j| (i, j)))
            .map(|(i, j)| Pair { i, j, wins: self.count(i, j) as f64, losses: self.count(j, i) as f64 })
            .filter(|p| p.wins + p.losses > 0.0)
            .collect()
    }
}

/// One pair's choices: `wins` of i over j, `losses` of j over i.
#[derive(Clone, Copy, Debug)]
struct Pair {
    i: usize,
    j: usize,
    wins: f64,
    losses: f64,
}

/// One observer's choices, in a sparse form that stays small with many conditions.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Observer {
    /// Who.
    pub id: String,
    /// What was chosen over what, how often.
    pub choices: Vec<Choice>,
}

/// A choice of one condition over another, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// The condition chosen.
    pub winner: usize,
    /// The one it was shown with.
    pub loser: usize,
    /// How often.
    pub times: u64,
}

/// The sum of the observers' choices.
pub fn pool<'a>(conditions: usize, observers: impl IntoIterator<Item = &'a Observer>) -> Result<Wins> {
    let mut wins = Wins::new(conditions);
    for choice in observers.into_iter().flat_map(|o| &o.choices) {
        wins.add(choice.winner, choice.loser, choice.times)?;
    }
    Ok(wins)
}
