//! A horse that looks along +x, 0.3 m at its back: a body, and four legs that turn about their pivots.

use glam::DVec3;

use super::field::{Solid, at, ball, cone, ellipsoid, noise, step};

/// A leg: its name, and the pivot of its own frame in the body's, metres.
pub(super) const LEGS: [(&str, DVec3); 4] = [
    ("leg-front-left", at(0.118, 0.2325, -0.040)),
    ("leg-front-right", at(0.118, 0.2325, 0.040)),
    ("leg-hind-left", at(-0.150, 0.240, -0.042)),
    ("leg-hind-right", at(-0.150, 0.240, 0.042)),
];

/// Trunk, neck, head and tail.
pub(super) fn body() -> Solid {
    let z = at(0.0, 0.0, 1.0);
    Solid::default()
        .add(ellipsoid(at(-0.010, 0.262, 0.0), at(1.0, 0.0, 0.0), z, [0.175, 0.072, 0.066]), 0.01)
        .add(ellipsoid(at(-0.140, 0.272, 0.0), at(1.0, 0.15, 0.0), z, [0.082, 0.072, 0.064]), 0.05)
        .add(ellipsoid(at(0.112, 0.268, 0.0), at(0.5, 1.0, 0.0), z, [0.082, 0.066, 0.058]), 0.04)
        // Neck, withers, crest.
        .add(cone(at(0.125, 0.295, 0.0), 0.054, at(0.205, 0.408, 0.0), 0.033), 0.05)
        .add(cone(at(0.060, 0.3185, 0.0), 0.022, at(0.115, 0.335, 0.0), 0.028), 0.05)
        .add(ellipsoid(at(0.152, 0.378, 0.0), at(0.58, 0.82, 0.0), z, [0.085, 0.026, 0.011]), 0.018)
        // Head: cheek, face, muzzle, chin.
        .add(ellipsoid(at(0.226, 0.415, 0.0), at(1.0, -0.62, 0.0), z, [0.045, 0.036, 0.028]), 0.03)
        .add(cone(at(0.236, 0.414, 0.0), 0.028, at(0.298, 0.362, 0.0), 0.0195), 0.025)
        .add(ellipsoid(at(0.304, 0.355, 0.0), at(0.6, -0.8, 0.0), z, [0.019, 0.0160, 0.0160]), 0.020)
        .add(ball(at(0.291, 0.349, 0.0), 0.0085), 0.012)
        // Ears, eyes, forelock.
        .pair(cone(at(0.207, 0.440, 0.015), 0.0120, at(0.219, 0.486, 0.021), 0.0042), 0.010)
        .pair(ball(at(0.247, 0.420, 0.0235), 0.0075), 0.003)
        .add(ellipsoid(at(0.228, 0.446, 0.0), at(0.9, -0.4, 0.0), z, [0.024, 0.010, 0.009]), 0.012)
        // Tail.
        .add(cone(at(-0.205, 0.305, 0.0), 0.018, at(-0.256, 0.276, 0.0), 0.018), 0.02)
        .add(cone(at(-0.256, 0.276, 0.0), 0.018, at(-0.276, 0.185, 0.0), 0.023), 0.010)
        .add(cone(at(-0.276, 0.185, 0.0), 0.023, at(-0.268, 0.095, 0.0), 0.007), 0.010)
}

/// A leg below its pivot.
pub(super) fn leg(name: &str) -> Solid {
    let z = at(0.0, 0.0, 1.0);
    if name.starts_with("leg-front") {
        return Solid::default()
            .add(ellipsoid(at(0.004, 0.000, 0.0), at(0.1, 1.0, 0.0), z, [0.062, 0.036, 0.026]), 0.01)
            .add(cone(at(0.002, -0.040, 0.0), 0.0235, at(0.004, -0.108, 0.0), 0.0150), 0.02)
            .add(ellipsoid(at(0.006, -0.116, 0.0), at(0.0, 1.0, 0.0), z, [0.020, 0.0150, 0.0140]), 0.012)
            .add(cone(at(0.002, -0.128, 0.0), 0.0110, at(0.000, -0.186, 0.0), 0.0095), 0.012)
            .add(ball(at(-0.001, -0.191, 0.0), 0.0130), 0.010)
            .add(cone(at(0.003, -0.198, 0.0), 0.0108, at(0.010, -0.212, 0.0), 0.0130), 0.006)
            .add(ellipsoid(at(0.013, -0.224, 0.0), at(1.0, 0.0, 0.0), z, [0.0205, 0.0085, 0.0185]), 0.012);
    }
    Solid::default()
        .add(ellipsoid(at(0.010, -0.004, 0.0), at(0.2, 1.0, 0.0), z, [0.076, 0.054, 0.030]), 0.01)
        .add(cone(at(0.020, -0.046, 0.0), 0.0330, at(-0.014, -0.106, 0.0), 0.0165), 0.03)
        .add(ellipsoid(at(-0.026, -0.122, 0.0), at(-0.4, 1.0, 0.0), z, [0.0225, 0.0150, 0.0130]), 0.014)
        .add(cone(at(-0.025, -0.130, 0.0), 0.0120, at(-0.018, -0.192, 0.0), 0.0098), 0.012)
        .add(ball(at(-0.018, -0.197, 0.0), 0.0132), 0.010)
        .add(cone(at(-0.014, -0.205, 0.0), 0.0110, at(-0.007, -0.219, 0.0), 0.0130), 0.006)
        .add(ellipsoid(at(-0.004, -0.2315, 0.0), at(1.0, 0.0, 0.0), z, [0.0202, 0.0085, 0.0182]), 0.012)
}

/// Muscles, mane and tail, metres; in the body's frame.
pub(super) fn relief(p: DVec3) -> f64 {
    let muscles = 0.0009 * noise(31, p * 32.0);
    // Strands across the crest of the neck, and down the tail.
    let mane = step(0.014, 0.008, p.z.abs())
        * step(0.012, 0.024, (p - at(0.126, 0.296, 0.0)).dot(at(-0.82, 0.58, 0.0)))
        * step(0.315, 0.335, p.y)
        * step(0.206, 0.190, p.x)
        * step(0.080, 0.110, p.x);
    let tail = step(-0.214, -0.226, p.x);
    let strands = noise(32, at(p.x * 60.0 + p.y * 70.0, p.y * 40.0 - p.x * 60.0, p.z * 220.0))
        + 0.6 * noise(33, at(p.x * 260.0 - p.y * 20.0, p.y * 26.0, p.z * 260.0));
    muscles + (0.0026 * mane + 0.0017 * tail) * strands
}
