//! Structural similarity of display images: a second opinion, never the accuracy claim.

use crate::filter::{Plane, gaussian_11, separable};

/// Mean SSIM of two grey images with values in [0, 1], row-major, `width * height` each; in [−1, 1], 1 for equal images.
///
/// Wang, Bovik, Sheikh & Simoncelli 2004: Gaussian window σ = 1.5 cut to 11 × 11, K = (0.01, 0.03), the 5 pixels at each border left
/// out of the mean. Panics when a length is not `width * height`, or a side is under 11 pixels.
pub fn ssim(reference: &[f64], test: &[f64], width: usize, height: usize) -> f64 {
    assert!(width >= 11 && height >= 11, "SSIM needs at least 11 × 11 pixels, not {width} × {height}");
    let kernel = gaussian_11(1.5);
    let blur = |values: Vec<f64>| separable(&Plane { width, height, values }, &kernel, &kernel).values;
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).collect::<Vec<_>>();
    assert_eq!(reference.len(), width * height);
    assert_eq!(test.len(), width * height);

    let (mean_r, mean_t) = (blur(reference.to_vec()), blur(test.to_vec()));
    let (square_r, square_t) = (blur(product(reference, reference)), blur(product(test, test)));
    let cross = blur(product(reference, test));
    let (c1, c2) = (0.01_f64.powi(2), 0.03_f64.powi(2));

    let mut sum = 0.0;
    for y in 5..height - 5 {
        for x in 5..width - 5 {
            let i = y * width + x;
            let (r, t) = (mean_r[i], mean_t[i]);
            let (var_r, var_t, cov) = (square_r[i] - r * r, square_t[i] - t * t, cross[i] - r * t);
            sum += (2.0 * r * t + c1) * (2.0 * cov + c2) / ((r * r + t * t + c1) * (var_r + var_t + c2));
        }
    }
    sum / ((width - 10) * (height - 10)) as f64
}
