//! PNG and JPEG, decoded after their size is known to be bearable.

use std::io::Cursor;

use image::{DynamicImage, ImageFormat, ImageReader, Limits};

use super::grid::{Lattice, Rect, Texture};
use crate::colour::{srgb_to_linear, srgb8_to_linear};
use crate::limits;

/// Decodes a PNG or JPEG, or says which rule it breaks. The size is checked before any pixel is decoded.
pub(crate) fn decode(bytes: &[u8]) -> Result<DynamicImage, String> {
    let format = match image::guess_format(bytes) {
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
        _ => return Err("is not a PNG or JPEG file".to_owned()),
    };
    let most = limits::IMAGE_SIDE;
    let reader = || {
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        let mut allowed = Limits::default();
        // RGBA in 16 bits of the largest image, and as much again for the decoder.
        allowed.max_alloc = Some((most * most * 16) as u64);
        reader.limits(allowed);
        reader
    };
    let unreadable = |e: image::ImageError| format!("can't be decoded: {e}");
    let (width, height) = reader().into_dimensions().map_err(unreadable)?;
    if width == 0 || height == 0 {
        return Err("has no pixels".to_owned());
    }
    if width as usize > most || height as usize > most {
        return Err(format!("is {width} × {height} pixels; an image has at most {most} a side"));
    }
    reader().decode().map_err(unreadable)
}

/// A scanned puppet.
pub(crate) struct Bitmap {
    image: DynamicImage,
}

impl Bitmap {
    pub(crate) fn open(bytes: &[u8]) -> Result<Self, String> {
        let image = match decode(bytes)? {
            // What has few colours or none becomes RGBA; 16-bit images keep their depth.
            image @ (DynamicImage::ImageRgba8(_) | DynamicImage::ImageRgba16(_)) => image,
            DynamicImage::ImageRgb16(_) | DynamicImage::ImageLuma16(_) | DynamicImage::ImageLumaA16(_) => {
                return Self::open_deep(bytes);
            }
            image => DynamicImage::ImageRgba8(image.into_rgba8()),
        };
        Ok(Self { image })
    }

    fn open_deep(bytes: &[u8]) -> Result<Self, String> {
        Ok(Self { image: DynamicImage::ImageRgba16(decode(bytes)?.into_rgba16()) })
    }

    /// [columns, rows].
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.image.width() as usize, self.image.height() as usize]
    }

    /// Opacities α(1 − T) on the lattice: copied where it is the image's own, else the mean over each texel's area.
    pub(crate) fn texture(&self, lattice: &Lattice, translucent: bool) -> Texture {
        let [width, height] = self.size();
        let within = Rect::of_size(lattice.columns, lattice.rows);
        match &self.image {
            DynamicImage::ImageRgba16(image) => {
                let linear: Vec<f32> = if translucent {
                    (0..=u16::MAX).map(|c| srgb_to_linear(f64::from(c) / 65535.0) as f32).collect()
                } else {
                    vec![0.0; 1 << 16]
                };
                let pixel = |x: usize, y: usize| {
                    let [r, g, b, a] = image.get_pixel(x as u32, y as u32).0;
                    let alpha = f32::from(a) / 65535.0;
                    [r, g, b].map(|c| alpha * (1.0 - linear[c as usize]))
                };
                sample(width, height, lattice, within, pixel)
            }
            DynamicImage::ImageRgba8(image) => {
                let linear = if translucent { *srgb8_to_linear() } else { [0.0; 256] };
                let pixel = |x: usize, y: usize| {
                    let [r, g, b, a] = image.get_pixel(x as u32, y as u32).0;
                    let alpha = f32::from(a) / 255.0;
                    [r, g, b].map(|c| alpha * (1.0 - linear[c as usize]))
                };
                sample(width, height, lattice, within, pixel)
            }
            _ => unreachable!("a bitmap is RGBA"),
        }
    }
}

fn sample(
    width: usize,
    height: usize,
    lattice: &Lattice,
    within: Rect,
    pixel: impl Fn(usize, usize) -> [f32; 3] + Sync,
) -> Texture {
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
