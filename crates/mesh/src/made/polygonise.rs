//! The surface of a field, as triangles.

use std::collections::HashMap;

use glam::DVec3;
use rayon::prelude::*;

/// A closed surface under way, in f64.
pub(super) struct Net {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// The values of a field on a lattice of cubes and their middles.
struct Lattice {
    min: DVec3,
    side: f64,
    /// Cubes along each axis.
    cells: [i32; 3],
    /// Places along each axis, in halves of the side; those that are neither corner nor middle stay empty.
    values: Vec<f64>,
}

impl Lattice {
    fn new(field: &(dyn Fn(DVec3) -> f64 + Sync), min: DVec3, max: DVec3, side: f64) -> Lattice {
        let cells = ((max - min) / side).ceil();
        let cells = [cells.x as i32, cells.y as i32, cells.z as i32];
        let mut lattice = Lattice { min, side, cells, values: Vec::new() };
        // One cube more for the middles behind the last.
        let layer = (2 * cells[1] + 2) * (2 * cells[2] + 2);
        let place = |index: i32| {
            let p = [index / layer, index % layer / (2 * cells[2] + 2), index % (2 * cells[2] + 2)];
            let odd = p.iter().filter(|x| *x % 2 == 1).count();
            if odd % 3 == 0 { field(lattice.place(p)) } else { f64::NAN }
        };
        lattice.values = (0..(2 * cells[0] + 2) * layer).into_par_iter().map(place).collect();
        lattice
    }

    fn place(&self, p: [i32; 3]) -> DVec3 {
        self.min + DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2])) * (0.5 * self.side)
    }

    fn value(&self, [x, y, z]: [i32; 3]) -> f64 {
        let [_, height, depth] = self.cells.map(|cells| 2 * cells + 2);
        self.values[((x * height + y) * depth + z) as usize]
    }

    /// Where the field is 0 between two places; away from both, so that no two such points fall together.
    fn cut(&self, low: [i32; 3], high: [i32; 3]) -> DVec3 {
        let (f, g) = (self.value(low), self.value(high));
        let share = (f / (f - g)).clamp(0.05, 0.95);
        self.place(low) + (self.place(high) - self.place(low)) * share
    }
}

/// Where a field changes its sign in a box from `min` to `max`, on a lattice of cubes of this side and their middles: the tetrahedra between
/// them (four around each line between neighbouring middles) are cut by planes. Closed and manifold as long as the solid lies within the box.
pub(super) fn net(field: &(dyn Fn(DVec3) -> f64 + Sync), min: DVec3, max: DVec3, side: f64) -> Net {
    let lattice = Lattice::new(field, min, max, side);
    let [columns, rows, layers] = lattice.cells;
    let mut net = Net { positions: Vec::new(), triangles: Vec::new() };
    let mut cuts: HashMap<[[i32; 3]; 2], u32> = HashMap::new();
    let middles = (0..columns).flat_map(|x| (0..rows).flat_map(move |y| (0..layers).map(move |z| [x, y, z])));
    for middle in middles.map(|cell| cell.map(|x| 2 * x + 1)) {
        for axis in (0..3).filter(|axis| middle[*axis] / 2 + 1 < lattice.cells[*axis]) {
            let mut next = middle;
            next[axis] += 2;
            let corner = |u: i32, v: i32| {
                let mut corner = middle;
                corner[axis] += 1;
                corner[(axis + 1) % 3] += u;
                corner[(axis + 2) % 3] += v;
                corner
            };
            // Around the axis, counter-clockwise seen from its end: each tetrahedron is right-handed.
            let ring = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
            for k in 0..4 {
                let tetrahedron = [middle, next, ring[k], ring[(k + 1) % 4]];
                let inside = tetrahedron.map(|p| lattice.value(p) < 0.0);
                let mut vertex = |a: [i32; 3], b: [i32; 3]| {
                    let key = if a < b { [a, b] } else { [b, a] };
                    *cuts.entry(key).or_insert_with(|| {
                        net.positions.push(lattice.cut(key[0], key[1]));
                        net.positions.len() as u32 - 1
                    })
                };
                cut(tetrahedron, inside, &mut vertex, &mut net.triangles);
            }
        }
    }
    net
}

/// Cuts one right-handed tetrahedron: the triangles look to where the field is not below 0.
fn cut(
    [a, b, c, d]: [[i32; 3]; 4],
    inside: [bool; 4],
    vertex: &mut dyn FnMut([i32; 3], [i32; 3]) -> u32,
    triangles: &mut Vec<[u32; 3]>,
) {
    let count = inside.iter().filter(|inside| **inside).count();
    let which = |wanted: bool| inside.iter().position(|inside| *inside == wanted).unwrap_or_default();
    match count {
        1 | 3 => {
            // The lone one first, by a permutation that keeps the tetrahedron right-handed.
            let [p, q, r, s] = [[a, b, c, d], [b, a, d, c], [c, a, b, d], [d, a, c, b]][which(count == 1)];
            let [q, r, s] = [vertex(p, q), vertex(p, r), vertex(p, s)];
            triangles.push(if count == 1 { [q, r, s] } else { [q, s, r] });
        }
        2 => {
            let [p, q, r, s] = match inside {
                [true, true, ..] => [a, b, c, d],
                [true, _, true, _] => [a, c, d, b],
                [true, ..] => [a, d, b, c],
                [_, true, true, _] => [b, c, a, d],
                [_, true, ..] => [b, d, c, a],
                _ => [c, d, a, b],
            };
            let quad = [vertex(p, r), vertex(p, s), vertex(q, s), vertex(q, r)];
            triangles.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
        }
        _ => {}
    }
}

impl Net {
    /// Spreads the vertices evenly over the surface: each towards the middle of its neighbours and back onto it, several times.
    pub(super) fn relax(&mut self, field: &(dyn Fn(DVec3) -> f64 + Sync), times: usize) {
        let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); self.positions.len()];
        for [a, b, c] in &self.triangles {
            // Of a closed surface each edge is run once either way.
            for (from, to) in [(a, b), (b, c), (c, a)] {
                neighbours[*from as usize].push(*to);
            }
        }
        for _ in 0..times {
            let moved = |(v, near): (usize, &Vec<u32>)| {
                let sum = near.iter().fold(DVec3::ZERO, |sum, n| sum + self.positions[*n as usize]);
                let here = self.positions[v];
                onto(field, here + (sum / near.len() as f64 - here) * 0.75)
            };
            self.positions = neighbours.par_iter().enumerate().map(moved).collect();
        }
    }

    /// Moves each vertex outwards by what `relief` says of its place, metres.
    pub(super) fn displace(
        &mut self,
        field: &(dyn Fn(DVec3) -> f64 + Sync),
        relief: &(dyn Fn(DVec3) -> f64 + Sync),
    ) {
        self.positions.par_iter_mut().for_each(|position| {
            let (_, slope) = value_and_slope(field, *position);
            *position += slope / slope.length() * relief(*position);
        });
    }
}

/// A step of Newton's along the slope to where the field is 0.
fn onto(field: &dyn Fn(DVec3) -> f64, p: DVec3) -> DVec3 {
    let (value, slope) = value_and_slope(field, p);
    let steep = slope.dot(slope);
    // Where there is hardly any slope, a step would go anywhere.
    if steep > 0.01 { p - slope * (value / steep) } else { p }
}

/// A field and its slope, from four points around the place.
fn value_and_slope(field: &dyn Fn(DVec3) -> f64, p: DVec3) -> (f64, DVec3) {
    const H: f64 = 1.0 / 65536.0;
    const CORNERS: [DVec3; 4] = [
        DVec3::new(1.0, 1.0, 1.0),
        DVec3::new(1.0, -1.0, -1.0),
        DVec3::new(-1.0, 1.0, -1.0),
        DVec3::new(-1.0, -1.0, 1.0),
    ];
    let [a, b, c, d] = CORNERS.map(|corner| field(p + corner * H));
    let slope = CORNERS[0] * a + CORNERS[1] * b + CORNERS[2] * c + CORNERS[3] * d;
    ((a + b + c + d) * 0.25, slope / (4.0 * H))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Mesh, check};

    fn ring(p: DVec3) -> f64 {
        let r = (p.x * p.x + p.z * p.z).sqrt() - 1.0;
        (r * r + p.y * p.y).sqrt() - 0.4
    }

    fn mesh(net: &Net) -> Mesh {
        Mesh::new(net.positions.iter().map(|p| p.as_vec3().to_array()).collect(), net.triangles.clone())
    }

    #[test]
    fn the_surface_is_closed_faces_out_and_lies_where_the_field_is_zero() {
        let mut net = net(&ring, DVec3::new(-1.61, -0.55, -1.61), DVec3::new(1.6, 0.7, 1.6), 0.1);
        let report = check(&mesh(&net));
        assert!(report.is_solid(), "{:?}", report.faults());
        assert_eq!((report.euler, report.parts), (0, 1));
        net.relax(&ring, 6);
        assert!(net.positions.iter().all(|p| ring(*p).abs() < 1e-3));
        let plain = mesh(&net);
        assert!(check(&plain).is_solid());
        net.displace(&ring, &|_| 0.01);
        assert!(net.positions.iter().all(|p| (ring(*p) - 0.01).abs() < 1e-3));
        let mesh = plain;
        // Volume 2 π² R r², area 4 π² R r.
        let pi = std::f64::consts::PI;
        assert!((mesh.signed_volume() / (2.0 * pi * pi * 0.16) - 1.0).abs() < 0.01);
        assert!((mesh.area() / (4.0 * pi * pi * 0.4) - 1.0).abs() < 0.01);
        // Evenly: no triangle is much smaller than the mean.
        let areas: Vec<f64> = mesh
            .triangles
            .iter()
            .filter_map(|t| mesh.corners(*t))
            .map(|[a, b, c]| (b - a).cross(c - a).length())
            .collect();
        let mean = areas.iter().sum::<f64>() / areas.len() as f64;
        assert!(areas.iter().all(|area| *area > 0.1 * mean));
    }
}
