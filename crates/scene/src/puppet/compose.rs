//! From parts and a pose to a mask: resample the moved parts, multiply, quantise once.

use rayon::prelude::*;

use super::grid::{Rect, Rigid, Texture};
use crate::theatre::Texels;

/// Rows that one task draws.
const BAND: usize = 16;

/// A part where a pose puts it.
pub(crate) struct Placed<'a> {
    pub texture: &'a Texture,
    pub motion: Rigid,
}

/// The product of the parts that never move: transmittances and their codes.
#[derive(Debug)]
pub(crate) struct Plate {
    pub rect: Rect,
    /// One plane a channel.
    pub transmittance: Vec<f32>,
    pub codes: Texels,
}

/// A texel's code: u8 or u16.
pub(crate) trait Code: Copy + Send + Sync {
    /// The code that lets everything through.
    const CLEAR: Self;
    /// Nearest code of a transmittance in [0, 1].
    fn nearest(transmittance: f32) -> Self;
}

// Adding 2²³ leaves the nearest whole number in the low bits: it rounds as the hardware does, and vectorises.
const ROUND: f32 = 8_388_608.0;

impl Code for u8 {
    const CLEAR: u8 = u8::MAX;
    fn nearest(transmittance: f32) -> u8 {
        (transmittance * 255.0 + ROUND).to_bits() as u8
    }
}

impl Code for u16 {
    const CLEAR: u16 = u16::MAX;
    fn nearest(transmittance: f32) -> u16 {
        (transmittance * 65535.0 + ROUND).to_bits() as u16
    }
}

/// Draws the product of `plate` and `parts` on the texels of `extent`, one plane a channel, into `codes`
/// (resized; its old content does not matter).
pub(crate) fn compose<C: Code>(
    extent: Rect,
    channels: usize,
    plate: Option<(Rect, &[f32], &[C])>,
    parts: &[Placed],
    codes: &mut Vec<C>,
) {
    let (width, height) = (extent.width(), extent.height());
    codes.resize(width * height * channels, C::CLEAR);
    let samplers: Vec<_> = parts.iter().map(Sampler::new).collect();
    for (c, plane) in codes.chunks_exact_mut((width * height).max(1)).enumerate() {
        plane.par_chunks_mut(width * BAND).enumerate().for_each_init(
            || vec![1.0f32; width],
            |light, (band, rows)| {
                for (j, row) in rows.chunks_exact_mut(width).enumerate() {
                    let y = extent.y0 + (band * BAND + j) as i64;
                    compose_row(extent, y, c, plate, &samplers, light, row);
                }
            },
        );
    }
}

/// Multiplies a part into the transmittances of `extent`, one plane a channel.
pub(crate) fn multiply(extent: Rect, part: &Placed, light: &mut [f32]) {
    let (width, sampler) = (extent.width(), Sampler::new(part));
    for (c, plane) in light.chunks_exact_mut(extent.area().max(1)).enumerate() {
        plane.par_chunks_exact_mut(width).enumerate().for_each(|(j, row)| {
            let y = extent.y0 + j as i64;
            if let Some(span) = sampler.span(y, extent) {
                sampler.multiply(y, extent, c, span.clone(), &mut row[span]);
            }
        });
    }
}

/// One row of one channel; `light` is scratch of the row's length.
fn compose_row<C: Code>(
    extent: Rect,
    y: i64,
    channel: usize,
    plate: Option<(Rect, &[f32], &[C])>,
    samplers: &[Sampler],
    light: &mut [f32],
    row: &mut [C],
) {
    // What no moving part touches is a copy of the plate's codes, or clear.
    let under = plate.and_then(|(rect, transmittance, codes)| {
        let inside = (rect.y0..rect.y1).contains(&y);
        let start = (channel * rect.height() + usize::try_from(y - rect.y0).ok()?) * rect.width();
        inside.then(|| {
            let at = usize::try_from(rect.x0 - extent.x0).expect("the extent holds the plate");
            (at, &transmittance[start..][..rect.width()], &codes[start..][..rect.width()])
        })
    });
    row.fill(C::CLEAR);
    if let Some((at, _, codes)) = under {
        row[at..at + codes.len()].copy_from_slice(codes);
    }
    // The texels that some moving part touches.
    let mut first = usize::MAX;
    let mut end = 0;
    let spans = samplers.iter().filter_map(|s| s.span(y, extent).map(|span| (s, span)));
    for (_, span) in spans.clone() {
        first = first.min(span.start);
        end = end.max(span.end);
    }
    if first >= end {
        return;
    }
    light[first..end].fill(1.0);
    if let Some((at, transmittance, _)) = under {
        let (from, to) = (first.max(at), end.min(at + transmittance.len()));
        if from < to {
            light[from..to].copy_from_slice(&transmittance[from - at..to - at]);
        }
    }
    for (sampler, span) in spans {
        sampler.multiply(y, extent, channel, span.clone(), &mut light[span]);
    }
    for (code, light) in row[first..end].iter_mut().zip(&light[first..end]) {
        *code = C::nearest(*light);
    }
}

/// Bilinear look-up of a moved part, in 32.32 fixed point: two additions a texel, and within 2e-6 texels after 16384 of them.
struct Sampler<'a> {
    texture: &'a Texture,
    /// From lattice to part.
    inverse: Rigid,
    bounds: Rect,
}

const ONE: f64 = 4_294_967_296.0;

impl<'a> Sampler<'a> {
    fn new(placed: &Placed<'a>) -> Self {
        let bounds = placed.motion.bounds(placed.texture.rect);
        Self { texture: placed.texture, inverse: placed.motion.inverse(), bounds }
    }

    /// Where the centre of texel (x, y) falls among the centres of the padded texture's texels, fixed point.
    fn source(&self, x: i64, y: i64) -> [i64; 2] {
        let [u, v] = self.inverse.apply([x as f64 + 0.5, y as f64 + 0.5]);
        let rect = self.texture.rect;
        [((u - rect.x0 as f64 + 0.5) * ONE).round() as i64, ((v - rect.y0 as f64 + 0.5) * ONE).round() as i64]
    }

    /// Steps of [`Sampler::source`] along a row.
    fn step(&self) -> [i64; 2] {
        [(self.inverse.cos * ONE).round() as i64, (-self.inverse.sin * ONE).round() as i64]
    }

    /// The columns of `extent` whose texels fall on the padded texture in row `y`.
    fn span(&self, y: i64, extent: Rect) -> Option<std::ops::Range<usize>> {
        if self.texture.rect.is_empty() || !(self.bounds.y0..self.bounds.y1).contains(&y) {
            return None;
        }
        let origin = self.source(self.bounds.x0, y);
        let step = self.step();
        let (mut first, mut end) = (0, self.bounds.x1 - self.bounds.x0);
        for axis in 0..2 {
            // 0 ≤ origin + i · step < limit, solved for i in whole numbers.
            let size = if axis == 0 { self.texture.rect.width() } else { self.texture.rect.height() };
            let limit = (size as i64 + 1) << 32;
            let (o, s) = (origin[axis], step[axis]);
            match s.signum() {
                0 if (0..limit).contains(&o) => {}
                0 => return None,
                1 => {
                    first = first.max(div_ceil(-o, s));
                    end = end.min(div_ceil(limit - o, s));
                }
                _ => {
                    first = first.max(div_ceil(o - limit + 1, -s));
                    end = end.min(o.div_euclid(-s) + 1);
                }
            }
        }
        let at =
            |i: i64| usize::try_from(self.bounds.x0 - extent.x0 + i).expect("the extent holds every part");
        (first < end).then(|| at(first)..at(end))
    }

    /// Multiplies the transmittances of columns `span` of `extent` with this part's.
    fn multiply(
        &self,
        y: i64,
        extent: Rect,
        channel: usize,
        span: std::ops::Range<usize>,
        light: &mut [f32],
    ) {
        let plane = self.texture.plane(channel);
        let stride = self.texture.stride();
        // The same fixed-point line as in `span`, or the ends could differ by an ulp.
        let offset = extent.x0 + span.start as i64 - self.bounds.x0;
        let origin = self.source(self.bounds.x0, y);
        let step = self.step();
        let (mut u, mut v) = (origin[0] + offset * step[0], origin[1] + offset * step[1]);
        let fraction = |fixed: i64| ((fixed as u32) >> 8) as f32 * (1.0 / 16_777_216.0);
        for light in light {
            let at = (v >> 32) as usize * stride + (u >> 32) as usize;
            let (fu, fv) = (fraction(u), fraction(v));
            let quad = &plane[at..at + stride + 2];
            let top = quad[0] + fu * (quad[1] - quad[0]);
            let bottom = quad[stride] + fu * (quad[stride + 1] - quad[stride]);
            *light *= 1.0 - (top + fv * (bottom - top));
            u += step[0];
            v += step[1];
        }
    }
}

/// a / b rounded up, b > 0.
fn div_ceil(a: i64, b: i64) -> i64 {
    -(-a).div_euclid(b)
}
