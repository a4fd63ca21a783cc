//! E⁰: the irradiance that an unshadowed emitter of unit radiance gives a point of the screen.
//!
//! A rectangle's is Lambert's formula, a sum of four arctangent terms. They are of order one, so a small or distant emitter, whose
//! value is of order area / distance², is what is left when almost everything cancels. Below
//! [`CLOSED_FORM_FROM`] steradians the integral is taken by tensor Gauss rules instead, on pieces small enough for
//! their error bound (`order`). A disk's closed form has an arrangement without cancellation.

use std::sync::{Arc, OnceLock};

use glam::{DVec2, DVec3};
use kelir_scene::{EmitterShape, Screen, Theatre};
use rayon::prelude::*;

use crate::project::pixel_m;
use crate::simd::multiversion;

/// Where Lambert's formula is used: there, rounding of terms of order one is below 1e-13 of the value.
pub const CLOSED_FORM_FROM: f64 = 4e-3;

const MOST_NODES: usize = 12;

/// ∫ cosθ_P cosθ_Q / |PQ|² dA over the emitter (steradians, cosine-weighted), at the screen point `p_m`, for a lamp
/// centred on `lamp_m`; E⁰ is this times the emitter's radiance. Relative error ≤ 1e-12.
pub fn unit(shape: &EmitterShape, lamp_m: DVec3, p_m: DVec2) -> f64 {
    let h = lamp_m.z.abs();
    let c = lamp_m.truncate() - p_m;
    match *shape {
        EmitterShape::Rectangle { size_m: [w, l] } => {
            let (a, b) = (0.5 * w, 0.5 * l);
            // No rectangle subtends more than its area over the squared distance of its nearest point.
            let near = (c.abs() - DVec2::new(a, b)).max(DVec2::ZERO);
            if w * l >= CLOSED_FORM_FROM * (near.length_squared() + h * h) {
                let closed = lambert(c, a, b, h);
                if closed >= CLOSED_FORM_FROM {
                    return closed;
                }
            }
            gauss(c, a, b, h)
        }
        EmitterShape::Disk { radius_m } => disk(c, radius_m, h),
    }
}

/// The differential element and the parallel rectangle, corner by corner: centre at lateral offset `c`, half-sides `a`, `b`, height `h`.
/// Absolute error of a few 1e-16, so that it serves sums that add up to about one.
pub(crate) fn lambert(c: DVec2, a: f64, b: f64, h: f64) -> f64 {
    let corner = |x: f64, y: f64| {
        let (rx, ry) = (x.hypot(h), y.hypot(h));
        0.5 * (x / rx * (y / rx).atan() + y / ry * (x / ry).atan())
    };
    corner(c.x + a, c.y + b) - corner(c.x - a, c.y + b) - corner(c.x + a, c.y - b) + corner(c.x - a, c.y - b)
}

/// π/2 · (1 − (s − r²)/D) with s = x² + h², D² = (s − r²)² + 4 r² h²; the difference is taken apart for s > r².
fn disk(c: DVec2, r: f64, h: f64) -> f64 {
    let (r2, h2) = (r * r, h * h);
    let t = c.length_squared() + h2 - r2;
    let d = t.hypot(2.0 * r * h);
    if t > 0.0 {
        2.0 * std::f64::consts::PI * r2 * h2 / (d * (d + t))
    } else {
        0.5 * std::f64::consts::PI * (d - t) / d
    }
}

/// Gauss–Legendre nodes and weights on [−1, 1] for 1..=[`MOST_NODES`] nodes, by Newton's method.
fn rule(n: usize) -> &'static [(f64, f64)] {
    static RULES: OnceLock<Vec<Vec<(f64, f64)>>> = OnceLock::new();
    let legendre = |n: usize, x: f64| {
        let (mut before, mut here) = (1.0, x);
        for k in 2..=n {
            (before, here) = (here, ((2 * k - 1) as f64 * x * here - (k - 1) as f64 * before) / k as f64);
        }
        (here, n as f64 * (x * here - before) / (x * x - 1.0))
    };
    let rules = RULES.get_or_init(|| {
        let node = |n: usize, i: usize| {
            let mut x = -((i as f64 + 0.75) / (n as f64 + 0.5) * std::f64::consts::PI).cos();
            for _ in 0..20 {
                let (value, slope) = legendre(n, x);
                x -= value / slope;
            }
            let slope = legendre(n, x).1;
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        };
        (1..=MOST_NODES)
            .map(|n| if n == 1 { vec![(0.0, 2.0)] } else { (0..n).map(|i| node(n, i)).collect() })
            .collect()
    });
    &rules[n - 1]
}

/// Nodes an axis for a relative error of at most `tolerance`, where the emitter's centre is `t` times its larger half-side
/// away; None if [`MOST_NODES`] are not enough.
///
/// As a function of one emitter coordinate u the integrand is h² / ((x − u)² + Y²)², analytic but for poles whose distance
/// from any real point of the emitter is q ≥ t − √2 half-sides. An n-point rule errs by f⁽²ⁿ⁾(ξ) 2²ⁿ⁺¹ (n!)⁴ / ((2n+1) (2n)!³); Cauchy's
/// estimate on a circle of radius θq bounds the derivative by (2n)! (θq)⁻²ⁿ max|f|, and there |f| is at most (1 − θ)⁻⁴ (1 + 2√2/q)⁴ times
/// its smallest value on the emitter. θ = n / (n + 2) is the best; the two axes add up.
fn order(t: f64, tolerance: f64) -> Option<usize> {
    let q = t - std::f64::consts::SQRT_2;
    if q < 2.0 {
        return None;
    }
    (1..=MOST_NODES).find(|&n| {
        let theta = n as f64 / (n + 2) as f64;
        // 2²ⁿ (n!)⁴ / ((2n+1) (2n)!²), as (∏ k / (n + k))² · 4ⁿ / (2n + 1).
        let ratio: f64 = (1..=n).map(|k| k as f64 / (n + k) as f64).product();
        let rule = ratio * ratio * 4f64.powi(n as i32) / (2 * n + 1) as f64;
        let spread = ((1.0 + 2.0 * std::f64::consts::SQRT_2 / q) / (1.0 - theta)).powi(4);
        2.0 * rule * spread * (theta * q).powi(-2 * n as i32) <= tolerance
    })
}

/// The integral over the rectangle of half-sides `a`, `b` whose centre is at lateral offset `c`, height `h`.
fn gauss(c: DVec2, a: f64, b: f64, h: f64) -> f64 {
    let distance = (c.length_squared() + h * h).sqrt();
    let Some(n) = order(distance / a.max(b), 1e-14) else {
        return if a > b {
            let half = DVec2::new(0.5 * a, 0.0);
            gauss(c - half, 0.5 * a, b, h) + gauss(c + half, 0.5 * a, b, h)
        } else {
            let half = DVec2::new(0.0, 0.5 * b);
            gauss(c - half, a, 0.5 * b, h) + gauss(c + half, a, 0.5 * b, h)
        };
    };
    let mut sum = 0.0;
    for (u, wu) in rule(n) {
        for (v, wv) in rule(n) {
            let r2 = (c.x + a * u).powi(2) + (c.y + b * v).powi(2) + h * h;
            // Divided twice: h² alone may underflow before r⁴ does.
            sum += wu * wv * (h / r2) * (h / r2);
        }
    }
    sum * a * b
}

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
    stride: usize,
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
        Self { shape: *shape, lamp_m, screen, size, columns, stride, nodes }
    }

    /// The values of row `j` into `out`, one a column.
    pub fn row(&self, j: usize, out: &mut [f64]) {
        let y = (0.5 - (j as f64 + 0.5) / self.size[1] as f64) * self.screen[1];
        match &self.nodes {
            Some(nodes) => {
                let add = |out: &mut [f64]| {
                    out.fill(0.0);
                    for (offset, weight) in nodes {
                        let node = self.lamp_m.truncate() + *offset;
                        add_node(&self.columns, node.x, (node.y - y).powi(2), self.lamp_m.z, *weight, out);
                    }
                };
                if self.stride == 1 {
                    return add(out);
                }
                let mut coarse = vec![0.0; self.columns.len()];
                add(&mut coarse);
                let weights: Vec<[f64; 4]> =
                    (0..self.stride).map(|k| lagrange(k as f64 / self.stride as f64)).collect();
                for (out, c) in out.chunks_mut(self.stride).zip(coarse.windows(4)) {
                    for (o, w) in out.iter_mut().zip(&weights) {
                        *o = w[0] * c[0] + w[1] * c[1] + w[2] * c[2] + w[3] * c[3];
                    }
                }
            }
            None => out
                .iter_mut()
                .zip(&self.columns)
                .for_each(|(o, x)| *o = unit(&self.shape, self.lamp_m, DVec2::new(*x, y))),
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
fn means_over_pixels(image: &[f64], [width, height]: [usize; 2]) -> Vec<f64> {
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

/// E⁰ of a lamp's emitters on one view's pixels, kept while lamp, screen and size stay.
#[derive(Debug, Default)]
pub(crate) struct UnitImages {
    kept: Vec<UnitImage>,
}

/// E⁰ of one emitter.
#[derive(Clone, Debug)]
struct UnitImage {
    /// What it was made for.
    key: String,
    /// At pixel centres.
    centres: Arc<Vec<f64>>,
    /// Means over pixels, where they were asked for.
    means: Option<Arc<Vec<f64>>>,
}

impl UnitImages {
    /// Brings the images up to date and forgets what is no longer used; `means` asks for [`UnitImages::means`].
    pub fn update(&mut self, theatre: &Theatre, size: [usize; 2], means: bool) {
        let lamp_m = theatre.lamp.position_m;
        let screen = &theatre.screen;
        let old = std::mem::take(&mut self.kept);
        for emitter in &theatre.lamp.emitters {
            let key =
                format!("{:?} {lamp_m:?} {} {} {size:?}", emitter.shape, screen.width_m, screen.height_m);
            let mut image = old.iter().find(|image| image.key == key).cloned().unwrap_or_else(|| UnitImage {
                centres: Arc::new(unit_image(&emitter.shape, lamp_m, screen, size)),
                means: None,
                key,
            });
            if means && image.means.is_none() {
                image.means = Some(Arc::new(means_over_pixels(&image.centres, size)));
            }
            self.kept.push(image);
        }
    }

    /// At pixel centres, one image an emitter.
    pub fn centres(&self) -> Vec<&[f64]> {
        self.kept.iter().map(|image| image.centres.as_slice()).collect()
    }

    /// Means over pixels, one image an emitter; values at the centres where means were not asked for.
    pub fn means(&self) -> Vec<&[f64]> {
        self.kept.iter().map(|image| image.means.as_ref().unwrap_or(&image.centres).as_slice()).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    /// Kind, half-sides, lamp, point and value from mpmath; `tests/data/irradiance.py` made them.
    fn cases() -> Vec<(EmitterShape, DVec3, DVec2, f64)> {
        let parse = |line: &str| {
            let fields: Vec<&str> = line.split(',').collect();
            let v: Vec<f64> = fields[1..].iter().map(|f| f.parse().unwrap()).collect();
            let shape = match fields[0] {
                "disk" => EmitterShape::Disk { radius_m: v[0] },
                _ => EmitterShape::Rectangle { size_m: [2.0 * v[0], 2.0 * v[1]] },
            };
            (shape, DVec3::new(v[2], v[3], v[4]), DVec2::new(v[5], v[6]), v[7])
        };
        include_str!("../tests/data/irradiance.csv").lines().map(parse).collect()
    }

    #[test]
    fn agrees_with_mpmath_to_1e12() {
        let cases = cases();
        assert_eq!(cases.len(), 170);
        for (shape, lamp, p, expected) in &cases {
            let got = unit(shape, *lamp, *p);
            assert!((got / expected - 1.0).abs() <= 1e-12, "{shape:?} {lamp} {p}: {got:e}, not {expected:e}");
        }
        // The negative control: Lambert's formula alone loses the digits of the smallest emitter.
        let (_, lamp, p, expected) = cases[1];
        let naive = lambert(lamp.truncate() - p, 5e-7, 5e-7, -lamp.z);
        assert!((naive / expected - 1.0).abs() > 1e-6, "{naive:e}");
    }

    #[test]
    fn rows_keep_their_bound() {
        let screen = Screen { width_m: 1.6, height_m: 0.9, albedo: kelir_scene::Albedo::Uniform([1.0; 3]) };
        let size = [1600, 9];
        let mut strides = Vec::new();
        for (side, z) in [(1e-6, -1.5), (0.02, -1.5), (0.1, -1.5), (0.1, -0.3), (1.0, -0.4)] {
            let (shape, lamp) =
                (EmitterShape::Rectangle { size_m: [side, 0.7 * side] }, DVec3::new(0.3, -0.1, z));
            let image = unit_image(&shape, lamp, &screen, size);
            strides.push(UnitRows::new(&shape, lamp, &screen, size).stride);
            for (k, got) in image.iter().enumerate() {
                let p = pixel_m(&screen, size, (k % size[0]) as f64, (k / size[0]) as f64);
                let expected = unit(&shape, lamp, p);
                assert!((got / expected - 1.0).abs() <= 2e-8, "{side} {z}: {got:e}, not {expected:e}");
            }
        }
        assert_eq!(strides, [4, 4, 4, 1, 1], "both ways are tried");
    }

    /// Against 64 × 64 midpoints in each pixel; the value at the centre is far off (negative control).
    #[test]
    fn means_over_pixels_are_means() {
        let screen = Screen { width_m: 1.6, height_m: 0.9, albedo: kelir_scene::Albedo::Uniform([1.0; 3]) };
        let size = [48, 27];
        for shape in [EmitterShape::Rectangle { size_m: [0.1, 0.2] }, EmitterShape::Disk { radius_m: 0.05 }] {
            let lamp = DVec3::new(0.3, -0.1, -1.5);
            let image = unit_image(&shape, lamp, &screen, size);
            let means = means_over_pixels(&image, size);
            let (mut worst, mut at_centres) = (0f64, 0f64);
            for (i, j) in [(0, 0), (20, 13), (33, 0), (47, 26), (0, 12)] {
                let part = |k: usize| (k as f64 + 0.5) / 64.0 - 0.5;
                let at = |k: usize| pixel_m(&screen, size, i as f64 + part(k % 64), j as f64 + part(k / 64));
                let mean = (0..4096).map(|k| unit(&shape, lamp, at(k))).sum::<f64>() / 4096.0;
                worst = worst.max((means[j * size[0] + i] / mean - 1.0).abs());
                at_centres = at_centres.max((image[j * size[0] + i] / mean - 1.0).abs());
            }
            assert!(worst < 1e-6 && at_centres > 5e-5, "{worst:e} {at_centres:e}");
        }
    }

    #[test]
    fn gauss_and_closed_form_meet() {
        for k in 0..40 {
            let (c, h) = (DVec2::new(0.03 * k as f64, 0.2), 0.7);
            let (closed, gauss) = (lambert(c, 0.05, 0.08, h), gauss(c, 0.05, 0.08, h));
            assert!((closed / gauss - 1.0).abs() < 1e-12, "{closed:e} {gauss:e}");
        }
    }

    #[test]
    fn a_disk_and_a_square_of_one_area_agree_from_far_away() {
        let far = DVec3::new(0.0, 0.0, -100.0);
        let square = unit(&EmitterShape::Rectangle { size_m: [0.01; 2] }, far, DVec2::ZERO);
        let disk =
            unit(&EmitterShape::Disk { radius_m: 0.01 / std::f64::consts::PI.sqrt() }, far, DVec2::ZERO);
        assert!((square / disk - 1.0).abs() < 1e-9);
        assert!((square / 1e-8 - 1.0).abs() < 1e-7, "area over squared distance: {square:e}");
    }
}
