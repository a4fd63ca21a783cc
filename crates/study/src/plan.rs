//! Who sees what in which order: the trial plan of a slot.
//!
//! A slot is a participant's place in the design. Its plan follows from the study and the slot alone. Slots 2k and 2k + 1
//! are mirror images: where one has the target on the left the other has it on the right, so that every pair is balanced
//! exactly whenever both are completed. A newcomer takes the lowest slot that no completed or active session holds.

use crate::adaptive::Running;
use crate::definition::{Block, Kind, StudyDefinition};
use crate::trials::{Shown, TrialKind, owned};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// What one participant is shown first; more may be decided from the answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrialPlan {
    /// Place in the design.
    pub slot: u32,
    /// The plan's seed (64 hex digits), shared by the two mirror slots.
    pub seed: String,
    /// Trials in the order shown.
    pub trials: Vec<Trial>,
    /// Whether answers will decide others.
    pub more: bool,
}

/// What is decided next for a session.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Decision {
    /// The trials that follow those decided before.
    pub trials: Vec<Trial>,
    /// Whether answers will decide others.
    pub more: bool,
}

/// One item with its conditions in their roles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// 0-based place in the session.
    pub trial_index: u32,
    /// How it asks, with its settings.
    #[serde(flatten)]
    pub trial: TrialKind,
    /// Block's id.
    pub block_id: String,
    /// 0-based place of the block in the study.
    pub block_index: u32,
    /// Item's id.
    pub item_id: String,
    /// 0-based place of the item in its block's file order.
    pub item_index: u32,
    /// How often the session has shown the item before.
    pub repeat: u32,
    /// Stills or animations.
    pub kind: Kind,
    /// What each role shows.
    #[serde(deserialize_with = "owned")]
    pub shown: Shown<'static>,
}

impl Trial {
    /// Whether this condition stands first: on the left, or in the first interval.
    pub fn is_first(&self, condition: &str) -> bool {
        let first = self.trial.rules().roles().first().and_then(|role| self.shown.get(role));
        first.is_some_and(|placed| placed.condition == condition)
    }
}

impl TrialPlan {
    /// The beginning of `slot`'s plan: blocks in file order, up to and with the first trial of an adaptive one. Items are shuffled within each
    /// block; the target comes first and second as evenly as the number of items allows: within every block (differing by at most one) and
    /// over the session (likewise).
    pub fn for_slot(study: &StudyDefinition, slot: u32) -> TrialPlan {
        let Decision { trials, more } = next_trials(study, slot, &[], &|_| None);
        TrialPlan { slot, seed: hex::encode(seed(study, slot)), trials, more }
    }
}

/// What follows the trials decided so far. `chose_target` says of a trial (by its index) whether its answer was the target; `None`: no answer
/// yet. A function of design, slot and answers alone, so that a reload or a restart changes nothing.
pub fn next_trials(
    study: &StudyDefinition,
    slot: u32,
    decided: &[Trial],
    chose_target: &dyn Fn(u32) -> Option<bool>,
) -> Decision {
    Procedures::default().next_trials(study, slot, decided, chose_target)
}

/// Procedures of one session's adaptive blocks, by block, with the answers that they have taken in: whoever decides trial after trial (a
/// simulation) need not replay them all each time.
#[derive(Clone, Debug, Default)]
pub struct Procedures(BTreeMap<usize, Running>);

impl Procedures {
    /// Those of a study's adaptive blocks before the first answer.
    pub fn of(study: &StudyDefinition) -> Procedures {
        let adaptive = study
            .blocks
            .iter()
            .enumerate()
            .filter_map(|(b, block)| Some((b, block, block.adaptive.as_ref()?)));
        Procedures(
            adaptive.filter_map(|(b, block, adaptive)| Some((b, adaptive.start(block).ok()?))).collect(),
        )
    }

    /// As [`next_trials`]; of the answers only those that have come since are looked at.
    pub fn next_trials(
        &mut self,
        study: &StudyDefinition,
        slot: u32,
        decided: &[Trial],
        chose_target: &dyn Fn(u32) -> Option<bool>,
    ) -> Decision {
        let fixed = fixed_blocks(study, slot);
        let mut next = Next { study, slot, decided, trials: Vec::new() };
        for (b, (block, fixed)) in study.blocks.iter().zip(fixed).enumerate() {
            let before: Vec<&Trial> =
                decided.iter().filter(|trial| trial.block_index as usize == b).collect();
            match &block.adaptive {
                None => {
                    fixed.into_iter().skip(before.len()).for_each(|(item, first)| next.push(b, item, first))
                }
                Some(adaptive) => {
                    // The settings were checked with the study file: an error would have been its.
                    let running = match self.0.entry(b) {
                        Entry::Occupied(running) => running.into_mut(),
                        Entry::Vacant(place) => match adaptive.start(block) {
                            Ok(running) => place.insert(running),
                            Err(_) => continue,
                        },
                    };
                    let unseen = before.get(running.answered()..).unwrap_or_default();
                    for chose in unseen.iter().map_while(|trial| chose_target(trial.trial_index)) {
                        running.answer(chose);
                    }
                    if running.answered() < before.len() {
                        return Decision { trials: next.trials, more: true };
                    }
                    if let Some(level) = running.level() {
                        next.push_level(b, level, &before);
                        return Decision { trials: next.trials, more: true };
                    }
                }
            }
        }
        Decision { trials: next.trials, more: false }
    }
}

/// The trials being decided.
struct Next<'a> {
    study: &'a StudyDefinition,
    slot: u32,
    decided: &'a [Trial],
    trials: Vec<Trial>,
}

impl Next<'_> {
    fn push(&mut self, block_index: usize, item_index: usize, target_first: bool) {
        let block = &self.study.blocks[block_index];
        let item = &block.items[item_index];
        let before = self.decided.iter().chain(&self.trials);
        let repeat = before.filter(|trial| trial.item_id == item.id).count() as u32;
        self.trials.push(Trial {
            trial_index: (self.decided.len() + self.trials.len()) as u32,
            trial: block.trial.clone(),
            block_id: block.id.clone(),
            block_index: block_index as u32,
            item_id: item.id.clone(),
            item_index: item_index as u32,
            repeat,
            kind: block.kind,
            shown: block.trial.rules().plan(&item.id, &block.target, block.other(), target_first),
        });
    }

    /// The next trial of an adaptive block: the least shown of the level's items, the target first in one of every two trials.
    fn push_level(&mut self, block_index: usize, level: f64, before: &[&Trial]) {
        let items = self.study.blocks[block_index].items.iter().enumerate();
        let shown = |index: usize| before.iter().filter(|trial| trial.item_index as usize == index).count();
        let of_level = items.filter(|(_, item)| item.level == Some(level)).map(|(index, _)| index);
        let Some(item_index) = of_level.min_by_key(|index| shown(*index)) else { return };
        let mut sides = ChaCha8Rng::from_seed(seed(self.study, self.slot));
        // Fixed blocks draw from the streams 0, 1 and 2.
        sides.set_stream(1000 + block_index as u64);
        let pair = before.len() / 2;
        let first_of_pair = (0..=pair).map(|_| below(&mut sides, 2) == 0).last().unwrap_or(true);
        let target_first = first_of_pair ^ (before.len() % 2 == 1) ^ (self.slot % 2 == 1);
        self.push(block_index, item_index, target_first);
    }
}

fn seed(study: &StudyDefinition, slot: u32) -> [u8; 32] {
    Sha256::digest(format!("kelir trial plan 1\n{}\n{}\n{}", study.id, study.seed, slot / 2)).into()
}

/// Items of each block in the order shown, each with whether the target comes first; nothing for adaptive blocks.
fn fixed_blocks(study: &StudyDefinition, slot: u32) -> Vec<Vec<(usize, bool)>> {
    let seed = seed(study, slot);
    let mirrored = slot % 2 == 1;
    let mut sides = ChaCha8Rng::from_seed(seed);
    let mut order = ChaCha8Rng::from_seed(seed);
    // The sides are shared by the two mirror slots, the order is each slot's own.
    order.set_stream(1 + u64::from(slot % 2));
    let mut extra_first = below(&mut sides, 2) == 0;
    let of_block = |block: &Block| {
        if block.adaptive.is_some() {
            return Vec::new();
        }
        let n = block.items.len();
        let mut target_first: Vec<bool> = (0..n / 2).flat_map(|_| [true, false]).collect();
        if n % 2 == 1 {
            // The odd ones out of odd blocks alternate over the session.
            target_first.push(extra_first);
            extra_first = !extra_first;
        }
        shuffle(&mut sides, &mut target_first);
        let mut items: Vec<usize> = (0..n).collect();
        shuffle(&mut order, &mut items);
        items.into_iter().map(|item| (item, target_first[item] != mirrored)).collect()
    };
    study.blocks.iter().map(of_block).collect()
}

/// The lowest slot that is not among `held`; `held` in any order.
pub fn lowest_free_slot(held: impl IntoIterator<Item = u32>) -> u32 {
    let held: std::collections::BTreeSet<u32> = held.into_iter().collect();
    (0..).zip(&held).find(|(slot, held)| slot != *held).map_or(held.len() as u32, |(slot, _)| slot)
}

/// Uniform in `0..n`, without modulo bias; n ≥ 1.
fn below(rng: &mut ChaCha8Rng, n: u32) -> u32 {
    let zone = u32::MAX - u32::MAX % n;
    loop {
        let x = rng.next_u32();
        if x < zone {
            return x % n;
        }
    }
}

/// Fisher–Yates.
fn shuffle<T>(rng: &mut ChaCha8Rng, items: &mut [T]) {
    for i in (1..items.len()).rev() {
        items.swap(i, below(rng, i as u32 + 1) as usize);
    }
}

#[cfg(test)]
mod tests;
