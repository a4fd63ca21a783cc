#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use glam::DVec3;
use kelir_frame::{Backend, Pixel};
use kelir_scene::{Albedo, Emitter, EmitterShape, Exposure, Lamp, Mask, Plane, Screen, Texels};
use std::sync::Arc;

use super::*;
use crate::oracle::{Point, geometric};
use crate::pa::Native;

/// A disc with a soft edge and holes, different in each channel.
fn figure(width: usize, height: usize, channels: usize, max: u16) -> Mask {
    let texel = |c: usize, x: usize, y: usize| {
        let (u, v) = (x as f64 / width as f64 - 0.45, y as f64 / height as f64 - 0.5);
        let r = (1.7 * u * u + v * v).sqrt() + 0.05 * (9.0 * u + 3.0 * c as f64).sin();
        let holes = if (x / 2 + y / 3).is_multiple_of(5) { 0.6 } else { 0.0 };
        let edge = ((r - 0.35) * height as f64 / 3.0).clamp(0.0, 1.0);
        (f64::from(max) * f64::max(edge, holes)).round() as u16
    };
    let texels: Vec<u16> = (0..channels * height * width)
        .map(|k| texel(k / (width * height), k % width, k / width % height))
        .collect();
    let texels = match max {
        255 => Texels::U8(texels.iter().map(|t| *t as u8).collect()),
        _ => Texels::U16(texels),
    };
    Mask::new(width, height, channels, texels)
}

fn plane(mask: Mask, centre_m: [f64; 3]) -> Plane {
    let size_m = [0.6 * mask.width as f64 / mask.height as f64, 0.6];
    Plane { mask: Arc::new(mask), centre_m: DVec3::from(centre_m), size_m, tilt_deg: [0.0; 2] }
}

fn theatre(planes: Vec<Plane>, ambient: Ambient, colours: [[f64; 3]; 2]) -> Theatre {
    let emitter = |name: &str, side: f64, radiance: [f64; 3]| Emitter {
        name: name.into(),
        shape: EmitterShape::Rectangle { size_m: [side, 0.8 * side] },
        radiance,
    };
    Theatre {
        screen: Screen { width_m: 1.6, height_m: 0.9, albedo: Albedo::Uniform([0.8, 0.7, 0.6]) },
        lamp: Lamp {
            position_m: DVec3::new(0.05, -0.03, -1.5),
            emitters: vec![emitter("inner", 0.02, colours[0]), emitter("outer", 0.1, colours[1])],
        },
        ambient,
        planes,
        exposure: Exposure::Auto,
    }
}

/// Grey; sixteen bits; colour with the paper's ambient light; two planes, one of them coloured, with a lamp of two colours.
fn scenes() -> Vec<Theatre> {
    let paper = Ambient::Paper { k_d_m: 1.0, s: [0.3, 0.2, 0.1] };
    let grey = [[2000.0; 3], [40.0; 3]];
    let centre = [0.1, 0.02, -0.2];
    vec![
        theatre(vec![plane(figure(100, 128, 1, 255), centre)], Ambient::None, grey),
        theatre(vec![plane(figure(100, 128, 1, 65535), centre)], Ambient::None, grey),
        theatre(vec![plane(figure(40, 64, 3, 255), [0.0, 0.0, -0.9])], paper, grey),
        theatre(
            vec![plane(figure(100, 128, 1, 255), centre), plane(figure(40, 64, 3, 255), [-0.2, 0.1, -0.5])],
            paper,
            [[2000.0, 1500.0, 800.0], [40.0, 40.0, 60.0]],
        ),
    ]
}

fn view(pixel: Pixel) -> View {
    View { size: [160, 90], pixel, skip: true }
}

fn on_gpu(shaders: &Shaders, knobs: Knobs) -> OnGpu {
    let gpu = kelir_frame::gpu::choose(Backend::Gpu).expect("the tests need a Vulkan adapter").unwrap();
    OnGpu::new(gpu, knobs, shaders).unwrap()
}

/// A shader that is 3 % off.
fn wrong() -> Shaders {
    let right = Shaders::default();
    let visibility =
        right.visibility.replace("    return select(mean,", "    mean *= 0.97;\n    return select(mean,");
    assert!(visibility != right.visibility);
    Shaders { visibility, ..right }
}

/// Largest difference of any visibility.
fn worst(a: &Frame, b: &Frame) -> f32 {
    let pairs = a.visibilities.iter().zip(&b.visibilities).flat_map(|(a, b)| {
        assert_eq!(a.name(), b.name());
        a.values.iter().zip(&b.values)
    });
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Largest difference of any display code.
fn codes_apart(a: &[u32], b: &[u32]) -> u32 {
    let bytes = |p: &u32| p.to_le_bytes();
    let pairs = a.iter().flat_map(bytes).zip(b.iter().flat_map(bytes));
    pairs.map(|(a, b)| u32::from(a.abs_diff(b))).max().unwrap_or(0)
}

/// Visibility to 2e-6, display codes to one; a shader that is 3 % off fails both.
#[test]
fn gpu_agrees_with_native() {
    for (knobs, pixel) in [
        (Knobs::default(), Pixel::Centre),
        (Knobs::default(), Pixel::Area),
        (Knobs { split: 2, weights: Weights::Irradiance, ..Knobs::default() }, Pixel::Area),
    ] {
        let (mut right, mut wrong) = (on_gpu(&Shaders::default(), knobs), on_gpu(&wrong(), knobs));
        for (k, scene) in scenes().iter().enumerate() {
            let (view, mut native) = (view(pixel), Native::new(knobs));
            let truth = native.radiance(scene, &view).unwrap();
            let drawn = right.radiance(scene, &view).unwrap();
            let error = worst(&truth, &drawn);
            assert!(error <= 2e-6, "scene {k} {pixel:?} {knobs:?}: {error:e}");
            assert!(worst(&truth, &wrong.radiance(scene, &view).unwrap()) > 1e-2);
            let white = crate::white([scene], &view);
            let mut codes = [(); 3].map(|()| vec![0; 160 * 90]);
            native.display(scene, &view, white, &mut codes[0]).unwrap();
            right.display(scene, &view, white, &mut codes[1]).unwrap();
            wrong.display(scene, &view, white, &mut codes[2]).unwrap();
            assert!(codes_apart(&codes[0], &codes[1]) <= 1, "scene {k} {pixel:?}");
            assert!(codes_apart(&codes[0], &codes[2]) > 1);
        }
    }
}

/// One theatre and knobs a feature, by name.
fn features() -> Vec<(&'static str, Theatre, Knobs)> {
    let grey = [[2000.0; 3], [40.0; 3]];
    let paper = Ambient::Paper { k_d_m: 1.0, s: [0.3, 0.2, 0.1] };
    let dome = Ambient::Dome { radiance: [3.0, 2.0, 1.0] };
    let near = || plane(figure(100, 128, 1, 255), [0.1, 0.02, -0.2]);
    let far = || plane(figure(40, 64, 3, 255), [-0.2, 0.1, -0.5]);
    let tilted = |tilt_deg, max| Plane { tilt_deg, ..plane(figure(100, 128, 1, max), [0.05, 0.0, -0.5]) };
    let disks = |mut theatre: Theatre| {
        theatre.lamp.emitters[0].shape = EmitterShape::Disk { radius_m: 0.01 };
        theatre.lamp.emitters[1].shape = EmitterShape::Disk { radius_m: 0.06 };
        theatre
    };
    let plain = Knobs::default();
    let split = Knobs { split: 3, ..plain };
    let irradiance = Knobs { split: 2, weights: Weights::Irradiance, strips: 8, ..plain };
    let woven = |mut theatre: Theatre| {
        let rgb: Vec<_> = (0..64 * 36).map(|k| [0.3 + 0.6 * (k % 7) as f32 / 7.0, 0.5, 0.7]).collect();
        let image = kelir_scene::LinearImage::new(64, 36, &rgb);
        theatre.screen.albedo = Albedo::Image(Arc::new(image));
        theatre
    };
    vec![
        ("disks", disks(theatre(vec![near()], Ambient::None, grey)), Knobs { strips: 16, ..plain }),
        ("disks, two planes", disks(theatre(vec![near(), far()], paper, grey)), irradiance),
        ("tilted", theatre(vec![tilted([20.0, -35.0], 255)], Ambient::None, grey), plain),
        ("tilted, split", theatre(vec![tilted([-10.0, 60.0], 255)], Ambient::None, grey), split),
        ("steep, sixteen bits", theatre(vec![tilted([5.0, 80.0], 65535)], Ambient::None, grey), irradiance),
        ("tilted beside upright", theatre(vec![tilted([15.0, 25.0], 255), far()], paper, grey), split),
        ("split", theatre(vec![near(), far()], Ambient::None, grey), split),
        ("dome", theatre(vec![near()], dome, grey), plain),
        (
            "dome on cloth",
            woven(theatre(vec![near(), far()], dome, [[800.0, 600.0, 300.0], [20.0; 3]])),
            plain,
        ),
        (
            "shadow map",
            theatre(vec![near(), far()], paper, grey),
            Knobs { variant: super::super::Variant::ShadowMap, map_size: 128, ..plain },
        ),
        (
            "sixteen bits",
            theatre(vec![plane(figure(40, 64, 3, 65535), [0.0, 0.0, -0.9])], paper, grey),
            split,
        ),
    ]
}

/// Whatever native PA draws, to 2e-6 of visibility and one code; tables, tilted planes or the dome 3 % off fail.
#[test]
fn gpu_draws_what_native_draws() {
    let right = Shaders::default();
    let tilted = right.tilted.replace("* params.norm;", "* params.norm * 0.97;");
    let shade = right.shade.replace("clamp(sum, 0.0, 1.0)", "clamp(sum * 0.9, 0.0, 1.0)");
    assert!(tilted != right.tilted && shade != right.shade);
    let off = [wrong(), Shaders { tilted, ..right.clone() }, Shaders { shade, ..right.clone() }];
    // Compiling takes longer than drawing: pipelines are kept from feature to feature.
    let mut gpu = on_gpu(&right, Knobs::default());
    let mut off = off.map(|shaders| on_gpu(&shaders, Knobs::default()));
    for (k, (name, scene, knobs)) in features().into_iter().enumerate() {
        let pixel = if k % 3 == 2 { Pixel::Centre } else { Pixel::Area };
        let view = View { size: [96, 54], pixel, skip: true };
        let mut native = Native::new(knobs);
        let truth = native.radiance(&scene, &view).unwrap();
        let dome = name.starts_with("dome");
        let wrong = match name {
            _ if dome => &mut off[2],
            _ if name.starts_with("tilted") || name.starts_with("steep") => &mut off[1],
            _ => &mut off[0],
        };
        (gpu.knobs, wrong.knobs) = (knobs, knobs);
        let error = worst(&truth, &gpu.radiance(&scene, &view).unwrap());
        assert!(error <= 2e-6, "{name} {pixel:?}: {error:e}");
        assert!(dome || worst(&truth, &wrong.radiance(&scene, &view).unwrap()) > 5e-3, "{name} {pixel:?}");
        let white = crate::white([&scene], &view);
        let mut codes = [(); 3].map(|()| vec![0; 96 * 54]);
        native.display(&scene, &view, white, &mut codes[0]).unwrap();
        gpu.display(&scene, &view, white, &mut codes[1]).unwrap();
        wrong.display(&scene, &view, white, &mut codes[2]).unwrap();
        assert!(codes_apart(&codes[0], &codes[1]) <= 1, "{name} {pixel:?}");
        assert!(codes_apart(&codes[0], &codes[2]) > 1, "{name} {pixel:?}");
    }
}

/// Steep, very near and very far planes, tiny and huge emitters: as the CPU has it, and never outside [0, 1].
#[test]
fn tilted_planes_stay_exact_under_stress() {
    let mut gpu = on_gpu(&Shaders::default(), Knobs::default());
    for side in [1e-3, 0.3] {
        for tilt in [[0.01, 0.0], [0.0, 45.0], [85.0, 0.0]] {
            let mut scene = theatre(
                vec![plane(figure(96, 128, 1, 255), [0.05, 0.1, -0.6])],
                Ambient::None,
                [[1.0; 3]; 2],
            );
            scene.planes[0].tilt_deg = tilt;
            scene.lamp.emitters.truncate(1);
            scene.lamp.emitters[0].shape = EmitterShape::Rectangle { size_m: [side, 0.8 * side] };
            let view = View { size: [96, 54], ..view(Pixel::Area) };
            let truth = Native::new(Knobs::default()).radiance(&scene, &view).unwrap();
            let drawn = gpu.radiance(&scene, &view).unwrap();
            // A steep plane bends a tile's map: 2e-6 of a texel, of a box of a tenth.
            let most = if tilt[0] > 80.0 { 4e-5 } else { 4e-6 };
            assert!(worst(&truth, &drawn) <= most, "side {side}, {tilt:?}: {:e}", worst(&truth, &drawn));
            assert!(drawn.visibilities[0].values.iter().all(|v| (0.0..=1.0).contains(v)));
        }
    }
}

/// The oracle shares nothing with the GPU but the scene.
#[test]
fn gpu_agrees_with_the_oracle() {
    for pixel in [Pixel::Centre, Pixel::Area] {
        let (scene, view) = (&scenes()[0], view(pixel));
        let frame = on_gpu(&Shaders::default(), Knobs::default()).radiance(scene, &view).unwrap();
        let off = on_gpu(&wrong(), Knobs::default()).radiance(scene, &view).unwrap();
        let (mut error, mut control) = (0f64, 0f64);
        for j in (2..90).step_by(7) {
            for i in (1..160).step_by(5) {
                for e in 0..2 {
                    let truth = geometric(scene, e, Point::pixel(scene, &view, i, j), 1.0)[0];
                    let of = |f: &Frame| (f64::from(f.visibilities[e].values[j * 160 + i]) - truth).abs();
                    error = error.max(of(&frame));
                    control = control.max(of(&off));
                }
            }
        }
        assert!(error <= 2e-6, "{pixel:?}: {error:e}");
        assert!(control > 1e-2);
    }
}

/// Emitters of 1e-6 m to 1 m and planes next to screen and lamp: never NaN, never outside [0, 1], and as the CPU has it.
#[test]
fn gpu_stays_exact_under_stress() {
    let mut gpu = on_gpu(&Shaders::default(), Knobs::default());
    for side in [1e-6, 1e-3, 1.0] {
        for z in [-1e-4, -0.75, -1.4999] {
            let mut scene =
                theatre(vec![plane(figure(96, 128, 1, 255), [0.05, 0.0, z])], Ambient::None, [[1.0; 3]; 2]);
            scene.lamp.emitters.truncate(1);
            scene.lamp.emitters[0].shape = EmitterShape::Rectangle { size_m: [side, 0.8 * side] };
            let view = View { size: [96, 54], ..view(Pixel::Area) };
            let truth = Native::new(Knobs::default()).radiance(&scene, &view).unwrap();
            let drawn = gpu.radiance(&scene, &view).unwrap();
            assert!(worst(&truth, &drawn) <= 4e-6, "side {side}, z {z}: {:e}", worst(&truth, &drawn));
            assert!(drawn.visibilities[0].values.iter().all(|v| (0.0..=1.0).contains(v)));
        }
    }
}

/// Without puppets, or with one beside the beam, the lit screen is drawn.
#[test]
fn gpu_draws_an_empty_stage() {
    let view = view(Pixel::Area);
    let beside = plane(figure(40, 64, 1, 255), [40.0, 0.0, -0.2]);
    for planes in [vec![], vec![beside]] {
        let scene = theatre(planes, Ambient::None, [[2000.0; 3], [40.0; 3]]);
        let drawn = on_gpu(&Shaders::default(), Knobs::default()).radiance(&scene, &view).unwrap();
        assert_eq!(drawn.radiance, Native::new(Knobs::default()).radiance(&scene, &view).unwrap().radiance);
    }
}

/// Batches of tiles and pieces, as large images and many pieces need, change no bit; nor does drawing a second time from what was kept.
#[test]
fn batches_change_nothing() {
    let (scene, view) = (&scenes()[3], view(Pixel::Area));
    let mut whole = on_gpu(&Shaders::default(), Knobs::default());
    let mut batched = on_gpu(&Shaders::default(), Knobs::default());
    batched.most = [17, 32];
    let one = whole.radiance(scene, &view).unwrap();
    let many = batched.radiance(scene, &view).unwrap();
    assert!(one.stats.counts["batches"] == 1 && many.stats.counts["batches"] > 1);
    assert_eq!(one.radiance, many.radiance);
    let again = whole.radiance(scene, &view).unwrap();
    assert_eq!(one.radiance, again.radiance);
    assert_eq!((again.stats.counts["tables_built"], again.stats.counts["background_reused"]), (0, 1));
}

#[test]
fn structs_are_laid_out_as_the_shaders_expect() {
    use super::passes::{RowsParams, ShadeParams, SlopeParams, VisibilityParams};
    use super::tables::TableParams;
    use crate::shaders::same_layout;
    let s = Shaders::default();
    same_layout!(&s.table, "Params", TableParams { width, height, max_code, quads });
    same_layout!(&s.rows, "Params", RowsParams { blocks, width, height, shift });
    same_layout!(
        &s.visibility,
        "Params",
        VisibilityParams {
            tiles,
            pieces,
            lookups,
            bounds,
            stride,
            count,
            channel,
            right,
            plane,
            shares,
            shares_end,
            shares_step,
            rest,
            unused_x,
            unused_y,
            unused_z,
        }
    );
    same_layout!(
        &s.tilted,
        "Params",
        SlopeParams {
            tiles,
            count,
            maps,
            width,
            height,
            sub_x,
            sub_y,
            norm,
            along_x,
            along_y,
            unused_x,
            unused_y,
        }
    );
    same_layout!(
        &s.shade,
        "Params",
        ShadeParams {
            tiles,
            stride,
            count,
            right,
            bottom,
            channel,
            distances,
            domes,
            scale,
            k_d,
            unused_x,
            unused_y,
            s,
            dome,
        }
    );
}

/// What stands in WGSL and in Rust is the same.
#[test]
fn constants_are_those_of_the_shaders() {
    use crate::shaders::same_constants;
    use kelir_frame::encode::LOWEST;
    use words::ROW;
    use work::{ACROSS, BLOCK, SHELF};
    same_constants!(include_str!("../shade.wgsl"), { "ACROSS": ACROSS, "LOWEST": LOWEST, "ROW": ROW });
    same_constants!(include_str!("../visibility.wgsl"), { "ACROSS": ACROSS, "BLOCK": BLOCK, "ROW": ROW, "SHELF": SHELF });
    same_constants!(include_str!("../rows.wgsl"), { "BLOCK": BLOCK, "ROW": ROW, "SHELF": SHELF });
    same_constants!(include_str!("../tilted.wgsl"), { "ACROSS": ACROSS, "ROW": ROW });
    same_constants!(include_str!("../table.wgsl"), { "workgroup_size": tables::WORKGROUP });
}
