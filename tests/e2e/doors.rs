//! One picture, two doors: what `kelir render` and `kelir animate` write is what a study shows.

use std::collections::HashMap;
use std::path::Path;

use kelir_fixtures as fixtures;
use kelir_tests::{Server, kelir, kelir_ok, sql};
use serde_json::Value;

/// A still and an animation of one scene; it hides the built-in study by having its name.
fn study() -> String {
    let block = |id: &str, kind: &str| {
        fixtures::block(id, &[("kind", kind), ("items", &fixtures::items([id], "../scenes/lamp.toml"))])
    };
    let conditions = r#"{ pa = { technique = "pa" }, mc = { technique = "mc", spp = 16 } }"#;
    let blocks = [block("still", "\"still\""), block("moving", "\"animation\"")];
    fixtures::study(&[("size", "[96, 54]"), ("conditions", conditions)], blocks)
}

/// The lamp comes nearer and stays: frames that show nothing new are among them.
fn scene() -> String {
    let timeline = r#"
[timeline]
fps = 10
seconds = 0.5
loop = false
[[timeline.tracks]]
target = "lamp.position_m"
easing = "linear"
keys = [{ t = 0.0, value = [0.0, 0.0, -1.5] }, { t = 0.3, value = [0.0, 0.0, -0.9] }, { t = 0.5, value = [0.0, 0.0, -0.9] }]
"#;
    format!("{}{timeline}", fixtures::SCENE)
}

/// Runs `kelir COMMAND SCENE …` on the native code at the study's size; answers what `--stats json` prints.
fn draw(command: &str, folder: &Path, technique: &str, more: &[&str], output: &Path) -> Value {
    let scene = folder.join("scenes/lamp.toml");
    let mut args = vec![command, scene.to_str().unwrap(), "--technique", technique];
    if technique == "mc" {
        args.extend(["--spp", "16"]);
    }
    args.extend(["--size", "96x54", "--backend", "cpu", "--stats", "json", "-o", output.to_str().unwrap()]);
    args.extend(more);
    serde_json::from_str(&kelir_ok(&args)).unwrap()
}

/// Hashes and bytes of the frames of a folder that `kelir animate` wrote.
fn frames(folder: &Path) -> (Value, Vec<Vec<u8>>) {
    let manifest: Value =
        serde_json::from_slice(&std::fs::read(folder.join("manifest.json")).unwrap()).unwrap();
    let names = manifest["frames"].as_array().unwrap().clone();
    (manifest, names.iter().map(|name| std::fs::read(folder.join(name.as_str().unwrap())).unwrap()).collect())
}

#[test]
fn the_command_line_draws_what_a_study_shows() {
    let data = tempfile::tempdir().unwrap();
    let files = [
        ("studies/shadow-puppets.toml", &*study()),
        ("scenes/lamp.toml", &scene()),
        ("puppets/square.svg", fixtures::SQUARE),
    ];
    fixtures::write(data.path(), &files);
    assert!(Server::start(data.path(), true).terminate().success());
    let rows = sql(
        &data.path().join("kelir.sqlite"),
        "SELECT item_id, condition, sha256, provenance FROM version_stimuli",
    );
    let shown: HashMap<(&str, &str), (&str, Value)> = rows
        .iter()
        .map(|row| {
            let text = |name: &str| row[name].as_str().unwrap();
            let provenance = serde_json::from_str(text("provenance")).unwrap();
            ((text("item_id"), text("condition")), (text("sha256"), provenance))
        })
        .collect();
    assert_eq!(shown.len(), 4);
    let bytes =
        |sha256: &str| std::fs::read(data.path().join("stimuli").join(&sha256[..2]).join(sha256)).unwrap();
    let work = tempfile::tempdir().unwrap();
    let output = |name: &str| work.path().join(name);

    for technique in ["pa", "mc"] {
        let (sha256, provenance) = &shown[&("still", technique)];
        let stats = draw("render", data.path(), technique, &[], &output("still.png"));
        let still = std::fs::read(output("still.png")).unwrap();
        assert!(still == bytes(sha256), "{technique}: white {} and {}", stats["white"], provenance["white"]);
        assert_eq!(stats["white"], provenance["white"], "{technique}");
        assert_eq!((&stats["exposure"], &provenance["exposure"]), (&"still".into(), &"still".into()));
        // Negative control: the other rule is another picture.
        let stats = draw("render", data.path(), technique, &["--exposure", "timeline"], &output("other.png"));
        assert!(std::fs::read(output("other.png")).unwrap() != still, "{technique}");
        let (_, moving) = &shown[&("moving", technique)];
        assert_eq!(stats["white"], moving["white"], "{technique}");
        assert!(stats["white"].as_f64() > provenance["white"].as_f64(), "the lamp comes nearer: {stats}");

        let (sha256, provenance) = &shown[&("moving", technique)];
        let manifest: Value = serde_json::from_slice(&bytes(sha256)).unwrap();
        let hashes = manifest["frames"].as_array().unwrap();
        let expected: Vec<Vec<u8>> = hashes.iter().map(|hash| bytes(hash.as_str().unwrap())).collect();
        let stats = draw("animate", data.path(), technique, &[], &output("frames"));
        let (written, drawn) = frames(&output("frames"));
        assert_eq!(drawn.len(), 5);
        assert!(drawn == expected, "{technique}");
        assert_eq!(stats["white"], provenance["white"], "{technique}");
        assert_eq!(written["white"], provenance["white"], "{technique}");
        assert_eq!(stats["frames_repeated"], provenance["counts"]["frames_repeated"], "{technique}");
        assert_eq!((&stats["exposure"], &provenance["exposure"]), (&"timeline".into(), &"timeline".into()));
        let other = format!("other-{technique}");
        draw("animate", data.path(), technique, &["--exposure", "still"], &output(&other));
        let (_, other) = frames(&output(&other));
        assert!(other.iter().zip(&drawn).all(|(a, b)| a != b), "{technique}");
    }
}

/// A still of an instant is exposed for that instant; what is no rule is refused.
#[test]
fn an_instant_has_an_exposure_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let files = [("scenes/lamp.toml", &*scene()), ("puppets/square.svg", fixtures::SQUARE)];
    fixtures::write(folder.path(), &files);
    let output = folder.path().join("x.png");
    let white = |more: &[&str]| draw("render", folder.path(), "pa", more, &output)["white"].as_f64().unwrap();
    // The brightest pixel is next to the axis: a small lamp's light falls off as 1 / z².
    let near = white(&["--time", "0.3"]) / white(&[]);
    assert!((near / (1.5f64 / 0.9).powi(2) - 1.0).abs() < 5e-3, "{near}");
    assert_eq!(white(&["--time", "0"]), white(&[]));
    assert_eq!(white(&["--time", "0.3"]), white(&["--exposure", "timeline"]));
    assert!(white(&["--time", "0.1"]) < white(&["--time", "0.1", "--exposure", "timeline"]));
    let scene = folder.path().join("scenes/lamp.toml");
    let out = kelir(&[
        "render",
        scene.to_str().unwrap(),
        "--technique",
        "pa",
        "--exposure",
        "bright",
        "-o",
        "x.png",
    ]);
    assert_eq!(out.status.code(), Some(2));
    let message = String::from_utf8_lossy(&out.stderr).into_owned();
    assert!(message.contains("still") && message.contains("timeline"), "{message}");
}
