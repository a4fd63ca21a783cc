//! What the shaders read of a plan: one texture of word vectors, addressed as if it were a list.
//!
//! A texture and not a storage buffer, because software adapters gather texels with vector instructions and buffers one lane
//! after the other.

use glam::{DVec2, DVec3};
use kelir_scene::Theatre;
use rayon::prelude::*;

use super::super::dome::DomeLight;
use super::super::plan::{Lookup, Plan};
use super::super::tiles::TILE;
use crate::project::tilted::PlaneFrame;
use crate::project::window::Windows;

/// Word vectors a row of the texture, as in the shaders.
pub(super) const ROW: usize = 2048;

/// A list of word vectors under construction.
#[derive(Default)]
pub(super) struct Words(pub Vec<[u32; 4]>);

impl Words {
    /// Appends vectors; returns where they begin.
    pub(super) fn extend(&mut self, vectors: impl IntoIterator<Item = [u32; 4]>) -> u32 {
        let at = self.0.len() as u32;
        self.0.extend(vectors);
        at
    }

    /// Whole rows of the texture, zeros at the end.
    pub(super) fn padded(&mut self) -> &[[u32; 4]] {
        self.0.resize(self.0.len().max(1).next_multiple_of(ROW), [0; 4]);
        &self.0
    }
}

/// Vectors of one window with `reach` weights an end: two for every three weights, (start + k, weights k to k + 2) of each end.
pub(super) fn vectors(reach: usize) -> usize {
    reach.div_ceil(3) * 2
}

fn pack(starts: [i32; 2], reach: usize, weight: impl Fn(usize, usize) -> u32, out: &mut [[u32; 4]]) {
    for (k, both) in out.chunks_exact_mut(2).enumerate().map(|(n, both)| (3 * n, both)) {
        for (side, vector) in both.iter_mut().enumerate() {
            vector[0] = (starts[side] + k as i32).cast_unsigned();
            for i in 0..3 {
                vector[1 + i] = if k + i < reach { weight(side, k + i) } else { 0 };
            }
        }
    }
}

/// Column windows: texel `start + k` weighs `weight[0][k]`, texels from `start + reach` to `second` weigh 1 / width, texel `second + k`
/// weighs `weight[1][k]`, all times `scale` and f32. `reach` is at least the windows' own.
pub(super) fn columns(x: &Windows, reach: usize, scale: f64) -> Vec<[u32; 4]> {
    let each = vectors(reach);
    let mut out = vec![[0; 4]; x.start.len() * each];
    out.par_chunks_exact_mut(each).with_min_len(256).enumerate().for_each(|(i, out)| {
        let (start, second, end) = ends(x, i, reach);
        let weight = |side: usize, k: usize| {
            let t = i64::from([start, second][side]) + k as i64;
            if side == 1 && t >= end { 0 } else { ((x.overlap(i, t) / x.width * scale) as f32).to_bits() }
        };
        pack([start, second], reach, weight, out);
    });
    out
}

/// Row windows: as columns, but with the native code's fixed-point weights, whose rounding is carried from row to row.
pub(super) fn rows(lookup: &Lookup, height: usize, reach: usize) -> Vec<[u32; 4]> {
    let (y, each) = (&lookup.y, vectors(reach));
    let scale = 2f64.powi(lookup.shift as i32) / lookup.unit;
    let mut out = vec![[0; 4]; y.start.len() * each];
    out.par_chunks_exact_mut(each).with_min_len(256).enumerate().for_each_init(
        || vec![0u32; 2 * reach],
        |weights, (j, out)| {
            let (start, second, end) = ends(y, j, reach);
            let (mut exact, mut rounded) = (0f64, 0f64);
            for (n, weight) in weights.iter_mut().enumerate() {
                *weight = 0;
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
        },
    );
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
pub(super) fn piece(
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

/// Six vectors a tile for a tilted plane: see tilted.wgsl. `home` is the tile's first pixel.
pub(super) fn slope(
    theatre: &Theatre,
    size: [usize; 2],
    plan: &Plan,
    lookup: &Lookup,
    frame: &PlaneFrame,
    home: [usize; 2],
) -> [[u32; 4]; 6] {
    let (piece, sub) = (&plan.pieces[lookup.piece], plan.sub);
    let size = size.map(|side| side * sub);
    // The first sub-pixel of the tile's middle pixel.
    let middle = [(home[0] + TILE[0] / 2) * sub, (home[1] + TILE[1] / 2) * sub];
    let p = crate::project::pixel_m(&theatre.screen, size, middle[0] as f64, middle[1] as f64).extend(0.0);
    let steps = [
        DVec3::new(theatre.screen.width_m / size[0] as f64, 0.0, 0.0),
        DVec3::new(0.0, -theatre.screen.height_m / size[1] as f64, 0.0),
    ];
    let (n, c, q) = (frame.normal, frame.centre_m, piece.centre_m);
    let (a, b) = (n.dot(c - p), n.dot(q - p));
    // Both change alike.
    let change = steps.map(|d| -n.dot(d));
    let axis = |unit: DVec3, half: DVec3| {
        // The texel is N / B with N affine, so it moves by (g d) / (1 + d B' / B).
        let at = (unit.dot(p) * (b - a) + unit.dot(q) * a - unit.dot(c) * b) / b;
        let rise =
            |k: usize| unit.dot(steps[k]) * (b - a) + unit.dot(q) * change[k] - unit.dot(c) * change[k];
        let g = [0, 1].map(|k| (rise(k) - at * change[k]) / b);
        let m = unit.dot(half) * b - unit.dot(q - p) * n.dot(half);
        let m_change = [0, 1].map(|k| unit.dot(half) * change[k] + unit.dot(steps[k]) * n.dot(half));
        (at, g, m, m_change)
    };
    let (u, gu, mu, mu_change) = axis(frame.u, DVec3::new(0.5 * piece.size_m[0], 0.0, 0.0));
    let (v, gv, mv, mv_change) = axis(frame.v, DVec3::new(0.0, 0.5 * piece.size_m[1], 0.0));
    // Beyond the plane's horizon the middle may lie anywhere; nothing is opaque out there.
    let far = 2f64.powi(28);
    let texel = (DVec2::new(u, v) + frame.middle).clamp(DVec2::splat(-far), DVec2::splat(far));
    let whole = texel.floor();
    // Few enough bits that times 64 sub-pixels it is exact in f32.
    let largest = gu.iter().chain(&gv).fold(1e-30, |m: f64, g| m.max(g.abs()));
    let quantum = 2f64.powi((largest * 80.0).log2().ceil() as i32 - 22);
    let coarse = |g: f64| (g / quantum).round() * quantum;
    let bits = |v: f64| (v as f32).to_bits();
    let int = |v: f64| (v as i32).cast_unsigned();
    [
        [int(whole.x), int(whole.y), bits(texel.x - whole.x), bits(texel.y - whole.y)],
        [gu[0], gu[1], gv[0], gv[1]].map(|g| bits(coarse(g))),
        [gu[0], gu[1], gv[0], gv[1]].map(|g| bits(g - coarse(g))),
        [a, change[0], change[1], b].map(bits),
        [change[0], change[1], mu, mu_change[0]].map(bits),
        [mu_change[1], mv, mv_change[0], mv_change[1]].map(bits),
    ]
}

/// What a piece's half-sides change of a tilted plane's n · q.
pub(super) fn along(plan: &Plan, lookup: &Lookup, frame: &PlaneFrame) -> [f32; 2] {
    let [w, h] = plan.pieces[lookup.piece].size_m;
    [(0.5 * w * frame.normal.x) as f32, (0.5 * h * frame.normal.y) as f32]
}

/// Four vectors a plane that hides the dome: where its windows of columns and rows are, its channels; then a map each, where it begins
/// (`places`) and how wide it is. The windows go to `words`, two vectors each: weights, then the first lattice point.
pub(super) fn dome(
    theatre: &Theatre,
    size: [usize; 2],
    light: &DomeLight,
    places: &[Vec<u32>],
    words: &mut Words,
) -> Vec<[u32; 4]> {
    let mut out = Vec::new();
    for ((centre, maps), places) in light.planes.iter().zip(places) {
        let Some(map) = maps.first() else { continue };
        let (values, width) = map.lattice();
        let counts = [width, values.len() / width];
        let windows = |axis: usize| -> Vec<[u32; 4]> {
            let one = |k: usize| {
                let (i, j) = if axis == 0 { (k as f64, 0.0) } else { (0.0, k as f64) };
                let at = crate::project::pixel_m(&theatre.screen, size, i, j) - *centre;
                let (first, weights) = map.taps(at);
                // The map reaches beyond the screen, so no window hangs over its edge.
                let first = first[axis].clamp(0.0, counts[axis] as f64 - 4.0) as u32;
                [weights[axis].map(|w| (w as f32).to_bits()), [first, 0, 0, 0]]
            };
            (0..size[axis]).into_par_iter().with_min_len(256).flat_map_iter(one).collect()
        };
        let (columns, rows) = (words.extend(windows(0)), words.extend(windows(1)));
        out.push([columns, rows, maps.len() as u32, 0]);
        out.extend((0..3).map(|c| {
            let c = c.min(maps.len() - 1);
            [places[c], maps[c].lattice().1 as u32, 0, 0]
        }));
    }
    out
}
