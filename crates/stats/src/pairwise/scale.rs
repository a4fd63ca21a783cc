//! The fit.

use super::model::Model;
use super::{Pair, Wins, graph};
use crate::linalg;
use crate::normal;
use crate::optimise::{Local, Maximum, maximise};
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// What is maximised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Estimator {
    /// The likelihood where it has a finite maximum, else the likelihood times Jeffreys' prior; the result says which.
    #[default]
    Automatic,
    /// The likelihood; separated choices are an error.
    MaximumLikelihood,
    /// The likelihood times Jeffreys' prior √det I: always finite, shrunk towards equality. For Bradley–Terry it is Firth's (1993) bias
    /// reduction; for Thurstone it is the same penalty, finite by Kosmidis & Firth (2021).
    Jeffreys,
}

/// Where the scale has its zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// The mean of the conditions.
    #[default]
    Mean,
    /// The condition of this index.
    Condition(usize),
}

/// How to scale.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ScaleOptions {
    /// Gaussian or logistic.
    pub model: Model,
    /// Likelihood, with or without prior.
    pub estimator: Estimator,
    /// The scale's zero.
    pub origin: Origin,
}

/// Positions of conditions on one axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Scale {
    /// The conditions' names.
    pub conditions: Vec<String>,
    /// Their positions, in JOD; more is chosen more often.
    pub jod: Vec<f64>,
    /// Standard errors in JOD, from the inverse information (observed; expected under Jeffreys' prior): right only for independent choices. Observers differ, so report
    /// [`observer_intervals`](super::observer_intervals).
    pub standard_errors: Vec<f64>,
    /// Covariance of `jod`, n × n, JOD² (rank n − 1).
    pub covariance: Vec<Vec<f64>>,
    /// Gaussian or logistic.
    pub model: Model,
    /// What was maximised: `maximum-likelihood` or `jeffreys`, never `automatic`.
    pub estimator: Estimator,
    /// The scale's zero.
    pub origin: Origin,
    /// ln likelihood of the single choices (no binomial coefficients, no prior).
    pub log_likelihood: f64,
    /// −2 ln of the likelihood ratio to a model with a free proportion for each compared pair.
    pub deviance: f64,
    /// Compared pairs − (conditions − 1).
    pub deviance_df: u64,
    /// P(χ² ≥ deviance): small when one dimension does not hold the data. Asymptotic; meaningless below about 5 expected choices a cell.
    pub deviance_p: f64,
    /// Choices.
    pub choices: u64,
}

impl Scale {
    /// The modelled proportion of choices of condition i over j. Errors: an index out of range.
    pub fn probability(&self, i: usize, j: usize) -> Result<f64> {
        let at = |name, index: usize| {
            let rule = "must be the index of a condition";
            self.jod.get(index).copied().ok_or(StatsError::Invalid { name, value: index as f64, rule })
        };
        Ok(self.model.probability(at("i", i)? - at("j", j)?))
    }
}

/// Scales conditions from how often each was chosen over each other one, complete design or not.
///
/// `names`: one a condition. Assumes independent choices (see [`observer_intervals`](super::observer_intervals) for the interval) and one
/// dimension (see `deviance_p`). Maximum likelihood agrees with pwcmp's `prior = 'none'` (whose 1.4826 is rounded, 1.5e-6 relative) and
/// with R's BradleyTerry2.
///
/// Errors: fewer than two conditions, no choices, a graph that falls apart ([`StatsError::Disconnected`], by name), separated choices
/// under [`Estimator::MaximumLikelihood`].
pub fn scale(names: &[String], wins: &Wins, options: ScaleOptions) -> Result<Scale> {
    let n = wins.conditions();
    if names.len() != n {
        let (first, second) = ("names", "the conditions");
        return Err(StatsError::LengthMismatch { first, first_len: names.len(), second, second_len: n });
    }
    if n < 2 {
        return Err(StatsError::TooFew { name: "conditions", len: n as u64, needed: 2 });
    }
    if let Origin::Condition(index) = options.origin
        && index >= n
    {
        let rule = "must be the index of a condition";
        return Err(StatsError::Invalid { name: "origin", value: index as f64, rule });
    }
    if wins.total() == 0 {
        return Err(StatsError::TooFew { name: "choices", len: 0, needed: 1 });
    }
    graph::connected(wins, names)?;
    let estimator = match (options.estimator, graph::unbeaten(wins)) {
        (Estimator::Automatic | Estimator::MaximumLikelihood, None) => Estimator::MaximumLikelihood,
        (Estimator::MaximumLikelihood, Some(group)) => {
            let group: Vec<&str> = group.iter().map(|&i| names[i].as_str()).collect();
            let reason = format!("{} never lost to any of the others", group.join(", "));
            return Err(StatsError::Separated { what: "the scale", reason });
        }
        _ => Estimator::Jeffreys,
    };
    let fit = fit(wins, options.model, estimator, &vec![0.0; n - 1])?;
    describe(names, wins, options, estimator, &fit)
}

/// Latent positions of conditions 1 … n − 1 against condition 0, from `start`.
pub(super) fn fit(wins: &Wins, model: Model, estimator: Estimator, start: &[f64]) -> Result<Maximum> {
    let pairs = wins.pairs();
    let q = wins.conditions() - 1;
    let jeffreys = estimator == Estimator::Jeffreys;
    maximise(start, &[], |theta| penalised(&pairs, q, model, theta, jeffreys))
        .ok_or(StatsError::NotConverged { what: "the scale" })
}

/// The columns of a pair's design row: +1 for i, −1 for j, condition 0 left out.
fn columns(pair: &Pair) -> [(Option<usize>, f64); 2] {
    [(pair.i.checked_sub(1), 1.0), (pair.j.checked_sub(1), -1.0)]
}

fn difference(pair: &Pair, theta: &[f64]) -> f64 {
    let at = |i: usize| if i == 0 { 0.0 } else { theta[i - 1] };
    at(pair.i) - at(pair.j)
}

fn accumulate(pair: &Pair, q: usize, slope: f64, weight: f64, gradient: &mut [f64], matrix: &mut [f64]) {
    for (a, x) in columns(pair) {
        let Some(a) = a else { continue };
        gradient[a] += x * slope;
        for (b, y) in columns(pair) {
            if let Some(b) = b {
                matrix[a * q + b] += x * y * weight;
            }
        }
    }
}

/// The Fisher information of the latent positions.
fn information(pairs: &[Pair], q: usize, model: Model, theta: &[f64]) -> Vec<f64> {
    let (mut matrix, mut nothing) = (vec![0.0; q * q], vec![0.0; q]);
    for pair in pairs {
        let weight = (pair.wins + pair.losses) * model.link(difference(pair, theta)).information;
        accumulate(pair, q, 0.0, weight, &mut nothing, &mut matrix);
    }
    matrix
}

/// The gradient of the ln likelihood in all latent positions `at`, and their Fisher information (n × n).
pub(super) fn score(wins: &Wins, model: Model, at: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let n = at.len();
    let (mut gradient, mut information) = (vec![0.0; n], vec![0.0; n * n]);
    for pair in wins.pairs() {
        let link = model.link(at[pair.i] - at[pair.j]);
        let slope = pair.wins * link.slope.0 - pair.losses * link.slope.1;
        let weight = (pair.wins + pair.losses) * link.information;
        for (i, x) in [(pair.i, 1.0), (pair.j, -1.0)] {
            gradient[i] += x * slope;
            for (j, y) in [(pair.i, 1.0), (pair.j, -1.0)] {
                information[i * n + j] += x * y * weight;
            }
        }
    }
    (gradient, information)
}

/// ln likelihood (+ ½ ln det of the Fisher information), its gradient, and as curvature minus the Hessian, but for the prior's with the
/// leverages held fixed (which is exact on a tree and spares third derivatives elsewhere).
fn penalised(pairs: &[Pair], q: usize, model: Model, theta: &[f64], jeffreys: bool) -> Local {
    let mut sum = Local { value: 0.0, gradient: vec![0.0; q], curvature: vec![0.0; q * q] };
    let mut inverse = Vec::new();
    if jeffreys {
        let Some(l) = linalg::cholesky(&information(pairs, q, model, theta), q) else {
            sum.value = f64::NEG_INFINITY;
            return sum;
        };
        sum.value = 0.5 * linalg::log_det(&l, q);
        inverse = linalg::inverse(&l, q);
    }
    for pair in pairs {
        let link = model.link(difference(pair, theta));
        // 0 · ln 0 is 0.
        let term = |k: f64, ln: f64| if k > 0.0 { k * ln } else { 0.0 };
        sum.value += term(pair.wins, link.ln.0) + term(pair.losses, link.ln.1);
        let mut slope = pair.wins * link.slope.0 - pair.losses * link.slope.1;
        let mut weight = pair.wins * link.bend.0 + pair.losses * link.bend.1;
        if jeffreys {
            let mut spread = 0.0;
            for (a, x) in columns(pair) {
                for (b, y) in columns(pair) {
                    if let (Some(a), Some(b)) = (a, b) {
                        spread += x * y * inverse[a * q + b];
                    }
                }
            }
            let leverage = (pair.wins + pair.losses) * link.information * spread;
            slope += 0.5 * leverage * link.ln_information.0;
            weight += 0.5 * leverage * link.ln_information.1;
        }
        accumulate(pair, q, slope, weight, &mut sum.gradient, &mut sum.curvature);
    }
    sum
}

/// Latent positions of all conditions about the origin, in JOD.
pub(super) fn positions(theta: &[f64], model: Model, origin: Origin) -> Vec<f64> {
    let mut all = vec![0.0];
    all.extend_from_slice(theta);
    let zero = match origin {
        Origin::Mean => all.iter().sum::<f64>() / all.len() as f64,
        Origin::Condition(i) => all[i],
    };
    all.iter().map(|x| (x - zero) * model.jod()).collect()
}

fn describe(
    names: &[String],
    wins: &Wins,
    options: ScaleOptions,
    estimator: Estimator,
    fit: &Maximum,
) -> Result<Scale> {
    let n = names.len();
    let q = n - 1;
    let model = options.model;
    let pairs = wins.pairs();
    let (mut log_likelihood, mut saturated) = (0.0, 0.0);
    for pair in &pairs {
        let link = model.link(difference(pair, &fit.at));
        let total = pair.wins + pair.losses;
        for (k, ln) in [(pair.wins, link.ln.0), (pair.losses, link.ln.1)] {
            if k > 0.0 {
                log_likelihood += k * ln;
                saturated += k * (k / total).ln();
            }
        }
    }
    let certainty = match estimator {
        Estimator::Jeffreys => information(&pairs, q, model, &fit.at),
        _ => fit.curvature.clone(),
    };
    let l = linalg::cholesky(&certainty, q).ok_or(StatsError::NotConverged { what: "the scale" })?;
    let inverse = linalg::inverse(&l, q);
    let latent = |i: usize, j: usize| if i == 0 || j == 0 { 0.0 } else { inverse[(i - 1) * q + j - 1] };
    // The variance of x − A x, where A takes the origin.
    let weight = |i: usize| match options.origin {
        Origin::Mean => 1.0 / n as f64,
        Origin::Condition(o) => f64::from(u8::from(i == o)),
    };
    let with_origin: Vec<f64> = (0..n).map(|i| (0..n).map(|k| weight(k) * latent(i, k)).sum()).collect();
    let origin_variance: f64 = (0..n).map(|i| weight(i) * with_origin[i]).sum();
    let jod2 = model.jod().powi(2);
    let covariance: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            (0..n)
                .map(|j| jod2 * (latent(i, j) - with_origin[i] - with_origin[j] + origin_variance))
                .collect()
        })
        .collect();
    let deviance = 2.0 * (saturated - log_likelihood).max(0.0);
    let df = (pairs.len() + 1 - n) as u64;
    Ok(Scale {
        conditions: names.to_vec(),
        jod: positions(&fit.at, model, options.origin),
        standard_errors: (0..n).map(|i| covariance[i][i].max(0.0).sqrt()).collect(),
        covariance,
        model,
        estimator,
        origin: options.origin,
        log_likelihood,
        deviance,
        deviance_df: df,
        deviance_p: normal::chi_squared_sf(deviance, df as f64),
        choices: wins.total(),
    })
}
