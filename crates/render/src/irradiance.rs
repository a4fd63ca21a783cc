//! E⁰: the irradiance that an unshadowed emitter of unit radiance gives a point of the screen.

use glam::{DVec2, DVec3};
use kelir_scene::{EmitterShape, Screen};

/// ∫ cosθ_P cosθ_Q / |PQ|² dA over the emitter (steradians, cosine-weighted), at the screen point `p_m`, for a lamp
/// centred on `lamp_m`; E⁰ is this times the emitter's radiance.
pub fn unit(shape: &EmitterShape, lamp_m: DVec3, p_m: DVec2) -> f64 {
    let h = lamp_m.z.abs();
    let [a, b] = shape.half_extent_m();
    let c = lamp_m.truncate() - p_m;
    let corner = |x: f64, y: f64| {
        let (rx, ry) = (x.hypot(h), y.hypot(h));
        0.5 * (x / rx * (y / rx).atan() + y / ry * (x / ry).atan())
    };
    corner(c.x + a, c.y + b) - corner(c.x - a, c.y + b) - corner(c.x + a, c.y - b) + corner(c.x - a, c.y - b)
}

/// [`unit`] at the centre of every pixel, row-major, first row on top.
pub fn unit_image(shape: &EmitterShape, lamp_m: DVec3, screen: &Screen, size: [usize; 2]) -> Vec<f64> {
    let mut out = Vec::with_capacity(size[0] * size[1]);
    for j in 0..size[1] {
        for i in 0..size[0] {
            out.push(unit(shape, lamp_m, crate::project::pixel_m(screen, size, i as f64, j as f64)));
        }
    }
    out
}
