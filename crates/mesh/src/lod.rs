//! Levels of detail: the same surface with fewer triangles.

use std::time::{Duration, Instant};

use meshopt::{SimplifyOptions, simplify_with_update};

use crate::mesh::sha256;
use crate::repair::{drop_unused, weld};
use crate::{Mesh, Report, check};

/// Counts the changes of what [`levels`] makes of a mesh: what was made under another is made anew.
const REVISION: u32 = 1;

/// What guides the simplification beside the positions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Attributes {
    /// Nothing: the surface's shape alone.
    #[default]
    None,
    /// The shading normals, too.
    Normals,
}

/// How much the normals count against positions, which are shares of the mesh's extent.
const NORMAL_WEIGHT: f32 = 0.1;
/// The same of texture coordinates: they follow the positions, and seldom decide.
const TEXTURE_WEIGHT: f32 = 0.05;

/// The last stretch to a target is one of these shares of it: a half, …
const STRETCHES: [usize; 4] = [2, 3, 5, 9];
/// … and is gone so many times at most.
const TRIES: usize = 12;
/// A mesh of more triangles is not simplified again and again as a whole: that takes long.
const CHEAP: usize = 16_384;

/// One level.
#[derive(Clone, Debug)]
pub struct Level {
    /// The mesh, without normals: they are its own.
    pub mesh: Mesh,
    /// Triangles that were asked for.
    pub target: usize,
    /// Why there are not as many as were asked for.
    pub missed: Option<Missed>,
    /// What it is like.
    pub report: Report,
    /// What of how the first surface hung together it has lost, each as a few words: faults, holes, parts, tunnels.
    pub lost: Vec<String>,
    /// What the simplification took, from the level before it.
    pub took: Duration,
}

/// Why a level has another number of triangles than was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missed {
    /// One less: an edge that is collapsed takes two triangles with it, and a closed surface has an even number.
    Pair,
    /// A few more or less: with as many, the surface did not hang together as the first one does.
    Topology,
}

impl Missed {
    /// The reason, as part of a sentence.
    pub fn reason(self) -> &'static str {
        match self {
            Missed::Pair => "an edge that is collapsed takes two triangles with it",
            Missed::Topology => "with as many, it did not hang together as the first surface does",
        }
    }
}

/// Why there are no levels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refused {
    /// The mesh can't be drawn: what is wrong, each with its count.
    Mesh(Vec<String>),
    /// A target that is not below the one before it, or the mesh's own triangles.
    Target(usize, usize),
    /// A target below this.
    Least(usize, usize),
}

/// The fewest triangles of a level: a tetrahedron.
pub const LEAST: usize = 4;

impl std::fmt::Display for Refused {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Refused::Mesh(faults) => write!(f, "the mesh has {}: repair it first", faults.join(", ")),
            Refused::Target(target, before) => {
                write!(f, "{target} triangles: each level has fewer than the one before it, here {before}")
            }
            Refused::Least(target, least) => write!(f, "{target} triangles: a level has at least {least}"),
        }
    }
}

impl std::error::Error for Refused {}

/// Simplifies a mesh step by step, each level from the one before it, to `targets` triangles: edges are collapsed by their quadric error
/// (Garland and Heckbert 1997) and the vertices left moved to where it is least. Normals of the mesh are dropped; texture coordinates go along.
///
/// Errors: a mesh with triangles that can't be drawn; targets that do not decrease.
pub fn levels(mesh: &Mesh, targets: &[usize], attributes: Attributes) -> Result<Vec<Level>, Refused> {
    let report = check(mesh);
    if !report.is_drawable() {
        return Err(Refused::Mesh(report.faults()));
    }
    let mut before = mesh.triangles.len();
    for &target in targets {
        if target < LEAST {
            return Err(Refused::Least(target, LEAST));
        }
        if target >= before {
            return Err(Refused::Target(target, before));
        }
        before = target;
    }
    let started = Instant::now();
    let mut last = Mesh { normals: None, ..mesh.clone() };
    weld(&mut last);
    drop_unused(&mut last);
    let mut prepared = started.elapsed();
    let mut last_report = report.clone();
    let mut levels = Vec::with_capacity(targets.len());
    for &target in targets {
        let started = Instant::now();
        // A level that missed by more may be there already.
        if last.triangles.len() > target {
            (last, last_report) = next(&last, target, attributes, &report);
        }
        let took = started.elapsed() + std::mem::take(&mut prepared);
        let missed = match last.triangles.len() {
            achieved if achieved == target => None,
            achieved if achieved + 1 == target => Some(Missed::Pair),
            _ => Some(Missed::Topology),
        };
        let lost = changes(&last_report, &report);
        levels.push(Level { mesh: last.clone(), target, missed, report: last_report.clone(), lost, took });
    }
    Ok(levels)
}

/// What decides the levels of a mesh, as a hash in hexadecimal: with the same one they are the same, on one kind of machine.
pub fn levels_key(mesh: &Mesh, targets: &[usize], attributes: Attributes) -> String {
    sha256(format!("kelir-lod/{REVISION}\n{}\n{attributes:?}\n{targets:?}", mesh.hash()).as_bytes())
}

/// A ladder of `steps` levels between a mesh's triangles and `least`, each the same share of the one before it; neighbours differ by two at
/// least, so that there may be fewer.
pub fn ladder(triangles: usize, steps: usize, least: usize) -> Vec<usize> {
    let share = libm::pow(least as f64 / triangles as f64, 1.0 / steps as f64);
    let mut targets = Vec::with_capacity(steps);
    let mut last = triangles;
    for step in 1..=steps {
        // Even: a closed surface can have no other number.
        let exact = triangles as f64 * libm::pow(share, step as f64);
        let target = (2.0 * (exact / 2.0).round()) as usize;
        let target = if step == steps { least } else { target.max(least) };
        if target < last {
            targets.push(target);
            last = target;
        }
    }
    targets
}

/// The level of `target` triangles below a mesh. The simplifier may fold a thin piece flat or pinch a vertex; then the last stretch is gone
/// again, to a few triangles more or from elsewhere, until the surface hangs together as `whole`, the first one, does.
fn next(mesh: &Mesh, target: usize, attributes: Attributes, whole: &Report) -> (Mesh, Report) {
    let goal = if whole.closed { target & !1 } else { target };
    let mut best: Option<((bool, usize), Mesh, Report)> = None;
    for stretch in STRETCHES {
        let near = target + target / stretch;
        let short = (mesh.triangles.len() > near).then(|| simplified(mesh.clone(), near, attributes));
        // One that went too far, or came apart, is no place to start from.
        let short =
            short.filter(|short| short.triangles.len() > target && changes(&check(short), whole).is_empty());
        let start = short.as_ref().unwrap_or(mesh);
        let tries = if short.is_some() || mesh.triangles.len() <= CHEAP { TRIES } else { 1 };
        for more in (0..tries).take_while(|more| target + 2 * more < start.triangles.len()) {
            let level = simplified(start.clone(), target + 2 * more, attributes);
            let report = check(&level);
            if level.triangles.is_empty() {
                continue;
            }
            let rank = (!changes(&report, whole).is_empty(), level.triangles.len().abs_diff(goal));
            if best.as_ref().is_none_or(|(known, ..)| rank < *known) {
                best = Some((rank, level, report));
            }
            if rank == (false, 0) {
                break;
            }
        }
        if best.as_ref().is_some_and(|(rank, ..)| *rank == (false, 0)) {
            break;
        }
    }
    best.map_or_else(|| (mesh.clone(), check(mesh)), |(_, level, report)| (level, report))
}

/// What of how the first surface hung together a level has lost, each as a few words.
fn changes(level: &Report, whole: &Report) -> Vec<String> {
    let mut changes = level.faults_beyond(whole);
    if level.closed != whole.closed {
        changes.push(if whole.closed { "holes" } else { "no holes" }.to_owned());
    }
    for (name, level, whole) in
        [("parts", level.parts as i64, whole.parts as i64), ("as Euler number", level.euler, whole.euler)]
    {
        if level != whole {
            changes.push(format!("{level} {name} in place of {whole}"));
        }
    }
    changes
}

/// Takes out pairs of faces that lie back to back: what is closed stays closed.
fn unfold(mesh: &mut Mesh) {
    let mut faces: Vec<([u32; 3], bool, usize)> = Vec::with_capacity(mesh.triangles.len());
    for (t, [a, b, c]) in mesh.triangles.iter().copied().enumerate() {
        let mut sorted = [a, b, c];
        sorted.sort_unstable();
        let [low, middle, _] = sorted;
        faces.push((sorted, [(a, b), (b, c), (c, a)].contains(&(low, middle)), t));
    }
    faces.sort_unstable();
    let mut gone = vec![false; faces.len()];
    for same in faces.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1) {
        let (back, front) = same.split_at(same.partition_point(|face| !face.1));
        back.iter().zip(front).for_each(|(back, front)| {
            gone[back.2] = true;
            gone[front.2] = true;
        });
    }
    let mut gone = gone.iter();
    mesh.triangles.retain(|_| gone.next() == Some(&false));
}

fn simplified(mut mesh: Mesh, target: usize, attributes: Attributes) -> Mesh {
    let normals = match attributes {
        Attributes::None => None,
        Attributes::Normals => Some(mesh.smooth_normals()),
    };
    let mut weights = Vec::new();
    weights.extend(normals.iter().flat_map(|_| [NORMAL_WEIGHT; 3]));
    weights.extend(mesh.texture.iter().flat_map(|_| [TEXTURE_WEIGHT; 2]));
    let mut values = Vec::with_capacity(mesh.positions.len() * weights.len());
    for v in 0..mesh.positions.len() {
        values.extend(normals.iter().flat_map(|normals| normals[v]));
        values.extend(mesh.texture.iter().flat_map(|texture| texture[v]));
    }
    let count = mesh.triangles.len();
    let mut indices = std::mem::take(&mut mesh.triangles).into_flattened();
    let left = simplify_with_update(
        &mut indices,
        &mut mesh.positions,
        &mut values,
        &weights,
        weights.len() * size_of::<f32>(),
        None,
        3 * target.min(count),
        // The count alone decides when to stop.
        1e9,
        SimplifyOptions::None,
        None,
    );
    mesh.triangles = indices[..left].as_chunks().0.to_vec();
    let first = weights.len().saturating_sub(2);
    for (v, texture) in mesh.texture.iter_mut().flatten().enumerate() {
        texture.copy_from_slice(&values[v * weights.len() + first..][..2]);
    }
    unfold(&mut mesh);
    drop_unused(&mut mesh);
    mesh
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;
    use crate::distance::Measured;
    use crate::shapes::{ball, cube, torus};

    #[test]
    fn levels_have_the_triangles_asked_for_and_stay_solid() {
        for attributes in [Attributes::None, Attributes::Normals] {
            for (mesh, euler) in [(ball(1.0, 32), 2), (torus(60, 30), 0)] {
                let levels = levels(&mesh, &[2000, 500, 100], attributes).unwrap();
                let fine = Measured::new(&mesh);
                let mut last = 0.0;
                for level in &levels {
                    assert_eq!((level.mesh.triangles.len(), level.missed), (level.target, None));
                    assert_eq!(check(&level.mesh), level.report);
                    assert!(level.report.is_solid(), "{:?}", level.report);
                    assert_eq!(level.report.euler, euler);
                    assert_eq!(level.report.unused_vertices, 0);
                    let rms = fine.distance(&Measured::new(&level.mesh), 5000, 1).unwrap().rms_m();
                    assert!(rms > last, "{rms} after {last}");
                    last = rms;
                }
            }
        }
    }

    /// A ball of n triangles with its vertices on it lies inside by about s²/4√3 of the area, s² = 4 area/(n √3); with the vertices where the
    /// error is least, half of that is outside. Optimal placement is what is bought: without it the same program keeps vertices on the ball.
    #[test]
    fn vertices_move_to_where_the_error_is_least() {
        let mesh = ball(1.0, 48);
        let level = levels(&mesh, &[500], Attributes::None).unwrap().remove(0);
        let volume = |mesh: &Mesh| mesh.signed_volume() / mesh_ball_volume();
        let rms =
            |other: &Mesh| Measured::new(&mesh).distance(&Measured::new(other), 5000, 1).unwrap().rms_m();
        let mut kept = mesh.clone();
        let mut indices = mesh.triangles.clone().into_flattened();
        let vertices = meshopt::VertexDataAdapter::new(
            &mesh.positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>(),
            12,
            0,
        )
        .map(|vertices| meshopt::simplify(&indices, &vertices, 1500, 1e9, SimplifyOptions::None, None))
        .unwrap();
        indices = vertices;
        kept.triangles = indices.as_chunks().0.to_vec();
        assert_eq!(kept.triangles.len(), level.mesh.triangles.len());
        assert!(rms(&level.mesh) < 0.6 * rms(&kept), "{} {}", rms(&level.mesh), rms(&kept));
        assert!((volume(&level.mesh) - 1.0).abs() < 0.5 * (volume(&kept) - 1.0).abs());
    }

    fn mesh_ball_volume() -> f64 {
        4.0 / 3.0 * std::f64::consts::PI
    }

    #[test]
    fn what_can_not_be_reached_is_told_with_its_reason() {
        // A closed surface has an even number of triangles, and a torus 14 at least (Möbius 1861, Császár 1949).
        let levels = levels(&torus(20, 10), &[101, 4], Attributes::None).unwrap();
        assert_eq!((levels[0].mesh.triangles.len(), levels[0].missed), (100, Some(Missed::Pair)));
        assert_eq!(levels[0].lost, Vec::<String>::new());
        // With four it has no tunnel.
        assert_eq!((levels[1].mesh.triangles.len(), levels[1].report.euler), (4, 2));
        assert_eq!(levels[1].lost, ["2 as Euler number in place of 0"]);
        // An open sheet reaches odd numbers, too.
        let mut open = ball(1.0, 16);
        open.triangles.truncate(1001);
        let level = super::levels(&open, &[333], Attributes::None).unwrap().remove(0);
        assert_eq!((level.mesh.triangles.len(), level.missed, level.lost), (333, None, Vec::new()));
    }

    #[test]
    fn faces_back_to_back_are_taken_out_in_pairs() {
        let mut mesh = cube();
        let whole = mesh.clone();
        let [a, b, c] = mesh.triangles[5];
        // A fin that nothing else holds, and a face three times over of which one is turned.
        mesh.triangles.extend([[b, c, a], [c, b, a]]);
        mesh.triangles.extend([[0, 7, 3], [3, 7, 0]]);
        unfold(&mut mesh);
        let sorted = |mesh: &Mesh| {
            let turned = |t: &[u32; 3]| {
                let mut t = *t;
                let first = (0..3).min_by_key(|k| t[*k]).unwrap();
                t.rotate_left(first);
                t
            };
            let mut all: Vec<_> = mesh.triangles.iter().map(turned).collect();
            all.sort_unstable();
            all
        };
        assert_eq!(sorted(&mesh), sorted(&whole));
    }

    #[test]
    fn what_can_not_be_simplified_is_refused() {
        let refused =
            |mesh: &Mesh, targets: &[usize]| levels(mesh, targets, Attributes::None).unwrap_err().to_string();
        assert_eq!(
            refused(&cube(), &[12]),
            "12 triangles: each level has fewer than the one before it, here 12"
        );
        assert_eq!(
            refused(&cube(), &[8, 8]),
            "8 triangles: each level has fewer than the one before it, here 8"
        );
        assert_eq!(refused(&cube(), &[2]), "2 triangles: a level has at least 4");
        let mut broken = cube();
        broken.triangles.push([0, 1, 99]);
        assert_eq!(
            refused(&broken, &[4]),
            "the mesh has 1 triangle with an index out of range: repair it first"
        );
    }

    /// A thin ring, which the simplifier folds and pinches readily.
    #[test]
    fn a_stretch_is_gone_again_until_the_surface_hangs_together() {
        let mut ring = torus(90, 20);
        ring.positions.iter_mut().for_each(|position| position[1] *= 0.002);
        let targets: Vec<usize> = ladder(3600, 40, 40).into_iter().filter(|target| *target >= 70).collect();
        for attributes in [Attributes::None, Attributes::Normals] {
            for level in levels(&ring, &targets, attributes).unwrap() {
                assert_eq!((level.missed, &level.lost), (None, &Vec::new()), "{}", level.target);
                assert!(level.report.is_solid() && level.report.euler == 0);
            }
        }
    }

    #[test]
    fn what_the_whole_one_lacked_is_no_loss() {
        let two = Report { crowded_edges: 2, triangles: 9, ..Report::default() };
        let one = Report { crowded_edges: 1, ..two.clone() };
        assert_eq!(changes(&one, &two), Vec::<String>::new());
        assert_eq!(changes(&two, &one), ["2 edges with more than two faces"]);
        assert_eq!(
            changes(&Report { closed: true, parts: 3, ..two.clone() }, &two),
            ["no holes", "3 parts in place of 0"]
        );
    }

    #[test]
    fn extreme_sizes_are_simplified_alike() {
        let plain = levels(&ball(1.0, 12), &[100], Attributes::Normals).unwrap().remove(0);
        for size in [1e-30, 1e30] {
            let level = levels(&ball(size, 12), &[100], Attributes::Normals).unwrap().remove(0);
            assert_eq!((level.mesh.triangles.len(), level.missed), (100, None), "{size}");
            let ratio = level.mesh.area() / plain.mesh.area() / (size * size);
            assert!((ratio - 1.0).abs() < 1e-3, "{size}: {ratio}");
        }
    }

    #[test]
    fn texture_coordinates_go_along() {
        // A sheet whose texture is its place.
        let n = 20u32;
        let at = |k: u32| k as f32 / n as f32;
        let vertices: Vec<(u32, u32)> = (0..=n).flat_map(|y| (0..=n).map(move |x| (x, y))).collect();
        let cell = |(x, y): (u32, u32)| {
            let a = y * (n + 1) + x;
            [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
        };
        let bent = |x: u32, y: u32| [at(x), at(y), at(x) * at(x) * at(y)];
        let mesh = Mesh {
            positions: vertices.iter().map(|&(x, y)| bent(x, y)).collect(),
            triangles: vertices.iter().filter(|(x, y)| *x < n && *y < n).flat_map(|v| cell(*v)).collect(),
            texture: Some(vertices.iter().map(|&(x, y)| [at(x), at(y)]).collect()),
            ..Mesh::default()
        };
        for attributes in [Attributes::None, Attributes::Normals] {
            let level = levels(&mesh, &[60], attributes).unwrap().remove(0);
            let texture = level.mesh.texture.unwrap();
            assert_eq!(texture.len(), level.mesh.positions.len());
            for (position, texture) in level.mesh.positions.iter().zip(texture) {
                let apart = (position[0] - texture[0]).hypot(position[1] - texture[1]);
                assert!(apart < 0.02, "{position:?} {texture:?}");
            }
        }
    }

    #[test]
    fn a_ladder_has_even_steps_and_ends_where_it_should() {
        let targets = ladder(69_666, 20, 100);
        assert_eq!((targets.len(), targets[19]), (20, 100));
        let share = (100f64 / 69_666.0).powf(0.05);
        for (above, below) in [69_666].iter().chain(&targets).zip(&targets) {
            assert!(below % 2 == 0);
            assert!((*below as f64 / *above as f64 - share).abs() < 0.01, "{above} {below}");
        }
        // More steps than there are even numbers between: fewer levels.
        assert_eq!(ladder(12, 9, 4), [10, 8, 6, 4]);
    }
}
