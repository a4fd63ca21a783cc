#![allow(clippy::unwrap_used)]

use super::*;
use crate::definition::{Block, Completion, Condition, Item, Texts};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use std::collections::BTreeMap;

fn study(seed: u64, items: &[usize]) -> StudyDefinition {
    let condition = Condition::Rendered { technique: "pa".to_owned(), knobs: BTreeMap::new(), camera: None };
    let texts = vec!["…".to_owned()];
    StudyDefinition {
        id: "test".to_owned(),
        title: "Test".to_owned(),
        question: "Which?".to_owned(),
        seed,
        size: [64, 36],
        surround: 0.2,
        estimated_minutes: 1,
        idle_minutes: 60,
        completion: Completion::default(),
        texts: Texts {
            welcome: texts.clone(),
            consent: texts.clone(),
            instructions: texts.clone(),
            debriefing: texts.clone(),
            thanks: texts,
        },
        conditions: [("pa".to_owned(), condition.clone()), ("mc".to_owned(), condition)].into(),
        blocks: items
            .iter()
            .enumerate()
            .map(|(b, n)| Block {
                id: format!("b{b}"),
                title: format!("Block {b}"),
                kind: Kind::Still,
                conditions: ["pa".to_owned(), "mc".to_owned()],
                target: "pa".to_owned(),
                items: (0..*n).map(|p| Item { id: format!("b{b}-p{p}"), scene: None, level: None }).collect(),
                catch: false,
                items_key: "items",
                psychometric: None,
            })
            .collect(),
        screening: Default::default(),
    }
}

/// How often each pair had the target on the left, over some plans.
fn lefts<'a>(plans: impl IntoIterator<Item = &'a TrialPlan>) -> BTreeMap<String, (u32, u32)> {
    let mut lefts = BTreeMap::new();
    for trial in plans.into_iter().flat_map(|plan| &plan.trials) {
        let (left, all): &mut (u32, u32) = lefts.entry(trial.item_id.clone()).or_default();
        *left += u32::from(trial.target_left);
        *all += 1;
    }
    lefts
}

fn exactly_balanced(plans: &[TrialPlan]) -> bool {
    lefts(plans).values().all(|(left, all)| 2 * left == *all)
}

fn config() -> Config {
    Config {
        cases: 200,
        rng_seed: RngSeed::Fixed(20_261_122),
        failure_persistence: None,
        ..Config::default()
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn a_plan_shows_every_pair_once_with_blocks_in_order_and_sides_even(
        seed in 0u64..1 << 53, slot in 0u32..100_000, items in prop::collection::vec(1usize..9, 1..6),
    ) {
        let study = study(seed, &items);
        let plan = TrialPlan::for_slot(&study, slot);
        prop_assert_eq!(plan.trials.len(), study.trial_count());
        prop_assert!(plan.trials.windows(2).all(|w| w[0].block_index <= w[1].block_index));
        let mut ids: Vec<_> = plan.trials.iter().map(|t| t.item_id.clone()).collect();
        ids.sort();
        ids.dedup();
        prop_assert_eq!(ids.len(), study.trial_count());
        for (i, trial) in plan.trials.iter().enumerate() {
            prop_assert_eq!(trial.trial_index as usize, i);
            prop_assert_eq!(trial.target_left, trial.left == "pa");
            prop_assert!(trial.left != trial.right);
        }
        let uneven = |block: Option<u32>| {
            let of = plan.trials.iter().filter(|t| block.is_none_or(|b| t.block_index == b));
            of.map(|t| if t.target_left { 1i64 } else { -1 }).sum::<i64>().abs()
        };
        prop_assert!(uneven(None) <= 1);
        for (block, n) in items.iter().enumerate() {
            prop_assert!(uneven(Some(block as u32)) <= (n % 2) as i64);
        }
    }

    #[test]
    fn mirror_slots_balance_every_pair_and_a_plan_is_reproducible(
        seed in 0u64..1 << 53, k in 0u32..50_000, items in prop::collection::vec(1usize..9, 1..6),
    ) {
        let study = study(seed, &items);
        let plans = [2 * k, 2 * k + 1].map(|slot| TrialPlan::for_slot(&study, slot));
        prop_assert!(exactly_balanced(&plans));
        prop_assert_eq!(&plans[0].seed, &plans[1].seed);
        prop_assert_eq!(&plans[1], &TrialPlan::for_slot(&study, 2 * k + 1));
        // Negative control: two plans that are no mirror images fail the same check.
        prop_assert!(!exactly_balanced(&[plans[0].clone(), plans[0].clone()]));
    }

    #[test]
    fn the_lowest_free_slot_is_free_and_nothing_below_it_is(held in prop::collection::vec(0u32..20, 0..30)) {
        let slot = lowest_free_slot(held.iter().copied());
        prop_assert!(!held.contains(&slot));
        prop_assert!((0..slot).all(|s| held.contains(&s)));
    }
}

#[test]
fn slots_seeds_and_orders_differ() {
    let study_a = study(1, &[6, 6]);
    let order = |study: &StudyDefinition, slot| -> Vec<String> {
        TrialPlan::for_slot(study, slot).trials.into_iter().map(|t| t.item_id).collect()
    };
    let orders: std::collections::BTreeSet<_> = (0..64).map(|slot| order(&study_a, slot)).collect();
    assert!(orders.len() > 60, "{} different orders of 64", orders.len());
    assert_ne!(order(&study_a, 0), order(&study(2, &[6, 6]), 0));
}

#[test]
fn sides_are_independent_of_the_pair_over_many_slots() {
    // Each pair of a two-pair block is left or right with probability ½; over 2,000 mirror pairs the first of the two slots
    // has it left 1000 ± 5 sd (sd = 22.4).
    let study = study(7, &[2, 2, 1]);
    let plans: Vec<_> = (0..2000).map(|k| TrialPlan::for_slot(&study, 2 * k)).collect();
    for (pair, (left, all)) in lefts(&plans) {
        assert_eq!(all, 2000);
        assert!((888..=1112).contains(&left), "{pair}: {left} of 2000");
    }
}
