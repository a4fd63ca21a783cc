//! Solids as fields: a number below 0 inside, above 0 outside, about the distance in metres near the surface.
//!
//! Made of + − × ÷ √ and comparisons alone, in f64: the same bits on every machine.

use glam::DVec3;

use crate::random::mixed;

/// A simple solid.
#[derive(Clone, Copy)]
pub(super) enum Shape {
    /// Two balls and what lies between them: centres and radii.
    Cone([DVec3; 2], [f64; 2]),
    /// Centre, unit axes at right angles to each other, and radii along them.
    Ellipsoid(DVec3, [DVec3; 3], [f64; 3]),
}

/// How a shape goes with those before it.
#[derive(Clone, Copy)]
enum Way {
    Add,
    Carve,
}

/// Shapes one after the other, blended.
#[derive(Clone, Default)]
pub(super) struct Solid {
    steps: Vec<(Shape, Way, f64)>,
}

/// A point; metres.
pub(super) const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Two balls and what lies between them.
pub(super) fn cone(a: DVec3, ra: f64, b: DVec3, rb: f64) -> Shape {
    Shape::Cone([a, b], [ra, rb])
}

/// A ball.
pub(super) fn ball(centre: DVec3, radius: f64) -> Shape {
    Shape::Ellipsoid(centre, [DVec3::X, DVec3::Y, DVec3::Z], [radius; 3])
}

/// An ellipsoid: its first radius lies along `along`, its third as near to `across` as a right angle allows.
pub(super) fn ellipsoid(centre: DVec3, along: DVec3, across: DVec3, radii: [f64; 3]) -> Shape {
    let first = along / along.length();
    let second = across.cross(first);
    let second = second / second.length();
    Shape::Ellipsoid(centre, [first, second, first.cross(second)], radii)
}

impl Shape {
    fn distance(&self, p: DVec3) -> f64 {
        match *self {
            Shape::Cone([a, b], [ra, rb]) => {
                // Quílez: the nearest of the two balls and the cone that touches both.
                let (ba, pa, dr) = (b - a, p - a, ra - rb);
                let l2 = ba.dot(ba);
                let (a2, il2) = (l2 - dr * dr, 1.0 / l2);
                let y = pa.dot(ba);
                let z = y - l2;
                let across = pa * l2 - ba * y;
                let x2 = across.dot(across);
                let (y2, z2) = (y * y * l2, z * z * l2);
                let sign = |x: f64| {
                    if x > 0.0 {
                        1.0
                    } else if x < 0.0 {
                        -1.0
                    } else {
                        0.0
                    }
                };
                let k = sign(dr) * dr * dr * x2;
                if sign(z) * a2 * z2 > k {
                    (x2 + z2).sqrt() * il2 - rb
                } else if sign(y) * a2 * y2 < k {
                    (x2 + y2).sqrt() * il2 - ra
                } else {
                    ((x2 * a2 * il2).sqrt() + y * dr) * il2 - ra
                }
            }
            Shape::Ellipsoid(centre, axes, radii) => {
                let d = p - centre;
                let local = [axes[0].dot(d), axes[1].dot(d), axes[2].dot(d)];
                let scaled = [local[0] / radii[0], local[1] / radii[1], local[2] / radii[2]];
                let k0 = length(scaled);
                let k1 = length([scaled[0] / radii[0], scaled[1] / radii[1], scaled[2] / radii[2]]);
                // At its very middle all radii are as near.
                if k1 > 0.0 { k0 * (k0 - 1.0) / k1 } else { -radii[0].min(radii[1]).min(radii[2]) }
            }
        }
    }

    fn mirrored(self) -> Shape {
        let flip = |v: DVec3| at(v.x, v.y, -v.z);
        match self {
            Shape::Cone(ends, radii) => Shape::Cone(ends.map(flip), radii),
            Shape::Ellipsoid(centre, axes, radii) => Shape::Ellipsoid(flip(centre), axes.map(flip), radii),
        }
    }
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// The lesser of two, rounded where they differ by less than `k`.
fn soft_min(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * h * k / 6.0
}

impl Solid {
    /// Adds a shape, blended over about `k` metres.
    pub(super) fn add(mut self, shape: Shape, k: f64) -> Solid {
        self.steps.push((shape, Way::Add, k));
        self
    }

    /// Adds a shape and its mirror image across z = 0.
    pub(super) fn pair(self, shape: Shape, k: f64) -> Solid {
        self.add(shape, k).add(shape.mirrored(), k)
    }

    /// Takes a shape and its mirror image away.
    pub(super) fn carve_pair(mut self, shape: Shape, k: f64) -> Solid {
        self.steps.push((shape, Way::Carve, k));
        self.steps.push((shape.mirrored(), Way::Carve, k));
        self
    }

    /// The field.
    pub(super) fn at(&self, p: DVec3) -> f64 {
        let mut field = f64::MAX;
        for (shape, way, k) in &self.steps {
            let distance = shape.distance(p);
            field = match way {
                Way::Add => soft_min(field, distance, *k),
                Way::Carve => -soft_min(-field, distance, *k),
            };
        }
        field
    }
}

/// Bumps without a pattern: from about −1 to 1, smooth, wavelengths of about 2 in each coordinate. Numbers at the lattice's points, blended by
/// polynomials (value noise).
pub(super) fn noise(seed: u64, p: DVec3) -> f64 {
    let floor = p.floor();
    let part = p - floor;
    let blend = |x: f64| x * x * x * (x * (x * 6.0 - 15.0) + 10.0);
    let (bx, by, bz) = (blend(part.x), blend(part.y), blend(part.z));
    let cell = [floor.x as i64, floor.y as i64, floor.z as i64];
    let value = |dx: i64, dy: i64, dz: i64| {
        let place = [cell[0] + dx, cell[1] + dy, cell[2] + dz];
        let hash = place.iter().fold(seed, |hash, x| mixed(hash, *x as u64));
        (hash >> 12) as f64 / (1u64 << 51) as f64 - 1.0
    };
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let row = |dy: i64, dz: i64| mix(value(0, dy, dz), value(1, dy, dz), bx);
    mix(mix(row(0, 0), row(1, 0), by), mix(row(0, 1), row(1, 1), by), bz)
}

/// The cosine of `n` times an angle from the cosine of the angle: Chebyshev's polynomial.
pub(super) fn cosine_of_multiple(n: u32, cosine: f64) -> f64 {
    let (mut last, mut this) = (1.0, cosine);
    for _ in 1..n {
        (last, this) = (this, 2.0 * cosine * this - last);
    }
    this
}

/// From 0 at `from` to 1 at `to`, smooth.
pub(super) fn step(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_distances_and_blend() {
        let cone = cone(at(0.0, 0.0, 0.0), 1.0, at(4.0, 0.0, 0.0), 1.0);
        for (p, distance) in [
            (at(2.0, 3.0, 0.0), 2.0),
            (at(-3.0, 0.0, 0.0), 2.0),
            (at(4.0, 0.0, 0.5), -0.5),
            (at(6.0, 0.0, 0.0), 1.0),
        ] {
            assert!((cone.distance(p) - distance).abs() < 1e-12, "{p}");
        }
        // A cone that grows: a ball of radius 2 around (4, 0, 0) decides far out there.
        assert!(
            (super::cone(at(0.0, 0.0, 0.0), 1.0, at(4.0, 0.0, 0.0), 2.0).distance(at(4.5, 5.0, 0.0))
                - (25.25f64.sqrt() - 2.0))
                .abs()
                < 1e-12
        );
        let egg = ellipsoid(at(1.0, 0.0, 0.0), at(0.0, 2.0, 0.0), at(0.0, 0.0, 1.0), [3.0, 2.0, 1.0]);
        for surface in [at(1.0, 3.0, 0.0), at(1.0, 0.0, 1.0), at(3.0, 0.0, 0.0), at(-1.0, 0.0, 0.0)] {
            assert!(egg.distance(surface).abs() < 1e-12, "{surface}");
        }
        let two = Solid::default().pair(ball(at(0.0, 0.0, 2.0), 1.0), 0.1);
        assert_eq!(two.at(at(0.0, 0.5, 2.0)), two.at(at(0.0, 0.5, -2.0)));
        assert_eq!(two.at(at(0.0, 0.0, 2.0)), -1.0);
        let carved = two.carve_pair(ball(at(0.0, 0.0, 3.0), 0.5), 0.1);
        assert!(carved.at(at(0.0, 0.0, 2.8)) > 0.0 && carved.at(at(0.0, 0.0, 2.3)) < 0.0);
    }

    #[test]
    fn bumps_are_smooth_bounded_and_even() {
        let many: Vec<f64> = (0..4000).map(|k| noise(3, at(0.37 * f64::from(k), 1.7, -0.2))).collect();
        let mean = many.iter().sum::<f64>() / 4000.0;
        assert!(mean.abs() < 0.1 && many.iter().all(|x| x.abs() <= 1.0), "{mean}");
        assert!(many.iter().any(|x| *x > 0.5) && many.iter().any(|x| *x < -0.5));
        // No jump where cells meet.
        assert!((noise(3, at(2.0 - 1e-9, 0.5, 0.5)) - noise(3, at(2.0, 0.5, 0.5))).abs() < 1e-7);
        for n in [1, 2, 7, 24] {
            let angle: f64 = 0.3;
            assert!((cosine_of_multiple(n, angle.cos()) - (angle * f64::from(n)).cos()).abs() < 1e-12);
        }
    }
}
