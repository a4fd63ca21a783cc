//! One axis of a box, or of box ⊛ pixel, cut into texels.
//!
//! Along an axis the mean opacity is `[T(end) − T(start)] / w` with T the prefix sum; for `area` pixels both terms are
//! means of T over the pixel's own width `p`. T is piecewise linear, so with `i = floor(x − p/2)`
//!
//! ```text
//! mean T = T[i] + Σ_k g_k (T[i+k+1] − T[i+k]),   g_k = mean over t in x ± p/2 of clamp(t − i − k, 0, 1).
//! ```
//!
//! Everything is measured from the box's centre, so that a box of 1e-7 texels is as exact as one of a hundred.

use kelir_frame::multiversion;

/// Texels that an end spread over `pixel` texels can touch.
pub fn reach(pixel: f64) -> usize {
    pixel.ceil() as usize + 1
}

/// ∫ clamp(s, 0, 1) ds from −∞ to `t`.
#[inline(always)]
fn ramp(t: f64) -> f64 {
    let inside = t.clamp(0.0, 1.0);
    0.5 * inside * inside + (t - 1.0).max(0.0)
}

/// Ends at `centres + offset`: the first texel of each, clamped to [−reach, size], and `reach` planes of weights; `pixel` is the pixel's
/// width in texels, 0 for a point.
#[inline(always)]
fn ends_generic(
    centres: &[f64],
    offset: f64,
    pixel: f64,
    size: usize,
    texels: &mut [i32],
    before: &mut [f64],
) {
    let count = centres.len();
    let reach = before.len() / count;
    let (first, last) = (-(reach as f64), size as f64);
    let texels = &mut texels[..count];
    for i in 0..count {
        let texel = centres[i].floor();
        let end = centres[i] - texel + offset - 0.5 * pixel;
        // Outside the grid all texels are clear, so where exactly an end lies there does not matter.
        texels[i] = (texel + end.floor()).clamp(first, last) as i32;
    }
    for (k, before) in before.chunks_exact_mut(count).enumerate() {
        for i in 0..count {
            let end = centres[i] - centres[i].floor() + offset - 0.5 * pixel;
            let t = end - end.floor() - k as f64;
            before[i] = if pixel > 0.0 { (ramp(t + pixel) - ramp(t)) / pixel } else { t.clamp(0.0, 1.0) };
        }
    }
}
multiversion! {
    fn ends(centres: &[f64], offset: f64, pixel: f64, size: usize, texels: &mut [i32], before: &mut [f64]) = ends_generic;
}

/// Both ends of every column's (or row's) box.
#[derive(Clone, Debug, Default)]
pub struct Windows {
    /// Weights an end.
    pub reach: usize,
    /// First texel of each start, clamped to [−reach, size].
    pub start: Vec<i32>,
    /// First texel of each stop, clamped likewise.
    pub stop: Vec<i32>,
    /// `reach` planes of one weight a column: g_k of the starts.
    pub start_before: Vec<f64>,
    /// Likewise of the stops.
    pub stop_before: Vec<f64>,
    /// Full width of the box in texels, > 0.
    pub width: f64,
    /// How far apart, in texels, the first and the last of four and of eight neighbouring ends lie at most.
    pub spans: [i32; 2],
}

impl Windows {
    /// Windows of `count` pixels whose boxes are centred on `centre(i)` texels and `width` texels wide, on a grid of
    /// `size` texels; each is averaged over `pixel` texels, 0 for the value at the centre.
    pub fn new(count: usize, centre: impl Fn(usize) -> f64, width: f64, size: usize, pixel: f64) -> Self {
        let reach = reach(pixel);
        let mut windows = Self {
            reach,
            start: vec![0; count],
            stop: vec![0; count],
            start_before: vec![0.0; reach * count],
            stop_before: vec![0.0; reach * count],
            width,
            spans: [0; 2],
        };
        let centres: Vec<f64> = (0..count).map(centre).collect();
        ends(&centres, -0.5 * width, pixel, size, &mut windows.start, &mut windows.start_before);
        ends(&centres, 0.5 * width, pixel, size, &mut windows.stop, &mut windows.stop_before);
        let span = |n: usize| {
            let of = |ends: &[i32]| ends.windows(n).map(|e| e[n - 1] - e[0]).max().unwrap_or(0);
            of(&windows.start).max(of(&windows.stop))
        };
        windows.spans = [span(4), span(8)];
        windows
    }

    /// Texels, inside the grid of `size`, that windows `range` touch.
    pub fn touched(&self, range: std::ops::Range<usize>, size: usize) -> [usize; 2] {
        let from = i64::from(self.start[range.start]).clamp(0, size as i64) as usize;
        let to = (i64::from(self.stop[range.end - 1]) + self.reach as i64).clamp(0, size as i64) as usize;
        [from, to.max(from)]
    }

    /// Texels, inside the grid of `size`, of which window `i` holds more than nothing.
    pub fn strictly_touched(&self, i: usize, size: usize) -> [usize; 2] {
        let [mut from, mut to] = self.touched(i..i + 1, size);
        while from < to && self.overlap(i, from as i64) <= 0.0 {
            from += 1;
        }
        while from < to && self.overlap(i, to as i64 - 1) <= 0.0 {
            to -= 1;
        }
        [from, to]
    }

    /// Whether windows `range` lie wholly on the grid.
    pub fn inside(&self, range: std::ops::Range<usize>, size: usize) -> bool {
        self.start[range.start] >= 0
            && i64::from(self.stop[range.end - 1]) + (self.reach as i64) <= size as i64
    }

    /// The share of window `i` that texel `t` has, in texels: its overlap with the box, averaged over the pixel.
    pub fn overlap(&self, i: usize, t: i64) -> f64 {
        let count = self.start.len();
        let before = |first: i32, weights: &[f64]| match t - i64::from(first) {
            k if k < 0 => 1.0,
            k if (k as usize) < self.reach => weights[k as usize * count + i],
            _ => 0.0,
        };
        (before(self.stop[i], &self.stop_before) - before(self.start[i], &self.start_before)).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Overlaps against midpoints over the pixel: Σ is the box's width, each texel its share.
    #[test]
    fn overlaps_are_those_of_a_box_slid_over_the_pixel() {
        for (width, pixel) in [(0.3, 0.0), (0.3, 1.7), (5.2, 0.0), (5.2, 1.7), (2.0, 4.4), (1e-4, 0.9)] {
            let centre = |i: usize| 3.37 + 0.61 * i as f64;
            let windows = Windows::new(12, centre, width, 20, pixel);
            for i in 0..12 {
                let mut sum = 0.0;
                for t in -10..30 {
                    let got = windows.overlap(i, t);
                    sum += got;
                    let n = if pixel > 0.0 { 20_000 } else { 1 };
                    let shifted = |k: usize| centre(i) + ((k as f64 + 0.5) / n as f64 - 0.5) * pixel;
                    let overlap = |c: f64| {
                        ((c + 0.5 * width).min((t + 1) as f64) - (c - 0.5 * width).max(t as f64)).max(0.0)
                    };
                    let expected = (0..n).map(|k| overlap(shifted(k))).sum::<f64>() / n as f64;
                    if (0..20).contains(&t) {
                        assert!(
                            (got - expected).abs() < 1e-3 * width.max(1e-3),
                            "{width} {pixel} {i} {t}: {got} {expected}"
                        );
                    }
                }
                assert!((sum / width - 1.0).abs() < 1e-9 || !windows.inside(i..i + 1, 20), "{sum}");
            }
        }
    }
}
