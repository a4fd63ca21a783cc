//! Images measured: errors in linear light, and display-space second opinions on how different two images look.
pub mod errors;
pub mod filter;
pub mod flip;
pub mod ssim;

#[cfg(test)]
mod tests {
    use super::flip::{PIXELS_PER_DEGREE, flip, mean_flip};
    use super::ssim::ssim;

    const W: usize = 64;
    const H: usize = 48;

    /// The images of tests/data/make_second_opinions.py.
    fn image(cx: f64, level: f64, tint: [f64; 3]) -> Vec<[f64; 3]> {
        (0..W * H)
            .map(|i| {
                let (x, y) = ((i % W) as f64, (i / W) as f64);
                let t = (((x - cx).hypot(y - 24.0) - 12.0) / 6.0 + 0.5).clamp(0.0, 1.0);
                let value = (0.4 + 0.5 * x / W as f64) * (t + (1.0 - t) * level);
                tint.map(|channel| channel * value)
            })
            .collect()
    }

    fn pair() -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
        (image(30.0, 0.1, [1.0, 0.9, 0.7]), image(31.5, 0.15, [1.0, 0.88, 0.72]))
    }

    fn grey(image: &[[f64; 3]]) -> Vec<f64> {
        image.iter().map(|[r, g, b]| 0.25 * r + 0.5 * g + 0.25 * b).collect()
    }

    #[test]
    fn ssim_agrees_with_scikit_image() {
        let (a, b) = pair();
        let value = ssim(&grey(&a), &grey(&b), W, H);
        assert!((value - 0.930229381637768).abs() < 1e-12, "{value}");
        assert_eq!(ssim(&grey(&a), &grey(&a), W, H), 1.0);
        // Negative control: one code of difference in one pixel is seen.
        let mut c = grey(&b);
        c[W * 24 + 32] += 1.0 / 255.0;
        assert!((ssim(&grey(&a), &c, W, H) - 0.930229381637768).abs() > 1e-7);
    }

    #[test]
    fn flip_agrees_with_its_authors_program() {
        // Theirs is f32 throughout, hence the tolerance.
        let (a, b) = pair();
        let map = flip(&a, &b, W, H, PIXELS_PER_DEGREE);
        let largest = map.iter().copied().fold(0.0, f64::max);
        assert!((mean_flip(&a, &b, W, H) - 0.1775304526090622).abs() < 2e-5, "{}", mean_flip(&a, &b, W, H));
        assert!((largest - 0.5022330284118652).abs() < 2e-5, "{largest}");
        assert_eq!(mean_flip(&a, &a, W, H), 0.0);
        // Negative control: at half the resolution a viewer sees another error.
        let near = flip(&a, &b, W, H, 0.5 * PIXELS_PER_DEGREE);
        assert!((near.iter().sum::<f64>() / near.len() as f64 - 0.1775304526090622).abs() > 1e-3);
    }
}
