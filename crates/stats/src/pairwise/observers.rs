//! Leave-one-observer-out: how likely are one observer's choices on the scale of all the others?

use super::scale::fit;
use super::{Estimator, Observer, ScaleOptions, graph, pool, scale};
use crate::clustered::quantile;
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// One observer against the scale of the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ObserverFit {
    /// Who.
    pub id: String,
    /// Their choices.
    pub choices: u64,
    /// Mean ln likelihood of a choice on the others' scale; ln ½ = −0.693 for guessing. `None` when the observer has no choices or the
    /// others' comparisons fall apart.
    pub log_likelihood: Option<f64>,
    /// The same, less its expectation, in standard deviations, if the observer chose as the others' scale says: far below −3 is odd.
    pub z: Option<f64>,
    /// How far below the first quartile of all observers' `log_likelihood`, in interquartile ranges; 0 above it (Perez-Ortiz & Mantiuk 2017).
    /// `None` also where that range is 0.
    pub distance: Option<f64>,
    /// `distance` > 1.5 (Tukey's fence), or z < −3 where there is no distance: look at this observer. Not a reason to exclude by itself; a preregistered rule is.
    pub odd: bool,
}

/// Screens observers by how well the scale of all the others predicts their choices.
///
/// Scales without a finite maximum are fitted with Jeffreys' prior. Errors: those of [`scale`](fn@scale); fewer than three observers.
pub fn odd_observers(
    names: &[String],
    observers: &[Observer],
    options: ScaleOptions,
) -> Result<Vec<ObserverFit>> {
    let n = names.len();
    if observers.len() < 3 {
        return Err(StatsError::TooFew { name: "observers", len: observers.len() as u64, needed: 3 });
    }
    let all = pool(n, observers)?;
    let model = options.model;
    let whole = scale(names, &all, ScaleOptions { estimator: Estimator::Jeffreys, ..options })?;
    let start: Vec<f64> = whole.jod[1..].iter().map(|x| (x - whole.jod[0]) / model.jod()).collect();

    let mut fits = Vec::with_capacity(observers.len());
    for observer in observers {
        let own = pool(n, [observer])?;
        let choices = own.total();
        let others = all.without(&own);
        let estimator = match graph::unbeaten(&others) {
            None if options.estimator != Estimator::Jeffreys => Estimator::MaximumLikelihood,
            _ => Estimator::Jeffreys,
        };
        let usable = choices > 0 && graph::components(&others).len() == 1;
        let found = if usable { fit(&others, model, estimator, &start).ok() } else { None };
        let scores = found.map(|found| {
            let at = |i: usize| if i == 0 { 0.0 } else { found.at[i - 1] };
            let (mut sum, mut expected, mut variance) = (0.0, 0.0, 0.0);
            for pair in own.pairs() {
                let (won, lost) = model.link(at(pair.i) - at(pair.j)).ln;
                let p = won.exp();
                let term = |k: f64, ln: f64| if k > 0.0 { k * ln } else { 0.0 };
                sum += term(pair.wins, won) + term(pair.losses, lost);
                let trials = pair.wins + pair.losses;
                expected += trials * (term(p, won) + term(1.0 - p, lost));
                if p > 0.0 && p < 1.0 {
                    variance += trials * p * (1.0 - p) * (won - lost).powi(2);
                }
            }
            let z = if variance > 0.0 { (sum - expected) / variance.sqrt() } else { 0.0 };
            (sum / choices as f64, z)
        });
        fits.push(ObserverFit {
            id: observer.id.clone(),
            choices,
            log_likelihood: scores.map(|s| s.0),
            z: scores.map(|s| s.1),
            distance: None,
            odd: false,
        });
    }

    let mut sorted: Vec<f64> = fits.iter().filter_map(|f| f.log_likelihood).collect();
    sorted.sort_by(f64::total_cmp);
    let (first, third) = (quantile(&sorted, 0.25), quantile(&sorted, 0.75));
    let range = third - first;
    // Where half of all observers choose alike but for rounding, quartiles make no fence, and an observer's own z has to say it.
    let fence = range > 1e-9 * first.abs();
    for fit in &mut fits {
        fit.distance = fit.log_likelihood.filter(|_| fence).map(|l| (first - l).max(0.0) / range);
        fit.odd = match fit.distance {
            Some(distance) => distance > 1.5,
            None => fit.z.is_some_and(|z| z < -3.0),
        };
    }
    Ok(fits)
}
