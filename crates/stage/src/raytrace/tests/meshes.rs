//! Rays against triangles.

use glam::DVec3;
use kelir_frame::Isa;

use super::*;
use crate::raytrace::rays::{Hits, LANES, NOTHING, Rays};
use crate::raytrace::tree::Tree;

/// Numbers in [−1, 1): SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }
}

fn tree(mesh: &Mesh) -> Tree {
    Tree::new(&mesh.positions, &mesh.triangles)
}

/// The first hit by another test than the tree's (Möller & Trumbore 1997), triangle by triangle.
fn brute(mesh: &Mesh, origin: DVec3, direction: DVec3) -> Option<(f64, u32)> {
    let hit = |(name, corners): (usize, &[u32; 3])| {
        let [a, b, c] = corners.map(|k| DVec3::from(mesh.positions[k as usize].map(f64::from)));
        let (e1, e2) = (b - a, c - a);
        let p = direction.cross(e2);
        let s = (origin - a) / e1.dot(p);
        let (u, q) = (s.dot(p), s.cross(e1));
        let (v, at) = (direction.dot(q), e2.dot(q));
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && at > 0.0).then_some((at, name as u32))
    };
    mesh.triangles.iter().enumerate().filter_map(hit).min_by(|a, b| a.0.total_cmp(&b.0))
}

#[test]
fn a_tree_finds_what_looking_at_every_triangle_finds() {
    let shape = bumpy(24, 0.3);
    let tree = tree(&shape);
    let mut random = Random(3);
    let (mut met, mut missed) = (0, 0);
    for round in 0..200 {
        let one = round % 2 == 0;
        let origin = 2.5 * random.vector();
        let origins = std::array::from_fn(|_| if one { origin } else { 2.5 * random.vector() });
        let directions: [DVec3; LANES] = std::array::from_fn(|r| 1.6 * random.vector() - origins[r]);
        let rays = if one {
            Rays::from_point(origin, &directions)
        } else {
            Rays::from_points(&origins, &directions)
        };
        let (mut first, mut any) = (Hits::default(), Hits::default());
        tree.first(&rays, &mut first);
        tree.any(&rays, &mut any);
        for r in 0..LANES {
            match brute(&shape, origins[r], directions[r]) {
                Some((at, triangle)) => {
                    met += 1;
                    assert!((first.at[r] - at).abs() < 1e-9 && first.triangle[r] == triangle, "{round} {r}");
                    assert_ne!(any.triangle[r], NOTHING);
                }
                None => {
                    missed += 1;
                    assert_eq!((first.triangle[r], any.triangle[r]), (NOTHING, NOTHING), "{round} {r}");
                }
            }
        }
    }
    assert!(met > 500 && missed > 500, "{met} met, {missed} missed: both must be tried");
}

/// Ten million rays from inside of a closed surface, a half of them aimed at edges and vertices: none escapes.
#[test]
fn nothing_escapes_from_a_closed_mesh() {
    let shape = bumpy(40, 0.25);
    let escapes = |shape: &Mesh, packets: u64, salt: u64| -> u64 {
        use rayon::prelude::*;
        let tree = tree(shape);
        let corner = |k: u32| DVec3::from(shape.positions[k as usize].map(f64::from));
        let packet = |n: u64| {
            let mut random = Random(n * 7919 + salt);
            let origin = 0.3 * random.vector();
            let origins: [DVec3; LANES] = std::array::from_fn(|_| 0.3 * random.vector());
            let one = n.is_multiple_of(2);
            let directions: [DVec3; LANES] = std::array::from_fn(|r| {
                let from = if one { origin } else { origins[r] };
                let [a, b, _] = shape.triangles[(n as usize * LANES + r) % shape.triangles.len()];
                match n / 2 % 4 {
                    0 => corner(a) - from,
                    1 => corner(a).lerp(corner(b), 0.5 + 0.5 * random.next()) - from,
                    _ => random.vector(),
                }
            });
            let rays = if one {
                Rays::from_point(origin, &directions)
            } else {
                Rays::from_points(&origins, &directions)
            };
            let mut hits = Hits::default();
            tree.first(&rays, &mut hits);
            hits.triangle.iter().filter(|t| **t == NOTHING).count() as u64
        };
        (0..packets).into_par_iter().map(packet).sum()
    };
    assert_eq!(escapes(&shape, 10_000_000 / LANES as u64, 1), 0);
    // One triangle of some thousands is missing: that is found.
    let mut holed = shape.clone();
    holed.triangles.remove(1234);
    assert!(escapes(&holed, 20_000, 1) > 0);
}

/// The same, far from the origin and tiny, huge, or seen through an edge along an axis.
#[test]
fn nothing_escapes_at_any_size() {
    for size in [1e-3, 1.0, 1e4] {
        let mut shape = bumpy(16, 0.2);
        for position in &mut shape.positions {
            *position = position.map(|x| x * size as f32);
        }
        let tree = tree(&shape);
        let mut random = Random(11);
        for n in 0..4000usize {
            let [a, b, c] = shape.triangles[n % shape.triangles.len()]
                .map(|k| DVec3::from(shape.positions[k as usize].map(f64::from)));
            let origin = if n % 3 == 0 { DVec3::ZERO } else { 0.2 * size * random.vector() };
            let directions = std::array::from_fn(|r| match r {
                0 => a - origin,
                1 => b - origin,
                2 => 0.5 * (a + b) - origin,
                3 => 0.5 * (b + c) - origin,
                4..10 => DVec3::AXES[r % 3] * if r < 7 { 1.0 } else { -1.0 },
                _ => random.vector(),
            });
            let mut hits = Hits::default();
            tree.first(&Rays::from_point(origin, &directions), &mut hits);
            assert!(hits.triangle.iter().all(|t| *t != NOTHING), "{size} {n} {:?}", hits.triangle);
        }
    }
}

#[test]
fn every_instruction_set_and_every_number_of_threads_draw_the_same() {
    let lamp = LightKind::Area {
        pose: overhead(2.0),
        shape: AreaShape::Rectangle { size_m: [0.3, 0.2] },
        radiance: [1.0, 2.0, 3.0],
    };
    let mut thing = object("ball", mesh(bumpy(12, 0.2), true), DVec3::new(0.1, 0.5, 0.0));
    thing.pose.scale = 0.2;
    let scene = stage(vec![floor(), thing], vec![lamp, point([1.0, 3.0, 0.5], 2.0)]);
    let knobs = Knobs { spp: 16, bounces: 1, ..Knobs::default() };
    let picture = || {
        let frame = draw(&scene, VIEW, knobs);
        (frame.radiance, frame.standard_error)
    };
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let right = one.install(picture);
    for isa in Isa::all() {
        // The choice holds for this thread alone.
        assert_eq!(one.install(|| isa.with(picture)), right, "{}", isa.name());
    }
    let three = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("threads");
    assert_eq!(three.install(picture), right);
    let again = draw(&scene, VIEW, Knobs { seed: 2, ..knobs });
    assert_ne!(again.radiance, right.0, "another seed");
}

/// A mesh whose caster is coarser throws the coarse shadow, and shades itself as it is seen.
#[test]
fn a_caster_of_another_level_shades_others_alone() {
    let (fine, coarse) = (Arc::new(ball(32)), Arc::new(ball(3)));
    let shadow = |seen: &Arc<Mesh>, caster: &Arc<Mesh>| {
        let form = Form::Mesh(MeshForm { seen: seen.clone(), caster: caster.clone(), smooth: false });
        let mut thing = object("ball", form, DVec3::new(0.0, 1.0, 0.0));
        thing.pose.scale = 0.4;
        let mut scene = stage(vec![floor(), thing], vec![point([1.0, 2.5, 0.3], 1.0)]);
        // From the side, the ball and its shadow in view.
        scene.camera.pose = Pose::looking(DVec3::new(0.0, 2.0, 4.0), DVec3::new(0.0, 0.4, 0.0), DVec3::Y);
        scene.camera.projection = Projection::with_field_of_view(45.0, 1.0);
        draw(&scene, View { size: [128, 128], ..VIEW }, Knobs::default()).radiance[0].clone()
    };
    let (all_fine, all_coarse, mixed) =
        (shadow(&fine, &fine), shadow(&coarse, &coarse), shadow(&fine, &coarse));
    // The ball is what differs between fine and coarse as it is seen; its pixels are those of the fine ball, its shadow's those of the coarse one.
    let differs = |a: &[f32], b: &[f32]| a.iter().zip(b).filter(|(a, b)| a != b).count();
    assert!(differs(&all_fine, &all_coarse) > 50);
    let shadows = differs(&all_fine, &mixed);
    assert!(shadows > 3, "the shadow is the coarse one: {shadows}");
    for (k, value) in mixed.iter().enumerate() {
        assert!(*value == all_fine[k] || *value == all_coarse[k], "pixel {k} is of neither");
    }
}
