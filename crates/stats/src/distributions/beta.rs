//! The beta distribution and the regularised incomplete beta function.
//!
//! I_x(a, b) = x^a (1−x)^(b−1) / B(a, b) · ∫₀^∞ e^(−as) (1 + x/(1−x) (1 − e^−s))^(b−1) ds (substitute t = x e^−s in
//! the definition, DLMF 8.17.1). The factor in front is Loader's, in double-double; the integrand decreases, so that
//! one quadrature serves all parameters. Each tail is found directly, never as 1 minus a number close to 1.

use super::dd::Dd;
use super::special::{deviance, exp_neg_m1_plus, integrate_decay, ln_1p_minus, stirling_error};

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

    fn from_lower(lower: f64, ln_lower: f64) -> Self {
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

fn tails_below_mean(a: f64, b: f64, x: Dd, y: Dd, lambda: Dd) -> Tails {
    let (lower, ln_lower) = one_tail(a, b, x, y, lambda);
    if lower > 0.7 && a < 1.0 {
        // A mean far above the median, so that the upper tail is the small one after all.
        let (upper, ln_upper) = one_tail(b, a, y, x, -lambda);
        return Tails::from_lower(upper, ln_upper).swapped();
    }
    Tails::from_lower(lower, ln_lower)
}

/// I_x(a, b) and its logarithm, where the integrand decreases (below the mean, or for b < 1).
fn one_tail(a: f64, b: f64, x: Dd, y: Dd, lambda: Dd) -> (f64, f64) {
    let exponent = ln_density_core(a, b, lambda);
    let (x, y) = (x.value(), y.value());
    let factor = (a / (a + b) * b / std::f64::consts::TAU).sqrt() / y * mills(a, b, x, y, lambda.value());
    let half = Dd { hi: exponent.hi / 2.0, lo: exponent.lo / 2.0 }.exp();
    (half * factor * half, exponent.value() + factor.ln())
}

/// ln of x^a y^b / B(a, b) · √(2π (a+b) / (a b)): Loader's saddle point form.
pub(crate) fn ln_density_core(a: f64, b: f64, lambda: Dd) -> Dd {
    stirling_error(a + b) - stirling_error(a) - stirling_error(b) - deviance(a, -lambda) - deviance(b, lambda)
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
            (b - 1.0) * (ln_1p_minus(z) - odds * exp_neg_m1_plus(s)) - slope * s
        };
        integrate_decay(g, slope, rate)
    } else {
        let g = |s: f64| (b - 1.0) * (-odds * (-s).exp_m1()).ln_1p() - a * s;
        integrate_decay(g, slope, slope)
    }
}
