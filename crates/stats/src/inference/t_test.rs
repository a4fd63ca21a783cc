//! Student's t-test of one sample and of paired samples, two-sided.

use serde::Serialize;
use utoipa::ToSchema;

use crate::descriptive::Moments;
use crate::distributions::student_t::StudentT;
use crate::{Result, StatsError};

/// What a one-sample (or paired) t-test says.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
#[schema(as = OneSampleTTest)]
pub struct TTest {
    /// How many values (pairs).
    pub n: u64,
    /// Their mean (the mean difference), in the units of the values.
    pub mean: f64,
    /// Their standard deviation, n − 1 in the denominator.
    pub sd: f64,
    /// The mean under the null hypothesis.
    pub mu: f64,
    /// (mean − mu) / (sd / √n).
    pub t: f64,
    /// Degrees of freedom, n − 1.
    pub df: f64,
    /// Two-sided p-value, P(|T| ≥ |t|) under the null hypothesis; never 0 while it is above 5e-324.
    pub p: f64,
}

/// Tests whether independent, approximately normal values have the mean `mu`.
///
/// # Errors
/// [`StatsError::TooFew`] below two values, [`StatsError::ZeroVariance`] when all are the same (t is then 0/0 or
/// infinite), [`StatsError::InvalidElement`] or [`StatsError::Invalid`] for what is not finite.
pub fn t_test_one_sample(values: &[f64], mu: f64) -> Result<TTest> {
    TTest::from_moments("values", &Moments::of(values)?, mu)
}

/// [`t_test_one_sample`] on a table of (value, how often), such as choices out of two: `[(0.0, 12), (1.0, 14), (2.0, 6)]`.
///
/// # Errors
/// As [`t_test_one_sample`].
pub fn t_test_from_counts(counts: &[(f64, u64)], mu: f64) -> Result<TTest> {
    TTest::from_moments("counts", &Moments::from_counts(counts)?, mu)
}

/// Tests whether the differences `first[i] − second[i]` have the mean 0.
///
/// # Errors
/// As [`t_test_one_sample`], and [`StatsError::LengthMismatch`].
pub fn t_test_paired(first: &[f64], second: &[f64]) -> Result<TTest> {
    t_test_one_sample(&differences(first, second)?, 0.0)
}

/// `first[i] − second[i]`.
pub(crate) fn differences(first: &[f64], second: &[f64]) -> Result<Vec<f64>> {
    if first.len() != second.len() {
        return Err(StatsError::LengthMismatch {
            first: "first",
            first_len: first.len(),
            second: "second",
            second_len: second.len(),
        });
    }
    Ok(first.iter().zip(second).map(|(a, b)| a - b).collect())
}

impl TTest {
    pub(crate) fn from_moments(name: &'static str, moments: &Moments, mu: f64) -> Result<Self> {
        let mu = StatsError::finite("mu", mu)?;
        let sd = moments.spread(name, "t")?;
        let n = moments.n as f64;
        let t = moments.above(mu) / (sd / n.sqrt());
        let df = n - 1.0;
        let p = StudentT::new(df)?.two_sided(t)?;
        Ok(Self { n: moments.n, mean: moments.mean, sd, mu, t, df, p })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    /// The paper's three tests; expected values from R 4.2.2, `t.test(rep(0:2, c(12, 14, 6)), mu = 1)` and so on.
    #[test]
    fn the_papers_three_tests() {
        type Case = (&'static [(f64, u64)], f64, f64, f64);
        let cases: [Case; 3] = [
            (&[(0.0, 12), (1.0, 14), (2.0, 6)], 1.0, -1.4375905768565216, 0.16056863389412473),
            (&[(0.0, 3), (1.0, 10), (2.0, 19)], 1.0, 4.20883424647321, 0.00020378219167228206),
            (&[(0.0, 26), (1.0, 7)], 0.5, -3.9834823795432888, 0.0003668638983360312),
        ];
        for (counts, mu, t, p) in cases {
            let test = t_test_from_counts(counts, mu).unwrap();
            assert!((test.t / t - 1.0).abs() < 1e-14, "{test:?}");
            assert!((test.p / p - 1.0).abs() < 1e-13, "{test:?}");
            let values: Vec<f64> = counts.iter().flat_map(|&(v, n)| vec![v; n as usize]).collect();
            assert_eq!(t_test_one_sample(&values, mu).unwrap(), test);
        }
    }

    #[test]
    fn what_has_no_t_is_a_named_error() {
        assert!(matches!(t_test_one_sample(&[], 1.0), Err(StatsError::TooFew { len: 0, .. })));
        assert!(matches!(t_test_one_sample(&[1.0], 1.0), Err(StatsError::TooFew { len: 1, needed: 2, .. })));
        for mu in [0.1, 0.5] {
            let same = t_test_one_sample(&[0.1; 3], mu);
            assert!(matches!(same, Err(StatsError::ZeroVariance { len: 3, .. })), "{same:?}");
        }
        let nan = t_test_one_sample(&[0.0, f64::NAN], 1.0).unwrap_err();
        assert_eq!(nan.to_string(), "values[1] = NaN: must be finite");
        assert!(t_test_from_counts(&[(0.0, 1), (1.0, 1)], f64::INFINITY).is_err());
        assert!(t_test_paired(&[1.0, 2.0], &[1.0]).is_err());
    }

    #[test]
    fn far_tails_are_not_zero() {
        // 1001 values of mean 1 and standard deviation 1: t = √1001 = 31.6, where 2 (1 − cdf) would be 0.
        let counts = [(0.0, 500), (1.0, 1), (2.0, 500)];
        let test = t_test_from_counts(&counts, 0.0).unwrap();
        assert!(test.p > 1e-154 && test.p < 1e-150, "{test:?}");
    }
}
