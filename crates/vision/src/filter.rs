//! Separable filtering with replicated borders.

/// A grey image, row-major.
#[derive(Clone, Debug)]
pub struct Plane {
    /// Pixels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width * height` values.
    pub values: Vec<f64>,
}

/// The 11-tap Gaussian of standard deviation `sigma` pixels, of sum 1.
pub fn gaussian_11(sigma: f64) -> Vec<f64> {
    let taps: Vec<f64> = (-5..=5).map(|x: i32| (-0.5 * (f64::from(x) / sigma).powi(2)).exp()).collect();
    let sum: f64 = taps.iter().sum();
    taps.iter().map(|tap| tap / sum).collect()
}

/// Correlates rows with `horizontal`, then columns with `vertical` (odd lengths, centre in the middle); borders are replicated.
pub fn separable(image: &Plane, horizontal: &[f64], vertical: &[f64]) -> Plane {
    let (width, height) = (image.width, image.height);
    let (rx, ry) = (horizontal.len() / 2, vertical.len() / 2);
    let mut rows = vec![0.0; width * height];
    let mut padded = vec![0.0; width + 2 * rx];
    for y in 0..height {
        let row = &image.values[y * width..][..width];
        padded[..rx].fill(row[0]);
        padded[rx..rx + width].copy_from_slice(row);
        padded[rx + width..].fill(row[width - 1]);
        for (x, out) in rows[y * width..][..width].iter_mut().enumerate() {
            *out = padded[x..].iter().zip(horizontal).map(|(value, tap)| value * tap).sum();
        }
    }
    let mut values = vec![0.0; width * height];
    for y in 0..height {
        let out = &mut values[y * width..][..width];
        for (k, tap) in vertical.iter().enumerate() {
            let source = (y + k).saturating_sub(ry).min(height - 1);
            for (out, value) in out.iter_mut().zip(&rows[source * width..][..width]) {
                *out += tap * value;
            }
        }
    }
    Plane { width, height, values }
}
