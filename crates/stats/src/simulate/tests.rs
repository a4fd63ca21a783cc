#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::psychometric::{Curve, Sigmoid, Task};

const PAPER: PreferenceDesign =
    PreferenceDesign { participants: 32, pairs: 2, preference: 0.5, icc: 0.1, lapse: 0.0, alpha: 0.05 };

#[test]
fn the_t_test_keeps_its_level_and_the_per_trial_test_does_not() {
    let strong = PreferenceDesign { icc: 0.5, pairs: 4, ..PAPER };
    let power = preference_power(&strong, 4000, 1).unwrap();
    // Four standard errors of 4,000 at .05 are .014, and a discrete t-test is a little off.
    assert!((power.t_test.rate - 0.05).abs() < 0.018, "{:?}", power.t_test);
    assert!(power.per_trial.rate > 0.15, "{:?}", power.per_trial);
    assert!(power.t_test.low < power.t_test.rate && power.t_test.rate < power.t_test.high);
    assert_eq!(power, preference_power(&strong, 4000, 1).unwrap());
}

#[test]
fn simulated_power_is_the_exact_one() {
    // With independent pairs a count is binomial(2, p): the power by summing over all tables of 8 participants.
    let design = PreferenceDesign { participants: 8, preference: 0.75, icc: 0.0, ..PAPER };
    let mut exact = 0.0;
    let probabilities = [0.0625, 0.375, 0.5625f64];
    let factorial = |n: u64| (1..=n).map(|k| k as f64).product::<f64>();
    for a in 0..=8u64 {
        for b in 0..=8 - a {
            let c = 8 - a - b;
            let p = factorial(8) / (factorial(a) * factorial(b) * factorial(c))
                * probabilities[0].powi(a as i32)
                * probabilities[1].powi(b as i32)
                * probabilities[2].powi(c as i32);
            // t of the table against mean 1, and t's 97.5% point at 7 degrees of freedom.
            let mean = (b + 2 * c) as f64 / 8.0;
            let ss =
                a as f64 * mean.powi(2) + b as f64 * (1.0 - mean).powi(2) + c as f64 * (2.0 - mean).powi(2);
            let se = (ss / 7.0 / 8.0).sqrt();
            let rejects =
                if se == 0.0 { mean != 1.0 } else { ((mean - 1.0) / se).abs() > 2.364_624_251_592_784 };
            exact += p * f64::from(u8::from(rejects));
        }
    }
    let rate = preference_power(&design, 20_000, 3).unwrap().t_test;
    let error = (exact * (1.0 - exact) / 20_000.0).sqrt();
    assert!((rate.rate - exact).abs() < 4.0 * error, "{rate:?} is not {exact}");
    // The negative control: another preference is another power.
    let other = preference_power(&PreferenceDesign { preference: 0.7, ..design }, 20_000, 3).unwrap().t_test;
    assert!((other.rate - exact).abs() > 10.0 * error);
}

#[test]
fn the_participants_needed_reach_the_power_and_one_fewer_do_not() {
    let design = PreferenceDesign { preference: 0.65, ..PAPER };
    let n = participants_needed(&design, 0.8, 1000, 600, 7).unwrap().unwrap();
    let power = |participants| {
        preference_power(&PreferenceDesign { participants, ..design }, 600, 7).unwrap().t_test.rate
    };
    assert!(power(n) >= 0.8 && power(n - 1) < 0.8, "{n}");
    // (z.975 + z.8)² · variance / (0.3)², with variance 2·.65·.35·(1 + .1): about 44.
    assert!((35..=55).contains(&n), "{n}");
    assert_eq!(
        None,
        participants_needed(&PreferenceDesign { preference: 0.5, ..PAPER }, 0.8, 60, 200, 7).unwrap()
    );
}

#[test]
fn designs_outside_their_ranges_are_refused() {
    for bad in [
        PreferenceDesign { participants: 1, ..PAPER },
        PreferenceDesign { pairs: 0, ..PAPER },
        PreferenceDesign { preference: 1.1, ..PAPER },
        PreferenceDesign { icc: f64::NAN, ..PAPER },
        PreferenceDesign { alpha: 0.0, ..PAPER },
        PreferenceDesign { pairs: u64::MAX, ..PAPER },
    ] {
        assert!(preference_power(&bad, 10, 0).is_err(), "{bad:?}");
    }
    assert!(preference_power(&PAPER, 0, 0).is_err());
    assert!(rate(0, 0, |_| Some(true)).is_err());
    assert_eq!((3, 3, 4), {
        let mut call = 0;
        let r = rate(7, 0, |_| {
            call += 1;
            (call % 2 == 0).then_some(true)
        })
        .unwrap();
        (r.hits, r.runs, r.undefined)
    });
}

#[test]
fn certain_preferences_are_found_without_variance() {
    let all = PreferenceDesign { preference: 1.0, icc: 0.0, ..PAPER };
    assert_eq!(1.0, preference_power(&all, 20, 0).unwrap().t_test.rate);
}

fn constant_stimuli() -> ThresholdDesign {
    ThresholdDesign {
        curve: Curve {
            sigmoid: Sigmoid::Gaussian,
            threshold: 0.0,
            width: 2.0,
            guess: 0.5,
            lapse: 0.02,
            eta: 0.0,
        },
        threshold_sd: 0.2,
        levels: (-3..=3).map(|i| f64::from(i) * 0.6).collect(),
        trials: 40,
        task: Task::default(),
        level: 0.95,
    }
}

#[test]
fn thresholds_are_found_where_they_are() {
    let found = threshold_precision(&constant_stimuli(), 200, 5).unwrap();
    assert!(found.bias.abs() < 5.0 * found.error_sd / 200f64.sqrt(), "{found:?}");
    assert!(found.coverage.high > 0.93 && found.coverage.rate > 0.9, "{found:?}");
    // Four times the trials, half the error.
    let more = threshold_precision(&ThresholdDesign { trials: 160, ..constant_stimuli() }, 200, 5).unwrap();
    assert!((0.35..0.7).contains(&(more.error_sd / found.error_sd)), "{found:?} {more:?}");
    assert!(more.mean_interval.unwrap() < found.mean_interval.unwrap());
    assert!(threshold_precision(&ThresholdDesign { trials: 0, ..constant_stimuli() }, 2, 0).is_err());
    assert!(threshold_precision(&ThresholdDesign { levels: vec![0.0], ..constant_stimuli() }, 2, 0).is_err());
}

#[test]
fn large_differences_are_found_and_absent_ones_are_not() {
    let design = ScaleDesign {
        jod: vec![0.0, 0.0, 1.5],
        observer_sd: 0.3,
        observers: 20,
        repeats: 3,
        options: Default::default(),
        level: 0.95,
    };
    let power = scale_power(&design, 40, 2).unwrap();
    assert_eq!(3, power.found.len());
    assert!(
        power.found[0].rate <= 0.2 && power.found[1].rate > 0.95 && power.found[2].rate > 0.95,
        "{power:?}"
    );
    assert!(power.coverage.rate > 0.85, "{power:?}");
    assert!(scale_power(&ScaleDesign { observers: 1, ..design }, 1, 0).is_err());
}

#[test]
fn designs_are_read_from_data() {
    let design: PreferenceDesign =
        serde_json::from_str(r#"{"participants": 32, "pairs": 2, "preference": 0.5, "icc": 0.1}"#).unwrap();
    assert_eq!(PAPER, design);
    assert!(
        serde_json::from_str::<PreferenceDesign>(r#"{"participants": 32, "pairs": 2, "prefrence": 0.5}"#)
            .is_err()
    );
}
