//! The maximum-likelihood fit.

use super::likelihood::{PARAMETERS, add_beta_prior, log_likelihood};
use super::{Lapse, Level, Levels, Scaling, Sigmoid, Task};
use crate::linalg;
use crate::normal;
use crate::optimise::{Local, Maximum, maximise};
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A psychometric function with numbers for its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Curve {
    /// Its shape.
    pub sigmoid: Sigmoid,
    /// Where F = ½ (unscaled), in the unit of x.
    pub threshold: f64,
    /// From F = .05 to F = .95, in the unit of x.
    pub width: f64,
    /// Guess rate γ.
    pub guess: f64,
    /// Lapse rate λ.
    pub lapse: f64,
    /// Overdispersion η; 0 is binomial.
    pub eta: f64,
}

impl Curve {
    /// ψ(x), the proportion of correct answers.
    pub fn proportion(&self, x: f64) -> f64 {
        self.guess + (1.0 - self.lapse - self.guess) * self.sigmoid.value(x, self.threshold, self.width)
    }

    /// The stimulus at which the curve has the given proportion; `scaling` says of what.
    ///
    /// Errors: a proportion the curve never has: outside (0, 1) unscaled, outside (γ, 1 − λ) scaled.
    pub fn threshold_at(&self, proportion: f64, scaling: Scaling) -> Result<f64> {
        let (low, high) = match scaling {
            Scaling::Unscaled => (0.0, 1.0),
            Scaling::Scaled => (self.guess, 1.0 - self.lapse),
        };
        if !(proportion > low && proportion < high) {
            let rule = "must lie strictly between the curve's asymptotes";
            return Err(StatsError::Invalid { name: "proportion", value: proportion, rule });
        }
        let p = (proportion - low) / (high - low);
        Ok(self.sigmoid.inverse(p, self.threshold, self.width))
    }

    /// dψ/dx at x.
    pub fn slope(&self, x: f64) -> f64 {
        let (z, rise) = self.sigmoid.argument(x, self.threshold, self.width);
        (1.0 - self.lapse - self.guess) * self.sigmoid.derivatives(z)[1] * rise / self.width
    }

    pub(super) fn parameters(&self) -> [f64; PARAMETERS] {
        [self.threshold, self.width, self.lapse, self.eta]
    }

    pub(super) fn from_parameters(task: &Task, at: &[f64]) -> Self {
        Self {
            sigmoid: task.sigmoid,
            guess: task.guess,
            threshold: at[0],
            width: at[1],
            lapse: at[2],
            eta: at[3],
        }
    }
}

/// A fitted psychometric function.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Fit {
    /// The curve.
    pub curve: Curve,
    /// Asymptotic standard errors of threshold, width, lapse and η, from the curvature; `None` for a parameter that is fixed or on a bound, and
    /// for all where the likelihood is flat (answers all correct or all at chance: the threshold is then any number).
    pub standard_errors: [Option<f64>; PARAMETERS],
    /// ln likelihood of the single answers (no binomial coefficients, no priors).
    pub log_likelihood: f64,
    /// Twice the ln likelihood missed against a free proportion at each level.
    pub deviance: f64,
    /// Parameters that ended on the edge of their range ("threshold", "width", "lapse", "eta"). With threshold or width among them the
    /// levels did not show the curve: the number is the edge, not an estimate.
    pub at_bound: Vec<String>,
    /// Answers.
    pub trials: u64,
}

/// Fits ψ by maximum likelihood; λ and η with their Beta(1, 10) priors where they are estimated (so the maximum is a penalised one).
///
/// Levels without trials are left out, equal ones merged. The threshold is sought within the levels and one spread beyond, the width from
/// 1/1000 to 10 spreads, λ up to ½; all correct, all at chance and the like end on an edge, said in `at_bound`.
/// Errors: an invalid task or level; fewer than two distinct levels.
pub fn fit(levels: &[Level], task: &Task) -> Result<Fit> {
    task.check()?;
    let levels = Levels::new(levels)?;
    let bounds = ml_bounds(&levels, task);
    let best = search(&levels, task, &bounds)?;
    Ok(describe(&levels, task, &bounds, &best))
}

pub(super) fn ml_bounds(levels: &Levels, task: &Task) -> [(f64, f64); PARAMETERS] {
    let spread = levels.spread();
    [
        (levels.low - spread, levels.high + spread),
        (1e-3 * spread, 10.0 * spread),
        task.lapse_bounds(),
        if task.overdispersion { (0.0, 0.999) } else { (0.0, 0.0) },
    ]
}

/// ln likelihood plus the ln priors of λ and η.
pub(super) fn penalised(levels: &[Level], task: &Task, at: &[f64]) -> Local {
    let mut sum = log_likelihood(levels, task, at);
    if task.lapse == Lapse::Prior {
        add_beta_prior(&mut sum, 2, at[2]);
    }
    if task.overdispersion {
        add_beta_prior(&mut sum, 3, at[3]);
    }
    sum
}

/// Thresholds, widths and lapse rates of the coarse grid from which maxima are climbed.
pub(super) const STARTS: [usize; 3] = [13, 5, 3];

/// The grid's points within `bounds`, lapse rates innermost.
pub(super) fn starts(levels: &Levels, bounds: &[(f64, f64)], eta: f64) -> Vec<Vec<f64>> {
    let spread = levels.spread();
    let mut starts = Vec::new();
    for i in 0..STARTS[0] {
        let threshold = levels.low + spread * (i as f64 / 8.0 - 0.25);
        for width in [0.02, 0.1, 0.3, 0.8, 2.0] {
            for lapse in [0.01, 0.06, 0.2] {
                let at = [threshold, width * spread, lapse, eta];
                starts.push(at.iter().zip(bounds).map(|(x, b)| x.clamp(b.0, b.1)).collect());
            }
        }
    }
    starts
}

/// Newton from the best few points of a coarse grid: the likelihood of a lapsing observer can have two hills.
pub(super) fn search(levels: &Levels, task: &Task, bounds: &[(f64, f64)]) -> Result<Maximum> {
    let etas: &[f64] = if task.overdispersion { &[0.0, 0.15] } else { &[0.0] };
    let grid = etas.iter().flat_map(|&eta| starts(levels, bounds, eta));
    let mut starts: Vec<(f64, Vec<f64>)> =
        grid.map(|at| (penalised(&levels.levels, task, &at).value, at)).collect();
    starts.sort_by(|a, b| b.0.total_cmp(&a.0));
    starts
        .iter()
        .step_by(3)
        .take(4)
        .filter_map(|(_, at)| maximise(at, bounds, |at| penalised(&levels.levels, task, at)))
        .max_by(|a, b| a.value.total_cmp(&b.value))
        .ok_or(StatsError::NotConverged { what: "the psychometric function" })
}

pub(super) fn describe(levels: &Levels, task: &Task, bounds: &[(f64, f64)], best: &Maximum) -> Fit {
    let curve = Curve::from_parameters(task, &best.at);
    let names = ["threshold", "width", "lapse", "eta"];
    let on_edge = |i: usize| {
        let (low, high) = bounds[i];
        let margin = 1e-9 * (high - low);
        low < high && (best.at[i] <= low + margin || best.at[i] >= high - margin)
    };
    let free: Vec<usize> = (0..PARAMETERS).filter(|&i| bounds[i].0 < bounds[i].1 && !on_edge(i)).collect();
    let q = free.len();
    let curvature: Vec<f64> =
        free.iter().flat_map(|&i| free.iter().map(move |&j| best.curvature[i * PARAMETERS + j])).collect();
    let mut standard_errors = [None; PARAMETERS];
    if let Some(l) = linalg::cholesky(&curvature, q) {
        let covariance = linalg::inverse(&l, q);
        for (k, &i) in free.iter().enumerate() {
            standard_errors[i] = Some(covariance[k * q + k].sqrt());
        }
    }
    Fit {
        curve,
        standard_errors,
        log_likelihood: log_likelihood(&levels.levels, task, &best.at).value,
        deviance: deviance(&levels.levels, &curve),
        at_bound: (0..PARAMETERS).filter(|&i| on_edge(i)).map(|i| names[i].to_owned()).collect(),
        trials: levels.levels.iter().map(|l| l.trials).sum(),
    }
}

/// 2 Σ k ln(k/nψ) + (n − k) ln((n − k)/n(1 − ψ)).
pub(super) fn deviance(levels: &[Level], curve: &Curve) -> f64 {
    let part = |k: f64, expected: f64| if k > 0.0 { k * (k / expected).ln() } else { 0.0 };
    let sum: f64 = levels
        .iter()
        .map(|l| {
            let psi = curve.proportion(l.x).clamp(1e-300, 1.0 - 1e-16);
            let (k, n) = (l.correct as f64, l.trials as f64);
            part(k, n * psi) + part(n - k, n * (1.0 - psi))
        })
        .sum();
    (2.0 * sum).max(0.0)
}

/// z for a two-sided level.
pub(super) fn critical(level: f64) -> f64 {
    -normal::quantile((1.0 - level) / 2.0)
}
