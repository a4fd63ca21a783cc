#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use kelir_stats::Result;
use kelir_stats::descriptive::{Moments, autocorrelation, one_way_anova};
use kelir_stats::distributions::{Beta, Binomial, ChiSquared, FisherF, NoncentralT, StudentT, normal};
use kelir_stats::inference::*;
use proptest::num::f64::ANY;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(20_110_809),
        failure_persistence: None,
        ..Default::default()
    }
}

/// An error or a number, never NaN.
fn number(result: Result<f64>) -> std::result::Result<(), TestCaseError> {
    if let Ok(value) = result {
        prop_assert!(!value.is_nan());
    }
    Ok(())
}

/// An error or a probability.
fn probability(result: Result<f64>) -> std::result::Result<(), TestCaseError> {
    if let Ok(p) = result {
        prop_assert!((0.0..=1.0).contains(&p), "{p}");
    }
    Ok(())
}

/// Any f64 as it is, or folded to where the functions are defined.
fn arguments() -> impl Strategy<Value = (f64, f64, f64)> {
    let any = || prop_oneof![ANY, -40.0..40.0, 0.0..1.0, (-300.0..300.0).prop_map(|e: f64| 10f64.powf(e))];
    (any(), any(), any())
}

/// Sizes from 0.01 to 1e6 on the log scale.
fn size() -> impl Strategy<Value = f64> {
    (-2.0..6.0).prop_map(|e: f64| 10f64.powf(e))
}

proptest! {
    #![proptest_config(config(2000))]

    #[test]
    fn no_input_panics_or_gives_nan((x, y, z) in arguments()) {
        for p in [normal::cdf(x), normal::sf(x)] {
            probability(p)?;
        }
        for v in [normal::pdf(x), normal::ln_cdf(x), normal::ln_sf(x), normal::quantile(x), normal::quantile_sf(x)] {
            number(v)?;
        }
        let t = StudentT::new(x);
        probability(t.clone().and_then(|t| t.cdf(y)))?;
        probability(t.clone().and_then(|t| t.sf(y)))?;
        probability(t.clone().and_then(|t| t.two_sided(y)))?;
        number(t.clone().and_then(|t| t.ln_sf(y)))?;
        number(t.clone().and_then(|t| t.pdf(y)))?;
        number(t.and_then(|t| t.quantile(y)))?;
        let beta = Beta::new(x, y);
        probability(beta.clone().and_then(|b| b.cdf(z)))?;
        probability(beta.clone().and_then(|b| b.sf(z)))?;
        number(beta.clone().and_then(|b| b.ln_cdf(z)))?;
        number(beta.clone().and_then(|b| b.ln_sf(z)))?;
        probability(beta.clone().and_then(|b| b.tails_at_complement(z)).map(|t| t.0))?;
        probability(beta.and_then(|b| b.quantile(z)))?;
        let chi = ChiSquared::new(x);
        probability(chi.clone().and_then(|c| c.cdf(y)))?;
        probability(chi.clone().and_then(|c| c.sf(y)))?;
        number(chi.and_then(|c| c.quantile(y)))?;
        let f = FisherF::new(x, y);
        probability(f.clone().and_then(|f| f.cdf(z)))?;
        probability(f.and_then(|f| f.sf(z)))?;
        let binomial = Binomial::new(x as u64, y);
        probability(binomial.clone().map(|b| b.cdf(z as u64)))?;
        probability(binomial.clone().map(|b| b.sf(z as u64)))?;
        probability(binomial.clone().map(|b| b.pmf(z as u64)))?;
        number(binomial.map(|b| b.ln_pmf(z as u64)))?;
    }
}

proptest! {
    #![proptest_config(config(300))]

    #[test]
    fn no_input_panics_or_gives_nan_in_noncentral_t_and_inference((x, y, z) in arguments()) {
        let t = NoncentralT::new(x, y);
        probability(t.clone().and_then(|t| t.cdf(z)))?;
        probability(t.and_then(|t| t.sf(z)))?;
        number(NoncentralT::delta_with_sf(x, y, z))?;
        if let Ok(test) = t_test_one_sample(&[x, y, z], x) {
            number(Ok(test.t))?;
            probability(Ok(test.p))?;
            number(effect_size(&test, 0.95).map(|e| e.g_interval.low))?;
            number(equivalence(&test, y).map(|e| e.p))?;
            number(jzs_bayes_factor(&test, z).map(|b| b.ln_bf10))?;
        }
        number(Moments::of(&[x, y]).map(|m| m.mean))?;
        number(autocorrelation(&[x, y, z, x], 1))?;
        number(one_way_anova(&[&[x, y], &[z, x]]).map(|a| a.f))?;
        let (k, n) = (x as u64, y as u64);
        probability(binomial_test(k, n, z).map(|b| b.p))?;
        for interval in [wilson(k, n, z), clopper_pearson(k, n, z), jeffreys(k, n, z)] {
            probability(interval.clone().map(|i| i.low))?;
            probability(interval.map(|i| i.high))?;
        }
        probability(wilcoxon_signed_rank(&[x, y, z], 0.5).map(|w| w.p))?;
        probability(sign_test(&[x, y, z], 0.5).map(|w| w.p))?;
        probability(power_t(k, y, z).map(|p| p.power))?;
        probability(power_binomial(k.min(1000), y, z, x).map(|p| p.power))?;
        number(dprime_2afc(k, n, ExtremeRates::LogLinear, z).map(|d| d.se))?;
        let _ = (holm(&[x, y, z]), hochberg(&[x, y, z]), benjamini_hochberg(&[x, y, z]));
    }
}

/// 1 when a ≤ b but for rounding.
fn at_most(a: f64, b: f64) -> bool {
    a <= b + 4e-15 * b.abs()
}

proptest! {
    #![proptest_config(config(400))]

    #[test]
    fn cdfs_grow_and_tails_complement(df in size(), b in size(), (x1, x2) in (-30.0..30.0_f64, -30.0..30.0_f64), (p1, p2) in (0.0..1.0_f64, 0.0..1.0_f64)) {
        let (x1, x2) = (x1.min(x2), x1.max(x2));
        let (p1, p2) = (p1.min(p2), p1.max(p2));
        let t = StudentT::new(df).unwrap();
        let beta = Beta::new(df, b).unwrap();
        let chi = ChiSquared::new(df).unwrap();
        let pairs = [
            (normal::cdf(x1), normal::sf(x1), normal::cdf(x2)),
            (t.cdf(x1), t.sf(x1), t.cdf(x2)),
            (beta.cdf(p1), beta.sf(p1), beta.cdf(p2)),
            (chi.cdf(p1 * df), chi.sf(p1 * df), chi.cdf(p2 * df)),
        ];
        for (lower, upper, later) in pairs {
            let (lower, upper, later) = (lower.unwrap(), upper.unwrap(), later.unwrap());
            prop_assert!((lower + upper - 1.0).abs() < 1e-14, "{lower} + {upper}");
            prop_assert!(at_most(lower, later), "{lower} {later}");
        }
        // Mirror images.
        let close = |a: f64, b: f64| a == b || (a / b - 1.0).abs() < 1e-14;
        prop_assert!(close(t.cdf(x1).unwrap(), t.sf(-x1).unwrap()));
        let binomial = Binomial::new(1000, p1).unwrap();
        let k = (p2 * 999.0) as u64;
        prop_assert!((binomial.cdf(k) + binomial.sf(k) - 1.0).abs() < 1e-14);
        let below = if k == 0 { 0.0 } else { binomial.cdf(k - 1) };
        prop_assert!((binomial.cdf(k) - binomial.pmf(k) - below).abs() < 1e-14);
    }

    #[test]
    fn quantiles_invert_cdfs(df in 0.5..1000.0_f64, b in 0.5..1000.0_f64, exponent in -290.0..-0.31_f64) {
        let p = 10f64.powf(exponent);
        // The relative error of a tail is that of its argument times its slope: up to 1400 for the normal, a for the beta.
        let close = |value: f64| prop_assert_ok((value / p - 1.0).abs() < 1e-12, value, p);
        close(normal::cdf(normal::quantile(p).unwrap()).unwrap())?;
        let t = StudentT::new(df).unwrap();
        let x = t.quantile_sf(p).unwrap();
        if x < f64::MAX {
            close(t.sf(x).unwrap())?;
        }
        let beta = Beta::new(df, b).unwrap();
        let x = beta.quantile(p).unwrap();
        if x > f64::MIN_POSITIVE && x < 0.5 {
            close(beta.cdf(x).unwrap())?;
        }
        let chi = ChiSquared::new(df).unwrap();
        let x = chi.quantile(p).unwrap();
        if x > f64::MIN_POSITIVE {
            close(chi.cdf(x).unwrap())?;
        }
        close(chi.sf(chi.quantile_sf(p).unwrap()).unwrap())?;
    }
}

fn prop_assert_ok(holds: bool, value: f64, expected: f64) -> std::result::Result<(), TestCaseError> {
    prop_assert!(holds, "{value} instead of {expected}");
    Ok(())
}
