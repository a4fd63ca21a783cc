//! Logistic regression with standard errors from the clusters.

use crate::linalg;
use crate::normal;
use crate::optimise::{Local, Maximum, maximise};
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Trials of one participant that share their predictors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// Whose choices these are (any numbering).
    pub participant: u64,
    /// Choices of the target, ≤ `trials`.
    pub successes: u64,
    /// Choices made.
    pub trials: u64,
    /// Predictors; write the intercept as a 1. All rows have as many.
    pub x: Vec<f64>,
}

impl Row {
    /// Rows of an intercept-only model, one a participant.
    pub fn intercept_only(clusters: &[super::Cluster]) -> Vec<Self> {
        (0..)
            .zip(clusters)
            .map(|(participant, c)| Self {
                participant,
                successes: c.successes,
                trials: c.trials,
                x: vec![1.0],
            })
            .collect()
    }
}

/// The small-sample factor on the cluster-robust variance (Cameron & Miller 2015; names as in R's clubSandwich).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "UPPERCASE")]
pub enum Correction {
    /// None: biased down with few participants.
    Cr0,
    /// G/(G − 1), with G participants (Stata's logit).
    #[default]
    Cr1,
    /// G/(G − 1) · (N − 1)/(N − p), with N trials and p coefficients (R's sandwich `HC1`, statsmodels).
    Cr1s,
}

/// One coefficient on the log-odds scale.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Coefficient {
    /// Log odds (ratio).
    pub estimate: f64,
    /// Its standard error under the model named by the result.
    pub standard_error: f64,
    /// estimate / standard error.
    pub statistic: f64,
    /// Two-sided p of estimate = 0.
    pub p: f64,
    /// Lower end of the 95% interval.
    pub low: f64,
    /// Upper end of the 95% interval.
    pub high: f64,
}

/// A logistic regression whose standard errors allow any dependence within participants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct RobustLogit {
    /// In the order of the predictors; p and interval from t with `df`.
    pub coefficients: Vec<Coefficient>,
    /// Standard errors that wrongly take the trials as independent, for comparison.
    pub naive_standard_errors: Vec<f64>,
    /// Which small-sample factor.
    pub correction: Correction,
    /// Participants − 1.
    pub df: f64,
    /// Participants with trials.
    pub participants: u64,
    /// Their trials.
    pub trials: u64,
    /// ln likelihood of the single choices (no binomial coefficients).
    pub log_likelihood: f64,
}

/// Logistic regression by maximum likelihood with the cluster-robust (sandwich) covariance of Liang & Zeger (1986).
///
/// Assumes independent participants, any dependence within; asymptotic in participants (below 30, read p with care).
/// Errors: malformed rows, fewer than two participants, collinear predictors, separated choices, participants who all fit alike (the
/// sandwich is then 0, which is no certainty).
pub fn robust_logit(rows: &[Row], correction: Correction) -> Result<RobustLogit> {
    let (rows, p) = checked(rows)?;
    let fit = plain(&rows, p)?;
    let l = linalg::cholesky(&fit.curvature, p).ok_or(COLLINEAR)?;
    let bread = linalg::inverse(&l, p);

    let groups = by_participant(&rows);
    let mut meat = vec![0.0; p * p];
    for group in &groups {
        let mut score = vec![0.0; p];
        for row in group {
            let residual = row.successes as f64 - row.trials as f64 * logistic(dot(&row.x, &fit.at));
            score.iter_mut().zip(&row.x).for_each(|(s, x)| *s += residual * x);
        }
        for i in 0..p {
            for j in 0..p {
                meat[i * p + j] += score[i] * score[j];
            }
        }
    }
    let (g, n) = (groups.len() as f64, rows.iter().map(|r| r.trials).sum::<u64>());
    let factor = match correction {
        Correction::Cr0 => 1.0,
        Correction::Cr1 => g / (g - 1.0),
        Correction::Cr1s if n as f64 > p as f64 => g / (g - 1.0) * (n as f64 - 1.0) / (n as f64 - p as f64),
        Correction::Cr1s => {
            return Err(StatsError::TooFew { name: "trials", len: n, needed: p as u64 + 1 });
        }
    };
    let df = g - 1.0;
    let t = normal::t_quantile(0.975, df);
    let coefficients = (0..p)
        .map(|i| {
            let variance: f64 = (0..p)
                .flat_map(|a| (0..p).map(move |b| (a, b)))
                .map(|(a, b)| bread[i * p + a] * meat[a * p + b] * bread[b * p + i])
                .sum();
            // Scores that are 0 but for rounding have no spread to take an interval from.
            if variance <= 1e-20 * bread[i * p + i] {
                return Err(StatsError::NoSolution {
                    what: "the cluster-robust interval",
                    reason: "every participant's choices are what the model expects, which leaves no differences between participants to take a standard error from",
                });
            }
            let se = (factor * variance).sqrt();
            Ok(coefficient(fit.at[i], se, t, |z| normal::t_two_sided(z, df)))
        })
        .collect::<Result<Vec<_>>>()?;
    Ok(RobustLogit {
        coefficients,
        naive_standard_errors: (0..p).map(|i| bread[i * p + i].sqrt()).collect(),
        correction,
        df,
        participants: groups.len() as u64,
        trials: n,
        log_likelihood: fit.value,
    })
}

pub(super) const COLLINEAR: StatsError =
    StatsError::NoSolution { what: "the logistic regression", reason: "the predictors are collinear" };

pub(super) fn coefficient(estimate: f64, se: f64, critical: f64, p: impl Fn(f64) -> f64) -> Coefficient {
    let statistic = estimate / se;
    Coefficient {
        estimate,
        standard_error: se,
        statistic,
        p: p(statistic),
        low: estimate - critical * se,
        high: estimate + critical * se,
    }
}

/// The rows with trials and the number of predictors.
pub(super) fn checked(rows: &[Row]) -> Result<(Vec<Row>, usize)> {
    let p = rows.first().map_or(0, |r| r.x.len());
    if p == 0 {
        return Err(StatsError::TooFew { name: "rows.x", len: 0, needed: 1 });
    }
    for (index, row) in rows.iter().enumerate() {
        if row.x.len() != p {
            return Err(StatsError::LengthMismatch {
                first: "rows[0].x",
                first_len: p,
                second: "another row's x",
                second_len: row.x.len(),
            });
        }
        if let Some(&value) = row.x.iter().find(|x| x.is_nan() || x.abs() > 1e12) {
            let rule = "must be within ±1e12";
            return Err(StatsError::InvalidElement { name: "rows.x", index, value, rule });
        }
        if row.successes > row.trials {
            return Err(StatsError::InvalidElement {
                name: "rows.successes",
                index,
                value: row.successes as f64,
                rule: "must not exceed trials",
            });
        }
    }
    let rows: Vec<Row> = rows.iter().filter(|r| r.trials > 0).cloned().collect();
    let participants = by_participant(&rows).len() as u64;
    if participants < 2 {
        return Err(StatsError::TooFew { name: "participants", len: participants, needed: 2 });
    }
    Ok((rows, p))
}

pub(super) fn by_participant(rows: &[Row]) -> Vec<Vec<&Row>> {
    let mut groups = std::collections::BTreeMap::<u64, Vec<&Row>>::new();
    for row in rows {
        groups.entry(row.participant).or_default().push(row);
    }
    groups.into_values().collect()
}

/// The ordinary logistic regression; its curvature is the Fisher information.
pub(super) fn plain(rows: &[Row], p: usize) -> Result<Maximum> {
    let separated =
        |reason: &str| StatsError::Separated { what: "the logistic regression", reason: reason.into() };
    let (hits, trials) = rows.iter().fold((0, 0), |(h, n), r| (h + r.successes, n + r.trials));
    if hits == 0 || hits == trials {
        return Err(separated("every choice is the same"));
    }
    let log_likelihood = |beta: &[f64]| {
        let mut sum = Local { value: 0.0, gradient: vec![0.0; p], curvature: vec![0.0; p * p] };
        for row in rows {
            let eta = dot(&row.x, beta);
            let (k, n) = (row.successes as f64, row.trials as f64);
            // k − nμ without cancelling where μ is 1 to rounding.
            let (mu, rest) = (logistic(eta), logistic(-eta));
            sum.value += k * eta - n * softplus(eta);
            add_row(&mut sum, row, k * rest - (n - k) * mu, n * mu * rest);
        }
        sum
    };
    let start = vec![0.0; p];
    linalg::cholesky(&log_likelihood(&start).curvature, p).ok_or(COLLINEAR)?;
    maximise(&start, &[], log_likelihood)
        .filter(|fit| is_summit(&log_likelihood(&fit.at), rows, p))
        .ok_or_else(|| separated("a combination of the predictors tells the choices apart without error"))
}

/// Whether a Newton step from here would leave every row's log odds as they are. The likelihood is concave: where it has no finite maximum, the
/// way up is a step of about 1 in the log odds, however flat it has become.
fn is_summit(here: &Local, rows: &[Row], p: usize) -> bool {
    let Some(l) = linalg::cholesky(&here.curvature, p) else { return false };
    let mut step = here.gradient.clone();
    linalg::solve(&l, p, &mut step);
    rows.iter().all(|row| dot(&row.x, &step).abs() < 0.01)
}

/// Adds a row's score and weight times x, xxᵀ.
pub(super) fn add_row(sum: &mut Local, row: &Row, residual: f64, weight: f64) {
    let p = row.x.len();
    for i in 0..p {
        sum.gradient[i] += residual * row.x[i];
        for j in 0..p {
            sum.curvature[i * p + j] += weight * row.x[i] * row.x[j];
        }
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// 1/(1 + e⁻ˣ), accurate in both tails.
pub(crate) fn logistic(x: f64) -> f64 {
    if x >= 0.0 {
        1.0 / (1.0 + (-x).exp())
    } else {
        let e = x.exp();
        e / (1.0 + e)
    }
}

/// ln(1 + eˣ).
pub(crate) fn softplus(x: f64) -> f64 {
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}
