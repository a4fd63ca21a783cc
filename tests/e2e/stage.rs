//! Stages through the real binary: checked, drawn, animated, and refused with what can be done.

use kelir_tests::{kelir, kelir_ok};
use serde_json::Value;

const STAGE: &str = r#"subject = "stage"

[stage]
ambient = 0.02

[stage.camera]
position_m = [0, 0.4, 1.2]
look_at_m = [0, 0.15, 0]
field_of_view_deg = 30
aspect = 1.5

[[stage.objects]]
name = "ground"
shape = "rectangle"
size_m = [4, 4]
rotate_deg = [-90, 0, 0]

[[stage.objects]]
name = "pyramid"
shape = "mesh"
file = "pyramid.obj"
position_m = [-0.05, 0, 0.05]

[[stage.lights]]
name = "projector"
kind = "projector"
position_m = [0.6, 0.9, 0.6]
throw_deg = 40
intensity = 3
slide = { pattern = "sine", frequency = [4, 4] }

[timeline]
fps = 10
seconds = 0.2

[[timeline.tracks]]
target = "stage.objects[1].rotate_deg"
keys = [{ t = 0, value = [0, 0, 0] }, { t = 0.1, value = [0, 45, 0] }]
"#;

const PYRAMID: &str = "v 0 0 0\nv .1 0 0\nv .1 0 -.1\nv 0 0 -.1\nv .05 .08 -.05\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

#[test]
fn a_stage_is_checked_drawn_and_animated() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::write(at("stage.toml"), STAGE).unwrap();
    std::fs::write(at("pyramid.obj"), PYRAMID).unwrap();
    let scene = at("stage.toml");
    let said = kelir_ok(&["scene", "check", &scene]);
    assert!(said.contains("2 objects of 12 triangles, 1 lights, 2 frames"), "{said}");

    // Pixels' middles under a projector: exact, and the same bytes each time.
    let middles = |out: &str| {
        let size = ["--size", "96x64", "--pixel", "centre", "-o", out, "--json"];
        kelir_ok(&[&["render", &scene, "--technique", "raytrace"], &size[..]].concat())
    };
    let report: Value = serde_json::from_str(&middles(&at("a.png"))).unwrap();
    assert!(report["standard_error"].is_null() && report["stats"]["counts"]["rays"].as_u64() > Some(96 * 64));
    middles(&at("b.png"));
    let [a, b] = ["a.png", "b.png"].map(|name| std::fs::read(at(name)).unwrap());
    assert_eq!(a, b);
    let image = image::load_from_memory(&a).unwrap().to_luma8();
    let brightness: Vec<u8> = image.pixels().map(|p| p.0[0]).collect();
    assert!(
        brightness.iter().any(|b| *b > 240) && brightness.iter().filter(|b| **b < 60).count() > 100,
        "light and shadow"
    );

    // Over pixels' areas an error is known, and layers of it are in an EXR.
    let areas = ["--size", "96x64", "--spp", "16", "-o", &at("c.exr"), "--json"];
    let report = kelir_ok(&[&["render", &scene, "--technique", "raytrace"], &areas[..]].concat());
    let report: Value = serde_json::from_str(&report).unwrap();
    assert!(report["standard_error"]["max"].as_f64() > Some(0.0));

    kelir_ok(&[
        "animate",
        &scene,
        "--technique",
        "raytrace",
        "--size",
        "48x32",
        "--spp",
        "16",
        "-o",
        &at("film"),
    ]);
    let manifest: Value = serde_json::from_slice(&std::fs::read(at("film/manifest.json")).unwrap()).unwrap();
    let frames = manifest["frames"].as_array().unwrap();
    assert!(frames.len() == 2 && frames[0] != frames[1], "it turns: {manifest}");
}

#[test]
fn what_a_stage_cannot_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::write(at("stage.toml"), STAGE).unwrap();
    std::fs::write(at("pyramid.obj"), PYRAMID).unwrap();
    let said = |args: &[&str]| {
        let out = kelir(args);
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        assert_eq!(out.status.code(), Some(2), "{args:?}: {said}");
        said
    };
    let out = at("x.png");
    let scene = at("stage.toml");
    let pa = said(&["render", &scene, "--technique", "pa", "--size", "96x64", "-o", &out]);
    assert!(pa.contains("pa cannot draw this scene: it shows a stage, which raytrace alone draws"), "{pa}");
    let theatre = said(&["render", "kayon", "--technique", "raytrace", "--size", "96x54", "-o", &out]);
    assert!(theatre.contains("it shows a theatre, which the other techniques draw"), "{theatre}");
    let size = said(&["render", &scene, "--technique", "raytrace", "--size", "96x54", "-o", &out]);
    assert!(size.contains("size = 96x54") && size.contains("96 pixels of width need 64 of height"), "{size}");
    std::fs::write(at("pyramid.obj"), format!("{PYRAMID}f 1 1 2\n")).unwrap();
    let mesh = said(&["scene", "check", &scene]);
    assert!(
        mesh.contains("stage.objects[1].file = \"pyramid.obj\"") && mesh.contains("repair = true"),
        "{mesh}"
    );
    assert!(!std::path::Path::new(&out).exists());
}
