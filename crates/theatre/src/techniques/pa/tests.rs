#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use std::sync::Arc;

use glam::DVec3;
use kelir_frame::{Pixel, View, encode};
use kelir_scene::{
    Albedo, Ambient, Emitter, EmitterShape, Exposure, Lamp, Mask, Plane, Screen, Texels, Theatre,
};

use super::*;
use crate::oracle::{Point, geometric, visibility};
use crate::white;

const SIZE: [usize; 2] = [320, 180];

fn view(pixel: Pixel) -> View {
    View { size: SIZE, pixel, skip: true }
}

/// A figure with soft edges, holes at texel pitch and an opaque body; not symmetric in any way.
fn figure(width: usize, height: usize, channels: usize) -> Mask {
    let texel = |c: usize, x: usize, y: usize| {
        let (u, v) = (x as f64 / width as f64 - 0.45, y as f64 / height as f64 - 0.5);
        let r = (u * u * 1.7 + v * v).sqrt() + 0.05 * (9.0 * u + 3.0 * c as f64).sin();
        let holes = if (x / 2 + y / 3).is_multiple_of(5) && u > 0.05 { 0.6 } else { 0.0 };
        let edge = ((r - 0.35) * height as f64 / 3.0).clamp(0.0, 1.0);
        (255.0 * edge.max(holes).min(1.0)).round() as u8
    };
    let texels = (0..channels)
        .flat_map(|c| (0..height).flat_map(move |y| (0..width).map(move |x| texel(c, x, y))))
        .collect();
    Mask::new(width, height, channels, Texels::U8(texels))
}

fn plane(mask: Mask, centre_m: [f64; 3], height_m: f64) -> Plane {
    let width_m = height_m * mask.width as f64 / mask.height as f64;
    Plane {
        mask: Arc::new(mask),
        centre_m: DVec3::from(centre_m),
        size_m: [width_m, height_m],
        tilt_deg: [0.0; 2],
    }
}

fn emitter(name: &str, size_m: [f64; 2], radiance: [f64; 3]) -> Emitter {
    Emitter { name: name.into(), shape: EmitterShape::Rectangle { size_m }, radiance }
}

fn theatre(planes: Vec<Plane>) -> Theatre {
    Theatre {
        screen: Screen { width_m: 1.6, height_m: 0.9, albedo: Albedo::Uniform([0.8, 0.7, 0.6]) },
        lamp: Lamp {
            position_m: DVec3::new(0.05, -0.03, -1.5),
            emitters: vec![
                emitter("inner", [0.02, 0.015], [2000.0; 3]),
                emitter("outer", [0.1, 0.12], [40.0; 3]),
            ],
        },
        ambient: Ambient::None,
        planes,
        exposure: Exposure::Auto,
    }
}

fn draw(theatre: &Theatre, pixel: Pixel) -> kelir_frame::Frame {
    Native::new(Knobs::default()).radiance(theatre, &view(pixel)).unwrap()
}

/// Largest |PA − oracle| of Vgeo over a sparse set of pixels; `oracle` may be a slightly different theatre.
fn worst(frame: &kelir_frame::Frame, oracle: &Theatre, pixel: Pixel) -> f64 {
    worst_of(frame, oracle, pixel, [5, 7])
}

/// [`worst`] over every `step`th column and row.
fn worst_of(frame: &kelir_frame::Frame, oracle: &Theatre, pixel: Pixel, step: [usize; 2]) -> f64 {
    let coloured = frame.visibilities.len() == 3 * oracle.lamp.emitters.len();
    let view = View { size: frame.size, ..view(pixel) };
    // What is a finite sum does not depend on it.
    let tolerance = if pixel == Pixel::Centre { 1e-5 } else { 1.0 };
    let mut worst = 0f64;
    for j in (2..frame.size[1]).step_by(step[1]) {
        for i in (1..frame.size[0]).step_by(step[0]) {
            for e in 0..oracle.lamp.emitters.len() {
                let v = geometric(oracle, e, Point::pixel(oracle, &view, i, j), tolerance);
                for (c, v) in v.into_iter().enumerate().take(if coloured { 3 } else { 1 }) {
                    let drawn = &frame.visibilities[if coloured { e * 3 + c } else { e }];
                    worst = worst.max((f64::from(drawn.values[j * frame.size[0] + i]) - v).abs());
                }
            }
        }
    }
    worst
}

#[test]
fn geometric_visibility_is_exact() {
    let scene = theatre(vec![plane(figure(200, 256, 1), [0.1, 0.02, -0.2], 0.6)]);
    for pixel in [Pixel::Centre, Pixel::Area] {
        let frame = draw(&scene, pixel);
        let error = worst(&frame, &scene, pixel);
        assert!(error <= 1e-6, "{pixel:?}: {error:e}");
        // Negative controls: a twentieth of a texel beside, a lamp 1 % larger, and the other pixel rule.
        let mut beside = scene.clone();
        beside.planes[0].centre_m.x += 0.05 * 0.6 / 256.0;
        assert!(worst(&frame, &beside, pixel) > 1e-4);
        let mut larger = scene.clone();
        larger.lamp.emitters[0].shape = EmitterShape::Rectangle { size_m: [0.0202, 0.015] };
        assert!(worst(&frame, &larger, pixel) > 1e-4);
        let other = if pixel == Pixel::Area { Pixel::Centre } else { Pixel::Area };
        assert!(worst(&frame, &scene, other) > 1e-4);
    }
}

/// Emitters from 1e-6 m to 1 m, planes from 0.1 mm off the screen to 0.1 mm off the lamp, and far-off lamps.
#[test]
fn stays_exact_under_stress() {
    let mut tried = 0;
    for side in [1e-6, 1e-3, 0.1, 1.0] {
        for z in [-1e-4, -0.05, -0.75, -1.4999] {
            for x in [0.0, 3.0] {
                for pixel in [Pixel::Centre, Pixel::Area] {
                    let mut scene =
                        theatre(vec![plane(figure(96, 128, 1), [0.05 + x * z / -1.5, 0.0, z], 0.5)]);
                    scene.lamp.position_m.x = x;
                    scene.lamp.emitters = vec![emitter("lamp", [side, 0.8 * side], [1.0; 3])];
                    let view = View { size: [96, 54], ..view(pixel) };
                    let frame = Native::new(Knobs::default()).radiance(&scene, &view).unwrap();
                    let error = worst(&frame, &scene, pixel);
                    assert!(error <= 1e-6, "side {side}, z {z}, x {x}, {pixel:?}: {error:e}");
                    tried += 1;
                }
            }
        }
    }
    assert_eq!(tried, 64);
}

#[test]
fn colour_and_sixteen_bits() {
    let mut scene = theatre(vec![plane(figure(64, 80, 3), [0.0, 0.0, -0.4], 0.5)]);
    let frame = draw(&scene, Pixel::Area);
    assert_eq!(
        frame.visibilities.iter().map(kelir_frame::Visibility::name).collect::<Vec<_>>()[..2],
        ["Vgeo.inner.R", "Vgeo.inner.G"]
    );
    let error = worst(&frame, &scene, Pixel::Area);
    assert!(error <= 1e-6, "{error:e}");
    // 16 bits, and a lamp whose box holds more than 2³²: u64 sums.
    let texels = (0..700 * 700u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 16) as u16).collect();
    scene.planes = vec![plane(Mask::new(700, 700, 1, Texels::U16(texels)), [0.0, 0.0, -1.2], 0.3)];
    scene.lamp.emitters = vec![emitter("lamp", [0.3, 0.3], [1.0; 3])];
    for pixel in [Pixel::Area, Pixel::Centre] {
        let view = View { size: [64, 36], ..view(pixel) };
        let frame = Native::new(Knobs::default()).radiance(&scene, &view).unwrap();
        let error = worst(&frame, &scene, pixel);
        assert!(error <= 1e-6, "{error:e}");
    }
}

#[test]
fn all_clear_is_lit_exactly_and_all_opaque_is_black() {
    let empty = draw(&theatre(vec![]), Pixel::Area);
    let flat = |code: u8| Mask::new(64, 64, 1, Texels::U8(vec![code; 64 * 64]));
    let clear = draw(&theatre(vec![plane(flat(255), [0.0, 0.0, -0.3], 0.5)]), Pixel::Area);
    assert_eq!(clear.radiance, empty.radiance);
    let scene = theatre(vec![plane(flat(0), [0.0, 0.0, -0.3], 3.0)]);
    let opaque = draw(&scene, Pixel::Area);
    assert!(opaque.radiance.iter().all(|p| p.iter().all(|l| *l == 0.0)));
    // And lit means albedo · E⁰ / π.
    let p = crate::project::pixel_m(&scene.screen, SIZE, 100.0, 50.0);
    let e0: f64 = scene
        .lamp
        .emitters
        .iter()
        .map(|e| e.radiance[1] * crate::irradiance::unit(&e.shape, scene.lamp.position_m, p))
        .sum();
    let expected = 0.7 * e0 / std::f64::consts::PI;
    assert!((f64::from(empty.radiance[1][50 * SIZE[0] + 100]) / expected - 1.0).abs() < 1e-6);
}

/// A half-plane: the penumbra is a linear ramp, a·d / (z_l − d) to either side of the edge's projection.
#[test]
fn a_half_plane_casts_a_linear_ramp() {
    let mut texels = vec![255u8; 256 * 256];
    texels.chunks_mut(256).for_each(|row| row[..128].fill(0));
    let mut scene = theatre(vec![plane(Mask::new(256, 256, 1, Texels::U8(texels)), [0.0, 0.0, -0.5], 2.0)]);
    scene.lamp.position_m = DVec3::new(0.0, 0.0, -1.5);
    let frame = draw(&scene, Pixel::Centre);
    let half = 0.05 * 0.5 / (1.5 - 0.5);
    let mut seen = 0;
    for i in 0..SIZE[0] {
        let x = crate::project::pixel_m(&scene.screen, SIZE, i as f64, 0.0).x;
        let expected = (0.5 + 0.5 * x / half).clamp(0.0, 1.0);
        let got = f64::from(frame.visibilities[1].values[90 * SIZE[0] + i]);
        assert!((got - expected).abs() < 1e-6, "column {i}: {got}, not {expected}");
        seen += usize::from(expected > 0.0 && expected < 1.0);
    }
    assert!(seen >= 8, "{seen} pixels in the ramp");
}

#[test]
fn several_planes_multiply_their_means() {
    let planes = vec![
        plane(figure(100, 128, 1), [-0.1, 0.0, -0.2], 0.5),
        plane(figure(80, 128, 3), [0.1, 0.05, -0.5], 0.4),
    ];
    let both = draw(&theatre(planes.clone()), Pixel::Centre);
    let alone: Vec<_> = planes.iter().map(|p| draw(&theatre(vec![p.clone()]), Pixel::Centre)).collect();
    for (c, name) in ["R", "G", "B"].iter().enumerate() {
        assert_eq!(both.visibilities[c].name(), format!("Vgeo.inner.{name}"));
        for k in 0..both.visibilities[c].values.len() {
            let expected = alone[0].visibilities[0].values[k] * alone[1].visibilities[c].values[k];
            assert!((both.visibilities[c].values[k] - expected).abs() < 1e-6);
        }
    }
    // Splitting the lamp tends to the mean of the product.
    let mut scene = theatre(planes);
    scene.lamp.emitters = vec![emitter("lamp", [0.3, 0.3], [1.0; 3])];
    let error = |split: u32| {
        let knobs = Knobs { split, ..Knobs::default() };
        let view = View { size: [64, 36], ..view(Pixel::Centre) };
        worst_of(&Native::new(knobs).radiance(&scene, &view).unwrap(), &scene, Pixel::Centre, [1, 1])
    };
    let curve = [1, 2, 4, 8, 16].map(error);
    assert!(curve[0] > 0.02 && curve[4] < 0.05 * curve[0], "{curve:?}");
    assert!(curve.windows(2).all(|w| w[1] < w[0]), "{curve:?}");
}

/// Irradiance weights remove the model error: the curve tends to what a light meter reads.
#[test]
fn irradiance_weights_tend_to_the_light_meter() {
    let mut scene = theatre(vec![plane(figure(50, 64, 1), [0.0, 0.0, -0.2], 0.3)]);
    scene.lamp = Lamp {
        position_m: DVec3::new(0.1, 0.0, -0.4),
        emitters: vec![emitter("lamp", [0.3, 0.3], [1.0; 3])],
    };
    let view = View { size: [48, 27], ..view(Pixel::Centre) };
    let error = |split: u32, weights: Weights| {
        let frame =
            Native::new(Knobs { split, weights, ..Knobs::default() }).radiance(&scene, &view).unwrap();
        let mut worst = 0f64;
        for j in (0..27).step_by(3) {
            for i in (0..48).step_by(3) {
                let v = visibility(&scene, 0, Point::pixel(&scene, &view, i, j), 1.0);
                worst =
                    worst.max((f64::from(frame.visibilities[0].values[j * 48 + i]) - v.irradiance[0]).abs());
            }
        }
        worst
    };
    let (geometric, coarse, fine) =
        (error(1, Weights::Area), error(4, Weights::Irradiance), error(16, Weights::Irradiance));
    assert!(geometric > 0.02, "{geometric}");
    assert!(coarse < 0.3 * geometric && fine < 0.2 * coarse, "{geometric} {coarse} {fine}");
}

/// L = L_lit · V̄ + (1 − V̄) · min(D / k_d, 1) · s · L_lit, worked out here from PA's own layers.
#[test]
fn paper_ambient_by_hand() {
    let planes = [
        plane(figure(100, 128, 1), [-0.1, 0.0, -0.2], 0.5),
        plane(figure(80, 128, 1), [0.15, 0.05, -0.5], 0.4),
    ];
    let (k_d, s) = (0.8, [0.5, 0.4, 0.3]);
    let lit = draw(&theatre(vec![]), Pixel::Centre);
    let alone: Vec<_> = planes.iter().map(|p| draw(&theatre(vec![p.clone()]), Pixel::Centre)).collect();
    for count in [1, 2] {
        let mut scene = theatre(planes[..count].to_vec());
        scene.ambient = Ambient::Paper { k_d_m: k_d, s };
        let frame = draw(&scene, Pixel::Centre);
        for k in (0..SIZE[0] * SIZE[1]).step_by(13) {
            let p = crate::project::pixel_m(&scene.screen, SIZE, (k % SIZE[0]) as f64, (k / SIZE[0]) as f64);
            let lamp = &scene.lamp;
            let e0: Vec<f64> = lamp
                .emitters
                .iter()
                .map(|e| e.radiance[0] * crate::irradiance::unit(&e.shape, lamp.position_m, p))
                .collect();
            let mean = |f: &kelir_frame::Frame| {
                let sum: f64 = e0.iter().zip(&f.visibilities).map(|(e, l)| e * f64::from(l.values[k])).sum();
                sum / e0.iter().sum::<f64>()
            };
            let own: Vec<f64> = alone[..count].iter().map(|f| 1.0 - mean(f)).collect();
            let shadow: f64 = own.iter().sum();
            let distance = if shadow > 0.0 {
                own.iter().zip([0.2, 0.5]).map(|(o, d)| o * d).sum::<f64>() / shadow
            } else {
                0.0
            };
            let v = mean(&frame);
            for (c, s) in s.iter().enumerate() {
                let lit = f64::from(lit.radiance[c][k]);
                let expected = lit * v + (1.0 - v) * (distance / k_d).min(1.0) * s * lit;
                let got = f64::from(frame.radiance[c][k]);
                assert!(
                    (got - expected).abs() < 2e-6 * lit,
                    "{count} planes, pixel {k}: {got}, not {expected}"
                );
            }
        }
    }
}

#[test]
fn display_is_the_encoded_radiance_and_skipping_changes_no_byte() {
    let planes = |channels: usize| {
        vec![
            plane(figure(100, 128, channels), [-0.3, 0.0, -0.2], 0.5),
            plane(figure(80, 128, 1), [0.35, 0.05, -0.5], 0.4),
            plane(figure(40, 32, 1), [4.0, 0.05, -0.1], 0.4),
        ]
    };
    let mut cases = 0;
    for pixel in [Pixel::Centre, Pixel::Area] {
        for ambient in [Ambient::None, Ambient::Paper { k_d_m: 0.5, s: [0.3; 3] }] {
            for (count, channels) in [(1, 1), (2, 3), (3, 1)] {
                for last in [[40.0; 3], [0.0; 3], [10.0, 40.0, 90.0]] {
                    let mut scene = theatre(planes(channels)[..count].to_vec());
                    scene.ambient = ambient;
                    scene.lamp.emitters[1].radiance = last;
                    if cases % 2 == 0 {
                        scene.screen.albedo = Albedo::Uniform([0.7; 3]);
                    }
                    let view = view(pixel);
                    let white = white([&scene], &view);
                    let mut native = Native::new(Knobs::default());
                    let frame = native.radiance(&scene, &view).unwrap();
                    let mut fast = vec![0; SIZE[0] * SIZE[1]];
                    let stats = native.display(&scene, &view, white, &mut fast).unwrap();
                    assert!(fast == encode::display(&frame, white), "display is not the encoded radiance");
                    let mut slow = vec![0; SIZE[0] * SIZE[1]];
                    let all =
                        native.display(&scene, &View { skip: false, ..view }, white, &mut slow).unwrap();
                    assert!(fast == slow, "skipping changed bytes");
                    assert!(stats.counts["pixels_lit_copied"] > 1000 && all.counts["pixels_lit_copied"] == 0);
                    assert_eq!(stats.counts["planes_off_beam"], u64::from(count == 3));
                    assert_eq!(stats.counts["tables_built"], 0);
                    cases += 1;
                }
            }
        }
    }
    assert_eq!(cases, 36);
}

/// What one drawing leaves for the next is what the next would make: after the lamp, the cloth, the size or the pixel rule has changed.
#[test]
fn what_is_kept_between_drawings_changes_no_byte() {
    let cloth = |grey: bool| {
        let rgb = (0..90 * 50)
            .map(|k| [0, 1, 2].map(|c| 0.2 + 0.6 * ((k * 7 + if grey { 0 } else { c }) % 13) as f32 / 13.0));
        Albedo::Image(Arc::new(kelir_scene::LinearImage::new(90, 50, &rgb.collect::<Vec<_>>())))
    };
    let base = theatre(vec![plane(figure(100, 128, 1), [-0.3, 0.0, -0.2], 0.5)]);
    let changed = |change: &dyn Fn(&mut Theatre)| {
        let mut scene = base.clone();
        change(&mut scene);
        scene
    };
    let (grey, coloured) = (cloth(true), cloth(false));
    let moved = |s: &mut Theatre| s.lamp.position_m.x += 0.1;
    let small = View { size: [160, 90], ..view(Pixel::Area) };
    let drawings = [
        (changed(&|s| s.screen.albedo = grey.clone()), view(Pixel::Area)),
        (changed(&|s| (s.screen.albedo, s.lamp.position_m.x) = (grey.clone(), 0.2)), view(Pixel::Area)),
        (changed(&|s| (s.screen.albedo, s.lamp.position_m.x) = (grey.clone(), 0.2)), view(Pixel::Centre)),
        (changed(&|s| s.screen.albedo = coloured.clone()), view(Pixel::Centre)),
        (
            changed(&|s| {
                (s.screen.albedo, s.ambient) = (coloured.clone(), Ambient::Dome { radiance: [2.0, 1.0, 3.0] })
            }),
            view(Pixel::Centre),
        ),
        (changed(&|s| s.screen.albedo = coloured.clone()), small),
        (changed(&|s| s.lamp.emitters[0].radiance = [90.0, 20.0, 5.0]), small),
        (changed(&moved), view(Pixel::Area)),
        (base.clone(), view(Pixel::Area)),
    ];
    let mut kept = Native::new(Knobs::default());
    let mut different = Vec::new();
    for (scene, view) in &drawings {
        let frame = kept.radiance(scene, view).unwrap();
        let fresh = Native::new(Knobs::default()).radiance(scene, view).unwrap();
        assert!(frame.radiance == fresh.radiance, "{:?} {:?}", scene.screen.albedo, view);
        different.push(fresh.radiance);
    }
    assert!(different.windows(2).all(|two| two[0] != two[1]), "two drawings are the same: nothing is tried");
}

#[test]
fn thread_count_changes_no_byte() {
    let scene = theatre(vec![plane(figure(300, 384, 1), [0.0, 0.0, -0.2], 0.7)]);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| draw(&scene, Pixel::Area).radiance)
    };
    let one = with(1);
    assert!(one == with(2) && one == with(3));
}

#[test]
fn what_cannot_be_drawn_is_refused_by_name() {
    let refused = |change: &dyn Fn(&mut Theatre)| {
        let mut scene = theatre(vec![plane(figure(10, 12, 1), [0.0, 0.0, -0.2], 0.7)]);
        change(&mut scene);
        Native::new(Knobs::default()).radiance(&scene, &view(Pixel::Area)).unwrap_err().to_string()
    };
    let dome = Ambient::Dome { radiance: [1.0; 3] };
    assert!(
        refused(&|s| (s.planes[0].tilt_deg, s.ambient) = ([10.0, 0.0], dome)).contains("puppets[0].tilt_deg")
    );
    assert!(refused(&|s| s.screen.height_m = 1.2).contains("size = 320x180"));
    assert!(
        renderer(&Knobs { split: 0, ..Knobs::default() }, Backend::Cpu).is_err()
            && renderer(&Knobs { strips: 0, ..Knobs::default() }, Backend::Cpu).is_err()
    );
}

/// Largest |PA − oracle| of Vgeo for each knob.
fn curve(scene: &Theatre, knobs: &[Knobs], pixel: Pixel) -> Vec<f64> {
    let view = View { size: [64, 36], ..view(pixel) };
    let error = |k: &Knobs| {
        let frame = Native::new(*k).radiance(scene, &view).unwrap();
        worst_of(&frame, scene, pixel, [3, 2])
    };
    knobs.iter().map(error).collect()
}

#[test]
fn strips_tend_to_the_disk() {
    let mut scene = theatre(vec![plane(figure(50, 64, 1), [0.1, 0.02, -0.4], 0.6)]);
    scene.lamp.emitters = vec![Emitter {
        name: "disk".into(),
        shape: EmitterShape::Disk { radius_m: 0.08 },
        radiance: [1.0; 3],
    }];
    let strips = [4, 16, 64, 256].map(|strips| Knobs { strips, ..Knobs::default() });
    let curve_ = curve(&scene, &strips, Pixel::Centre);
    assert!(curve_[2] < 2e-3 && curve_[3] < 5e-4, "{curve_:?}");
    assert!(curve_.windows(2).all(|w| w[1] < 0.6 * w[0]), "{curve_:?}");
    // Negative control: the square of the same area is no disk.
    let mut square = scene.clone();
    let side = 0.08 * std::f64::consts::PI.sqrt();
    square.lamp.emitters[0].shape = EmitterShape::Rectangle { size_m: [side, side] };
    let frame = Native::new(Knobs::default())
        .radiance(&square, &View { size: [64, 36], ..view(Pixel::Centre) })
        .unwrap();
    assert!(worst_of(&frame, &scene, Pixel::Centre, [3, 2]) > 1e-2);
}

#[test]
fn splitting_tends_to_the_tilted_plane() {
    for tilt in [[30.0, 0.0], [20.0, -50.0], [0.0, 80.0]] {
        let mut scene = theatre(vec![plane(figure(25, 32, 1), [0.05, 0.02, -0.6], 0.4)]);
        scene.planes[0].tilt_deg = tilt;
        scene.lamp.emitters = vec![emitter("lamp", [0.1, 0.1], [1.0; 3])];
        let splits = [1, 4, 16].map(|split| Knobs { split, ..Knobs::default() });
        let curve_ = curve(&scene, &splits, Pixel::Centre);
        assert!(curve_[2] < 0.25 * curve_[0] && curve_[2] < 0.01, "{tilt:?}: {curve_:?}");
        // Negative control: the other way round it hangs otherwise.
        let frame =
            Native::new(splits[2]).radiance(&scene, &View { size: [64, 36], ..view(Pixel::Centre) }).unwrap();
        scene.planes[0].tilt_deg = tilt.map(|t| -t);
        assert!(worst_of(&frame, &scene, Pixel::Centre, [3, 2]) > 0.05, "{tilt:?}");
    }
}

/// A tilt of next to nothing is drawn by another path than no tilt.
#[test]
fn a_barely_tilted_plane_is_an_upright_one() {
    let mut scene = theatre(vec![plane(figure(50, 64, 3), [0.1, 0.02, -0.3], 0.6)]);
    let upright = draw(&scene, Pixel::Centre);
    scene.planes[0].tilt_deg = [1e-9, -1e-9];
    let tilted = draw(&scene, Pixel::Centre);
    for (a, b) in upright.visibilities.iter().zip(&tilted.visibilities) {
        assert!(a.values.iter().zip(&b.values).all(|(a, b)| (a - b).abs() < 1e-6), "{}", a.name());
    }
    let mut all = vec![0; SIZE[0] * SIZE[1]];
    let mut skipped = all.clone();
    scene.planes[0].tilt_deg = [25.0, -40.0];
    let mut native = Native::new(Knobs::default());
    native.display(&scene, &View { skip: false, ..view(Pixel::Area) }, 100.0, &mut all).unwrap();
    let stats = native.display(&scene, &view(Pixel::Area), 100.0, &mut skipped).unwrap();
    assert!(all == skipped && stats.counts["pixels_lit_copied"] > 1000);
}

#[test]
fn the_dome_is_a_convolution() {
    for (z, height, bound) in [(-0.3, 0.5, 1e-3), (-0.05, 0.5, 1e-3), (-0.01, 0.3, 1e-3)] {
        let mut scene = theatre(vec![plane(figure(50, 64, 3), [0.1, 0.02, z], height)]);
        scene.ambient = Ambient::Dome { radiance: [1.0, 0.5, 0.25] };
        scene.lamp.emitters.iter_mut().for_each(|e| e.radiance = [0.0; 3]);
        let view = View { size: [96, 54], ..view(Pixel::Centre) };
        let mut native = Native::new(Knobs::default());
        let frame = native.radiance(&scene, &view).unwrap();
        let compare = |scene: &Theatre| {
            let mut worst = 0f64;
            for j in (0..54).step_by(9) {
                for i in (0..96).step_by(7) {
                    let p = crate::project::pixel_m(&scene.screen, view.size, i as f64, j as f64);
                    let through = crate::oracle::dome(scene, p);
                    for c in 0..3 {
                        let unit = [0.8, 0.7 * 0.5, 0.6 * 0.25][c];
                        let got = f64::from(frame.radiance[c][j * 96 + i]) / unit;
                        worst = worst.max((got - through[c]).abs());
                    }
                }
            }
            worst
        };
        let error = compare(&scene);
        assert!(error < bound, "{z}: {error}");
        let mut nearer = scene.clone();
        nearer.planes[0].centre_m.z *= 0.95;
        assert!(compare(&nearer) > 3.0 * error.max(2e-4), "{z}: {error} {}", compare(&nearer));
        // Sliding needs no new convolution, and is the same picture from elsewhere.
        let mut slid = scene.clone();
        slid.planes[0].centre_m.x += 0.03;
        let stats = native.radiance(&slid, &view).unwrap().stats;
        assert_eq!(stats.counts["domes_built"], 0);
    }
}

/// The shadow map tends to the exact boxes as its resolution grows.
#[test]
fn shadow_maps_err_by_their_resolution() {
    let scene = theatre(vec![plane(figure(200, 256, 1), [0.1, 0.02, -0.3], 0.6)]);
    let maps =
        [64, 256, 1024].map(|map_size| Knobs { variant: Variant::ShadowMap, map_size, ..Knobs::default() });
    let curve_ = curve(&scene, &maps, Pixel::Centre);
    assert!(curve_.windows(2).all(|w| w[1] < 0.7 * w[0]) && curve_[2] > 1e-2, "{curve_:?}");
}
