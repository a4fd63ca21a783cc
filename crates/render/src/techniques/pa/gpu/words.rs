//! What the shaders read of a plan: one texture of word vectors, addressed as if it were a list.
//!
//! A texture and not a storage buffer, because software adapters gather texels with vector instructions and buffers one lane
//! after the other.

use kelir_scene::Theatre;
use rayon::prelude::*;

use super::super::plan::{Lookup, Plan};
use super::super::window::Windows;

/// Word vectors a row of the texture, as in the shaders.
pub const ROW: usize = 2048;

/// A list of word vectors under construction.
#[derive(Default)]
pub struct Words(pub Vec<[u32; 4]>);

impl Words {
    /// Appends vectors; returns where they begin.
    pub fn extend(&mut self, vectors: impl IntoIterator<Item = [u32; 4]>) -> u32 {
        let at = self.0.len() as u32;
        self.0.extend(vectors);
        at
    }

    /// Whole rows of the texture, zeros at the end.
    pub fn padded(&mut self) -> &[[u32; 4]] {
        self.0.resize(self.0.len().max(1).next_multiple_of(ROW), [0; 4]);
        &self.0
    }
}

/// Vectors of one window with `reach` weights an end: start, second, first weights of both, then the other weights in pairs, so that
/// vector k holds weights 2k − 1 and 2k.
pub fn vectors(reach: usize) -> usize {
    1 + reach / 2
}

fn pack(starts: [i32; 2], reach: usize, weight: impl Fn(usize, usize) -> u32, out: &mut [[u32; 4]]) {
    out.fill([0; 4]);
    out[0][0] = starts[0].cast_unsigned();
    out[0][1] = starts[1].cast_unsigned();
    for k in 0..reach {
        let at = if k % 2 == 1 { 0 } else { 2 };
        out[k.div_ceil(2)][at] = weight(0, k);
        out[k.div_ceil(2)][at + 1] = weight(1, k);
    }
}

/// Column windows: texel `start + k` weighs `weight[0][k]`, texels from `start + reach` to `second` weigh 1 / width, texel `second + k`
/// weighs `weight[1][k]`, all f32. `reach` is at least the windows' own.
pub fn columns(x: &Windows, reach: usize) -> Vec<[u32; 4]> {
    let mut out = vec![[0; 4]; x.start.len() * vectors(reach)];
    out.par_chunks_exact_mut(vectors(reach)).with_min_len(256).enumerate().for_each(|(i, out)| {
        let (start, second, end) = ends(x, i, reach);
        let weight = |side: usize, k: usize| {
            let t = i64::from([start, second][side]) + k as i64;
            if side == 1 && t >= end { 0 } else { ((x.overlap(i, t) / x.width) as f32).to_bits() }
        };
        pack([start, second], reach, weight, out);
    });
    out
}

/// Row windows: as columns, but with the native code's fixed-point weights, whose rounding is carried from row to row.
pub fn rows(lookup: &Lookup, height: usize, reach: usize) -> Vec<[u32; 4]> {
    let y = &lookup.y;
    let scale = 2f64.powi(lookup.shift as i32) / lookup.unit;
    let mut out = vec![[0; 4]; y.start.len() * vectors(reach)];
    out.par_chunks_exact_mut(vectors(reach)).with_min_len(256).enumerate().for_each(|(j, out)| {
        let (start, second, end) = ends(y, j, reach);
        let (mut exact, mut rounded) = (0f64, 0f64);
        let mut weights = vec![0u32; 2 * reach];
        for (n, weight) in weights.iter_mut().enumerate() {
            let t = i64::from([start, second][n / reach]) + (n % reach) as i64;
            if t < 0 || t >= height as i64 || (n >= reach && t >= end) {
                continue;
            }
            exact += y.overlap(j, t) * scale;
            let whole = (exact - rounded).round().clamp(0.0, f64::from(u32::MAX));
            rounded += whole;
            *weight = whole as u32;
        }
        pack([start, second], reach, |side, k| weights[side * reach + k], out);
    });
    out
}

/// First texel, first texel of the second end, and the texel behind the last.
fn ends(windows: &Windows, i: usize, reach: usize) -> (i32, i32, i64) {
    let start = windows.start[i];
    let end = i64::from(windows.stop[i]) + windows.reach as i64;
    (start, windows.stop[i].max(start + reach as i32), end)
}

/// Three vectors a piece: the look-ups `range` of the batch and its weight; tangents of the first column and row towards its centre
/// and their steps; its half-sides' tangents.
pub fn piece(
    theatre: &Theatre,
    size: [usize; 2],
    plan: &Plan,
    p: usize,
    range: std::ops::Range<usize>,
) -> [[u32; 4]; 3] {
    let piece = &plan.pieces[p];
    let z = piece.centre_m.z.abs();
    let at = crate::project::pixel_m(&theatre.screen, size, 0.0, 0.0) - piece.centre_m.truncate();
    let step = [theatre.screen.width_m / size[0] as f64, -theatre.screen.height_m / size[1] as f64];
    let bits = |v: f64| ((v / z) as f32).to_bits();
    [
        [range.start as u32, range.end as u32, (piece.weight as f32).to_bits(), 0],
        [bits(at.x), bits(at.y), bits(step[0]), bits(step[1])],
        [bits(0.5 * piece.size_m[0]), bits(0.5 * piece.size_m[1]), 0, 0],
    ]
}
