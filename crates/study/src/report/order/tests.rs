#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::answers::{Answers, Row};
use kelir_fixtures as fixtures;

const ITEMS: [&str; 12] = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l"];

/// `people` answer twelve items in file order: whether the target stood first, whether the first was chosen, and the time in ms.
fn judged(people: usize, given: impl Fn(usize, usize) -> (bool, bool, f64)) -> OrderReport {
    let block = fixtures::block("stills", &[("items", &fixtures::items(ITEMS, "a.toml"))]);
    let study = StudyDefinition::parse("s.toml", &fixtures::study(&[("seed", "11")], [block])).unwrap();
    let [target, other] = [&study.blocks[0].target, study.blocks[0].other()];
    let mut answers = Answers::new(&study);
    for person in 0..people {
        for (k, item) in ITEMS.iter().enumerate() {
            let (target_first, first, rt_ms) = given(person, k);
            let sides = if target_first { [target, other] } else { [other, target] };
            answers.push(Row::choice(&format!("p{person:02}"), k as u32, item, sides, first, rt_ms));
        }
    }
    of(&study, &answers.participants()).unwrap()
}

#[test]
fn who_keeps_to_one_side_is_named() {
    // The first chooses what stands first each time, everybody else in half of the trials.
    let found = judged(3, |person, k| (k % 2 == 0, person == 0 || k % 4 < 2, 500.0));
    let [one] = &found.leaning[..] else { panic!("{found:?}") };
    assert_eq!((&*one.session_id, one.first, one.trials), ("p00", 12, 12));
    // R 4.2.2: binom.test(12, 12)$p.value = 2^-11, times the three who were tested.
    let close = |ours: f64, theirs: f64| (ours / theirs - 1.0).abs() < 1e-12;
    assert!(close(one.p, 2f64.powi(-11)) && close(one.p_holm, 3.0 * 2f64.powi(-11)), "{one:?}");
    let first = found.first.as_ref().unwrap();
    assert_eq!((first.chosen, first.trials, first.participants), (24, 36, 3));
    // One of three differs from a half: of both signs of one score each is as large.
    assert_eq!((first.test.p, first.test.exact), (1.0, true));
    // Control: nobody keeps to one side.
    assert!(judged(3, |_, k| (k % 2 == 0, k % 4 < 2, 500.0)).leaning.is_empty());
}

#[test]
fn what_changes_over_a_block_is_found_and_nothing_else() {
    // The target is chosen in the second half alone, wherever it stands; two of ten disagree at the end with the rest.
    let found = judged(10, |person, k| {
        let target = k >= 6 && !(person < 2 && k >= 10);
        let target_first = (person + k) % 2 == 0;
        (target_first, target == target_first, 500.0)
    });
    let place = found.blocks[0].place.as_ref().unwrap();
    assert!(place.slope > 0.5 && place.p == place.p_smallest, "{place:?}");
    let agreement = found.agreement.as_ref().unwrap();
    assert!(agreement.slope < 0.0 && agreement.p < 0.05, "{agreement:?}");
    assert_eq!((agreement.participants, agreement.observations), (10, 120));
    assert!(found.blocks[0].speed.is_none(), "times are all the same");
    // Control: choices that alternate go with nothing.
    let even = judged(10, |_, k| (k % 2 == 0, k % 4 < 2, 500.0));
    assert!(even.blocks[0].place.as_ref().unwrap().p > 0.3, "{even:?}");
    assert!(even.agreement.is_some_and(|slope| slope.slope == 0.0 && slope.p == 1.0));
}

#[test]
fn slow_choices_and_outliers_are_told() {
    // Of the target they take twice as long; one answer takes a minute, one a millisecond.
    let found = judged(8, |person, k| {
        let target = (person + k / 2) % 2 == 0;
        let ms = if target { 1000.0 } else { 500.0 } + (person + k) as f64;
        let ms = match (person, k) {
            (0, 0) => 60_000.0,
            (1, 1) => 1.0,
            _ => ms,
        };
        (k % 2 == 0, target == (k % 2 == 0), ms)
    });
    let speed = found.blocks[0].speed.as_ref().unwrap();
    assert!(speed.slope > 0.0 && speed.p < 0.05, "{speed:?}");
    let outliers = found.blocks[0].outliers.unwrap();
    assert_eq!((outliers.fast, outliers.slow, outliers.answers), (1, 1, 96));
    // The quartiles are near 500 and 1000 ms: the fences near 500/2^1.5 and 1000·2^1.5.
    assert!((outliers.below_ms / (500.0 / 2f64.powf(1.5)) - 1.0).abs() < 0.05, "{outliers:?}");
    assert!((outliers.above_ms / (1000.0 * 2f64.powf(1.5)) - 1.0).abs() < 0.05, "{outliers:?}");
}
