#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use kelir_stats::psychometric::{BeliefGrid, Curve, Sigmoid, Task};
use kelir_stats::random::Random;
use proptest::prelude::*;

fn rule(track: Track) -> StaircaseRule {
    StaircaseRule {
        track,
        start: 3.0,
        steps: vec![0.8, 0.4, 0.1],
        lowest: -10.0,
        highest: 10.0,
        reversals: 12,
        trials: 400,
    }
}

/// An observer of a yes–no task, P(correct) = F(x).
fn observer(threshold: f64, guess: f64, lapse: f64) -> Curve {
    Curve { sigmoid: Sigmoid::Logistic, threshold, width: 3.0, guess, lapse, eta: 0.0 }
}

#[test]
fn a_staircase_walks_as_levitt_wrote() {
    // Two down, one up; steps .8 until the first reversal, .4 until the second, then .1.
    let mut staircase = Staircase::new(rule(Track::Transformed { down: 2 })).unwrap();
    let mut shown = Vec::new();
    for correct in [true, true, true, true, false, true, false, true, true, false] {
        shown.push(staircase.stimulus().unwrap());
        staircase.answer(correct);
    }
    shown.push(staircase.stimulus().unwrap());
    let expected = [3.0, 3.0, 2.2, 2.2, 1.4, 1.8, 1.8, 2.2, 2.2, 2.1, 2.2];
    assert!(shown.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{shown:?}");
    let turns: Vec<String> = staircase.reversals().iter().map(|x| format!("{x:.1}")).collect();
    assert_eq!(["1.4", "2.2", "2.1"].to_vec(), turns);
    assert_eq!(10, staircase.trials());
    assert_eq!(None, staircase.estimate().filter(|e| e.reversals < 2));
}

#[test]
fn staircases_converge_where_theory_says() {
    let tracks = [
        (Track::Transformed { down: 1 }, 0.5),
        (Track::Transformed { down: 2 }, 0.5f64.sqrt()),
        (Track::Transformed { down: 3 }, 0.5f64.cbrt()),
        (Track::Weighted { target: 0.75 }, 0.75),
        (Track::Weighted { target: 0.9 }, 0.9),
    ];
    let curve = observer(0.5, 0.0, 0.0);
    for (track, p) in tracks {
        assert!((track.converges_at() - p).abs() < 1e-15);
        let mut sum = 0.0;
        let runs = 300;
        for run in 0..runs {
            let mut random = Random::stream(21, run);
            let long = StaircaseRule {
                steps: vec![0.8, 0.4, 0.2, 0.04],
                reversals: 80,
                trials: 4000,
                ..rule(track)
            };
            let mut staircase = Staircase::new(long).unwrap();
            while let Some(x) = staircase.stimulus() {
                staircase.answer(random.bernoulli(curve.proportion(x)));
            }
            sum += staircase.estimate().unwrap().threshold;
        }
        let reached = curve.proportion(sum / runs as f64);
        // The mean of reversals is off by up to half a step, here .007 of the proportion.
        assert!((reached - p).abs() < 0.015, "{track:?} settles at {reached}");
    }
}

#[test]
fn a_staircases_intervals_cover_also_lapsing_observers() {
    // 500 observers with two alternatives, thresholds of their own, every third lapsing on 5% of trials; three down, one up.
    let track = Track::Transformed { down: 3 };
    let plan = StaircaseRule { steps: vec![1.6, 0.8, 0.4], reversals: 400, trials: 120, ..rule(track) };
    let task = Task { sigmoid: Sigmoid::Logistic, ..Task::default() };
    let (mut hits, mut lapsing_hits, mut lapsing, mut halved) = (0u32, 0u32, 0u32, 0u32);
    let observers = 500u32;
    for index in 0..observers {
        let mut random = Random::stream(33, u64::from(index));
        let lapses = index % 3 == 0;
        let truth = observer(-1.5 + 3.0 * random.uniform(), 0.5, if lapses { 0.05 } else { 0.0 });
        let mut staircase = Staircase::new(plan.clone()).unwrap();
        while let Some(x) = staircase.stimulus() {
            staircase.answer(random.bernoulli(truth.proportion(x)));
        }
        assert_eq!(staircase.levels().iter().map(|l| l.trials).sum::<u64>(), 120);
        let found = staircase.posterior(&task, 0.95).unwrap();
        let (middle, t) = (found.mean.threshold, found.threshold);
        let inside = |low: f64, high: f64| low <= truth.threshold && truth.threshold <= high;
        let hit = inside(t.low_centred, t.high_centred);
        hits += u32::from(hit);
        lapsing += u32::from(lapses);
        lapsing_hits += u32::from(lapses && hit);
        halved += u32::from(inside(0.5 * (t.low_centred + middle), 0.5 * (t.high_centred + middle)));
    }
    let share = |n: u32, of: u32| f64::from(n) / f64::from(of);
    assert!((0.92..=0.99).contains(&share(hits, observers)), "covers {hits} of {observers}");
    assert!(share(lapsing_hits, lapsing) > 0.88, "covers {lapsing_hits} of {lapsing} lapsing observers");
    // The negative control.
    assert!(share(halved, observers) < 0.8, "half the interval covers {halved} of {observers}");
}

#[test]
fn a_staircase_stays_within_its_stimuli_and_ends() {
    let mut staircase =
        Staircase::new(StaircaseRule { lowest: 0.0, trials: 50, ..rule(Track::Transformed { down: 1 }) })
            .unwrap();
    replay(&mut staircase, [true; 80]);
    assert_eq!((None, 50, None), (staircase.stimulus(), staircase.trials(), staircase.estimate()));
    let mut twice =
        Staircase::new(StaircaseRule { reversals: 1, ..rule(Track::Weighted { target: 0.75 }) }).unwrap();
    replay(&mut twice, [true, false, true, true]);
    assert_eq!((2, 1), (twice.trials(), twice.reversals().len()));
}

#[test]
fn rules_that_cannot_work_are_refused_by_key() {
    let good = rule(Track::Transformed { down: 2 });
    let refused = |rule: StaircaseRule| Staircase::new(rule).unwrap_err().to_string();
    assert!(refused(rule(Track::Transformed { down: 0 })).contains("down"));
    assert!(refused(rule(Track::Weighted { target: 1.0 })).contains("target"));
    assert!(refused(StaircaseRule { steps: vec![], ..good.clone() }).contains("steps"));
    assert!(refused(StaircaseRule { steps: vec![0.1, f64::NAN], ..good.clone() }).contains("steps[1]"));
    assert!(refused(StaircaseRule { start: 11.0, ..good.clone() }).contains("start"));
    assert!(refused(StaircaseRule { lowest: 20.0, ..good.clone() }).contains("lowest"));
    assert!(refused(StaircaseRule { reversals: 0, ..good.clone() }).contains("reversals"));
    assert!(refused(StaircaseRule { trials: 0, ..good }).contains("trials"));
    assert!(QuestPlus::new(QuestPlusRule { trials: 0, ..quest_rule() }).is_err());
    assert!(QuestPlus::new(QuestPlusRule { precise_enough: Some(f64::NAN), ..quest_rule() }).is_err());
}

fn axis(low: f64, high: f64, n: usize) -> Vec<f64> {
    (0..n).map(|i| low + (high - low) * i as f64 / (n - 1) as f64).collect()
}

fn quest_rule() -> QuestPlusRule {
    QuestPlusRule {
        grid: BeliefGrid {
            sigmoid: Sigmoid::Logistic,
            guess: 0.5,
            stimuli: axis(-4.0, 6.0, 21),
            thresholds: axis(-3.0, 3.0, 49),
            widths: vec![1.0, 1.7, 3.0, 5.0],
            lapses: vec![0.0, 0.02, 0.05, 0.1],
        },
        trials: 80,
        precise_enough: None,
    }
}

#[test]
fn quest_plus_intervals_cover_also_lapsing_observers() {
    // 600 observers, thresholds over the middle of the grid, every third lapsing on 5% of trials. A posterior interval covers .95 on average over
    // its prior; observers drawn a little differently may move that by a few hundredths.
    let (mut hits, mut lapsing_hits, mut lapsing, mut halved, mut error) = (0u32, 0u32, 0u32, 0u32, 0.0);
    let observers = 600;
    let start = QuestPlus::new(quest_rule()).unwrap();
    for index in 0..observers {
        let mut random = Random::stream(31, index);
        let lapses = index % 3 == 0;
        let truth = observer(-1.5 + 3.0 * random.uniform(), 0.5, if lapses { 0.05 } else { 0.01 });
        let mut quest = start.clone();
        while let Some(x) = quest.stimulus() {
            quest.answer(random.bernoulli(truth.proportion(x)));
        }
        let e = quest.threshold(0.95).unwrap();
        let inside = |low: f64, high: f64| low <= truth.threshold && truth.threshold <= high;
        hits += u32::from(inside(e.low, e.high));
        lapsing += u32::from(lapses);
        lapsing_hits += u32::from(lapses && inside(e.low, e.high));
        halved += u32::from(inside(0.5 * (e.low + e.median), 0.5 * (e.high + e.median)));
        error += (e.mean - truth.threshold) / observers as f64;
    }
    let share = |n: u32, of: u32| f64::from(n) / f64::from(of);
    let covers = share(hits, observers as u32);
    assert!((0.92..=0.985).contains(&covers), "covers {covers}");
    assert!(share(lapsing_hits, lapsing) > 0.90, "covers {lapsing_hits} of {lapsing} lapsing observers");
    assert!(share(halved, observers as u32) < 0.8, "half the interval covers {halved}");
    assert!(error.abs() < 0.1, "mean error {error}");
}

#[test]
fn quest_plus_beats_a_fixed_stimulus_and_stops_when_precise() {
    let truth = observer(0.7, 0.5, 0.02);
    let rule = QuestPlusRule { precise_enough: Some(0.35), trials: 1000, ..quest_rule() };
    let mut quest = QuestPlus::new(rule).unwrap();
    let mut random = Random::new(4);
    while let Some(x) = quest.stimulus() {
        quest.answer(random.bernoulli(truth.proportion(x)));
    }
    let trials = quest.trials();
    assert!((20..400).contains(&trials), "{trials}");
    let found = quest.threshold(0.95).unwrap();
    assert!(found.standard_deviation < 0.35 && found.low < 0.7 && 0.7 < found.high, "{found:?}");
    // As many answers to the easiest stimulus say nothing.
    let mut idle = kelir_stats::psychometric::Belief::new(quest_rule().grid).unwrap();
    for _ in 0..trials {
        idle.update(20, random.bernoulli(truth.proportion(6.0))).unwrap();
    }
    assert!(idle.threshold(0.95).unwrap().standard_deviation > 1.0);
    assert!(
        !quest.contradicted()
            && quest.width(0.95).unwrap().mean > 1.0
            && quest.lapse(0.95).unwrap().mean < 0.1
    );
    assert!((quest.curve().threshold - found.mean).abs() < 1e-15);
}

#[test]
fn rules_are_read_from_data() {
    let rule: StaircaseRule = toml::from_str(
        "track = { weighted = { target = 0.75 } }\nstart = 1.0\nsteps = [0.2]\nlowest = 0.0\nhighest = 2.0\nreversals = 8\ntrials = 60",
    )
    .unwrap();
    assert_eq!(Track::Weighted { target: 0.75 }, rule.track);
    assert!(Staircase::new(rule).is_ok());
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(7), ..ProptestConfig::with_cases(100) })]

    #[test]
    fn a_replayed_procedure_is_where_it_was(answers in prop::collection::vec(any::<bool>(), 0..120), cut in 0usize..120) {
        let whole = |answers: &[bool]| {
            let mut s = Staircase::new(rule(Track::Transformed { down: 3 })).unwrap();
            replay(&mut s, answers.iter().copied());
            s
        };
        let cut = cut.min(answers.len());
        let mut resumed = whole(&answers[..cut]);
        replay(&mut resumed, answers[cut..].iter().copied());
        prop_assert_eq!(&whole(&answers), &resumed);
        prop_assert!((-10.0..=10.0).contains(&resumed.stimulus().unwrap_or(0.0)));
    }
}
