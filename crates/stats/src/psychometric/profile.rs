//! Profile-likelihood intervals of threshold and width.

use super::fit::{critical, describe, ml_bounds, penalised, search};
use super::likelihood::PARAMETERS;
use super::{Fit, Level, Levels, Task};
use crate::optimise::maximise;
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The fit with likelihood intervals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ProfileIntervals {
    /// The maximum.
    pub fit: Fit,
    /// Confidence level.
    pub level: f64,
    /// Of the threshold.
    pub threshold: ProfileInterval,
    /// Of the width.
    pub width: ProfileInterval,
}

/// All values whose likelihood, the other parameters at their best, is within χ²₁'s quantile of the maximum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ProfileInterval {
    /// Lower end; `None` where the data don't bound it within the range searched by [`fit`](fn@super::fit).
    pub low: Option<f64>,
    /// Upper end, likewise.
    pub high: Option<f64>,
}

/// Fits as [`fit`](fn@super::fit) does and adds profile-likelihood intervals. Errors: those of the fit; a level outside (0, 1).
pub fn profile_intervals(levels: &[Level], task: &Task, level: f64) -> Result<ProfileIntervals> {
    StatsError::open_probability("level", level)?;
    task.check()?;
    let levels = Levels::new(levels)?;
    let bounds = ml_bounds(&levels, task);
    let best = search(&levels, task, &bounds)?;
    let drop = 0.5 * critical(level).powi(2);

    let end = |parameter: usize, towards: f64| -> Option<f64> {
        let mut warm = best.at.clone();
        // How far above the cut the profile is at x.
        let mut above = |x: f64| {
            let mut frozen = bounds;
            frozen[parameter] = (x, x);
            let mut start = warm.clone();
            start[parameter] = x;
            let found = maximise(&start, &frozen, |at| penalised(&levels.levels, task, at));
            found.map_or(f64::NEG_INFINITY, |found| {
                warm = found.at;
                found.value - best.value + drop
            })
        };
        let edge = if towards < 0.0 { bounds[parameter].0 } else { bounds[parameter].1 };
        let mut inside = best.at[parameter];
        let mut reach = 0.02 * levels.spread();
        let mut outside = loop {
            let next = inside + towards * reach;
            let beyond = (edge - next) * towards <= 0.0;
            let next = if beyond { edge } else { next };
            if above(next) < 0.0 {
                break next;
            }
            if beyond {
                return None;
            }
            inside = next;
            reach *= 1.6;
        };
        for _ in 0..100 {
            let middle = 0.5 * (inside + outside);
            if middle == inside || middle == outside {
                break;
            }
            if above(middle) >= 0.0 {
                inside = middle
            } else {
                outside = middle
            }
            if (inside - outside).abs() <= 1e-12 * levels.spread() {
                break;
            }
        }
        Some(0.5 * (inside + outside))
    };
    let interval = |parameter| ProfileInterval { low: end(parameter, -1.0), high: end(parameter, 1.0) };
    const { assert!(PARAMETERS == 4) };
    Ok(ProfileIntervals {
        threshold: interval(0),
        width: interval(1),
        fit: describe(&levels, task, &bounds, &best),
        level,
    })
}
