//! All conditions on one axis, and how far the answers bear that out.

use super::LEVEL;
use crate::analysis::TOO_FEW_CONDITIONS;
use crate::answers::{Participant, compares, observers};
use crate::definition::{Block, Kind, StudyDefinition};
use kelir_stats::pairwise::{
    Observer, ObserverFit, ScaleIntervals, ScaleOptions, circular_triads, observer_intervals, odd_observers,
    pool,
};
use serde::Serialize;
use utoipa::ToSchema;

use super::words::count;

/// Above this many observers none is looked at alone: each costs a fit of all the others.
const MOST_SCREENED: usize = 2000;

/// Random patterns of signs of a test whose patterns are too many to try them all.
const FLIPS: usize = 9999;

/// How far observers contradict the one axis and themselves.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Consistency {
    /// Circular triads over all observers.
    pub triads: Triads,
    /// Observers whose choices the scale of all the others was asked to predict; 0 with fewer than three or with more than
    /// 2,000.
    pub observers: u64,
    /// Those whom it predicts far worse than the rest: to look at, not to exclude.
    pub odd: Vec<ObserverFit>,
}

/// Circular triads (a over b, b over c, c over a), summed over observers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Triads {
    /// Triads whose three pairs one observer answered with a majority each.
    pub triads: u64,
    /// Those that run in a circle; a coin toss makes a quarter of them circular.
    pub circular: u64,
    /// Mean of Kendall & Babington Smith's coefficient of consistence over the observers who answered every pair; 1: no
    /// circles. Null without such observers.
    pub consistence: Option<f64>,
}

/// The conditions' positions from all blocks but catch blocks.
///
/// # Errors
/// Why there is no scale, as a sentence.
pub(super) fn scale(
    study: &StudyDefinition,
    participants: &[&Participant],
) -> Result<(ScaleIntervals, Consistency), String> {
    let (names, observers) = observers(study, participants);
    if names.len() < 3 {
        return Err(TOO_FEW_CONDITIONS.to_owned());
    }
    let options = ScaleOptions::default();
    let found = observer_intervals(&names, &observers, options, FLIPS, LEVEL, study.seed)
        .map_err(|error| format!("No scale: {error}."))?;
    Ok((found, consistency(&names, &observers)))
}

/// What a scale's choices are of, in words: it is one of conditions, whatever was shown.
pub(super) fn pooled(study: &StudyDefinition) -> String {
    let compared: Vec<&Block> = study.blocks.iter().filter(|block| compares(block)).collect();
    let of_kind = |kind| compared.iter().filter(|b| b.kind == kind).map(|b| b.items.len()).sum::<usize>();
    let kinds: Vec<String> = [(of_kind(Kind::Still), "still"), (of_kind(Kind::Animation), "animation")]
        .into_iter()
        .filter(|(items, _)| *items > 0)
        .map(|(items, what)| count(items, what))
        .collect();
    let mut levels: Vec<f64> = compared.iter().flat_map(|b| &b.items).filter_map(|item| item.level).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    let levels = match levels.len() {
        0 => String::new(),
        n => format!(", at {}", count(n, "level")),
    };
    format!(
        "The scale takes the choices of {} together: pairs of {}{levels}; how conditions differ from one of these to another does not show in it.",
        count(compared.len(), "block"),
        kinds.join(" and ")
    )
}

fn consistency(names: &[String], observers: &[Observer]) -> Consistency {
    let (mut triads, mut circular, mut consistences) = (0, 0, Vec::new());
    for observer in observers {
        let Ok(wins) = pool(names.len(), [observer]) else { continue };
        let own = circular_triads(&wins);
        triads += own.triads;
        circular += own.circular;
        consistences.extend(own.consistence);
    }
    let mean =
        (!consistences.is_empty()).then(|| consistences.iter().sum::<f64>() / consistences.len() as f64);
    let fits = if observers.len() > MOST_SCREENED {
        Vec::new()
    } else {
        odd_observers(names, observers, ScaleOptions::default()).unwrap_or_default()
    };
    Consistency {
        triads: Triads { triads, circular, consistence: mean },
        observers: fits.iter().filter(|f| f.log_likelihood.is_some()).count() as u64,
        odd: fits.into_iter().filter(|f| f.odd).collect(),
    }
}
