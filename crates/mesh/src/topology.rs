//! Which triangles meet where: what checking and repairing ask.

use crate::Mesh;
use crate::mesh::welded;

/// A side of a triangle, between two places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Side {
    /// The places at its ends, the lower first.
    pub ends: [u32; 2],
    /// The triangle, as [`Topology::faces`] counts.
    pub face: u32,
    /// Whether the triangle runs from the lower end to the higher.
    pub upwards: bool,
}

/// Triangles and their edges, vertices at one position being one place.
pub(crate) struct Topology {
    /// For each vertex the first one at its position.
    pub place: Vec<u32>,
    /// Of the mesh's triangles those with three places, all of them in range and finite.
    pub faces: Vec<u32>,
    /// The faces' places.
    pub corners: Vec<[u32; 3]>,
    /// All sides, those of one edge together.
    pub sides: Vec<Side>,
}

impl Topology {
    pub(crate) fn of(mesh: &Mesh) -> Topology {
        let place = welded(&mesh.positions);
        let (mut faces, mut corners) = (Vec::new(), Vec::new());
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            if !is_drawable(mesh, *triangle) {
                continue;
            }
            let [a, b, c] = triangle.map(|index| place[index as usize]);
            if a != b && b != c && c != a {
                faces.push(t as u32);
                corners.push([a, b, c]);
            }
        }
        let sides = by_edge(&corners, mesh.positions.len());
        Topology { place, faces, corners, sides }
    }

    /// The edges: of each all its sides.
    pub(crate) fn edges(&self) -> impl Iterator<Item = &[Side]> {
        self.sides.chunk_by(|a, b| a.ends == b.ends)
    }
}

/// The sides of all faces, sorted: put into a row for each lower end, which are then short.
fn by_edge(corners: &[[u32; 3]], places: usize) -> Vec<Side> {
    let side = |face: usize, from: u32, to: u32| Side {
        ends: [from.min(to), from.max(to)],
        face: face as u32,
        upwards: from < to,
    };
    let all = || {
        let faces = corners.iter().enumerate();
        faces.flat_map(|(f, &[a, b, c])| [side(f, a, b), side(f, b, c), side(f, c, a)])
    };
    let mut next = vec![0; places + 1];
    all().for_each(|side| next[side.ends[0] as usize + 1] += 1);
    (0..places).for_each(|place| next[place + 1] += next[place]);
    let mut sides = vec![side(0, 0, 0); 3 * corners.len()];
    for side in all() {
        let at = &mut next[side.ends[0] as usize];
        sides[*at] = side;
        *at += 1;
    }
    sides.chunk_by_mut(|a, b| a.ends[0] == b.ends[0]).for_each(<[Side]>::sort_unstable);
    sides
}

/// Whether all three indices are in range and their positions finite.
pub(crate) fn is_drawable(mesh: &Mesh, triangle: [u32; 3]) -> bool {
    mesh.corners(triangle).is_some_and(|corners| corners.iter().all(|corner| corner.is_finite()))
}

/// Whether a triangle's corners, in range and finite, lie on a line.
pub(crate) fn is_flat(mesh: &Mesh, triangle: [u32; 3]) -> bool {
    // Differences of f32 are exact in f64 but for extreme ranges, and so are all but the last bits of their products.
    mesh.corners(triangle).is_some_and(|[a, b, c]| (b - a).cross(c - a) == glam::DVec3::ZERO)
}

/// Sets that are united two by two.
pub(crate) struct Sets(Vec<u32>);

impl Sets {
    pub(crate) fn new(count: usize) -> Sets {
        Sets((0..count as u32).collect())
    }

    /// The set's name: one of its members.
    pub(crate) fn of(&mut self, member: u32) -> u32 {
        let mut at = member;
        while self.0[at as usize] != at {
            let above = self.0[at as usize];
            self.0[at as usize] = self.0[above as usize];
            at = above;
        }
        at
    }

    pub(crate) fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.of(a), self.of(b));
        // The lower name stays: which is which does not depend on the order of unions.
        self.0[a.max(b) as usize] = a.min(b);
    }
}
