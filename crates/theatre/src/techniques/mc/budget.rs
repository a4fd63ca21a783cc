//! How many samples a drawing gets: decided by a pilot of a few rows with points of its own, then frozen before the final
//! pass, so that when it ends does not bias what it estimates. The frozen count replays the image to the byte.

use std::time::Instant;

use kelir_frame::RenderError;

use super::{Knobs, Points, REPLICATES, Row};

/// Most points per replicate: what [`Knobs::spp`] may ask for.
const MOST: usize = (1 << 20) / REPLICATES;

/// Points per replicate of the two pilots.
const PILOTS: [usize; 2] = [4, 16];

/// One row in so many is drawn in a pilot.
const SPARSE: usize = 8;

/// Points per replicate for `knobs`; `draw` draws the given rows with the given points.
pub(super) fn freeze(
    knobs: &Knobs,
    height: usize,
    started: Instant,
    mut draw: impl FnMut(Points, &[usize]) -> Result<Vec<Row>, RenderError>,
) -> Result<usize, RenderError> {
    if knobs.target_error.is_none() && knobs.time_limit_s.is_none() {
        return Ok((knobs.spp as usize).div_ceil(REPLICATES));
    }
    let rows: Vec<usize> = match height < 4 * SPARSE {
        true => (0..height).collect(),
        false => (SPARSE / 2..height).step_by(SPARSE).collect(),
    };
    let (mut error, mut seconds) = ([0.0; 2], [0.0; 2]);
    for (k, samples) in PILOTS.into_iter().enumerate() {
        let clock = Instant::now();
        // Points that the final pass does not use, or its count would depend on its own errors.
        let drawn = draw(Points::new(!knobs.seed, samples), &rows)?;
        seconds[k] = clock.elapsed().as_secs_f64();
        error[k] = rms(&drawn);
    }
    let mut samples = MOST as f64;
    if let Some(target) = knobs.target_error {
        samples = samples.min(for_error(error, target));
    }
    if let Some(limit) = knobs.time_limit_s {
        let scale = height as f64 / rows.len() as f64;
        let left = limit - started.elapsed().as_secs_f64();
        samples = samples.min(for_time(seconds.map(|s| s * scale), left));
    }
    Ok((samples as usize).clamp(1, MOST))
}

/// Root mean square of the standard error over penumbra pixels, in units of the brightest unshadowed pixel.
pub(super) fn rms(rows: &[Row]) -> f64 {
    let penumbra: u64 = rows.iter().map(|r| r.penumbra).sum();
    let square: f64 = rows.iter().map(|r| r.error_square).sum();
    let full = rows.iter().map(|r| r.brightest).fold(0.0, f64::max);
    if penumbra > 0 && full > 0.0 { (square / penumbra as f64).sqrt() / full } else { 0.0 }
}

/// Points for `target`, from the pilots' errors: error falls as a power of the count between −1 and −½, with 30 % to spare
/// because the power is not known well.
fn for_error(error: [f64; 2], target: f64) -> f64 {
    if error[1] <= 0.0 {
        return 1.0;
    }
    let ratio = PILOTS[1] as f64 / PILOTS[0] as f64;
    let power = ((error[1] / error[0]).ln() / ratio.ln()).clamp(-1.0, -0.5);
    (1.3 * PILOTS[1] as f64 * (target / error[1]).powf(1.0 / power)).ceil()
}

/// Points for `seconds`, from the pilots' times: a constant and a price a point, with 10 % to spare.
fn for_time(pilots: [f64; 2], seconds: f64) -> f64 {
    let price = ((pilots[1] - pilots[0]) / (PILOTS[1] - PILOTS[0]) as f64).max(1e-9);
    let constant = (pilots[0] - price * PILOTS[0] as f64).max(0.0);
    (0.9 * (seconds - constant) / price).floor().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_follow_the_pilots() {
        // Error halves when the count doubles: sixteen points give 0.01, so 0.001 needs ten times as many, and a bit.
        assert!((208.0..=209.0).contains(&for_error([0.04, 0.01], 0.001)));
        // Slower than 1/√n is taken for 1/√n.
        assert!((83.0..=85.0).contains(&for_error([0.01, 0.01], 0.005)));
        assert_eq!(for_error([0.0, 0.0], 0.001), 1.0);
        assert!((89.0..=90.0).contains(&for_time([1.4, 2.6], 11.0)));
        assert_eq!(for_time([1.4, 2.6], 0.5), 1.0);
    }
}
