//! What comparisons and tests draw.

use std::sync::Arc;

use glam::DVec3;
use kelir_frame::{Pixel, View};
use kelir_scene::{
    Albedo, Ambient, Emitter, EmitterShape, Exposure, Lamp, Mask, Plane, Screen, Texels, Theatre,
};

use super::super::{Knobs, Variant, Weights};

/// A disc with a soft edge and holes, different in each channel.
pub(super) fn figure(width: usize, height: usize, channels: usize, max: u16) -> Mask {
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

pub(super) fn plane(mask: Mask, centre_m: [f64; 3]) -> Plane {
    let size_m = [0.6 * mask.width as f64 / mask.height as f64, 0.6];
    Plane { mask: Arc::new(mask), centre_m: DVec3::from(centre_m), size_m, tilt_deg: [0.0; 2] }
}

pub(super) fn theatre(planes: Vec<Plane>, ambient: Ambient, colours: [[f64; 3]; 2]) -> Theatre {
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
pub(super) fn scenes() -> Vec<(&'static str, Theatre)> {
    let paper = Ambient::Paper { k_d_m: 1.0, s: [0.3, 0.2, 0.1] };
    let grey = [[2000.0; 3], [40.0; 3]];
    let centre = [0.1, 0.02, -0.2];
    let far = plane(figure(40, 64, 3, 255), [0.0, 0.0, -0.9]);
    let both =
        vec![plane(figure(100, 128, 1, 255), centre), plane(figure(40, 64, 3, 255), [-0.2, 0.1, -0.5])];
    vec![
        ("grey", theatre(vec![plane(figure(100, 128, 1, 255), centre)], Ambient::None, grey)),
        ("sixteen bits", theatre(vec![plane(figure(100, 128, 1, 65535), centre)], Ambient::None, grey)),
        ("colour, ambient light", theatre(vec![far], paper, grey)),
        (
            "two planes, a lamp of two colours",
            theatre(both, paper, [[2000.0, 1500.0, 800.0], [40.0, 40.0, 60.0]]),
        ),
    ]
}

pub(super) fn view(pixel: Pixel) -> View {
    View { size: [160, 90], pixel, skip: true }
}

/// One theatre, its knobs and , by name.
pub(super) fn features() -> Vec<(&'static str, Theatre, Knobs)> {
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
            Knobs { variant: Variant::ShadowMap, map_size: 128, ..plain },
        ),
        (
            "colour, sixteen bits, split",
            theatre(vec![plane(figure(40, 64, 3, 65535), [0.0, 0.0, -0.9])], paper, grey),
            split,
        ),
    ]
}

/// Emitters of 1e-6 m to 1 m, and planes next to screen and lamp.
pub(super) fn extremes() -> Vec<(String, Theatre)> {
    let places = [1e-6, 1e-3, 1.0].into_iter().flat_map(|side| [-1e-4, -0.75, -1.4999].map(|z| (side, z)));
    let one = |(side, z): (f64, f64)| {
        let puppet = plane(figure(96, 128, 1, 255), [0.05, 0.0, z]);
        (format!("an emitter of {side:e} m, a puppet {} m off the screen", -z), single(puppet, side))
    };
    places.map(one).collect()
}

/// Barely tilted, tilted and steep planes before a tiny and a huge emitter, with how much of visibility they may err by: a steep plane
/// bends a tile's map, by 2e-6 of a texel of a box of a tenth.
pub(super) fn slopes() -> Vec<(String, Theatre, f64)> {
    let tilts = [([0.01, 0.0], 4e-6), ([0.0, 45.0], 4e-6), ([85.0, 0.0], 4e-5)];
    let one = |side: f64, tilt_deg: [f64; 2], most: f64| {
        let puppet = Plane { tilt_deg, ..plane(figure(96, 128, 1, 255), [0.05, 0.1, -0.6]) };
        (format!("an emitter of {side:e} m, a puppet tilted by {tilt_deg:?}°"), single(puppet, side), most)
    };
    [1e-3, 0.3].into_iter().flat_map(|side| tilts.map(|(tilt, most)| one(side, tilt, most))).collect()
}

/// One plane before one emitter.
fn single(plane: Plane, side: f64) -> Theatre {
    let mut scene = theatre(vec![plane], Ambient::None, [[1.0; 3]; 2]);
    scene.lamp.emitters.truncate(1);
    scene.lamp.emitters[0].shape = EmitterShape::Rectangle { size_m: [side, 0.8 * side] };
    scene
}
