//! One image as it is compared: its irradiance, and what a display shows of it.

use kelir_vision::{flip, ssim};

/// An image in the forms that comparisons want.
pub(super) struct Seen {
    size: [usize; 2],
    /// Three planes; NaN where the screen is black.
    pub irradiance: Vec<f64>,
    /// sRGB values in [0, 1].
    display: Vec<[f64; 3]>,
}

impl Seen {
    /// From irradiance and display codes `0x__BBGGRR`.
    pub(super) fn new(irradiance: Vec<f64>, codes: &[u32], size: [usize; 2]) -> Self {
        let value = |code: u32| f64::from(code & 0xff) / 255.0;
        let display = codes.iter().map(|p| [value(*p), value(p >> 8), value(p >> 16)]).collect();
        Self { size, irradiance, display }
    }

    /// SSIM of the lumas; none under 11 pixels a side.
    pub(super) fn ssim(&self, reference: &Self) -> Option<f64> {
        let [width, height] = self.size;
        let luma = |image: &Self| -> Vec<f64> {
            image.display.iter().map(|[r, g, b]| 0.2126 * r + 0.7152 * g + 0.0722 * b).collect()
        };
        (width >= 11 && height >= 11).then(|| ssim::ssim(&luma(reference), &luma(self), width, height))
    }

    /// Mean FLIP.
    pub(super) fn flip(&self, reference: &Self) -> f64 {
        flip::mean_flip(&reference.display, &self.display, self.size[0], self.size[1])
    }
}
