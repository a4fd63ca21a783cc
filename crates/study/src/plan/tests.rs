#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::definition::{Block, Completion, Condition, Item};
use crate::languages::Texts;
use kelir_fixtures as fixtures;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use std::collections::BTreeMap;

fn study(seed: u64, items: &[usize]) -> StudyDefinition {
    let condition = Condition::Rendered { technique: "pa".to_owned(), knobs: BTreeMap::new(), camera: None };
    let texts = vec!["…".to_owned()];
    StudyDefinition {
        language: "en".to_owned(),
        translations: BTreeMap::new(),
        id: "test".to_owned(),
        title: "Test".to_owned(),
        question: "Which?".to_owned(),
        seed,
        size: [64, 36],
        display: Default::default(),
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
                items_key: Default::default(),
                trial: TrialKind::TwoAlternative,
                adaptive: None,
                psychometric: None,
            })
            .collect(),
        screening: Default::default(),
        equivalence: None,
        primary: None,
        edition: 1,
        response: Default::default(),
        session: Default::default(),
    }
}

/// How often each pair had the target on the left, over some plans.
fn lefts<'a>(plans: impl IntoIterator<Item = &'a TrialPlan>) -> BTreeMap<String, (u32, u32)> {
    let mut lefts = BTreeMap::new();
    for trial in plans.into_iter().flat_map(|plan| &plan.trials) {
        let (left, all): &mut (u32, u32) = lefts.entry(trial.item_id.clone()).or_default();
        *left += u32::from(trial.is_first("pa"));
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
        prop_assert_eq!(plan.trials.len(), study.most_trials());
        prop_assert!(plan.trials.windows(2).all(|w| w[0].block_index <= w[1].block_index));
        let mut ids: Vec<_> = plan.trials.iter().map(|t| t.item_id.clone()).collect();
        ids.sort();
        ids.dedup();
        prop_assert_eq!(ids.len(), study.most_trials());
        for (i, trial) in plan.trials.iter().enumerate() {
            prop_assert_eq!(trial.trial_index as usize, i);
            let shown: Vec<_> = trial.shown.values().map(|placed| &*placed.condition).collect();
            prop_assert_eq!(shown, if trial.is_first("pa") { ["pa", "mc"] } else { ["mc", "pa"] });
        }
        let uneven = |block: Option<u32>| {
            let of = plan.trials.iter().filter(|t| block.is_none_or(|b| t.block_index == b));
            of.map(|t| if t.is_first("pa") { 1i64 } else { -1 }).sum::<i64>().abs()
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

/// A fixed block, an adaptive one over seven levels of two items each, and a fixed one again.
fn growing(procedure: &str, seed: u64) -> StudyDefinition {
    let fixed = |id: &str| {
        let items = fixtures::items((0..3).map(|i| format!("{id}{i}")), "a.toml");
        fixtures::block(id, &[("items", &items)])
    };
    let levels: Vec<String> =
        (0..14).map(|i| format!("{{ id = \"l{i}\", scene = \"a.toml\", level = {} }}", i / 2)).collect();
    let growing = [
        ("trial", "\"two-interval\""),
        ("items", &*format!("[{}]", levels.join(", "))),
        ("psychometric", r#"{ function = "logistic", direction = "rising", label = "l" }"#),
        ("adaptive", procedure),
    ];
    let blocks = [fixed("before"), fixtures::block("levels", &growing), fixed("after")];
    let text = fixtures::study(&[("seed", &seed.to_string())], blocks);
    StudyDefinition::parse("s.toml", &text).unwrap_or_else(|errors| panic!("{errors}"))
}

const STAIRCASE: &str = r#"{ procedure = "staircase", trials = 30, reversals = 6, down = 2 }"#;
const QUEST: &str = r#"{ procedure = "quest-plus", trials = 12 }"#;

/// Takes a study to its end: the answer to trial i is `answers[i]` (whether the target was chosen).
fn take(study: &StudyDefinition, slot: u32, answers: &[bool]) -> Vec<Trial> {
    let TrialPlan { mut trials, mut more, .. } = TrialPlan::for_slot(study, slot);
    let mut answered = 0;
    while more {
        answered += 1;
        let next =
            next_trials(study, slot, &trials, &|i| answers.get(i as usize).copied().filter(|_| i < answered));
        more = next.more;
        trials.extend(next.trials);
    }
    trials
}

proptest! {
    #![proptest_config(Config { cases: 60, ..config() })]

    #[test]
    fn a_growing_plan_is_a_function_of_slot_and_answers(
        seed in 0u64..1 << 53, slot in 0u32..1000, answers in prop::collection::vec(any::<bool>(), 40), cut in 0usize..40,
        quest in any::<bool>(),
    ) {
        let study = growing(if quest { QUEST } else { STAIRCASE }, seed);
        let trials = take(&study, slot, &answers);
        let levels: Vec<&Trial> = trials.iter().filter(|t| t.block_id == "levels").collect();
        prop_assert!(trials.iter().enumerate().all(|(i, t)| t.trial_index as usize == i));
        prop_assert!(trials.windows(2).all(|w| w[0].block_index <= w[1].block_index));
        prop_assert_eq!(trials.iter().filter(|t| t.block_id == "after").count(), 3);
        prop_assert!(trials.len() <= study.most_trials() && (!quest || levels.len() == 12));

        // A reload in the midst: what was decided stands, and what follows is the same.
        let cut = cut.min(trials.len());
        let next = next_trials(&study, slot, &trials[..cut], &|i| answers.get(i as usize).copied().filter(|_| (i as usize) < cut));
        for (again, first) in next.trials.iter().zip(&trials[cut..]) {
            prop_assert_eq!(again, first);
        }
        prop_assert!(!next.trials.is_empty() || cut == trials.len());

        // Steered: it begins at the easiest level and stays there only as long as the answers say so.
        let easiest = |t: &&&Trial| t.item_index >= 12;
        if !quest {
            prop_assert!(easiest(&&levels[0]));
        }
        // Both items of a level are shown in turn, and the target comes first in one of every two trials.
        for pair in levels.chunks_exact(2) {
            prop_assert!(pair[0].is_first("pa") != pair[1].is_first("pa"));
        }
        let mirror = take(&study, slot ^ 1, &answers);
        for (a, b) in levels.iter().zip(mirror.iter().filter(|t| t.block_id == "levels")) {
            prop_assert_eq!((&a.item_id, a.is_first("pa")), (&b.item_id, !b.is_first("pa")));
        }
        for (i, trial) in levels.iter().enumerate() {
            let before = levels[..i].iter().filter(|t| t.item_id == trial.item_id).count();
            prop_assert_eq!(trial.repeat as usize, before);
        }
    }
}

#[test]
fn a_staircase_over_levels_walks_as_levitt_wrote() {
    // Two down, one up from the easiest of seven levels, by 4, 2, then 1 level; worked out by hand.
    let study = growing(STAIRCASE, 1);
    let answers = [[true; 3].as_slice(), &[true, true, true, false, true, true, false, true]].concat();
    let mut answers = answers;
    answers.resize(40, true);
    let trials = take(&study, 0, &answers);
    let levels: Vec<u32> =
        trials.iter().filter(|t| t.block_id == "levels").map(|t| t.item_index / 2).collect();
    assert_eq!(levels[..9], [6, 6, 2, 2, 4, 4, 3, 4, 4]);
}
