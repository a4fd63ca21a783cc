#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::task::tasks;
use kelir_fixtures as fixtures;
use kelir_store::sha256_hex;
use std::sync::LazyLock;

/// A still and a film of one scene under two techniques.
static STUDY: LazyLock<String> = LazyLock::new(|| {
    let block = |id: &str, item: &str, kind: &str| {
        let items = fixtures::items([item], "../scenes/lamp.toml");
        fixtures::block(id, &[("kind", kind), ("conditions", "[\"pa\", \"pcss\"]"), ("items", &items)])
    };
    let conditions = r#"{ pa = { technique = "pa" }, pcss = { technique = "pcss", bias_m = 0 } }"#;
    let blocks = [block("stills", "a", "\"still\""), block("loop", "b", "\"animation\"")];
    fixtures::study(&[("seed", "3"), ("conditions", conditions)], blocks)
});

/// The lamp moves.
static SCENE: LazyLock<String> = LazyLock::new(|| {
    let timeline = r#"
[timeline]
fps = 10
seconds = 0.2
loop = true
[[timeline.tracks]]
target = "lamp.position_m"
keys = [{ t = 0.0, value = [0.0, 0.0, -1.5] }, { t = 0.1, value = [0.0, 0.0, -1.0] }]
"#;
    format!("{}{timeline}", fixtures::SCENE)
});

fn library(study: &str) -> (tempfile::TempDir, Library) {
    let folder = tempfile::tempdir().unwrap();
    let files =
        [("studies/s.toml", study), ("scenes/lamp.toml", &SCENE), ("puppets/square.svg", fixtures::SQUARE)];
    fixtures::write(folder.path(), &files);
    let library = Library::new(folder.path());
    (folder, library)
}

fn identities(study: &str) -> Vec<String> {
    let (_folder, library) = library(study);
    let study = library.study("studies/s.toml").unwrap();
    let maker = RenderMaker::default();
    tasks(&study).iter().map(|task| maker.identity(task, &library).unwrap()).collect()
}

/// Known from the scene's hash alone, the key is that of the job with its scene read.
#[test]
fn the_key_is_the_jobs() {
    let (_folder, library) = library(&STUDY);
    let study = library.study("studies/s.toml").unwrap();
    let keys: Vec<String> = tasks(&study)
        .iter()
        .map(|task| {
            let key = sha256_hex(RenderMaker::default().identity(task, &library).unwrap().as_bytes());
            let AnyScene::Theatre(read) = library.scene("scenes/lamp.toml").unwrap() else {
                panic!("a theatre")
            };
            assert_eq!(key, job(task).unwrap().with_scene(read).key().unwrap());
            key
        })
        .collect();
    assert!((1..4).all(|k| !keys[..k].contains(&keys[k])), "{keys:?}");
    let texts = identities(&STUDY);
    let rules = ["still", "still", "timeline", "timeline"].map(|rule| format!(r#""exposure":"{rule}""#));
    for (text, rule) in texts.iter().zip(&rules) {
        assert!(text.starts_with("kelir-job/2\n{\"backend\":\"cpu\"") && text.contains(rule), "{text}");
        assert!(text.contains(r#""reference":{"knobs":{"seed":1,"spp":64},"revision":"#), "{text}");
    }
}

#[test]
fn what_a_study_leaves_out_is_its_default() {
    let written = STUDY
        .replace("technique = \"pa\"", "technique = \"pa\", split = 1, weights = \"area\"")
        .replace("bias_m = 0", "bias_m = -0.0, seed = 1");
    assert_eq!(identities(&written), identities(&STUDY));
    // Negative controls.
    let other = identities(&STUDY.replace("technique = \"pa\"", "technique = \"pa\", split = 2"));
    let same: Vec<bool> = identities(&STUDY).iter().zip(&other).map(|(a, b)| a == b).collect();
    assert_eq!(same, [false, true, false, true]);
    let sizes = identities(&STUDY.replace("[64, 36]", "[80, 45]"));
    assert!(sizes.iter().zip(identities(&STUDY)).all(|(a, b)| *a != b));
}

#[test]
fn a_knob_out_of_its_range_is_found_with_the_study() {
    let (_folder, library) = library(&STUDY.replace("bias_m = 0", "map_size = 1"));
    let said = library.study("studies/s.toml").unwrap_err().to_string();
    assert!(
        said.contains("conditions.pcss")
            && said.contains("map_size = 1: must be a whole number from 16 to 8192"),
        "{said}"
    );
}

/// A picture of another scene is not kept under this one's key.
#[test]
fn a_scene_that_changes_meanwhile_is_refused() {
    let (folder, library) = library(&STUDY);
    let study = library.study("studies/s.toml").unwrap();
    let task = tasks(&study).remove(0);
    let maker = RenderMaker::default();
    maker.identity(&task, &library).unwrap();
    assert!(maker.make(&task, &library, &mut |_, _| ()).is_ok());
    let brighter = SCENE.replace("radiance = 40.0", "radiance = 41.0");
    fixtures::write(folder.path(), &[("scenes/lamp.toml", &brighter)]);
    let said = maker.make(&task, &library, &mut |_, _| ()).unwrap_err();
    assert!(said.contains("scenes/lamp.toml") && said.contains("changed"), "{said}");
}

/// A photograph at a larger size is the same photograph: its blur is as wide in the scene, and its noise has the same power there.
#[test]
fn a_camera_sees_alike_at_each_size() {
    let camera = "technique = \"pa\", camera = { defocus_px = 0.8, noise = 0.012, seed = 7 }";
    let study = STUDY
        .replace("size = [64, 36]\n", "")
        .replacen("[texts]", "[display]\nsizes = [[64, 36], [160, 90]]\n[texts]", 1)
        .replacen("technique = \"pa\"", camera, 1);
    let (stills, _) = study.rsplit_once("[[blocks]]").unwrap();
    let (_folder, library) = library(stills);
    let study = library.study("studies/s.toml").unwrap_or_else(|errors| panic!("{errors}"));
    let jobs: Vec<_> =
        tasks(&study).iter().filter(|t| t.name == "pa").map(|task| job(task).unwrap()).collect();
    let settings: Vec<_> = jobs.iter().map(|job| (job.view.size, job.camera.unwrap())).collect();
    let [(small, first), (large, second)] = settings[..] else { panic!("{settings:?}") };
    assert_eq!((small, first.defocus_px, first.noise), ([64, 36], 0.8, 0.012));
    assert_eq!((large, second.defocus_px, second.noise), ([160, 90], 2.0, 0.03));
    assert_eq!((second.vignette, second.jpeg_quality, second.seed), (first.vignette, first.jpeg_quality, 7));
    // What is too much at the largest size is told with the study.
    let wide = stills.replace("defocus_px = 0.8", "defocus_px = 60");
    let (_folder, library) = self::library(&wide);
    let said = library.study("studies/s.toml").unwrap_err().to_string();
    assert!(said.contains("conditions.pa.camera") && said.contains("defocus_px = 150"), "{said}");
}

/// A study may show a stage: checked, keyed, tried in a small size and made by the same functions.
#[test]
fn a_stage_is_made_as_a_theatre_is() {
    const STAGE: &str = r#"
subject = "stage"
[stage.camera]
position_m = [0, 1, 3]
look_at_m = [0, 0.3, 0]
field_of_view_deg = 40
[[stage.objects]]
name = "ground"
shape = "rectangle"
size_m = [4, 4]
rotate_deg = [-90, 0, 0]
[[stage.objects]]
name = "ball"
shape = "sphere"
radius_m = 0.4
position_m = [0, 0.4, 0]
[[stage.lights]]
name = "lamp"
kind = "rectangle"
position_m = [1, 2, 1]
size_m = [0.5, 0.5]
radiance = 5
"#;
    let study = |one: &str, other: &str| {
        let items = fixtures::items(["a"], "../scenes/lamp.toml");
        let block = fixtures::block(
            "stills",
            &[
                ("kind", "\"still\""),
                ("conditions", "[\"one\", \"other\"]"),
                ("target", "\"one\""),
                ("items", &items),
            ],
        );
        let conditions = format!("{{ one = {{ {one} }}, other = {{ {other} }} }}");
        fixtures::study(&[("conditions", &conditions)], [block])
    };
    let written = |study: &str| {
        let (folder, library) = library(study);
        std::fs::write(folder.path().join("scenes/lamp.toml"), STAGE).unwrap();
        (folder, library)
    };
    let few = r#"technique = "raytrace", spp = 16"#;
    let (_folder, library) = written(&study(few, r#"technique = "pa""#));
    let refused = library.rehearsed("studies/s.toml").unwrap_err().to_string();
    assert!(refused.contains("it shows a stage, which raytrace alone draws"), "{refused}");

    let (_folder, library) = written(&study(few, r#"technique = "raytrace", spp = 32"#));
    let study = library.rehearsed("studies/s.toml").unwrap();
    let maker = RenderMaker::default();
    let made: Vec<(String, Made)> = tasks(&study)
        .iter()
        .map(|task| {
            let key = sha256_hex(maker.identity(task, &library).unwrap().as_bytes());
            (key, maker.make(task, &library, &mut |_, _| ()).unwrap())
        })
        .collect();
    let [(one, first), (other, second)] = &made[..] else { panic!("two pictures") };
    assert!(one != other && first.bytes != second.bytes);
    assert_eq!((&first.provenance["technique"], &first.provenance["spp"]), (&json!("raytrace"), &json!(16)));
    assert!(first.provenance["standard_error"]["max"].as_f64().unwrap() > 0.0);
}
