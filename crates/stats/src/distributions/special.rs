//! What the densities are made of: the deviance and Stirling's error (Loader 2000, "Fast and accurate computation
//! of binomial probabilities"), in double-double so that deep tails keep their digits.

use super::dd::{Dd, atanh_over};

/// ln √(2π).
pub(crate) const LN_SQRT_2PI: Dd = Dd { hi: 0.9189385332046728, lo: -3.8782941580672414e-17 };

/// a · (r − 1 − ln r) with r = mean / a: how unlikely a count of `a` is under a `mean`, of which `excess` = mean − a is
/// given beside it because neither can be had from the other where they are far apart in size.
pub(crate) fn deviance(a: f64, mean: Dd, excess: Dd) -> Dd {
    let z = excess / a.into();
    if z.hi > -0.5 && z.hi < 1.0 {
        // z − ln(1 + z) without cancellation: with s = z / (2 + z), ln(1 + z) = 2 atanh s and z − 2 s = z s.
        let s = z / (z + 2.0.into());
        let d = z * s - s * s * s * 2.0.into() * atanh_over(s, 1);
        d * a.into()
    } else {
        if mean.hi <= 0.0 {
            return f64::INFINITY.into();
        }
        excess - (mean.ln() - Dd::from(a).ln()) * a.into()
    }
}

/// ln Γ(a) − (a − ½) ln a + a − ln √(2π): what Stirling's formula misses, for a > 0.
pub(crate) fn stirling_error(a: f64) -> Dd {
    /// From here the series below is exact to 1e-18.
    const SERIES_FROM: f64 = 16.0;
    if a >= SERIES_FROM {
        return stirling_series(a).into();
    }
    let steps = (SERIES_FROM - a).ceil();
    let mut product = Dd::from(a);
    let mut shifted = Dd::from(a);
    for _ in 1..steps as u32 {
        shifted = shifted + 1.0.into();
        product = product * shifted;
    }
    shifted = shifted + 1.0.into();
    let half = Dd::from(0.5);
    let a = Dd::from(a);
    (shifted - half) * shifted.ln() - (a - half) * a.ln() - steps.into() - product.ln()
        + stirling_series(shifted.value()).into()
}

/// Σ B₂ₖ / (2k (2k − 1) a^(2k−1)).
fn stirling_series(a: f64) -> f64 {
    const COEFFICIENTS: [f64; 8] = [
        1.0 / 12.0,
        -1.0 / 360.0,
        1.0 / 1260.0,
        -1.0 / 1680.0,
        1.0 / 1188.0,
        -691.0 / 360360.0,
        1.0 / 156.0,
        -3617.0 / 122400.0,
    ];
    let r2 = 1.0 / (a * a);
    COEFFICIENTS.iter().rev().fold(0.0, |sum, c| sum * r2 + c) / a
}

/// ln Γ(a) for a > 0, correct to an ulp of max(1, |ln Γ|).
pub(crate) fn ln_gamma(a: f64) -> f64 {
    if a > 1e300 {
        return if a.is_infinite() { a } else { a * (a.ln() - 1.0) };
    }
    let x = Dd::from(a);
    ((x - 0.5.into()) * x.ln() - x + LN_SQRT_2PI + stirling_error(a)).value()
}

/// ln(1 + z) − z for z > −1, without cancellation.
pub(crate) fn ln_1p_minus(z: f64) -> f64 {
    if !(-0.4..0.7).contains(&z) {
        return z.ln_1p() - z;
    }
    let s = z / (2.0 + z);
    let s2 = s * s;
    let mut sum = 0.0;
    let mut k = terms(s2);
    while k > 0 {
        sum = sum * s2 + 1.0 / f64::from(2 * k + 1);
        k -= 1;
    }
    2.0 * s * s2 * sum - z * s
}

/// How many powers of `r` (≤ 0.07) matter to double precision.
fn terms(r: f64) -> u32 {
    match r {
        r if r < 1e-6 => 3,
        r if r < 1e-3 => 6,
        r if r < 1e-2 => 8,
        _ => 15,
    }
}

/// e^x − 1 − x, without cancellation.
pub(crate) fn exp_m1_minus(x: f64) -> f64 {
    if x.abs() > 0.5 {
        return x.exp_m1() - x;
    }
    let mut term = x * x / 2.0;
    let mut sum = term;
    let mut k = 3.0;
    while term.abs() > 1e-17 * sum {
        term *= x / k;
        sum += term;
        k += 1.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// mpmath.loggamma.
    #[test]
    fn ln_gamma_is_exact_everywhere() {
        for (a, expected) in [
            (1e-10, 23.025850929882735),
            (0.5, 0.5723649429247001),
            (1.4616321449683622, -0.12148629053584961),
            (7.25, 7.05218545073854),
            (100.0, 359.1342053695754),
            (1e10, 220258509288.81058),
            (1e305, 7.012884533631839e307),
        ] {
            let error = (ln_gamma(a) - expected).abs() / expected.abs();
            assert!(error < 3e-16, "{a}: {} {error:e}", ln_gamma(a));
        }
    }
}
