//! Every kind of light against its closed form.

use std::f64::consts::PI;

use kelir_scene::LinearImage;

use super::*;

/// Irradiance under the corner of a parallel rectangle at distance 1 of sides a and b and radiance 1 (Lambert 1760, by way of Howell's catalogue
/// of configuration factors, B-4); odd in both, so that rectangles anywhere are sums of four.
fn corner(a: f64, b: f64) -> f64 {
    let term = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
    0.5 * (term(a, b) + term(b, a))
}

/// Irradiance from a rectangle at a height, x and z from its first to its second.
fn rectangle(p: DVec3, height: f64, x: [f64; 2], z: [f64; 2]) -> f64 {
    let [x0, x1] = x.map(|x| (x - p.x) / height);
    let [z0, z1] = z.map(|z| (z - p.z) / height);
    corner(x1, z1) - corner(x0, z1) - corner(x1, z0) + corner(x0, z0)
}

#[test]
fn a_point_falls_off_with_distance_and_cosine() {
    let frame = draw(&stage(vec![floor()], vec![point([0.2, 0.7, -0.1], 3.0)]), VIEW, Knobs::default());
    assert!(frame.standard_error.is_none(), "nothing is estimated");
    for k in 0..256 {
        let to = DVec3::new(0.2, 0.7, -0.1) - middle(VIEW, k, 1.0);
        let right = 3.0 * 0.7 / to.length().powi(3);
        assert!((irradiance(&frame, k) / right - 1.0).abs() < 1e-6);
    }
}

/// Exact ends of a sphere's shadow on the ground: radius 1 at height 2 under a point 4 high, x to the side.
#[test]
fn a_spheres_shadow_ends_where_it_should() {
    for (x, [low, high]) in [(1.0, [-4.333, 1.0]), (2.0, [-6.861, 0.194]), (4.0, [-12.479, -0.855])] {
        let shadow = |form: Form| {
            let ball = object("ball", form, DVec3::new(0.0, 2.0, 0.0));
            let mut scene = stage(vec![floor(), ball], vec![point([x, 4.0, 0.0], 1.0)]);
            // A line of 8,000 pixels of 4 mm, from below, where no ball is in the way.
            scene.camera.pose.position_m = DVec3::new(0.0, -1.0, 0.0);
            scene.camera.pose.rotation = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
            scene.camera.projection = Projection::Orthographic { width_m: 32.0 };
            scene.camera.aspect = 8000.0;
            // Both sides of the floor are lit, but only the upper one by this lamp: so look at the upper one.
            scene.camera.pose.position_m.y = 0.5;
            scene.camera.pose.rotation = DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2);
            let frame = draw(&scene, View { size: [8000, 1], ..VIEW }, Knobs::default());
            let at = |k: usize| (k as f64 + 0.5) / 8000.0 * 32.0 - 16.0;
            let dark: Vec<f64> = (0..8000).filter(|k| frame.radiance[0][*k] == 0.0).map(at).collect();
            [dark[0], dark[dark.len() - 1]]
        };
        let [from, to] = shadow(Form::Sphere { radius_m: 1.0 });
        assert!((from - low).abs() < 0.005 && (to - high).abs() < 0.005, "{x}: {from} to {to}");
        // Of triangles: inscribed, and so a little smaller.
        let [from, to] = shadow(mesh(ball(200), false));
        assert!((from - low).abs() < 0.02 && (to - high).abs() < 0.01, "{x}: {from} to {to}");
    }
}

#[test]
fn a_rectangle_is_lamberts() {
    let lamp = LightKind::Area {
        pose: overhead(0.8),
        shape: AreaShape::Rectangle { size_m: [0.6, 0.3] },
        radiance: [1.0; 3],
    };
    // The camera is above the lamp, whose back is black: so look from beside.
    let mut scene = stage(vec![floor()], vec![lamp]);
    scene.camera.pose.position_m.y = 0.5;
    let frame = draw(&scene, VIEW, Knobs::default());
    assert_covers(&frame, |k| rectangle(middle(VIEW, k, 1.0), 0.8, [-0.3, 0.3], [-0.15, 0.15]));
}

/// Half of the lamp hides behind an edge: what is left is a rectangle again, which one depends on the pixel.
#[test]
fn a_penumbra_of_an_edge_is_a_smaller_lamp() {
    let lamp = LightKind::Area {
        pose: overhead(1.0),
        shape: AreaShape::Rectangle { size_m: [0.2, 0.2] },
        radiance: [1.0; 3],
    };
    // From x = 0 to far away on the right, half way up.
    let mut card = object("card", Form::Rectangle { size_m: [10.0, 10.0] }, DVec3::new(5.0, 0.5, 0.0));
    card.pose.rotation = DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    let mut scene = stage(vec![floor(), card], vec![lamp]);
    scene.camera.pose.position_m.y = 0.4;
    scene.camera.projection = Projection::Orthographic { width_m: 0.5 };
    let frame = draw(&scene, VIEW, Knobs { spp: 256, ..Knobs::default() });
    // From p the edge x = 0 at half height is seen at x = −p.x on the lamp.
    let right = |k: usize| {
        let p = middle(VIEW, k, 0.5);
        rectangle(p, 1.0, [-0.1, (-p.x).clamp(-0.1, 0.1)], [-0.1, 0.1])
    };
    let shades = (0..256).filter(|k| right(*k) > 0.0 && middle(VIEW, *k, 0.5).x.abs() < 0.1).count();
    assert!(shades >= 90, "{shades} pixels in the penumbra");
    let share = covered(&frame, right);
    assert!((0.9..=1.0).contains(&share), "covered {share}");
    let off = covered(&frame, |k| right(k) + 0.02 * rectangle(DVec3::ZERO, 1.0, [-0.1, 0.1], [-0.1, 0.1]));
    assert!(off < 0.5, "2% of full light off is covered, too: {off}");
}

#[test]
fn a_disk_on_its_axis_is_pi_l_sine_squared() {
    let lamp =
        LightKind::Area { pose: overhead(0.5), shape: AreaShape::Disk { radius_m: 0.4 }, radiance: [1.0; 3] };
    let mut scene = stage(vec![floor()], vec![lamp]);
    scene.camera.pose.position_m.y = 0.3;
    // So near to the axis that all pixels are on it.
    scene.camera.projection = Projection::Orthographic { width_m: 1e-6 };
    let frame = draw(&scene, VIEW, Knobs { spp: 1024, ..Knobs::default() });
    assert_covers(&frame, |_| PI * 0.16 / (0.16 + 0.25));
}

#[test]
fn a_sun_gives_its_irradiance_whatever_its_size() {
    let light = |angular_radius_deg| LightKind::Directional {
        direction: DVec3::new(0.0, -4.0, 3.0) / 5.0,
        irradiance: [2.0; 3],
        angular_radius_deg,
    };
    let hard = draw(&stage(vec![floor()], vec![light(0.0)]), VIEW, Knobs::default());
    assert!((irradiance(&hard, 7) - 1.6).abs() < 1e-6 && hard.standard_error.is_none());
    let soft = draw(&stage(vec![floor()], vec![light(20.0)]), VIEW, Knobs::default());
    // A cone that is all above the horizon: by symmetry the cosine's mean is the axis's.
    assert_covers(&soft, |_| 1.6);
}

#[test]
fn environments_are_what_a_quadrature_makes_of_them() {
    let rgb: Vec<[f32; 3]> = (0..16 * 8)
        .map(|k| {
            let bright = if k == 16 * 2 + 9 { 40.0 } else { 0.5 + ((k * 37) % 11) as f32 * 0.1 };
            [bright, 0.5 * bright, 1.0]
        })
        .collect();
    let environment = Environment { image: Arc::new(LinearImage::new(16, 8, &rgb)), scale: [1.0, 1.0, 0.3] };
    let scene = stage(vec![floor()], vec![LightKind::Environment(environment.clone())]);
    let frame = draw(&scene, VIEW, Knobs { spp: 4096, ..Knobs::default() });
    // E = ∫ L cos over the upper half: midpoints in polar angle and azimuth.
    let n = 1000;
    let mut right = [0.0; 3];
    for a in 0..n {
        let theta = 0.5 * PI * (a as f64 + 0.5) / n as f64;
        for b in 0..2 * n {
            let phi = PI * (b as f64 + 0.5) / n as f64;
            let to = DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
            let weight = theta.cos() * theta.sin() * (0.5 * PI / n as f64) * (PI / n as f64);
            let radiance = environment.radiance(to);
            (0..3).for_each(|c| right[c] += weight * radiance[c]);
        }
    }
    assert_covers(&frame, |_| right[0]);
    // An even one is π L.
    let even = Environment { image: Arc::new(LinearImage::new(4, 2, &[[1.0; 3]; 8])), scale: [2.0; 3] };
    let scene = stage(vec![floor()], vec![LightKind::Environment(even)]);
    let frame = draw(&scene, VIEW, Knobs { spp: 4096, ..Knobs::default() });
    assert_covers(&frame, |_| 2.0 * PI);
}

#[test]
fn a_slide_falls_on_the_floor_as_it_was_thrown() {
    let slide =
        Slide::new(Pattern::Sine { amplitude: 1.0, frequency: [1.0, 3.0], phase_deg: [0.0; 2] }, 0.0, 0.1);
    // Straight down, with −z on top as the camera has it.
    let pose = Pose::looking(DVec3::new(0.0, 2.0, 0.0), DVec3::ZERO, DVec3::NEG_Z);
    for falloff in [true, false] {
        let projector =
            Projector { pose, throw_deg: 30.0, intensity: [2.0; 3], falloff, slide: slide.clone() };
        let scene = stage(vec![floor()], vec![LightKind::Projector(Box::new(projector))]);
        let frame = draw(&scene, VIEW, Knobs::default());
        let side = 4.0 * 15f64.to_radians().tan();
        for k in 0..256 {
            let p = middle(VIEW, k, 1.0);
            let r = p.distance(DVec3::new(0.0, 2.0, 0.0));
            let s = slide.at(0.5 + p.x / side, 0.5 + p.z / side)[0];
            let right = 2.0 * s * (2.0 / r) / if falloff { r * r } else { 1.0 };
            assert!((irradiance(&frame, k) - right).abs() < 1e-6, "{k}");
        }
    }
}

/// What is dark is dark: from below, and behind a lamp's back.
#[test]
fn backs_are_not_lit() {
    let below = draw(&stage(vec![floor()], vec![point([0.0, -1.0, 0.0], 1.0)]), VIEW, Knobs::default());
    assert!(below.radiance[0].iter().all(|l| *l == 0.0));
    let mut pose = overhead(1.0);
    pose.rotation = DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    let lamp = LightKind::Area { pose, shape: AreaShape::Rectangle { size_m: [0.2; 2] }, radiance: [1.0; 3] };
    let mut scene = stage(vec![floor()], vec![lamp]);
    scene.camera.pose.position_m.y = 0.5;
    assert!(draw(&scene, VIEW, Knobs::default()).radiance[0].iter().all(|l| *l == 0.0));
}
