//! How many samples a drawing gets: decided by a pilot of a few rows with points of its own, then frozen before the final
//! pass, so that when it ends does not bias what it estimates. The frozen count replays the image to the byte.

use std::time::Instant;

use kelir_frame::RenderError;

use super::{Knobs, Points, REPLICATES, Row};

/// Most points per replicate: what [`Knobs::spp`] may ask for.
const MOST: usize = (1 << 20) / REPLICATES;

/// Points per replicate of the first pilot.
const FIRST: usize = 4;

/// A pilot draws so many rows, spread over the image, or all that there are.
const ROWS: usize = 32;

/// Of the time that there is, what pilots may take before they end.
const SHARE: f64 = 0.1;

/// What a pilot found.
struct Pilot {
    /// Points per replicate.
    samples: usize,
    /// [`rms`] of its rows.
    error: f64,
    /// Of its rows.
    seconds: f64,
}

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
    let step = (height / ROWS).max(1);
    let rows: Vec<usize> = (step / 2..height).step_by(step).collect();
    let mut pilots = Vec::new();
    let mut samples = FIRST;
    while samples <= MOST && !enough(&pilots, knobs, started.elapsed().as_secs_f64()) {
        let clock = Instant::now();
        // Points that the final pass does not use, or its count would depend on its own errors.
        let error = rms(&draw(Points::new(!knobs.seed, samples), &rows)?);
        pilots.push(Pilot { samples, error, seconds: clock.elapsed().as_secs_f64() });
        samples *= 2;
    }
    let mut samples = knobs.target_error.map_or(MOST, |target| for_error(&pilots, target));
    if let Some(limit) = knobs.time_limit_s {
        let scale = height as f64 / rows.len() as f64;
        let left = limit - started.elapsed().as_secs_f64();
        samples = samples.min(for_time(&pilots, scale, left) as usize);
    }
    Ok(samples.clamp(1, MOST))
}

/// Whether more pilots would tell nothing: the error is reached, or the time for pilots is over.
fn enough(pilots: &[Pilot], knobs: &Knobs, elapsed: f64) -> bool {
    let reached = knobs.target_error.is_some_and(|target| for_error(pilots, target) < MOST);
    let late = knobs.time_limit_s.is_some_and(|limit| elapsed > SHARE * limit);
    // A price needs two.
    reached && knobs.time_limit_s.is_none() || pilots.len() >= 2 && (reached || late)
}

/// Root mean square of the standard error over penumbra pixels, in units of the brightest unshadowed pixel.
pub(super) fn rms(rows: &[Row]) -> f64 {
    let penumbra: u64 = rows.iter().map(|r| r.penumbra).sum();
    let square: f64 = rows.iter().map(|r| r.error_square).sum();
    let full = rows.iter().map(|r| r.brightest).fold(0.0, f64::max);
    if penumbra > 0 && full > 0.0 { (square / penumbra as f64).sqrt() / full } else { 0.0 }
}

/// Points for `target`: the first pilot's that reached it. Pilots double, because nets of a power of two points are best: half as many
/// again cost half as much again for some percent of the error.
fn for_error(pilots: &[Pilot], target: f64) -> usize {
    pilots.iter().find(|pilot| pilot.error <= target).map_or(MOST, |pilot| pilot.samples)
}

/// Points for `left` seconds, from the last two pilots' times, each `scale` times as long in the image: a constant and a price a point,
/// with 10 % to spare.
fn for_time(pilots: &[Pilot], scale: f64, left: f64) -> f64 {
    let [.., before, last] = pilots else { return 1.0 };
    let price = scale * (last.seconds - before.seconds) / (last.samples - before.samples) as f64;
    let price = price.max(1e-9);
    let constant = (scale * before.seconds - price * before.samples as f64).max(0.0);
    (0.9 * (left - constant) / price).floor().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pilots(errors: &[f64], seconds: &[f64]) -> Vec<Pilot> {
        let both = errors.iter().zip(seconds).enumerate();
        both.map(|(k, (&error, &seconds))| Pilot { samples: FIRST << k, error, seconds }).collect()
    }

    #[test]
    fn counts_follow_the_pilots() {
        let found = pilots(&[0.04, 0.02, 0.01], &[1.4, 1.8, 2.6]);
        assert_eq!(for_error(&found, 0.011), 16);
        assert_eq!(for_error(&found, 0.02), 8);
        assert_eq!(for_error(&found, 0.001), MOST);
        assert!((89.0..=90.0).contains(&for_time(&found, 1.0, 11.0)));
        assert!((89.0..=90.0).contains(&for_time(&found, 2.0, 22.0)));
        assert_eq!(for_time(&found, 1.0, 0.5), 1.0);
    }

    #[test]
    fn pilots_end_when_they_know_enough() {
        let knobs = |target_error, time_limit_s| Knobs { target_error, time_limit_s, ..Knobs::default() };
        let one = pilots(&[0.04], &[1.0]);
        let two = pilots(&[0.04, 0.02], &[1.0, 2.0]);
        assert!(!enough(&[], &knobs(Some(0.5), None), 0.0));
        assert!(enough(&one, &knobs(Some(0.05), None), 1e9) && !enough(&two, &knobs(Some(0.01), None), 1e9));
        assert!(!enough(&one, &knobs(Some(0.05), Some(1.0)), 1e9), "a price needs two");
        assert!(enough(&two, &knobs(Some(0.05), Some(1e9)), 0.0));
        assert!(
            !enough(&two, &knobs(None, Some(100.0)), 9.0) && enough(&two, &knobs(None, Some(100.0)), 11.0)
        );
    }
}
