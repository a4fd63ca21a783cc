#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use crate::answers::{Answers, Row};
use crate::definition::StudyDefinition;
use crate::report::{PsychometricReport, Report};
use kelir_fixtures as fixtures;
use kelir_stats::random::Random;

/// A block of seven or fewer levels whose psychometric function is described by `function`.
fn study(function: &str, levels: &[f64]) -> StudyDefinition {
    let items: Vec<String> = (0..)
        .zip(levels)
        .map(|(i, level): (u32, _)| format!("{{ id = \"p{i}\", scene = \"a.toml\", level = {level:?} }}"))
        .collect();
    let items = format!("[{}]", items.join(", "));
    let block = fixtures::block(
        "levels",
        &[("conditions", "[\"full\", \"few\"]"), ("target", "\"full\""), ("items", &items)],
    );
    let conditions = "{ full = { technique = \"pa\" }, few = { technique = \"mc\" } }";
    let text = fixtures::study(
        &[("seed", "5"), ("conditions", conditions)],
        [block, format!("[blocks.psychometric]\n{function}")],
    );
    StudyDefinition::parse("levels.toml", &text).unwrap()
}

const FALLING: &str = "function = \"gaussian\"\ndirection = \"falling\"\nlabel = \"triangles\"\nunit = \"log10\"\nthresholds = [0.75, 0.9]";

/// Participant i chooses the target at level k when `target(i, k)`.
fn report(
    study: &StudyDefinition,
    participants: usize,
    mut target: impl FnMut(usize, usize) -> bool,
) -> PsychometricReport {
    let block = &study.blocks[0];
    let mut answers = Answers::new(study);
    for i in 0..participants {
        let session_id = &format!("s{i:04}");
        for (k, pair) in block.items.iter().enumerate() {
            let sides = [block.target.as_str(), block.other()];
            answers.push(Row::choice(session_id, k as u32, &pair.id, sides, target(i, k), 500.0));
        }
    }
    Report::of(study, &answers.participants()).blocks[0].psychometric.clone().unwrap()
}

#[test]
fn the_golden_values_of_psignifit_come_through_the_study_file() {
    // N = 100 a level; psignifit 4.3 with x negated: threshold −3.183 [−3.331, −3.082], width 1.001, lapse 0.029.
    let levels = [2.48, 2.7, 3.0, 3.2, 3.5, 3.8];
    let correct = [96, 95, 84, 72, 58, 50];
    let found = report(&study(FALLING, &levels), 100, |i, k| i < correct[k]);
    let fit = found.fit.as_ref().unwrap();
    let rounded = [-fit.threshold.value, fit.width.value, fit.lapse.value].map(|x| format!("{x:.3}"));
    assert_eq!(rounded, ["-3.183", "1.001", "0.029"]);
    // psignifit reads both ends half a cell of its grid too low, −3.331 and −3.082; forty points lie over less than a level here.
    for (ours, theirs) in [(-fit.threshold.high, -3.331), (-fit.threshold.low, -3.082)] {
        assert!((0.002..0.5 / 39.0).contains(&(ours - theirs)), "{ours} {theirs}");
    }
    let shares: Vec<u64> = found.points.iter().map(|p| p.target.as_ref().unwrap().chosen).collect();
    assert_eq!(shares, correct.map(|c| c as u64));
    // The plot's curve falls, and passes 75% where the threshold at 75% says.
    assert!(fit.curve.windows(2).all(|w| w[0].level < w[1].level && w[0].share >= w[1].share));
    let [three_quarters, nine_tenths] = fit.at[..] else { panic!("two thresholds were asked for") };
    let crossing = fit.curve.windows(2).find(|w| w[0].share >= 0.75 && w[1].share < 0.75).unwrap();
    let level = three_quarters.level.unwrap();
    assert!(crossing[0].level <= level && level <= crossing[1].level);
    assert!(three_quarters.low.unwrap() < level && level < three_quarters.high.unwrap());
    assert!(nine_tenths.level.unwrap() < level, "more triangles, fewer right answers");
    assert!(fit.goodness.unwrap().p_simulated > 0.05);
    // Negative controls: another shape is another threshold, and the wrong direction shows no curve.
    let weibull = study(&FALLING.replace("gaussian", "weibull"), &levels);
    let other = report(&weibull, 100, |i, k| i < correct[k]).fit.unwrap();
    assert_ne!(format!("{:.3}", other.threshold.value), "3.183");
    let rising = study(&FALLING.replace("falling", "rising"), &levels);
    let wrong = report(&rising, 100, |i, k| i < correct[k]);
    assert!(wrong.fit.unwrap().goodness.unwrap().p_simulated < 0.05, "{:?}", wrong.notes);
}

#[test]
fn a_rising_block_gives_what_the_same_falling_one_gives() {
    let correct = [52, 61, 75, 88, 97];
    let up = [1.0, 2.0, 3.0, 4.0, 5.0];
    let down = up.map(|x| -x);
    let rising = report(&study(&FALLING.replace("falling", "rising"), &up), 100, |i, k| i < correct[k]);
    let falling = report(&study(FALLING, &down), 100, |i, k| i < correct[k]);
    let (rising, falling) = (rising.fit.unwrap(), falling.fit.unwrap());
    assert_eq!(rising.threshold.value, -falling.threshold.value);
    assert_eq!(rising.threshold.low, -falling.threshold.high);
    assert_eq!(rising.width, falling.width);
    assert_eq!(rising.at[0].low, falling.at[0].high.map(|x| -x));
    let by = |fit: &super::PsychometricFit| fit.threshold_by_participant.clone().unwrap();
    assert_eq!(by(&rising).bootstrap.low, -by(&falling).bootstrap.high);
}

#[test]
fn the_interval_of_resampled_participants_grows_when_one_answers_all_alike() {
    // Four pairs a level: answered independently, or four times the same, which is a quarter of the answers and twice the interval.
    let share = [0.52, 0.61, 0.75, 0.88, 0.97];
    let levels: Vec<f64> = (0..20).map(|k| f64::from(k / 4)).collect();
    let study = study(&FALLING.replace("falling", "rising"), &levels);
    let mut random = Random::new(3);
    let independent = report(&study, 80, |_, k| random.bernoulli(share[k / 4]));
    let mut random = Random::new(4);
    let mut last = false;
    let alike = report(&study, 80, |_, k| {
        if k % 4 == 0 {
            last = random.bernoulli(share[k / 4]);
        }
        last
    });
    let width = |report: &PsychometricReport| {
        let interval = report.fit.as_ref().unwrap().threshold_by_participant.clone().unwrap().bootstrap;
        interval.high - interval.low
    };
    assert!(width(&alike) > 1.5 * width(&independent), "{} {}", width(&alike), width(&independent));
    assert!(alike.notes.iter().any(|n| n.contains("resampled participants")), "{:?}", alike.notes);
}

#[test]
fn few_participants_are_said_to_tell_too_little() {
    let study = study(&FALLING.replace("falling", "rising"), &[1.0, 2.0, 3.0, 4.0, 5.0]);
    let told = |participants: usize| {
        // Right from a level of their own on.
        let found = report(&study, participants, |i, k| k > i % 3 || (i + k) % 2 == 0);
        assert!(found.fit.as_ref().unwrap().threshold_by_participant.is_some());
        found.notes.iter().any(|note| note.starts_with(&format!("Resamples of {participants} participants")))
    };
    assert_eq!([2, 4, 5, 12].map(told), [true, true, false, false]);
}

#[test]
fn no_answers_and_hopeless_answers_are_notes() {
    let study = study(FALLING, &[1.0, 2.0, 3.0]);
    let empty = report(&study, 0, |_, _| true);
    assert!(empty.fit.is_none() && empty.points.len() == 3 && !empty.notes.is_empty());
    assert!(empty.points.iter().all(|p| p.target.is_none()));
    for choice in [true, false] {
        let same = report(&study, 10, |_, _| choice);
        assert!(!same.notes.is_empty(), "{same:?}");
        assert!(serde_json::to_string(&same).unwrap().contains("\"threshold\""));
    }
}
