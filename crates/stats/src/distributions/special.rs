//! What the densities are made of: the deviance and Stirling's error (Loader 2000, "Fast and accurate computation
//! of binomial probabilities"), in double-double so that deep tails keep their digits.

use super::dd::{Dd, atanh_over};

/// ln √(2π).
pub(crate) const LN_SQRT_2PI: Dd = Dd { hi: 0.9189385332046728, lo: -3.8782941580672414e-17 };

/// a · (r − 1 − ln r) with r = (a + excess) / a ≥ 0: how unlikely a count of `a` is under a mean of `a + excess`.
pub(crate) fn deviance(a: f64, excess: Dd) -> Dd {
    let z = excess / a.into();
    if z.hi > -0.5 && z.hi < 1.0 {
        // z − ln(1 + z) without cancellation: with s = z / (2 + z), ln(1 + z) = 2 atanh s and z − 2 s = z s.
        let s = z / (z + 2.0.into());
        let d = z * s - s * s * s * 2.0.into() * atanh_over(s, 1);
        d * a.into()
    } else {
        let mean = excess + a.into();
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
#[allow(dead_code)] // for the Bayes factor and the fits
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

/// e^−s − 1 + s for s ≥ 0, without cancellation.
pub(crate) fn exp_neg_m1_plus(s: f64) -> f64 {
    if s > 0.5 {
        return (-s).exp_m1() + s;
    }
    let mut term = s * s / 2.0;
    let mut sum = term;
    let mut k = 3.0;
    while term.abs() > 1e-17 * sum {
        term *= -s / k;
        sum += term;
        k += 1.0;
    }
    sum
}

/// ∫₀^∞ exp(g(s)) ds for a decreasing g with g(0) = 0 and slope −`slope` there, that falls over a length of about
/// 1 / `rate` or more: the trapezoid rule in ln s, which converges like exp(−π²/2h) for anything between an
/// exponential and a Gaussian.
pub(crate) fn integrate_decay(g: impl Fn(f64) -> f64, slope: f64, rate: f64) -> f64 {
    const STEP: f64 = 0.125;
    /// Left of `START / rate` the integrand is 1 − slope · s to 1e-17 of the whole.
    const START: f64 = 2e-6;
    let first = START / rate;
    let ratio = (-STEP).exp();
    let mut sum = first / (1.0 - ratio) - slope * first * first / (1.0 - ratio * ratio);
    let mut last = 0.0;
    for k in 1..20_000 {
        let s = first * (f64::from(k) * STEP).exp();
        let term = s * g(s).exp();
        sum += term;
        if term < last && term < 1e-18 * sum || !s.is_finite() {
            break;
        }
        last = term;
    }
    sum * STEP
}
