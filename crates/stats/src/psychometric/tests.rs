#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
//! Oracles: tests/data/psychometric.py and quest_plus.py (psignifit 4.3, questplus 2023.1, and the definitions in 30-digit arithmetic).

use super::*;
use crate::random::Random;
use proptest::prelude::*;
use serde_json::Value;

fn data(name: &str) -> Value {
    let path = format!("{}/tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn oracle() -> Value {
    data("psychometric.json")
}

fn numbers(value: &Value) -> Vec<f64> {
    serde_json::from_value(value.clone()).unwrap()
}

fn case(value: &Value) -> (Vec<Level>, Task) {
    let (x, correct, trials) = (numbers(&value["x"]), numbers(&value["correct"]), numbers(&value["trials"]));
    let levels = (0..x.len())
        .map(|i| Level { x: x[i], correct: correct[i] as u64, trials: trials[i] as u64 })
        .collect();
    let sigmoid = serde_json::from_value(value["sigmoid"].clone()).unwrap();
    let task = Task { sigmoid, guess: value["guess"].as_f64().unwrap(), ..Task::default() };
    (levels, task)
}

fn triangles() -> Vec<Level> {
    [(2.48, 96), (2.7, 95), (3.0, 84), (3.2, 72), (3.5, 58), (3.8, 50)]
        .map(|(x, correct): (f64, u64)| Level { x: -x, correct, trials: 100 })
        .into()
}

fn close(what: &str, got: f64, expected: f64, tolerance: f64) {
    assert!(
        (got - expected).abs() <= tolerance * expected.abs().max(1e-3),
        "{what}: {got} is not {expected}"
    );
}

#[test]
fn maximum_likelihood_agrees_with_thirty_digits() {
    for (name, value) in oracle().as_object().unwrap() {
        let (levels, task) = case(value);
        for (key, overdispersion) in [("ml", false), ("ml_eta", true)] {
            let found = fit(&levels, &Task { overdispersion, ..task }).unwrap();
            if value[key].is_null() {
                // The best curve is a step somewhere between two levels, −227.02794 by a search of 162 starts; the next hill has −227.66.
                let penalty = 9.0 * (-found.curve.lapse).ln_1p();
                assert!((found.log_likelihood + penalty + 227.027_94).abs() < 1e-4);
                continue;
            }
            for (got, expected) in found.curve.parameters().iter().zip(numbers(&value[key])) {
                close(&format!("{name} {key}"), *got, expected, 1e-9);
            }
            let value_at = value[format!("{key}_value")].as_f64().unwrap();
            let penalty = 9.0 * (-found.curve.lapse).ln_1p() + 9.0 * (-found.curve.eta).ln_1p();
            close(name, found.log_likelihood + penalty, value_at, 1e-12);
        }
        if value["profile95"].is_null() {
            continue;
        }
        let profile = profile_intervals(&levels, &task, 0.95).unwrap();
        for (interval, key) in [(profile.threshold, "threshold"), (profile.width, "width")] {
            let expected = numbers(&value["profile95"][key]);
            close(name, interval.low.unwrap(), expected[0], 1e-8);
            close(name, interval.high.unwrap(), expected[1], 1e-8);
        }
    }
}

#[test]
fn the_posterior_agrees_with_psignifit() {
    for (name, value) in oracle().as_object().unwrap() {
        let (levels, task) = case(value);
        let task = Task { overdispersion: true, ..task };
        let expected = &value["psignifit"];
        for (level, key) in [(0.95, "interval95"), (0.68, "interval68")] {
            let found = posterior(&levels, &task, level, &[]).unwrap();
            for (i, (got, exact)) in found.map.parameters().iter().zip(numbers(&value["map"])).enumerate() {
                close(&format!("{name} map {i}"), *got, exact, 1e-9);
                // psignifit ends its simplex search about 1e-3 from the top.
                assert!((got - expected["map"][i].as_f64().unwrap()).abs() < 3e-3);
            }
            let parameters = [&found.threshold, &found.width, &found.lapse, &found.eta];
            for (i, (parameter, mean)) in parameters.iter().zip(found.mean.parameters()).enumerate() {
                let what = format!("{name} {key} {i}");
                close(&what, mean, expected["mean"][i].as_f64().unwrap(), 1e-9);
                close(&what, parameter.low, expected[key][i][0].as_f64().unwrap(), 1e-9);
                close(&what, parameter.high, expected[key][i][1].as_f64().unwrap(), 1e-9);
            }
        }
    }
}

#[test]
fn the_golden_values_of_psignifit_4_3() {
    let task = Task { overdispersion: true, ..Task::default() };
    let found = posterior(&triangles(), &task, 0.95, &[0.75]).unwrap();
    let rounded = |x: f64| format!("{x:.3}");
    assert_eq!(
        ["-3.183", "1.001", "0.029", "-3.331", "-3.082"].map(String::from),
        [
            rounded(found.map.threshold),
            rounded(found.map.width),
            rounded(found.map.lapse),
            rounded(found.threshold.low),
            rounded(found.threshold.high)
        ]
    );
    // The negative control: another curve is another threshold.
    let other = posterior(&triangles(), &Task { sigmoid: Sigmoid::Weibull, ..task }, 0.95, &[]).unwrap();
    assert_ne!("-3.183", rounded(other.map.threshold));
    // Half a cell of 0.0187 lies between psignifit's reading of the interval and what its finer grids converge to: with 160 steps it gives
    // −3.3233 … −3.0749 by its own reading, whose cells are .0046.
    let converged: [f64; 2] = [-3.3233 + 0.0023, -3.0749 + 0.0023];
    let error = |x: f64, i: usize| (x - converged[i]).abs();
    assert!(error(found.threshold.low_centred, 0) < 1e-3 && error(found.threshold.high_centred, 1) < 1e-3);
    assert!(error(found.threshold.low, 0) > 8e-3);
    let three_quarters = &found.thresholds[0];
    let map = found.map.threshold_at(0.75, Scaling::Scaled).unwrap();
    assert!(three_quarters.low.unwrap() < map && map < three_quarters.high.unwrap());
    assert!((three_quarters.reached - 1.0).abs() < 1e-12);
    assert!(!found.threshold.on_edge && !found.width.on_edge);
}

#[test]
fn derivatives_of_the_likelihood_are_its_differences() {
    for sigmoid in [Sigmoid::Gaussian, Sigmoid::Logistic, Sigmoid::Weibull] {
        let task = Task { sigmoid, overdispersion: true, ..Task::default() };
        let levels = triangles();
        let at = [-3.2, 0.9, 0.04, 0.12];
        let here = likelihood::log_likelihood(&levels, &task, &at);
        let h = 1e-5;
        for i in 0..4 {
            let step = |sign: f64| {
                let mut moved = at;
                moved[i] += sign * h;
                likelihood::log_likelihood(&levels, &task, &moved)
            };
            let (up, down) = (step(1.0), step(-1.0));
            close("gradient", here.gradient[i], (up.value - down.value) / (2.0 * h), 1e-6);
            for j in 0..4 {
                let expected = -(up.gradient[j] - down.gradient[j]) / (2.0 * h);
                close("curvature", here.curvature[i * 4 + j], expected, 1e-6);
            }
        }
    }
}

#[test]
fn thresholds_are_where_the_curve_says() {
    for sigmoid in [Sigmoid::Gaussian, Sigmoid::Logistic, Sigmoid::Weibull] {
        let curve = Curve { sigmoid, threshold: 2.0, width: 1.5, guess: 0.5, lapse: 0.04, eta: 0.0 };
        assert!((curve.threshold_at(0.5, Scaling::Unscaled).unwrap() - 2.0).abs() < 1e-14);
        let span = |p| curve.threshold_at(p, Scaling::Unscaled).unwrap();
        assert!((span(0.95) - span(0.05) - 1.5).abs() < 1e-13);
        let x = curve.threshold_at(0.75, Scaling::Scaled).unwrap();
        assert!((curve.proportion(x) - 0.75).abs() < 1e-14);
        assert!((x - 2.0).abs() > 0.01, "scaled and unscaled differ");
        let h = 1e-6;
        close(
            "slope",
            curve.slope(1.7),
            (curve.proportion(1.7 + h) - curve.proportion(1.7 - h)) / (2.0 * h),
            1e-8,
        );
        for p in [0.5, 0.96, 0.97, f64::NAN] {
            assert!(curve.threshold_at(p, Scaling::Scaled).is_err());
        }
    }
}

#[test]
fn data_that_show_no_curve_end_on_an_edge() {
    let level = |x: f64, correct| Level { x, correct, trials: 20 };
    let all = [level(0.0, 20), level(1.0, 20), level(2.0, 20)];
    let found = fit(&all, &Task::default()).unwrap();
    assert!(!found.at_bound.is_empty() && found.deviance < 1e-6, "{found:?}");
    let chance = [level(0.0, 10), level(1.0, 10), level(2.0, 10)];
    assert!(!fit(&chance, &Task::default()).unwrap().at_bound.is_empty());
    let interval = profile_intervals(&chance, &Task::default(), 0.95).unwrap().threshold;
    assert!(interval.low.is_none() || interval.high.is_none());
    assert!(posterior(&chance, &Task::default(), 0.95, &[0.75]).unwrap().thresholds[0].reached <= 1.0);
    // A perfect step: the width ends at its lowest.
    let step = [level(0.0, 0), level(1.0, 0), level(2.0, 20), level(3.0, 20)];
    let task = Task { guess: 0.0, ..Task::default() };
    assert!(fit(&step, &task).unwrap().deviance < 1e-3);
}

#[test]
fn bad_input_is_named() {
    let good = triangles();
    let task = Task::default();
    let with = |x, correct, trials| fit(&[good[0], Level { x, correct, trials }], &task);
    assert!(matches!(
        with(f64::NAN, 1, 2),
        Err(StatsError::InvalidElement { name: "levels.x", index: 1, .. })
    ));
    assert!(matches!(with(0.0, 3, 2), Err(StatsError::InvalidElement { .. })));
    assert!(matches!(with(0.0, 0, 0), Err(StatsError::TooFew { .. })));
    assert!(matches!(with(good[0].x, 1, 2), Err(StatsError::TooFew { .. })));
    assert!(fit(&[], &task).is_err());
    assert!(fit(&good, &Task { guess: 1.0, ..task }).is_err());
    assert!(fit(&good, &Task { guess: f64::NAN, ..task }).is_err());
    assert!(fit(&good, &Task { lapse: Lapse::Fixed(0.5), ..task }).is_err());
    assert!(posterior(&good, &task, 1.0, &[]).is_err());
    assert!(posterior(&good, &task, 0.95, &[0.5]).is_err());
    assert!(goodness_of_fit(&good, &task, 99, 0).is_err());
}

#[test]
fn a_fixed_lapse_rate_is_kept() {
    let found = fit(&triangles(), &Task { lapse: Lapse::Fixed(0.02), ..Task::default() }).unwrap();
    assert_eq!(0.02, found.curve.lapse);
    assert!(found.standard_errors[0].is_some() && found.standard_errors[2].is_none());
    assert!(found.at_bound.is_empty());
}

#[test]
fn goodness_of_fit_has_its_level_and_its_power() {
    let curve =
        Curve { sigmoid: Sigmoid::Gaussian, threshold: 0.0, width: 2.0, guess: 0.5, lapse: 0.02, eta: 0.0 };
    let observe = |eta: f64, seed| -> Vec<Level> {
        let mut random = Random::new(seed);
        (-3..=3)
            .map(|i| {
                let x = f64::from(i) * 0.6;
                let p = random.beta(curve.proportion(x), eta * eta);
                Level { x, correct: random.binomial(40, p), trials: 40 }
            })
            .collect()
    };
    let rejected = |eta| {
        let p = |seed| goodness_of_fit(&observe(eta, seed), &Task::default(), 199, seed).unwrap();
        (0..100).filter(|&seed| p(seed).p_simulated <= 0.05).count()
    };
    // 5 of 100 expected; 5 + 4·√4.75 = 13.7.
    let false_alarms = rejected(0.0);
    assert!(false_alarms <= 13, "{false_alarms}");
    // Strong overdispersion must be seen.
    let seen = rejected(0.3);
    assert!(seen >= 60, "{seen}");
    let once = goodness_of_fit(&observe(0.0, 1), &Task::default(), 199, 5).unwrap();
    assert_eq!(once, goodness_of_fit(&observe(0.0, 1), &Task::default(), 199, 5).unwrap());
    assert_eq!(Some(4), once.df);
}

#[test]
fn profile_intervals_cover_also_lapsing_observers() {
    // 500 observers, a third of whom lapse on 5% of trials: five standard errors around .95, with room for the small sample; half the
    // interval is the negative control.
    let (mut hits, mut halved) = (0u32, 0u32);
    let observers = 500u32;
    for seed in 0..observers {
        let mut random = Random::stream(11, u64::from(seed));
        let lapse = if seed % 3 == 0 { 0.05 } else { 0.0 };
        let truth = random.normal() * 0.3;
        let curve =
            Curve { sigmoid: Sigmoid::Gaussian, threshold: truth, width: 2.0, guess: 0.5, lapse, eta: 0.0 };
        let levels: Vec<Level> = (-3..=3)
            .map(|i| {
                let x = f64::from(i) * 0.6;
                Level { x, correct: random.binomial(40, curve.proportion(x)), trials: 40 }
            })
            .collect();
        let found = profile_intervals(&levels, &Task::default(), 0.95).unwrap();
        let middle = found.fit.curve.threshold;
        let inside = |low: Option<f64>, high: Option<f64>| {
            low.is_none_or(|low| low <= truth) && high.is_none_or(|high| truth <= high)
        };
        let t = found.threshold;
        hits += u32::from(inside(t.low, t.high));
        halved += u32::from(inside(t.low.map(|l| 0.5 * (l + middle)), t.high.map(|h| 0.5 * (h + middle))));
    }
    let share = |n: u32| f64::from(n) / f64::from(observers);
    assert!((0.92..=0.99).contains(&share(hits)), "covers {}", share(hits));
    assert!(share(halved) < 0.8, "half the width covers {}", share(halved));
}

fn belief() -> Belief {
    let axis = |low: f64, high: f64, n: usize| -> Vec<f64> {
        (0..n).map(|i| low + (high - low) * i as f64 / (n - 1) as f64).collect()
    };
    Belief::new(BeliefGrid {
        sigmoid: Sigmoid::Gaussian,
        guess: 0.5,
        stimuli: axis(-2.0, 2.0, 21),
        thresholds: axis(-2.0, 2.0, 41),
        widths: vec![0.5, 1.0, 2.0, 4.0],
        lapses: vec![0.0, 0.02, 0.05, 0.1],
    })
    .unwrap()
}

#[test]
fn a_belief_is_the_product_of_its_answers() {
    let mut belief = belief();
    let answers = [(10, true), (3, false), (15, true), (7, true), (7, false)];
    for (stimulus, correct) in answers {
        belief.update(stimulus, correct).unwrap();
    }
    // By hand: prior × likelihood of each curve, the mean threshold.
    let grid = belief.grid().clone();
    let (mut total, mut mean) = (0.0, 0.0);
    for &lapse in &grid.lapses {
        for &threshold in &grid.thresholds {
            for &width in &grid.widths {
                let curve = Curve { sigmoid: grid.sigmoid, threshold, width, guess: 0.5, lapse, eta: 0.0 };
                let mut p = (1.0 - lapse).powi(9);
                for (stimulus, correct) in answers {
                    let psi = curve.proportion(grid.stimuli[stimulus]);
                    p *= if correct { psi } else { 1.0 - psi };
                }
                total += p;
                mean += p * threshold;
            }
        }
    }
    let estimate = belief.threshold(0.95).unwrap();
    close("mean", estimate.mean, mean / total, 1e-12);
    assert!(estimate.low < estimate.median && estimate.median < estimate.high);
    assert!((belief.mean_curve().threshold - estimate.mean).abs() < 1e-15);
}

#[test]
fn the_most_informative_stimulus_leaves_the_least_entropy() {
    let mut belief = belief();
    for (stimulus, correct) in [(14, true), (6, false), (10, true)] {
        belief.update(stimulus, correct).unwrap();
    }
    // QUEST+'s definition, literally: the expected entropy of the posterior after the answer.
    let expected_entropy = |stimulus: usize| -> f64 {
        [true, false]
            .map(|correct| {
                let mut after = belief.clone();
                let n = belief.mass.len();
                let p: f64 =
                    belief.mass.iter().zip(&belief.correct[stimulus * n..]).map(|(m, p)| m * p).sum();
                after.update(stimulus, correct).unwrap();
                let entropy: f64 = after.mass.iter().filter(|m| **m > 0.0).map(|m| -m * m.ln()).sum();
                assert_eq!(n, after.mass.len());
                entropy * if correct { p } else { 1.0 - p }
            })
            .iter()
            .sum()
    };
    let best = (0..21).min_by(|&a, &b| expected_entropy(a).total_cmp(&expected_entropy(b))).unwrap();
    assert_eq!(best, belief.most_informative());
    let worst = (0..21).max_by(|&a, &b| expected_entropy(a).total_cmp(&expected_entropy(b))).unwrap();
    assert_ne!(worst, belief.most_informative());
}

#[test]
fn a_belief_refuses_what_is_impossible() {
    let mut certain = Belief::new(BeliefGrid {
        sigmoid: Sigmoid::Gaussian,
        guess: 0.5,
        stimuli: vec![0.0, 1e6],
        thresholds: vec![0.0],
        widths: vec![1.0],
        lapses: vec![0.0],
    })
    .unwrap();
    let before = certain.threshold(0.9).unwrap();
    assert!(certain.update(1, false).is_err());
    assert!(certain.update(2, true).is_err());
    assert_eq!(before, certain.threshold(0.9).unwrap());
    let grid = certain.grid().clone();
    assert!(Belief::new(BeliefGrid { stimuli: vec![], ..grid.clone() }).is_err());
    assert!(Belief::new(BeliefGrid { widths: vec![0.0], ..grid.clone() }).is_err());
    assert!(Belief::new(BeliefGrid { thresholds: vec![1.0, 1.0], ..grid.clone() }).is_err());
    assert!(Belief::new(BeliefGrid { lapses: vec![0.5], ..grid.clone() }).is_err());
    assert!(Belief::new(BeliefGrid { stimuli: vec![f64::NAN], ..grid }).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(6), ..ProptestConfig::with_cases(60) })]

    #[test]
    fn any_levels_give_numbers_or_a_named_error(
        data in prop::collection::vec((-1e3f64..1e3, 0u64..30, 0u64..30), 0..8),
        sigmoid in prop::sample::select(vec![Sigmoid::Gaussian, Sigmoid::Logistic, Sigmoid::Weibull]),
        guess in 0.0f64..0.9,
        overdispersion: bool,
    ) {
        let levels: Vec<Level> = data.iter().map(|&(x, correct, trials)| Level { x, correct, trials }).collect();
        let task = Task { sigmoid, guess, overdispersion, lapse: Lapse::Prior };
        match fit(&levels, &task) {
            Ok(found) => {
                prop_assert!(found.curve.parameters().iter().all(|x| x.is_finite()), "{found:?}");
                prop_assert!(found.deviance.is_finite() && found.log_likelihood <= 0.0);
            }
            Err(e) => prop_assert!(!matches!(e, StatsError::NotConverged { .. }), "{e}: {levels:?}"),
        }
    }
}

#[test]
fn questplus_shows_the_same_stimuli() {
    let oracle = data("quest_plus.json");
    let mut belief = Belief::new(BeliefGrid {
        sigmoid: Sigmoid::Gaussian,
        guess: 0.5,
        stimuli: numbers(&oracle["stimuli"]),
        thresholds: numbers(&oracle["thresholds"]),
        widths: numbers(&oracle["widths"]),
        lapses: numbers(&oracle["lapses"]),
    })
    .unwrap();
    for (answer, shown) in
        oracle["answers"].as_array().unwrap().iter().zip(oracle["shown"].as_array().unwrap())
    {
        assert_eq!(shown.as_u64(), Some(belief.most_informative() as u64));
        belief.update(belief.most_informative(), answer.as_bool().unwrap()).unwrap();
    }
    let curve = belief.mean_curve();
    close("threshold", curve.threshold, oracle["threshold"].as_f64().unwrap(), 1e-9);
    close("width", curve.width, oracle["width"].as_f64().unwrap(), 1e-9);
    close("lapse", curve.lapse, oracle["lapse"].as_f64().unwrap(), 1e-9);
}

#[test]
fn a_ridge_that_is_level_to_rounding_is_an_end() {
    // A staircase's levels: the best curve passes 1.8 at its share exactly, and any steep one does.
    let levels =
        [(1.0000000000000004, 1, 2), (1.4, 10, 21), (1.8, 38, 46), (2.2, 31, 34), (2.6, 10, 11), (3.0, 6, 6)]
            .map(|(x, correct, trials)| Level { x, correct, trials });
    let task = Task { sigmoid: Sigmoid::Logistic, ..Task::default() };
    let found = fit(&levels, &task).unwrap();
    assert!(
        (found.log_likelihood + 9.0 * (-found.curve.lapse).ln_1p() + 51.891_884_596_013_88).abs() < 1e-9,
        "{found:?}"
    );
    assert!((found.curve.proportion(1.8) - 38.0 / 46.0).abs() < 1e-6);
    let interval = profile_intervals(&levels, &task, 0.95).unwrap().threshold;
    assert!(
        interval.low.is_some_and(|low| low > 1.0) && interval.high.is_some_and(|high| high < 2.3),
        "{interval:?}"
    );
}
