//! Hostile and merely random input: no panic, and what is accepted keeps the invariants.
//!
//! `PROPTEST_CASES` sets the number of cases (default 256 a property); the seeds are fixed and printed by proptest.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

use crate::support::{Files, MANIFEST, PUPPET_SVG, SCENE, files, parse, png};
use kelir_scene::{EmitterShape, Masks, Plane, Scene, Theatre};

fn config(seed: u64) -> Config {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|c| c.parse().ok()).unwrap_or(256);
    Config { cases, rng_seed: RngSeed::Fixed(seed), failure_persistence: None, ..Config::default() }
}

/// A scene with everything in it.
pub(crate) const FULL: &str = r#"
[screen]
width_m = 1.6
height_m = 0.9
albedo = { weave = { base = [0.8, 0.7, 0.6], threads = 24, contrast = 0.1, vignette = 0.2, seed = 3 } }
[lamp]
position_m = [0.1, 0.2, -1.5]
[[lamp.emitters]]
name = "inner"
shape = "rectangle"
size_m = [0.02, 0.03]
radiance = 2000.0
[[lamp.emitters]]
name = "outer"
shape = "disk"
radius_m = 0.1
radiance = [40, 30, 20]
[ambient]
model = "paper"
k_d_m = 1.0
s = 0.2
[[puppets]]
image = "../puppets/figure.toml"
height_m = 0.6
position_m = [0.0, 0.0, -0.4]
texels = 64
rotate_deg = 10.0
tilt_deg = [20, -10]
pose = { bar = 20.0, leaf = -10 }
[[puppets]]
image = "../puppets/p.png"
height_m = 0.2
position_m = [0.1, 0.0, -0.2]
translucent = true
bits = 16
[exposure]
white = 50.0
[timeline]
fps = 12
seconds = 0.5
loop = true
[[timeline.tracks]]
target = "puppets[0].pose.bar"
easing = "smooth"
keys = [ { t = 0.0, value = 0.0 }, { t = 0.3, value = 35.0 } ]
[[timeline.tracks]]
target = "puppets[1].position_m"
keys = [ { t = 0.0, value = [0, 0, -0.2] }, { t = 0.3, value = [0, 0.1, -0.5] } ]
"#;

pub(crate) fn full_files() -> Files {
    let mut files = files();
    files.insert("puppets/p.png".into(), png(9, 7, |x, y| [20 * x as u8, 30 * y as u8, 99, 28 * x as u8]));
    files
}

/// What techniques rely on.
fn check(theatre: &Theatre) -> Result<(), TestCaseError> {
    let screen = &theatre.screen;
    prop_assert!(
        screen.width_m > 0.0
            && screen.height_m > 0.0
            && screen.width_m.is_finite()
            && screen.height_m.is_finite()
    );
    let lamp = &theatre.lamp;
    prop_assert!(lamp.position_m.is_finite() && lamp.position_m.z < 0.0 && !lamp.emitters.is_empty());
    for (i, emitter) in lamp.emitters.iter().enumerate() {
        prop_assert!(lamp.emitters[..i].iter().all(|other| other.name != emitter.name));
        prop_assert!(emitter.shape.area_m2() > 0.0 && emitter.shape.area_m2().is_finite());
        prop_assert!(emitter.radiance.iter().all(|l| *l >= 0.0 && l.is_finite()));
        if let EmitterShape::Rectangle { size_m } = emitter.shape {
            prop_assert!(size_m.iter().all(|s| *s > 0.0));
        }
    }
    for plane in &theatre.planes {
        check_plane(plane, lamp.position_m.z)?;
    }
    Ok(())
}

fn check_plane(plane: &Plane, lamp_z_m: f64) -> Result<(), TestCaseError> {
    prop_assert!(plane.size_m.iter().all(|s| *s > 0.0 && s.is_finite()));
    prop_assert!(plane.mask.width >= 1 && plane.mask.height >= 1);
    // Texels are square.
    let [u, v] = [plane.size_m[0] / plane.mask.width as f64, plane.size_m[1] / plane.mask.height as f64];
    prop_assert!((u / v - 1.0).abs() < 1e-9);
    for corner in plane.corners_m() {
        prop_assert!(corner.is_finite() && corner.z > lamp_z_m && corner.z < 0.0, "corner {corner}");
    }
    Ok(())
}

/// Reads it; if it is accepted, checks the still and some instants of it.
pub(crate) fn read(toml: &str, files: &Files) -> Result<bool, TestCaseError> {
    match parse(toml, files) {
        Err(errors) => {
            prop_assert!(!errors.is_empty() && !errors.to_string().is_empty());
            for problem in errors.iter() {
                prop_assert!(
                    !problem.to_string().contains(char::is_control),
                    "one line a problem: {problem:?}"
                );
            }
            Ok(false)
        }
        Ok(scene) => {
            check(&scene.still())?;
            let mut masks = Masks::default();
            let frames: Vec<f64> = scene
                .timeline()
                .map(|t| (0..t.frame_count().min(4)).map(|f| t.frame_time_s(f)).collect())
                .unwrap_or_default();
            for time in frames {
                check(&scene.theatre_at(time, &mut masks))?;
            }
            // Whatever was accepted is written back to what reads to the same scene.
            let again = parse(scene.to_toml(), files);
            let again = again.as_ref().map(Scene::sha256).map_err(ToString::to_string);
            prop_assert_eq!(again, Ok(scene.sha256()), "{}", scene.to_toml());
            Ok(true)
        }
    }
}

/// One change of a text's bytes.
#[derive(Clone, Debug)]
pub(crate) enum Mutation {
    Set(prop::sample::Index, u8),
    Remove(prop::sample::Index, usize),
    Repeat(prop::sample::Index, usize),
    Insert(prop::sample::Index, &'static str),
}

const TOKENS: &[&str] = &[
    "nan",
    "inf",
    "-inf",
    "-0.0",
    "0",
    "1e308",
    "1e-320",
    "-1",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "\"\"",
    "= ",
    "\n",
    "[[puppets]]\n",
    "[timeline]\n",
    "image = \"../puppets/p.png\"\n",
    "true",
    "<",
    ">",
    "&lt;",
    "url(#a)",
    "<use href=\"#body\"/>",
    "\u{2212}",
    "\u{0}",
    "\"disk\"",
    "1979-05-27",
    "0x7fffffffffffffff",
    "9223372036854775808",
    "..",
    "%",
    "viewBox=\"0 0 1 1\"",
    "<g>",
];

pub(crate) fn mutation() -> impl Strategy<Value = Mutation> {
    use prop::sample::Index;
    prop_oneof![
        (any::<Index>(), any::<u8>()).prop_map(|(i, b)| Mutation::Set(i, b)),
        (any::<Index>(), 1..12usize).prop_map(|(i, n)| Mutation::Remove(i, n)),
        (any::<Index>(), 1..40usize).prop_map(|(i, n)| Mutation::Repeat(i, n)),
        (any::<Index>(), prop::sample::select(TOKENS)).prop_map(|(i, t)| Mutation::Insert(i, t)),
    ]
}

pub(crate) fn mutate(bytes: &[u8], mutations: &[Mutation]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for mutation in mutations {
        if bytes.is_empty() {
            break;
        }
        match mutation {
            Mutation::Set(at, byte) => *at.get_mut(&mut bytes) = *byte,
            Mutation::Remove(at, n) => {
                let at = at.index(bytes.len());
                bytes.drain(at..(at + n).min(bytes.len()));
            }
            Mutation::Repeat(at, n) => {
                let at = at.index(bytes.len());
                let piece = bytes[at..(at + n).min(bytes.len())].to_vec();
                bytes.splice(at..at, piece);
            }
            Mutation::Insert(at, token) => {
                let at = at.index(bytes.len());
                bytes.splice(at..at, token.bytes());
            }
        }
    }
    bytes
}

#[test]
fn the_unmutated_scene_is_accepted() {
    assert!(read(FULL, &full_files()).unwrap());
}

proptest! {
    #![proptest_config(config(1))]
    #[test]
    fn mutated_scenes_never_panic(mutations in prop::collection::vec(mutation(), 1..6)) {
        let text = mutate(FULL.as_bytes(), &mutations);
        read(&String::from_utf8_lossy(&text), &full_files())?;
    }

    #[test]
    fn random_text_never_panics(text in "\\PC{0,200}") {
        read(&text, &full_files())?;
    }
}

proptest! {
    #![proptest_config(config(2))]
    #[test]
    fn mutated_files_never_panic(
        file in prop::sample::select(&["puppets/figure.svg", "puppets/figure.toml", "puppets/p.png"][..]),
        mutations in prop::collection::vec(mutation(), 1..6),
    ) {
        let mut files = full_files();
        let bytes = mutate(&files[file], &mutations);
        files.insert(file.to_owned(), bytes);
        read(FULL, &files)?;
    }

    #[test]
    fn random_bytes_are_no_image(bytes in prop::collection::vec(any::<u8>(), 0..300), png_header in any::<bool>()) {
        let mut files = full_files();
        let mut file = if png_header { files["puppets/p.png"][..40].to_vec() } else { Vec::new() };
        file.extend(bytes);
        files.insert("puppets/p.png".to_owned(), file);
        prop_assert!(!read(FULL, &files)?);
    }
}

/// z of a corner, by rotating (u, v, 0) about x and then about y.
fn corner_z(position_z: f64, [u, v]: [f64; 2], tilt_deg: [f64; 2]) -> f64 {
    let [about_x, about_y] = tilt_deg.map(f64::to_radians);
    position_z + v * about_x.sin() * about_y.cos() - u * about_y.sin()
}

proptest! {
    #![proptest_config(config(3))]
    #[test]
    fn a_tilted_puppet_is_accepted_exactly_when_its_corners_are_backstage(
        z in -1.7..0.1f64, about_x in -89.9..89.9f64, about_y in -89.9..89.9f64,
    ) {
        let scene = SCENE
            .replace("texels = 128", &format!("texels = 64\ntilt_deg = [{about_x:?}, {about_y:?}]"))
            .replace("[0.0, 0.0, -0.2]", &format!("[0.0, 0.0, {z:?}]"));
        let inside = [[-0.3, -0.3], [0.3, -0.3], [0.3, 0.3], [-0.3, 0.3], [0.0, 0.0]]
            .iter()
            .map(|&corner| corner_z(z, corner, [about_x, about_y]))
            .all(|z| z > -1.5 && z < 0.0);
        prop_assert_eq!(read(&scene, &files())?, inside);
    }

    #[test]
    fn turned_and_posed_puppets_keep_their_opacity(rotate in -400.0..400.0f64, bar in -120.0..180.0f64, leaf in -720.0..720.0f64) {
        // Nothing is cut off: the grid holds all of the body, 64 × 64, wherever the rest is, to within what overlaps.
        let lines = format!("texels = 128\nrotate_deg = {rotate:?}\npose = {{ bar = {bar:?}, leaf = {leaf:?} }}");
        let scene = SCENE.replace("texels = 128", &lines);
        let theatre = parse(&scene, &files()).unwrap().still();
        check(&theatre)?;
        let mask = &theatre.planes[0].mask;
        let opacity: f64 = (0..mask.height)
            .flat_map(|y| (0..mask.width).map(move |x| (x, y)))
            .map(|(x, y)| 1.0 - mask.transmittance(0, x, y))
            .sum();
        // The body, and of bar (20 × 8 beyond the body at rest) and leaf (16 × 16) what does not overlap.
        prop_assert!((4096.0 + 100.0..=4096.0 + 160.0 + 256.0 + 10.0).contains(&opacity), "{}", opacity);
    }
}

#[test]
fn a_manifest_alone_is_mutated_too() {
    // A fixed walk through every prefix: truncation is the commonest damage.
    for end in (0..MANIFEST.len()).step_by(7) {
        let mut files = full_files();
        files.insert("puppets/figure.toml".into(), MANIFEST.as_bytes()[..end].to_vec());
        read(FULL, &files).unwrap();
    }
    for end in (0..PUPPET_SVG.len()).step_by(7) {
        let mut files = full_files();
        files.insert("puppets/figure.svg".into(), PUPPET_SVG.as_bytes()[..end].to_vec());
        assert!(!read(FULL, &files).unwrap());
    }
}
