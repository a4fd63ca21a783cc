//! Double-double arithmetic: a number as the exact sum of two `f64`, about 31 decimal digits.
//!
//! A tail of 1e-300 is exp(-690): an error of one part in 1e16 in the exponent would already cost three digits of
//! the tail. Exponents are therefore formed here, and rounded only once.
//!
//! Error-free transformations after Dekker (1971) and Knuth (TAOCP 2, 4.2.2); the fused multiply-add gives the
//! exact product.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// `hi + lo`, with `|lo|` at most half an ulp of `hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Dd {
    pub(crate) hi: f64,
    pub(crate) lo: f64,
}

impl Dd {
    pub(crate) const LN_2: Self = Self { hi: std::f64::consts::LN_2, lo: 2.3190468138462996e-17 };

    /// a + b, exactly.
    pub(crate) fn sum(a: f64, b: f64) -> Self {
        let hi = a + b;
        let b_rounded = hi - a;
        Self { hi, lo: (a - (hi - b_rounded)) + (b - b_rounded) }
    }

    /// a · b, exactly (unless it over- or underflows).
    pub(crate) fn product(a: f64, b: f64) -> Self {
        let hi = a * b;
        Self { hi, lo: a.mul_add(b, -hi) }
    }

    /// 1 / n.
    pub(crate) fn reciprocal(n: f64) -> Self {
        let hi = 1.0 / n;
        Self { hi, lo: (-hi).mul_add(n, 1.0) / n }
    }

    /// Rounded to the nearest `f64`.
    pub(crate) fn value(self) -> f64 {
        self.hi + self.lo
    }

    /// e^self, to about one ulp: overflows to infinity and underflows to 0.
    pub(crate) fn exp(self) -> f64 {
        let leading = self.hi.exp();
        if leading == 0.0 || leading.is_infinite() { leading } else { leading + leading * self.lo }
    }

    /// Natural logarithm of a positive number, to about 1e-24 relative to max(1, |ln|).
    pub(crate) fn ln(self) -> Self {
        let (mantissa, exponent) = split_exponent(self.hi);
        let scale = mantissa / self.hi;
        let m = if scale.is_finite() {
            Self { hi: mantissa, lo: self.lo * scale }
        } else {
            Self { hi: mantissa, lo: 0.0 } // a subnormal has no low part
        };
        let s = (m - 1.0.into()) / (m + 1.0.into());
        Self::LN_2 * f64::from(exponent).into() + s * 2.0.into() * atanh_over(s, 0)
    }
}

/// atanh(s) / s without its first `skip` terms: Σ s^2j / (2j + 1 + 2·skip), for |s| ≤ 1/3, to about 1e-24.
pub(crate) fn atanh_over(s: Dd, skip: u32) -> Dd {
    /// Terms that need more than double precision: the ones after are below (1/9)^8 of the whole.
    const EXACT_TERMS: u32 = 9;
    const TERMS: u32 = 26;
    let s2 = s * s;
    let denominator = |j: u32| f64::from(2 * (j + skip) + 1);
    let mut tail = 0.0;
    for j in (EXACT_TERMS..TERMS).rev() {
        tail = tail * s2.hi + 1.0 / denominator(j);
    }
    (0..EXACT_TERMS).rev().fold(tail.into(), |sum: Dd, j| sum * s2 + Dd::reciprocal(denominator(j)))
}

/// A positive finite number as m · 2^k with m in [√½, √2).
fn split_exponent(x: f64) -> (f64, i32) {
    const BIAS: i32 = 1023;
    let (x, shift) = if x < f64::MIN_POSITIVE { (x * 2f64.powi(54), -54) } else { (x, 0) };
    let bits = x.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i32 - BIAS;
    let mantissa = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) | ((BIAS as u64) << 52));
    if mantissa > std::f64::consts::SQRT_2 {
        (mantissa / 2.0, exponent + shift + 1)
    } else {
        (mantissa, exponent + shift)
    }
}

impl From<f64> for Dd {
    fn from(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }
}

impl Neg for Dd {
    type Output = Self;
    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl Add for Dd {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let high = Self::sum(self.hi, other.hi);
        let low = Self::sum(self.lo, other.lo);
        let high = Self::sum(high.hi, high.lo + low.hi);
        Self::sum(high.hi, high.lo + low.lo)
    }
}

impl Sub for Dd {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Dd {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let p = Self::product(self.hi, other.hi);
        Self::sum(p.hi, p.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}

impl Div for Dd {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.hi / other.hi;
        let rest = self - other * first.into();
        let second = rest.hi / other.hi;
        let rest = rest - other * second.into();
        Self::sum(first, second) + Self::from(rest.hi / other.hi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hi and lo of mpmath.log at 60 digits.
    #[test]
    fn logarithms_have_twice_the_digits() {
        for (x, hi, lo) in [
            (3.0, 1.0986122886681098, -9.07129723500153e-17),
            (0.1, -2.3025850929940455, -1.7150243628057985e-16),
            (1e300, 690.7755278982137, 2.3747660028800243e-14),
            (5e-324, -744.4400719213812, -4.422444340918698e-14),
            (1.0000001, 9.999999505838704e-08, 1.5249709528441489e-24),
        ] {
            let ln = Dd::from(x).ln();
            let error = ((ln.hi - hi) + (ln.lo - lo)).abs();
            assert!(error < 1e-23 * hi.abs().max(1.0), "ln {x}: {ln:?}, off by {error:e}");
        }
    }

    #[test]
    fn quotients_have_twice_the_digits() {
        let third = Dd::from(1.0) / 3.0.into();
        let back = third * 3.0.into() - 1.0.into();
        assert!(back.value().abs() < 1e-31, "{back:?}");
        assert!(third.lo != 0.0);
    }
}
