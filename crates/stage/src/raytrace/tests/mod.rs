//! The tracer against closed forms. What is estimated is judged by its own standard error, which a wrong value must not pass.

mod lights;
mod meshes;
mod surfaces;

use std::sync::Arc;

use glam::{DQuat, DVec3};
use kelir_frame::{Frame, Pixel, View};
use kelir_mesh::Mesh;
use kelir_scene::Exposure;
use kelir_scene::stage::*;

use super::{Knobs, renderer};

pub(crate) const VIEW: View = View { size: [16, 16], pixel: Pixel::Centre, skip: true };

/// A stage of these, seen from above: an orthographic camera, 1 m wide, over the origin; x to the right and −z upwards in the picture.
pub(crate) fn stage(objects: Vec<Object>, lights: Vec<LightKind>) -> Stage {
    let pose = Pose {
        position_m: DVec3::new(0.0, 50.0, 0.0),
        rotation: DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2),
        scale: 1.0,
    };
    let light = |(k, kind)| Light { name: format!("light{k}"), kind };
    Stage {
        camera: Camera { pose, projection: Projection::Orthographic { width_m: 1.0 }, aspect: 1.0 },
        objects,
        lights: lights.into_iter().enumerate().map(light).collect(),
        ambient: [0.0; 3],
        exposure: Exposure::Auto,
    }
}

pub(crate) fn object(name: &str, form: Form, position_m: DVec3) -> Object {
    Object {
        name: name.into(),
        form,
        pose: Pose { position_m, ..Pose::default() },
        surface: Surface::Matte { albedo: [1.0; 3], texture: None },
        casts: true,
    }
}

/// A white floor of 100 m.
pub(crate) fn floor() -> Object {
    let mut floor = object("floor", Form::Rectangle { size_m: [100.0; 2] }, DVec3::ZERO);
    floor.pose.rotation = DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    floor
}

/// What faces down from so high over the origin.
pub(crate) fn overhead(height_m: f64) -> Pose {
    Pose {
        position_m: DVec3::new(0.0, height_m, 0.0),
        rotation: DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2),
        scale: 1.0,
    }
}

pub(crate) fn point(position: [f64; 3], intensity: f64) -> LightKind {
    LightKind::Point { position_m: position.into(), intensity: [intensity; 3] }
}

pub(crate) fn draw(stage: &Stage, view: View, knobs: Knobs) -> Frame {
    renderer(&knobs).radiance(stage, &view).expect("a picture")
}

/// The middle of a pixel of the picture from above, metres.
pub(crate) fn middle(view: View, pixel: usize, width_m: f64) -> DVec3 {
    let [w, h] = view.size;
    let (i, j) = (pixel % w, pixel / w);
    let (w, h) = (w as f64, h as f64);
    DVec3::new(((i as f64 + 0.5) / w - 0.5) * width_m, 0.0, ((j as f64 + 0.5) - 0.5 * h) / w * width_m)
}

/// Irradiance of a white floor.
pub(crate) fn irradiance(frame: &Frame, pixel: usize) -> f64 {
    std::f64::consts::PI * f64::from(frame.radiance[0][pixel])
}

/// How many of the pixels are within 2.13 standard errors (95% of a t of 15) of what they should be, as a share.
pub(crate) fn covered(frame: &Frame, right: impl Fn(usize) -> f64) -> f64 {
    let se = &frame.standard_error.as_ref().expect("errors")[0];
    let n = frame.radiance[0].len();
    let within = |k: &usize| {
        let error = std::f64::consts::PI * f64::from(se[*k]);
        // Where all replicates agree f32 is all that is left.
        (irradiance(frame, *k) - right(*k)).abs() <= 2.131 * error + 2e-7 * right(*k)
    };
    (0..n).filter(within).count() as f64 / n as f64
}

/// What is right is covered as often as its interval says, and what is off by 2% is not.
pub(crate) fn assert_covers(frame: &Frame, right: impl Fn(usize) -> f64) {
    let share = covered(frame, &right);
    assert!((0.9..=0.995).contains(&share), "covered {share}");
    let off = covered(frame, |k| 1.02 * right(k));
    assert!(off < 0.8, "2% off is covered, too: {off}");
}

/// A sphere of radius 1 of `n` rows and 2n columns of quadrilaterals, closed.
pub(crate) fn ball(n: u32) -> Mesh {
    bumpy(n, 0.0)
}

/// The same with bumps so high.
pub(crate) fn bumpy(rows: u32, high: f64) -> Mesh {
    let columns = 2 * rows;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    let at = |j: u32, i: u32| {
        let t = std::f64::consts::PI * f64::from(j) / f64::from(rows);
        let f = std::f64::consts::TAU * f64::from(i) / f64::from(columns);
        let r = 1.0 + high * (5.0 * t).sin() * (7.0 * f).sin() * t.sin();
        [r * t.sin() * f.cos(), r * t.cos(), r * t.sin() * f.sin()].map(|x| x as f32)
    };
    positions.push([0.0, 1.0, 0.0]);
    for j in 1..rows {
        positions.extend((0..columns).map(|i| at(j, i)));
    }
    positions.push([0.0, -1.0, 0.0]);
    let last = positions.len() as u32 - 1;
    let vertex = |j: u32, i: u32| match j {
        0 => 0,
        j if j == rows => last,
        j => 1 + (j - 1) * columns + i % columns,
    };
    for j in 0..rows {
        for i in 0..columns {
            let [a, b, c, d] = [vertex(j, i), vertex(j, i + 1), vertex(j + 1, i), vertex(j + 1, i + 1)];
            if j > 0 {
                triangles.push([a, b, d]);
            }
            if j + 1 < rows {
                triangles.push([a, d, c]);
            }
        }
    }
    Mesh::new(positions, triangles)
}

pub(crate) fn mesh(mesh: Mesh, smooth: bool) -> Form {
    let mesh = Arc::new(mesh);
    Form::Mesh(MeshForm { seen: mesh.clone(), caster: mesh, smooth })
}
