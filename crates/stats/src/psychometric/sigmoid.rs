//! The curves.

use crate::clustered::logistic;
use crate::normal;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The shape of the curve F between guessing and lapsing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sigmoid {
    /// The cumulative Gaussian; σ = width / 3.2897.
    #[default]
    Gaussian,
    /// The logistic function; scale = width / 5.8889.
    Logistic,
    /// 1 − exp(−10^(β(x − t))): the Weibull function of an intensity whose log10 is x (a Gumbel function of x).
    Weibull,
}

/// Which proportion a threshold is asked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Scaling {
    /// Of the curve F itself, 0 to 1 without guesses and lapses: psignifit's `thresh_PC`.
    Unscaled,
    /// Of correct answers ψ, guesses and lapses included: psignifit's `Result.threshold`.
    Scaled,
}

impl Sigmoid {
    /// z at the threshold, and the rise of z over the width.
    fn shape(self) -> (f64, f64) {
        match self {
            // 2 Φ⁻¹(.95).
            Self::Gaussian => (0.0, 3.289_707_253_902_945),
            // 2 ln 19.
            Self::Logistic => (0.0, 5.888_877_958_332_881),
            // ln ln 2; ln(−ln .05) − ln(−ln .95).
            Self::Weibull => (-0.366_512_920_581_664_3, 4.067_383_949_407_113),
        }
    }

    /// The curve's own argument and its rise over the width.
    pub(super) fn argument(self, x: f64, threshold: f64, width: f64) -> (f64, f64) {
        let (centre, rise) = self.shape();
        (centre + rise * (x - threshold) / width, rise)
    }

    /// F, F′, F″ at the argument z.
    pub(super) fn derivatives(self, z: f64) -> [f64; 3] {
        match self {
            Self::Gaussian => {
                let density = (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
                [normal::cdf(z), density, -z * density]
            }
            Self::Logistic => {
                let (p, q) = (logistic(z), logistic(-z));
                [p, p * q, p * q * (q - p)]
            }
            Self::Weibull => {
                let e = z.exp();
                let density = (z - e).exp();
                [-(-e).exp_m1(), density, if density > 0.0 { density * (1.0 - e) } else { 0.0 }]
            }
        }
    }

    /// F(x) for a threshold and a width > 0.
    pub fn value(self, x: f64, threshold: f64, width: f64) -> f64 {
        let (z, _) = self.argument(x, threshold, width);
        match self {
            Self::Gaussian => normal::cdf(z),
            Self::Logistic => logistic(z),
            Self::Weibull => -(-z.exp()).exp_m1(),
        }
    }

    /// The x with F(x) = p, for p in (0, 1).
    pub(super) fn inverse(self, p: f64, threshold: f64, width: f64) -> f64 {
        let (centre, rise) = self.shape();
        let z = match self {
            Self::Gaussian => normal::quantile(p),
            Self::Logistic => (p / (1.0 - p)).ln(),
            Self::Weibull => (-(-p).ln_1p()).ln(),
        };
        threshold + (z - centre) * width / rise
    }
}
