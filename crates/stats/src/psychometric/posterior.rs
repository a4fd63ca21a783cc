//! The posterior on a grid, by psignifit 4's procedure (Schütt, Harmeling, Macke & Wichmann 2016, Vision Research 122, 105).

use super::likelihood::{PARAMETERS, add_beta_prior, log_likelihood};
use super::{Curve, Lapse, Level, Levels, Task, priors};
use crate::optimise::{Local, maximise};
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Points a side of the grids: the coarse one finds where the mass is, the fine one measures it. psignifit's numbers.
/// The parameters in the order threshold, width, lapse, eta.
const COARSE: [usize; PARAMETERS] = [30, 40, 10, 20];
const FINE: [usize; PARAMETERS] = [40, 40, 20, 20];
/// A coarse cell with less mass than this is left out of the fine grid.
const NEGLIGIBLE: f64 = 1e-5;

/// The posterior of a psychometric function.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Posterior {
    /// Where the posterior density is highest (found by Newton's method, not on the grid).
    pub map: Curve,
    /// The posterior mean of each parameter.
    pub mean: Curve,
    /// The threshold (unscaled, F = ½).
    pub threshold: ParameterPosterior,
    /// The width.
    pub width: ParameterPosterior,
    /// The lapse rate.
    pub lapse: ParameterPosterior,
    /// The overdispersion.
    pub eta: ParameterPosterior,
    /// Credible level of all intervals.
    pub level: f64,
    /// Thresholds at the scaled proportions asked for.
    pub thresholds: Vec<ThresholdPosterior>,
}

/// One parameter's marginal posterior.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ParameterPosterior {
    /// The grid; one value if the parameter is fixed.
    pub grid: Vec<f64>,
    /// Posterior mass at each, summing to 1.
    pub mass: Vec<f64>,
    /// Lower end of the equal-tailed credible interval as psignifit 4.3 reads it: linear in the running sum of the mass at the grid points,
    /// which puts both ends half a grid cell too low.
    pub low: f64,
    /// Upper end, likewise.
    pub high: f64,
    /// Lower end with each point's mass spread over its cell, which is what a finer grid converges to: the better number.
    pub low_centred: f64,
    /// Upper end, likewise.
    pub high_centred: f64,
    /// More than 0.1% of the mass lies on an edge of the prior's range of threshold or width: the data do not bound it.
    pub on_edge: bool,
}

/// The posterior of a threshold at a scaled proportion (of correct answers, guesses and lapses included).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ThresholdPosterior {
    /// The proportion of correct answers.
    pub proportion: f64,
    /// Share of the posterior whose curves reach it.
    pub reached: f64,
    /// Posterior median; `None` where it is beyond every stimulus.
    pub median: Option<f64>,
    /// Lower end of the equal-tailed interval, likewise.
    pub low: Option<f64>,
    /// Upper end, likewise.
    pub high: Option<f64>,
}

/// The posterior under psignifit's default priors: threshold flat over the levels with cosine edges, width flat between twice the smallest
/// step and the spread with cosine edges, λ and η Beta(1, 10).
///
/// `level`: credible level; `proportions`: scaled proportions at which thresholds are wanted. psignifit always lets η free
/// ([`Task::overdispersion`]). Errors: an invalid task, level, proportion or data; fewer than two distinct levels.
pub fn posterior(levels: &[Level], task: &Task, level: f64, proportions: &[f64]) -> Result<Posterior> {
    task.check()?;
    StatsError::open_probability("level", level)?;
    for (index, &value) in proportions.iter().enumerate() {
        if !(value > task.guess && value < 1.0) {
            let rule = "must lie strictly between the guess rate and 1";
            return Err(StatsError::InvalidElement { name: "proportions", index, value, rule });
        }
    }
    let levels = Levels::new(levels)?;
    let spread = levels.spread();
    let bounds = [
        (levels.low - 0.5 * spread, levels.high + 0.5 * spread),
        (levels.step, 3.0 * spread),
        task.lapse_bounds(),
        if task.overdispersion { (0.0, 1.0 - 1e-10) } else { (0.0, 0.0) },
    ];
    let coarse = Grid::new(&levels, task, &bounds, &COARSE);
    let fine = Grid::new(&levels, task, &coarse.tightened(), &FINE);

    let tail = (1.0 - level) / 2.0;
    let marginals: [ParameterPosterior; PARAMETERS] =
        std::array::from_fn(|i| fine.marginal(i, tail, (i < 2).then_some(bounds[i])));
    let mean: Vec<f64> =
        marginals.iter().map(|m| m.grid.iter().zip(&m.mass).map(|(x, p)| x * p).sum()).collect();
    let thresholds = proportions.iter().map(|&p| fine.threshold(task, p, tail)).collect();

    // The density always falls from η = 0, so that a second hill needs its own start.
    let top = fine.highest();
    let flat = [top[0], top[1], top[2], 0.0];
    let map = [top, flat]
        .iter()
        .filter_map(|start| maximise(start, &bounds, |at| log_posterior(&levels, task, at)))
        .max_by(|a, b| a.value.total_cmp(&b.value))
        .ok_or(StatsError::NotConverged { what: "the posterior's mode" })?;
    let [threshold, width, lapse, eta] = marginals;
    Ok(Posterior {
        map: Curve::from_parameters(task, &map.at),
        mean: Curve::from_parameters(task, &mean),
        threshold,
        width,
        lapse,
        eta,
        level,
        thresholds,
    })
}

fn log_posterior(levels: &Levels, task: &Task, at: &[f64]) -> Local {
    let mut sum = log_likelihood(&levels.levels, task, at);
    for (i, prior) in [priors::threshold(levels, at[0]), priors::width(levels, at[1])].iter().enumerate() {
        sum.value += prior[0];
        sum.gradient[i] += prior[1];
        sum.curvature[i * PARAMETERS + i] -= prior[2];
    }
    if task.lapse == Lapse::Prior {
        add_beta_prior(&mut sum, 2, at[2]);
    }
    if task.overdispersion {
        add_beta_prior(&mut sum, 3, at[3]);
    }
    sum
}

/// Posterior mass over threshold × width × lapse × eta, eta outermost and width innermost.
struct Grid {
    axes: [Vec<f64>; PARAMETERS],
    mass: Vec<f64>,
}

impl Grid {
    fn new(
        levels: &Levels,
        task: &Task,
        bounds: &[(f64, f64); PARAMETERS],
        points: &[usize; PARAMETERS],
    ) -> Self {
        let axes: [Vec<f64>; PARAMETERS] = std::array::from_fn(|i| axis(bounds[i], points[i]));
        let [thresholds, widths, lapses, etas] = &axes;
        let beta = |x: f64, used: bool| if used { 9.0 * (-x).ln_1p() } else { 0.0 };
        let plane: Vec<f64> = thresholds
            .iter()
            .flat_map(|&t| {
                let prior = priors::threshold(levels, t)[0];
                widths.iter().map(move |&w| prior + priors::width(levels, w)[0])
            })
            .collect();
        let curves: Vec<Vec<f64>> = levels
            .levels
            .iter()
            .map(|l| {
                let at = |&t: &f64| widths.iter().map(move |&w| task.sigmoid.value(l.x, t, w));
                thresholds.iter().flat_map(at).collect()
            })
            .collect();

        let mut mass = Vec::with_capacity(etas.len() * lapses.len() * plane.len());
        for &eta in etas {
            let counts: Vec<Answers> = levels.levels.iter().map(|l| Answers::new(l, eta)).collect();
            for &lapse in lapses {
                let prior = beta(eta, task.overdispersion) + beta(lapse, task.lapse == Lapse::Prior);
                let span = 1.0 - lapse - task.guess;
                for (cell, plane) in plane.iter().enumerate() {
                    let mut sum = prior + plane;
                    if sum > f64::NEG_INFINITY {
                        for (answers, curve) in counts.iter().zip(&curves) {
                            sum += answers.log_likelihood(task.guess + span * curve[cell]);
                        }
                    }
                    mass.push(sum);
                }
            }
        }
        let highest = mass.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<Vec<f64>> = axes.iter().map(|a| trapezoid(a)).collect();
        let mut index = 0;
        let mut total = 0.0;
        for e in &weights[3] {
            for l in &weights[2] {
                for t in &weights[0] {
                    for w in &weights[1] {
                        mass[index] = (mass[index] - highest).exp() * e * l * t * w;
                        total += mass[index];
                        index += 1;
                    }
                }
            }
        }
        mass.iter_mut().for_each(|m| *m /= total);
        Self { axes, mass }
    }

    /// Axis indices of a cell, in the parameters' order.
    fn indices(&self, cell: usize) -> [usize; PARAMETERS] {
        let [t, w, l, _] = self.axes.each_ref().map(Vec::len);
        [cell / w % t, cell % w, cell / (w * t) % l, cell / (w * t * l)]
    }

    fn highest(&self) -> [f64; PARAMETERS] {
        let cell = (0..self.mass.len()).max_by(|&a, &b| self.mass[a].total_cmp(&self.mass[b])).unwrap_or(0);
        let at = self.indices(cell);
        std::array::from_fn(|i| self.axes[i][at[i]])
    }

    /// The box around all cells that matter, one cell wider.
    fn tightened(&self) -> [(f64, f64); PARAMETERS] {
        let mut range = [(usize::MAX, 0); PARAMETERS];
        for (cell, _) in self.mass.iter().enumerate().filter(|(_, m)| **m >= NEGLIGIBLE) {
            for (range, i) in range.iter_mut().zip(self.indices(cell)) {
                *range = (range.0.min(i), range.1.max(i));
            }
        }
        std::array::from_fn(|i| {
            let axis = &self.axes[i];
            let (first, last) = range[i];
            if first > last {
                return (axis[0], axis[axis.len() - 1]);
            }
            (axis[first.saturating_sub(1)], axis[(last + 1).min(axis.len() - 1)])
        })
    }

    fn marginal(&self, parameter: usize, tail: f64, edge: Option<(f64, f64)>) -> ParameterPosterior {
        let grid = self.axes[parameter].clone();
        let mut mass = vec![0.0; grid.len()];
        for (cell, m) in self.mass.iter().enumerate() {
            mass[self.indices(cell)[parameter]] += m;
        }
        let mut running = 0.0;
        let sums: Vec<f64> = mass
            .iter()
            .map(|m| {
                running += m;
                running
            })
            .collect();
        let last = grid.len() - 1;
        // Each point's mass lies in its cell, halfway to its neighbours.
        let cells: Vec<f64> = std::iter::once(0.0).chain(sums.iter().copied()).collect();
        let edges: Vec<f64> =
            (0..=grid.len()).map(|i| 0.5 * (grid[i.saturating_sub(1)] + grid[i.min(last)])).collect();
        let on_edge = edge.is_some_and(|(low, high)| {
            (grid[0] <= low && mass[0] > 1e-3) || (grid[last] >= high && mass[last] > 1e-3)
        });
        ParameterPosterior {
            low: interpolate(tail, &sums, &grid),
            high: interpolate(1.0 - tail, &sums, &grid),
            low_centred: interpolate(tail, &cells, &edges),
            high_centred: interpolate(1.0 - tail, &cells, &edges),
            on_edge,
            grid,
            mass,
        }
    }

    fn threshold(&self, task: &Task, proportion: f64, tail: f64) -> ThresholdPosterior {
        let [thresholds, widths, lapses, _] = &self.axes;
        let plane = thresholds.len() * widths.len() * lapses.len();
        let mut weighted: Vec<(f64, f64)> = Vec::with_capacity(plane);
        let mut reached = 0.0;
        for cell in 0..plane {
            let weight: f64 = self.mass.iter().skip(cell).step_by(plane).sum();
            let [t, w, l, _] = self.indices(cell);
            let p = (proportion - task.guess) / (1.0 - task.guess - lapses[l]);
            if p > 0.0 && p < 1.0 {
                weighted.push((task.sigmoid.inverse(p, thresholds[t], widths[w]), weight));
                reached += weight;
            }
        }
        weighted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let quantile = |q: f64| {
            let mut sum = 0.0;
            weighted
                .iter()
                .find(|(_, w)| {
                    sum += w;
                    sum >= q
                })
                .map(|(x, _)| *x)
        };
        ThresholdPosterior {
            proportion,
            reached: reached.min(1.0),
            median: quantile(0.5),
            low: quantile(tail),
            high: quantile(1.0 - tail),
        }
    }
}

/// `points` equal steps over the range, or its one value.
fn axis((low, high): (f64, f64), points: usize) -> Vec<f64> {
    if high - low <= 1e-12 * (1.0 + low.abs()) {
        return vec![low];
    }
    let step = (high - low) / (points - 1) as f64;
    (0..points).map(|i| if i == points - 1 { high } else { low + step * i as f64 }).collect()
}

/// The trapezoidal rule's weights.
fn trapezoid(axis: &[f64]) -> Vec<f64> {
    if axis.len() < 2 {
        return vec![1.0];
    }
    let step = axis[1] - axis[0];
    (0..axis.len()).map(|i| if i == 0 || i == axis.len() - 1 { 0.5 * step } else { step }).collect()
}

/// y at x on the line through rising (xs, ys), the ends held.
fn interpolate(x: f64, xs: &[f64], ys: &[f64]) -> f64 {
    let above = xs.partition_point(|v| *v < x);
    if above == 0 {
        return ys[0];
    }
    if above == xs.len() {
        return ys[ys.len() - 1];
    }
    let (x0, x1) = (xs[above - 1], xs[above]);
    if x1 == x0 { ys[above] } else { ys[above - 1] + (x - x0) / (x1 - x0) * (ys[above] - ys[above - 1]) }
}

/// A level's answers under one η, ready for many ψ.
struct Answers {
    k: f64,
    m: f64,
    /// 1/η² − 1, or `None` for the binomial.
    size: Option<f64>,
    /// ln Γ(ν) − ln Γ(n + ν).
    constant: f64,
}

impl Answers {
    fn new(level: &Level, eta: f64) -> Self {
        let (k, m) = (level.correct as f64, (level.trials - level.correct) as f64);
        let size = (eta * eta > 1e-9).then(|| 1.0 / (eta * eta) - 1.0);
        let constant = size.map_or(0.0, |v| ln_gamma(v) - ln_gamma(k + m + v));
        Self { k, m, size, constant }
    }

    fn log_likelihood(&self, psi: f64) -> f64 {
        let psi = psi.clamp(1e-300, 1.0 - 1e-16);
        let term = |k: f64, p: f64| match self.size {
            _ if k == 0.0 => 0.0,
            None => k * p.ln(),
            Some(v) => ln_gamma(k + v * p) - ln_gamma(v * p),
        };
        self.constant + term(self.k, psi) + term(self.m, 1.0 - psi)
    }
}

/// ln Γ(x) for x > 0 by Stirling's series, moved above 10 first: 1e-15 of its largest term, a third of the time of an exact one.
fn ln_gamma(mut x: f64) -> f64 {
    let mut product = 1.0;
    while x < 10.0 {
        product *= x;
        x += 1.0;
    }
    let r = 1.0 / x;
    let r2 = r * r;
    let series = r
        * (1.0 / 12.0
            - r2 * (1.0 / 360.0
                - r2 * (1.0 / 1260.0
                    - r2 * (1.0 / 1680.0 - r2 * (1.0 / 1188.0 - r2 * (691.0 / 360_360.0))))));
    (x - 0.5) * x.ln() - x + 0.5 * std::f64::consts::TAU.ln() + series - product.ln()
}
