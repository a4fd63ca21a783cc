//! Small golden images of every scene that ships and every technique, compared by error, each with the revisions that it was blessed at.
//!
//! A picture that changes under revisions that stay is refused, blessing or not: stimuli that were made before would be taken for what the
//! renderer draws now. Raise the technique's `REVISION` ([`kelir_render::REVISION`] where all change); then
//! `KELIR_BLESS=1 cargo test -p kelir-render --test it golden` makes its pictures anew. Look at what changed before you commit it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use kelir_render::camera::Camera;
use kelir_render::encode::png;
use kelir_render::{Backend, Pixel, Technique, View, mc, oracle, pa, pcss, points, renderer, white};
use kelir_scene::{EmitterShape, Theatre};
use kelir_vision::errors::{Errors, errors};

use crate::support::{Shipped, shipped};

/// Root mean square and largest difference, in codes: every machine draws the same up to its `sin` and `pow`.
const BOUND: [f64; 2] = [0.05, 2.0];

/// What the revisions of each picture are kept in, beside the pictures.
const RECORD: &str = "blessed.json";

/// One way to draw a scene.
struct Way {
    name: &'static str,
    technique: Technique,
    view: View,
    camera: Option<Camera>,
}

fn ways(scene: &str) -> Vec<Way> {
    let area = View { size: [96, 54], pixel: Pixel::Area, skip: true };
    let way = |name, technique| Way { name, technique, view: area, camera: None };
    let pa = || Technique::Pa(pa::Knobs::default());
    let mut ways = vec![
        way("pa", pa()),
        way("mc", Technique::Mc(mc::Knobs { spp: 64, ..mc::Knobs::default() })),
        way("points", Technique::Points(points::Knobs { lights: 16, ..points::Knobs::default() })),
        way("pcss", Technique::Pcss(pcss::Knobs::default())),
        Way {
            view: View { size: [48, 27], pixel: Pixel::Centre, skip: true },
            ..way("oracle", Technique::Oracle(oracle::Knobs { tolerance: 0.1, geometric: false }))
        },
    ];
    if scene == "kayon" {
        ways.push(Way { camera: Some(Camera::default()), ..way("camera", pa()) });
    }
    ways
}

impl Way {
    /// Display codes; `white` is the scene's own, so that a changed lamp shows.
    fn draw(&self, theatre: &Theatre, white: f64) -> Vec<u32> {
        let mut drawing = renderer(&self.technique, Backend::Cpu).unwrap();
        if let Some(camera) = self.camera {
            return camera.expose(&drawing.radiance(theatre, &self.view).unwrap(), white).unwrap();
        }
        let mut out = vec![0; self.view.size[0] * self.view.size[1]];
        drawing.display(theatre, &self.view, white, &mut out).unwrap();
        out
    }
}

/// A picture as it is drawn now.
#[derive(Clone)]
struct Picture {
    file: String,
    /// What it may depend on: the scene, what techniques share, the technique.
    revisions: String,
    size: [usize; 2],
    codes: Vec<u32>,
}

impl Picture {
    fn of(scene: &Shipped, way: &Way) -> Self {
        let technique = (way.technique.name(), way.technique.revision());
        Self {
            file: file(&scene.name, way.name),
            revisions: format!(
                "scene {}, shared {}, {} {}",
                &scene.sha256[..16],
                kelir_render::REVISION,
                technique.0,
                technique.1
            ),
            size: way.view.size,
            codes: way.draw(&scene.still, white([&scene.still], &way.view)),
        }
    }
}

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

fn file(scene: &str, way: &str) -> String {
    format!("{scene}-{way}.png")
}

fn channels(codes: &[u32]) -> Vec<f64> {
    codes.iter().flat_map(|p| [0, 8, 16].map(|shift| f64::from(p >> shift & 0xff))).collect()
}

fn difference(codes: &[u32], golden: &[f64]) -> Errors {
    errors(&channels(codes), golden, None, 1.0).unwrap()
}

fn within(error: &Errors) -> bool {
    error.rmse <= BOUND[0] && error.max <= BOUND[1]
}

fn read(path: &Path, size: [usize; 2]) -> Vec<f64> {
    let image = image::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).to_rgb8();
    assert_eq!([image.width() as usize, image.height() as usize], size, "{}", path.display());
    image.into_raw().into_iter().map(f64::from).collect()
}

/// Holds `pictures` to those in `folder`, or makes those anew whose revisions changed; all or nothing. Errors: every picture that must not
/// stay as it is, and what to do about it.
fn settle(folder: &Path, pictures: &[Picture], bless: bool) -> Result<(), String> {
    let record = std::fs::read(folder.join(RECORD)).unwrap_or_else(|_| b"{}".to_vec());
    let record: BTreeMap<String, String> = serde_json::from_slice(&record).unwrap();
    let (mut refused, mut anew) = (Vec::new(), Vec::new());
    for picture in pictures {
        let Picture { file, revisions, size, codes } = picture;
        let blessed = record.get(file);
        if blessed == Some(revisions) {
            let error = difference(codes, &read(&folder.join(file), *size));
            if !within(&error) {
                refused.push(format!(
                    "{file}: {error:?} codes from the golden image, yet its revisions are those it was blessed at ({revisions}): raise the \
                     technique's REVISION (kelir_render::REVISION where all techniques changed), then bless it with KELIR_BLESS=1"
                ));
            }
        } else if bless {
            anew.push(picture);
        } else {
            refused.push(format!(
                "{file}: blessed at {}, now {revisions}: bless it with KELIR_BLESS=1, and look at it",
                blessed.map_or("nothing", String::as_str)
            ));
        }
    }
    if !refused.is_empty() {
        return Err(refused.join("\n"));
    }
    for Picture { file, size, codes, .. } in anew {
        std::fs::write(folder.join(file), png(codes, *size).unwrap()).unwrap();
    }
    if bless {
        let record: BTreeMap<_, _> = pictures.iter().map(|p| (&p.file, &p.revisions)).collect();
        let text = serde_json::to_string_pretty(&record).unwrap() + "\n";
        std::fs::write(folder.join(RECORD), text).unwrap();
    }
    Ok(())
}

#[test]
fn every_scene_and_technique() {
    let drawn = |scene: &'static Shipped| ways(&scene.name).into_iter().map(move |way| (scene, way));
    let drawn: Vec<_> = shipped().iter().flat_map(drawn).collect();
    let pictures: Vec<_> = drawn.iter().map(|(scene, way)| Picture::of(scene, way)).collect();
    settle(&folder(), &pictures, std::env::var_os("KELIR_BLESS").is_some()).unwrap_or_else(|e| panic!("{e}"));
    for ((scene, way), picture) in drawn.iter().zip(&pictures) {
        // The negative control: a lamp 3 % larger at equal flux.
        let mut larger = scene.still.clone();
        for emitter in &mut larger.lamp.emitters {
            if let EmitterShape::Rectangle { size_m } = &mut emitter.shape {
                size_m.iter_mut().for_each(|s| *s *= 1.03);
            }
            emitter.radiance.iter_mut().for_each(|l| *l /= 1.03 * 1.03);
        }
        let codes = way.draw(&larger, white([&scene.still], &way.view));
        let error = difference(&codes, &read(&folder().join(&picture.file), picture.size));
        assert!(!within(&error), "{}: {error:?}", picture.file);
    }
}

/// What a changed renderer is told: under the same revision it may not even bless.
#[test]
fn a_change_needs_a_higher_revision() {
    let folder = tempfile::tempdir().unwrap();
    let kept = || std::fs::read(folder.path().join("a-pa.png")).unwrap();
    let picture = |revision: u32, code: u32| Picture {
        file: "a-pa.png".into(),
        revisions: format!("scene 0, shared 1, pa {revision}"),
        size: [4, 2],
        codes: vec![0xff00_0000 | code; 8],
    };
    let settle = |picture: &Picture, bless| settle(folder.path(), std::slice::from_ref(picture), bless);
    assert!(settle(&picture(1, 10), false).unwrap_err().contains("blessed at nothing"));
    settle(&picture(1, 10), true).unwrap();
    settle(&picture(1, 10), false).unwrap();
    let first = kept();
    // Another picture, the same revision.
    for bless in [false, true] {
        let said = settle(&picture(1, 90), bless).unwrap_err();
        assert!(said.contains("raise the technique's REVISION") && said.contains("pa 1"), "{said}");
        assert!(kept() == first, "nothing was written");
    }
    // A higher revision is blessed on purpose only, and then is what later pictures are held to.
    let said = settle(&picture(2, 90), false).unwrap_err();
    assert!(said.contains("pa 1, now") && said.contains("KELIR_BLESS=1"), "{said}");
    settle(&picture(2, 90), true).unwrap();
    settle(&picture(2, 90), false).unwrap();
    assert!(kept() != first);
    assert!(settle(&picture(2, 10), true).is_err());
}

/// No golden image is left of a scene or technique that is gone, and all of them are small.
#[test]
fn nothing_else_is_kept() {
    let known = |name: &str| {
        name == RECORD
            || shipped().iter().any(|s| ways(&s.name).iter().any(|w| file(&s.name, w.name) == name))
    };
    let mut bytes = 0;
    for entry in std::fs::read_dir(folder()).unwrap() {
        let entry = entry.unwrap();
        assert!(known(entry.file_name().to_str().unwrap()), "{}", entry.path().display());
        bytes += entry.metadata().unwrap().len();
    }
    assert!(bytes < 1 << 20, "{bytes}");
}
