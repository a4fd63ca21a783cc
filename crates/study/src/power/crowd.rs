//! Simulated people who take a study.

use super::design::{Design, Supposed, Truth};
use crate::answers::{Answers, Row, blocks};
use crate::definition::{Block, GUESS};
use crate::plan::{Procedures, Trial, TrialPlan};
use kelir_stats::pairwise::Model;
use kelir_stats::psychometric::Curve;
use kelir_stats::random::Random;
use std::borrow::Cow;

/// Standard deviation of the logarithm of response times.
const RT_SPREAD: f64 = 0.4;

/// Everybody who could take part in any simulated study.
pub(super) struct Crowd<'a> {
    pub(super) design: &'a Design,
    /// The plan of each slot.
    plans: Vec<TrialPlan>,
    /// For each pair of the study, by its place: its block's truth, and its level.
    items: Vec<(Option<&'a Supposed>, Option<f64>)>,
    /// The adaptive blocks' procedures before the first answer.
    procedures: Procedures,
    /// For each block, the place of its first item.
    first_items: Vec<usize>,
    /// How many `[[truth]]` there are.
    entries: usize,
}

/// One observer's own deviation from a truth.
#[derive(Default)]
struct Own {
    /// Probability, or threshold.
    value: f64,
    /// Quality of each of the study's conditions.
    qualities: Vec<f64>,
}

/// The number of a simulated participant.
pub(super) fn index(session_id: &str) -> u32 {
    session_id.parse().unwrap_or(u32::MAX)
}

impl<'a> Crowd<'a> {
    pub(super) fn new(design: &'a Design) -> Crowd<'a> {
        let study = &design.study;
        let most = design.participants.last().copied().unwrap_or(0);
        let items: Vec<_> = blocks(study)
            .zip(&design.truths)
            .flat_map(|((block, _), truth)| block.items.iter().map(move |pair| (truth.as_ref(), pair.level)))
            .collect();
        let entries = design.truths.iter().flatten().map(|t| t.entry + 1).max().unwrap_or(0);
        Crowd {
            design,
            plans: (0..most).map(|slot| TrialPlan::for_slot(study, slot)).collect(),
            items,
            procedures: Procedures::of(study),
            first_items: blocks(study).map(|(_, items)| items.start as usize).collect(),
            entries,
        }
    }

    /// The answers of one simulated study with the most participants; those of a smaller one are the first of them. One after the other
    /// they take the lowest slot that nobody completed, as newcomers do.
    pub(super) fn take(&self, run: u64) -> Answers {
        let study = &self.design.study;
        let mut answers = Answers::new(study);
        let seed = Random::stream(self.design.seed, run).next_u64();
        let mut slot = 0;
        for person in 0..self.plans.len() {
            let mut random = Random::stream(seed, person as u64);
            let finished = self.answer(&mut random, &format!("{person:06}"), slot, &mut answers);
            slot += usize::from(finished);
        }
        answers
    }

    /// One person's answers to a slot's plan; whether they finished.
    fn answer(&self, random: &mut Random, session_id: &str, slot: usize, answers: &mut Answers) -> bool {
        let (study, people) = (&self.design.study, &self.design.observers);
        let plan = &self.plans[slot];
        let careless = random.bernoulli(people.careless);
        let stays = !random.bernoulli(people.dropout);
        let last = random.below(study.most_trials());
        let own = self.own(random);
        let median = if careless { people.careless_rt_ms } else { people.rt_median_ms };
        let most = if stays { usize::MAX } else { last };
        let (mut trials, mut more) = (Cow::Borrowed(&plan.trials), plan.more);
        let mut procedures = self.procedures.clone();
        let mut chose = Vec::new();
        while chose.len() < most {
            if chose.len() == trials.len() {
                if !more {
                    break;
                }
                let given = |trial: u32| chose.get(trial as usize).copied();
                let next = procedures.next_trials(study, slot as u32, &trials, &given);
                more = next.more;
                trials.to_mut().extend(next.trials);
                continue;
            }
            let trial = &trials[chose.len()];
            let chance = self.chance_in(trial, careless, &own);
            let chose_target = random.bernoulli(chance);
            let rt_ms = median * (RT_SPREAD * random.normal()).exp();
            let chose_first =
                chose_target == trial.is_first(&study.blocks[trial.block_index as usize].target);
            if let Some(observation) = trial.trial.rules().chose(&trial.shown, chose_first, rt_ms) {
                answers.push(Row {
                    session_id,
                    trial_index: trial.trial_index,
                    observation,
                    received_us: None,
                });
            }
            chose.push(chose_target);
        }
        stays
    }

    /// Probability that this observer chooses the target in a trial.
    fn chance_in(&self, trial: &Trial, careless: bool, own: &[Own]) -> f64 {
        let block = trial.block_index as usize;
        let (supposed, level) = self.items[self.first_items[block] + trial.item_index as usize];
        match supposed {
            _ if careless => 0.5,
            None => 1.0 - self.design.observers.catch_errors,
            Some(supposed) => {
                let chance = self.chance(supposed, block, level, &own[supposed.entry]);
                (1.0 - supposed.lapse) * chance + 0.5 * supposed.lapse
            }
        }
    }

    /// What is this observer's own, by entry of the design.
    fn own(&self, random: &mut Random) -> Vec<Own> {
        let mut own: Vec<Own> = (0..self.entries).map(|_| Own::default()).collect();
        let mut known = vec![false; self.entries];
        for supposed in self.design.truths.iter().flatten() {
            if std::mem::replace(&mut known[supposed.entry], true) {
                continue;
            }
            own[supposed.entry] = match &supposed.truth {
                Truth::Preference { probability, icc } => {
                    Own { value: random.beta(*probability, *icc), ..Own::default() }
                }
                Truth::Quality { jod, observer_sd } => Own {
                    qualities: self
                        .design
                        .study
                        .conditions
                        .keys()
                        .map(|name| jod.get(name).copied().unwrap_or(0.0) + observer_sd * random.normal())
                        .collect(),
                    ..Own::default()
                },
                Truth::Threshold { threshold, threshold_sd, .. } => {
                    Own { value: threshold + threshold_sd * random.normal(), ..Own::default() }
                }
            };
        }
        own
    }

    /// An observer's probability of choosing the target, without lapses.
    fn chance(&self, supposed: &Supposed, block: usize, level: Option<f64>, own: &Own) -> f64 {
        let block = &self.design.study.blocks[block];
        match &supposed.truth {
            Truth::Preference { .. } => own.value,
            Truth::Quality { .. } => {
                let place = |name: &str| self.design.study.conditions.keys().position(|known| known == name);
                let quality = |name| place(name).map_or(0.0, |place| own.qualities[place]);
                Model::Thurstone.probability(quality(&block.target) - quality(block.other()))
            }
            Truth::Threshold { width, .. } => at_level(block, level, own.value, *width),
        }
    }
}

/// The probability with which observers who answer a block with care choose its target, by item, lapses included: over their own normal deviations
/// as a sum where there is no closed form. `None` for a catch block, and for an adaptive one, whose levels the answers choose.
pub(super) fn chances(design: &Design, block: usize) -> Option<Vec<f64>> {
    let supposed = design.truths.get(block)?.as_ref()?;
    let of_study = design.study.blocks.get(block).filter(|block| block.adaptive.is_none())?;
    let lapsing = |chance: f64| (1.0 - supposed.lapse) * chance + 0.5 * supposed.lapse;
    let (mut shares, mut weights) = (vec![0.0; of_study.items.len()], 0.0);
    for step in -60..=60 {
        let z = f64::from(step) / 10.0;
        let weight = (-0.5 * z * z).exp();
        for (pair, mean) in of_study.items.iter().zip(&mut shares) {
            let chance = match &supposed.truth {
                Truth::Preference { probability, .. } => *probability,
                Truth::Quality { jod, observer_sd } => {
                    // Two deviations, of target and other.
                    let difference = jod.get(&of_study.target)? - jod.get(of_study.other())?;
                    Model::Thurstone.probability(difference + 2f64.sqrt() * observer_sd * z)
                }
                Truth::Threshold { threshold, width, threshold_sd } => {
                    at_level(of_study, pair.level, threshold + threshold_sd * z, *width)
                }
            };
            *mean += weight * lapsing(chance);
        }
        weights += weight;
    }
    Some(shares.into_iter().map(|share| share / weights).collect())
}

/// The block's psychometric function without lapses at a pair's level; guessing where there is none.
fn at_level(block: &Block, level: Option<f64>, threshold: f64, width: f64) -> f64 {
    let Some((asked, level)) = block.psychometric.as_ref().zip(level) else { return GUESS };
    let sign = asked.direction.sign();
    let (sigmoid, threshold) = (asked.function, sign * threshold);
    Curve { sigmoid, threshold, width, guess: GUESS, lapse: 0.0, eta: 0.0 }.proportion(sign * level)
}
