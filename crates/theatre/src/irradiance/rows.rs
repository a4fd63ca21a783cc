//! E⁰ along whole rows of pixels, and over all of them.

use glam::{DVec2, DVec3};
use kelir_frame::multiversion;
use kelir_scene::{EmitterShape, Screen};
use rayon::prelude::*;

use super::{order, rule, unit};

/// [`unit`](fn@unit) at pixel centres; relative error ≤ 2e-8, a third of an f32's rounding.
///
/// Along a row it is taken at every `stride`th column and interpolated by cubics, whose error is at most 9/16 s⁴ max|f⁗| / 4! for points s
/// apart; Cauchy's estimate on a circle of half the distance R makes that 144 (s / R)⁴ of the value.
#[derive(Clone, Debug)]
pub(crate) struct UnitPixels {
    shape: EmitterShape,
    lamp_m: DVec3,
    screen: [f64; 2],
    size: [usize; 2],
    stride: usize,
    /// Nodes on the emitter, metres, and their weights, where one rule serves every pixel.
    nodes: Option<Vec<(DVec2, f64)>>,
}

impl UnitPixels {
    /// For one emitter of a lamp at `lamp_m`; the rule is chosen for the nearest point of the screen.
    pub(crate) fn new(shape: &EmitterShape, lamp_m: DVec3, screen: &Screen, size: [usize; 2]) -> Self {
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
        Self { shape: *shape, lamp_m, screen, size, stride, nodes }
    }

    /// Columns from one value that is computed to the next.
    #[cfg(test)]
    pub(super) fn stride(&self) -> usize {
        self.stride
    }

    fn x(&self, i: f64) -> f64 {
        ((i + 0.5) / self.size[0] as f64 - 0.5) * self.screen[0]
    }

    fn y(&self, j: usize) -> f64 {
        (0.5 - (j as f64 + 0.5) / self.size[1] as f64) * self.screen[1]
    }

    /// The x of the `k`th column that is interpolated between: one lies before the first.
    fn knot(&self, k: usize) -> f64 {
        self.x((k as f64 - 1.0) * self.stride as f64)
    }

    /// The value of pixel (i, j), to the bit that of [`UnitRows`].
    pub(crate) fn at(&self, i: usize, j: usize) -> f64 {
        let (x, y) = (self.x(i as f64), self.y(j));
        let Some(nodes) = &self.nodes else { return unit(&self.shape, self.lamp_m, DVec2::new(x, y)) };
        let add = |columns: &[f64], out: &mut [f64]| {
            for (offset, weight) in nodes {
                let node = self.lamp_m.truncate() + *offset;
                add_node_generic(columns, node.x, (node.y - y).powi(2), self.lamp_m.z, *weight, out);
            }
        };
        if self.stride == 1 {
            let mut out = [0.0];
            add(&[x], &mut out);
            return out[0];
        }
        let mut c = [0.0; 4];
        add(&[0, 1, 2, 3].map(|k| self.knot(i / self.stride + k)), &mut c);
        let w = lagrange((i % self.stride) as f64 / self.stride as f64);
        w[0] * c[0] + w[1] * c[1] + w[2] * c[2] + w[3] * c[3]
    }
}

/// The same for whole rows.
#[derive(Clone, Debug)]
pub struct UnitRows {
    pub(super) of: UnitPixels,
    /// The x of every column's pixel centre, or of every `stride`th, from one before the first to two behind the last.
    columns: Vec<f64>,
}

impl UnitRows {
    /// For one emitter of a lamp at `lamp_m`.
    pub fn new(shape: &EmitterShape, lamp_m: DVec3, screen: &Screen, size: [usize; 2]) -> Self {
        let of = UnitPixels::new(shape, lamp_m, screen, size);
        let columns = match of.stride {
            1 => (0..size[0]).map(|i| of.x(i as f64)).collect(),
            stride => (0..size[0].div_ceil(stride) + 3).map(|k| of.knot(k)).collect(),
        };
        Self { of, columns }
    }

    /// The values of row `j` into `out`, one a column.
    pub fn row(&self, j: usize, out: &mut [f64]) {
        let of = &self.of;
        let y = of.y(j);
        match &of.nodes {
            Some(nodes) => {
                let add = |out: &mut [f64]| {
                    out.fill(0.0);
                    for (offset, weight) in nodes {
                        let node = of.lamp_m.truncate() + *offset;
                        add_node(&self.columns, node.x, (node.y - y).powi(2), of.lamp_m.z, *weight, out);
                    }
                };
                if of.stride == 1 {
                    return add(out);
                }
                let mut coarse = vec![0.0; self.columns.len()];
                add(&mut coarse);
                let weights: Vec<[f64; 4]> =
                    (0..of.stride).map(|k| lagrange(k as f64 / of.stride as f64)).collect();
                for (out, c) in out.chunks_mut(of.stride).zip(coarse.windows(4)) {
                    for (o, w) in out.iter_mut().zip(&weights) {
                        *o = w[0] * c[0] + w[1] * c[1] + w[2] * c[2] + w[3] * c[3];
                    }
                }
            }
            None => out
                .iter_mut()
                .zip(&self.columns)
                .for_each(|(o, x)| *o = unit(&of.shape, of.lamp_m, DVec2::new(*x, y))),
        }
    }
}

/// Weights of the points −1, 0, 1, 2 at `t` in [0, 1].
fn lagrange(t: f64) -> [f64; 4] {
    let (a, b, c, d) = (t + 1.0, t, t - 1.0, t - 2.0);
    [-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0]
}

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
