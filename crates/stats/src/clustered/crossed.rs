//! Logistic regression with random intercepts for participants and for pairs, which cross, by Laplace's approximation.

use super::logit::{Coefficient, coefficient, logistic, softplus};
use super::pairs_of;
use crate::linalg;
use crate::normal;
use crate::optimise::{Local, Maximum, maximise};
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Participants' and pairs' log odds scatter normally: logit P = β + σᵤ zᵢ + σᵥ xⱼ for participant i and pair j, all z and x ~ N(0, 1).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct CrossedLogit {
    /// β, the log odds at the centre of participants and pairs; p and 95% interval from t with `df`.
    pub log_odds: Coefficient,
    /// One less than there are pairs, or participants where these are fewer: other samples are of both.
    pub df: f64,
    /// Share of target choices over participants and pairs: the mean of P over both distributions.
    pub share: f64,
    /// The same at the lower end of the interval of β.
    pub low: f64,
    /// And at its upper end.
    pub high: f64,
    /// σᵤ, standard deviation of participants' log odds.
    pub participant_sd: f64,
    /// σᵥ, standard deviation of pairs' log odds.
    pub pair_sd: f64,
    /// ln likelihood by Laplace's approximation.
    pub log_likelihood: f64,
    /// Participants with choices.
    pub participants: u64,
    /// Pairs with choices.
    pub pairs: u64,
    /// Choices.
    pub choices: u64,
}

/// From so many pairs on the variance of pairs can be estimated at all well.
pub const ENOUGH_PAIRS: u64 = 5;

/// A standard deviation beyond this is called infinite.
const LARGEST_SIGMA: f64 = 50.0;
/// More choices would take minutes.
const MOST_CHOICES: usize = 100_000;

/// Fits the crossed random intercepts by maximum likelihood, the integral by Laplace's approximation as lme4's `glmer` has it (nAGQ = 1).
///
/// `choices`: a row a participant with a place for each pair; `None`: not answered. The standard error of β comes from the curvature in all
/// parameters that are not 0. Laplace's approximation makes the standard deviations too small where each participant answers few pairs.
/// Errors: rows of unequal length; fewer than two participants or pairs with choices; more than 100,000 choices; all choices alike;
/// choices that nobody and no pair contradicts, where a standard deviation is infinite. Source: Bates, Mächler, Bolker & Walker (2015).
pub fn crossed_logit(choices: &[Vec<Option<bool>>]) -> Result<CrossedLogit> {
    let data = Data::new(choices)?;
    let [pairs, participants] = [data.pairs, data.participants];
    let start = logit_of_share(&data)?;
    if data.is_consistent(|&(i, _, _)| i) || data.is_consistent(|&(_, j, _)| j) {
        return Err(endless());
    }
    let mut fit = climb(&data, [start, 0.7, 0.7])?;
    // The likelihood is even in both: 0 is level, and may be the bottom of a valley instead of a top.
    for i in [1, 2] {
        if fit.at[i] == 0.0 && fit.curvature[i * PARAMETERS + i] < 0.0 {
            let mut from = [fit.at[0], fit.at[1], fit.at[2]];
            from[i] = 0.3;
            fit = Some(climb(&data, from)?).filter(|other| other.value > fit.value).unwrap_or(fit);
        }
    }
    if fit.at[1].max(fit.at[2]) >= LARGEST_SIGMA {
        return Err(endless());
    }
    let free: Vec<usize> = (0..PARAMETERS).filter(|&i| i == 0 || fit.at[i] > 1e-6).collect();
    let q = free.len();
    let curvature: Vec<f64> = free
        .iter()
        .flat_map(|&i| free.iter().map(move |&j| (i, j)))
        .map(|(i, j)| fit.curvature[i * PARAMETERS + j])
        .collect();
    let l = linalg::cholesky(&curvature, q)
        .ok_or(StatsError::NotConverged { what: "the logit with participants and pairs" })?;
    let error = linalg::inverse(&l, q)[0].sqrt();
    let df = pairs.min(participants) as f64 - 1.0;
    let log_odds =
        coefficient(fit.at[0], error, normal::t_quantile(0.975, df), |t| normal::t_two_sided(t, df));
    let spread = fit.at[1].hypot(fit.at[2]);
    Ok(CrossedLogit {
        share: mean_logistic(log_odds.estimate, spread),
        low: mean_logistic(log_odds.low, spread),
        high: mean_logistic(log_odds.high, spread),
        log_odds,
        df,
        participant_sd: fit.at[1],
        pair_sd: fit.at[2],
        log_likelihood: fit.value,
        participants: participants as u64,
        pairs: pairs as u64,
        choices: data.cells.len() as u64,
    })
}

/// β, σᵤ and σᵥ.
const PARAMETERS: usize = 3;

/// The mean of 1/(1 + e^−(eta + spread z)) over z ~ N(0, 1): a trapezoidal sum, exact to rounding.
fn mean_logistic(eta: f64, spread: f64) -> f64 {
    let step = 0.05 / spread.max(1.0);
    let n = (9.0 / step) as i64;
    let weigh = |k: i64| {
        let z = k as f64 * step;
        (-0.5 * z * z).exp() * logistic(eta + spread * z)
    };
    step * (-n..=n).map(weigh).sum::<f64>() / std::f64::consts::TAU.sqrt()
}

fn endless() -> StatsError {
    StatsError::Separated {
        what: "the logit with participants and pairs",
        reason: "choices hardly ever contradict those of the same participant, or of the same pair, so that a standard deviation grows without end".into(),
    }
}

fn logit_of_share(data: &Data) -> Result<f64> {
    let (hits, all) = (data.cells.iter().map(|c| c.2).sum::<f64>(), data.cells.len() as f64);
    if hits == 0.0 || hits == all {
        return Err(StatsError::Separated {
            what: "the logit with participants and pairs",
            reason: "every choice is the same".into(),
        });
    }
    Ok((hits / (all - hits)).ln())
}

fn climb(data: &Data, start: [f64; PARAMETERS]) -> Result<Maximum> {
    let bounds = [(f64::NEG_INFINITY, f64::INFINITY), (0.0, LARGEST_SIGMA), (0.0, LARGEST_SIGMA)];
    maximise(&start, &bounds, |at| data.local(at))
        .ok_or(StatsError::NotConverged { what: "the logit with participants and pairs" })
}

/// Choices by participant and pair, those without any left out.
struct Data {
    participants: usize,
    pairs: usize,
    /// Participant, pair, 1 for the target.
    cells: Vec<(usize, usize, f64)>,
}

/// The mode of the random effects and what Laplace's approximation needs there.
struct Mode {
    /// Participants', then pairs'.
    effects: Vec<f64>,
    /// ln likelihood less half the effects' squares.
    height: f64,
    /// Of each cell: y − μ, μ(1 − μ) and the derivative of that.
    cells: Vec<[f64; 3]>,
    hessian: Arrow,
}

/// A matrix that is diagonal in participants: [[diagonal, cross], [crossᵀ, dense]], factored.
struct Arrow {
    diagonal: Vec<f64>,
    /// A row a participant.
    cross: Vec<f64>,
    /// The Cholesky factor of the Schur complement over pairs.
    schur: Vec<f64>,
}

impl Data {
    fn new(choices: &[Vec<Option<bool>>]) -> Result<Data> {
        let columns = pairs_of(choices)?;
        let answered: Vec<&Vec<Option<bool>>> =
            choices.iter().filter(|row| row.iter().any(Option::is_some)).collect();
        let used: Vec<usize> =
            (0..columns).filter(|&j| answered.iter().any(|row| row[j].is_some())).collect();
        for (name, len) in [("participants", answered.len()), ("pairs", used.len())] {
            if len < 2 {
                return Err(StatsError::TooFew { name, len: len as u64, needed: 2 });
            }
        }
        let mut cells = Vec::new();
        for (i, row) in answered.iter().enumerate() {
            cells.extend(
                used.iter().enumerate().filter_map(|(k, &j)| Some((i, k, f64::from(u8::from(row[j]?))))),
            );
        }
        if cells.len() > MOST_CHOICES {
            let rule = "must not exceed 100,000";
            return Err(StatsError::Invalid { name: "choices", value: cells.len() as f64, rule });
        }
        Ok(Data { participants: answered.len(), pairs: used.len(), cells })
    }

    /// Whether all choices of each participant, or in each pair, are alike: Laplace's approximation may have a maximum there, the likelihood has none.
    fn is_consistent(&self, of: impl Fn(&(usize, usize, f64)) -> usize) -> bool {
        let mut first = vec![None; self.participants.max(self.pairs)];
        self.cells.iter().all(|cell| *first[of(cell)].get_or_insert(cell.2) == cell.2)
    }

    /// Laplace's ln likelihood with its exact gradient; the curvature by differences of that.
    fn local(&self, at: &[f64]) -> Local {
        let (value, gradient) = self.laplace(at);
        let mut curvature = vec![0.0; PARAMETERS * PARAMETERS];
        for i in 0..PARAMETERS {
            let step = 1e-5 * (1.0 + at[i].abs());
            let beside = |by: f64| {
                let mut there = at.to_vec();
                there[i] += by;
                self.laplace(&there).1
            };
            let (above, below) = (beside(step), beside(-step));
            for j in 0..PARAMETERS {
                let slope = -(above[j] - below[j]) / (2.0 * step);
                curvature[i * PARAMETERS + j] += 0.5 * slope;
                curvature[j * PARAMETERS + i] += 0.5 * slope;
            }
        }
        Local { value, gradient: gradient.to_vec(), curvature }
    }

    /// ℓ(ẑ) − ½ẑ² − ½ ln det H at the mode ẑ of the random effects, and its derivatives, those of ẑ and H included.
    fn laplace(&self, at: &[f64]) -> (f64, [f64; PARAMETERS]) {
        let sigmas = [at[1], at[2]];
        let Some(mode) = self.mode(at) else { return (f64::NAN, [f64::NAN; PARAMETERS]) };
        let value = mode.height - 0.5 * mode.hessian.ln_det();
        let [own, shared, joint] = mode.hessian.inverse_parts();
        let (m, j_all) = (self.participants, self.pairs);
        let mut gradient = [0.0; PARAMETERS];
        // Derivatives of the mode's equations in each parameter, and of ln det H in the effects.
        let mut moved = [vec![0.0; m + j_all], vec![0.0; m + j_all], vec![0.0; m + j_all]];
        let mut pulled = vec![0.0; m + j_all];
        for (&(i, j, _), &[residual, weight, bend]) in self.cells.iter().zip(&mode.cells) {
            let effects = [mode.effects[i], mode.effects[m + j]];
            let (both, alone) = (joint[i * j_all + j], [own[i], shared[j]]);
            let variance = sigmas[0].powi(2) * alone[0]
                + 2.0 * sigmas[0] * sigmas[1] * both
                + sigmas[1].powi(2) * alone[1];
            let direct = [1.0, effects[0], effects[1]];
            for (k, direct) in direct.iter().enumerate() {
                gradient[k] += residual * direct - 0.5 * bend * variance * direct;
                moved[k][i] -= sigmas[0] * weight * direct;
                moved[k][m + j] -= sigmas[1] * weight * direct;
            }
            moved[1][i] += residual;
            moved[2][m + j] += residual;
            gradient[1] -= weight * (sigmas[0] * alone[0] + sigmas[1] * both);
            gradient[2] -= weight * (sigmas[1] * alone[1] + sigmas[0] * both);
            pulled[i] += bend * variance * sigmas[0];
            pulled[m + j] += bend * variance * sigmas[1];
        }
        mode.hessian.solve(&mut pulled);
        for (gradient, moved) in gradient.iter_mut().zip(&moved) {
            *gradient -= 0.5 * pulled.iter().zip(moved).map(|(a, b)| a * b).sum::<f64>();
        }
        (value, gradient)
    }

    /// The mode of the random effects by Newton's method: strictly concave, so that halved steps always end there.
    fn mode(&self, at: &[f64]) -> Option<Mode> {
        let m = self.participants;
        let mut here = self.seen(at, vec![0.0; m + self.pairs])?;
        for _ in 0..100 {
            let mut step: Vec<f64> = here.effects.iter().map(|z| -z).collect();
            for (&(i, j, _), [residual, ..]) in self.cells.iter().zip(&here.cells) {
                step[i] += at[1] * residual;
                step[m + j] += at[2] * residual;
            }
            here.hessian.solve(&mut step);
            let largest = step.iter().fold(0.0, |most: f64, d| most.max(d.abs()));
            let mut scale = 1.0;
            let next = loop {
                let there = here.effects.iter().zip(&step).map(|(z, d)| z + scale * d).collect();
                let there = self.seen(at, there)?;
                if there.height >= here.height - 1e-13 * (1.0 + here.height.abs()) || scale < 1e-6 {
                    break there;
                }
                scale *= 0.5;
            };
            here = next;
            if largest < 1e-11 {
                break;
            }
        }
        Some(here)
    }

    /// Height and curvature at these random effects.
    fn seen(&self, at: &[f64], effects: Vec<f64>) -> Option<Mode> {
        let (m, j_all) = (self.participants, self.pairs);
        let mut height = -0.5 * effects.iter().map(|z| z * z).sum::<f64>();
        let (mut diagonal, mut cross) = (vec![1.0; m], vec![0.0; m * j_all]);
        let mut shared = vec![1.0; j_all];
        let mut cells = Vec::with_capacity(self.cells.len());
        for &(i, j, y) in &self.cells {
            let eta = at[0] + at[1] * effects[i] + at[2] * effects[m + j];
            let (mu, rest) = (logistic(eta), logistic(-eta));
            let weight = mu * rest;
            height += y * eta - softplus(eta);
            diagonal[i] += at[1] * at[1] * weight;
            shared[j] += at[2] * at[2] * weight;
            cross[i * j_all + j] += at[1] * at[2] * weight;
            cells.push([if y > 0.5 { rest } else { -mu }, weight, weight * (rest - mu)]);
        }
        let mut schur = vec![0.0; j_all * j_all];
        for (i, own) in diagonal.iter().enumerate() {
            let row = &cross[i * j_all..(i + 1) * j_all];
            for (a, x) in row.iter().enumerate().filter(|(_, x)| **x != 0.0) {
                for (b, y) in row.iter().enumerate() {
                    schur[a * j_all + b] -= x * y / own;
                }
            }
        }
        shared.iter().enumerate().for_each(|(j, x)| schur[j * j_all + j] += x);
        let schur = linalg::cholesky(&schur, j_all)?;
        Some(Mode { effects, height, cells, hessian: Arrow { diagonal, cross, schur } })
    }
}

impl Arrow {
    fn pairs(&self) -> usize {
        self.cross.len() / self.diagonal.len()
    }

    fn ln_det(&self) -> f64 {
        self.diagonal.iter().map(|d| d.ln()).sum::<f64>() + linalg::log_det(&self.schur, self.pairs())
    }

    /// Solves for a right-hand side of participants, then pairs, in place.
    fn solve(&self, b: &mut [f64]) {
        let n = self.pairs();
        let (own, shared) = b.split_at_mut(self.diagonal.len());
        for ((x, d), row) in own.iter().zip(&self.diagonal).zip(self.cross.chunks(n)) {
            shared.iter_mut().zip(row).for_each(|(s, c)| *s -= c * x / d);
        }
        linalg::solve(&self.schur, n, shared);
        for ((x, d), row) in own.iter_mut().zip(&self.diagonal).zip(self.cross.chunks(n)) {
            *x = (*x - row.iter().zip(shared.iter()).map(|(c, s)| c * s).sum::<f64>()) / d;
        }
    }

    /// Of the inverse: the participants' diagonal, the pairs' diagonal, and the block between them.
    fn inverse_parts(&self) -> [Vec<f64>; 3] {
        let n = self.pairs();
        let dense = linalg::inverse(&self.schur, n);
        let (mut own, mut joint) = (Vec::with_capacity(self.diagonal.len()), vec![0.0; self.cross.len()]);
        for (i, (d, row)) in self.diagonal.iter().zip(self.cross.chunks(n)).enumerate() {
            let mut variance = 1.0 / d;
            for j in 0..n {
                let through: f64 = (0..n).map(|k| row[k] / d * dense[k * n + j]).sum();
                joint[i * n + j] = -through;
                variance += through * row[j] / d;
            }
            own.push(variance);
        }
        [own, (0..n).map(|j| dense[j * n + j]).collect(), joint]
    }
}

#[cfg(test)]
mod tests;
