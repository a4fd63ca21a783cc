//! A block's psychometric function: how the share of target choices depends on the pairs' level.

use super::choices::{LEVEL, Proportion, REPLICATES};
use crate::answers::Given;
use crate::definition::{Block, Direction, GUESS, Psychometric};
use kelir_stats::clustered::{Bootstrap, Cluster};
use kelir_stats::psychometric::{
    Curve, GoodnessOfFit, Level, ParameterPosterior, Posterior, ResampledThreshold, Scaling, Task,
    goodness_of_fit, posterior, resampled_threshold,
};
use serde::Serialize;
use std::ops::Range;
use utoipa::ToSchema;

/// Observers simulated for the goodness of fit.
const SIMULATIONS: usize = 1000;
/// From so many participants on resampling them holds what it promises (`kelir bench coverage`).
const MANY: usize = 5;
/// Points of the curve that is drawn.
const CURVE_POINTS: usize = 121;

/// A block's psychometric function with its data, everything in the levels of the study file.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct PsychometricReport {
    /// What was asked for: shape, direction, label and unit of the level.
    pub asked: Psychometric,
    /// Guess rate, given by the task: ½ with two pictures.
    pub guess: f64,
    /// Target choices at each level, levels rising.
    pub points: Vec<LevelPoint>,
    /// The fitted curve; null where there are too few answers.
    pub fit: Option<PsychometricFit>,
    /// Why there is no curve, or what a reader must not conclude from it.
    pub notes: Vec<String>,
}

/// The choices at one level.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct LevelPoint {
    /// The level.
    pub level: f64,
    /// Share of target choices; null without answers.
    pub target: Option<Proportion>,
}

/// A fitted psychometric function.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct PsychometricFit {
    /// Level at which the curve is halfway between guessing and lapsing (F = ½, unscaled), where the posterior is highest.
    pub threshold: Parameter,
    /// From F = .05 to F = .95, in levels.
    pub width: Parameter,
    /// Lapse rate.
    pub lapse: Parameter,
    /// Overdispersion η: η² is the correlation of two answers at one level; 0 is binomial.
    pub eta: Parameter,
    /// The threshold by maximum likelihood, with an interval from resampled participants; null with fewer than two.
    pub threshold_by_participant: Option<ResampledThreshold>,
    /// Levels at the shares asked for.
    pub at: Vec<ThresholdAt>,
    /// Deviance of the maximum-likelihood curve without overdispersion, and how large it would be by chance.
    pub goodness: Option<Goodness>,
    /// Points of the curve where the posterior is highest, from a little below the lowest level to a little above the highest.
    pub curve: Vec<CurvePoint>,
}

/// A parameter of the curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Parameter {
    /// Where the posterior density is highest.
    pub value: f64,
    /// Lower end of the 95% posterior interval, each point's mass spread over its cell (psignifit 4.3 reads both ends half a cell lower).
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Whether the data do not bound it: mass lies on the edge of the prior's range.
    pub on_edge: bool,
}

/// The level at which the target's share reaches a given value, guesses and lapses included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct ThresholdAt {
    /// The share of target choices.
    pub share: f64,
    /// Its level on the curve where the posterior is highest; null where that one never reaches it.
    pub level: Option<f64>,
    /// Lower end of the 95% posterior interval; null where it is beyond every level.
    pub low: Option<f64>,
    /// Upper end, likewise.
    pub high: Option<f64>,
}

/// Does the curve hold the data?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Goodness {
    /// Twice the ln likelihood missed against a free share at each level.
    pub deviance: f64,
    /// Levels − parameters; null when nothing is left over.
    pub df: Option<u64>,
    /// P(χ² ≥ deviance): asymptotic.
    pub p_asymptotic: Option<f64>,
    /// Share of simulated observers with at least this deviance.
    pub p_simulated: f64,
    /// How many were simulated.
    pub simulations: usize,
}

/// One point of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct CurvePoint {
    /// The level.
    pub level: f64,
    /// The share of target choices.
    pub share: f64,
}

/// The block's psychometric function, if its file asks for one; `places`: of its pairs; `seen`: each participant's answers to it.
pub(super) fn of(
    block: &Block,
    places: &Range<u32>,
    seen: &[&[Given]],
    seed: u64,
) -> Option<PsychometricReport> {
    let asked = block.psychometric.as_ref()?;
    let sign = asked.direction.sign();
    let xs: Vec<f64> = block.items.iter().filter_map(|pair| pair.level).map(|level| sign * level).collect();
    let level = |given: &Given| {
        let x = *xs.get((given.item - places.start) as usize)?;
        Some(Level { x, correct: u64::from(given.chose_target), trials: 1 })
    };
    let answered = seen.iter().filter(|answers| !answers.is_empty());
    let people: Vec<Vec<Level>> =
        answered.map(|answers| answers.iter().filter_map(level).collect()).collect();
    Some(judge(asked, &xs, &people, block.adaptive.is_some(), seed))
}

fn judge(
    asked: &Psychometric,
    xs: &[f64],
    people: &[Vec<Level>],
    adaptive: bool,
    seed: u64,
) -> PsychometricReport {
    let sign = asked.direction.sign();
    let mut levels: Vec<Level> = xs.iter().map(|&x| Level { x, correct: 0, trials: 0 }).collect();
    levels.sort_by(|a, b| a.x.total_cmp(&b.x));
    levels.dedup_by(|a, b| a.x == b.x);
    for answer in people.iter().flatten() {
        if let Some(level) = levels.iter_mut().find(|l| l.x == answer.x) {
            level.correct += answer.correct;
            level.trials += answer.trials;
        }
    }
    let mut notes = Vec::new();
    let fit = match fit(asked, &levels, people, adaptive, seed, &mut notes) {
        Ok(fit) => Some(fit),
        Err(error) => {
            notes.push(format!("No psychometric function: {error}."));
            None
        }
    };
    let mut points: Vec<LevelPoint> = levels
        .iter()
        .map(|l| LevelPoint { level: sign * l.x, target: Proportion::of(&at_level(people, l.x)) })
        .collect();
    points.sort_by(|a, b| a.level.total_cmp(&b.level));
    PsychometricReport { asked: asked.clone(), guess: GUESS, points, fit, notes }
}

/// Each participant's answers at a level.
fn at_level(people: &[Vec<Level>], x: f64) -> Vec<Cluster> {
    let of = |own: &Vec<Level>| {
        let there = || own.iter().filter(|l| l.x == x);
        Cluster { successes: there().map(|l| l.correct).sum(), trials: there().map(|l| l.trials).sum() }
    };
    people.iter().map(of).collect()
}

fn fit(
    asked: &Psychometric,
    levels: &[Level],
    people: &[Vec<Level>],
    adaptive: bool,
    seed: u64,
    notes: &mut Vec<String>,
) -> Result<PsychometricFit, kelir_stats::StatsError> {
    let task = Task { sigmoid: asked.function, guess: GUESS, lapse: asked.lapse, overdispersion: true };
    let found = posterior(levels, &task, LEVEL, &asked.thresholds)?;
    let plain = Task { overdispersion: false, ..task };
    let goodness = goodness_of_fit(levels, &plain, SIMULATIONS, seed).ok().map(Goodness::of);
    if found.threshold.on_edge || found.width.on_edge {
        notes.push(
            "The levels do not show the whole curve: threshold or width is not bounded by the data."
                .to_owned(),
        );
    }
    if goodness.is_some_and(|g| g.p_simulated < 0.05) {
        notes.push("The curve misses the data by more than chance would (deviance): trust no threshold of it without a look at the plot.".to_owned());
    }
    if adaptive {
        notes.push(
            "A procedure chose the levels from the answers. The fitted curve takes account of that, a single level's share does not: it is \
             drawn towards the share that the procedure looks for."
                .to_owned(),
        );
    }
    let threshold_by_participant = match resampled_threshold(people, &plain, REPLICATES, LEVEL, seed) {
        Ok(found) => {
            notes.extend(bounded(&found));
            notes.extend(few(people.len()));
            Some(found)
        }
        Err(error) => {
            notes.push(format!("No interval of the threshold from resampled participants: {error}."));
            None
        }
    };
    if people.iter().any(|own| own.len() > 1) {
        let instead = match &threshold_by_participant {
            Some(_) => ": the threshold's interval from resampled participants does not",
            None => "",
        };
        notes.push(format!(
            "The posterior takes the answers at different levels as independent, although each participant gave several{instead}."
        ));
    }
    Ok(PsychometricFit::of(asked, levels, &found, goodness, threshold_by_participant))
}

/// What resamples that did not show the curve make of the threshold's interval.
fn bounded(found: &ResampledThreshold) -> Option<String> {
    let (all, edge) = (found.bootstrap.replicates, found.at_bound);
    (edge > 0).then(|| {
        format!(
            "In {edge} of {all} resamples of participants the curve ended on the edge of the range that is searched: their answers did not bound it, and \
             the threshold's interval from resampled participants is at least as wide as it says."
        )
    })
}

/// What resamples of few participants make of it.
fn few(participants: usize) -> Option<String> {
    (participants < MANY).then(|| {
        format!(
            "Resamples of {participants} participants tell too little of others: the threshold's interval from resampled participants holds the truth less often than \
             {:.0}% of the time.",
            100.0 * LEVEL
        )
    })
}

impl Goodness {
    fn of(found: GoodnessOfFit) -> Goodness {
        Goodness {
            deviance: found.fit.deviance,
            df: found.df,
            p_asymptotic: found.p_asymptotic,
            p_simulated: found.p_simulated,
            simulations: found.simulations,
        }
    }
}

impl PsychometricFit {
    /// From the fit along rising x = ±level back to levels.
    fn of(
        asked: &Psychometric,
        levels: &[Level],
        found: &Posterior,
        goodness: Option<Goodness>,
        by_participant: Option<ResampledThreshold>,
    ) -> PsychometricFit {
        let falling = asked.direction == Direction::Falling;
        let map = &found.map;
        let upright = |value: f64, p: &ParameterPosterior| Parameter {
            value,
            low: p.low_centred,
            high: p.high_centred,
            on_edge: p.on_edge,
        };
        let mut threshold = upright(map.threshold, &found.threshold);
        let mut by_participant = by_participant;
        if falling {
            threshold = Parameter {
                value: -threshold.value,
                low: -threshold.high,
                high: -threshold.low,
                ..threshold
            };
            by_participant = by_participant.map(|found| {
                let b = found.bootstrap;
                let bootstrap = Bootstrap { estimate: -b.estimate, low: -b.high, high: -b.low, ..b };
                ResampledThreshold { bootstrap, ..found }
            });
        }
        let at = found
            .thresholds
            .iter()
            .map(|t| {
                let level = map.threshold_at(t.proportion, Scaling::Scaled).ok();
                let (level, low, high) = if falling {
                    (level.map(|x| -x), t.high.map(|x| -x), t.low.map(|x| -x))
                } else {
                    (level, t.low, t.high)
                };
                ThresholdAt { share: t.proportion, level, low, high }
            })
            .collect();
        PsychometricFit {
            threshold,
            width: upright(map.width, &found.width),
            lapse: upright(map.lapse, &found.lapse),
            eta: upright(map.eta, &found.eta),
            threshold_by_participant: by_participant,
            at,
            goodness,
            curve: curve(map, levels, asked.direction.sign()),
        }
    }
}

/// Points of the curve over all levels and a twentieth of their range on either side, levels rising.
fn curve(map: &Curve, levels: &[Level], sign: f64) -> Vec<CurvePoint> {
    let xs = || levels.iter().map(|l| l.x);
    let (low, high) = (xs().fold(f64::INFINITY, f64::min), xs().fold(f64::NEG_INFINITY, f64::max));
    let margin = 0.05 * (high - low);
    let step = (high - low + 2.0 * margin) / (CURVE_POINTS - 1) as f64;
    let point = |i: usize| {
        let x = low - margin + step * i as f64;
        CurvePoint { level: sign * x, share: map.proportion(x) }
    };
    let mut points: Vec<CurvePoint> = (0..CURVE_POINTS).map(point).collect();
    points.sort_by(|a, b| a.level.total_cmp(&b.level));
    points
}

#[cfg(test)]
mod tests;
