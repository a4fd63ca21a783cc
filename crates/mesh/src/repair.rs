//! A mesh made sound, as far as that can be done without guessing at its shape.

use std::collections::{HashMap, HashSet};

use serde::Serialize;

use crate::mesh::{six_volumes, vector, welded};
use crate::topology::{Topology, is_drawable, is_flat};
use crate::{Mesh, Model};

/// What was done, in this order.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Repaired {
    /// Triangles dropped that named no vertex, or one that is not finite.
    pub undrawable: usize,
    /// Vertices joined with an earlier one at the same position (and of the same texture coordinates).
    pub welded: usize,
    /// Triangles dropped that had no area.
    pub zero_area: usize,
    /// Triangles dropped that had the corners of an earlier one.
    pub duplicates: usize,
    /// Vertices dropped that no triangle had.
    pub unused: usize,
    /// Triangles turned so that neighbours agree which side is out.
    pub turned: usize,
    /// Pieces turned as a whole: they enclosed a negative volume.
    pub turned_pieces: usize,
    /// Pieces that have only one side, as a Möbius strip; their triangles stay as they were.
    pub one_sided: usize,
}

impl Repaired {
    fn counts(&mut self) -> [&mut usize; 8] {
        [
            &mut self.undrawable,
            &mut self.welded,
            &mut self.zero_area,
            &mut self.duplicates,
            &mut self.unused,
            &mut self.turned,
            &mut self.turned_pieces,
            &mut self.one_sided,
        ]
    }

    /// What was done, each with its count; empty where nothing was.
    pub fn list(&self) -> Vec<String> {
        let counts = [
            (self.undrawable, "triangles without finite vertices dropped"),
            (self.welded, "vertices welded"),
            (self.zero_area, "zero-area faces dropped"),
            (self.duplicates, "duplicate faces dropped"),
            (self.unused, "unused vertices dropped"),
            (self.turned, "faces turned to agree with their neighbours"),
            (self.turned_pieces, "pieces turned inside out"),
            (self.one_sided, "one-sided pieces left as they are"),
        ];
        counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect()
    }
}

/// Welds vertices at the same position, drops what can't be drawn, has no area, is there twice or is not used, and winds triangles alike,
/// each closed piece outwards. Holes, edges with more than two faces and vertices with more than one fan stay. Normals are dropped where
/// anything but unused vertices was wrong: they were of another surface. A cavity within a body is turned outwards too.
pub fn repair(mesh: &mut Mesh) -> Repaired {
    let mut done = Repaired::default();
    let drop = |mesh: &mut Mesh, count: &mut usize, keep: &mut dyn FnMut(&Mesh, [u32; 3]) -> bool| {
        let triangles = std::mem::take(&mut mesh.triangles);
        *count = triangles.len();
        mesh.triangles = triangles.into_iter().filter(|triangle| keep(mesh, *triangle)).collect();
        *count -= mesh.triangles.len();
    };
    drop(mesh, &mut done.undrawable, &mut |mesh, triangle| is_drawable(mesh, triangle));
    done.welded = weld(mesh);
    drop(mesh, &mut done.zero_area, &mut |mesh, triangle| !is_flat(mesh, triangle));
    let place = welded(&mesh.positions);
    let mut seen = HashSet::new();
    drop(mesh, &mut done.duplicates, &mut |_, triangle| {
        let mut places = triangle.map(|index| place[index as usize]);
        places.sort_unstable();
        seen.insert(places)
    });
    wind(mesh, &mut done);
    if done != Repaired::default() {
        mesh.normals = None;
    }
    done.unused = drop_unused(mesh) - done.welded;
    done
}

/// Repairs each part of a model by itself; one whose vertices follow a skin keeps them all, and is only wound.
pub fn repair_model(model: &mut Model) -> Repaired {
    let mut sum = Repaired::default();
    for part in model.nodes.iter_mut().flat_map(|node| &mut node.parts) {
        let mut done = Repaired::default();
        match part.weights {
            None => done = repair(&mut part.mesh),
            Some(_) => wind(&mut part.mesh, &mut done),
        }
        for (sum, more) in sum.counts().into_iter().zip(done.counts()) {
            *sum += *more;
        }
    }
    sum
}

/// Joins vertices of one position and texture coordinates; answers how many of them no triangle has any longer.
pub(crate) fn weld(mesh: &mut Mesh) -> usize {
    let place = welded(&mesh.positions);
    let mut first = HashMap::new();
    let mut joined = 0;
    let to: Vec<u32> = (0..mesh.positions.len())
        .map(|v| {
            let texture = mesh.texture.as_ref().map(|texture| texture[v].map(|x| (x + 0.0).to_bits()));
            let to = *first.entry((place[v], texture)).or_insert(v as u32);
            joined += usize::from(to != v as u32);
            to
        })
        .collect();
    mesh.triangles.as_flattened_mut().iter_mut().for_each(|index| *index = to[*index as usize]);
    joined
}

/// Drops vertices that no triangle has; answers how many.
pub(crate) fn drop_unused(mesh: &mut Mesh) -> usize {
    let mut used = vec![false; mesh.positions.len()];
    mesh.triangles.as_flattened().iter().for_each(|index| used[*index as usize] = true);
    let mut to = vec![0; used.len()];
    let mut kept = 0;
    for (v, used) in used.iter().enumerate() {
        to[v] = kept;
        kept += u32::from(*used);
    }
    let count = used.len() - kept as usize;
    fn keep<T>(list: &mut Vec<T>, used: &[bool]) {
        let mut used = used.iter();
        list.retain(|_| used.next().copied().unwrap_or_default());
    }
    keep(&mut mesh.positions, &used);
    mesh.normals.iter_mut().for_each(|normals| keep(normals, &used));
    mesh.texture.iter_mut().for_each(|texture| keep(texture, &used));
    mesh.triangles.as_flattened_mut().iter_mut().for_each(|index| *index = to[*index as usize]);
    count
}

/// Winds each piece, held together by edges of two faces, alike: as most of it was, or outwards where no edge of it ends the surface.
fn wind(mesh: &mut Mesh, done: &mut Repaired) {
    let topology = Topology::of(mesh);
    let count = topology.faces.len();
    // For each face its neighbours over edges of two, and whether both run the same way.
    let mut neighbours: Vec<Vec<(u32, bool)>> = vec![Vec::new(); count];
    let mut open = vec![false; count];
    for edge in topology.edges() {
        match edge {
            [a, b] => {
                let apart = a.upwards == b.upwards;
                neighbours[a.face as usize].push((b.face, apart));
                neighbours[b.face as usize].push((a.face, apart));
            }
            [side] => open[side.face as usize] = true,
            _ => {}
        }
    }
    let mut turn: Vec<Option<bool>> = vec![None; count];
    for first in 0..count {
        if turn[first].is_some() {
            continue;
        }
        turn[first] = Some(false);
        let (mut piece, mut next, mut one_sided) = (vec![first as u32], 0, false);
        while let Some(&face) = piece.get(next) {
            next += 1;
            let turned = turn[face as usize] == Some(true);
            for &(neighbour, apart) in &neighbours[face as usize] {
                match turn[neighbour as usize] {
                    Some(known) => one_sided |= known != (turned ^ apart),
                    None => {
                        turn[neighbour as usize] = Some(turned ^ apart);
                        piece.push(neighbour);
                    }
                }
            }
        }
        if one_sided {
            done.one_sided += 1;
            piece.iter().for_each(|face| turn[*face as usize] = Some(false));
            continue;
        }
        let is_turned = |face: &&u32| turn[**face as usize] == Some(true);
        let turned = piece.iter().filter(is_turned).count();
        let closed = !piece.iter().any(|face| open[*face as usize]);
        let origin =
            mesh.corners(topology_corners(mesh, &topology, piece[0])).map_or(vector([0.0; 3]), |[a, ..]| a);
        let volume: f64 = piece
            .iter()
            .filter_map(|face| {
                let corners = mesh.corners(topology_corners(mesh, &topology, *face))?;
                let volume = six_volumes(corners.map(|corner| corner - origin));
                Some(if is_turned(&face) { -volume } else { volume })
            })
            .sum();
        let whole = if closed { volume < 0.0 } else { 2 * turned > piece.len() };
        // Turned as a whole, what had to be turned is what had not.
        match (closed && whole, turned) {
            (true, 0) => done.turned_pieces += 1,
            _ => done.turned += if whole { piece.len() - turned } else { turned },
        }
        piece
            .iter()
            .for_each(|face| turn[*face as usize] = turn[*face as usize].map(|turned| turned ^ whole));
    }
    for (face, turn) in topology.faces.iter().zip(turn) {
        if turn == Some(true) {
            mesh.triangles[*face as usize].swap(1, 2);
        }
    }
}

fn topology_corners(mesh: &Mesh, topology: &Topology, face: u32) -> [u32; 3] {
    mesh.triangles[topology.faces[face as usize] as usize]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check;
    use crate::shapes::{cube, joined, mobius, moved, tetrahedron, torus};

    #[test]
    fn what_is_sound_stays_as_it_is() {
        for mesh in
            [tetrahedron(), cube(), torus(9, 7), Mesh { normals: Some(cube().smooth_normals()), ..cube() }]
        {
            let mut same = mesh.clone();
            assert_eq!(repair(&mut same), Repaired::default());
            assert_eq!(same, mesh);
        }
    }

    #[test]
    fn a_heap_of_damage_becomes_a_cube() {
        let cube = cube();
        let split: Vec<_> =
            cube.triangles.iter().flatten().map(|index| cube.positions[*index as usize]).collect();
        let mut mesh = Mesh::new(split, (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect());
        mesh.normals = Some(vec![[0.0, 0.0, 1.0]; 36]);
        mesh.positions.extend([[9.0; 3], [f32::NAN; 3]]);
        mesh.normals.iter_mut().for_each(|normals| normals.extend([[0.0, 0.0, 1.0]; 2]));
        mesh.triangles.extend([[0, 0, 1], [0, 1, 37], [5, 6, 400], [2, 1, 0]]);
        for turned in [1, 4, 7] {
            mesh.triangles[turned].swap(0, 1);
        }
        let done = repair(&mut mesh);
        let expected = Repaired {
            undrawable: 2,
            welded: 28,
            zero_area: 1,
            duplicates: 1,
            unused: 2,
            turned: 3,
            ..Repaired::default()
        };
        assert_eq!(done, expected);
        assert!(check(&mesh).is_solid(), "{:?}", check(&mesh));
        assert_eq!((mesh.positions.len(), mesh.signed_volume(), mesh.normals), (8, 1.0, None));
        assert_eq!(done.list()[0], "2 triangles without finite vertices dropped");
    }

    #[test]
    fn pieces_are_turned_outwards_each_for_itself() {
        let mut inward = torus(8, 6);
        inward.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
        let mut mesh = joined(&[cube(), moved(inward, [50.0, 0.0, 0.0])]);
        let done = repair(&mut mesh);
        assert_eq!(done, Repaired { turned_pieces: 1, ..Repaired::default() });
        assert!(check(&mesh).is_solid());
        // Cubes that share an edge are two pieces.
        let mut inward = moved(cube(), [1.0, 1.0, 0.0]);
        inward.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
        let mut mesh = joined(&[cube(), inward]);
        assert_eq!(repair(&mut mesh).turned_pieces, 1);
        assert_eq!(mesh.signed_volume(), 2.0);
    }

    #[test]
    fn an_open_piece_is_wound_as_most_of_it_was() {
        let mut mesh = torus(10, 6);
        mesh.triangles.truncate(40);
        let plain = mesh.clone();
        // The first among those turned: its winding decides nothing.
        (0..5).for_each(|t| mesh.triangles[t].swap(1, 2));
        let done = repair(&mut mesh);
        assert_eq!(done.turned, 5);
        assert_eq!(mesh.triangles, plain.triangles);
    }

    #[test]
    fn one_side_stays_one_side() {
        let mut strip = mobius(12);
        let plain = strip.clone();
        assert_eq!(repair(&mut strip), Repaired { one_sided: 1, ..Repaired::default() });
        assert_eq!(strip.triangles, plain.triangles);
    }

    #[test]
    fn a_seam_of_a_texture_is_kept() {
        let mut mesh = joined(&[cube(), cube()]);
        mesh.texture = Some((0..16).map(|v| [if v < 8 { 0.0 } else { 1.0 }, 0.0]).collect());
        mesh.triangles.truncate(12);
        (6..12).for_each(|t| mesh.triangles[t] = mesh.triangles[t].map(|index| index + 8));
        let done = repair(&mut mesh);
        assert_eq!((done.welded, done.turned), (0, 0));
        assert!(check(&mesh).is_solid());
    }
}
