//! Small golden images of every scene that ships and every technique, compared by error.
//!
//! `KELIR_BLESS=1 cargo test -p kelir-render --test it golden` makes them anew; look at what changed before you commit it.

use std::path::PathBuf;

use kelir_render::encode::png;
use kelir_render::{Backend, Pixel, Technique, View, mc, oracle, pa, pcss, points, renderer, white};
use kelir_scene::{EmitterShape, Theatre};
use kelir_vision::errors::{Errors, errors};

use crate::support::shipped;

/// Root mean square and largest difference, in codes: every machine draws the same up to its `sin` and `pow`.
const BOUND: [f64; 2] = [0.05, 2.0];

fn techniques() -> Vec<(&'static str, Technique, View)> {
    let area = View { size: [96, 54], pixel: Pixel::Area, skip: true };
    vec![
        ("pa", Technique::Pa(pa::Knobs::default()), area),
        ("mc", Technique::Mc(mc::Knobs { spp: 64, ..mc::Knobs::default() }), area),
        ("points", Technique::Points(points::Knobs { lights: 16, ..points::Knobs::default() }), area),
        ("pcss", Technique::Pcss(pcss::Knobs::default()), area),
        (
            "oracle",
            Technique::Oracle(oracle::Knobs { tolerance: 0.1, geometric: false }),
            View { size: [48, 27], pixel: Pixel::Centre, skip: true },
        ),
    ]
}

fn file(scene: &str, technique: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(format!("{scene}-{technique}.png"))
}

/// Display codes; `white` is the scene's own, so that a changed lamp shows.
fn draw(theatre: &Theatre, technique: &Technique, view: &View, white: f64) -> Vec<u32> {
    let mut out = vec![0; view.size[0] * view.size[1]];
    renderer(technique, Backend::Cpu).unwrap().display(theatre, view, white, &mut out).unwrap();
    out
}

fn channels(codes: &[u32]) -> Vec<f64> {
    codes.iter().flat_map(|p| [0, 8, 16].map(|shift| f64::from(p >> shift & 0xff))).collect()
}

fn difference(codes: &[u32], golden: &[f64]) -> Errors {
    errors(&channels(codes), golden, None, 1.0).unwrap()
}

fn read(path: &PathBuf, size: [usize; 2]) -> Vec<f64> {
    let missing = |e: &dyn std::fmt::Display| -> ! { panic!("{}: {e}; see golden.rs", path.display()) };
    let image = image::open(path).unwrap_or_else(|e| missing(&e)).to_rgb8();
    assert_eq!([image.width() as usize, image.height() as usize], size, "{}", path.display());
    image.into_raw().into_iter().map(f64::from).collect()
}

#[test]
fn every_scene_and_technique() {
    let bless = std::env::var_os("KELIR_BLESS").is_some();
    for scene in shipped() {
        for (name, technique, view) in techniques() {
            let path = file(&scene.name, name);
            let white = white([&scene.still], &view);
            let codes = draw(&scene.still, &technique, &view, white);
            if bless {
                std::fs::write(&path, png(&codes, view.size).unwrap()).unwrap();
            }
            let golden = read(&path, view.size);
            let error = difference(&codes, &golden);
            assert!(
                error.rmse <= BOUND[0] && error.max <= BOUND[1],
                "{}: {error:?} codes from the golden image",
                path.display()
            );
            // The negative control: a lamp 3 % larger at equal flux.
            let mut larger = scene.still.clone();
            for emitter in &mut larger.lamp.emitters {
                if let EmitterShape::Rectangle { size_m } = &mut emitter.shape {
                    size_m.iter_mut().for_each(|s| *s *= 1.03);
                }
                emitter.radiance.iter_mut().for_each(|l| *l /= 1.03 * 1.03);
            }
            let error = difference(&draw(&larger, &technique, &view, white), &golden);
            assert!(error.rmse > BOUND[0] || error.max > BOUND[1], "{}: {error:?}", path.display());
        }
    }
}

/// No golden image is left of a scene or technique that is gone, and all of them are small.
#[test]
fn nothing_else_is_kept() {
    let scenes = || shipped().iter().flat_map(|s| techniques().into_iter().map(|(t, ..)| file(&s.name, t)));
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let mut bytes = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        assert!(scenes().any(|path| path == entry.path()), "{}", entry.path().display());
        bytes += entry.metadata().unwrap().len();
    }
    assert!(bytes < 1 << 20, "{bytes}");
}
