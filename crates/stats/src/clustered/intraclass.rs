//! Intraclass correlation of binary choices, and the warning that follows from it.

use super::{Cluster, answered};
use crate::betabinomial;
use crate::optimise::{Local, maximise};
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// How the intraclass correlation is estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IccEstimator {
    /// Fleiss & Cuzick (1979): 1 − Σ yᵢ(nᵢ − yᵢ)/nᵢ / ((N − m) p(1 − p)), with p the pooled proportion. With two trials each this is
    /// Fisher's pairwise correlation and, when not negative, the maximum-likelihood one.
    #[default]
    FleissCuzick,
    /// Analysis of variance: (MSB − MSW)/(MSB + (n₀ − 1) MSW) with n₀ = (N − Σnᵢ²/N)/(m − 1).
    Anova,
    /// Maximum likelihood of the beta-binomial; never negative.
    BetaBinomial,
}

/// How alike the choices of one participant are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Intraclass {
    /// Which estimator gave it.
    pub estimator: IccEstimator,
    /// Intraclass correlation, −1/(n − 1) to 1; 0 for independent trials.
    pub icc: f64,
    /// The proportion of choices of the target under that estimator.
    pub proportion: f64,
    /// Participants with at least one trial.
    pub participants: u64,
    /// Their trials.
    pub trials: u64,
    /// Variance inflation 1 + (Σnᵢ²/Σnᵢ − 1)·icc of the pooled proportion; not below 0.
    pub design_effect: f64,
}

/// The intraclass correlation of binary choices (participants × trials).
///
/// Participants without trials are left out. Errors: fewer than two participants; nobody with two trials; all choices the same, when
/// agreement within and between participants cannot be told apart. Sources: Ridout, Demétrio & Firth (1999), Biometrics 55, 137.
pub fn intraclass(clusters: &[Cluster], estimator: IccEstimator) -> Result<Intraclass> {
    let clusters = answered(clusters)?;
    let m = clusters.len() as f64;
    if clusters.len() < 2 {
        return Err(StatsError::TooFew { name: "clusters", len: clusters.len() as u64, needed: 2 });
    }
    let trials: u64 = clusters.iter().map(|c| c.trials).sum();
    let successes: u64 = clusters.iter().map(|c| c.successes).sum();
    let total = trials as f64;
    if trials == clusters.len() as u64 {
        return Err(StatsError::NoSolution {
            what: "the intraclass correlation",
            reason: "no participant has two trials",
        });
    }
    let pooled = successes as f64 / total;
    if successes == 0 || successes == trials {
        return Err(StatsError::ZeroVariance {
            name: "choices",
            len: trials,
            value: pooled,
            undefined: "the intraclass correlation",
        });
    }
    let squares: f64 = clusters.iter().map(|c| (c.trials as f64).powi(2)).sum();
    let within: f64 =
        clusters.iter().map(|c| c.successes as f64 * (c.trials - c.successes) as f64 / c.trials as f64).sum();
    let (icc, proportion) = match estimator {
        IccEstimator::FleissCuzick => (1.0 - within / ((total - m) * pooled * (1.0 - pooled)), pooled),
        IccEstimator::Anova => {
            let between: f64 = clusters
                .iter()
                .map(|c| c.trials as f64 * (c.successes as f64 / c.trials as f64 - pooled).powi(2))
                .sum();
            let (msb, msw) = (between / (m - 1.0), within / (total - m));
            let n0 = (total - squares / total) / (m - 1.0);
            ((msb - msw) / (msb + (n0 - 1.0) * msw), pooled)
        }
        IccEstimator::BetaBinomial => beta_binomial(&clusters, pooled)?,
    };
    Ok(Intraclass {
        estimator,
        icc,
        proportion,
        participants: clusters.len() as u64,
        trials,
        design_effect: (1.0 + (squares / total - 1.0) * icc).max(0.0),
    })
}

/// (icc, mean) of the beta-binomial by maximum likelihood. θ = icc/(1 − icc).
fn beta_binomial(clusters: &[Cluster], pooled: f64) -> Result<(f64, f64)> {
    if let Some(many) = clusters.iter().find(|c| c.trials > 1_000_000) {
        let rule = "must not exceed a million for the beta-binomial";
        return Err(StatsError::Invalid { name: "clusters.trials", value: many.trials as f64, rule });
    }
    if clusters.iter().all(|c| c.successes == 0 || c.successes == c.trials) {
        // Everybody is consistent: the likelihood rises to icc = 1, where each participant is one answer.
        let hits = clusters.iter().filter(|c| c.successes > 0).count();
        return Ok((1.0, hits as f64 / clusters.len() as f64));
    }
    let log_likelihood = |x: &[f64]| {
        let mut sum = Local { value: 0.0, gradient: vec![0.0; 2], curvature: vec![0.0; 4] };
        for c in clusters {
            let d = betabinomial::log_likelihood(c.successes, c.trials, x[0], x[1]);
            sum.value += d.value;
            sum.gradient[0] += d.p;
            sum.gradient[1] += d.theta;
            sum.curvature[0] -= d.p_p;
            sum.curvature[1] -= d.p_theta;
            sum.curvature[2] -= d.p_theta;
            sum.curvature[3] -= d.theta_theta;
        }
        sum
    };
    let best = maximise(&[pooled, 0.1], &[(1e-12, 1.0 - 1e-12), (0.0, 1e9)], log_likelihood)
        .ok_or(StatsError::NotConverged { what: "the beta-binomial fit" })?;
    Ok((best.at[1] / (1.0 + best.at[1]), best.at[0]))
}

/// A finding: a test that counts trials as independent was asked of data in which participants gave several.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct IndependenceWarning {
    /// Participants with at least one trial.
    pub participants: u64,
    /// Their trials.
    pub trials: u64,
    /// The Fleiss–Cuzick intraclass correlation, when it is defined.
    pub icc: Option<f64>,
    /// Variance inflation of the pooled proportion, when it is defined.
    pub design_effect: Option<f64>,
    /// trials / `design_effect`, never above `trials`: how many independent trials the data are worth.
    pub effective_trials: Option<f64>,
    /// One plain sentence for a report.
    pub message: String,
}

/// The warning due when a per-trial test (binomial, χ², t over trials) is used on these choices; `None` when nobody has two trials.
///
/// It is due whatever the estimate of the correlation: a small sample can't show that trials are independent.
pub fn independence_warning(clusters: &[Cluster]) -> Result<Option<IndependenceWarning>> {
    let clusters = answered(clusters)?;
    if clusters.iter().all(|c| c.trials < 2) {
        return Ok(None);
    }
    let found = intraclass(&clusters, IccEstimator::FleissCuzick).ok();
    let trials: u64 = clusters.iter().map(|c| c.trials).sum();
    let participants = clusters.len() as u64;
    // Answers that alternate more than chance would are no proof of more answers than there are.
    let effective = found.as_ref().map(|f| trials as f64 / f.design_effect.max(1.0));
    let mut message = format!(
        "This test counts {trials} trials as independent, but they are the answers of {participants} participants"
    );
    let worth = match (&found, effective) {
        (Some(f), _) if f.design_effect < 1.0 => format!(
            " (intraclass correlation {:.3}: one participant's answers alternate rather than repeat, which may be chance)",
            f.icc
        ),
        (Some(f), Some(n)) => {
            format!(" (intraclass correlation {:.3}): they are worth about {n:.0} independent trials", f.icc)
        }
        _ => String::new(),
    };
    message.push_str(&format!("{worth}. Use a test over participants."));
    Ok(Some(IndependenceWarning {
        participants,
        trials,
        icc: found.as_ref().map(|f| f.icc),
        design_effect: found.as_ref().map(|f| f.design_effect),
        effective_trials: effective,
        message,
    }))
}
