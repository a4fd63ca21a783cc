//! What is wrong with a mesh, counted.

use serde::Serialize;

use crate::topology::{Sets, Side, Topology, is_drawable, is_flat};
use crate::{Mesh, Model};

/// What a mesh is like. Vertices at one position are one for all that is said of edges, fans and parts: files split them where a texture or
/// a normal has a seam, and the surface has none there.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Report {
    /// Vertices.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Triangles with an index that no vertex has.
    pub out_of_range: usize,
    /// Vertices with a coordinate that is not a number, or infinite.
    pub not_finite: usize,
    /// Triangles whose corners lie on a line or at a point.
    pub zero_area: usize,
    /// Triangles with the three corners of an earlier one, either way round.
    pub duplicates: usize,
    /// Edges with one face.
    pub boundary_edges: usize,
    /// Edges with more than two faces.
    pub crowded_edges: usize,
    /// Edges whose two faces run along them the same way: one of them is inside out.
    pub inconsistent_edges: usize,
    /// Vertices whose faces make more than one fan: surfaces that touch at a point.
    pub pinched_vertices: usize,
    /// Vertices at the position of an earlier one.
    pub coincident_vertices: usize,
    /// Vertices that no triangle has.
    pub unused_vertices: usize,
    /// Pieces that share no vertex.
    pub parts: usize,
    /// Parts that are closed and wound alike, and whose inside is out: their signed volume is negative.
    pub inward_parts: usize,
    /// Vertices − edges + faces: 2 for each part like a sphere, 0 like a torus.
    pub euler: i64,
    /// Every edge has two faces at least.
    pub closed: bool,
}

impl Report {
    fn counts(&mut self) -> [&mut usize; 14] {
        [
            &mut self.vertices,
            &mut self.triangles,
            &mut self.out_of_range,
            &mut self.not_finite,
            &mut self.zero_area,
            &mut self.duplicates,
            &mut self.boundary_edges,
            &mut self.crowded_edges,
            &mut self.inconsistent_edges,
            &mut self.pinched_vertices,
            &mut self.coincident_vertices,
            &mut self.unused_vertices,
            &mut self.parts,
            &mut self.inward_parts,
        ]
    }

    /// Whether every triangle can be drawn: indices in range, positions finite, an area.
    pub fn is_drawable(&self) -> bool {
        self.triangles > 0 && self.out_of_range + self.not_finite + self.zero_area == 0
    }

    /// Whether edges have one or two faces that run along them opposite ways, and vertices one fan.
    pub fn is_manifold(&self) -> bool {
        self.duplicates + self.crowded_edges + self.inconsistent_edges + self.pinched_vertices == 0
    }

    /// Whether it is the surface of a solid: drawable, manifold, closed, its outside out.
    pub fn is_solid(&self) -> bool {
        self.is_drawable() && self.is_manifold() && self.closed && self.inward_parts == 0
    }

    /// What is wrong, each with its count: `3 zero-area faces`. An edge that bounds the surface and vertices that are not used are no faults.
    pub fn faults(&self) -> Vec<String> {
        self.faults_beyond(&Report::default())
    }

    /// What is wrong here more often than there.
    pub(crate) fn faults_beyond(&self, other: &Report) -> Vec<String> {
        let more = self
            .fault_counts()
            .into_iter()
            .zip(other.fault_counts())
            .filter(|(here, there)| here.0 > there.0);
        let mut faults: Vec<String> = more
            .map(|((count, one, many), _)| format!("{count} {}", if count == 1 { one } else { many }))
            .collect();
        if self.triangles == 0 {
            faults.push("no triangles".to_owned());
        }
        faults
    }

    fn fault_counts(&self) -> [(usize, &'static str, &'static str); 8] {
        [
            (
                self.out_of_range,
                "triangle with an index out of range",
                "triangles with an index out of range",
            ),
            (self.not_finite, "vertex that is not finite", "vertices that are not finite"),
            (self.zero_area, "zero-area face", "zero-area faces"),
            (self.duplicates, "duplicate face", "duplicate faces"),
            (self.crowded_edges, "edge with more than two faces", "edges with more than two faces"),
            (self.inconsistent_edges, "edge between faces wound apart", "edges between faces wound apart"),
            (self.pinched_vertices, "vertex with more than one fan", "vertices with more than one fan"),
            (self.inward_parts, "part inside out", "parts inside out"),
        ]
    }
}

/// Looks at each part of a model where it rests, one by one: parts may touch. Counts add up.
pub fn check_model(model: &Model) -> Report {
    let parts = model.posed(&model.rest());
    let mut reports = parts.iter().map(|(_, mesh)| check(mesh));
    let Some(mut sum) = reports.next() else { return Report::default() };
    for report in reports {
        sum.closed &= report.closed;
        sum.euler += report.euler;
        for (sum, more) in sum.counts().into_iter().zip(report.clone().counts()) {
            *sum += *more;
        }
    }
    sum
}

/// Looks at everything, whatever the mesh holds.
pub fn check(mesh: &Mesh) -> Report {
    let topology = Topology::of(mesh);
    let count = mesh.positions.len();
    let in_range = |triangle: &&[u32; 3]| triangle.iter().all(|index| (*index as usize) < count);
    let mut used = vec![false; count];
    mesh.triangles.iter().filter(in_range).flatten().for_each(|index| used[*index as usize] = true);
    let is_zero = |triangle: &&[u32; 3]| is_drawable(mesh, **triangle) && is_flat(mesh, **triangle);
    let mut report = Report {
        vertices: count,
        triangles: mesh.triangles.len(),
        out_of_range: mesh.triangles.len() - mesh.triangles.iter().filter(in_range).count(),
        not_finite: mesh.positions.iter().filter(|p| p.iter().any(|x| !x.is_finite())).count(),
        zero_area: mesh.triangles.iter().filter(is_zero).count(),
        duplicates: duplicates(&topology),
        coincident_vertices: topology.place.iter().enumerate().filter(|(v, at)| *v != **at as usize).count(),
        unused_vertices: used.iter().filter(|used| !**used).count(),
        closed: !topology.faces.is_empty(),
        ..Report::default()
    };
    edges(&topology, &mut report);
    vertices(mesh, &topology, &mut report);
    report
}

/// Faces with the places of an earlier one: they have its edge of the two lowest places, and its third.
fn duplicates(topology: &Topology) -> usize {
    let mut thirds = Vec::new();
    let mut count = 0;
    for edge in topology.edges().filter(|edge| edge.len() > 1) {
        let [_, high] = edge[0].ends;
        let third = |side: &Side| topology.corners[side.face as usize].into_iter().max();
        thirds.clear();
        thirds.extend(edge.iter().filter_map(third).filter(|third| *third > high));
        thirds.sort_unstable();
        count += thirds.windows(2).filter(|pair| pair[0] == pair[1]).count();
    }
    count
}

fn edges(topology: &Topology, report: &mut Report) {
    for edge in topology.edges() {
        report.euler -= 1;
        match edge {
            [_] => {
                report.boundary_edges += 1;
                report.closed = false;
            }
            [a, b] => report.inconsistent_edges += usize::from(a.upwards == b.upwards),
            _ => report.crowded_edges += 1,
        }
    }
}

fn vertices(mesh: &Mesh, topology: &Topology, report: &mut Report) {
    // A fan is the corners at one place that edges hold together; a part what places hold together.
    let mut fans = Sets::new(3 * topology.corners.len());
    let mut parts = Sets::new(mesh.positions.len());
    let corner = |face: u32, place: u32| {
        let k = topology.corners[face as usize].iter().position(|corner| *corner == place);
        3 * face + k.unwrap_or_default() as u32
    };
    for edge in topology.edges() {
        let [low, high] = edge[0].ends;
        parts.unite(low, high);
        for side in &edge[1..] {
            fans.unite(corner(edge[0].face, low), corner(side.face, low));
            fans.unite(corner(edge[0].face, high), corner(side.face, high));
        }
    }
    let mut fans_at = vec![0u32; mesh.positions.len()];
    for (c, place) in topology.corners.as_flattened().iter().enumerate() {
        fans_at[*place as usize] += u32::from(fans.of(c as u32) == c as u32);
    }
    report.pinched_vertices = fans_at.iter().filter(|fans| **fans > 1).count();
    report.euler += fans_at.iter().filter(|fans| **fans > 0).count() as i64 + topology.faces.len() as i64;
    // What is open or wound apart has no outside.
    let mut whole = vec![true; mesh.positions.len()];
    for edge in topology.edges() {
        let upwards = edge.iter().filter(|side| side.upwards).count();
        whole[parts.of(edge[0].ends[0]) as usize] &= 2 * upwards == edge.len();
    }
    let mut volumes = vec![0.0; mesh.positions.len()];
    for (&face, corners) in topology.faces.iter().zip(&topology.corners) {
        let part = parts.of(corners[0]) as usize;
        // From a corner of the part's own: the set's name is one of its vertices.
        let origin = crate::mesh::vector(mesh.positions[part]);
        if let Some(corners) = mesh.corners(mesh.triangles[face as usize]) {
            volumes[part] += crate::mesh::six_volumes(corners.map(|corner| corner - origin));
        }
    }
    for place in (0..mesh.positions.len()).filter(|v| fans_at[*v] > 0) {
        if parts.of(place as u32) as usize == place {
            report.parts += 1;
            report.inward_parts += usize::from(whole[place] && volumes[place] < 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{cube, joined, mobius, moved, tetrahedron, torus};

    #[test]
    fn closed_shapes_are_solid_and_have_their_euler_number() {
        for (mesh, vertices, triangles, euler) in
            [(tetrahedron(), 4, 4, 2), (cube(), 8, 12, 2), (torus(12, 8), 96, 192, 0)]
        {
            let expected = Report { vertices, triangles, parts: 1, euler, closed: true, ..Report::default() };
            assert_eq!(check(&mesh), expected);
            assert!(check(&mesh).is_solid() && check(&mesh).faults().is_empty());
        }
    }

    #[test]
    fn an_open_cube_has_a_boundary_and_is_no_solid() {
        let mut mesh = cube();
        mesh.triangles.truncate(10);
        let report = check(&mesh);
        assert_eq!((report.boundary_edges, report.closed, report.euler, report.parts), (4, false, 1, 1));
        assert!(report.is_manifold() && !report.is_solid());
    }

    #[test]
    fn a_mobius_strip_has_one_edge_where_its_faces_disagree() {
        // 2 · n vertices, 2 · n faces, 4 · n edges of which 2 · n are one boundary.
        let report = check(&mobius(16));
        assert_eq!((report.euler, report.boundary_edges, report.inconsistent_edges), (0, 32, 1));
        assert_eq!((report.parts, report.crowded_edges, report.pinched_vertices), (1, 0, 0));
        assert!(!report.is_manifold());
    }

    #[test]
    fn cubes_that_touch_are_told_by_where() {
        let apart = check(&joined(&[cube(), moved(cube(), [3.0, 0.0, 0.0])]));
        assert_eq!((apart.parts, apart.euler, apart.is_solid()), (2, 4, true));
        // At the vertex (1, 1, 1).
        let vertex = check(&joined(&[cube(), moved(cube(), [1.0, 1.0, 1.0])]));
        assert_eq!((vertex.pinched_vertices, vertex.crowded_edges, vertex.parts), (1, 0, 1));
        assert_eq!((vertex.coincident_vertices, vertex.euler, vertex.closed), (1, 3, true));
        assert!(!vertex.is_manifold());
        // Along the edge from (1, 1, 0) to (1, 1, 1): its ends have one fan, through the edge.
        let edge = check(&joined(&[cube(), moved(cube(), [1.0, 1.0, 0.0])]));
        assert_eq!((edge.pinched_vertices, edge.crowded_edges, edge.parts, edge.closed), (0, 1, 1, true));
        assert_eq!(edge.faults(), ["1 edge with more than two faces"]);
    }

    #[test]
    fn faces_and_vertices_that_are_wrong_are_counted() {
        let mut mesh = cube();
        mesh.positions.extend([[0.5, 0.0, 0.0], [f32::NAN, 0.0, 0.0], [0.0, f32::INFINITY, 0.0], [7.0; 3]]);
        mesh.triangles.extend([
            [0, 8, 1],        // On a line.
            [0, 0, 1],        // At two points.
            [0, 1, 9],        // Not finite.
            [10, 1, 2],       // Not finite.
            [0, 1, 99],       // Out of range.
            [u32::MAX, 0, 1], // Out of range.
        ]);
        // The first face again, the other way round.
        mesh.triangles.push([0, 3, 2]);
        let report = check(&mesh);
        let counts = [
            report.zero_area,
            report.not_finite,
            report.out_of_range,
            report.duplicates,
            report.unused_vertices,
        ];
        assert_eq!(counts, [2, 2, 2, 1, 1]);
        assert!(!report.is_drawable());
        assert_eq!(report.faults()[0], "2 triangles with an index out of range");
        assert_eq!(check(&Mesh::default()).faults(), ["no triangles"]);
    }

    #[test]
    fn a_face_turned_round_and_a_part_inside_out_are_seen() {
        let mut turned = cube();
        turned.triangles[3].swap(0, 1);
        assert_eq!(check(&turned).inconsistent_edges, 3);
        let mut inward = cube();
        inward.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
        let two = joined(&[moved(inward, [1e5, 0.0, 0.0]), cube()]);
        let report = check(&two);
        assert_eq!((report.inward_parts, report.parts, report.inconsistent_edges), (1, 2, 0));
        assert!(report.is_manifold() && !report.is_solid());
    }

    #[test]
    fn parts_of_a_model_are_looked_at_one_by_one() {
        let mut model = Model::from(cube());
        model.nodes.push(model.nodes[0].clone());
        model.nodes[1].rest.translation.x = 1.0;
        // As one mesh the two have a face in common.
        assert!(!check(&model.merged(&model.rest())).is_manifold());
        let report = check_model(&model);
        assert!(report.is_solid());
        assert_eq!((report.parts, report.triangles, report.euler), (2, 24, 4));
        assert_eq!(check_model(&Model::default()).faults(), ["no triangles"]);
    }

    #[test]
    fn a_seam_of_a_texture_is_no_edge_of_the_surface() {
        let cube = cube();
        let split: Vec<_> =
            cube.triangles.iter().flatten().map(|index| cube.positions[*index as usize]).collect();
        let soup = Mesh::new(split, (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect());
        let report = check(&soup);
        assert!(report.is_solid());
        assert_eq!((report.coincident_vertices, report.euler), (28, 2));
    }
}
