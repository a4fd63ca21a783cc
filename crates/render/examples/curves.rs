//! PA's error in geometric visibility against the oracle over each accuracy knob:
//! `cargo run --release -p kelir-render --example curves -- SCENE.toml`.
#![allow(clippy::print_stdout, clippy::expect_used)]

use kelir_render::oracle::{self, Oracle, Point};
use kelir_render::pa::{Knobs, Native, Variant};
use kelir_render::{Pixel, Renderer, View};
use kelir_scene::{Ambient, EmitterShape, Scene, Theatre};

const VIEW: View = View { size: [160, 90], pixel: Pixel::Centre, skip: true };

/// (root mean square, largest) error over every `STEP`th pixel and all emitters.
fn error(theatre: &Theatre, knobs: Knobs) -> (f64, f64) {
    const STEP: usize = 5;
    let frame = Native::new(knobs).radiance(theatre, &VIEW).expect("drawn");
    let (mut sum, mut worst, mut n) = (0.0, 0f64, 0);
    let per = frame.layers.len() / theatre.lamp.emitters.len();
    for j in (0..VIEW.size[1]).step_by(STEP) {
        for i in (0..VIEW.size[0]).step_by(STEP) {
            for e in 0..theatre.lamp.emitters.len() {
                let truth =
                    oracle::visibility(theatre, e, Point::pixel(theatre, &VIEW, i, j), 1e-4).geometric[0];
                let got = f64::from(frame.layers[e * per].values[j * VIEW.size[0] + i]);
                sum += (got - truth).powi(2);
                worst = worst.max((got - truth).abs());
                n += 1;
            }
        }
    }
    ((sum / f64::from(n)).sqrt(), worst)
}

fn curve(name: &str, theatre: &Theatre, knobs: impl IntoIterator<Item = (u32, Knobs)>) {
    print!("{name}:");
    for (value, knobs) in knobs {
        let (rmse, max) = error(theatre, knobs);
        print!("  {value}: {rmse:.1e} / {max:.1e}");
    }
    println!();
}

fn main() {
    let path = std::env::args().nth(1).unwrap_or_else(|| "stimuli/scenes/kijang-near.toml".into());
    let scene = Scene::from_path(std::path::Path::new(&path)).expect("a valid scene");
    let mut still = scene.still();
    still.planes.truncate(1);
    still.ambient = Ambient::None;
    println!("{path}, {}x{}: rms / max error of Vgeo", VIEW.size[0], VIEW.size[1]);
    curve("upright plane, rectangles (nothing to turn)", &still, [(1, Knobs::default())]);
    let maps =
        [128, 512, 2048].map(|n| (n, Knobs { variant: Variant::ShadowMap, map_size: n, ..Knobs::default() }));
    curve("shadow map, samples a side", &still, maps);
    let mut disk = still.clone();
    disk.lamp.emitters.truncate(1);
    disk.lamp.emitters[0].shape = EmitterShape::Disk { radius_m: 0.05 };
    let strips = [4, 16, 64, 256].map(|n| (n, Knobs { strips: n, ..Knobs::default() }));
    curve("disk of 0.05 m, strips", &disk, strips);
    let splits = || [1, 2, 4, 8, 16].map(|n| (n, Knobs { split: n, ..Knobs::default() }));
    for degrees in [15.0, 45.0, 75.0] {
        let mut tilted = still.clone();
        tilted.lamp.emitters.truncate(1);
        tilted.lamp.emitters[0].shape = EmitterShape::Rectangle { size_m: [0.1, 0.1] };
        let z = 0.5 * tilted.lamp.position_m.z;
        tilted.planes[0].centre_m.z = z;
        tilted.planes[0].tilt_deg = [0.0, degrees];
        curve(&format!("tilted by {degrees} degrees, split"), &tilted, splits());
    }
    let mut two = still.clone();
    two.lamp.emitters.truncate(1);
    two.lamp.emitters[0].shape = EmitterShape::Rectangle { size_m: [0.1, 0.1] };
    two.planes.push(two.planes[0].clone());
    two.planes[1].centre_m.z *= 1.7;
    two.planes[1].centre_m.x += 0.03;
    curve("two planes, split", &two, splits());
    let mut dome = still.clone();
    dome.ambient = Ambient::Dome { radiance: [1.0; 3] };
    dome.lamp.emitters.iter_mut().for_each(|e| e.radiance = [0.0; 3]);
    dome.screen.albedo = kelir_scene::Albedo::Uniform([1.0; 3]);
    let frame = Native::new(Knobs::default()).radiance(&dome, &VIEW).expect("drawn");
    let truth = Oracle::new(oracle::Knobs::default()).crop(&dome, &VIEW, 60..100, 45..46).expect("drawn");
    let got = &frame.radiance[0][45 * VIEW.size[0] + 60..];
    let worst = truth.iter().zip(got).map(|((l, _), got)| (l[0] - f64::from(*got)).abs()).fold(0.0, f64::max);
    println!("dome: max {worst:.1e} of its radiance along a row");
}
