//! Sides, order and speed: what besides the conditions went with the choices. Nobody planned these tests: they are to look at.

use super::choices::{ALPHA, LEVEL};
use crate::answers::{Given, Participant, blocks};
use crate::definition::{Block, StudyDefinition};
use kelir_stats::clustered::{Groups, WithinSlope, within_slope};
use kelir_stats::inference::{Flipped, binomial_test, holm, sign_flips};
use serde::Serialize;
use std::collections::HashMap;
use std::ops::Range;
use utoipa::ToSchema;

/// Random ways to deal choices out anew, and random patterns of signs.
const DEALS: usize = 1999;
/// An answer is an outlier this many interquartile ranges of the logarithm of its time beyond the quartiles.
pub const FENCES: f64 = 1.5;

/// What besides the conditions went with the choices.
#[derive(Clone, Debug, Default, Serialize, ToSchema)]
pub struct OrderReport {
    /// Whether what stood first was chosen more or less often than what stood second, over participants, all blocks together. Null without answers.
    pub first: Option<FirstTest>,
    /// Participants with a side of their own: exact binomial test, p corrected by Holm for all who were tested.
    pub leaning: Vec<Leaning>,
    /// Participants tested for a side of their own.
    pub tested: u64,
    /// The most trials any of them answered: with too few nobody's side can be shown.
    pub most_trials: u64,
    /// Whether choices agree more or less with those of most others, later in a block than earlier: slope of agreement (0 to 1) from a block's first
    /// trial to its last. Null where nothing tells.
    pub agreement: Option<WithinSlope>,
    /// Block by block.
    pub blocks: Vec<BlockOrder>,
}

/// A test of what stood first.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct FirstTest {
    /// Choices of what stood first.
    pub chosen: u64,
    /// Choices.
    pub trials: u64,
    /// Participants who made them.
    pub participants: u64,
    /// By flipping the signs of participants' differences.
    pub test: Flipped,
}

/// A participant who keeps to one side.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Leaning {
    /// Session's id.
    pub session_id: String,
    /// Choices of what stood first.
    pub first: u64,
    /// Choices.
    pub trials: u64,
    /// Exact binomial p against a half.
    pub p: f64,
    /// The same corrected by Holm's method for all who were tested.
    pub p_holm: f64,
}

/// Order and speed in one block.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct BlockOrder {
    /// Block's id.
    pub id: String,
    /// Slope of choosing the target (0 or 1) from the block's first trial to its last. Null where nothing tells.
    pub place: Option<WithinSlope>,
    /// Slope of choosing the target over the logarithm of the response time, for each tenth that it grows. Null likewise.
    pub speed: Option<WithinSlope>,
    /// Response times that are outliers; null with fewer than four.
    pub outliers: Option<Outliers>,
}

/// Response times beyond Tukey's fences on the logarithm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Outliers {
    /// Answers below this time are fast outliers, in ms.
    pub below_ms: f64,
    /// Answers above this time are slow outliers, in ms.
    pub above_ms: f64,
    /// Fast ones.
    pub fast: u64,
    /// Slow ones.
    pub slow: u64,
    /// Answers with a time.
    pub answers: u64,
}

/// Of all blocks but catch blocks; nothing without answers.
pub(super) fn of(study: &StudyDefinition, participants: &[&Participant]) -> Option<OrderReport> {
    let analysed: Vec<(&Block, Range<u32>)> = blocks(study).filter(|(block, _)| !block.catch).collect();
    let sides: Vec<(&Participant, u64, u64)> = participants
        .iter()
        .map(|participant| {
            let own = analysed.iter().flat_map(|(_, items)| participant.answers_to(items));
            let (first, all) = own.fold((0, 0), |(f, n), given| (f + u64::from(given.chose_first), n + 1));
            (*participant, first, all)
        })
        .filter(|(_, _, trials)| *trials > 0)
        .collect();
    if sides.is_empty() {
        return None;
    }
    let differences: Vec<f64> = sides.iter().map(|(_, first, n)| *first as f64 - 0.5 * *n as f64).collect();
    let first = sign_flips(&differences, DEALS, study.seed).ok().map(|test| FirstTest {
        chosen: sides.iter().map(|side| side.1).sum(),
        trials: sides.iter().map(|side| side.2).sum(),
        participants: sides.len() as u64,
        test,
    });
    Some(OrderReport {
        first,
        leaning: leaning(&sides),
        tested: sides.len() as u64,
        most_trials: sides.iter().map(|side| side.2).max().unwrap_or_default(),
        agreement: agreement(&analysed, participants, study.seed),
        blocks: analysed
            .iter()
            .map(|(block, items)| {
                let seen: Vec<&[Given]> = participants.iter().map(|p| p.answers_to(items)).collect();
                of_block(block, &seen, study.seed)
            })
            .collect(),
    })
}

fn leaning(sides: &[(&Participant, u64, u64)]) -> Vec<Leaning> {
    let p: Vec<f64> =
        sides.iter().map(|(_, first, n)| binomial_test(*first, *n, 0.5).map_or(1.0, |test| test.p)).collect();
    let corrected = holm(&p).unwrap_or_default();
    let all = sides.iter().zip(p.iter().zip(corrected));
    all.filter(|(_, (_, p_holm))| *p_holm < ALPHA)
        .map(|((participant, first, trials), (p, p_holm))| Leaning {
            session_id: participant.session_id.to_string(),
            first: *first,
            trials: *trials,
            p: *p,
            p_holm,
        })
        .collect()
}

/// Each answer with its place in the block, from 0 to 1 over the trials that the participant answered there; in the order of the trials.
fn placed(answers: &[Given]) -> Vec<(f64, Given)> {
    let mut answers = answers.to_vec();
    answers.sort_by_key(|given| given.trial_index);
    let last = answers.len().saturating_sub(1).max(1) as f64;
    answers.into_iter().enumerate().map(|(k, given)| (k as f64 / last, given)).collect()
}

fn target(given: &Given) -> f64 {
    f64::from(u8::from(given.chose_target))
}

fn of_block(block: &Block, seen: &[&[Given]], seed: u64) -> BlockOrder {
    // Where a procedure chose the trials, they come in no random order.
    let places: Vec<Groups> = match block.adaptive {
        None => {
            let own =
                |answers: &&[Given]| vec![placed(answers).iter().map(|(x, g)| (*x, target(g))).collect()];
            seen.iter().map(own).collect()
        }
        Some(_) => Vec::new(),
    };
    let timed = |given: &&Given| given.rt_ms.is_finite() && given.rt_ms > 0.0;
    // Where levels differ, what is hard is both slower and chosen otherwise.
    let speeds: Vec<Groups> = match block.psychometric {
        None => {
            let own = |answers: &&[Given]| {
                vec![answers.iter().filter(timed).map(|g| (g.rt_ms.ln() / 1.1f64.ln(), target(g))).collect()]
            };
            seen.iter().map(own).collect()
        }
        Some(_) => Vec::new(),
    };
    let times = seen.iter().flat_map(|answers| answers.iter().filter(timed).map(|g| g.rt_ms));
    BlockOrder {
        id: block.id.clone(),
        place: within_slope(&places, DEALS, LEVEL, seed).ok(),
        speed: within_slope(&speeds, DEALS, LEVEL, seed).ok(),
        outliers: Outliers::of(times.collect()),
    }
}

/// Whether agreement with the others grows or falls within blocks. A choice agrees by 1 where most of the others chose so in that pair, by ½ where as
/// many chose otherwise.
fn agreement(
    analysed: &[(&Block, Range<u32>)],
    participants: &[&Participant],
    seed: u64,
) -> Option<WithinSlope> {
    let fixed: Vec<&Range<u32>> =
        analysed.iter().filter(|(block, _)| block.adaptive.is_none()).map(|(_, items)| items).collect();
    let mut chosen = HashMap::<u32, (u64, u64)>::new();
    for given in participants.iter().flat_map(|p| fixed.iter().flat_map(|items| p.answers_to(items))) {
        let (hits, all) = chosen.entry(given.item).or_default();
        (*hits, *all) = (*hits + u64::from(given.chose_target), *all + 1);
    }
    let agrees = |given: &Given| {
        let (hits, all) = chosen[&given.item];
        let (for_it, others) = (hits - u64::from(given.chose_target), all - 1);
        let same = if given.chose_target { for_it } else { others - for_it };
        match (2 * same).cmp(&others) {
            std::cmp::Ordering::Greater => 1.0,
            std::cmp::Ordering::Equal => 0.5,
            std::cmp::Ordering::Less => 0.0,
        }
    };
    let people: Vec<Groups> = participants
        .iter()
        .map(|participant| {
            let group = |items: &&Range<u32>| {
                placed(participant.answers_to(items)).iter().map(|(x, given)| (*x, agrees(given))).collect()
            };
            fixed.iter().map(group).collect()
        })
        .collect();
    within_slope(&people, DEALS, LEVEL, seed).ok()
}

impl Outliers {
    fn of(mut times: Vec<f64>) -> Option<Outliers> {
        if times.len() < 4 {
            return None;
        }
        times.sort_by(f64::total_cmp);
        let logs: Vec<f64> = times.iter().map(|ms| ms.ln()).collect();
        let (q1, q3) = (super::quantile(&logs, 0.25)?, super::quantile(&logs, 0.75)?);
        let reach = FENCES * (q3 - q1);
        let (low, high) = (q1 - reach, q3 + reach);
        Some(Outliers {
            below_ms: low.exp(),
            above_ms: high.exp(),
            fast: logs.iter().filter(|x| **x < low).count() as u64,
            slow: logs.iter().filter(|x| **x > high).count() as u64,
            answers: times.len() as u64,
        })
    }
}

#[cfg(test)]
mod tests;
