#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use std::sync::Arc;

use glam::{DVec2, DVec3};
use kelir_scene::{
    Albedo, Ambient, Emitter, EmitterShape, Exposure, Lamp, Mask, Plane, Screen, Texels, Theatre,
};

use super::*;

fn theatre(planes: Vec<Plane>) -> Theatre {
    Theatre {
        screen: Screen { width_m: 1.6, height_m: 0.9, albedo: Albedo::Uniform([0.8; 3]) },
        lamp: Lamp {
            position_m: DVec3::new(0.0, 0.0, -1.5),
            emitters: vec![Emitter {
                name: "lamp".into(),
                shape: EmitterShape::Rectangle { size_m: [0.2, 0.1] },
                radiance: [1.0; 3],
            }],
        },
        ambient: Ambient::None,
        planes,
        exposure: Exposure::Auto,
    }
}

fn plane(width: usize, codes: Vec<u8>, z: f64, size_m: [f64; 2]) -> Plane {
    let mask = Mask::new(width, codes.len() / width, 1, Texels::U8(codes));
    Plane { mask: Arc::new(mask), centre_m: DVec3::new(0.0, 0.0, z), size_m, tilt_deg: [0.0; 2] }
}

/// Brute force: midpoints over the emitter, transmittance by tracing the ray to the plane.
fn brute(theatre: &Theatre, p: DVec2, n: usize) -> Visibility {
    let lamp = theatre.lamp.position_m;
    let [a, b] = theatre.lamp.emitters[0].shape.half_extent_m();
    let mut sum = Visibility::default();
    let mut weight = 0.0;
    for j in 0..n {
        for i in 0..n {
            let part = (DVec2::new(i as f64, j as f64) + 0.5) / n as f64 * 2.0 - 1.0;
            let q = lamp + DVec3::new(part.x * a, part.y * b, 0.0);
            let ray = q - p.extend(0.0);
            let tau: f64 = theatre
                .planes
                .iter()
                .map(|plane| {
                    let x = p.extend(0.0) + ray * (plane.centre_m.z / lamp.z) - plane.centre_m;
                    let u = ((x.x / plane.size_m[0] + 0.5) * plane.mask.width as f64).floor();
                    let v = ((0.5 - x.y / plane.size_m[1]) * plane.mask.height as f64).floor();
                    let inside =
                        u >= 0.0 && v >= 0.0 && u < plane.mask.width as f64 && v < plane.mask.height as f64;
                    if inside { plane.mask.transmittance(0, u as usize, v as usize) } else { 1.0 }
                })
                .product();
            let cosines = lamp.z * lamp.z / ray.length_squared().powi(2);
            sum.geometric[0] += tau / (n * n) as f64;
            sum.irradiance[0] += tau * cosines;
            weight += cosines;
        }
    }
    sum.irradiance[0] /= weight;
    sum
}

fn two_planes() -> Theatre {
    let codes =
        |seed: u32, n: u32| (0..n).map(|k| ((k + seed).wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    theatre(vec![plane(7, codes(1, 49), -0.5, [0.3, 0.2]), plane(5, codes(9, 30), -0.9, [0.2, 0.25])])
}

#[test]
fn agrees_with_brute_force() {
    let difference = |a: &Visibility, b: &Visibility| {
        (a.geometric[0] - b.geometric[0]).abs().max((a.irradiance[0] - b.irradiance[0]).abs())
    };
    // Negative control: a plane shifted by a fifth of a texel is told apart.
    let mut moved = two_planes();
    moved.planes[0].centre_m.x += 0.2 * 0.3 / 7.0;
    let (mut worst, mut worst_moved) = (0f64, 0f64);
    for p in [DVec2::ZERO, DVec2::new(0.11, -0.07), DVec2::new(-0.25, 0.2)] {
        let sampled = brute(&two_planes(), p, 1000);
        worst = worst.max(difference(&visibility(&two_planes(), 0, Point::At(p), 1.0), &sampled));
        worst_moved = worst_moved.max(difference(&visibility(&moved, 0, Point::At(p), 1.0), &sampled));
    }
    assert!(worst < 1e-3, "{worst}");
    assert!(worst_moved > 5e-3, "{worst_moved}");
}

/// The lower half of the emitter is hidden: both visibilities from areas and from Lambert's formula of the other half.
#[test]
fn half_an_emitter() {
    let scene = theatre(vec![plane(1, vec![255, 0], -0.75, [10.0, 10.0])]);
    let v = visibility(&scene, 0, Point::At(DVec2::new(0.3, 0.0)), 1.0);
    assert!((v.geometric[0] - 0.5).abs() < 1e-12);
    let lamp = DVec3::new(0.0, 0.025, -1.5);
    let half =
        crate::irradiance::unit(&EmitterShape::Rectangle { size_m: [0.2, 0.05] }, lamp, DVec2::new(0.3, 0.0));
    let whole =
        crate::irradiance::unit(&scene.lamp.emitters[0].shape, scene.lamp.position_m, DVec2::new(0.3, 0.0));
    assert!((v.irradiance[0] - half / whole).abs() < 1e-12);
}

#[test]
fn pixel_means_tend_to_the_closed_form() {
    let mut scene = two_planes();
    scene.planes.truncate(1);
    let (centre, sides) = (DVec2::new(0.05, 0.02), DVec2::new(0.08, 0.06));
    let exact = visibility(&scene, 0, Point::Over(centre, sides), 1.0).geometric[0];
    let n = 200;
    let part = |k: usize| (k as f64 + 0.5) / n as f64 - 0.5;
    let sum: f64 = (0..n * n)
        .map(|k| {
            let p = centre + sides * DVec2::new(part(k % n), part(k / n));
            visibility(&scene, 0, Point::At(p), 1.0).geometric[0]
        })
        .sum();
    assert!((exact - sum / (n * n) as f64).abs() < 1e-5, "{exact} {}", sum / (n * n) as f64);
}

#[test]
fn draws_frames() {
    let view = kelir_frame::View { size: [32, 18], pixel: kelir_frame::Pixel::Area, skip: true };
    let frame = Oracle::new(Knobs::default()).radiance(&two_planes(), &view).unwrap();
    assert_eq!(
        frame.visibilities.iter().map(kelir_frame::Visibility::name).collect::<Vec<_>>(),
        ["Vgeo.lamp", "Virr.lamp"]
    );
    let lit = f64::from(frame.radiance[0][0]);
    let p = crate::project::pixel_m(&two_planes().screen, view.size, 0.0, 0.0);
    let e0 = crate::irradiance::unit(&two_planes().lamp.emitters[0].shape, DVec3::new(0.0, 0.0, -1.5), p);
    assert!((lit / (0.8 * e0 / std::f64::consts::PI) - 1.0).abs() < 1e-6);
}

/// Cut at its kinks, a pixel's mean is exact: of the geometric visibility against the closed form, of everything through two
/// planes against a fine lattice, which a lattice that misses the kinks is not near.
#[test]
fn pixels_cut_at_their_kinks() {
    let mut one = two_planes();
    one.planes.truncate(1);
    for k in 0..40 {
        let (centre, sides) = (DVec2::new(0.017 * f64::from(k) - 0.3, 0.05), DVec2::new(0.03, 0.02));
        let cut = visibility(&one, 0, Point::Over(centre, sides), 1.0).geometric[0];
        let closed = geometric(&one, 0, Point::Over(centre, sides), 1.0)[0];
        assert!((cut - closed).abs() < 1e-12, "{cut} {closed}");
    }
    let scene = two_planes();
    let lattice = |centre: DVec2, sides: DVec2, n: usize| {
        let part = |k: usize| (k as f64 + 0.5) / n as f64 - 0.5;
        let (mut geometric, mut e, mut lit) = (0.0, 0.0, 0.0);
        for k in 0..n * n {
            let p = centre + sides * DVec2::new(part(k % n), part(k / n));
            let v = visibility(&scene, 0, Point::At(p), 1.0);
            let unit = crate::irradiance::unit(&scene.lamp.emitters[0].shape, scene.lamp.position_m, p);
            (geometric, e, lit) = (geometric + v.geometric[0], e + unit * v.irradiance[0], lit + unit);
        }
        [geometric / (n * n) as f64, e / lit]
    };
    let (mut worst, mut coarse) = (0f64, 0f64);
    for (x, y) in [(0.05, 0.02), (-0.21, 0.11), (0.0, -0.15)] {
        let (centre, sides) = (DVec2::new(x, y), DVec2::new(0.04, 0.03));
        let v = visibility(&scene, 0, Point::Over(centre, sides), 1.0);
        let (fine, two) = (lattice(centre, sides, 256), lattice(centre, sides, 2));
        let distance = |to: [f64; 2]| (v.geometric[0] - to[0]).abs().max((v.irradiance[0] - to[1]).abs());
        (worst, coarse) = (worst.max(distance(fine)), coarse.max(distance(two)));
    }
    assert!(worst < 3e-6 && coarse > 1e-4, "{worst} {coarse}");
}
