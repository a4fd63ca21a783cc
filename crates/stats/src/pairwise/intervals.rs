//! Intervals of a scale, and tests of its differences, from observers.

use super::flips::scores;
use super::scale::{fit, positions};
use super::{Estimator, Observer, Scale, ScaleOptions, Wins, graph, pool, scale};
use crate::inference::{flip, holm};
use crate::normal;
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A scale with what its observers' differences do to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ScaleIntervals {
    /// The scale of all observers.
    pub scale: Scale,
    /// One interval a condition, in the scale's order.
    pub conditions: Vec<ConditionInterval>,
    /// One interval a pair of conditions: read significance here, not from overlaps above.
    pub differences: Vec<DifferenceInterval>,
    /// Confidence level.
    pub level: f64,
    /// Observers with choices.
    pub observers: usize,
    /// Random patterns of signs behind each p that is not exact.
    pub flips: usize,
    /// The seed that repeats them.
    pub seed: u64,
    /// Why an interval is missing; null where none is.
    pub note: Option<String>,
}

/// A condition's interval, in JOD.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ConditionInterval {
    /// Its name.
    pub condition: String,
    /// Position.
    pub jod: f64,
    /// Lower end; null where the observers give no interval.
    pub low: Option<f64>,
    /// Upper end, likewise.
    pub high: Option<f64>,
    /// Standard error from leaving out each observer in turn; null likewise.
    pub standard_error: Option<f64>,
}

/// The interval of a difference of two conditions, in JOD, and the test that there is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct DifferenceInterval {
    /// The condition subtracted from.
    pub a: String,
    /// The condition subtracted.
    pub b: String,
    /// a − b.
    pub jod: f64,
    /// Lower end; null where the observers give no interval.
    pub low: Option<f64>,
    /// Upper end, likewise.
    pub high: Option<f64>,
    /// Two-sided p of "no difference" by flipping the signs of observers' scores.
    pub p: f64,
    /// The same corrected by Holm's method for the number of pairs of conditions.
    pub p_holm: f64,
    /// The smallest p that so many observers, or so many random patterns of signs, can give.
    pub p_smallest: f64,
    /// Whether every pattern of signs was tried.
    pub p_exact: bool,
}

/// Scales the pooled choices; intervals and tests come from the observers, whatever the choices of one have in common.
///
/// An interval is estimate ± t × standard error with m − 1 degrees of freedom for m observers, the standard error from leaving out each
/// observer in turn (jackknife, Efron & Stein 1981), fitted with Jeffreys' prior, which is always finite. Where leaving out anybody changes
/// nothing there is no interval. A difference is tested by flipping the signs of observers' effective scores (Hemerik, Goeman & Finos 2020):
/// over all patterns up to [`EXACT_FLIPS_TO`](crate::inference::EXACT_FLIPS_TO) observers with a score, else over `flips` random ones;
/// deterministic for a seed.
///
/// Errors: those of [`scale`](fn@scale); fewer than two observers with choices; fewer than 1,000 flips; a level outside (0, 1).
pub fn observer_intervals(
    names: &[String],
    observers: &[Observer],
    options: ScaleOptions,
    flips: usize,
    level: f64,
    seed: u64,
) -> Result<ScaleIntervals> {
    StatsError::open_probability("level", level)?;
    if flips < 1000 {
        let rule = "must be at least 1000";
        return Err(StatsError::Invalid { name: "flips", value: flips as f64, rule });
    }
    let n = names.len();
    let answered: Vec<&Observer> =
        observers.iter().filter(|o| o.choices.iter().any(|c| c.times > 0)).collect();
    let all = pool(n, answered.iter().copied())?;
    let whole = scale(names, &all, options)?;
    if answered.len() < 2 {
        return Err(StatsError::TooFew { name: "observers", len: answered.len() as u64, needed: 2 });
    }
    let left_out = leave_one_out(&all, &answered, &whole, options)?;
    let mut note = left_out.is_none().then(|| DISCONNECTED.to_owned());
    let critical = normal::t_quantile(0.5 + 0.5 * level, answered.len() as f64 - 1.0);
    // Of a quantity read off the positions.
    let mut spread = |of: &dyn Fn(&[f64]) -> f64| {
        let values: Vec<f64> = left_out.as_ref()?.iter().map(|positions| of(positions)).collect();
        let error = jackknife(&values);
        if error.is_none() {
            note.get_or_insert_with(|| ALIKE.to_owned());
        }
        error
    };
    let ends = |middle: f64, error: Option<f64>| {
        (error.map(|e| middle - critical * e), error.map(|e| middle + critical * e))
    };
    let conditions = (0..n)
        .map(|i| {
            let standard_error = spread(&|positions| positions[i]);
            let (low, high) = ends(whole.jod[i], standard_error);
            ConditionInterval { condition: names[i].clone(), jod: whole.jod[i], low, high, standard_error }
        })
        .collect();
    let pairs: Vec<[usize; 2]> = (0..n).flat_map(|a| (a + 1..n).map(move |b| [a, b])).collect();
    let columns =
        pairs.iter().map(|pair| scores(&all, &answered, options, *pair)).collect::<Result<Vec<_>>>()?;
    let tests = flip(&columns, flips, seed);
    let corrected = holm(&tests.iter().map(|test| test.p).collect::<Vec<_>>())?;
    let differences = pairs
        .iter()
        .zip(tests.into_iter().zip(corrected))
        .map(|(&[a, b], (test, p_holm))| {
            let jod = whole.jod[a] - whole.jod[b];
            let (low, high) = ends(jod, spread(&|positions| positions[a] - positions[b]));
            DifferenceInterval {
                a: names[a].clone(),
                b: names[b].clone(),
                jod,
                low,
                high,
                p: test.p,
                p_holm,
                p_smallest: test.smallest,
                p_exact: test.exact,
            }
        })
        .collect();
    Ok(ScaleIntervals {
        conditions,
        differences,
        level,
        observers: answered.len(),
        flips,
        seed,
        note,
        scale: whole,
    })
}

const DISCONNECTED: &str =
    "No intervals: without one of the participants some conditions are compared with no other.";
const ALIKE: &str = "No interval where leaving out any one participant changes nothing: they chose alike, which tells their number and not how far \
     others would differ.";

/// Positions without each observer in turn, in JOD; `None` where some are then linked by no comparison.
fn leave_one_out(
    all: &Wins,
    observers: &[&Observer],
    whole: &Scale,
    options: ScaleOptions,
) -> Result<Option<Vec<Vec<f64>>>> {
    // From the whole's scale the rest's is a few Newton steps away.
    let start: Vec<f64> = whole.jod[1..].iter().map(|x| (x - whole.jod[0]) / options.model.jod()).collect();
    let mut positions_of = Vec::with_capacity(observers.len());
    for observer in observers {
        let rest = all.without(&pool(all.conditions(), [*observer])?);
        if graph::components(&rest).len() > 1 {
            return Ok(None);
        }
        let from = |start: &[f64]| fit(&rest, options.model, Estimator::Jeffreys, start);
        let found = from(&start).or_else(|_| from(&vec![0.0; start.len()]))?;
        positions_of.push(positions(&found.at, options.model, options.origin));
    }
    Ok(Some(positions_of))
}

/// The jackknife's standard error; `None` where the values agree but for rounding.
fn jackknife(values: &[f64]) -> Option<f64> {
    let m = values.len() as f64;
    let mean = values.iter().sum::<f64>() / m;
    let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
    let error = ((m - 1.0) / m * squares).sqrt();
    (error > 1e-7).then_some(error)
}
