//! Who sees what in which order: the trial plan of a slot.
//!
//! A slot is a participant's place in the design. Its plan follows from the study and the slot alone. Slots 2k and 2k + 1
//! are mirror images: where one has the target on the left the other has it on the right, so that every pair is balanced
//! exactly whenever both are completed. A newcomer takes the lowest slot that no completed or active session holds.

use crate::definition::{Kind, StudyDefinition, hex};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use utoipa::ToSchema;

/// What one participant sees.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct TrialPlan {
    /// Place in the design.
    pub slot: u32,
    /// The plan's seed (64 hex digits), shared by the two mirror slots.
    pub seed: String,
    /// Trials in the order shown.
    pub trials: Vec<Trial>,
}

/// One pair with its sides decided.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Trial {
    /// 0-based place in the session.
    pub trial_index: u32,
    /// Block's id.
    pub block_id: String,
    /// 0-based place of the block in the study.
    pub block_index: u32,
    /// Item's id.
    pub item_id: String,
    /// 0-based place of the item in its block's file order.
    #[serde(alias = "pair_index")]
    pub item_index: u32,
    /// Stills or animations.
    pub kind: Kind,
    /// Condition on the left.
    pub left: String,
    /// Condition on the right.
    pub right: String,
    /// Whether the block's target is on the left.
    pub target_left: bool,
}

impl TrialPlan {
    /// The plan of `slot`: blocks in file order, pairs shuffled within each, the target left and right as evenly as the
    /// number of pairs allows: within every block (differing by at most one) and over the session (likewise).
    pub fn for_slot(study: &StudyDefinition, slot: u32) -> TrialPlan {
        let seed = Sha256::digest(format!("kelir trial plan 1\n{}\n{}\n{}", study.id, study.seed, slot / 2));
        let mirrored = slot % 2 == 1;
        let mut sides = ChaCha8Rng::from_seed(seed.into());
        let mut order = ChaCha8Rng::from_seed(seed.into());
        // The sides are shared by the two mirror slots, the order is each slot's own.
        order.set_stream(1 + u64::from(slot % 2));

        let mut extra_left = below(&mut sides, 2) == 0;
        let mut trials = Vec::with_capacity(study.trial_count());
        for (block_index, block) in study.blocks.iter().enumerate() {
            let n = block.items.len();
            let mut target_left: Vec<bool> = (0..n / 2).flat_map(|_| [true, false]).collect();
            if n % 2 == 1 {
                // The odd ones out of odd blocks alternate over the session.
                target_left.push(extra_left);
                extra_left = !extra_left;
            }
            shuffle(&mut sides, &mut target_left);
            let mut items: Vec<usize> = (0..n).collect();
            shuffle(&mut order, &mut items);
            for item_index in items {
                let target_left = target_left[item_index] != mirrored;
                let (target, other) = (block.target.clone(), block.other().to_owned());
                let (left, right) = if target_left { (target, other) } else { (other, target) };
                trials.push(Trial {
                    trial_index: trials.len() as u32,
                    block_id: block.id.clone(),
                    block_index: block_index as u32,
                    item_id: block.items[item_index].id.clone(),
                    item_index: item_index as u32,
                    kind: block.kind,
                    left,
                    right,
                    target_left,
                });
            }
        }
        TrialPlan { slot, seed: hex(&seed), trials }
    }
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
