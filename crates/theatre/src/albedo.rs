//! The screen's albedo on the output's pixel grid.

use kelir_frame::{Pixel, View};
use kelir_scene::{Albedo, LinearImage, Screen};

/// Albedo per pixel.
#[derive(Clone, Debug, PartialEq)]
pub enum PixelAlbedo {
    /// The same in every pixel.
    Uniform([f32; 3]),
    /// Three planes of `width * height`, row-major, first row on top.
    Image([Vec<f32>; 3]),
}

impl PixelAlbedo {
    /// Channel `c` of pixel `k` (row-major index).
    pub fn at(&self, c: usize, k: usize) -> f32 {
        match self {
            Self::Uniform(a) => a[c],
            Self::Image(planes) => planes[c][k],
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

fn resample(image: &LinearImage, view: &View) -> [Vec<f32>; 3] {
    let [w, h] = view.size;
    let columns: Vec<_> = (0..w).map(|i| cells(i, w, image.width, view.pixel)).collect();
    let rows: Vec<_> = (0..h).map(|j| cells(j, h, image.height, view.pixel)).collect();
    let mut out = [vec![0f32; w * h], vec![0f32; w * h], vec![0f32; w * h]];
    for (j, (y0, wy)) in rows.iter().enumerate() {
        for (i, (x0, wx)) in columns.iter().enumerate() {
            let mut sum = [0f64; 3];
            for (dy, fy) in wy.iter().enumerate() {
                let row = &image.rgb[(y0 + dy) * image.width + x0..];
                for (texel, fx) in row.iter().zip(wx) {
                    for c in 0..3 {
                        sum[c] += fy * fx * f64::from(texel[c]);
                    }
                }
            }
            for c in 0..3 {
                out[c][j * w + i] = sum[c] as f32;
            }
        }
    }
    out
}
