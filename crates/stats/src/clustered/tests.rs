#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
//! Oracles: tests/data/clustered.py.

use super::*;
use crate::random::Random;
use proptest::prelude::*;
use serde_json::Value;

/// A row a participant: 1 the target, 0 the other, - not answered.
pub(super) fn rows(text: &str) -> Vec<Vec<Option<bool>>> {
    let choice = |c| match c {
        '1' => Some(true),
        '0' => Some(false),
        _ => None,
    };
    text.split(' ').map(|row| row.chars().map(choice).collect()).collect()
}

fn oracle() -> Value {
    serde_json::from_str(include_str!("../../tests/data/clustered.json")).unwrap()
}

fn close(name: &str, got: f64, expected: &Value, tolerance: f64) {
    let expected = expected.as_f64().unwrap();
    assert!((got - expected).abs() <= tolerance * expected.abs(), "{name}: {got} is not {expected}");
}

fn counts(value: &Value) -> Vec<u64> {
    value["counts"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect()
}

fn design(oracle: &Value) -> Vec<Row> {
    serde_json::from_value(oracle["design"]["rows"].clone()).unwrap()
}

#[test]
fn intraclass_correlations_are_those_of_the_definitions() {
    let oracle = oracle();
    for name in ["paper_a", "paper_b", "four", "uneven"] {
        let case = &oracle[name];
        let clusters: Vec<Cluster> = if name == "uneven" {
            let pairs: Vec<(u64, u64)> = serde_json::from_value(case["clusters"].clone()).unwrap();
            pairs.into_iter().map(|(successes, trials)| Cluster { successes, trials }).collect()
        } else {
            Cluster::from_counts(&counts(case))
        };
        let icc = |e| intraclass(&clusters, e).unwrap();
        close(name, icc(IccEstimator::FleissCuzick).icc, &case["icc"]["fleiss_cuzick"], 1e-13);
        close(name, icc(IccEstimator::Anova).icc, &case["icc"]["anova"], 1e-12);
        let beta = icc(IccEstimator::BetaBinomial);
        close(name, beta.icc, &case["beta_binomial"]["icc"], 1e-9);
        close(name, beta.proportion, &case["beta_binomial"]["proportion"], 1e-9);
    }
}

#[test]
fn the_paper_has_093_and_167() {
    let icc = |counts: &[u64], e| intraclass(&Cluster::from_counts(counts), e).unwrap().icc;
    assert_eq!("0.093", format!("{:.3}", icc(&[12, 14, 6], IccEstimator::FleissCuzick)));
    assert_eq!("0.167", format!("{:.3}", icc(&[3, 10, 19], IccEstimator::FleissCuzick)));
    // The other estimator must not pass for it.
    assert_eq!("0.109", format!("{:.3}", icc(&[12, 14, 6], IccEstimator::Anova)));
}

#[test]
fn robust_logit_agrees_with_statsmodels() {
    let oracle = oracle();
    let mut cases: Vec<(&str, Vec<Row>)> = ["paper_a", "paper_b", "four"]
        .map(|n| (n, Row::intercept_only(&Cluster::from_counts(&counts(&oracle[n])))))
        .into();
    cases.push(("design", design(&oracle)));
    for (name, rows) in cases {
        let expected = &oracle[name]["robust"];
        for (correction, key) in
            [(Correction::Cr0, "cr0"), (Correction::Cr1, "cr1"), (Correction::Cr1s, "cr1s")]
        {
            let fit = robust_logit(&rows, correction).unwrap();
            close(name, fit.log_likelihood, &expected["log_likelihood"], 1e-12);
            for (i, c) in fit.coefficients.iter().enumerate() {
                close(name, c.estimate, &expected["beta"][i], 1e-9);
                close(name, c.standard_error, &expected[key][i], 1e-9);
                close(name, fit.naive_standard_errors[i], &expected["naive"][i], 1e-9);
            }
        }
    }
}

#[test]
fn mixed_logit_agrees_with_a_fixed_grid() {
    let oracle = oracle();
    let mut cases: Vec<(&str, Vec<Row>)> = ["paper_a", "paper_b", "four"]
        .map(|n| (n, Row::intercept_only(&Cluster::from_counts(&counts(&oracle[n])))))
        .into();
    cases.push(("design", design(&oracle)));
    for (name, rows) in cases {
        let expected = &oracle[name]["mixed"];
        let fit = mixed_logit(&rows).unwrap();
        close(name, fit.log_likelihood, &expected["log_likelihood"], 1e-11);
        close(name, fit.sigma, &expected["sigma"], 1e-9);
        let p = fit.coefficients.len();
        for (i, c) in fit.coefficients.iter().enumerate() {
            close(name, c.estimate, &expected["beta"][i], 1e-9);
            close(name, c.standard_error, &expected["se"][i], 1e-6);
        }
        close(name, fit.sigma_standard_error.unwrap(), &expected["se"][p], 1e-6);
        assert_eq!(name.starts_with("paper"), fit.saturated);
        // The negative control: the plain logit is another number.
        assert!((fit.log_likelihood_independent / fit.log_likelihood - 1.0).abs() > 1e-3, "{name}");
    }
}

#[test]
fn a_saturated_fit_reproduces_the_moments() {
    // (12, 14, 6): E[p] = 26/64 and E[p²] = 6/32 under the fitted mixture, by a plain sum over z.
    let fit = mixed_logit(&Row::intercept_only(&Cluster::from_counts(&[12, 14, 6]))).unwrap();
    let (mut first, mut second) = (0.0, 0.0);
    for i in -12_000..=12_000 {
        let z = f64::from(i) * 1e-3;
        let w = (-0.5 * z * z).exp() * 1e-3 / std::f64::consts::TAU.sqrt();
        let p = 1.0 / (1.0 + (-(fit.coefficients[0].estimate + fit.sigma * z)).exp());
        first += w * p;
        second += w * p * p;
    }
    assert!((first - 26.0 / 64.0).abs() < 1e-10 && (second - 6.0 / 32.0).abs() < 1e-10);
}

#[test]
fn disagreement_within_participants_puts_sigma_on_its_boundary() {
    // Everybody chose each once: less scatter than chance.
    let fit = mixed_logit(&Row::intercept_only(&Cluster::from_counts(&[1, 20, 2]))).unwrap();
    assert!(fit.boundary && fit.sigma == 0.0 && fit.sigma_p == 1.0 && fit.sigma_standard_error.is_none());
    let consistent = mixed_logit(&Row::intercept_only(&Cluster::from_counts(&[10, 0, 12])));
    assert!(matches!(consistent, Err(StatsError::Separated { .. })));
}

#[test]
fn separated_and_collinear_predictors_are_named() {
    let row = |participant, successes, x: &[f64]| Row { participant, successes, trials: 4, x: x.to_vec() };
    let separated =
        [row(1, 0, &[1.0, 0.0]), row(2, 4, &[1.0, 1.0]), row(3, 0, &[1.0, 0.0]), row(4, 4, &[1.0, 1.0])];
    assert!(matches!(robust_logit(&separated, Correction::Cr1), Err(StatsError::Separated { .. })));
    let collinear = [row(1, 1, &[1.0, 2.0]), row(2, 3, &[1.0, 2.0]), row(3, 2, &[1.0, 2.0])];
    assert_eq!(Err(logit::COLLINEAR), robust_logit(&collinear, Correction::Cr1));
    let ragged = [row(1, 1, &[1.0]), row(2, 3, &[1.0, 2.0])];
    assert!(matches!(robust_logit(&ragged, Correction::Cr1), Err(StatsError::LengthMismatch { .. })));
    let nan = [row(1, 1, &[f64::NAN]), row(2, 3, &[1.0])];
    assert!(matches!(mixed_logit(&nan), Err(StatsError::InvalidElement { .. })));
}

#[test]
fn degenerate_choices_are_named_errors() {
    let same = Cluster::from_counts(&[0, 0, 5]);
    assert!(matches!(intraclass(&same, IccEstimator::Anova), Err(StatsError::ZeroVariance { .. })));
    assert!(matches!(intraclass(&[], IccEstimator::Anova), Err(StatsError::TooFew { .. })));
    let single = Cluster::from_counts(&[4, 5]);
    assert!(matches!(intraclass(&single, IccEstimator::Anova), Err(StatsError::NoSolution { .. })));
    let impossible = [Cluster { successes: 3, trials: 2 }, Cluster { successes: 1, trials: 2 }];
    assert!(matches!(intraclass(&impossible, IccEstimator::Anova), Err(StatsError::InvalidElement { .. })));
}

#[test]
fn the_warning_is_due_when_trials_are_shared() {
    let warning = independence_warning(&Cluster::from_counts(&[3, 10, 19])).unwrap().unwrap();
    assert_eq!((32, 64), (warning.participants, warning.trials));
    assert!((warning.design_effect.unwrap() - 7.0 / 6.0).abs() < 1e-14);
    assert!(warning.message.contains("64 trials") && warning.message.contains("55 independent"));
    assert_eq!(None, independence_warning(&Cluster::from_counts(&[10, 20])).unwrap());
    // Who alternates has not given more answers than there are: 19 chose one of two, one chose none; correlation −1/1.05.
    let alternating = independence_warning(&Cluster::from_counts(&[1, 19, 0])).unwrap().unwrap();
    assert!((alternating.icc.unwrap() + 19.0 / 21.0).abs() < 1e-14, "{alternating:?}");
    assert_eq!(alternating.effective_trials, Some(40.0));
    assert!(
        alternating.message.contains("alternate") && !alternating.message.contains("worth"),
        "{alternating:?}"
    );
    // With everybody the same the correlation is undefined, but the trials are still shared.
    assert!(independence_warning(&Cluster::from_counts(&[0, 0, 9])).unwrap().unwrap().icc.is_none());
}

#[test]
fn scores_that_vanish_give_no_interval_and_no_certainty() {
    // Everybody presses one key, and the sides are balanced: each chooses the target in half of the trials.
    for clusters in [Cluster::from_counts(&[0, 20, 0]), Cluster::from_counts(&[0, 7, 0, 0])] {
        let error = robust_logit(&Row::intercept_only(&clusters), Correction::Cr1).unwrap_err();
        assert!(
            matches!(error, StatsError::NoSolution { what: "the cluster-robust interval", .. }),
            "{error}"
        );
    }
    // Control: one who chose otherwise is a difference between participants.
    let one = Cluster::from_counts(&[0, 20, 1]);
    assert!(
        robust_logit(&Row::intercept_only(&one), Correction::Cr1).unwrap().coefficients[0].standard_error
            > 0.0
    );
}

#[test]
fn a_finite_logit_is_found_however_far_it_reaches() {
    let row = |participant, x, successes| Row { participant, successes, trials: 10, x: vec![1.0, x] };
    let xs = [(-30.0, 0), (-1.0, 2), (-0.5, 4), (0.0, 5), (0.5, 7), (1.0, 8), (30.0, 10)];
    let rows: Vec<Row> = (0..).zip(xs).map(|(i, (x, k))| row(i, x, k)).collect();
    let fit = robust_logit(&rows, Correction::Cr1).unwrap();
    let beta: Vec<f64> = fit.coefficients.iter().map(|c| c.estimate).collect();
    assert!(30.0 * beta[1] > 20.0, "log odds beyond 20: {beta:?}");
    // The score equations hold, written out here.
    for power in [0, 1] {
        let score: f64 = xs
            .iter()
            .map(|&(x, k)| (k as f64 - 10.0 / (1.0 + (-(beta[0] + beta[1] * x)).exp())) * x.powi(power))
            .sum();
        assert!(score.abs() < 1e-9, "{score}");
    }
    // One success of 10¹⁰ trials: log odds of −23 by hand.
    let rare = [(1, 1, 5_000_000_000), (2, 0, 5_000_000_000)].map(|(participant, successes, trials)| Row {
        participant,
        successes,
        trials,
        x: vec![1.0],
    });
    let found = robust_logit(&rare, Correction::Cr1).unwrap().coefficients[0].estimate;
    assert!((found - (1e-10f64 / (1.0 - 1e-10)).ln()).abs() < 1e-6, "{found}");
    // Control: without the overlap there is no maximum, and quasi-complete separation is none either.
    let far = |middle| [(-30.0, 0), (0.0, middle), (30.0, 10)];
    for data in [far(0).to_vec(), far(5).to_vec()] {
        let rows: Vec<Row> = (0..).zip(data).map(|(i, (x, k))| row(i, x, k)).collect();
        let found = robust_logit(&rows, Correction::Cr1);
        assert!(matches!(found, Err(StatsError::Separated { .. })), "{found:?}");
    }
}

fn mean(sample: &[&Cluster]) -> Option<f64> {
    let (k, n) = sample.iter().fold((0, 0), |(k, n), c| (k + c.successes, n + c.trials));
    (n > 0).then(|| k as f64 / n as f64)
}

#[test]
fn the_bootstrap_sees_the_clusters() {
    let clusters = Cluster::from_counts(&[20, 2, 20]);
    let run = |seed| bootstrap(&clusters, 4000, 0.95, seed, BootstrapMethod::Percentile, mean).unwrap();
    assert_eq!(run(1), run(1));
    assert_ne!(run(1).standard_error, run(2).standard_error);
    // The standard error of the mean of participants' proportions, which are 0 (20), ½ (2) and 1 (20); the plain binomial one is far smaller.
    let by_participant = (10.0f64 / 42.0 / 42.0).sqrt();
    assert!((run(1).standard_error / by_participant - 1.0).abs() < 0.05);
    assert!(run(1).standard_error > 1.3 * (0.25f64 / 84.0).sqrt());
}

#[test]
fn the_bootstrap_covers_what_it_claims() {
    // 40 participants × 3 pairs, p = .7, icc = .2. Binomial bounds at 4 standard errors for 400 samples around .95 (minus the method's own
    // small-sample loss), and the negative control: trials resampled as if independent must fall below.
    let (mut hits, mut naive) = (0, 0);
    let runs = 400;
    for run in 0..runs {
        let mut random = Random::stream(99, run);
        let clusters: Vec<Cluster> = (0..40)
            .map(|_| {
                let p = random.beta(0.7, 0.4);
                Cluster { successes: random.binomial(3, p), trials: 3 }
            })
            .collect();
        let b = bootstrap(&clusters, 2000, 0.95, run, BootstrapMethod::BiasCorrected, mean).unwrap();
        hits += u32::from(b.low <= 0.7 && 0.7 <= b.high);
        let se = (b.estimate * (1.0 - b.estimate) / 120.0).sqrt();
        naive += u32::from((b.estimate - 0.7).abs() <= 1.96 * se);
    }
    let share = f64::from(hits) / runs as f64;
    assert!((0.895..=0.985).contains(&share), "covers {share}");
    assert!(f64::from(naive) / (runs as f64) < 0.88, "the naive interval covers {naive} of {runs}");
}

#[test]
fn the_symmetric_interval_of_a_mean_is_students() {
    // Where the statistic is a mean, what is widened is the interval that Student's t gives exactly.
    for n in [6, 12, 40] {
        let values: Vec<f64> = (0..n).map(|i| (f64::from(i) * 0.37).fract()).collect();
        let of = |sample: &[&f64]| Some(sample.iter().copied().sum::<f64>() / sample.len() as f64);
        let half = |method| {
            let found = bootstrap(&values, 40_000, 0.95, 1, method, of).unwrap();
            assert!(found.low < found.estimate && found.estimate < found.high);
            [found.estimate - found.low, found.high - found.estimate]
        };
        let m = f64::from(n);
        let mean = values.iter().sum::<f64>() / m;
        let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (m - 1.0);
        // qt(.975, n − 1), R 4.2.2.
        let t = match n {
            6 => 2.570581835636314,
            12 => 2.200985160082949,
            _ => 2.022690911734728,
        };
        let students = t * (variance / m).sqrt();
        let [low, high] = half(BootstrapMethod::Symmetric);
        // The mean of few values drawn from few has shorter tails than a normal one.
        assert!(
            (low - high).abs() < 1e-12 && (low / students - 1.0).abs() < 0.5 / m,
            "{n}: {low} {students}"
        );
        // Control: the quantiles themselves are narrower, with six participants by a third.
        let [low, high] = half(BootstrapMethod::Percentile);
        assert!(
            (low + high) / 2.0 / students < if n == 6 { 0.75 } else { 0.97 },
            "{n}: {low} {high} {students}"
        );
    }
}

#[test]
fn the_bootstrap_refuses_what_it_cannot_do() {
    let clusters = Cluster::from_counts(&[3, 3, 3]);
    let method = BootstrapMethod::Percentile;
    assert!(bootstrap(&clusters, 1999, 0.95, 0, method, mean).is_err());
    assert!(bootstrap(&clusters, 2000, 1.0, 0, method, mean).is_err());
    assert!(bootstrap(&clusters[..1], 2000, 0.95, 0, method, mean).is_err());
    assert!(bootstrap(&clusters, 2000, 0.95, 0, method, |_| None).is_err());
    let mut calls = 0;
    let rarely = bootstrap(&clusters, 2000, 0.95, 0, method, |_| {
        calls += 1;
        (calls == 1).then_some(1.0)
    });
    assert!(rarely.is_err());
    let alike = bootstrap(&Cluster::from_counts(&[0, 9, 0]), 2000, 0.95, 0, method, mean).unwrap_err();
    assert!(alike.to_string().contains("all resamples agree"), "{alike}");
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(4), ..ProptestConfig::with_cases(200) })]

    #[test]
    fn nothing_panics_and_results_are_numbers(data in prop::collection::vec((0u64..6, 0u64..6), 0..12)) {
        let clusters: Vec<Cluster> = data.iter().map(|&(successes, trials)| Cluster { successes, trials }).collect();
        for e in [IccEstimator::FleissCuzick, IccEstimator::Anova, IccEstimator::BetaBinomial] {
            if let Ok(found) = intraclass(&clusters, e) {
                prop_assert!(found.icc.is_finite() && found.icc <= 1.0 + 1e-12, "{found:?}");
            }
        }
        let _ = independence_warning(&clusters);
        let rows = Row::intercept_only(&clusters);
        if let Ok(fit) = robust_logit(&rows, Correction::Cr1) {
            prop_assert!(fit.coefficients[0].estimate.is_finite() && fit.coefficients[0].p >= 0.0);
        }
        if let Ok(fit) = mixed_logit(&rows) {
            prop_assert!(fit.sigma.is_finite() && fit.log_likelihood >= fit.log_likelihood_independent - 1e-9);
        }
    }
}
