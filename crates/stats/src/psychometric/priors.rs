//! psignifit 4's default priors of threshold and width (Schütt et al. 2016), up to a factor, with the derivatives of their logarithms.

use super::Levels;
use std::f64::consts::PI;

/// ln prior and its first two derivatives; −∞ outside the prior's range.
pub(super) type LogPrior = [f64; 3];

const NEVER: LogPrior = [f64::NEG_INFINITY, 0.0, 0.0];

/// Flat over the levels, with a cosine fall to 0 over half their spread on either side.
pub(super) fn threshold(levels: &Levels, x: f64) -> LogPrior {
    let spread = levels.spread();
    let k = 2.0 * PI / spread;
    if x < levels.low {
        if x < levels.low - 0.5 * spread { NEVER } else { raised_cosine(k * (levels.low - x), -k) }
    } else if x > levels.high {
        if x > levels.high + 0.5 * spread { NEVER } else { raised_cosine(k * (x - levels.high), k) }
    } else {
        [0.0; 3]
    }
}

/// Flat from twice the smallest step of the levels to their spread, with cosine falls to 0 at the smallest step and at three spreads.
pub(super) fn width(levels: &Levels, x: f64) -> LogPrior {
    let (narrow, wide) = (levels.step, levels.spread());
    if x < narrow || x > 3.0 * wide {
        return NEVER;
    }
    // psignifit's order: with two levels the plateau is empty and the falls overlap; the upper one then holds.
    if x >= wide {
        let k = 0.5 * PI / wide;
        raised_cosine(k * (x - wide), k)
    } else if x <= 2.0 * narrow {
        let k = PI / narrow;
        raised_cosine(PI - k * (x - narrow), -k)
    } else {
        [0.0; 3]
    }
}

/// ln of (1 + cos φ)/2 = cos²(φ/2), where φ changes at `rate`.
fn raised_cosine(phase: f64, rate: f64) -> LogPrior {
    let (sin, cos) = (0.5 * phase).sin_cos();
    if cos.abs() < 1e-15 {
        return NEVER;
    }
    let tan = sin / cos;
    [2.0 * cos.abs().ln(), -rate * tan, -0.5 * rate * rate * (1.0 + tan * tan)]
}
