//! A simulated photograph: what a camera in front of the screen would make of the audience's radiance.
//!
//! In linear light: defocus (the lens's disk), vignetting, photon and read noise; then sRGB in eight bits, and JPEG.
//! Everything random comes from a hash of seed, pixel and channel, so a photograph is the same bytes each time.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::encode::{Srgb, pack, png};
use crate::{Frame, RenderError};

/// The camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Camera {
    /// Radius of the disk that a point is spread over, pixels, 0..=64.
    pub defocus_px: f64,
    /// Tangent of the angle at which the corners are seen, 0..=2: light falls off with the cosine's fourth power.
    pub vignette: f64,
    /// Standard deviation of the photon noise of a white pixel, relative to white, 0..=1; a pixel of light x has √x times as
    /// much. Read noise is an eighth of it, everywhere.
    pub noise: f64,
    /// 1..=100; absent for a PNG.
    pub jpeg_quality: Option<u8>,
    /// Seed of the noise.
    pub seed: u64,
}

impl Default for Camera {
    fn default() -> Self {
        Self { defocus_px: 0.8, vignette: 0.25, noise: 0.012, jpeg_quality: Some(90), seed: 1 }
    }
}

/// A finished photograph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Photograph {
    /// `image/jpeg` or `image/png`.
    pub media_type: &'static str,
    /// The file.
    pub bytes: Vec<u8>,
}

impl Camera {
    /// Errors: a setting out of its range.
    pub fn check(&self) -> Result<(), RenderError> {
        let within = |name: &str, value: f64, most: f64| {
            let rule = || Err(RenderError::Knob(format!("camera.{name} = {value}: from 0 to {most}")));
            if (0.0..=most).contains(&value) { Ok(()) } else { rule() }
        };
        within("defocus_px", self.defocus_px, 64.0)?;
        within("vignette", self.vignette, 2.0)?;
        within("noise", self.noise, 1.0)?;
        match self.jpeg_quality {
            Some(q) if !(1..=100).contains(&q) => {
                Err(RenderError::Knob(format!("camera.jpeg_quality = {q}: from 1 to 100")))
            }
            _ => Ok(()),
        }
    }

    /// Display codes `0xFFBBGGRR` of the photograph, `white` as in the image itself.
    pub fn expose(&self, frame: &Frame, white: f64) -> Result<Vec<u32>, RenderError> {
        self.check()?;
        let [w, h] = frame.size;
        let mut planes = frame.radiance.each_ref().map(|plane| {
            let mut light: Vec<f32> = plane.iter().map(|l| (f64::from(*l) / white) as f32).collect();
            light = blur(&light, w, h, self.defocus_px);
            light
        });
        for (c, plane) in planes.iter_mut().enumerate() {
            plane.par_chunks_mut(w).enumerate().for_each(|(j, row)| {
                for (i, x) in row.iter_mut().enumerate() {
                    let light = f64::from(*x) * self.falloff(i, j, [w, h]);
                    let sigma = self.noise * (light.max(0.0) + 1.0 / 64.0).sqrt();
                    *x = (light + sigma * gaussian(self.seed, ((j * w + i) * 3 + c) as u64)) as f32;
                }
            });
        }
        let srgb = Srgb::get();
        let [r, g, b] = &planes;
        Ok(r.iter()
            .zip(g)
            .zip(b)
            .map(|((r, g), b)| pack(srgb.code(*r), srgb.code(*g), srgb.code(*b)))
            .collect())
    }

    /// The photograph of `frame` as a file.
    pub fn photograph(&self, frame: &Frame, white: f64) -> Result<Photograph, RenderError> {
        self.file(&self.expose(frame, white)?, frame.size)
    }

    /// Codes that were exposed, `width * height` of them, as a file.
    pub fn file(&self, codes: &[u32], size: [usize; 2]) -> Result<Photograph, RenderError> {
        let Some(quality) = self.jpeg_quality else {
            return Ok(Photograph { media_type: "image/png", bytes: png(codes, size)? });
        };
        let rgb: Vec<u8> = codes.iter().flat_map(|p| [*p as u8, (p >> 8) as u8, (p >> 16) as u8]).collect();
        let mut bytes = Vec::new();
        let mut encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, quality);
        encoder
            .encode(&rgb, size[0] as u32, size[1] as u32, image::ExtendedColorType::Rgb8)
            .map_err(|e| RenderError::Encode(format!("jpeg: {e}")))?;
        Ok(Photograph { media_type: "image/jpeg", bytes })
    }

    /// cos⁴ of the angle off axis; 1 in the middle.
    fn falloff(&self, i: usize, j: usize, [w, h]: [usize; 2]) -> f64 {
        let off = |k: usize, n: usize| k as f64 + 0.5 - 0.5 * n as f64;
        let r2 = off(i, w).powi(2) + off(j, h).powi(2);
        let corner2 = 0.25 * ((w * w + h * h) as f64);
        (1.0 + self.vignette * self.vignette * r2 / corner2).powi(-2)
    }
}

/// Rows of a disk: offset and the weights of columns −reach..=reach, each pixel's share by 16 × 16 sub-samples.
fn disk(radius: f64) -> (isize, Vec<Vec<f32>>) {
    let reach = (radius + 0.5).ceil() as isize;
    let sub = |k: isize, s: usize| k as f64 + (s as f64 + 0.5) / 16.0 - 0.5;
    let share = |x: isize, y: isize| {
        let inside = |s: usize| sub(x, s % 16).hypot(sub(y, s / 16)) <= radius;
        (0..256).filter(|s| inside(*s)).count() as f64
    };
    let mut rows: Vec<Vec<f64>> =
        (-reach..=reach).map(|y| (-reach..=reach).map(|x| share(x, y)).collect()).collect();
    let sum: f64 = rows.iter().flatten().sum();
    if sum > 0.0 {
        rows.iter_mut().flatten().for_each(|w| *w /= sum);
    } else {
        rows[reach as usize][reach as usize] = 1.0;
    }
    (reach, rows.into_iter().map(|row| row.into_iter().map(|w| w as f32).collect()).collect())
}

/// Convolution with a disk; beyond the image its edge pixels go on.
fn blur(light: &[f32], w: usize, h: usize, radius: f64) -> Vec<f32> {
    if radius <= 0.0 {
        return light.to_vec();
    }
    let (reach, kernel) = disk(radius);
    let mut out = vec![0f32; w * h];
    out.par_chunks_mut(w).enumerate().for_each(|(j, out)| {
        for (dy, weights) in (-reach..=reach).zip(&kernel) {
            let y = (j as isize + dy).clamp(0, h as isize - 1) as usize;
            let row = &light[y * w..][..w];
            for (dx, weight) in (-reach..=reach).zip(weights).filter(|(_, weight)| **weight > 0.0) {
                for (i, o) in out.iter_mut().enumerate() {
                    *o += weight * row[(i as isize + dx).clamp(0, w as isize - 1) as usize];
                }
            }
        }
    });
    out
}

/// Nearly Gaussian, mean 0 and variance 1: twelve uniform 16-bit numbers, summed in integers, so that every machine agrees.
fn gaussian(seed: u64, index: u64) -> f64 {
    let mix = |mut x: u64| {
        x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    };
    let first = mix(seed ^ mix(index));
    let words = [first, mix(first), mix(mix(first))];
    let sum: u64 = words.iter().flat_map(|w| [w & 0xffff, w >> 16 & 0xffff, w >> 32 & 0xffff, w >> 48]).sum();
    (sum as f64 + 6.0) / 65536.0 - 6.0
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    fn flat(level: f32) -> Frame {
        let plane = vec![level; 200 * 150];
        Frame {
            size: [200, 150],
            radiance: [plane.clone(), plane.clone(), plane],
            visibilities: vec![],
            standard_error: None,
            stats: crate::Stats::default(),
        }
    }

    const PLAIN: Camera = Camera { defocus_px: 0.0, vignette: 0.0, noise: 0.0, jpeg_quality: None, seed: 3 };

    #[test]
    fn a_camera_that_does_nothing_shows_the_image() {
        assert_eq!(PLAIN.expose(&flat(0.3), 0.6).unwrap(), crate::encode::display(&flat(0.3), 0.6));
    }

    #[test]
    fn the_same_bytes_each_time_and_others_for_another_seed() {
        let camera = Camera { noise: 0.02, jpeg_quality: Some(85), ..Camera::default() };
        let one = camera.photograph(&flat(0.3), 0.6).unwrap();
        assert_eq!((one.media_type, &one.bytes[..2]), ("image/jpeg", &[0xff, 0xd8][..]));
        assert_eq!(one, camera.photograph(&flat(0.3), 0.6).unwrap());
        assert_ne!(one, Camera { seed: 8, ..camera }.photograph(&flat(0.3), 0.6).unwrap());
    }

    #[test]
    fn noise_has_its_mean_and_variance() {
        let sample: Vec<f64> = (0..200_000).map(|k| gaussian(5, k)).collect();
        let n = sample.len() as f64;
        let mean = sample.iter().sum::<f64>() / n;
        let variance = sample.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
        assert!(mean.abs() < 4.0 / n.sqrt(), "{mean}");
        assert!((variance - 1.0).abs() < 4.0 * (2.0 / n).sqrt(), "{variance}");
        let lag = sample.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / n;
        assert!(lag.abs() < 4.0 / n.sqrt(), "{lag}");
    }

    #[test]
    fn vignette_darkens_by_the_cosine_to_the_fourth() {
        let camera = Camera { vignette: 1.0, ..PLAIN };
        assert!((camera.falloff(0, 0, [2000, 1500]) - 0.25).abs() < 1e-3, "45 degrees in the corner");
        assert!(camera.falloff(1000, 750, [2000, 1500]) > 0.999_999);
    }

    #[test]
    fn defocus_keeps_the_light_and_spreads_it_over_a_disk() {
        let mut light = vec![0f32; 41 * 41];
        light[20 * 41 + 20] = 1.0;
        let spread = blur(&light, 41, 41, 5.0);
        assert!((spread.iter().sum::<f32>() - 1.0).abs() < 1e-5);
        let expected = 1.0 / (std::f32::consts::PI * 25.0);
        assert!((spread[20 * 41 + 23] / expected - 1.0).abs() < 0.01);
        assert_eq!(spread[20 * 41 + 26], 0.0);
    }

    #[test]
    fn settings_out_of_range_are_named() {
        for (camera, name) in [
            (Camera { defocus_px: -1.0, ..PLAIN }, "camera.defocus_px"),
            (Camera { vignette: f64::NAN, ..PLAIN }, "camera.vignette"),
            (Camera { noise: 2.0, ..PLAIN }, "camera.noise"),
            (Camera { jpeg_quality: Some(0), ..PLAIN }, "camera.jpeg_quality"),
        ] {
            assert!(camera.photograph(&flat(0.3), 1.0).unwrap_err().to_string().contains(name));
        }
    }
}
