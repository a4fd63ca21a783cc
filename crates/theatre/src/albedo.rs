//! The screen's albedo on the output's pixel grid.

use kelir_frame::{Pixel, View};
use kelir_scene::{Albedo, LinearImage, Screen};
use rayon::prelude::*;

/// Albedo per pixel.
#[derive(Clone, Debug, PartialEq)]
pub enum PixelAlbedo {
    /// The same in every pixel.
    Uniform([f32; 3]),
    /// Planes of `width * height`, row-major, first row on top: three, or one where the image is grey.
    Image(Vec<Vec<f32>>),
}

impl PixelAlbedo {
    /// Channel `c` of pixel `k` (row-major index).
    pub fn at(&self, c: usize, k: usize) -> f32 {
        match self {
            Self::Uniform(a) => a[c],
            Self::Image(planes) => planes[c.min(planes.len() - 1)][k],
        }
    }

    /// Whether all channels are equal.
    pub fn is_grey(&self) -> bool {
        match self {
            Self::Uniform([r, g, b]) => r == g && g == b,
            Self::Image(planes) => planes.len() == 1,
        }
    }
}

/// Resamples the screen's albedo once to the pixel grid: the mean over each pixel for [`Pixel::Area`], the value of the
/// texel at its centre for [`Pixel::Centre`].
pub fn on_grid(screen: &Screen, view: &View) -> PixelAlbedo {
    match &screen.albedo {
        Albedo::Uniform(a) => PixelAlbedo::Uniform(a.map(|v| v as f32)),
        Albedo::Image(image) => PixelAlbedo::Image(resample(image, view)),
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
    most: usize,
}

impl Columns {
    fn new(n: usize, source: usize, pixel: Pixel) -> Self {
        let cells: Vec<_> = (0..n).map(|i| cells(i, n, source, pixel)).collect();
        let most = cells.iter().map(|(_, weights)| weights.len()).max().unwrap_or(1);
        let weight = |k: usize| cells.iter().map(move |(_, w)| w.get(k).copied().unwrap_or(0.0));
        Self {
            weights: (0..most).flat_map(weight).collect(),
            first: cells.iter().map(|c| c.0).collect(),
            most,
        }
    }

    /// Adds `weight` times the means of channel `c` of a row of texels.
    fn add(&self, row: &[[f32; 3]], c: usize, weight: f64, sums: &mut [f64]) {
        for (i, sum) in sums.iter_mut().enumerate() {
            for k in 0..self.most {
                let texel = row[(self.first[i] + k).min(row.len() - 1)][c];
                *sum += weight * self.weights[k * self.first.len() + i] * f64::from(texel);
            }
        }
    }
}

fn resample(image: &LinearImage, view: &View) -> Vec<Vec<f32>> {
    let [w, h] = view.size;
    let columns = Columns::new(w, image.width, view.pixel);
    let rows: Vec<_> = (0..h).map(|j| cells(j, h, image.height, view.pixel)).collect();
    let grey = image.rgb.par_chunks(1 << 14).all(|part| part.iter().all(|[r, g, b]| r == g && g == b));
    let plane = |c: usize| {
        let mut out = vec![0f32; w * h];
        out.par_chunks_mut(w).zip(&rows).for_each_init(Vec::new, |sums, (out, (y0, weights))| {
            sums.clear();
            sums.resize(w, 0f64);
            for (dy, weight) in weights.iter().enumerate() {
                columns.add(&image.rgb[(y0 + dy) * image.width..][..image.width], c, *weight, sums);
            }
            out.iter_mut().zip(&*sums).for_each(|(out, sum)| *out = *sum as f32);
        });
        out
    };
    (0..if grey { 1 } else { 3 }).map(plane).collect()
}
