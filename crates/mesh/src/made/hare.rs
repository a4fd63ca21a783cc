//! A hare that sits up, looking along +x; 0.36 m to the tips of its ears.

use glam::DVec3;

use super::field::{Solid, at, ball, cone, ellipsoid, noise, step};

/// Its body.
pub(super) fn solid() -> Solid {
    let z = at(0.0, 0.0, 1.0);
    Solid::default()
        // Haunches, belly, chest.
        .add(ellipsoid(at(-0.055, 0.080, 0.0), at(1.0, 0.35, 0.0), z, [0.088, 0.074, 0.066]), 0.01)
        .add(cone(at(-0.020, 0.105, 0.0), 0.064, at(0.035, 0.160, 0.0), 0.046), 0.04)
        .add(cone(at(0.032, 0.165, 0.0), 0.040, at(0.052, 0.222, 0.0), 0.029), 0.04)
        // Head, muzzle, cheeks, brow.
        .add(ellipsoid(at(0.066, 0.238, 0.0), at(1.0, -0.25, 0.0), z, [0.046, 0.034, 0.030]), 0.02)
        .add(cone(at(0.085, 0.232, 0.0), 0.024, at(0.116, 0.222, 0.0), 0.0145), 0.02)
        .pair(ball(at(0.086, 0.222, 0.014), 0.018), 0.015)
        .pair(ball(at(0.110, 0.217, 0.007), 0.010), 0.01)
        .add(ball(at(0.1305, 0.2275, 0.0), 0.0045), 0.006)
        // Ears: long shells, bent back.
        .pair(
            ellipsoid(
                at(0.033, 0.292, 0.018),
                at(-0.35, 1.0, 0.12),
                at(0.25, 0.0, 1.0),
                [0.044, 0.0085, 0.0155],
            ),
            0.014,
        )
        .pair(
            ellipsoid(
                at(0.010, 0.334, 0.025),
                at(-0.62, 1.0, 0.14),
                at(0.25, 0.0, 1.0),
                [0.034, 0.0075, 0.0125],
            ),
            0.014,
        )
        .carve_pair(
            ellipsoid(
                at(0.0405, 0.300, 0.0245),
                at(-0.42, 1.0, 0.12),
                at(0.25, 0.0, 1.0),
                [0.037, 0.0065, 0.0085],
            ),
            0.005,
        )
        // Hind legs: thighs, feet.
        .pair(ellipsoid(at(-0.040, 0.068, 0.050), at(0.8, 0.6, 0.05), z, [0.062, 0.049, 0.030]), 0.02)
        .pair(cone(at(-0.070, 0.020, 0.058), 0.019, at(0.030, 0.014, 0.056), 0.0135), 0.02)
        .pair(cone(at(0.030, 0.014, 0.056), 0.0135, at(0.046, 0.0135, 0.055), 0.0130), 0.006)
        // Forelegs, paws.
        .pair(cone(at(0.042, 0.135, 0.026), 0.026, at(0.062, 0.070, 0.029), 0.0155), 0.025)
        .pair(cone(at(0.062, 0.070, 0.029), 0.0155, at(0.068, 0.020, 0.028), 0.0115), 0.012)
        .pair(ellipsoid(at(0.078, 0.0125, 0.029), at(1.0, 0.0, 0.0), z, [0.021, 0.0120, 0.0135]), 0.012)
        // Tail, eyes.
        .add(ellipsoid(at(-0.142, 0.062, 0.0), at(-0.6, 0.8, 0.0), z, [0.027, 0.021, 0.021]), 0.012)
        .pair(ball(at(0.0855, 0.2465, 0.0235), 0.0078), 0.0025)
}

/// Its coat, metres: tufts that run down and back, less on face, ears and feet.
pub(super) fn relief(p: DVec3) -> f64 {
    // Long along the way the hair lies.
    let along = at(-0.62, -0.78, 0.0);
    let stretched = p - along * (0.62 * p.dot(along));
    let bend = at(noise(11, p * 45.0), noise(12, p * 45.0), noise(13, p * 45.0)) * 0.004;
    let tufts = noise(14, (stretched + bend) * 190.0) + 0.5 * noise(15, (stretched + bend) * 380.0);
    let coat = 1.0 - 0.75 * step(0.195, 0.225, p.y) - 0.2 * step(0.035, 0.015, p.y);
    let eye = (p - at(0.0855, 0.2465, if p.z > 0.0 { 0.0235 } else { -0.0235 })).length();
    0.0011 * coat * tufts * step(0.008, 0.016, eye)
}
