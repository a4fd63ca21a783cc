#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
use glam::DVec3;
use kelir_frame::Pixel;
use kelir_scene::*;

use super::twins::crooked;
use super::*;
use crate::irradiance;
use crate::trace::scenes::{edge, theatre, view};

fn draw(theatre: &Theatre, view: &View, spp: u32, seed: u64) -> Frame {
    renderer(&Knobs { spp, seed, ..Knobs::default() }, Backend::Cpu).unwrap().radiance(theatre, view).unwrap()
}

fn channel<'a>(frame: &'a Frame, name: &str) -> &'a [f32] {
    frame.channels().find(|(n, _)| n == name).unwrap().1
}

/// What the light from `q` to `p` keeps on its way through all planes, texel by texel in f64.
fn transmittance(theatre: &Theatre, p: DVec3, towards: DVec3) -> f64 {
    let through = theatre.planes.iter().map(|plane| {
        let [x, y] = plane.tilt_deg.map(f64::to_radians);
        let turn = glam::DMat3::from_rotation_y(y) * glam::DMat3::from_rotation_x(x);
        let t = turn.z_axis.dot(plane.centre_m - p) / turn.z_axis.dot(towards);
        let hit = p + t * towards - plane.centre_m;
        let (u, v) = (turn.x_axis.dot(hit) / plane.size_m[0], turn.y_axis.dot(hit) / plane.size_m[1]);
        let (w, h) = (plane.mask.width as f64, plane.mask.height as f64);
        let (tx, ty) = (((u + 0.5) * w).floor(), ((0.5 - v) * h).floor());
        match tx >= 0.0 && ty >= 0.0 && tx < w && ty < h {
            true => plane.mask.transmittance(0, tx as usize, ty as usize),
            false => 1.0,
        }
    });
    through.product()
}

/// E / L of source `k` (behind the last emitter: the dome) by 400² midpoints, at a pixel's centre.
fn brute(theatre: &Theatre, view: &View, k: usize, pixel: [usize; 2]) -> f64 {
    let p = crate::project::pixel_m(&theatre.screen, view.size, pixel[0] as f64, pixel[1] as f64).extend(0.0);
    let n = 400;
    let middles = (0..n * n).map(|i| [i % n, i / n].map(|i| (f64::from(i) + 0.5) / f64::from(n)));
    let cells = f64::from(n * n);
    let Some(emitter) = theatre.lamp.emitters.get(k) else {
        // Cosine-weighted directions in polar coordinates.
        let direction = |[a, b]: [f64; 2]| {
            let (r, phi) = (a.sqrt(), b * std::f64::consts::TAU);
            DVec3::new(r * phi.cos(), r * phi.sin(), -(1.0 - a).sqrt())
        };
        let sum: f64 = middles.map(|m| transmittance(theatre, p, direction(m))).sum();
        return sum / cells * std::f64::consts::PI;
    };
    let lamp = theatre.lamp.position_m;
    let from = |q: DVec3| transmittance(theatre, p, q - p) * q.z * q.z / p.distance_squared(q).powi(2);
    let at = |x: f64, y: f64| lamp + DVec3::new(x, y, 0.0);
    let sum: f64 = match emitter.shape {
        EmitterShape::Rectangle { size_m: [w, h] } => {
            middles.map(|[a, b]| from(at((a - 0.5) * w, (b - 0.5) * h))).sum()
        }
        EmitterShape::Disk { radius_m } => middles
            .map(|[a, b]| {
                let (r, phi) = (radius_m * a.sqrt(), b * std::f64::consts::TAU);
                from(at(r * phi.cos(), r * phi.sin()))
            })
            .sum(),
    };
    sum / cells * emitter.shape.area_m2()
}

/// Every source alone against midpoint sums, one of them (the wrong tilt) as a negative control.
#[test]
fn disks_tilts_and_the_dome_agree_with_brute_force() {
    let (scene, view) = (crooked(), view(Pixel::Centre));
    let frame = draw(&scene, &view, 4096, 1);
    let mut other = scene.clone();
    other.planes[0].tilt_deg = [-20.0, -35.0];
    let (mut worst, mut control) = (0f64, 0f64);
    for (k, name) in ["Virr.inner", "Virr.outer", "Virr.dome"].into_iter().enumerate() {
        let bare = Theatre { planes: vec![], ..scene.clone() };
        for pixel in [[3, 4], [20, 10], [24, 13], [27, 20], [33, 5], [22, 26], [40, 22]] {
            let value = f64::from(channel(&frame, name)[pixel[1] * view.size[0] + pixel[0]]);
            let lit = brute(&bare, &view, k, pixel);
            worst = worst.max((value - brute(&scene, &view, k, pixel) / lit).abs());
            control = control.max((value - brute(&other, &view, k, pixel) / lit).abs());
        }
    }
    assert!(worst < 6e-3, "{worst}");
    assert!(control > 2e-2, "{control}");
}

/// Steep planes whose horizon is in sight, up to 89.9°: the bounds hold (what they call known, sampling finds too), and
/// nothing is NaN or outside [0, 1].
#[test]
fn bounds_hold_for_steep_planes() {
    let view = view(Pixel::Area);
    for tilt in [[60.0, 0.0], [0.0, 85.0], [89.9, 0.0], [70.0, -80.0]] {
        let mut scene = theatre(edge(1), Ambient::None);
        scene.planes[0].tilt_deg = tilt;
        scene.planes[0].size_m = [0.8, 0.45];
        let skipped = draw(&scene, &view, 64, 1);
        let all = draw(&scene, &View { skip: false, ..view }, 64, 1);
        assert_eq!(skipped.radiance, all.radiance, "{tilt:?}");
        let visibility = channel(&skipped, "Virr.outer");
        assert!(visibility.iter().all(|v| (-1e-3..1.02).contains(v)), "{tilt:?}");
        assert!(visibility.iter().any(|v| *v < 0.99), "{tilt:?}");
    }
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
        let (value, se) = (f64::from(frame.radiance[0][k]), f64::from(channel(&frame, "SE.R")[k]));
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
            assert!(all.channels().eq(other.channels()));
        }
        assert_eq!(all.stats.counts["spp"], 48);
        assert!(unskipped.stats.counts["samples"] > all.stats.counts["samples"]);
        assert_ne!(all.radiance, draw(&theatre, &view, 40, 4).radiance, "the seed must matter");
    }
}

/// Intervals of Student's t with 15 degrees of freedom cover as often as they say: at 50 %, where the tails don't count, and at 95 %, which
/// a step's few values may miss by some percent. Half the standard error covers far less.
#[test]
fn the_standard_error_is_the_error() {
    let theatre = theatre(edge(1), Ambient::None);
    let view = view(Pixel::Area);
    let truth = draw(&theatre, &view, 1 << 14, 99);
    let mut errors = Vec::new();
    for seed in 0..20 {
        let frame = draw(&theatre, &view, 256, seed);
        for (k, se) in channel(&frame, "SE.G").iter().enumerate().filter(|(_, se)| **se > 0.0) {
            errors.push(f64::from((frame.radiance[1][k] - truth.radiance[1][k]).abs() / se));
        }
    }
    let within = |most: f64| errors.iter().filter(|e| **e <= most).count() as f64 / errors.len() as f64;
    let [half, nearly_all, control] = [within(0.6912), within(2.1314), within(0.5 * 0.6912)];
    assert!(errors.len() > 1000, "{}", errors.len());
    assert!((0.42..0.58).contains(&half) && (0.88..0.98).contains(&nearly_all), "{half}, {nearly_all}");
    assert!(control < 0.35, "{control}");
}

#[test]
fn refuses_knobs_out_of_range() {
    let wrong = [
        (Knobs { spp: 0, ..Knobs::default() }, "spp"),
        (Knobs { spp: (1 << 20) + 1, ..Knobs::default() }, "spp"),
        (Knobs { target_error: Some(0.0), ..Knobs::default() }, "target_error"),
        (Knobs { time_limit_s: Some(f64::NAN), ..Knobs::default() }, "time_limit_s"),
    ];
    for (knobs, name) in wrong {
        let error = renderer(&knobs, Backend::Cpu).err().unwrap().to_string();
        assert!(error.contains(name), "{error}");
    }
}

/// The error asked for is reached, not by far too many samples, and the count that was frozen replays the bytes.
#[test]
fn a_target_error_is_reached_and_replayed() {
    let (theatre, view) = (theatre(edge(1), Ambient::None), view(Pixel::Area));
    let target = 1e-3;
    let knobs = Knobs { target_error: Some(target), ..Knobs::default() };
    let frame = renderer(&knobs, Backend::Cpu).unwrap().radiance(&theatre, &view).unwrap();
    let reached = frame.stats.values["se_rms"];
    assert!((0.3 * target..1.1 * target).contains(&reached), "{reached}");
    let replay = draw(&theatre, &view, frame.stats.counts["spp"] as u32, knobs.seed);
    assert_eq!(frame.radiance, replay.radiance);
    let knobs = Knobs { time_limit_s: Some(1e-3), ..Knobs::default() };
    let hurried = renderer(&knobs, Backend::Cpu).unwrap().radiance(&theatre, &view).unwrap();
    assert_eq!(
        hurried.radiance,
        draw(&theatre, &view, hurried.stats.counts["spp"] as u32, knobs.seed).radiance
    );
}

/// Over a pixel, visibility is the mean of E over the mean of E⁰, in MC as in the oracle. Neither the mean of E / E⁰ nor the
/// mean of E over E⁰ at the centre is the same.
#[test]
fn over_a_pixel_visibility_is_mean_over_mean() {
    let mut scene = theatre(edge(1), Ambient::None);
    scene.lamp.emitters.remove(0);
    scene.lamp.position_m.x = 0.4;
    scene.planes[0].size_m[1] = 2.0;
    let view = view(Pixel::Area);
    let frame = draw(&scene, &view, 1 << 14, 1);
    let (shape, lamp) = (scene.lamp.emitters[0].shape, scene.lamp.position_m);
    // Mean differences from the definition over all penumbra pixels: of MC, of the oracle, and of two other definitions.
    let (mut sums, mut tested) = ([0.0; 4], 0.0);
    for (pixel, drawn) in channel(&frame, "Virr.outer").iter().enumerate() {
        if !(0.01..0.99).contains(drawn) {
            continue;
        }
        let (i, j) = (pixel % view.size[0], pixel / view.size[0]);
        // The edge is vertical: midpoints are dense along x.
        let [mut e, mut lit, mut ratio] = [0.0; 3];
        for k in 0..256 * 4 {
            let part = |k: usize, n: usize| (k as f64 + 0.5) / n as f64 - 0.5;
            let at = [i as f64 + part(k % 256, 256), j as f64 + part(k / 256, 4)];
            let p = crate::project::pixel_m(&scene.screen, view.size, at[0], at[1]);
            let seen = crate::oracle::visibility(&scene, 0, crate::oracle::Point::At(p), 1.0).irradiance[0];
            let unit = irradiance::unit(&shape, lamp, p);
            (e, lit, ratio) = (e + seen * unit, lit + unit, ratio + seen);
        }
        let centre = crate::project::pixel_m(&scene.screen, view.size, i as f64, j as f64);
        let point = crate::oracle::Point::pixel(&scene, &view, i, j);
        let oracle = crate::oracle::visibility(&scene, 0, point, 1e-6).irradiance[0];
        let at_centre = e / 1024.0 / irradiance::unit(&shape, lamp, centre);
        let differences = [f64::from(*drawn), oracle, ratio / 1024.0, at_centre].map(|v| v - e / lit);
        sums.iter_mut().zip(differences).for_each(|(s, d)| *s += d);
        assert!((oracle - e / lit).abs() < 1e-5, "{oracle} {}", e / lit);
        tested += 1.0;
    }
    let [mc, oracle, of_ratios, at_centre] = sums.map(|s: f64| (s / tested).abs());
    assert!(tested > 40.0 && mc < 1.5e-5 && oracle < 1e-6, "{tested} {mc:e} {oracle:e}");
    assert!(of_ratios > 4e-5 && at_centre > 4e-5, "{of_ratios:e} {at_centre:e}");
}
