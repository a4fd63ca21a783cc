#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use std::collections::HashMap;

use kelir_stats::StatsError;
use kelir_stats::inference::*;

/// Expected values by `tests/data/make_inference.R` and `make_inference.py`.
struct Expected(HashMap<&'static str, f64>);

impl Expected {
    fn from(text: &'static str) -> Self {
        Self(
            text.lines()
                .map(|line| line.split_once('\t').unwrap())
                .map(|(k, v)| (k, v.parse().unwrap()))
                .collect(),
        )
    }

    fn r() -> Self {
        Self::from(include_str!("../data/inference_r.tsv"))
    }

    fn python() -> Self {
        Self::from(include_str!("../data/inference_py.tsv"))
    }

    /// `value` is the expected one to 1e-12.
    fn check(&self, key: &str, value: f64) {
        self.check_to(1e-12, key, value);
    }

    fn check_to(&self, tolerance: f64, key: &str, value: f64) {
        let expected = *self.0.get(key).unwrap_or_else(|| panic!("no expected value for {key}"));
        assert!(
            (value - expected).abs() <= tolerance * expected.abs(),
            "{key}: {value} instead of {expected}, off by {:e}",
            ((value - expected) / expected).abs()
        );
    }
}

fn values(counts: &[u64]) -> Vec<f64> {
    counts.iter().enumerate().flat_map(|(v, &n)| std::iter::repeat_n(v as f64, n as usize)).collect()
}

fn samples() -> [(&'static str, Vec<f64>, f64); 5] {
    [
        ("mc", values(&[12, 14, 6]), 1.0),
        ("photo", values(&[3, 10, 19]), 1.0),
        ("video", values(&[26, 7]), 0.5),
        ("small", vec![1.5, -0.25, 3.0], 0.0),
        ("large", vec![1e9 + 1.0, 1e9 + 2.0, 1e9 + 4.0], 1e9),
    ]
}

#[test]
fn t_tests_are_those_of_r() {
    let r = Expected::r();
    for (name, values, mu) in samples() {
        let test = t_test_one_sample(&values, mu).unwrap();
        if name == "large" {
            // 1, 2 and 4 above 1e9, of which R's t keeps 7 digits.
            assert!((test.t / 7f64.sqrt() - 1.0).abs() < 1e-15, "{test:?}");
        } else {
            r.check(&format!("t.{name}"), test.t);
            r.check(&format!("t_p.{name}"), test.p);
        }
        // The same differences as pairs.
        let zeros = vec![mu; values.len()];
        assert_eq!(t_test_paired(&values, &zeros).unwrap().t, test.t);
    }
}

#[test]
fn effect_sizes_and_bayes_factors_are_those_of_mpmath() {
    let py = Expected::python();
    for (name, values, mu) in samples().into_iter().take(3) {
        let test = t_test_one_sample(&values, mu).unwrap();
        let effect = effect_size(&test, 0.95).unwrap();
        py.check(&format!("d.{name}"), effect.d);
        py.check(&format!("g.{name}"), effect.g);
        py.check(&format!("d_low.{name}"), effect.d_interval.low);
        py.check(&format!("d_high.{name}"), effect.d_interval.high);
        py.check(&format!("g_low.{name}"), effect.g_interval.low);
        py.check(&format!("g_high.{name}"), effect.g_interval.high);
        let bayes = jzs_bayes_factor(&test, ORDINARY_PRIOR_SCALE).unwrap();
        py.check(&format!("ln_bf10.{name}"), bayes.ln_bf10);
    }
}

/// R's BayesFactor integrates to some 1e-8 itself.
#[test]
fn bayes_factors_are_those_of_r() {
    let r = Expected::r();
    for (t, n, key) in [
        (-1.43759057685652, 32, "ln_bf10.-1.43759057685652/32"),
        (0.0, 20, "ln_bf10.0/20"),
        (12.0, 50, "ln_bf10.12/50"),
    ] {
        let test = TTest { n, mean: 0.0, sd: 1.0, mu: 0.0, t, df: n as f64 - 1.0, p: 1.0 };
        r.check_to(1e-7, key, jzs_bayes_factor(&test, ORDINARY_PRIOR_SCALE).unwrap().ln_bf10);
    }
}

#[test]
fn binomial_tests_and_intervals_are_those_of_r() {
    let r = Expected::r();
    let mut checked = 0;
    for key in r.0.keys().filter_map(|key| key.strip_prefix("binom_p.")) {
        let (counts, p0) =
            key.split_once('.').map(|(c, p)| (c, format!("0.{}", p.trim_start_matches("0.")))).unwrap();
        let p0: f64 = if key.ends_with("3e-04") { 3e-4 } else { p0.parse().unwrap() };
        let (x, n) = counts.split_once('/').unwrap();
        let (x, n) = (x.parse::<f64>().unwrap() as u64, n.parse::<f64>().unwrap() as u64);
        // R's sum over 1e6 likelihoods is good to 1e-10.
        let tolerance = if n > 1000 { 1e-10 } else { 1e-12 };
        r.check_to(tolerance, &format!("binom_p.{key}"), binomial_test(x, n, p0).unwrap().p);
        if n <= 1000 {
            type Method = fn(u64, u64, f64) -> kelir_stats::Result<Interval>;
            let methods: [(&str, Method); 3] =
                [("clopper", clopper_pearson), ("jeffreys", jeffreys), ("wilson", wilson)];
            for (name, interval) in methods {
                let interval = interval(x, n, 0.95).unwrap();
                r.check(&format!("{name}_low.{counts}"), interval.low);
                r.check(&format!("{name}_high.{counts}"), interval.high);
            }
        }
        checked += 1;
    }
    assert_eq!(checked, 12);
}

#[test]
fn rank_tests_count_ties() {
    let (r, py) = (Expected::r(), Expected::python());
    for (name, values) in [("mc", values(&[12, 14, 6])), ("photo", values(&[3, 10, 19]))] {
        r.check(&format!("sign_p.{name}"), sign_test(&values, 1.0).unwrap().p);
        let ranks = wilcoxon_signed_rank(&values, 1.0).unwrap();
        r.check(&format!("wilcoxon_v.{name}"), ranks.v);
        r.check(&format!("wilcoxon_p.{name}"), ranks.p);
    }
    let mixed = [1.1, -0.3, 2.5, 2.5, -1.1, 0.0, 4.0, 0.3, -0.3, 7.0];
    r.check("wilcoxon_v.mixed", wilcoxon_signed_rank(&mixed, 0.0).unwrap().v);
    py.check("wilcoxon_all_signs.tied", wilcoxon_signed_rank(&mixed, 0.0).unwrap().p);
    let plain = [1.0, -2.0, 3.0, 4.0, 5.0, -6.0, 7.0, 8.0, 9.0, 10.0, -11.0];
    py.check("wilcoxon_all_signs.plain", wilcoxon_signed_rank(&plain, 0.0).unwrap().p);
    // Above 500 values, R's normal approximation with continuity correction.
    let many: Vec<f64> = (0..510).map(|i| f64::from((i * 37) % 101) - 47.0).collect();
    let normal = wilcoxon_signed_rank(&many, 0.0).unwrap();
    assert_eq!(normal.method, RankMethod::Normal);
    r.check("wilcoxon_normal_p", normal.p);
    assert_eq!(wilcoxon_signed_rank(&many[..500], 0.0).unwrap().method, RankMethod::Exact);
}

#[test]
fn decimals_tie_as_they_are_written() {
    // exactRankTests::wilcox.exact(c(-1, 1, 1, 1, -1, 1, 1, 1)): V = 27, p = 0.2890625. In doubles 0.2 − 0.1 and 0.3 − 0.2 differ.
    let found = wilcoxon_signed_rank(&[0.1, 0.3, 0.3, 0.3, 0.1, 0.3, 0.3, 0.3], 0.2).unwrap();
    assert_eq!((found.v, found.p), (27.0, 0.2890625));
    // What equals mu but for rounding is left out: 0.1 + 0.2 is 0.30000000000000004.
    assert_eq!(wilcoxon_signed_rank(&[0.3, 0.5, 0.1], 0.1 + 0.2).unwrap().n, 2);
    // Control: distances that do differ do not tie.
    assert_eq!(wilcoxon_signed_rank(&[0.1, 0.301, 0.3], 0.2).unwrap().v, 4.5);
}

#[test]
fn corrections_are_those_of_r() {
    let r = Expected::r();
    let p = [0.160569, 2.03782e-4, 3.66864e-4, 0.04, 0.04, 0.9, 1.0, 0.0];
    for (name, adjusted) in [("holm", holm(&p)), ("hochberg", hochberg(&p)), ("BH", benjamini_hochberg(&p))] {
        for (i, value) in adjusted.unwrap().into_iter().enumerate() {
            r.check(&format!("{name}.{i}"), value);
        }
    }
    assert!(holm(&[]).unwrap().is_empty());
    assert!(matches!(holm(&[0.5, f64::NAN]), Err(StatsError::InvalidElement { index: 1, .. })));
}

#[test]
fn power_is_that_of_mpmath_and_r() {
    let (r, py) = (Expected::r(), Expected::python());
    for (n, d, key) in [
        (32, 0.5, "0.5"),
        (32, 0.2, "0.2"),
        (10, 1.0, "1.0"),
        (3, 0.7, "0.7"),
        (32, -0.248, "-0.248"),
        (200, 0.05, "0.05"),
    ] {
        py.check(&format!("power_t.{n}.{key}"), power_t(n, d, 0.05).unwrap().power);
    }
    r.check_to(1e-10, "power_t.32.0.5", power_t(32, 0.5, 0.05).unwrap().power);
    for (n, p0, p1) in [(32, 0.5, 0.7), (33, 0.5, 7.0 / 33.0), (50, 0.3, 0.4), (12, 0.9, 0.5)] {
        let plan = power_binomial(n, p0, p1, 0.05).unwrap();
        py.check(&format!("binomial_size.{n}.{p0}"), plan.size);
        py.check(&format!("binomial_power.{n}.{p0}"), plan.power);
    }
}

#[test]
fn sample_sizes_are_the_smallest() {
    // R: power.t.test(delta = 0.5, power = 0.8, type = "one.sample")$n is 33.37.
    assert_eq!(sample_size_t(0.5, 0.05, 0.8).unwrap().n, 34);
    for (d, power) in [(0.2, 0.9), (2.0, 0.8), (-0.7, 0.5)] {
        let plan = sample_size_t(d, 0.05, power).unwrap();
        assert!(plan.power >= power && (plan.n == 2 || power_t(plan.n - 1, d, 0.05).unwrap().power < power));
    }
    assert!(matches!(sample_size_t(0.0, 0.05, 0.8), Err(StatsError::NoSolution { .. })));
    for (p0, p1, power) in [(0.5, 0.7, 0.8), (0.5, 0.25, 0.9), (0.05, 0.15, 0.8), (0.3, 0.9, 0.95)] {
        let plan = sample_size_binomial(p0, p1, 0.05, power).unwrap();
        let at = |n: u64| power_binomial(n, p0, p1, 0.05).unwrap().power;
        assert!(plan.n == 1 || at(plan.n - 1) < power, "{plan:?}");
        assert!((plan.n..3 * plan.n + 100).all(|n| at(n) >= power), "{plan:?}");
    }
    assert!(sample_size_binomial(0.5, 0.5, 0.05, 0.8).is_err());
    assert!(sample_size_binomial(0.5, 0.501, 0.05, 0.8).is_err());
    let plan = detectable_effect_t(32, 0.05, 0.8).unwrap();
    assert!((plan.power - 0.8).abs() < 1e-12, "{plan:?}");
}

#[test]
fn equivalence_is_two_one_sided_tests_of_r() {
    let r = Expected::r();
    let test = t_test_from_counts(&[(0.0, 12), (1.0, 14), (2.0, 6)], 1.0).unwrap();
    let points = equivalence(&test, 0.5).unwrap();
    r.check("tost_p.points", points.p);
    r.check("tost_p.sd", equivalence(&test, 0.5 * test.sd).unwrap().p);
    r.check("tost_low", points.interval_90.low);
    r.check("tost_high", points.interval_90.high);
    assert!(equivalence(&test, 0.0).is_err());
}

#[test]
fn sensitivity_and_agreement() {
    let (r, py) = (Expected::r(), Expected::python());
    for (x, n) in [(48, 64), (20, 64), (33, 34)] {
        let d = dprime_2afc(x, n, ExtremeRates::Refuse, 0.95).unwrap();
        r.check(&format!("dprime.{x}/{n}"), d.dprime);
        assert!(d.interval.low < d.dprime && d.dprime < d.interval.high);
    }
    assert!(matches!(dprime_2afc(64, 64, ExtremeRates::Refuse, 0.95), Err(StatsError::NoSolution { .. })));
    assert_eq!(dprime_2afc(64, 64, ExtremeRates::HalfTrial, 0.95).unwrap().proportion, 63.5 / 64.0);
    assert_eq!(dprime_2afc(0, 64, ExtremeRates::LogLinear, 0.95).unwrap().proportion, 0.5 / 65.0);

    let wikipedia: [&[u64]; 10] = [
        &[0, 0, 0, 0, 14],
        &[0, 2, 6, 4, 2],
        &[0, 0, 3, 5, 6],
        &[0, 3, 9, 2, 0],
        &[2, 2, 8, 1, 1],
        &[7, 7, 0, 0, 0],
        &[3, 2, 6, 3, 0],
        &[2, 5, 3, 2, 2],
        &[6, 5, 2, 1, 0],
        &[0, 2, 2, 3, 7],
    ];
    let binary: [&[u64]; 5] = [&[3, 0], &[2, 1], &[0, 3], &[3, 0], &[1, 2]];
    for (name, table) in [("wikipedia", &wikipedia[..]), ("binary", &binary[..])] {
        let kappa = fleiss_kappa(table).unwrap();
        py.check(&format!("fleiss.{name}"), kappa.kappa);
        py.check(&format!("fleiss_se.{name}"), kappa.se_null);
    }
    assert!(matches!(fleiss_kappa(&[&[3, 0], &[3, 0]]), Err(StatsError::NoSolution { .. })));
    assert!(matches!(fleiss_kappa(&[&[3, 0], &[2, 0]]), Err(StatsError::InvalidElement { index: 1, .. })));
    assert!(
        fleiss_kappa(&[]).is_err()
            && fleiss_kappa(&[&[1, 0]]).is_err()
            && fleiss_kappa(&[&[2], &[2]]).is_err()
    );
}

#[test]
fn bad_input_is_named() {
    assert_eq!(
        binomial_test(3, 2, 0.5).unwrap_err().to_string(),
        "successes = 3: must not exceed the number of trials"
    );
    assert!(
        binomial_test(0, 0, 0.5).is_err()
            && binomial_test(1, 2, f64::NAN).is_err()
            && binomial_test(1, 2, 1.1).is_err()
    );
    assert!(sign_test(&[1.0, 1.0], 1.0).is_err() && wilcoxon_signed_rank(&[f64::INFINITY], 1.0).is_err());
    assert!(
        wilson(1, 2, 1.0).is_err()
            && clopper_pearson(1, 0, 0.9).is_err()
            && jeffreys(1, 2, f64::NAN).is_err()
    );
    assert!(
        power_t(1, 0.5, 0.05).is_err()
            && power_t(10, f64::NAN, 0.05).is_err()
            && power_t(10, 0.5, 0.0).is_err()
    );
    assert!(power_binomial(10, 0.5, 2.0, 0.05).is_err() && power_binomial(0, 0.5, 0.6, 0.05).is_err());
    let test = t_test_one_sample(&[0.0, 1.0], 0.5).unwrap();
    assert!(effect_size(&test, 0.0).is_err() && jzs_bayes_factor(&test, f64::NAN).is_err());
    // Two participants: no unbiased effect size.
    assert_eq!(effect_size(&test, 0.95).unwrap().g, 0.0);
    // Certain hypotheses.
    assert_eq!(binomial_test(0, 5, 0.0).unwrap().p, 1.0);
    assert_eq!(binomial_test(1, 5, 0.0).unwrap().p, 0.0);
    assert_eq!(binomial_test(5, 5, 1.0).unwrap().p, 1.0);
}
