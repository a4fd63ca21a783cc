//! Scans: PNG and JPEG as puppets.

use std::ops::Bound::Excluded;

use image::DynamicImage;
use kelir_reader::Node;

use super::grid::{Lattice, Texture};
use crate::picture::Picture;

/// What a picture without alpha is opaque by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum AlphaFrom {
    /// As opaque as it is dark.
    Luminance,
    /// Opaque where its luminance is below this, else clear.
    Below(f64),
}

impl AlphaFrom {
    pub(crate) fn read(node: &Node) -> Option<Self> {
        if node.as_str().is_some() {
            return node.choice(&[("luminance", Self::Luminance)]);
        }
        let rule = "is \"luminance\", or the luminance, above 0 and below 1, under which a pixel is opaque";
        node.number_in((Excluded(0.0), Excluded(1.0)), rule).map(Self::Below)
    }

    /// The share of a pixel's alpha that is left, by its linear colour (luminance as in BT.709).
    fn share(self, [r, g, b]: [f32; 3]) -> f32 {
        let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        match self {
            Self::Luminance => (1.0 - luminance).clamp(0.0, 1.0),
            Self::Below(threshold) => f32::from(u8::from(f64::from(luminance) < threshold)),
        }
    }
}

/// A scanned puppet.
pub(crate) struct Bitmap {
    /// RGBA in 8 or 16 bits.
    picture: Picture,
}

impl Bitmap {
    pub(crate) fn open(bytes: &[u8]) -> Result<Self, String> {
        let mut picture = Picture::decode(bytes)?;
        // What has few colours or none becomes RGBA; 16-bit images keep their depth.
        picture.image = match picture.image {
            image @ (DynamicImage::ImageRgba16(_)
            | DynamicImage::ImageRgb16(_)
            | DynamicImage::ImageLuma16(_)
            | DynamicImage::ImageLumaA16(_)) => DynamicImage::ImageRgba16(image.into_rgba16()),
            image => DynamicImage::ImageRgba8(image.into_rgba8()),
        };
        Ok(Self { picture })
    }

    /// [columns, rows].
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.picture.image.width() as usize, self.picture.image.height() as usize]
    }

    /// Whether no pixel lets anything through by its alpha.
    pub(crate) fn is_opaque(&self) -> bool {
        match &self.picture.image {
            DynamicImage::ImageRgba16(image) => image.pixels().all(|p| p.0[3] == u16::MAX),
            DynamicImage::ImageRgba8(image) => image.pixels().all(|p| p.0[3] == u8::MAX),
            _ => unreachable!("a bitmap is RGBA"),
        }
    }

    /// Opacities α(1 − T) on the lattice: copied where it is the image's own, else the mean over each texel's area. Errors: its colours matter, and
    /// it says something of them that can't be applied.
    pub(crate) fn texture(
        &self,
        lattice: &Lattice,
        translucent: bool,
        alpha_from: Option<AlphaFrom>,
    ) -> Result<Texture, String> {
        let codes = if matches!(self.picture.image, DynamicImage::ImageRgba16(_)) { 1 << 16 } else { 1 << 8 };
        let linear = match translucent || alpha_from.is_some() {
            true => self.picture.linear(codes)?,
            false => vec![0.0; codes],
        };
        let opacity = |rgb: [usize; 3], alpha: f32| {
            let light = rgb.map(|c| linear[c]);
            let alpha = alpha_from.map_or(alpha, |from| alpha * from.share(light));
            if translucent { light.map(|l| alpha * (1.0 - l)) } else { [alpha; 3] }
        };
        let size = self.size();
        Ok(match &self.picture.image {
            DynamicImage::ImageRgba16(image) => sample(size, lattice, |x, y| {
                let [r, g, b, a] = image.get_pixel(x as u32, y as u32).0;
                opacity([r, g, b].map(usize::from), f32::from(a) / 65535.0)
            }),
            DynamicImage::ImageRgba8(image) => sample(size, lattice, |x, y| {
                let [r, g, b, a] = image.get_pixel(x as u32, y as u32).0;
                opacity([r, g, b].map(usize::from), f32::from(a) / 255.0)
            }),
            _ => unreachable!("a bitmap is RGBA"),
        })
    }
}

fn sample(
    [width, height]: [usize; 2],
    lattice: &Lattice,
    pixel: impl Fn(usize, usize) -> [f32; 3] + Sync,
) -> Texture {
    let within = lattice.rest();
    if [lattice.columns, lattice.rows] == [width, height] {
        return Texture::new(within, |x, y| pixel(x as usize, y as usize));
    }
    let columns = shares(width, lattice.columns, lattice.scale, lattice.margin);
    let rows = shares(height, lattice.rows, lattice.scale, 0.0);
    Texture::new(within, |x, y| {
        let mut sum = [0.0f64; 3];
        for &(j, wy) in &rows[y as usize] {
            for &(i, wx) in &columns[x as usize] {
                for (sum, value) in sum.iter_mut().zip(pixel(i, j)) {
                    *sum += wx * wy * f64::from(value);
                }
            }
        }
        sum.map(|s| s.clamp(0.0, 1.0) as f32)
    })
}

/// For each texel along an axis, the pixels that it covers and the share of the texel that each fills.
fn shares(pixels: usize, texels: usize, scale: f64, margin: f64) -> Vec<Vec<(usize, f64)>> {
    (0..texels)
        .map(|t| {
            let (low, high) = ((t as f64 - margin) / scale, (t as f64 + 1.0 - margin) / scale);
            let first = low.floor().max(0.0) as usize;
            let end = (high.ceil().max(0.0) as usize).min(pixels);
            (first..end)
                .map(|p| (p, (high.min(p as f64 + 1.0) - low.max(p as f64)).max(0.0) * scale))
                .filter(|(_, share)| *share > 0.0)
                .collect()
        })
        .collect()
}
