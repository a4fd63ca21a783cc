//! The beta distribution and the regularised incomplete beta function.
//!
//! I_x(a, b) = x^a (1−x)^(b−1) / B(a, b) · ∫₀^∞ e^(−as) (1 + x/(1−x) (1 − e^−s))^(b−1) ds (substitute t = x e^−s in
//! the definition, DLMF 8.17.1). The factor in front is Loader's, in double-double; the integrand decreases, so that
//! one quadrature serves all parameters. Each tail is found directly, never as 1 minus a number close to 1.

use super::dd::Dd;
use super::quadrature::integrate_decay;
use super::root;
use super::special::{LN_SQRT_2PI, deviance, exp_m1_minus, ln_1p_minus, stirling_error};
use crate::{Result, StatsError};

/// What a and b may be.
const SHAPE_RULE: &str = "must lie in [1e-280, 1e280]";

/// The beta distribution on [0, 1] with shapes a and b.
///
/// Relative error of both tails ≤ 1e-13 for a, b ≤ 1000 and ≤ 1e-12 up to 1e6, down to 1e-300.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beta {
    a: f64,
    b: f64,
}

impl Beta {
    /// `a` and `b` in [1e-280, 1e280].
    ///
    /// # Errors
    /// [`StatsError::Invalid`] for anything else.
    pub fn new(a: f64, b: f64) -> Result<Self> {
        Ok(Self { a: shape("a", a)?, b: shape("b", b)? })
    }

    /// I_x(a, b) = P(X ≤ x).
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless x is in [0, 1].
    pub fn cdf(&self, x: f64) -> Result<f64> {
        Ok(self.tails(x)?.lower)
    }

    /// P(X > x) = I_{1−x}(b, a).
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless x is in [0, 1].
    pub fn sf(&self, x: f64) -> Result<f64> {
        Ok(self.tails(x)?.upper)
    }

    /// ln P(X ≤ x); goes on where the tail underflows.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless x is in [0, 1].
    pub fn ln_cdf(&self, x: f64) -> Result<f64> {
        Ok(self.tails(x)?.ln_lower)
    }

    /// ln P(X > x).
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless x is in [0, 1].
    pub fn ln_sf(&self, x: f64) -> Result<f64> {
        Ok(self.tails(x)?.ln_upper)
    }

    /// (P(X ≤ x), P(X > x)) at x = 1 − `complement`, which says more than x where x is close to 1.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless `complement` is in [0, 1].
    pub fn tails_at_complement(&self, complement: f64) -> Result<(f64, f64)> {
        let flipped =
            Self { a: self.b, b: self.a }.tails(StatsError::probability("complement", complement)?)?;
        Ok((flipped.upper, flipped.lower))
    }

    /// The x below which a share `p` lies.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless p is in [0, 1].
    pub fn quantile(&self, p: f64) -> Result<f64> {
        let p = StatsError::probability("p", p)?;
        Ok(self.inverse(p, false).0)
    }

    /// The x above which a share `q` lies: exact for tiny q, where `quantile(1 − q)` cannot be.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless q is in [0, 1].
    pub fn quantile_sf(&self, q: f64) -> Result<f64> {
        let q = StatsError::probability("q", q)?;
        Ok(self.inverse(q, true).0)
    }

    fn tails(&self, x: f64) -> Result<Tails> {
        let x = StatsError::probability("x", x)?;
        Ok(tails(self.a, self.b, x.into(), Dd::sum(1.0, -x)))
    }

    /// x and 1 − x where the tail (upper or lower) is `share`.
    fn inverse(&self, share: f64, upper: bool) -> (f64, f64) {
        if share == 0.0 || share == 1.0 {
            return if (share == 0.0) == upper { (1.0, 0.0) } else { (0.0, 1.0) };
        }
        // The smaller tail says more; 1 − share is exact above ½.
        let (share, upper) = if share > 0.5 { (1.0 - share, !upper) } else { (share, upper) };
        let middle = tails(self.a, self.b, 0.5.into(), 0.5.into());
        let above_half = if upper { middle.upper > share } else { middle.lower < share };
        if above_half {
            let complement = lower_half_quantile(self.b, self.a, share, !upper);
            (1.0 - complement, complement)
        } else {
            let x = lower_half_quantile(self.a, self.b, share, upper);
            (x, 1.0 - x)
        }
    }
}

/// The x ≤ ½ of Beta(a, b) with the given lower or upper tail; 0 where it underflows.
fn lower_half_quantile(a: f64, b: f64, share: f64, upper: bool) -> f64 {
    let at = |x: f64| tails(a, b, x.into(), Dd::sum(1.0, -x));
    root::in_logarithm(
        |x| {
            let tails = at(x);
            if upper {
                -root::ln_ratio(tails.upper, tails.ln_upper, share)
            } else {
                root::ln_ratio(tails.lower, tails.ln_lower, share)
            }
        },
        0.5,
        a / (a + b),
    )
}

/// `Ok(value)` for a shape or degrees of freedom that the algorithms take.
pub(crate) fn shape(name: &'static str, value: f64) -> Result<f64> {
    if (1e-280..=1e280).contains(&value) {
        Ok(value)
    } else {
        Err(StatsError::Invalid { name, value, rule: SHAPE_RULE })
    }
}

/// Both tails at one point, and their logarithms (which go on where the tails underflow).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tails {
    pub(crate) lower: f64,
    pub(crate) upper: f64,
    pub(crate) ln_lower: f64,
    pub(crate) ln_upper: f64,
}

impl Tails {
    pub(crate) const NOTHING_BELOW: Self =
        Self { lower: 0.0, upper: 1.0, ln_lower: f64::NEG_INFINITY, ln_upper: 0.0 };

    pub(crate) fn swapped(self) -> Self {
        Self { lower: self.upper, upper: self.lower, ln_lower: self.ln_upper, ln_upper: self.ln_lower }
    }

    pub(crate) fn from_lower(lower: f64, ln_lower: f64) -> Self {
        let lower = lower.min(1.0);
        Self { lower, upper: 1.0 - lower, ln_lower: ln_lower.min(0.0), ln_upper: (-lower).ln_1p() }
    }
}

/// The tails of Beta(a, b) at x, with y = 1 − x given as exactly as x; a and b in [1e-300, 1e300].
pub(crate) fn tails(a: f64, b: f64, x: Dd, y: Dd) -> Tails {
    if x.hi <= 0.0 {
        return Tails::NOTHING_BELOW;
    }
    if y.hi <= 0.0 {
        return Tails::NOTHING_BELOW.swapped();
    }
    // (a + b) times the distance of x below the mean.
    let lambda = y * a.into() - x * b.into();
    if lambda.hi >= 0.0 {
        tails_below_mean(a, b, x, y, lambda)
    } else {
        tails_below_mean(b, a, y, x, -lambda).swapped()
    }
}

/// x below which (1 − x)^b is 1 to every digit, for b up to [`NEGLIGIBLE_UP_TO`].
pub(crate) const NEGLIGIBLE: f64 = 1e-290;
pub(crate) const NEGLIGIBLE_UP_TO: f64 = 1e10;

/// The tails at an x so small that I_x = x^a / (a B(a, b)): given as ln x, because x itself may underflow.
pub(crate) fn leading_tails(a: f64, b: f64, ln_x: Dd) -> Tails {
    let ln_lower = ln_x * a.into() - ln_a_beta(a, b);
    let lower = ln_lower.exp().min(1.0);
    let ln_lower = ln_lower.value().min(0.0);
    let upper = -ln_lower.exp_m1();
    Tails { lower, upper, ln_lower, ln_upper: upper.ln() }
}

/// ln(a B(a, b)), for b up to [`NEGLIGIBLE_UP_TO`].
pub(crate) fn ln_a_beta(a: f64, b: f64) -> Dd {
    let half = Dd::from(0.5);
    let n = Dd::sum(a, b);
    let (x, y) = (Dd::from(a), Dd::from(b));
    // Stirling's formula for the three gammas; their linear terms cancel.
    (x + half) * x.ln() + (y - half) * y.ln() - (n - half) * n.ln()
        + LN_SQRT_2PI
        + stirling_error(a)
        + stirling_error(b)
        - stirling_error(a + b)
}

fn tails_below_mean(a: f64, b: f64, x: Dd, y: Dd, lambda: Dd) -> Tails {
    if x.hi < NEGLIGIBLE && b < NEGLIGIBLE_UP_TO {
        return leading_tails(a, b, x.ln());
    }
    let (lower, ln_lower) = one_tail(a, b, x, y, lambda);
    if lower > 0.7 && a < 1.0 && x.hi > NEGLIGIBLE {
        // A mean far above the median, so that the upper tail is the small one after all.
        let (upper, ln_upper) = one_tail(b, a, y, x, -lambda);
        return Tails::from_lower(upper, ln_upper).swapped();
    }
    Tails::from_lower(lower, ln_lower)
}

/// I_x(a, b) and its logarithm, where the integrand decreases (below the mean, or for b < 1).
fn one_tail(a: f64, b: f64, x: Dd, y: Dd, lambda: Dd) -> (f64, f64) {
    let exponent = ln_density_core(a, b, x, y, lambda);
    let (x, y) = (x.value(), y.value());
    let factor = (a / (a + b) * b / std::f64::consts::TAU).sqrt() / y * mills(a, b, x, y, lambda.value());
    let half = Dd { hi: exponent.hi / 2.0, lo: exponent.lo / 2.0 }.exp();
    (half * factor * half, exponent.value() + factor.ln())
}

/// ln of x^a y^b / B(a, b) · √(2π (a+b) / (a b)): Loader's saddle point form.
pub(crate) fn ln_density_core(a: f64, b: f64, x: Dd, y: Dd, lambda: Dd) -> Dd {
    let n = Dd::sum(a, b);
    stirling_error(a + b)
        - stirling_error(a)
        - stirling_error(b)
        - deviance(a, n * x, -lambda)
        - deviance(b, n * y, lambda)
}

/// ∫₀^∞ e^(−as) (1 + x/y (1 − e^−s))^(b−1) ds.
fn mills(a: f64, b: f64, x: f64, y: f64, lambda: f64) -> f64 {
    let odds = x / y;
    let slope = (lambda + x) / y;
    if b > 1.0 {
        let rate = slope + ((b - 1.0) * odds / y).sqrt();
        // The two large slopes cancel, so they are taken out of the logarithm and the exponential beforehand.
        let g = |s: f64| {
            let z = -odds * (-s).exp_m1();
            (b - 1.0) * (ln_1p_minus(z) - odds * exp_m1_minus(-s)) - slope * s
        };
        integrate_decay(g, slope, rate)
    } else {
        let g = |s: f64| (b - 1.0) * (-odds * (-s).exp_m1()).ln_1p() - a * s;
        integrate_decay(g, slope, slope)
    }
}
