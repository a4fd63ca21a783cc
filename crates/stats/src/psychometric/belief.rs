//! The running posterior of an adaptive procedure: a table of answer probabilities, multiplied in trial by trial.

use super::{Curve, Sigmoid};
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// What is thought possible before the first trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct BeliefGrid {
    /// The curve.
    pub sigmoid: Sigmoid,
    /// Guess rate of the task.
    pub guess: f64,
    /// The stimuli that can be shown.
    pub stimuli: Vec<f64>,
    /// Thresholds (F = ½, unscaled), rising; each as likely.
    pub thresholds: Vec<f64>,
    /// Widths (F = .05 to .95), rising; each as likely.
    pub widths: Vec<f64>,
    /// Lapse rates, rising; likely as Beta(1, 10).
    pub lapses: Vec<f64>,
}

/// The posterior over a grid of curves, updated by each answer.
#[derive(Clone, Debug)]
pub struct Belief {
    grid: BeliefGrid,
    /// Posterior mass, widths innermost, then thresholds, then lapses.
    pub(super) mass: Vec<f64>,
    /// P(correct), a row of `mass.len()` for each stimulus.
    pub(super) correct: Vec<f64>,
    /// Entropy of that answer in nats, likewise.
    entropy: Vec<f64>,
}

/// A parameter's marginal posterior in five numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Estimate {
    /// Posterior mean.
    pub mean: f64,
    /// Posterior standard deviation.
    pub standard_deviation: f64,
    /// Posterior median.
    pub median: f64,
    /// Lower end of the equal-tailed credible interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// The largest table: stimuli × curves.
const LARGEST: usize = 1 << 25;

impl Belief {
    /// The belief before any answer. Errors: an empty or unordered axis, a value out of range, guess + lapse ≥ 1, more than 2²⁵ cells.
    pub fn new(grid: BeliefGrid) -> Result<Self> {
        StatsError::probability("guess", grid.guess)?;
        let axes: [(&'static str, &[f64], f64, f64); 4] = [
            ("stimuli", &grid.stimuli, f64::MIN, f64::MAX),
            ("thresholds", &grid.thresholds, f64::MIN, f64::MAX),
            ("widths", &grid.widths, f64::MIN_POSITIVE, f64::MAX),
            ("lapses", &grid.lapses, 0.0, 1.0 - grid.guess - 1e-9),
        ];
        for (name, axis, low, high) in axes {
            if axis.is_empty() {
                return Err(StatsError::TooFew { name, len: 0, needed: 1 });
            }
            for (index, &value) in axis.iter().enumerate() {
                let rising = index == 0 || axis[index - 1] < value;
                if !(low..=high).contains(&value) || !rising {
                    let rule = "must rise strictly within the parameter's range";
                    return Err(StatsError::InvalidElement { name, index, value, rule });
                }
            }
        }
        let curves =
            grid.thresholds.len().saturating_mul(grid.widths.len()).saturating_mul(grid.lapses.len());
        let cells = curves.saturating_mul(grid.stimuli.len());
        if cells > LARGEST {
            let rule = "stimuli × thresholds × widths × lapses must not exceed 2^25";
            return Err(StatsError::Invalid { name: "grid", value: cells as f64, rule });
        }
        let mut mass = Vec::with_capacity(curves);
        for &lapse in &grid.lapses {
            mass.extend(std::iter::repeat_n(
                (1.0 - lapse).powi(9),
                grid.thresholds.len() * grid.widths.len(),
            ));
        }
        let (mut correct, mut entropy) = (Vec::with_capacity(cells), Vec::with_capacity(cells));
        for &x in &grid.stimuli {
            for &lapse in &grid.lapses {
                for &threshold in &grid.thresholds {
                    for &width in &grid.widths {
                        let f = grid.sigmoid.value(x, threshold, width);
                        let p = grid.guess + (1.0 - lapse - grid.guess) * f;
                        correct.push(p);
                        entropy.push(binary_entropy(p));
                    }
                }
            }
        }
        let mut belief = Self { grid, mass, correct, entropy };
        belief.normalise();
        Ok(belief)
    }

    /// The grid it was made from.
    pub fn grid(&self) -> &BeliefGrid {
        &self.grid
    }

    /// The index of the stimulus whose answer is expected to tell most about the curve (QUEST+, Watson 2017): the greatest mutual information
    /// H(answer) − E[H(answer | curve)], which is the expected fall of the posterior's entropy. The first of equals.
    pub fn most_informative(&self) -> usize {
        let n = self.mass.len();
        let mut best = (0, f64::NEG_INFINITY);
        for (index, (p, h)) in self.correct.chunks_exact(n).zip(self.entropy.chunks_exact(n)).enumerate() {
            let information = binary_entropy(dot(&self.mass, p)) - dot(&self.mass, h);
            if information > best.1 {
                best = (index, information);
            }
        }
        best.0
    }

    /// Takes in one answer to the stimulus of this index. Errors: an index out of range; an answer that no curve of the grid can give
    /// (a wrong one where all have ψ = 1), after which the belief is as it was.
    pub fn update(&mut self, stimulus: usize, correct: bool) -> Result<()> {
        if stimulus >= self.grid.stimuli.len() {
            let rule = "must be the index of a stimulus";
            return Err(StatsError::Invalid { name: "stimulus", value: stimulus as f64, rule });
        }
        let n = self.mass.len();
        let row = &self.correct[stimulus * n..(stimulus + 1) * n];
        let chance = dot(&self.mass, row);
        let likelihood = if correct { chance } else { 1.0 - chance };
        if likelihood <= 0.0 {
            return Err(StatsError::NoSolution {
                what: "the posterior",
                reason: "no curve of the grid can give this answer",
            });
        }
        for (m, p) in self.mass.iter_mut().zip(row) {
            *m *= if correct { *p } else { 1.0 - p };
        }
        self.normalise();
        Ok(())
    }

    fn normalise(&mut self) {
        let total: f64 = self.mass.iter().sum();
        self.mass.iter_mut().for_each(|m| *m /= total);
    }

    /// The threshold's marginal posterior with an equal-tailed interval. Errors: a level outside (0, 1).
    pub fn threshold(&self, level: f64) -> Result<Estimate> {
        let widths = self.grid.widths.len();
        self.marginal(&self.grid.thresholds, level, |i| i / widths)
    }

    /// The width's, likewise.
    pub fn width(&self, level: f64) -> Result<Estimate> {
        self.marginal(&self.grid.widths, level, |i| i)
    }

    /// The lapse rate's, likewise.
    pub fn lapse(&self, level: f64) -> Result<Estimate> {
        let plane = self.grid.widths.len() * self.grid.thresholds.len();
        self.marginal(&self.grid.lapses, level, |i| i / plane)
    }

    /// The curve of the posterior means.
    pub fn mean_curve(&self) -> Curve {
        let mean = |e: Result<Estimate>| e.map_or(f64::NAN, |e| e.mean);
        Curve {
            sigmoid: self.grid.sigmoid,
            guess: self.grid.guess,
            threshold: mean(self.threshold(0.5)),
            width: mean(self.width(0.5)),
            lapse: mean(self.lapse(0.5)),
            eta: 0.0,
        }
    }

    fn marginal(&self, axis: &[f64], level: f64, index: impl Fn(usize) -> usize) -> Result<Estimate> {
        StatsError::open_probability("level", level)?;
        let mut mass = vec![0.0; axis.len()];
        for (i, m) in self.mass.iter().enumerate() {
            mass[index(i) % axis.len()] += m;
        }
        let mean: f64 = dot(&mass, axis);
        let variance: f64 = mass.iter().zip(axis).map(|(m, x)| m * (x - mean).powi(2)).sum();
        let quantile = |q: f64| {
            // Each value stands for the stretch halfway to its neighbours, so that an interval isn't rounded to the grid.
            let mut below = 0.0;
            for (i, m) in mass.iter().enumerate() {
                if below + m >= q || i + 1 == axis.len() {
                    let left = if i > 0 { 0.5 * (axis[i - 1] + axis[i]) } else { axis[i] };
                    let right = axis.get(i + 1).map_or(axis[i], |next| 0.5 * (axis[i] + next));
                    let share = if *m > 0.0 { ((q - below) / m).clamp(0.0, 1.0) } else { 0.5 };
                    return left + share * (right - left);
                }
                below += m;
            }
            axis[0]
        };
        let tail = (1.0 - level) / 2.0;
        Ok(Estimate {
            mean,
            standard_deviation: variance.max(0.0).sqrt(),
            median: quantile(0.5),
            low: quantile(tail),
            high: quantile(1.0 - tail),
        })
    }
}

/// Sums in eight lanes, so that the compiler may use vectors without being allowed to reorder a single sum.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a8, b8) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a8.remainder().iter().zip(b8.remainder()).map(|(x, y)| x * y).sum();
    let mut lanes = [0.0; 8];
    for (x, y) in a8.zip(b8) {
        for k in 0..8 {
            lanes[k] += x[k] * y[k];
        }
    }
    lanes.iter().sum::<f64>() + rest
}

/// −p ln p − (1 − p) ln(1 − p).
fn binary_entropy(p: f64) -> f64 {
    let part = |p: f64| if p > 0.0 { -p * p.ln() } else { 0.0 };
    part(p) + part(1.0 - p)
}
