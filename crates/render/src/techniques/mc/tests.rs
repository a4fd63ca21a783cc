#![allow(clippy::unwrap_used)]
use std::sync::Arc;

use glam::DVec3;
use kelir_scene::*;

use super::*;
use crate::Pixel;

/// A half-plane: opaque for x < 0.
fn edge(channels: usize) -> Mask {
    let (w, h) = (64, 36);
    let code = |k: usize| if k % w < w / 2 { 0 } else { 255 };
    Mask::new(w, h, channels, Texels::U8((0..w * h * channels).map(code).collect()))
}

fn theatre(mask: Mask, ambient: Ambient) -> Theatre {
    let emitter = |name: &str, side: f64, radiance: f64| Emitter {
        name: name.into(),
        shape: EmitterShape::Rectangle { size_m: [side, side] },
        radiance: [radiance, 0.8 * radiance, 0.5 * radiance],
    };
    Theatre {
        screen: Screen { width_m: 1.6, height_m: 0.9, albedo: Albedo::Uniform([0.8, 0.7, 0.6]) },
        lamp: Lamp {
            position_m: DVec3::new(0.05, -0.02, -1.5),
            emitters: vec![emitter("inner", 0.02, 2000.0), emitter("outer", 0.1, 40.0)],
        },
        ambient,
        planes: vec![Plane {
            mask: Arc::new(mask),
            centre_m: DVec3::new(0.0, 0.0, -0.4),
            size_m: [1.2, 0.675],
            tilt_deg: [0.0; 2],
        }],
        exposure: Exposure::Auto,
    }
}

fn view(pixel: Pixel) -> View {
    View { size: [48, 27], pixel, skip: true }
}

fn draw(theatre: &Theatre, view: &View, spp: u32, seed: u64) -> Frame {
    renderer(&Knobs { spp, seed }, Backend::Cpu).unwrap().radiance(theatre, view).unwrap()
}

fn layer<'a>(frame: &'a Frame, name: &str) -> &'a [f32] {
    &frame.layers.iter().find(|l| l.name == name).unwrap().values
}

/// ∫ over the emitter by 400² midpoints in f64 with the mask looked up texel by texel, at a pixel's centre.
fn brute(theatre: &Theatre, view: &View, k: usize, pixel: [usize; 2]) -> f64 {
    let (lamp, plane) = (&theatre.lamp, &theatre.planes[0]);
    let EmitterShape::Rectangle { size_m: [w, h] } = lamp.emitters[k].shape else { unreachable!() };
    let p = crate::project::pixel_m(&theatre.screen, view.size, pixel[0] as f64, pixel[1] as f64).extend(0.0);
    let n = 400;
    let mut sum = 0.0;
    for a in 0..n {
        for b in 0..n {
            let at = |i: i32, side: f64| ((f64::from(i) + 0.5) / f64::from(n) - 0.5) * side;
            let q = lamp.position_m + DVec3::new(at(a, w), at(b, h), 0.0);
            let x = p + (q - p) * (plane.centre_m.z / q.z) - plane.centre_m;
            let texel = |v: f64, side: f64, n: usize| ((v / side + 0.5) * n as f64).floor();
            let (tx, ty) = (
                texel(x.x, plane.size_m[0], plane.mask.width),
                texel(-x.y, plane.size_m[1], plane.mask.height),
            );
            let inside =
                tx >= 0.0 && ty >= 0.0 && tx < plane.mask.width as f64 && ty < plane.mask.height as f64;
            let tau = if inside { plane.mask.transmittance(0, tx as usize, ty as usize) } else { 1.0 };
            sum += tau * q.z * q.z / p.distance_squared(q).powi(2);
        }
    }
    sum * w * h / f64::from(n * n)
}

#[test]
fn agrees_with_brute_force_within_its_standard_error() {
    let theatre = theatre(edge(1), Ambient::None);
    let view = view(Pixel::Centre);
    let frame = draw(&theatre, &view, 1024, 1);
    let j = 13;
    let mut tested = 0;
    for i in 0..view.size[0] {
        let k = j * view.size[0] + i;
        let reflect = 0.8 / std::f64::consts::PI;
        let truth: f64 = reflect
            * (0..2)
                .map(|e| theatre.lamp.emitters[e].radiance[0] * brute(&theatre, &view, e, [i, j]))
                .sum::<f64>();
        let (value, se) = (f64::from(frame.radiance[0][k]), f64::from(layer(&frame, "SE.R")[k]));
        // The midpoint sum errs by about 1/400 of a penumbra that crosses the emitter, and 1e-6 elsewhere.
        let slack = if se > 0.0 { 2e-3 } else { 3e-6 };
        assert!(
            (value - truth).abs() <= 5.0 * se + slack * truth.max(0.1),
            "{i}: {value} ± {se} against {truth}"
        );
        tested += usize::from(se > 0.0);
    }
    assert!(tested >= 2, "no penumbra was looked at");
}

#[test]
fn same_bytes_whatever_the_threads_and_the_skipping() {
    for (mask, pixel) in [(edge(1), Pixel::Area), (edge(3), Pixel::Centre)] {
        let theatre = theatre(mask, Ambient::Paper { k_d_m: 1.0, s: [0.3, 0.2, 0.1] });
        let view = view(pixel);
        let all = draw(&theatre, &view, 40, 3);
        let unskipped = draw(&theatre, &View { skip: false, ..view }, 40, 3);
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let single = one.install(|| draw(&theatre, &view, 40, 3));
        for other in [&unskipped, &single] {
            assert_eq!(all.radiance, other.radiance);
            all.layers
                .iter()
                .zip(&other.layers)
                .for_each(|(a, b)| assert_eq!(a.values, b.values, "{}", a.name));
        }
        assert_eq!(all.stats.counts["spp"], 48);
        assert!(unskipped.stats.counts["samples"] > all.stats.counts["samples"]);
        assert_ne!(all.radiance, draw(&theatre, &view, 40, 4).radiance, "the seed must matter");
    }
}

/// The narrow and wide instruction sets give the same sums.
#[test]
fn vector_width_does_not_matter() {
    let theatre = theatre(edge(3), Ambient::None);
    let view = view(Pixel::Area);
    let masks = [Arc::new(Padded::new(&theatre.planes[0].mask))];
    let plan = plan::Plan::new(&theatre, &view, &masks).unwrap();
    let points = Points::new(1, 37);
    let sampler =
        native::Sampler { plan: &plan, masks: &masks, points: &points, samples: 37, seed: 5, planes: 0..1 };
    for i in 20..28 {
        assert_eq!(sampler.sums::<3>(1, i, 13, [0.0; 3]), sampler.sums_any::<3>(1, i, 13, [0.0; 3]));
    }
}

#[test]
fn the_standard_error_is_the_error() {
    let theatre = theatre(edge(1), Ambient::None);
    let view = view(Pixel::Area);
    let truth = draw(&theatre, &view, 1 << 14, 99);
    let (mut sum, mut n) = (0.0, 0);
    for seed in 0..20 {
        let frame = draw(&theatre, &view, 64, seed);
        for (k, se) in layer(&frame, "SE.G").iter().enumerate().filter(|(_, se)| **se > 0.0) {
            sum += f64::from((frame.radiance[1][k] - truth.radiance[1][k]) / se).powi(2);
            n += 1;
        }
    }
    // The mean of squared t with 15 degrees of freedom is 15/13.
    let mean = sum / f64::from(n);
    assert!(n > 1000 && (0.9..1.5).contains(&mean), "{mean} over {n}");
}

#[test]
fn refuses_what_it_cannot_draw() {
    let mut tilted = theatre(edge(1), Ambient::None);
    tilted.planes[0].tilt_deg = [10.0, 0.0];
    let mut dome = theatre(edge(1), Ambient::None);
    dome.ambient = Ambient::Dome { radiance: [1.0; 3] };
    let mut mc = renderer(&Knobs::default(), Backend::Cpu).unwrap();
    for (theatre, key) in [(tilted, "puppets[0].tilt_deg"), (dome, "dome")] {
        let error = mc.radiance(&theatre, &view(Pixel::Area)).unwrap_err().to_string();
        assert!(error.contains(key), "{error}");
    }
    assert!(renderer(&Knobs { spp: 0, seed: 0 }, Backend::Cpu).is_err());
}

fn on_gpu(theatre: &Theatre, view: &View, wgsl: &str) -> Frame {
    let gpu = crate::gpu::choose(Backend::Gpu).expect("the tests need a Vulkan adapter").unwrap();
    let sampler = gpu::Sampler::new(gpu, wgsl).unwrap();
    Mc::new(Knobs { spp: 256, seed: 3 }, Some(sampler)).radiance(theatre, view).unwrap()
}

/// Largest difference of any channel of radiance in units of the brightest unshadowed pixel of `a`'s red.
fn distance(a: &Frame, b: &Frame) -> f32 {
    let full = a.radiance.iter().flatten().fold(0f32, |m, v| m.max(*v));
    let pairs = a.radiance.iter().flatten().zip(b.radiance.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs() / full).fold(0.0, f32::max)
}

/// The GPU draws the very same points, so it differs from the CPU by f32 rounding alone: at worst one of 256 samples
/// falls on the other side of a texel's edge. A shader whose weights are 2 % off must be told apart.
#[test]
fn gpu_agrees_with_cpu() {
    let mut several = theatre(edge(3), Ambient::Paper { k_d_m: 1.0, s: [0.3, 0.2, 0.1] });
    let mut second = several.planes[0].clone();
    second.centre_m = DVec3::new(0.1, 0.1, -0.7);
    second.mask = Arc::new(edge(1));
    several.planes.push(second);
    for (theatre, pixel) in [(theatre(edge(1), Ambient::None), Pixel::Centre), (several, Pixel::Area)] {
        let view = view(pixel);
        let cpu = draw(&theatre, &view, 256, 3);
        let gpu = on_gpu(&theatre, &view, gpu::WGSL);
        assert!(distance(&cpu, &gpu) < 5e-4, "{}", distance(&cpu, &gpu));
        for layer in &cpu.layers {
            let other = self::layer(&gpu, &layer.name);
            let worst = layer.values.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst < 5e-3, "{}: {worst}", layer.name);
        }
        assert_ne!(
            cpu.radiance, gpu.radiance,
            "the GPU's sums are f32, the CPU's f64: equal bits were not drawn twice"
        );
        let wrong = gpu::WGSL.replace("(1.0 / (w * w))", "(0.98 / (w * w))");
        assert!(distance(&cpu, &on_gpu(&theatre, &view, &wrong)) > 5e-3);
    }
}

#[test]
fn structs_are_laid_out_as_the_shader_expects() {
    use crate::gpu::tests::same_layout;
    same_layout!(
        gpu::WGSL,
        "Params",
        gpu::Params { width, height, samples, jobs, planes, seed, area, channels }
    );
    same_layout!(gpu::WGSL, "Job", estimate::Job { x, y, emitter, first, end, v0_r, v0_g, v0_b });
    same_layout!(gpu::WGSL, "Axis", gpu::GpuAxis { offset, low, high, anchor });
    same_layout!(gpu::WGSL, "Emitter", gpu::Emitter { side_x, side_y, pixel_x, pixel_y });
    same_layout!(gpu::WGSL, "Map", gpu::Map { emitter_x, emitter_y, pixel_x, pixel_y, layer, channels });
}
