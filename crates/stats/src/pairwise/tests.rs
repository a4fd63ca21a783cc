#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
//! Oracles: tests/data/pairwise.py and pairwise.R.

use super::*;
use crate::random::Random;
use proptest::prelude::*;
use serde_json::Value;

fn oracle() -> Value {
    serde_json::from_str(include_str!("../../tests/data/pairwise.json")).unwrap()
}

fn wins(value: &Value) -> Wins {
    Wins::from_matrix(&serde_json::from_value::<Vec<Vec<u64>>>(value["wins"].clone()).unwrap()).unwrap()
}

fn names(n: usize) -> Vec<String> {
    (0..n).map(|i| format!("c{i}")).collect()
}

fn options(model: Model, estimator: Estimator) -> ScaleOptions {
    ScaleOptions { model, estimator, origin: Origin::Mean }
}

const MODELS: [(Model, &str, &str); 2] =
    [(Model::Thurstone, "thurstone", "probit"), (Model::BradleyTerry, "bradley-terry", "logit")];

/// Within `tolerance` of the largest position: a position near the arbitrary zero has no relative accuracy of its own.
fn close(what: &str, got: &[f64], expected: &Value, tolerance: f64) {
    let expected: Vec<f64> = serde_json::from_value(expected.clone()).unwrap();
    let size = expected.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    assert_eq!(expected.len(), got.len());
    for (a, b) in got.iter().zip(&expected) {
        assert!((a - b).abs() <= tolerance * size, "{what}: {got:?} is not {expected:?}");
    }
}

#[test]
fn maximum_likelihood_agrees_with_scipy_pwcmp_and_r() {
    let oracle = oracle();
    let r: Value = serde_json::from_str(include_str!("../../tests/data/pairwise_r.json")).unwrap();
    for (case, value) in oracle["ml"].as_object().unwrap() {
        let wins = wins(value);
        for (model, name, link) in MODELS {
            let fit = scale(&names(wins.conditions()), &wins, options(model, Estimator::Automatic)).unwrap();
            assert_eq!(Estimator::MaximumLikelihood, fit.estimator);
            close(case, &fit.jod, &value[name]["jod"], 1e-11);
            close(case, &fit.standard_errors, &value[name]["se"], 1e-6);
            let ll = value[name]["log_likelihood"].as_f64().unwrap();
            assert!((fit.log_likelihood / ll - 1.0).abs() < 1e-12);
            let by_r =
                r.as_array().unwrap().iter().find(|v| v["case"] == **case && v["link"] == link).unwrap();
            // R scores the probit by Fisher steps, which it ends at 1e-9; the logit's are Newton's.
            close(case, &fit.jod, &by_r["jod"], 2e-9);
            assert!((fit.deviance / by_r["deviance"].as_f64().unwrap() - 1.0).abs() < 1e-11);
            assert_eq!(by_r["df"].as_u64(), Some(fit.deviance_df));
            if model == Model::Thurstone {
                close(case, &fit.jod, &value["pwcmp"], 1e-11);
            } else {
                // The negative control: the other model is another scale.
                let other = scale(&names(wins.conditions()), &wins, ScaleOptions::default()).unwrap();
                assert!(other.jod.iter().zip(&fit.jod).any(|(a, b)| (a - b).abs() > 1e-3));
            }
        }
    }
}

#[test]
fn jeffreys_keeps_separated_scales_finite() {
    let oracle = oracle();
    for (case, value) in oracle["jeffreys"].as_object().unwrap() {
        let wins = wins(value);
        for (model, name, _) in MODELS {
            let fit = scale(&names(wins.conditions()), &wins, options(model, Estimator::Jeffreys)).unwrap();
            close(case, &fit.jod, &value[name], 1e-10);
            let automatic =
                scale(&names(wins.conditions()), &wins, options(model, Estimator::Automatic)).unwrap();
            assert_eq!(case == "complete", automatic.estimator == Estimator::MaximumLikelihood);
            let ml = scale(&names(wins.conditions()), &wins, options(model, Estimator::MaximumLikelihood));
            assert_eq!(case == "complete", ml.is_ok());
        }
    }
}

#[test]
fn one_jod_is_three_quarters() {
    // Two conditions, 75 of 100: by definition 1 JOD apart, under either model.
    let wins = Wins::from_matrix(&[vec![0, 75], vec![25, 0]]).unwrap();
    for (model, ..) in MODELS {
        let from_b = ScaleOptions { origin: Origin::Condition(1), ..options(model, Estimator::Automatic) };
        let fit = scale(&names(2), &wins, from_b).unwrap();
        assert!((fit.jod[0] - 1.0).abs() < 1e-13 && fit.jod[1] == 0.0);
        assert!(fit.standard_errors[1] == 0.0 && fit.standard_errors[0] > 0.0);
        assert!((fit.probability(0, 1).unwrap() - 0.75).abs() < 1e-14);
        assert!(fit.probability(0, 2).is_err());
        assert!(fit.deviance < 1e-10 && fit.deviance_df == 0 && fit.deviance_p == 1.0);
    }
}

#[test]
fn the_origin_moves_positions_and_nothing_else() {
    let wins = wins(&oracle()["ml"]["incomplete"]);
    let at = |origin| scale(&names(6), &wins, ScaleOptions { origin, ..Default::default() }).unwrap();
    let (mean, third) = (at(Origin::Mean), at(Origin::Condition(2)));
    assert!(mean.jod.iter().sum::<f64>().abs() < 1e-12);
    assert_eq!((0.0, 0.0), (third.jod[2], third.standard_errors[2]));
    for (i, j) in [(0, 1), (3, 5)] {
        assert!(((mean.jod[i] - mean.jod[j]) - (third.jod[i] - third.jod[j])).abs() < 1e-12);
        let difference = |s: &Scale| s.covariance[i][i] + s.covariance[j][j] - 2.0 * s.covariance[i][j];
        assert!((difference(&mean) / difference(&third) - 1.0).abs() < 1e-10);
    }
}

#[test]
fn what_does_not_hang_together_is_named() {
    let mut wins = Wins::new(4);
    wins.add(0, 1, 3).unwrap();
    wins.add(1, 0, 2).unwrap();
    wins.add(2, 3, 3).unwrap();
    let names: Vec<String> = ["photo", "pa", "mc", "oracle"].map(String::from).into();
    let error = scale(&names, &wins, ScaleOptions::default()).unwrap_err();
    assert_eq!(
        "the comparisons fall apart into 2 groups that nothing links: {photo, pa} | {mc, oracle}",
        error.to_string()
    );
    wins.add(2, 0, 1).unwrap();
    let ml = ScaleOptions { estimator: Estimator::MaximumLikelihood, ..Default::default() };
    let error = scale(&names, &wins, ml).unwrap_err().to_string();
    assert!(error.contains("mc, oracle never lost to any of the others"), "{error}");
}

#[test]
fn bad_counts_are_refused() {
    assert!(Wins::tally(2, [(0, 2)]).is_err());
    assert!(Wins::tally(2, [(1, 1)]).is_err());
    assert!(Wins::from_matrix(&[vec![0, 1], vec![1]]).is_err());
    assert!(Wins::from_matrix(&[vec![3, 1], vec![1, 0]]).is_err());
    assert!(Wins::from_matrix(&[vec![0, u64::MAX], vec![1, 0]]).is_err());
    let none = scale(&names(3), &Wins::new(3), ScaleOptions::default());
    assert!(matches!(none, Err(StatsError::TooFew { name: "choices", .. })));
    assert!(scale(&names(1), &Wins::new(1), ScaleOptions::default()).is_err());
    assert!(scale(&names(0), &Wins::new(0), ScaleOptions::default()).is_err());
    assert!(scale(&names(2), &Wins::new(3), ScaleOptions::default()).is_err());
    let wins = Wins::tally(2, [(0, 1), (1, 0)]).unwrap();
    let beyond = ScaleOptions { origin: Origin::Condition(2), ..Default::default() };
    assert!(scale(&names(2), &wins, beyond).is_err());
}

#[test]
fn circular_triads_have_kendalls_distribution() {
    let table = &oracle()["triads"];
    for n in 3..=6usize {
        // A transitive order, then with ever more upsets.
        for seed in 0..20 {
            let mut random = Random::stream(5, seed);
            let mut wins = Wins::new(n);
            for i in 0..n {
                for j in i + 1..n {
                    let upset = random.bernoulli(seed as f64 / 40.0);
                    wins.add(if upset { j } else { i }, if upset { i } else { j }, 1).unwrap();
                }
            }
            let found = circular_triads(&wins);
            let expected = table[n.to_string()][found.circular as usize].as_f64().unwrap();
            assert!((found.p.unwrap() - expected).abs() < 1e-12);
            assert!((0.0..=1.0).contains(&found.consistence.unwrap()));
            assert_eq!(seed == 0, seed == 0 && found.circular == 0);
        }
    }
    let cycle = Wins::tally(3, [(0, 1), (1, 2), (2, 0)]).unwrap();
    let found = circular_triads(&cycle);
    assert_eq!((1, 1, Some(0.0), Some(1.0)), (found.triads, found.circular, found.consistence, found.p));
    // An incomplete round has circles but no coefficient.
    let part = Wins::tally(4, [(0, 1), (1, 2), (2, 0), (0, 3)]).unwrap();
    let found = circular_triads(&part);
    assert_eq!((1, 1, None, None), (found.triads, found.circular, found.consistence, found.p));
    let twelve: Vec<(usize, usize)> = (0..12).flat_map(|i| (i + 1..12).map(move |j| (i, j))).collect();
    let found = circular_triads(&Wins::tally(12, twelve).unwrap());
    assert!(found.consistence == Some(1.0) && found.p.unwrap() < 1e-6);
}

/// Observers of a complete design with the given positions (JOD); the first `reversed` answer the wrong way round.
fn simulated(jod: &[f64], observers: usize, repeats: u64, reversed: usize, seed: u64) -> Vec<Observer> {
    (0..observers)
        .map(|o| {
            let mut random = Random::stream(seed, o as u64);
            let mut choices = Vec::new();
            for i in 0..jod.len() {
                for j in i + 1..jod.len() {
                    let sign = if o < reversed { -1.0 } else { 1.0 };
                    let p = Model::Thurstone.probability(sign * (jod[i] - jod[j]));
                    let won = random.binomial(repeats, p);
                    choices.push(Choice { winner: i, loser: j, times: won });
                    choices.push(Choice { winner: j, loser: i, times: repeats - won });
                }
            }
            Observer { id: format!("o{o}"), choices }
        })
        .collect()
}

#[test]
fn a_reversed_observer_is_odd() {
    let observers = simulated(&[0.0, 0.8, 1.6, 2.4], 20, 5, 1, 3);
    let found = odd_observers(&names(4), &observers, ScaleOptions::default()).unwrap();
    assert!(found[0].odd && found[0].z.unwrap() < -5.0, "{:?}", found[0]);
    assert!(found[1..].iter().all(|f| !f.odd && f.z.unwrap() > -3.5), "{found:?}");
    assert!(odd_observers(&names(4), &observers[..2], ScaleOptions::default()).is_err());
}

#[test]
fn nobody_is_odd_by_a_fence_that_has_no_width() {
    // Nine alike, and one who differs in one of three choices.
    let observer = |id: usize, first: [usize; 2]| Observer {
        id: format!("o{id}"),
        choices: [first, [1, 2], [0, 2]].map(|[winner, loser]| Choice { winner, loser, times: 1 }).to_vec(),
    };
    let mut observers: Vec<Observer> = (0..9).map(|id| observer(id, [0, 1])).collect();
    observers.push(observer(9, [1, 0]));
    let found = odd_observers(&names(3), &observers, ScaleOptions::default()).unwrap();
    assert!(found.iter().all(|f| f.distance.is_none()), "{found:?}");
    assert!(found.iter().all(|f| f.odd == (f.z.unwrap() < -3.0)), "{found:?}");
}

#[test]
fn observer_intervals_repeat_and_cover() {
    let truth = [0.0, 0.5, 1.0, 2.0];
    let run = |seed| {
        let observers = simulated(&truth, 25, 2, 0, seed);
        observer_intervals(&names(4), &observers, ScaleOptions::default(), 2000, 0.95, seed).unwrap()
    };
    assert_eq!(run(1), run(1));
    let (mut hits, mut halved, mut total) = (0u32, 0u32, 0u32);
    for seed in 0..60 {
        for d in run(seed).differences {
            let index = |name: &str| name[1..].parse::<usize>().unwrap();
            let expected = truth[index(&d.a)] - truth[index(&d.b)];
            total += 1;
            let [low, high] = [d.low, d.high].map(Option::unwrap);
            hits += u32::from(low <= expected && expected <= high);
            let (low, high) = (d.jod - (d.jod - low) / 2.0, d.jod + (high - d.jod) / 2.0);
            halved += u32::from(low <= expected && expected <= high);
        }
    }
    let share = |n: u32| f64::from(n) / f64::from(total);
    // 60 independent experiments: five standard errors of a clustered 95%, and intervals of half the width as the negative control.
    assert!((0.88..=0.99).contains(&share(hits)), "covers {}", share(hits));
    assert!(share(halved) < 0.80, "half the width covers {}", share(halved));
}

#[test]
fn a_million_choices_tally_exactly() {
    let mut random = Random::new(8);
    let jod = [0.0, 0.3, 0.5, 0.9, 1.4, 2.0];
    let rows: Vec<(usize, usize)> = (0..1_000_000)
        .map(|_| {
            let i = random.below(6);
            let j = (i + 1 + random.below(5)) % 6;
            let wins = random.bernoulli(Model::Thurstone.probability(jod[i] - jod[j]));
            if wins { (i, j) } else { (j, i) }
        })
        .collect();
    let wins = Wins::tally(6, rows).unwrap();
    let from_first = ScaleOptions { origin: Origin::Condition(0), ..Default::default() };
    let fit = scale(&names(6), &wins, from_first).unwrap();
    assert_eq!(1_000_000, fit.choices);
    for (i, truth) in jod.iter().enumerate() {
        assert!((fit.jod[i] - truth).abs() <= 5.0 * fit.standard_errors[i], "{:?}", fit.jod);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(5), ..ProptestConfig::with_cases(150) })]

    #[test]
    fn any_counts_give_a_finite_scale_or_a_named_error(
        n in 0usize..6,
        cells in prop::collection::vec(prop_oneof![3 => Just(0u64), 3 => 0u64..4, 1 => 0u64..1_000_000], 36),
    ) {
        let mut wins = Wins::new(n);
        for i in 0..n {
            for j in (0..n).filter(|j| *j != i) {
                wins.add(i, j, cells[i * 6 + j]).unwrap();
            }
        }
        for (model, ..) in MODELS {
            match scale(&names(n), &wins, options(model, Estimator::Automatic)) {
                Ok(fit) => {
                    prop_assert!(fit.jod.iter().chain(&fit.standard_errors).all(|x| x.is_finite()), "{fit:?}");
                    prop_assert!((0.0..=1.0).contains(&fit.deviance_p));
                }
                Err(e) => prop_assert!(
                    matches!(e, StatsError::Disconnected { .. } | StatsError::TooFew { .. }),
                    "{e}: {wins:?}"
                ),
            }
        }
        let _ = circular_triads(&wins);
    }

    #[test]
    fn renaming_conditions_renames_positions(seed in 0u64..1000) {
        let mut random = Random::new(seed);
        let mut order: Vec<usize> = (0..4).collect();
        random.shuffle(&mut order);
        let (mut plain, mut shuffled) = (Wins::new(4), Wins::new(4));
        for i in 0..4 {
            for j in (0..4).filter(|j| *j != i) {
                let times = 1 + random.below(20) as u64;
                plain.add(i, j, times).unwrap();
                shuffled.add(order[i], order[j], times).unwrap();
            }
        }
        let a = scale(&names(4), &plain, ScaleOptions::default()).unwrap();
        let b = scale(&names(4), &shuffled, ScaleOptions::default()).unwrap();
        for (i, &place) in order.iter().enumerate() {
            prop_assert!((a.jod[i] - b.jod[place]).abs() < 1e-10);
        }
    }
}
