//! E⁰ of emitters down to 1e-6 m, against mpmath.

use glam::{DVec2, DVec3};
use kelir_scene::EmitterShape;

use crate::irradiance;

/// Relative errors of E⁰ for emitters of one shape and size, over lamps near, far and aside.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct EmitterErrors {
    /// "rectangle" or "disk".
    pub shape: String,
    /// Full sides, or the diameter, metres.
    pub size_m: [f64; 2],
    /// Values compared.
    pub points: usize,
    /// Largest relative error of what every technique uses.
    pub product: f64,
    /// The same of Lambert's formula alone in f64 (a disk: of its formula as textbooks have it).
    pub closed_form: f64,
    /// The same of that formula in f32.
    pub closed_form_f32: f64,
}

/// Relative errors, smallest emitters first. `tests/data/irradiance.py` made the values, with mpmath at 90 digits.
pub fn emitters() -> Vec<EmitterErrors> {
    let mut all: Vec<EmitterErrors> = Vec::new();
    for line in include_str!("../../tests/data/irradiance.csv").lines() {
        let mut fields = line.split(',');
        let name = fields.next().unwrap_or_default();
        let v: Vec<f64> = fields.filter_map(|f| f.parse().ok()).collect();
        let [a, b, x, y, z, px, py, expected] = v[..] else { continue };
        let (lamp, p) = (DVec3::new(x, y, z), DVec2::new(px, py));
        let (shape, closed, closed_f32) = if name == "disk" {
            let (h2, x2) = (z * z, (x - px).powi(2) + (y - py).powi(2));
            let closed = disk(x2, h2, a * a);
            (EmitterShape::Disk { radius_m: a }, closed, disk_f32(x2 as f32, h2 as f32, (a * a) as f32))
        } else {
            let c = lamp.truncate() - p;
            let closed = irradiance::lambert(c, a, b, -z);
            let closed_f32 = lambert_f32([c.x as f32, c.y as f32], a as f32, b as f32, -z as f32);
            (EmitterShape::Rectangle { size_m: [2.0 * a, 2.0 * b] }, closed, closed_f32)
        };
        let errors = [irradiance::unit(&shape, lamp, p), closed, f64::from(closed_f32)];
        let [product, closed_form, closed_form_f32] = errors.map(|got| (got / expected - 1.0).abs());
        let size_m = [2.0 * a, 2.0 * b];
        match all.iter_mut().find(|e| e.shape == name && e.size_m == size_m) {
            Some(e) => {
                e.points += 1;
                e.product = e.product.max(product);
                e.closed_form = e.closed_form.max(closed_form);
                e.closed_form_f32 = e.closed_form_f32.max(closed_form_f32);
            }
            None => all.push(EmitterErrors {
                shape: name.into(),
                size_m,
                points: 1,
                product,
                closed_form,
                closed_form_f32,
            }),
        }
    }
    all
}

fn disk(x2: f64, h2: f64, r2: f64) -> f64 {
    let s = x2 + h2;
    0.5 * std::f64::consts::PI * (1.0 - (s - r2) / ((s + r2).powi(2) - 4.0 * r2 * x2).sqrt())
}

fn disk_f32(x2: f32, h2: f32, r2: f32) -> f32 {
    let s = x2 + h2;
    0.5 * std::f32::consts::PI * (1.0 - (s - r2) / ((s + r2).powi(2) - 4.0 * r2 * x2).sqrt())
}

fn lambert_f32([x, y]: [f32; 2], a: f32, b: f32, h: f32) -> f32 {
    let corner = |x: f32, y: f32| {
        let (rx, ry) = (x.hypot(h), y.hypot(h));
        0.5 * (x / rx * (y / rx).atan() + y / ry * (x / ry).atan())
    };
    corner(x + a, y + b) - corner(x - a, y + b) - corner(x + a, y - b) + corner(x - a, y - b)
}
