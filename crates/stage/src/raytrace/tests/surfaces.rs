//! What surfaces do with light.

use std::f64::consts::PI;

use super::*;

/// An integrating sphere: of its own light each point gets the same from everywhere, E₁ = ρ E₀. (A furnace of convex bodies would say nothing:
/// there nothing sends light on.)
#[test]
fn an_integrating_sphere_sends_its_light_on() {
    for form in [Form::Sphere { radius_m: 1.0 }, mesh(ball(64), true)] {
        let mut wall = object("wall", form.clone(), DVec3::ZERO);
        wall.surface = Surface::Matte { albedo: [0.8, 0.5, 0.25], texture: None };
        let mut scene = stage(vec![wall], vec![point([0.0; 3], 1.0)]);
        scene.camera.pose = Pose::looking(DVec3::new(0.0, 0.3, 0.2), DVec3::new(0.0, 0.0, -1.0), DVec3::Y);
        scene.camera.projection = Projection::with_field_of_view(60.0, 1.0);
        let frame = draw(&scene, VIEW, Knobs { spp: 256, bounces: 1, ..Knobs::default() });
        let direct = draw(&scene, VIEW, Knobs::default());
        for (c, albedo) in [0.8, 0.5, 0.25].into_iter().enumerate() {
            for k in 0..256 {
                let [one, both] = [&direct, &frame].map(|f| PI * f64::from(f.radiance[c][k]) / albedo);
                assert!((one - 1.0).abs() < 0.004, "E₀ = 1: {one}");
                // Triangles of 3° are nearer to the middle than the sphere, by as much as 0.1%.
                assert!((both / (1.0 + albedo) - 1.0).abs() < 0.004, "{both} of {}", 1.0 + albedo);
            }
        }
        if matches!(form, Form::Sphere { .. }) {
            let share = covered(&frame, |_| 0.8 * 1.8);
            assert!(share > 0.9, "{share}");
        }
    }
}

/// A wall lit by a floor: bounced light where no lamp is seen, against a quadrature over the floor.
#[test]
fn a_wall_is_lit_by_the_floor_in_front_of_it() {
    // The lamp is behind the wall's plane for the wall, and above the floor for the floor: only the floor is lit.
    let mut wall = object("wall", Form::Rectangle { size_m: [1.0, 1.0] }, DVec3::new(0.0, 0.5, 0.0));
    wall.casts = false;
    let mut ground = object("ground", Form::Rectangle { size_m: [2.0, 2.0] }, DVec3::new(0.0, 0.0, 1.0));
    ground.pose.rotation = DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    let lamp = DVec3::new(0.0, 1.0, -0.5);
    let mut scene = stage(vec![wall, ground], vec![point(lamp.to_array(), 1.0)]);
    scene.camera.pose = Pose { position_m: DVec3::new(0.0, 0.5, 0.05), ..Pose::default() };
    scene.camera.projection = Projection::Orthographic { width_m: 0.8 };
    let frame = draw(&scene, VIEW, Knobs { spp: 1024, bounces: 1, ..Knobs::default() });
    let right = |k: usize| {
        let (i, j) = (k % 16, k / 16);
        let p = DVec3::new(
            ((i as f64 + 0.5) / 16.0 - 0.5) * 0.8,
            0.5 + (0.5 - (j as f64 + 0.5) / 16.0) * 0.8,
            0.0,
        );
        let n = 200;
        let mut sum = 0.0;
        for a in 0..n * n {
            let q = DVec3::new(
                2.0 * ((a % n) as f64 + 0.5) / n as f64 - 1.0,
                0.0,
                2.0 * ((a / n) as f64 + 0.5) / n as f64,
            );
            let (to, from) = (q - p, lamp - q);
            let radiance = from.y / from.length().powi(3) / PI;
            sum += radiance * (to.z / to.length()) * (-to.y / to.length()) / to.length_squared()
                * (2.0 / n as f64).powi(2);
        }
        sum
    };
    assert_covers(&frame, right);
}

/// Through a mirror is seen what a mirrored camera sees.
#[test]
fn a_mirror_shows_what_is_behind_it() {
    let card = |x: f64| {
        let mut card = object("card", Form::Rectangle { size_m: [0.5, 0.5] }, DVec3::new(x, 0.1, 2.0));
        // It faces −z.
        card.pose.rotation = DQuat::from_rotation_y(PI);
        card
    };
    let lamp = || point([0.4, 0.8, 0.5], 1.0);
    let mut glass = object("glass", Form::Rectangle { size_m: [50.0, 50.0] }, DVec3::ZERO);
    glass.surface = Surface::Mirror { reflectance: [0.5, 1.0, 1.0] };
    let mut through = stage(vec![glass, card(0.1)], vec![lamp()]);
    through.camera.projection = Projection::with_field_of_view(30.0, 1.0);
    through.camera.pose = Pose::looking(DVec3::new(0.2, 0.3, 1.0), DVec3::new(0.2, 0.3, 0.0), DVec3::Y);
    // From the other side of where the mirror was, left and right changed over.
    let mut direct = stage(vec![card(0.1)], vec![lamp()]);
    direct.camera.projection = through.camera.projection;
    direct.camera.pose = Pose::looking(DVec3::new(0.2, 0.3, -1.0), DVec3::new(0.2, 0.3, 0.0), DVec3::Y);
    let [a, b] =
        [&through, &direct].map(|scene| draw(scene, View { size: [32, 32], ..VIEW }, Knobs::default()));
    let mut seen = 0;
    for j in 0..32 {
        for i in 0..32 {
            let (here, there) = (j * 32 + i, j * 32 + 31 - i);
            seen += usize::from(b.radiance[0][there] > 0.0);
            for (c, share) in [(0, 0.5), (1, 1.0)] {
                assert!((a.radiance[c][here] - share * b.radiance[c][there]).abs() < 1e-6, "{i} {j}");
            }
        }
    }
    assert!(seen > 20, "{seen}");
}

/// A pixel's area: of a lamp that shines by itself, the share that it covers.
#[test]
fn a_pixel_is_the_mean_over_its_area() {
    let lamp = LightKind::Area {
        // Facing up to the camera.
        pose: Pose { rotation: DQuat::from_rotation_x(-PI / 2.0), ..Pose::default() },
        shape: AreaShape::Rectangle { size_m: [0.55, 0.3] },
        radiance: [1.0; 3],
    };
    let view = View { pixel: Pixel::Area, ..VIEW };
    let frame = draw(&stage(vec![], vec![lamp]), view, Knobs { spp: 256, ..Knobs::default() });
    let share = |k: usize| {
        let p = middle(view, k, 1.0);
        let cover = |at: f64, half: f64| ((half - at.abs()) * 16.0 + 0.5).clamp(0.0, 1.0);
        cover(p.x, 0.275) * cover(p.z, 0.15)
    };
    let total: f64 = frame.radiance[0].iter().map(|l| f64::from(*l)).sum();
    assert!((total / (0.55 * 0.3 * 256.0) - 1.0).abs() < 0.003, "{total}");
    let se = &frame.standard_error.as_ref().expect("errors")[0];
    for (k, se) in se.iter().enumerate() {
        let (value, right) = (f64::from(frame.radiance[0][k]), share(k));
        assert!((value - right).abs() < 5.0 * f64::from(*se) + 1e-6, "{k}: {value} {right}");
        assert!((value - right).abs() < 0.02);
    }
}

/// Ambient light is albedo × radiance, on all that no lamp reaches, too.
#[test]
fn ambient_light_is_everywhere() {
    let mut scene = stage(vec![floor()], vec![]);
    scene.objects[0].surface = Surface::Matte { albedo: [0.5, 0.25, 1.0], texture: None };
    scene.ambient = [0.2, 0.4, 0.0];
    let frame = draw(&scene, VIEW, Knobs::default());
    assert_eq!([0, 1, 2].map(|c| frame.radiance[c][3]), [0.1, 0.1, 0.0]);
}

/// A smooth ball is shaded as the ball that its triangles stand for; a flat one by its facets.
#[test]
fn smooth_normals_are_those_of_the_ball() {
    let picture = |form: Form| {
        let mut scene = stage(vec![object("ball", form, DVec3::ZERO)], vec![]);
        scene.lights.push(Light {
            name: "sun".into(),
            kind: LightKind::Directional {
                direction: DVec3::NEG_Y,
                irradiance: [1.0; 3],
                angular_radius_deg: 0.0,
            },
        });
        draw(&scene, VIEW, Knobs::default()).radiance[0].clone()
    };
    let exact = picture(Form::Sphere { radius_m: 1.0 });
    let worst = |other: Vec<f32>| exact.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0f32, f32::max);
    let (smooth, flat) = (worst(picture(mesh(ball(24), true))), worst(picture(mesh(ball(24), false))));
    assert!(smooth < 0.002 && flat > 0.01, "{smooth} {flat}");
}
