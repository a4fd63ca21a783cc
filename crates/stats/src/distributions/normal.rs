//! The standard normal distribution.
//!
//! Tails by the trapezoid rule for e^(z²) erfc(z) with its pole corrected (Chiarella & Reichel 1968; Hunter & Regan
//! 1972), step ½, exact to 1e-17; the centre by the series of positive terms φ(x) Σ x^(2k+1) / (2k+1)!!. x² is
//! formed exactly, so that tails keep their digits down to 1e-308.

use super::dd::Dd;
use super::root::{self, Local};
use crate::{Result, StatsError};

/// √(2π).
const SQRT_2PI: f64 = 2.506_628_274_631_000_5;

/// φ(x), the density.
///
/// # Errors
/// [`StatsError::Invalid`] when x is NaN.
pub fn pdf(x: f64) -> Result<f64> {
    StatsError::number("x", x).map(density)
}

/// Φ(x) = P(X ≤ x).
///
/// # Errors
/// [`StatsError::Invalid`] when x is NaN.
pub fn cdf(x: f64) -> Result<f64> {
    StatsError::number("x", x).map(lower)
}

/// P(X > x), the upper tail itself and not 1 − Φ.
///
/// # Errors
/// [`StatsError::Invalid`] when x is NaN.
pub fn sf(x: f64) -> Result<f64> {
    StatsError::number("x", x).map(|x| lower(-x))
}

/// ln Φ(x); goes on where Φ underflows.
///
/// # Errors
/// [`StatsError::Invalid`] when x is NaN.
pub fn ln_cdf(x: f64) -> Result<f64> {
    StatsError::number("x", x).map(ln_lower)
}

/// ln P(X > x).
///
/// # Errors
/// [`StatsError::Invalid`] when x is NaN.
pub fn ln_sf(x: f64) -> Result<f64> {
    StatsError::number("x", x).map(|x| ln_lower(-x))
}

/// The x with Φ(x) = p; −∞ and ∞ at 0 and 1.
///
/// # Errors
/// [`StatsError::Invalid`] unless p is in [0, 1].
pub fn quantile(p: f64) -> Result<f64> {
    StatsError::probability("p", p).map(inverse)
}

/// The x with P(X > x) = q: exact for tiny q, where `quantile(1 − q)` cannot be.
///
/// # Errors
/// [`StatsError::Invalid`] unless q is in [0, 1].
pub fn quantile_sf(q: f64) -> Result<f64> {
    StatsError::probability("q", q).map(|q| -inverse(q))
}

/// φ(x) for a number x.
pub(crate) fn density(x: f64) -> f64 {
    if x.abs() > 1e150 { 0.0 } else { half_square(x).exp() / SQRT_2PI }
}

/// Φ(x) for a number x.
pub(crate) fn lower(x: f64) -> f64 {
    if x < 0.0 {
        upper_and_ln(-x).0
    } else if x < CENTRE {
        0.5 + central(x)
    } else {
        1.0 - upper_and_ln(x).0
    }
}

/// ln Φ(x) for a number x.
pub(crate) fn ln_lower(x: f64) -> f64 {
    if x < 0.0 { upper_and_ln(-x).1 } else { (-upper_and_ln(x).0).ln_1p() }
}

/// Below this the series for the centre is used.
const CENTRE: f64 = 0.75;

/// P(X > x) and its logarithm for x ≥ 0.
pub(crate) fn upper_and_ln(x: f64) -> (f64, f64) {
    if x < CENTRE {
        let upper = 0.5 - central(x);
        return (upper, upper.ln());
    }
    if x > 1e150 {
        return (0.0, -0.5 * x * x);
    }
    let exponent = half_square(x);
    let half_scaled = 0.5 * scaled_erfc(x * std::f64::consts::FRAC_1_SQRT_2);
    (exponent.exp() * half_scaled, exponent.value() + half_scaled.ln())
}

/// P(0 < X < x) for x ≥ 0.
pub(crate) fn central(x: f64) -> f64 {
    if x >= CENTRE {
        return 0.5 - upper_and_ln(x).0;
    }
    let (mut term, mut sum, mut k) = (x, x, 1.0);
    while term > 1e-17 * sum {
        k += 2.0;
        term *= x * x / k;
        sum += term;
    }
    sum * density(x)
}

/// Φ⁻¹(p) for p in [0, 1].
pub(crate) fn inverse(p: f64) -> f64 {
    if p > 0.5 {
        return positive_inverse(1.0 - p, p - 0.5);
    }
    -positive_inverse(p, 0.5 - p)
}

/// The x ≥ 0 with P(X > x) = q, where `share` = ½ − q lies between 0 and x.
fn positive_inverse(q: f64, share: f64) -> f64 {
    if q == 0.0 {
        return f64::INFINITY;
    }
    if share < 1e-9 {
        return share * SQRT_2PI;
    }
    // Abramowitz & Stegun 26.2.23, absolute error 4.5e-4.
    let t = (-2.0 * q.ln()).sqrt();
    let start = t
        - (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
    if share < 0.25 {
        let f = |x: f64| Local { value: central(x) - share, slope: density(x) };
        root::increasing(&f, 0.0, 1.0, start)
    } else {
        let target = q.ln();
        let f = |x: f64| {
            let (upper, ln_upper) = upper_and_ln(x);
            let value =
                if upper >= f64::MIN_POSITIVE { ((q - upper) / upper).ln_1p() } else { target - ln_upper };
            let slope = if upper > 0.0 { density(x) / upper } else { x };
            Local { value, slope }
        };
        root::increasing(&f, 0.5, 40.0, start)
    }
}

/// −x² / 2, exactly.
fn half_square(x: f64) -> Dd {
    let square = Dd::product(x, x);
    Dd { hi: -0.5 * square.hi, lo: -0.5 * square.lo }
}

/// e^(z²) erfc(z) for z ≥ ½.
fn scaled_erfc(z: f64) -> f64 {
    const STEP: f64 = 0.5;
    /// e^(−n² / 4), n = 1 … 12.
    const WEIGHTS: [f64; 12] = [
        0.778_800_783_071_404_9,
        0.367_879_441_171_442_3,
        0.105_399_224_561_864_34,
        0.018_315_638_888_734_18,
        0.001_930_454_136_227_709_2,
        1.234_098_040_866_795_5e-4,
        4.785_117_392_129_009e-6,
        1.125_351_747_192_591_1e-7,
        1.605_228_055_185_611_6e-9,
        1.388_794_386_496_402e-11,
        7.287_724_095_819_692e-14,
        2.319_522_830_243_569_4e-16,
    ];
    let z2 = z * z;
    let mut sum = 0.0;
    let mut n = WEIGHTS.len();
    for weight in WEIGHTS.iter().rev() {
        let node = n as f64 * STEP;
        sum += weight / (z2 + node * node);
        n -= 1;
    }
    let trapezoid = STEP * z / std::f64::consts::PI * (1.0 / z2 + 2.0 * sum);
    if z > 6.3 {
        return trapezoid;
    }
    // The pole of 1 / (z² + t²) at t = iz.
    trapezoid - 2.0 * z2.exp() / (std::f64::consts::TAU * z / STEP).exp_m1()
}
