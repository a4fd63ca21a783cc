//! Student's t distribution, for any positive number of degrees of freedom.
//!
//! Its tail is an incomplete beta function, P(T > t) = ½ I_x(df/2, ½) with x = df / (df + t²) for t > 0
//! (Abramowitz & Stegun 26.7.1); x and 1 − x are formed to 31 digits, so that neither a tiny nor a huge t loses any.

use super::beta::{self, ln_a_beta, ln_density_core};
use super::dd::Dd;
use super::root;
use crate::{Result, StatsError};

/// Above this many degrees of freedom, t is the normal distribution to every digit.
const NORMAL_FROM: f64 = 1e250;

/// Student's t with `df` degrees of freedom.
///
/// Relative error of both tails ≤ 1e-13 for df ≤ 1000, ≤ 1e-12 up to 1e6, down to 1e-300.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StudentT {
    df: f64,
}

/// The probabilities of a point t ≥ 0.
struct Point {
    /// P(T > t) and its logarithm.
    upper: f64,
    ln_upper: f64,
    /// P(0 < T < t).
    central: f64,
}

impl StudentT {
    /// `df` ≥ 1e-280; infinity is the normal distribution.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] for anything else.
    pub fn new(df: f64) -> Result<Self> {
        if df >= 1e-280 {
            Ok(Self { df })
        } else {
            Err(StatsError::Invalid { name: "df", value: df, rule: "must be at least 1e-280" })
        }
    }

    /// Degrees of freedom.
    pub fn df(&self) -> f64 {
        self.df
    }

    /// P(T ≤ t).
    ///
    /// # Errors
    /// [`StatsError::Invalid`] when t is NaN.
    pub fn cdf(&self, t: f64) -> Result<f64> {
        self.sf(-t)
    }

    /// P(T > t), the upper tail itself and not 1 − cdf.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] when t is NaN.
    pub fn sf(&self, t: f64) -> Result<f64> {
        let t = StatsError::number("t", t)?;
        let point = self.point(t.abs());
        Ok(if t >= 0.0 { point.upper } else { 1.0 - point.upper })
    }

    /// ln P(T > t); goes on where the tail underflows.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] when t is NaN.
    pub fn ln_sf(&self, t: f64) -> Result<f64> {
        let t = StatsError::number("t", t)?;
        let point = self.point(t.abs());
        Ok(if t >= 0.0 { point.ln_upper } else { (-point.upper).ln_1p() })
    }

    /// ln P(T ≤ t).
    ///
    /// # Errors
    /// [`StatsError::Invalid`] when t is NaN.
    pub fn ln_cdf(&self, t: f64) -> Result<f64> {
        self.ln_sf(-t)
    }

    /// P(|T| ≥ |t|), the p-value of a two-sided test.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] when t is NaN.
    pub fn two_sided(&self, t: f64) -> Result<f64> {
        Ok(2.0 * self.sf(t.abs())?)
    }

    /// Density at t.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] when t is NaN.
    pub fn pdf(&self, t: f64) -> Result<f64> {
        Ok(self.density(StatsError::number("t", t)?.abs()))
    }

    /// The t below which a share `p` lies; −∞ and ∞ at 0 and 1, ±1.8e308 where t would be beyond.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless p is in [0, 1].
    pub fn quantile(&self, p: f64) -> Result<f64> {
        let p = StatsError::probability("p", p)?;
        Ok(if p <= 0.5 { -self.upper_quantile(p, 0.5 - p) } else { self.upper_quantile(1.0 - p, p - 0.5) })
    }

    /// The t above which a share `q` lies: exact for tiny q, where `quantile(1 − q)` cannot be.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless q is in [0, 1].
    pub fn quantile_sf(&self, q: f64) -> Result<f64> {
        Ok(-self.quantile(StatsError::probability("q", q)?)?)
    }

    fn point(&self, t: f64) -> Point {
        if t == 0.0 {
            return Point { upper: 0.5, ln_upper: -std::f64::consts::LN_2, central: 0.0 };
        }
        if t.is_infinite() {
            return Point { upper: 0.0, ln_upper: f64::NEG_INFINITY, central: 0.5 };
        }
        let df = self.df;
        if df >= NORMAL_FROM {
            let (upper, ln_upper) = super::normal::upper_and_ln(t);
            return Point { upper, ln_upper, central: super::normal::central(t) };
        }
        let a = df / 2.0;
        if t < 1e-15 && t < 1e-15 * df.sqrt() {
            let central = t * self.density(0.0);
            return Point { upper: 0.5 - central, ln_upper: (0.5 - central).ln(), central };
        }
        if t > 1e15 && t / df.sqrt() > 1e15 {
            // The leading term x^a / (2 a B(a, ½)) of the tail; the next is 1e-30 of it.
            let ln_x = Dd::from(df).ln() - Dd::from(t).ln() * 2.0.into();
            let tail = ln_x * a.into() - ln_a_beta(a, 0.5) - Dd::LN_2;
            let upper = tail.exp().min(0.5);
            return Point { upper, ln_upper: tail.value(), central: 0.5 - upper };
        }
        let (x, y) = shares(df, t);
        let tails = beta::tails(a, 0.5, x, y);
        Point {
            upper: 0.5 * tails.lower,
            ln_upper: tails.ln_lower - std::f64::consts::LN_2,
            central: 0.5 * tails.upper,
        }
    }

    fn density(&self, t: f64) -> f64 {
        let df = self.df;
        if t.is_infinite() {
            return 0.0;
        }
        if df >= NORMAL_FROM {
            return super::normal::density(t);
        }
        let a = df / 2.0;
        if t > 1e15 && t / df.sqrt() > 1e15 {
            // df^a t^−(df + 1) / B(a, ½), the leading term.
            let ln_beta = ln_a_beta(a, 0.5) - Dd::from(a).ln();
            return (Dd::from(df).ln() * a.into() - Dd::sum(df, 1.0) * Dd::from(t).ln() - ln_beta).exp();
        }
        // Flat to 30 digits below this.
        let t = t.max(1e-16 * df.sqrt().min(1.0));
        // f(t) = x^a y^½ / (B(a, ½) t): the chain rule on I_x(a, ½).
        let (x, y) = shares(df, t);
        let lambda = y * a.into() - x * 0.5.into();
        let core = ln_density_core(a, 0.5, x, y, lambda).exp();
        core * (a / (a + 0.5) * 0.5 / std::f64::consts::TAU).sqrt() / t
    }

    /// The t ≥ 0 with P(T > t) = q ≤ ½, where `central` = ½ − q.
    fn upper_quantile(&self, q: f64, central: f64) -> f64 {
        if q == 0.0 {
            return f64::INFINITY;
        }
        if central == 0.0 {
            return 0.0;
        }
        if q < 0.25 {
            let f = |t: f64| {
                let point = self.point(t);
                -root::ln_ratio(point.upper, point.ln_upper, q)
            };
            root::in_logarithm(f, f64::MAX, (-2.0 * q.ln()).sqrt())
        } else {
            let f = |t: f64| {
                let point = self.point(t);
                root::ln_ratio(point.central, point.central.ln(), central)
            };
            root::in_logarithm(f, f64::MAX, central / self.density(0.0))
        }
    }
}

/// df / (df + t²) and t² / (df + t²), to 31 digits: both scaled by a power of two so that t² cannot overflow.
fn shares(df: f64, t: f64) -> (Dd, Dd) {
    let scale = 2f64.powi(-(t.log2().round() as i32).clamp(-1000, 1000));
    let t = t * scale;
    let df = Dd::from(df * scale * scale);
    let square = Dd::product(t, t);
    let whole = df + square;
    (df / whole, square / whole)
}
