//! A surface of triangles.

use std::collections::HashMap;

use glam::DVec3;
use sha2::{Digest, Sha256};

/// A surface of triangles that share vertices.
///
/// Anyone may put anything in: what is computed of a triangle whose indices are out of range leaves it out, and [`check()`](crate::check()) counts it.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Vertices, metres: right-handed, y up.
    pub positions: Vec<[f32; 3]>,
    /// Three vertices each, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Unit normals, one a vertex; `None` where the surface's own are to be computed.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Texture coordinates, one a vertex: (0, 0) is the picture's top left corner, (1, 1) its bottom right one.
    pub texture: Option<Vec<[f32; 2]>>,
    /// Albedo per linear sRGB channel, 0 to 1; a texture multiplies it.
    pub base_colour: [f32; 3],
}

impl Default for Mesh {
    fn default() -> Self {
        Mesh {
            positions: Vec::new(),
            triangles: Vec::new(),
            normals: None,
            texture: None,
            base_colour: [1.0; 3],
        }
    }
}

/// The smallest box along the axes, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least coordinates.
    pub min: [f32; 3],
    /// The greatest coordinates.
    pub max: [f32; 3],
}

impl Bounds {
    /// The length of the diagonal, metres.
    pub fn diagonal(&self) -> f64 {
        (vector(self.max) - vector(self.min)).length()
    }
}

impl Mesh {
    /// A mesh of vertices (metres) and triangles alone, white.
    pub fn new(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Mesh {
        Mesh { positions, triangles, ..Mesh::default() }
    }

    /// The corners of a triangle, metres; `None` where an index is out of range.
    pub fn corners(&self, [a, b, c]: [u32; 3]) -> Option<[DVec3; 3]> {
        let corner = |index: u32| self.positions.get(index as usize).map(|position| vector(*position));
        Some([corner(a)?, corner(b)?, corner(c)?])
    }

    /// The box around all vertices, used or not, that are finite; `None` where there are none.
    pub fn bounds(&self) -> Option<Bounds> {
        let finite = |position: &&[f32; 3]| position.iter().all(|x| x.is_finite());
        self.positions.iter().filter(finite).fold(None, |bounds, &position| {
            let Bounds { min, max } = bounds.unwrap_or(Bounds { min: position, max: position });
            let each = |pick: fn(f32, f32) -> f32, of: [f32; 3]| [0, 1, 2].map(|k| pick(of[k], position[k]));
            Some(Bounds { min: each(f32::min, min), max: each(f32::max, max) })
        })
    }

    /// The area of all triangles, square metres.
    pub fn area(&self) -> f64 {
        let corners = self.triangles.iter().filter_map(|triangle| self.corners(*triangle));
        corners.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
    }

    /// The volume that a closed surface encloses, cubic metres; negative where its inside is out.
    pub fn signed_volume(&self) -> f64 {
        // From a corner of the surface's own: far from the origin the tetrahedra would cancel.
        let Some(origin) = self.triangles.iter().find_map(|triangle| self.corners(*triangle)) else {
            return 0.0;
        };
        let corners = self.triangles.iter().filter_map(|triangle| self.corners(*triangle));
        corners.map(|[a, b, c]| [a, b, c].map(|corner| corner - origin[0])).map(six_volumes).sum::<f64>()
            / 6.0
    }

    /// Unit normals of the triangles, by the winding; zero for those that have none.
    pub fn flat_normals(&self) -> Vec<[f32; 3]> {
        let normal = |triangle: &[u32; 3]| {
            let [a, b, c] = self.corners(*triangle)?;
            Some((b - a).cross(c - a).normalize_or_zero().as_vec3().to_array())
        };
        self.triangles.iter().map(|triangle| normal(triangle).unwrap_or_default()).collect()
    }

    /// Unit normals of the vertices: the triangles' own, weighted by their angle there, so that how a face is cut into triangles makes no
    /// difference (Thürmer and Wüthrich 1998). Vertices at one position share one normal; zero for those that have none.
    pub fn smooth_normals(&self) -> Vec<[f32; 3]> {
        let place = welded(&self.positions);
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for triangle in &self.triangles {
            let Some(corners) = self.corners(*triangle) else { continue };
            let [a, b, c] = corners;
            let normal = (b - a).cross(c - a).normalize_or_zero();
            for (k, &vertex) in triangle.iter().enumerate() {
                let (to_next, to_last) =
                    (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
                // `libm`: the same bits on every machine.
                let angle = libm::atan2(to_next.cross(to_last).length(), to_next.dot(to_last));
                sums[place[vertex as usize] as usize] += angle * normal;
            }
        }
        place.iter().map(|&at| sums[at as usize].normalize_or_zero().as_vec3().to_array()).collect()
    }

    /// SHA-256 of all that the mesh is, in hexadecimal: counts and arrays, little-endian.
    pub fn hash(&self) -> String {
        let mut hash = Sha256::new();
        hash.update(b"kelir-mesh/1");
        for count in [self.positions.len(), self.triangles.len()] {
            hash.update((count as u64).to_le_bytes());
        }
        let mut floats =
            |values: &[f32]| values.iter().for_each(|value| hash.update(value.to_bits().to_le_bytes()));
        floats(self.positions.as_flattened());
        floats(&self.base_colour);
        floats(self.normals.as_deref().unwrap_or_default().as_flattened());
        floats(self.texture.as_deref().unwrap_or_default().as_flattened());
        hash.update([u8::from(self.normals.is_some()), u8::from(self.texture.is_some())]);
        self.triangles.as_flattened().iter().for_each(|index| hash.update(index.to_le_bytes()));
        hex::encode(hash.finalize())
    }
}

/// SHA-256 of bytes, in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    hex::encode(Sha256::digest(bytes))
}

/// In f64, where sums and products of coordinates are all but exact.
pub(crate) fn vector(position: [f32; 3]) -> DVec3 {
    DVec3::from_array(position.map(f64::from))
}

/// Six times the signed volume of the tetrahedron from the origin.
pub(crate) fn six_volumes([a, b, c]: [DVec3; 3]) -> f64 {
    a.dot(b.cross(c))
}

/// For each vertex the first one at its position; −0 is 0, and what is not a number is at no other's.
pub(crate) fn welded(positions: &[[f32; 3]]) -> Vec<u32> {
    let mut first = HashMap::with_capacity(positions.len());
    let place = |(index, position): (usize, &[f32; 3])| {
        let index = index as u32;
        if position.iter().any(|x| x.is_nan()) {
            return index;
        }
        *first.entry(position.map(|x| (x + 0.0).to_bits())).or_insert(index)
    };
    positions.iter().enumerate().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{cube, tetrahedron};

    #[test]
    fn a_cube_has_its_area_volume_and_box() {
        let cube = cube();
        assert_eq!((cube.area(), cube.signed_volume()), (6.0, 1.0));
        assert_eq!(cube.bounds(), Some(Bounds { min: [0.0; 3], max: [1.0; 3] }));
        assert_eq!(cube.bounds().map(|b| b.diagonal()), Some(3f64.sqrt()));
        assert_eq!(Mesh::default().bounds(), None);
        // Inside out, and far away: the volume of what is near is not lost.
        let mut far = cube.clone();
        far.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
        far.positions.iter_mut().for_each(|position| position[0] += 1e6);
        assert_eq!(far.signed_volume(), -1.0);
    }

    #[test]
    fn normals_are_weighted_by_angle_and_not_by_how_faces_are_cut() {
        // Each corner of a cube lies in 1 or 2 triangles of a face, with a right angle in all: the normal is the diagonal.
        let cube = cube();
        let third = 1.0 / 3f64.sqrt();
        for (normal, position) in cube.smooth_normals().iter().zip(&cube.positions) {
            for k in 0..3 {
                let expected = if position[k] == 1.0 { third } else { -third };
                assert!((f64::from(normal[k]) - expected).abs() < 1e-7, "{normal:?}");
            }
        }
        // Negative control: weighted by area (the sum of cross products), two corners in three are not.
        let by_area = |vertex: u32| {
            let triangles = cube.triangles.iter().filter(|triangle| triangle.contains(&vertex));
            let corners = triangles.filter_map(|triangle| cube.corners(*triangle));
            corners.map(|[a, b, c]| (b - a).cross(c - a)).sum::<DVec3>().normalize()
        };
        assert!((0..8).any(|vertex| (by_area(vertex).abs() - DVec3::splat(third)).length() > 0.1));
    }

    #[test]
    fn vertices_at_one_position_share_a_normal() {
        let mut apart = tetrahedron();
        let corners: Vec<_> =
            apart.triangles.iter().flatten().map(|index| apart.positions[*index as usize]).collect();
        let whole: Vec<_> = {
            let normals = apart.smooth_normals();
            apart.triangles.iter().flatten().map(|index| normals[*index as usize]).collect()
        };
        apart.positions = corners;
        apart.triangles = (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        assert_eq!(apart.smooth_normals(), whole);
        let flat = apart.flat_normals();
        assert_ne!(flat[0], whole[0]);
        assert_eq!(flat.len(), 4);
    }

    #[test]
    fn what_is_out_of_range_counts_nothing() {
        let mut mesh = cube();
        mesh.triangles.push([0, 1, 99]);
        mesh.positions.push([f32::NAN, 0.0, 0.0]);
        assert_eq!((mesh.area(), mesh.signed_volume()), (6.0, 1.0));
        assert_eq!(mesh.bounds(), cube().bounds());
        assert_eq!(mesh.flat_normals()[12], [0.0; 3]);
        assert_eq!(mesh.smooth_normals()[8], [0.0; 3]);
    }

    #[test]
    fn every_field_is_in_the_hash() {
        let cube = cube();
        let changes: [fn(&mut Mesh); 5] = [
            |m| m.positions[0][0] = -0.0,
            |m| m.triangles[0].rotate_left(1),
            |m| m.normals = Some(Vec::new()),
            |m| m.texture = Some(Vec::new()),
            |m| m.base_colour[2] = 0.5,
        ];
        for change in changes {
            let mut changed = cube.clone();
            change(&mut changed);
            assert_ne!(changed.hash(), cube.hash());
        }
    }
}
