//! The screen's albedo on the output's pixel grid.

use std::sync::Arc;

use kelir_frame::{Pixel, View, multiversion};
use kelir_scene::{Albedo, LinearImage, Screen};
use rayon::prelude::*;

/// Albedo per pixel.
#[derive(Clone, Debug, PartialEq)]
pub enum PixelAlbedo {
    /// The same in every pixel.
    Uniform([f32; 3]),
    /// An image of as many pixels; the cloth itself where its grid is theirs.
    Image(Arc<LinearImage>),
}

impl PixelAlbedo {
    /// Channel `c` of pixel `k` (row-major index).
    pub fn at(&self, c: usize, k: usize) -> f32 {
        match self {
            Self::Uniform(a) => a[c],
            Self::Image(image) => image.channel(c)[k],
        }
    }

    /// Whether all channels are equal.
    pub fn is_grey(&self) -> bool {
        match self {
            Self::Uniform([r, g, b]) => r == g && g == b,
            Self::Image(image) => image.planes.len() == 1,
        }
    }
}

/// Resamples the screen's albedo once to the pixel grid: the mean over each pixel for [`Pixel::Area`], the value of the
/// texel at its centre for [`Pixel::Centre`].
pub fn on_grid(screen: &Screen, view: &View) -> PixelAlbedo {
    match &screen.albedo {
        Albedo::Uniform(a) => PixelAlbedo::Uniform(a.map(|v| v as f32)),
        Albedo::Image(image) if [image.width, image.height] == view.size => PixelAlbedo::Image(image.clone()),
        Albedo::Image(image) => PixelAlbedo::Image(Arc::new(resample(image, view))),
    }
}

/// Weights of the source cells [first, first + weights.len()) in the mean over output cell `k` of `n`.
fn cells(k: usize, n: usize, source: usize, pixel: Pixel) -> (usize, Vec<f64>) {
    let step = source as f64 / n as f64;
    match pixel {
        Pixel::Centre => ((((k as f64 + 0.5) * step) as usize).min(source - 1), vec![1.0]),
        Pixel::Area => {
            let (from, to) = (k as f64 * step, (k + 1) as f64 * step);
            let first = (from as usize).min(source - 1);
            let last = (to.ceil() as usize).clamp(first + 1, source);
            let part = |i: usize| (to.min((i + 1) as f64) - from.max(i as f64)).max(0.0) / step;
            (first, (first..last).map(part).collect())
        }
    }
}

/// [`cells`] of every output cell of a row: weights of the kth source cell at `k * n`, 0 where a cell has fewer.
struct Columns {
    first: Vec<usize>,
    weights: Vec<f64>,
}

impl Columns {
    fn new(n: usize, source: usize, pixel: Pixel) -> Self {
        let cells: Vec<_> = (0..n).map(|i| cells(i, n, source, pixel)).collect();
        let most = cells.iter().map(|(_, weights)| weights.len()).max().unwrap_or(1);
        let weight = |k: usize| cells.iter().map(move |(_, w)| w.get(k).copied().unwrap_or(0.0));
        Self { weights: (0..most).flat_map(weight).collect(), first: cells.iter().map(|c| c.0).collect() }
    }

    /// Adds `weight` times the means of a row of texels.
    fn add(&self, row: &[f32], weight: f64, sums: &mut [f64]) {
        add(&self.first, &self.weights, row, weight, sums);
    }
}

#[inline(always)]
fn add_generic(first: &[usize], weights: &[f64], row: &[f32], weight: f64, sums: &mut [f64]) {
    for (k, weights) in weights.chunks_exact(first.len()).enumerate() {
        for ((sum, first), w) in sums.iter_mut().zip(first).zip(weights) {
            let texel = row[(first + k).min(row.len() - 1)];
            *sum += weight * w * f64::from(texel);
        }
    }
}
multiversion! { fn add(first: &[usize], weights: &[f64], row: &[f32], weight: f64, sums: &mut [f64]) = add_generic; }

fn resample(image: &LinearImage, view: &View) -> LinearImage {
    let [w, h] = view.size;
    let columns = Columns::new(w, image.width, view.pixel);
    let rows: Vec<_> = (0..h).map(|j| cells(j, h, image.height, view.pixel)).collect();
    let plane = |texels: &Vec<f32>| {
        let mut out = vec![0f32; w * h];
        out.par_chunks_mut(w).zip(&rows).for_each_init(Vec::new, |sums, (out, (y0, weights))| {
            sums.clear();
            sums.resize(w, 0f64);
            for (dy, weight) in weights.iter().enumerate() {
                columns.add(&texels[(y0 + dy) * image.width..][..image.width], *weight, sums);
            }
            out.iter_mut().zip(&*sums).for_each(|(out, sum)| *out = *sum as f32);
        });
        out
    };
    LinearImage { width: w, height: h, planes: image.planes.iter().map(plane).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against sums over all texels, each weighed by its overlap with the pixel; one plane only where the image is grey.
    #[test]
    fn pixels_are_means_of_texels() {
        let source = [7usize, 5];
        for grey in [true, false] {
            let texel = |k: usize, c: usize| ((k * 31 + if grey { 0 } else { c * 17 }) % 23) as f32 / 23.0;
            let rgb: Vec<_> = (0..35).map(|k| [0, 1, 2].map(|c| texel(k, c))).collect();
            let image = LinearImage::new(source[0], source[1], &rgb);
            let screen = Screen { width_m: 1.4, height_m: 1.0, albedo: Albedo::Image(Arc::new(image)) };
            for size in [[7, 5], [3, 2], [20, 14]] {
                let overlap = |i: usize, d: usize, t: usize| {
                    let step = source[d] as f64 / size[d] as f64;
                    let (from, to) = (i as f64 * step, (i + 1) as f64 * step);
                    (to.min(t as f64 + 1.0) - from.max(t as f64)).max(0.0) / step
                };
                let mean = |i: usize, j: usize, c: usize| -> f64 {
                    let part =
                        |k: usize| overlap(i, 0, k % 7) * overlap(j, 1, k / 7) * f64::from(texel(k, c));
                    (0..35).map(part).sum()
                };
                let got = on_grid(&screen, &View { size, pixel: Pixel::Area, skip: true });
                assert_eq!(got.is_grey(), grey);
                for k in 0..size[0] * size[1] {
                    for c in 0..3 {
                        let (got, expected) = (f64::from(got.at(c, k)), mean(k % size[0], k / size[0], c));
                        assert!((got - expected).abs() < 1e-7, "{size:?} pixel {k}: {got}, not {expected}");
                    }
                }
                let centre = on_grid(&screen, &View { size, pixel: Pixel::Centre, skip: true });
                let middle = |k: usize, n: usize, of: usize| (2 * k + 1) * of / (2 * n);
                for k in 0..size[0] * size[1] {
                    let (i, j) = (middle(k % size[0], size[0], 7), middle(k / size[0], size[1], 5));
                    assert_eq!(centre.at(1, k), texel(j * 7 + i, 1), "{size:?} pixel {k}");
                }
            }
        }
    }
}
