//! From a difference on the scale to a proportion of choices.

use crate::clustered::{logistic, softplus};
use crate::normal;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// How the proportion of choices follows from the difference of two conditions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// Thurstone's Case V: equal, independent Gaussian noise; P = Φ(d / 1.4826…) with d in JOD.
    #[default]
    Thurstone,
    /// Bradley–Terry: P = 1/(1 + e^(−d ln 3)) with d in JOD.
    BradleyTerry,
}

/// What one choice probability's likelihood needs at a latent difference d.
pub(super) struct Link {
    /// ln P(d) and ln P(−d).
    pub ln: (f64, f64),
    /// The derivatives of ln P at d and of ln P at −d (both in their own argument).
    pub slope: (f64, f64),
    /// Minus the second derivatives likewise.
    pub bend: (f64, f64),
    /// Fisher information w of one choice, (ln w)′ and −(ln w)″ in d.
    pub information: f64,
    pub ln_information: (f64, f64),
}

impl Model {
    /// JOD per unit of the latent scale, 1/P⁻¹(.75): under Thurstone's model the standard deviation of a choice's noise, in JOD.
    pub fn jod(self) -> f64 {
        match self {
            // 1/Φ⁻¹(.75); pwcmp rounds it to 1.4826.
            Self::Thurstone => 1.482_602_218_505_602,
            Self::BradleyTerry => 1.0 / 3f64.ln(),
        }
    }

    /// The proportion of choices for a condition that is better by `difference_jod`; ½ at 0, ¾ at 1.
    pub fn probability(self, difference_jod: f64) -> f64 {
        let d = difference_jod / self.jod();
        match self {
            Self::Thurstone => normal::cdf(d),
            Self::BradleyTerry => logistic(d),
        }
    }

    pub(super) fn link(self, d: f64) -> Link {
        match self {
            Self::Thurstone => {
                let ln = (normal::ln_cdf(d), normal::ln_cdf(-d));
                // Inverse Mills ratios φ/Φ, on the log scale so that they survive the tails.
                let ln_density = -0.5 * d * d - 0.5 * std::f64::consts::TAU.ln();
                let slope = ((ln_density - ln.0).exp(), (ln_density - ln.1).exp());
                let bend = (slope.0 * (slope.0 + d), slope.1 * (slope.1 - d));
                Link {
                    ln,
                    slope,
                    bend,
                    information: slope.0 * slope.1,
                    ln_information: (slope.1 - slope.0 - 2.0 * d, 2.0 - bend.0 - bend.1),
                }
            }
            Self::BradleyTerry => {
                let (p, q) = (logistic(d), logistic(-d));
                let information = p * q;
                Link {
                    ln: (-softplus(-d), -softplus(d)),
                    slope: (q, p),
                    bend: (information, information),
                    information,
                    ln_information: (q - p, 2.0 * information),
                }
            }
        }
    }
}
