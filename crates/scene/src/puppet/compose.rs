//! From parts and a pose to a mask: resample the moved parts, multiply, quantise once.

use rayon::prelude::*;

use super::grid::{Rect, Rigid, Texture};
use crate::theatre::Texels;

/// Rows that one task draws.
const BAND: usize = 16;

/// A part where a pose puts it.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub texture: &'a Texture,
    pub motion: Rigid,
}

/// The product of the parts that never move.
pub(crate) struct Plate<'a, C, const L: usize> {
    pub rect: Rect,
    /// Transmittances, texel by texel.
    pub light: &'a [[f32; L]],
    /// The same, quantised: one plane a channel.
    pub codes: &'a [C],
}

/// A texel's code: u8 or u16.
pub(crate) trait Code: Copy + Send + Sync + Sized {
    /// The code that lets everything through.
    const CLEAR: Self;
    /// The transmittance of a code.
    fn transmittance(self) -> f32;
    /// Nearest code of a transmittance in [0, 1].
    fn nearest(transmittance: f32) -> Self;
    /// Texels of this code; none of another.
    fn slice(texels: &Texels) -> &[Self];
}

// Adding 2²³ leaves the nearest whole number in the low bits: it rounds as the hardware does, and vectorises.
const ROUND: f32 = 8_388_608.0;

impl Code for u8 {
    const CLEAR: u8 = u8::MAX;
    fn transmittance(self) -> f32 {
        f32::from(self) / 255.0
    }
    fn nearest(transmittance: f32) -> u8 {
        (transmittance * 255.0 + ROUND).to_bits() as u8
    }
    fn slice(texels: &Texels) -> &[u8] {
        if let Texels::U8(codes) = texels { codes } else { &[] }
    }
}

impl Code for u16 {
    const CLEAR: u16 = u16::MAX;
    fn transmittance(self) -> f32 {
        f32::from(self) / 65535.0
    }
    fn nearest(transmittance: f32) -> u16 {
        (transmittance * 65535.0 + ROUND).to_bits() as u16
    }
    fn slice(texels: &Texels) -> &[u16] {
        if let Texels::U16(codes) = texels { codes } else { &[] }
    }
}

/// Channels of a mask whose texels have L lanes: 1 for grey, 3 for colour, whose fourth lane is not used.
const fn channels(lanes: usize) -> usize {
    if lanes == 1 { 1 } else { 3 }
}

/// Draws the product of `plate` and `parts` on the texels of `extent`, one plane a channel, into `codes`
/// (resized; its old content does not matter).
pub(crate) fn compose<C: Code, const L: usize>(
    extent: Rect,
    plate: Option<Plate<C, L>>,
    parts: &[Placed],
    codes: &mut Vec<C>,
) {
    let width = extent.width();
    codes.resize(extent.area() * channels(L), C::CLEAR);
    let samplers: Vec<Sampler<L>> = parts.iter().map(Sampler::new).collect();
    // A band holds the same rows of every channel's plane.
    let mut bands: Vec<Vec<&mut [C]>> = Vec::new();
    bands.resize_with(extent.height().div_ceil(BAND), Vec::new);
    for plane in codes.chunks_exact_mut(extent.area().max(1)) {
        for (band, rows) in bands.iter_mut().zip(plane.chunks_mut(width * BAND)) {
            band.push(rows);
        }
    }
    bands.into_par_iter().enumerate().for_each_init(
        || vec![[1.0; L]; width],
        |light, (band, mut planes)| {
            for j in 0..planes[0].len() / width {
                let y = extent.y0 + (band * BAND + j) as i64;
                let row = planes.iter_mut().map(|rows| &mut rows[j * width..][..width]);
                compose_row(extent, y, plate.as_ref(), &samplers, light, row);
            }
        },
    );
}

/// Multiplies a part into the transmittances of `extent`.
pub(crate) fn multiply<const L: usize>(extent: Rect, part: &Placed, light: &mut [[f32; L]]) {
    let sampler = Sampler::new(part);
    light.par_chunks_exact_mut(extent.width().max(1)).enumerate().for_each(|(j, row)| {
        let y = extent.y0 + j as i64;
        if let Some(span) = sampler.span(y, extent) {
            sampler.multiply(y, extent, span.clone(), &mut row[span]);
        }
    });
}

/// One row of every channel; `light` is scratch of the row's length.
fn compose_row<'r, C: Code + 'r, const L: usize>(
    extent: Rect,
    y: i64,
    plate: Option<&Plate<C, L>>,
    samplers: &[Sampler<L>],
    light: &mut [[f32; L]],
    channels: impl Iterator<Item = &'r mut [C]>,
) {
    // The plate's row: where it begins in this one, and its texels' range in the plate.
    let under = plate.filter(|p| (p.rect.y0..p.rect.y1).contains(&y)).map(|plate| {
        let at = usize::try_from(plate.rect.x0 - extent.x0).expect("the extent holds the plate");
        let start = (y - plate.rect.y0) as usize * plate.rect.width();
        (plate, at, start..start + plate.rect.width())
    });
    // The columns that some moving part touches.
    let spans = samplers.iter().filter_map(|s| s.span(y, extent).map(|span| (s, span)));
    let touched = spans.clone().map(|(_, span)| span).reduce(|a, b| a.start.min(b.start)..a.end.max(b.end));
    if let Some(touched) = touched.clone() {
        light[touched.clone()].fill([1.0; L]);
        if let Some((plate, at, texels)) = &under {
            let (from, to) = (touched.start.max(*at), touched.end.min(at + texels.len()));
            if from < to {
                let texels = &plate.light[texels.clone()];
                light[from..to].copy_from_slice(&texels[from - at..to - at]);
            }
        }
        for (sampler, span) in spans {
            sampler.multiply(y, extent, span.clone(), &mut light[span]);
        }
    }
    for (c, row) in channels.enumerate() {
        // What no moving part touches is a copy of the plate's codes, or clear.
        row.fill(C::CLEAR);
        if let Some((plate, at, texels)) = &under {
            let plane = &plate.codes[c * plate.rect.area()..];
            row[*at..at + texels.len()].copy_from_slice(&plane[texels.clone()]);
        }
        if let Some(touched) = touched.clone() {
            for (code, light) in row[touched.clone()].iter_mut().zip(&light[touched]) {
                *code = C::nearest(light[c]);
            }
        }
    }
}

/// Bilinear look-up of a moved part, in 32.32 fixed point: two additions a texel, and within 2e-6 texels after 16384 of them.
struct Sampler<'a, const L: usize> {
    texture: &'a Texture,
    texels: &'a [[f32; L]],
    /// From lattice to part.
    inverse: Rigid,
    bounds: Rect,
}

const ONE: f64 = 4_294_967_296.0;

impl<'a, const L: usize> Sampler<'a, L> {
    fn new(placed: &Placed<'a>) -> Self {
        let bounds = placed.motion.bounds(placed.texture.rect);
        Self {
            texture: placed.texture,
            texels: placed.texture.texels(),
            inverse: placed.motion.inverse(),
            bounds,
        }
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
    fn multiply(&self, y: i64, extent: Rect, span: std::ops::Range<usize>, light: &mut [[f32; L]]) {
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
            let quad = &self.texels[at..at + stride + 2];
            let (a, b, c, d) = (quad[0], quad[1], quad[stride], quad[stride + 1]);
            for (lane, light) in light.iter_mut().enumerate() {
                let top = a[lane] + fu * (b[lane] - a[lane]);
                let bottom = c[lane] + fu * (d[lane] - c[lane]);
                *light *= 1.0 - (top + fv * (bottom - top));
            }
            u += step[0];
            v += step[1];
        }
    }
}

/// a / b rounded up, b > 0.
fn div_ceil(a: i64, b: i64) -> i64 {
    -(-a).div_euclid(b)
}
