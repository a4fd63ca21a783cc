//! How far one surface is from another.

use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::Mesh;
use crate::mesh::vector;
use crate::nearest::Surface;
use crate::random::fraction;
use crate::topology::is_drawable;

/// Points that are looked at unless something else is asked for, on each surface.
pub const SAMPLES: usize = 50_000;
/// Points that one thread takes at a time: sums are the same however many there are.
const CHUNK: usize = 1024;

/// The distance of two surfaces, looked at from points spread evenly over the area of each, and from the corners of its triangles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Distance {
    /// From the points of the first to the second.
    pub there: OneWay,
    /// From the points of the second to the first.
    pub back: OneWay,
    /// The diagonal of the first one's box, metres: what the distances are shares of.
    pub diagonal_m: f64,
}

/// What the points of one surface find of another: the nearest point of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OneWay {
    /// Root mean square of the distances over the area, metres.
    pub rms_m: f64,
    /// The greatest distance found, at corners too, metres. As it is sampled, the true one may be greater.
    pub greatest_m: f64,
    /// Root mean square of the angle between the shading normals (angle-weighted, of either mesh's own surface) over the area, degrees.
    pub normal_deg: f64,
    /// The same of the triangles' own normals, degrees: what flat shading shows.
    pub flat_normal_deg: f64,
}

impl Distance {
    /// Root mean square over both surfaces, metres.
    pub fn rms_m(&self) -> f64 {
        (0.5 * (self.there.rms_m * self.there.rms_m + self.back.rms_m * self.back.rms_m)).sqrt()
    }

    /// The Hausdorff distance as sampled, metres.
    pub fn hausdorff_m(&self) -> f64 {
        self.there.greatest_m.max(self.back.greatest_m)
    }
}

/// A mesh with all that is asked of it again and again: one surface is compared with several.
pub struct Measured<'a> {
    mesh: &'a Mesh,
    surface: Surface,
    smooth: Vec<[f32; 3]>,
    flat: Vec<[f32; 3]>,
}

impl<'a> Measured<'a> {
    /// Builds what is needed; triangles that can't be drawn are left out.
    pub fn new(mesh: &'a Mesh) -> Measured<'a> {
        Measured {
            mesh,
            surface: Surface::new(mesh),
            smooth: mesh.smooth_normals(),
            flat: mesh.flat_normals(),
        }
    }

    /// The distance from another surface; `samples` points on each, chosen by `seed`. `None` where either has no area.
    pub fn distance(&self, other: &Measured, samples: usize, seed: u64) -> Option<Distance> {
        Some(Distance {
            there: self.one_way(other, samples, seed)?,
            back: other.one_way(self, samples, seed)?,
            diagonal_m: self.mesh.bounds()?.diagonal(),
        })
    }

    fn one_way(&self, other: &Measured, samples: usize, seed: u64) -> Option<OneWay> {
        let points = spread(self.mesh, samples, seed)?;
        let sums: Vec<Option<[f64; 4]>> = points
            .par_chunks(CHUNK)
            .map(|points| {
                let mut sums = [0.0f64; 4];
                for point in points {
                    let (here, there) = (self.at(point), other.surface.nearest(point.point)?);
                    let there =
                        other.at(&Point { triangle: there.triangle, weights: there.weights, ..*point });
                    let distance = other.surface.nearest(point.point)?.distance;
                    let squares = [distance, angle(here.0, there.0), angle(here.1, there.1)].map(|x| x * x);
                    (0..3).for_each(|k| sums[k] += squares[k]);
                    sums[3] = sums[3].max(distance);
                }
                Some(sums)
            })
            .collect();
        let mut all = [0.0f64; 4];
        for sums in sums {
            let sums = sums?;
            (0..3).for_each(|k| all[k] += sums[k]);
            all[3] = all[3].max(sums[3]);
        }
        let drawable: Vec<&[u32; 3]> =
            self.mesh.triangles.iter().filter(|triangle| is_drawable(self.mesh, **triangle)).collect();
        let mut corners: Vec<u32> = drawable.into_iter().flatten().copied().collect();
        corners.sort_unstable();
        corners.dedup();
        let at_corners = corners.par_iter().filter_map(|corner| {
            other
                .surface
                .nearest(vector(self.mesh.positions[*corner as usize]))
                .map(|nearest| nearest.distance)
        });
        let mean = |sum: f64| (sum / points.len() as f64).sqrt();
        Some(OneWay {
            rms_m: mean(all[0]),
            greatest_m: at_corners.reduce(|| all[3], f64::max),
            normal_deg: mean(all[1]),
            flat_normal_deg: mean(all[2]),
        })
    }

    /// The shading normal and the triangle's own at a point.
    fn at(&self, point: &Point) -> (DVec3, DVec3) {
        let triangle = self.mesh.triangles[point.triangle as usize];
        let smooth =
            triangle.iter().zip(point.weights).map(|(v, weight)| vector(self.smooth[*v as usize]) * weight);
        (smooth.sum::<DVec3>().normalize_or_zero(), vector(self.flat[point.triangle as usize]))
    }
}

/// A point of a triangle.
#[derive(Clone, Copy)]
struct Point {
    triangle: u32,
    weights: [f64; 3],
    point: DVec3,
}

/// Points spread evenly over the area: one in each of `count` equal shares of it, in the order of the triangles.
fn spread(mesh: &Mesh, count: usize, seed: u64) -> Option<Vec<Point>> {
    let mut upto = Vec::with_capacity(mesh.triangles.len());
    let mut area = 0.0;
    for triangle in &mesh.triangles {
        if is_drawable(mesh, *triangle)
            && let Some([a, b, c]) = mesh.corners(*triangle)
        {
            area += (b - a).cross(c - a).length();
        }
        upto.push(area);
    }
    if !(area > 0.0 && area.is_finite()) {
        return None;
    }
    let point = |k: usize| {
        let draw = |n: u64| fraction(seed, 3 * k as u64 + n);
        let at = (k as f64 + draw(0)) / count as f64 * area;
        let triangle = upto.partition_point(|area| *area <= at).min(upto.len() - 1);
        let [a, b, c] = mesh.corners(mesh.triangles[triangle])?;
        // A square folded into a triangle.
        let (mut u, mut v) = (draw(1), draw(2));
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        Some(Point {
            triangle: triangle as u32,
            weights: [1.0 - u - v, u, v],
            point: a + u * (b - a) + v * (c - a),
        })
    };
    (0..count).map(point).collect()
}

/// Degrees between two directions.
fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;
    use crate::shapes::{ball, cube, moved, torus};

    fn distance(a: &Mesh, b: &Mesh, samples: usize) -> Distance {
        Measured::new(a).distance(&Measured::new(b), samples, 7).unwrap()
    }

    #[test]
    fn concentric_balls_are_as_far_apart_as_their_radii() {
        let found = distance(&ball(1.0, 64), &ball(1.25, 64), 4000);
        for way in [found.there, found.back] {
            assert!((way.rms_m - 0.25).abs() < 3e-4 && (way.greatest_m - 0.25).abs() < 3e-4, "{way:?}");
            assert!(way.normal_deg < 0.2 && way.flat_normal_deg < 2.0, "{way:?}");
        }
        assert!((found.diagonal_m - 2.0 * 3f64.sqrt()).abs() < 1e-6);
        // Negative control: a hundredth more is seen.
        assert!((distance(&ball(1.0, 64), &ball(1.26, 64), 4000).rms_m() - 0.25).abs() > 5e-3);
    }

    /// The unit cube from itself moved along x by d < ½. Of its six faces the two across x are d away, the others but for a strip of width d
    /// are 0: there the distance grows evenly to d, and the mean square of a strip of area d is d²/3. So rms² = (2 d² + 4 d · d²/3) / 6.
    #[test]
    fn a_moved_cube_has_the_distance_that_integration_gives() {
        let d = 0.25;
        let found = distance(&cube(), &moved(cube(), [0.25, 0.0, 0.0]), 40_000);
        // The side that the other covers is not d away but as near as its rim: along x the far face lies inside, ⅙ of its points nearer to a side.
        let side = |y: f64| y.min(1.0 - y).min(d);
        let n = 500;
        let middle = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
        let inside: f64 = (0..n)
            .flat_map(|i| (0..n).map(move |j| side(middle(i)).min(side(middle(j))).powi(2)))
            .sum::<f64>()
            / f64::from(n * n);
        let expected = ((d * d + inside + 4.0 * d * d * d / 3.0) / 6.0).sqrt();
        assert!((found.there.rms_m / expected - 1.0).abs() < 5e-3, "{} {expected}", found.there.rms_m);
        assert!((found.hausdorff_m() - d).abs() < 1e-12);
    }

    #[test]
    fn a_part_that_only_one_has_is_far_in_one_direction() {
        let (one, two) = (cube(), crate::shapes::joined(&[cube(), moved(cube(), [10.0, 0.0, 0.0])]));
        let found = distance(&one, &two, 2000);
        assert!(found.there.greatest_m < 1e-12 && (found.back.greatest_m - 10.0).abs() < 0.1, "{found:?}");
    }

    #[test]
    fn facets_are_seen_in_their_own_normals() {
        let (fine, coarse) = (torus(96, 48), torus(24, 12));
        let found = distance(&fine, &coarse, 8000);
        assert!(found.there.flat_normal_deg > 2.0 * found.there.normal_deg, "{found:?}");
        let same = distance(&fine, &fine, 8000);
        assert!(same.there.greatest_m < 1e-12 && same.there.flat_normal_deg < 1e-3, "{same:?}");
    }

    #[test]
    fn what_has_no_area_has_no_distance() {
        let (cube, nothing) = (cube(), Mesh::default());
        assert!(Measured::new(&cube).distance(&Measured::new(&nothing), 10, 1).is_none());
        assert!(Measured::new(&nothing).distance(&Measured::new(&cube), 10, 1).is_none());
    }
}
