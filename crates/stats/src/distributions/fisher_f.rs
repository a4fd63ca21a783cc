//! Fisher's F distribution.

use super::beta::{self, Tails};
use super::dd::Dd;
use crate::{Result, StatsError};

/// F with `df1` (numerator) and `df2` (denominator) degrees of freedom; precision as [`super::beta::Beta`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FisherF {
    df1: f64,
    df2: f64,
}

impl FisherF {
    /// Both in [1e-10, 1e10].
    ///
    /// # Errors
    /// [`StatsError::Invalid`] for anything else.
    pub fn new(df1: f64, df2: f64) -> Result<Self> {
        Ok(Self { df1: degrees("df1", df1)?, df2: degrees("df2", df2)? })
    }

    /// P(F ≤ f).
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless f ≥ 0.
    pub fn cdf(&self, f: f64) -> Result<f64> {
        Ok(self.tails(f)?.lower)
    }

    /// P(F > f), the p-value of an analysis of variance.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless f ≥ 0.
    pub fn sf(&self, f: f64) -> Result<f64> {
        Ok(self.tails(f)?.upper)
    }

    /// F / (F + df2 / df1) is Beta(df1 / 2, df2 / 2).
    fn tails(&self, f: f64) -> Result<Tails> {
        let (df1, df2) = (self.df1, self.df2);
        if f.is_nan() || f < 0.0 {
            return Err(StatsError::Invalid { name: "f", value: f, rule: "must be at least 0" });
        }
        if f == 0.0 {
            return Ok(Tails::NOTHING_BELOW);
        }
        if f.is_infinite() {
            return Ok(Tails::NOTHING_BELOW.swapped());
        }
        let odds = df1 / df2 * f;
        let ln_odds = || Dd::from(df1).ln() - Dd::from(df2).ln() + Dd::from(f).ln();
        if odds < beta::NEGLIGIBLE {
            return Ok(beta::leading_tails(df1 / 2.0, df2 / 2.0, ln_odds()));
        }
        if odds > 1.0 / beta::NEGLIGIBLE {
            return Ok(beta::leading_tails(df2 / 2.0, df1 / 2.0, -ln_odds()).swapped());
        }
        // Divide before multiplying, so that nothing overflows.
        let odds = Dd::from(df1) / df2.into() * f.into();
        let whole = odds + 1.0.into();
        Ok(beta::tails(df1 / 2.0, df2 / 2.0, odds / whole, Dd::from(1.0) / whole))
    }
}

fn degrees(name: &'static str, value: f64) -> Result<f64> {
    if (1e-10..=beta::NEGLIGIBLE_UP_TO).contains(&value) {
        Ok(value)
    } else {
        Err(StatsError::Invalid { name, value, rule: "must lie in [1e-10, 1e10]" })
    }
}
