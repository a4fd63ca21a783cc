//! Kelir's pictures beside Mitsuba's of the same scenes, kind of light by kind of light: `tests/data/mitsuba/make.py` makes and explains them.

use std::path::{Path, PathBuf};

use exr::prelude::{ReadChannels, ReadLayers};
use kelir_frame::{Frame, Pixel, View};
use kelir_scene::AnyScene;
use kelir_scene::DirAssets;
use kelir_scene::stage::{LightKind, Stage};
use kelir_stage::raytrace::{Knobs, renderer};

const SIZE: [usize; 2] = [48, 36];

/// Sides of the tiles whose means are compared.
const TILE: [usize; 2] = [8, 6];

/// Two-sided 0.1%, Šidák over 5,184 values, of Student's t with the 15 degrees of freedom that kelir's sixteen replicates leave at least.
const PIXEL_T: f64 = 9.01;

/// Two-sided 0.1%, Šidák over 108 tiles, of a normal variable: a tile's errors add up over 48 pixels.
const TILE_Z: f64 = 4.43;

/// Share of a picture's mean that Mitsuba's f32 is trusted to.
const SINGLE: f64 = 1e-4;

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mitsuba")
}

/// The stage of scene files one after the other.
fn stage(files: &[&str]) -> Stage {
    let text: String = files
        .iter()
        .map(|file| std::fs::read_to_string(data().join(file).with_extension("toml")).unwrap())
        .collect();
    match AnyScene::parse("scene.toml", &text, &DirAssets::new(data())).unwrap() {
        AnyScene::Stage(scene) => scene.still(),
        AnyScene::Theatre(_) => panic!("these are stages"),
    }
}

/// Radiance and its standard error, one a channel and pixel.
struct Picture {
    values: [Vec<f64>; 3],
    errors: [Vec<f64>; 3],
}

fn mitsuba(name: &str) -> Picture {
    let read = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels();
    let file = data().join(name).with_extension("exr");
    let image = read.first_valid_layer().all_attributes().non_parallel().from_file(file).unwrap();
    let size = image.layer_data.size;
    assert_eq!([size.0, size.1], SIZE);
    let channel = |name: String| {
        let of = |c: &&exr::prelude::AnyChannel<exr::prelude::FlatSamples>| c.name.to_string() == name;
        let channel = image.layer_data.channel_data.list.iter().find(of).unwrap();
        channel.sample_data.values_as_f32().map(f64::from).collect()
    };
    Picture {
        values: ["R", "G", "B"].map(|c| channel(c.to_owned())),
        errors: ["R", "G", "B"].map(|c| channel(format!("SE.{c}"))),
    }
}

fn kelir(stage: &Stage, bounces: u32, spp: u32) -> Picture {
    let view = View { size: SIZE, pixel: Pixel::Area, skip: true };
    let frame: Frame = renderer(&Knobs { spp, bounces, ..Knobs::default() }).radiance(stage, &view).unwrap();
    let wide = |planes: [Vec<f32>; 3]| planes.map(|plane| plane.into_iter().map(f64::from).collect());
    Picture { values: wide(frame.radiance), errors: wide(frame.standard_error.unwrap()) }
}

/// How far apart two pictures are: the worst pixel in standard errors, the worst tile in standard errors, and the difference of their means as a share.
#[derive(Debug)]
struct Apart {
    pixel: f64,
    tile: f64,
    mean: f64,
}

impl Apart {
    fn of(a: &Picture, b: &Picture) -> Self {
        let [width, height] = SIZE;
        let mut apart = Self { pixel: 0.0, tile: 0.0, mean: 0.0 };
        for c in 0..3 {
            let mean = |picture: &Picture| picture.values[c].iter().sum::<f64>() / (width * height) as f64;
            let single = SINGLE * mean(b);
            apart.mean = apart.mean.max((mean(a) / mean(b) - 1.0).abs());
            let mut tiles = vec![(0.0, 0.0); width / TILE[0] * height / TILE[1]];
            for k in 0..width * height {
                let difference = a.values[c][k] - b.values[c][k];
                let variance = a.errors[c][k].powi(2) + b.errors[c][k].powi(2);
                apart.pixel = apart.pixel.max(difference.abs() / (variance + single * single).sqrt());
                let tile = &mut tiles[k / width / TILE[1] * (width / TILE[0]) + k % width / TILE[0]];
                *tile = (tile.0 + difference, tile.1 + variance);
            }
            let pixels = (TILE[0] * TILE[1]) as f64;
            for (difference, variance) in tiles {
                apart.tile = apart.tile.max(difference.abs() / (variance + (pixels * single).powi(2)).sqrt());
            }
        }
        apart
    }

    fn same(&self) -> bool {
        self.pixel < PIXEL_T && self.tile < TILE_Z
    }
}

/// Holds kelir's picture to Mitsuba's; `wrong` makes it a little wrong, which must not pass.
fn assert_alike(name: &str, files: &[&str], bounces: u32, wrong: impl Fn(&mut Stage)) {
    let right = mitsuba(name);
    let mut stage = stage(files);
    // So many that no sliver of a shadow that covers a few thousandths of a pixel is missed by all sixteen replicates, whose error would be none.
    let drawn = kelir(&stage, bounces, 4096);
    let apart = Apart::of(&drawn, &right);
    println!("{name}: {apart:?}");
    let mut brighter = drawn;
    brighter.values.iter_mut().flatten().for_each(|value| *value *= 1.02);
    let off = Apart::of(&brighter, &right);
    println!("2% brighter: {off:?}");
    wrong(&mut stage);
    let wrong = Apart::of(&kelir(&stage, bounces, 256), &right);
    println!("wrong: {wrong:?}");
    assert!(apart.same(), "{name}: {apart:?}");
    assert!(!off.same(), "{name}, 2% brighter, passes: {off:?}");
    assert!(!wrong.same(), "{name}, made wrong, passes: {wrong:?}");
}

/// 2 cm to the side, or about a degree where it is a direction.
fn moved(stage: &mut Stage) {
    match &mut stage.lights[0].kind {
        LightKind::Point { position_m, .. } => position_m.x += 0.02,
        LightKind::Area { pose, .. } => pose.position_m.x += 0.02,
        LightKind::Projector(projector) => projector.pose.position_m.x += 0.02,
        LightKind::Directional { direction, .. } => {
            direction.x += 0.02;
            *direction = direction.normalize();
        }
        LightKind::Environment(_) => panic!("is everywhere"),
    }
}

#[test]
fn a_point() {
    assert_alike("point", &["stage", "point"], 0, moved);
}

#[test]
fn a_directional_light() {
    assert_alike("directional", &["stage", "directional"], 0, moved);
}

#[test]
fn a_sun() {
    assert_alike("sun", &["stage", "sun"], 0, moved);
}

#[test]
fn a_rectangle() {
    assert_alike("rectangle", &["stage", "rectangle"], 0, moved);
}

#[test]
fn a_disk() {
    assert_alike("disk", &["stage", "disk"], 0, moved);
}

#[test]
fn an_environment() {
    assert_alike("environment", &["stage", "environment"], 0, |stage| stage.objects[1].casts = false);
}

#[test]
fn a_projector() {
    assert_alike("projector", &["stage", "projector"], 0, moved);
}

#[test]
fn a_bounce() {
    assert_alike("bounced", &["stage", "rectangle"], 1, moved);
}

#[test]
fn a_mirror_ball() {
    assert_alike("mirror", &["mirror"], 0, |stage| stage.objects[1].pose.position_m.x += 0.02);
}
