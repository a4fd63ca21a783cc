#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use glam::DVec2;
use kelir_frame::Pixel;
use kelir_scene::Plane;
use proptest::prelude::*;

use super::twins::{blocks, crooked, edge, plane, square, theatre, view};
use super::*;
use crate::shaders::same_layout;
use crate::{oracle, pa};

fn draw(theatre: &Theatre, knobs: Knobs, view: &View) -> Frame {
    renderer(&knobs, Backend::Cpu).unwrap().radiance(theatre, view).unwrap()
}

fn exact(theatre: &Theatre, view: &View) -> Frame {
    pa::Native::new(pa::Knobs::default()).radiance(theatre, view).unwrap()
}

fn rms(a: &Frame, b: &Frame) -> f64 {
    let pairs =
        || a.visibilities.iter().zip(&b.visibilities).flat_map(|(a, b)| a.values.iter().zip(&b.values));
    let sum: f64 = pairs().map(|(a, b)| f64::from(a - b).powi(2)).sum();
    (sum / pairs().count() as f64).sqrt()
}

/// The width of a straight edge's penumbra, metres: of a ramp V from 0 to 1 it is 6 ∫ V (1 − V) dx.
fn penumbra_m(frame: &Frame, theatre: &Theatre) -> f64 {
    let width = frame.size[0];
    let row = &frame.visibilities[0].values[27 * width..28 * width];
    let pixel = theatre.screen.width_m / width as f64;
    6.0 * pixel * row.iter().map(|v| f64::from(v * (1.0 - v))).sum::<f64>()
}

/// Blocker search, estimate and filter give the width that similar triangles demand, 1 on the lit side and 0 on the dark
/// one; what an estimate 20 % too wide would draw fails the same test.
#[test]
fn a_straight_edge_has_its_penumbra() {
    let knobs = Knobs { filter_samples: 1024, map_size: 2048, ..Knobs::default() };
    let fine = View { size: [960, 540], pixel: Pixel::Centre, skip: true };
    let scene = theatre(square(0.1), vec![edge()]);
    let expected = 0.1 * 0.4 / (1.5 - 0.4);
    let right =
        |theatre: &Theatre| (penumbra_m(&draw(theatre, knobs, &fine), theatre) / expected - 1.0).abs() < 0.02;
    assert!(right(&scene));
    assert!(!right(&theatre(square(0.12), vec![edge()])));
    assert!(!right(&theatre(square(0.08), vec![edge()])));

    for pixel in [Pixel::Centre, Pixel::Area] {
        let view = view(pixel);
        let (drawn, exact) = (draw(&scene, knobs, &view), exact(&scene, &view));
        let mut seen = [0; 3];
        for (v, exact) in drawn.visibilities[0].values.iter().zip(&exact.visibilities[0].values) {
            // The map shows the edge to half a texel, 1 % of the penumbra.
            match *exact {
                0.0 => assert_eq!(*v, 0.0),
                1.0 => assert_eq!(*v, 1.0),
                e => assert!((v - e).abs() < 0.03, "{v} {e}"),
            }
            seen[if *exact == 0.0 { 0 } else { 1 + usize::from(*exact == 1.0) }] += 1;
        }
        assert!(seen.iter().all(|n| *n > 50), "{seen:?}");
        assert!(rms(&drawn, &exact) < 0.005);
    }
}

/// One upright plane has one depth: more samples and finer maps come nearer to what PA knows exactly, on disks too. A map of
/// another place in the theatre does not.
#[test]
fn more_samples_and_texels_come_nearer() {
    for shape in [square(0.1), EmitterShape::Disk { radius_m: 0.06 }] {
        let view = view(Pixel::Area);
        let scene = theatre(shape, vec![plane(blocks(1), -0.4, [0.8, 0.6])]);
        let exact = pa::Native::new(pa::Knobs { strips: 512, ..pa::Knobs::default() })
            .radiance(&scene, &view)
            .unwrap();
        let error = |samples: u32, map_size: u32| {
            let knobs =
                Knobs { blocker_samples: samples, filter_samples: samples, map_size, ..Knobs::default() };
            rms(&draw(&scene, knobs, &view), &exact)
        };
        let samples = [1, 4, 16, 64, 256, 1024].map(|n| error(n, 2048));
        assert!(samples.windows(2).all(|e| e[1] < 0.7 * e[0]), "{samples:?}");
        assert!(samples[5] < 4e-3, "{samples:?}");
        let maps = [16, 64, 256, 1024].map(|n| error(1024, n));
        assert!(maps.windows(2).all(|e| e[1] < 0.8 * e[0]), "{maps:?}");
        let mut moved = scene.clone();
        moved.planes[0].centre_m.z -= 0.05;
        let other = draw(&moved, Knobs { filter_samples: 1024, ..Knobs::default() }, &view);
        assert!(rms(&other, &exact) > 10.0 * samples[5]);
    }
}

/// Averaged depths are an approximation on tilted planes: near the oracle, as near as the tilt is small.
#[test]
fn tilted_planes_are_nearly_right() {
    let view = View { size: [32, 18], ..view(Pixel::Centre) };
    let knobs = Knobs { blocker_samples: 1024, filter_samples: 1024, map_size: 2048, ..Knobs::default() };
    let error = |degrees: f64| {
        let mut scene = theatre(square(0.1), vec![plane(blocks(1), -0.6, [0.7, 0.6])]);
        scene.planes[0].tilt_deg = [0.0, degrees];
        let truth = oracle::renderer(&oracle::Knobs { tolerance: 1e-3, geometric: true });
        rms(&draw(&scene, knobs, &view), &truth.unwrap().radiance(&scene, &view).unwrap())
    };
    let errors = [0.0, 30.0, 60.0].map(error);
    assert!(errors[0] < 2e-3 && errors[1] < 0.01 && errors[2] < 0.03, "{errors:?}");
    assert!(errors[0] < errors[1] && errors[1] < errors[2], "{errors:?}");
}

#[test]
fn layouts_match_the_shader() {
    same_layout!(
        gpu::WGSL,
        "Params",
        gpu::Params { jobs, channels, emitters, search_samples, filter_samples }
    );
    same_layout!(
        gpu::WGSL,
        "Beam",
        gpu::GpuBeam {
            codes,
            depths,
            stride,
            plane,
            channels,
            max_code,
            size,
            bits,
            pixel_x,
            pixel_y,
            columns,
            rows,
        }
    );
    same_layout!(gpu::WGSL, "Penumbra", gpu::GpuPenumbra { search_x, search_y, widths, search, filter_ });
}

/// Skipping changes no bit, and skips; neither does keeping maps between drawings.
#[test]
fn skipping_and_keeping_change_nothing() {
    let mut renderer = renderer(&Knobs { map_size: 256, ..Knobs::default() }, Backend::Cpu).unwrap();
    let view = view(Pixel::Area);
    let first = renderer.radiance(&crooked(), &view).unwrap();
    let all = renderer.radiance(&crooked(), &View { skip: false, ..view }).unwrap();
    assert_eq!(first.radiance, all.radiance);
    assert_eq!(all.stats.counts["searches_skipped"], 0);
    assert!(first.stats.counts["searches_skipped"] > 5000, "{:?}", first.stats.counts);
    let scene = crooked();
    renderer.radiance(&scene, &view).unwrap();
    let kept = renderer.radiance(&scene, &view).unwrap();
    assert_eq!((kept.stats.counts["maps_built"], kept.radiance), (0, first.radiance));
    let mut moved = scene.clone();
    moved.planes[1].centre_m.x += 0.02;
    assert_eq!(renderer.radiance(&moved, &view).unwrap().stats.counts["maps_built"], 1);
}

/// Planes multiply, each with its own map; a bias beyond a plane's distance makes it cast no shadow.
#[test]
fn planes_multiply_and_the_bias_leaves_some_out() {
    let view = view(Pixel::Centre);
    let planes = [plane(blocks(1), -0.4, [0.8, 0.6]), plane(blocks(1), -0.9, [0.4, 0.3])];
    let of = |planes: &[Plane], bias_m| {
        draw(&theatre(square(0.1), planes.to_vec()), Knobs { bias_m, ..Knobs::default() }, &view)
    };
    let (both, near, far) = (of(&planes, 0.0), of(&planes[..1], 0.0), of(&planes[1..], 0.0));
    let parts = near.visibilities[0].values.iter().zip(&far.visibilities[0].values);
    assert!(both.visibilities[0].values.iter().zip(parts).all(|(v, (a, b))| (v - a * b).abs() < 1e-6));
    assert_eq!(of(&planes, 0.5).radiance, far.radiance);
    assert_eq!(of(&planes, 1.0).visibilities[0].values, vec![1.0; 96 * 54]);
}

#[test]
fn refuses_what_it_cannot_draw() {
    let knob = |knobs: Knobs| renderer(&knobs, Backend::Cpu).err().unwrap().to_string();
    assert!(knob(Knobs { blocker_samples: 0, ..Knobs::default() }).contains("blocker_samples = 0"));
    assert!(knob(Knobs { filter_samples: 16385, ..Knobs::default() }).contains("filter_samples = 16385"));
    assert!(knob(Knobs { map_size: 15, ..Knobs::default() }).contains("map_size = 15"));
    assert!(knob(Knobs { bias_m: f64::NAN, ..Knobs::default() }).contains("bias_m"));
    let mut dome = crooked();
    dome.ambient = Ambient::Dome { radiance: [1.0; 3] };
    let refused = |scene: &Theatre| {
        renderer(&Knobs::default(), Backend::Cpu)
            .unwrap()
            .radiance(scene, &view(Pixel::Area))
            .unwrap_err()
            .to_string()
    };
    assert!(refused(&dome).contains("dome"));
    let speck = theatre(square(0.1), vec![plane(blocks(1), -0.4, [1e-7, 1e-7])]);
    assert!(refused(&speck).contains("puppets[0].size"));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]
    /// Whatever the sizes, distances and tilts: numbers in [0, 1], the same with and without skipping.
    #[test]
    fn any_scene_gives_visibilities(
        side in -5f64..0.3, depth in 0.0001f64..0.9999, tilt in prop::array::uniform2(-89f64..89.0), disk: bool,
        x in -0.5f64..0.5, flat: bool, seed: u64,
    ) {
        let extent = 10f64.powf(side);
        let shape = if disk { EmitterShape::Disk { radius_m: 0.5 * extent } } else { square(extent) };
        let mut scene = theatre(shape, vec![plane(blocks(1), -1.5 * depth, [0.2 * (1.0 - depth), 0.1])]);
        scene.planes[0].centre_m.x = x;
        if !flat {
            scene.planes[0].tilt_deg = tilt;
            // Corners stay between lamp and screen.
            let room = 1.5 * depth.min(1.0 - depth);
            scene.planes[0].size_m = [room, 0.9 * room];
        }
        let view = View { size: [32, 18], pixel: Pixel::Area, skip: true };
        let knobs = Knobs { map_size: 64, filter_samples: 7, blocker_samples: 3, seed, ..Knobs::default() };
        let frame = draw(&scene, knobs, &view);
        prop_assert!(frame.visibilities[0].values.iter().all(|v| (0.0..=1.0).contains(v)));
        prop_assert_eq!(frame.radiance, draw(&scene, knobs, &View { skip: false, ..view }).radiance);
    }
}

/// Samples stay on the disk and spread evenly: as many in each of four rings of equal area.
#[test]
fn the_disk_is_filled_evenly() {
    let pattern = Pattern::new(3, 256, &EmitterShape::Disk { radius_m: 1.0 });
    let mut rings = [0; 4];
    for [x, y, ..] in &pattern.places {
        let at = DVec2::new(f64::from(*x), f64::from(*y)) / 2f64.powi(31);
        assert!(at.length() <= 1.0);
        rings[((4.0 * at.length_squared()) as usize).min(3)] += 1;
    }
    assert!(rings.iter().all(|n: &i32| (n - 1024).abs() < 64), "{rings:?}");
}

/// What stands in WGSL and in Rust is the same.
#[test]
fn constants_are_those_of_the_shader() {
    crate::shaders::same_constants!(gpu::WGSL, { "workgroup_size": gpu::WORKGROUP });
}
