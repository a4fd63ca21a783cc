//! E⁰ along whole rows of pixels, and over all of them.

use glam::{DVec2, DVec3};
use kelir_frame::multiversion;
use kelir_scene::{EmitterShape, Screen};
use rayon::prelude::*;

use super::{order, rule, unit};
use crate::project::pixel_m;

/// [`unit`](fn@unit) for whole rows of pixel centres; relative error ≤ 2e-8, a third of an f32's rounding.
///
/// Along a row it is taken at every `stride`th column and interpolated by cubics, whose error is at most 9/16 s⁴ max|f⁗| / 4! for points s
/// apart; Cauchy's estimate on a circle of half the distance R makes that 144 (s / R)⁴ of the value.
#[derive(Clone, Debug)]
pub struct UnitRows {
    shape: EmitterShape,
    lamp_m: DVec3,
    screen: [f64; 2],
    size: [usize; 2],
    /// The x of every column's pixel centre, or of every `stride`th, from one before the first to two behind the last.
    columns: Vec<f64>,
    pub(super) stride: usize,
    /// Weights of the four points around a column, one row a point, for the columns from one point to the next.
    taps: [Vec<f64>; 4],
    /// Nodes on the emitter, metres, and their weights, where one rule serves every pixel.
    nodes: Option<Vec<(DVec2, f64)>>,
}

impl UnitRows {
    /// For one emitter of a lamp at `lamp_m`; the rule is chosen for the nearest point of the screen.
    pub fn new(shape: &EmitterShape, lamp_m: DVec3, screen: &Screen, size: [usize; 2]) -> Self {
        let x = |i: f64| pixel_m(screen, size, i, 0.0).x;
        let mut columns: Vec<f64> = (0..size[0]).map(|i| x(i as f64)).collect();
        let mut stride = 1;
        let screen = [screen.width_m, screen.height_m];
        let nodes = match *shape {
            EmitterShape::Rectangle { size_m: [w, l] } => {
                let (a, b) = (0.5 * w, 0.5 * l);
                let beside = (lamp_m.truncate().abs() - 0.5 * DVec2::from(screen)).max(DVec2::ZERO);
                let nearest = beside.length().hypot(lamp_m.z);
                let close = |s: &usize| {
                    144.0 * (*s as f64 * screen[0] / size[0] as f64 / (nearest - a.hypot(b)).max(0.0)).powi(4)
                        <= 1e-8
                };
                let n = order(nearest / a.max(b), 1e-8).filter(|n| *n <= 6);
                if n.is_some() {
                    stride = [16, 8, 4, 2].into_iter().find(close).unwrap_or(1);
                }
                if stride > 1 {
                    let points = size[0].div_ceil(stride) + 3;
                    columns = (0..points).map(|k| x((k as f64 - 1.0) * stride as f64)).collect();
                }
                n.map(|n| {
                    let line = rule(n);
                    line.iter()
                        .flat_map(|(u, wu)| line.iter().map(move |(v, wv)| (u, v, wu * wv)))
                        .map(|(u, v, weight)| (DVec2::new(a * u, b * v), weight * a * b))
                        .collect()
                })
            }
            EmitterShape::Disk { .. } => None,
        };
        let weights: Vec<_> = (0..stride).map(|k| lagrange(k as f64 / stride as f64)).collect();
        let taps = [0, 1, 2, 3].map(|p| weights.iter().map(|w| w[p]).collect());
        Self { shape: *shape, lamp_m, screen, size, columns, stride, taps, nodes }
    }

    /// The values of row `j` into `out`, one a column.
    pub fn row(&self, j: usize, out: &mut [f64]) {
        self.span(j, 0, out);
    }

    /// Those of the columns from `first` on.
    pub fn span(&self, j: usize, first: usize, out: &mut [f64]) {
        let y = (0.5 - (j as f64 + 0.5) / self.size[1] as f64) * self.screen[1];
        let Some(nodes) = &self.nodes else {
            let columns = out.iter_mut().zip(&self.columns[first..]);
            return columns.for_each(|(o, x)| *o = unit(&self.shape, self.lamp_m, DVec2::new(*x, y)));
        };
        let add = |columns: &[f64], out: &mut [f64]| {
            out.fill(0.0);
            for (offset, weight) in nodes {
                let node = self.lamp_m.truncate() + *offset;
                add_node(columns, node.x, (node.y - y).powi(2), self.lamp_m.z, *weight, out);
            }
        };
        if self.stride == 1 {
            return add(&self.columns[first..][..out.len()], out);
        }
        let points = first / self.stride..(first + out.len()).div_ceil(self.stride) + 3;
        let mut coarse = vec![0.0; points.len()];
        add(&self.columns[points], &mut coarse);
        let [before, from, to, after] = &self.taps;
        interpolate(&coarse, first % self.stride, [before, from, to, after], out);
    }
}

/// Weights of the points −1, 0, 1, 2 at `t` in [0, 1].
fn lagrange(t: f64) -> [f64; 4] {
    let (a, b, c, d) = (t + 1.0, t, t - 1.0, t - 2.0);
    [-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0]
}

#[inline(always)]
fn interpolate_generic(coarse: &[f64], first: usize, taps: [&[f64]; 4], mut out: &mut [f64]) {
    let mut from = first;
    for c in coarse.windows(4) {
        let n = (taps[0].len() - from).min(out.len());
        let (here, rest) = out.split_at_mut(n);
        let [w0, w1, w2, w3] = taps.map(|weights| &weights[from..from + n]);
        for k in 0..n {
            here[k] = w0[k] * c[0] + w1[k] * c[1] + w2[k] * c[2] + w3[k] * c[3];
        }
        (from, out) = (0, rest);
    }
}
multiversion! { fn interpolate(coarse: &[f64], first: usize, taps: [&[f64]; 4], out: &mut [f64]) = interpolate_generic; }

#[inline(always)]
fn add_node_generic(columns: &[f64], x: f64, dy2: f64, h: f64, weight: f64, out: &mut [f64]) {
    let beside = dy2 + h * h;
    for (o, column) in out.iter_mut().zip(columns) {
        let dx = x - column;
        let q = h / (dx * dx + beside);
        *o += weight * q * q;
    }
}
multiversion! { fn add_node(columns: &[f64], x: f64, dy2: f64, h: f64, weight: f64, out: &mut [f64]) = add_node_generic; }

/// [`unit`](fn@unit) at the centre of every pixel, row-major, first row on top; relative error ≤ 2e-8.
pub fn unit_image(shape: &EmitterShape, lamp_m: DVec3, screen: &Screen, size: [usize; 2]) -> Vec<f64> {
    let rows = UnitRows::new(shape, lamp_m, screen, size);
    let mut out = vec![0.0; size[0] * size[1]];
    out.par_chunks_mut(size[0]).enumerate().for_each(|(j, out)| rows.row(j, out));
    out
}

/// Means of E⁰ over the areas of pixels, from its values `image` at their centres: a smooth function's mean is its value plus
/// (Δ²x + Δ²y) / 24, second differences between neighbours; what is left out is of fourth order in the pixel's angular size.
pub(super) fn means_over_pixels(image: &[f64], [width, height]: [usize; 2]) -> Vec<f64> {
    // Beyond the last second difference of a line they go on in a straight line.
    let second = |at: &dyn Fn(usize) -> f64, k: usize, n: usize| {
        let here = |k: usize| at(k - 1) - 2.0 * at(k) + at(k + 1);
        match k {
            _ if n < 3 => 0.0,
            _ if n == 3 => here(1),
            0 => 2.0 * here(1) - here(2),
            _ if k + 1 == n => 2.0 * here(n - 2) - here(n - 3),
            _ => here(k),
        }
    };
    let mut out = vec![0.0; image.len()];
    out.par_chunks_mut(width).enumerate().for_each(|(j, out)| {
        for (i, out) in out.iter_mut().enumerate() {
            let across = second(&|i| image[j * width + i], i, width);
            let down = second(&|j| image[j * width + i], j, height);
            *out = image[j * width + i] + (across + down) / 24.0;
        }
    });
    out
}
