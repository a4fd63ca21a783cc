//! Does the curve hold the data?

use super::fit::{deviance, ml_bounds, penalised, search};
use super::{Curve, Fit, Level, Levels, Task, fit};
use crate::normal;
use crate::optimise::maximise;
use crate::random::Random;
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The deviance of a fit and how large it would be by chance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct GoodnessOfFit {
    /// The maximum-likelihood fit.
    pub fit: Fit,
    /// Levels − parameters estimated; `None` when nothing is left over.
    pub df: Option<u64>,
    /// P(χ² ≥ deviance): asymptotic, too small with few trials a level. `None` without degrees of freedom or with overdispersion, which
    /// would explain the excess away.
    pub p_asymptotic: Option<f64>,
    /// Share of simulated observers, each fitted like the real one, with at least this deviance: (1 + count)/(1 + simulations).
    pub p_simulated: f64,
    /// Observers simulated from the fitted curve.
    pub simulations: usize,
    /// The seed that repeats them.
    pub seed: u64,
}

/// Fits the curve and compares its deviance with that of `simulations` observers simulated from it, refitted each (Wichmann & Hill 2001, but
/// with the refit). Deterministic for a seed. Errors: those of [`fit`](fn@fit); fewer than 100 simulations.
pub fn goodness_of_fit(
    levels: &[Level],
    task: &Task,
    simulations: usize,
    seed: u64,
) -> Result<GoodnessOfFit> {
    if simulations < 100 {
        let rule = "must be at least 100";
        return Err(StatsError::Invalid { name: "simulations", value: simulations as f64, rule });
    }
    let found = fit(levels, task)?;
    let levels = Levels::new(levels)?;
    let bounds = ml_bounds(&levels, task);
    let start = found.curve.parameters();
    let mut larger = 0u64;
    for index in 0..simulations {
        let mut random = Random::stream(seed, index as u64);
        let simulated: Vec<Level> = levels
            .levels
            .iter()
            .map(|l| {
                let psi = random.beta(found.curve.proportion(l.x), found.curve.eta.powi(2));
                Level { correct: random.binomial(l.trials, psi), ..*l }
            })
            .collect();
        let refit = maximise(&start, &bounds, |at| penalised(&simulated, task, at)).or_else(|| {
            let simulated = Levels { levels: simulated.clone(), ..levels };
            search(&simulated, task, &bounds).ok()
        });
        // A refit that does not converge counts against the curve's rejection.
        let d = refit.map_or(f64::INFINITY, |m| deviance(&simulated, &Curve::from_parameters(task, &m.at)));
        larger += u64::from(d >= found.deviance);
    }
    let estimated = bounds.iter().filter(|(low, high)| low < high).count();
    let df = levels.levels.len().checked_sub(estimated).filter(|df| *df > 0).map(|df| df as u64);
    let asymptotic = df.filter(|_| !task.overdispersion);
    Ok(GoodnessOfFit {
        df,
        p_asymptotic: asymptotic.map(|df| normal::chi_squared_sf(found.deviance, df as f64)),
        p_simulated: (1 + larger) as f64 / (1 + simulations) as f64,
        fit: found,
        simulations,
        seed,
    })
}
