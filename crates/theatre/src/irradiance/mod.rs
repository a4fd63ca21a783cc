//! E⁰: the irradiance that an unshadowed emitter of unit radiance gives a point of the screen.
//!
//! A rectangle's is Lambert's formula, a sum of four arctangent terms. They are of order one, so a small or distant emitter, whose
//! value is of order area / distance², is what is left when almost everything cancels. Below
//! [`CLOSED_FORM_FROM`] steradians the integral is taken by tensor Gauss rules instead, on pieces small enough for
//! their error bound (`order`). A disk's closed form has an arrangement without cancellation.

mod kept;
mod rows;

use std::sync::OnceLock;

use glam::{DVec2, DVec3};
use kelir_scene::EmitterShape;

pub(crate) use kept::UnitImages;
pub use rows::{UnitRows, unit_image};

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

#[cfg(test)]
mod tests;
