//! Logistic regression with a random intercept for each participant, integrated by adaptive quadrature.

use super::logit::{self, Coefficient, Row, by_participant, checked, coefficient, dot, logistic, softplus};
use crate::linalg;
use crate::normal;
use crate::optimise::{Local, maximise};
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Participants' log odds scatter normally about the fixed effects: logit P = xβ + σz, z ~ N(0, 1) a participant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct MixedLogit {
    /// For a participant at the centre (z = 0), in the order of the predictors; p and 95% interval from the normal.
    pub coefficients: Vec<Coefficient>,
    /// Standard deviation σ of the participants' log odds.
    pub sigma: f64,
    /// Its standard error; `None` on the boundary σ = 0.
    pub sigma_standard_error: Option<f64>,
    /// σ²/(σ² + π²/3): the intraclass correlation on the latent scale.
    pub latent_icc: f64,
    /// ln likelihood of the single choices (no binomial coefficients).
    pub log_likelihood: f64,
    /// The same with σ = 0.
    pub log_likelihood_independent: f64,
    /// P of the likelihood ratio under σ = 0, from ½χ²₀ + ½χ²₁ (σ is on its boundary there).
    pub sigma_p: f64,
    /// The model has as many parameters as the data have free proportions (intercept only, two trials each): it reproduces the mean
    /// and the second moment of the participants' proportions exactly, and nothing is left to test the normal shape.
    pub saturated: bool,
    /// The maximum is at σ = 0: participants differ no more than chance makes them.
    pub boundary: bool,
    /// Participants with trials.
    pub participants: u64,
    /// Their trials.
    pub trials: u64,
}

/// σ beyond this is called infinite: participants never contradict themselves.
const LARGEST_SIGMA: f64 = 50.0;

/// Fits the random-intercept logit by maximum likelihood. Each participant's integral is a trapezoidal sum about the posterior's peak, whose
/// error falls exponentially with the step: exact to rounding, where 40-point Gauss–Hermite is off by 1e-9 at σ = 2.7 and Laplace's
/// approximation is badly biased with a few trials each.
///
/// Assumes normal log odds over participants and independent trials given the participant.
/// Errors: malformed rows, fewer than two participants, nobody with two trials, collinear or separated predictors, participants who
/// never contradict themselves (σ = ∞).
/// Sources: Pinheiro & Bates (1995); Self & Liang (1987) for the boundary.
pub fn mixed_logit(rows: &[Row]) -> Result<MixedLogit> {
    let (rows, p) = checked(rows)?;
    let groups = by_participant(&rows);
    let trials_of = |g: &Vec<&Row>| g.iter().map(|r| r.trials).sum::<u64>();
    if groups.iter().all(|g| trials_of(g) < 2) {
        return Err(StatsError::NoSolution {
            what: "the random-intercept logit",
            reason: "no participant has two trials",
        });
    }
    let fixed = logit::plain(&rows, p)?;
    let intercept_only = p == 1 && rows.iter().all(|r| r.x[0] == rows[0].x[0]);
    let consistent = groups.iter().all(|g| {
        let hits: u64 = g.iter().map(|r| r.successes).sum();
        hits == 0 || hits == trials_of(g)
    });
    if consistent {
        return Err(StatsError::Separated {
            what: "the random-intercept logit",
            reason: "no participant's choices differ among themselves, so σ is infinite".into(),
        });
    }

    let mut start = fixed.at.clone();
    start.push(1.0);
    let mut bounds = vec![(f64::NEG_INFINITY, f64::INFINITY); p];
    bounds.push((0.0, LARGEST_SIGMA));
    let fit = maximise(&start, &bounds, |theta| marginal(&groups, theta))
        .ok_or(StatsError::NotConverged { what: "the random-intercept logit" })?;
    if fit.at[p] >= LARGEST_SIGMA {
        return Err(StatsError::Separated {
            what: "the random-intercept logit",
            reason: "participants hardly ever contradict themselves, so σ grows without end".into(),
        });
    }
    let boundary = fit.at[p] < 1e-6 || fit.value <= fixed.value;
    let (at, value, curvature) = if boundary {
        (fixed.at.clone(), fixed.value, fixed.curvature.clone())
    } else {
        (fit.at.clone(), fit.value, fit.curvature)
    };
    let q = at.len();
    let l = linalg::cholesky(&curvature, q).ok_or(logit::COLLINEAR)?;
    let covariance = linalg::inverse(&l, q);
    let sigma = if boundary { 0.0 } else { fit.at[p] };
    let ratio = 2.0 * (value - fixed.value).max(0.0);
    let z = normal::quantile(0.975);
    Ok(MixedLogit {
        coefficients: (0..p)
            .map(|i| coefficient(at[i], covariance[i * q + i].sqrt(), z, |s| 2.0 * normal::cdf(-s.abs())))
            .collect(),
        sigma,
        sigma_standard_error: (!boundary).then(|| covariance[p * q + p].sqrt()),
        latent_icc: sigma * sigma / (sigma * sigma + std::f64::consts::PI.powi(2) / 3.0),
        log_likelihood: value,
        log_likelihood_independent: fixed.value,
        sigma_p: if ratio > 0.0 { 0.5 * normal::chi_squared_sf(ratio, 1.0) } else { 1.0 },
        saturated: intercept_only && groups.iter().all(|g| trials_of(g) == 2),
        boundary,
        participants: groups.len() as u64,
        trials: rows.iter().map(|r| r.trials).sum(),
    })
}

/// ln likelihood in (β, σ) with exact derivatives of the integral: E[∂ ln f] and E[∂² ln f] + Var[∂ ln f] over the participant's posterior.
fn marginal(groups: &[Vec<&Row>], theta: &[f64]) -> Local {
    let q = theta.len();
    let (beta, sigma) = (&theta[..q - 1], theta[q - 1]);
    let mut sum = Local { value: 0.0, gradient: vec![0.0; q], curvature: vec![0.0; q * q] };
    let mut score = vec![0.0; q];
    for group in groups {
        let eta: Vec<f64> = group.iter().map(|r| dot(&r.x, beta)).collect();
        let (centre, scale) = posterior_peak(group, &eta, sigma);
        let mut mass = 0.0;
        let mut mean = vec![0.0; q];
        let mut second = vec![0.0; q * q];
        let at_centre = log_joint(group, &eta, sigma, centre);
        // Fine against the peak's width and against the poles of the logistic function at iπ/σ.
        let step = (scale / 4.0).min(0.5 / sigma.max(1e-3));
        let mut node = |z: f64| {
            let height = log_joint(group, &eta, sigma, z) - at_centre;
            if height < -40.0 {
                return false;
            }
            let w = step * height.exp();
            mass += w;
            score.fill(0.0);
            for (row, eta) in group.iter().zip(&eta) {
                let mu = logistic(eta + sigma * z);
                let residual = row.successes as f64 - row.trials as f64 * mu;
                let information = row.trials as f64 * mu * (1.0 - mu);
                let extended = |i: usize| if i < q - 1 { row.x[i] } else { z };
                for i in 0..q {
                    score[i] += residual * extended(i);
                    for j in 0..q {
                        second[i * q + j] -= w * information * extended(i) * extended(j);
                    }
                }
            }
            for i in 0..q {
                mean[i] += w * score[i];
                for j in 0..q {
                    second[i * q + j] += w * score[i] * score[j];
                }
            }
            true
        };
        (0..).map(f64::from).take_while(|k| node(centre + step * k)).count();
        (1..).map(f64::from).take_while(|k| node(centre - step * k)).count();
        sum.value += at_centre + (mass / std::f64::consts::TAU.sqrt()).ln();
        for i in 0..q {
            let m = mean[i] / mass;
            sum.gradient[i] += m;
            for j in 0..q {
                sum.curvature[i * q + j] -= second[i * q + j] / mass - m * mean[j] / mass;
            }
        }
    }
    sum
}

/// ln P(choices | z) − z²/2.
fn log_joint(group: &[&Row], eta: &[f64], sigma: f64, z: f64) -> f64 {
    let choices: f64 = group
        .iter()
        .zip(eta)
        .map(|(row, eta)| {
            let e = eta + sigma * z;
            row.successes as f64 * e - row.trials as f64 * softplus(e)
        })
        .sum();
    choices - 0.5 * z * z
}

/// Mode and curvature scale of the participant's posterior of z: strictly concave, so bisection on the slope always ends.
fn posterior_peak(group: &[&Row], eta: &[f64], sigma: f64) -> (f64, f64) {
    let slope = |z: f64| {
        let mut slope = -z;
        let mut curvature = 1.0;
        for (row, eta) in group.iter().zip(eta) {
            let mu = logistic(eta + sigma * z);
            slope += sigma * (row.successes as f64 - row.trials as f64 * mu);
            curvature += sigma * sigma * row.trials as f64 * mu * (1.0 - mu);
        }
        (slope, curvature)
    };
    let reach = sigma * group.iter().map(|r| r.trials).sum::<u64>() as f64 + 1.0;
    let (mut low, mut high, mut z) = (-reach, reach, 0.0);
    for _ in 0..200 {
        let (g, c) = slope(z);
        if g > 0.0 {
            low = z;
        } else {
            high = z;
        }
        let newton = z + g / c;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let close = (next - z).abs() <= 1e-14 * (1.0 + z.abs());
        z = next;
        if close {
            break;
        }
    }
    (z, 1.0 / slope(z).1.sqrt())
}
