//! The reference page of scene files and puppet manifests, made of what their reader asks for while it reads scenes that use every key.
#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use std::path::Path;

use kelir_reader::{Asked, Reading};

use crate::DirAssets;
use crate::scene::read_into;

/// Between them these ask for every key.
const SAMPLES: [&str; 3] = [
    r#"
subject = "theatre"
[screen]
width_m = 1.6
height_m = 0.9
albedo = { weave = { base = 0.8 } }
[lamp]
position_m = [0, 0, -1]
emitters = [
    { name = "a", shape = "rectangle", size_m = [0.1, 0.1], radiance = 1 },
    { name = "b", shape = "disk", radius_m = 0.1, radiance = 1 },
]
[ambient]
model = "paper"
k_d_m = 0.5
s = 0.5
[exposure]
white = 1.0
[[puppets]]
image = "puppets/kijang.toml"
height_m = 0.1
position_m = [0, 0, -0.5]
texels = 64
tilt_deg = [1, 1]
rotate_deg = 1
pose = { head = 1 }
[timeline]
fps = 1
seconds = 1
[[timeline.tracks]]
target = "puppets[0].pose.head"
keys = [{ t = 0, value = 1 }]
"#,
    r#"
[screen]
width_m = 1.6
height_m = 0.9
albedo = { image = "cloth.png" }
[lamp]
position_m = [0, 0, -1]
emitters = [{ name = "a", shape = "disk", radius_m = 0.1, radiance = 1 }]
[ambient]
model = "dome"
radiance = 1
[exposure]
white = "auto"
"#,
    r#"
subject = "stage"
[stage]
ambient = 0.1
[stage.camera]
position_m = [0, 0, 1]
look_at_m = [0, 0, 0]
up = [0, 1, 0]
intrinsics = { size_px = [4, 3], focal_px = [1, 1], centre_px = [2, 1.5] }
[[stage.objects]]
name = "a"
shape = "mesh"
file = "none.obj"
[[stage.objects]]
name = "b"
shape = "sphere"
radius_m = 1
mirror = 1
[[stage.objects]]
name = "c"
shape = "rectangle"
size_m = [1, 1]
[[stage.objects]]
name = "d"
shape = "triangle"
corners_m = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
[[stage.objects]]
name = "e"
shape = "cylinder"
radius_m = 1
height_m = 1
[[stage.lights]]
name = "a"
kind = "point"
position_m = [0, 0, 1]
intensity = 1
[[stage.lights]]
name = "b"
kind = "directional"
direction = [0, -1, 0]
irradiance = 1
[[stage.lights]]
name = "c"
kind = "rectangle"
position_m = [0, 1, 1]
size_m = [1, 1]
radiance = 1
[[stage.lights]]
name = "d"
kind = "environment"
image = "none.exr"
[[stage.lights]]
name = "e"
kind = "projector"
position_m = [0, 1, 1]
throw_deg = 30
intensity = 1
slide = { pattern = "sine", frequency = 1 }
[[stage.lights]]
name = "f"
kind = "projector"
position_m = [0, 1, 1]
throw_deg = 30
intensity = 1
slide = { pattern = "noise", band = [1, 2] }
[[stage.lights]]
name = "g"
kind = "projector"
position_m = [0, 1, 1]
throw_deg = 30
intensity = 1
slide = { pattern = "image", image = "none.png" }
[[stage.lights]]
name = "h"
kind = "disk"
position_m = [0, 1, 1]
radius_m = 1
radiance = 1
"#,
];

fn stimuli() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../stimuli")
}

/// Reads a scene, noting what is asked for; whether it is sound.
fn asked_of(reading: &Reading, name: &str, toml: &str) -> bool {
    read_into(reading, name, name, toml, &DirAssets::new(stimuli())).is_some()
}

/// What is asked for by a scene's reader and by a manifest's, whose keys stand at the root of their own file.
fn asked() -> [Asked; 3] {
    let reading = Reading::noting();
    assert!(asked_of(&reading, "sample.toml", SAMPLES[0]), "{:?}", reading.into_problems());
    // The cloth's picture is not there; its key has been asked for by then.
    assert!(!asked_of(&reading, "sample.toml", SAMPLES[1]));
    // Neither are a stage's files.
    assert!(!asked_of(&reading, "sample.toml", SAMPLES[2]));
    let part = |path: &str| match path.split(['.', '[']).next().unwrap_or_default() {
        "title" | "source" | "license" | "image" | "parts" => 2,
        "stage" => 1,
        _ => 0,
    };
    [0, 1, 2].map(|wanted| {
        let mut asked = reading.asked();
        asked.keys.retain(|path, _| part(path) == wanted);
        asked
    })
}

fn page([scene, stage, manifest]: &[Asked; 3]) -> String {
    format!(
        "# Scene files and puppet manifests\n\n\
         Made of what their reader asks for: `KELIR_BLESS=1 cargo test -p kelir-scene reference` writes this page, and a test compares it.\n\
         Both are TOML. Lengths are in metres, angles in degrees; the middle of the cloth is the origin, the audience is at z > 0, puppets and lamp are\n\
         at z < 0. Paths are relative to the file that names them. A key that is not listed is refused. `kelir scene check FILE` names every problem.\n\n\
         ## A scene\n\n| key | needed | what it is |\n|---|---|---|\n{}\n\n\
         ## A stage\n\nThe sections of a scene with `subject = \"stage\"`, beside `exposure` and `timeline`. Right-handed, y up; a camera looks along its own −z.\n\n\
         | key | needed | what it is |\n|---|---|---|\n{}\n\n\
         ## A puppet's manifest\n\n| key | needed | what it is |\n|---|---|---|\n{}\n",
        scene.rows(),
        stage.rows(),
        manifest.rows()
    )
}

#[test]
fn the_page_lists_every_key_that_the_reader_asks_for() {
    let asked = asked();
    let page = page(&asked);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/scene-file.md");
    if std::env::var_os("KELIR_BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, &page).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&path).unwrap_or_default(), page, "KELIR_BLESS=1 writes it anew");
    // Each key of the scenes that ship is in it: nothing was left out by what the samples lack.
    let lacking = |asked: &[Asked; 3], name: &str| -> Vec<String> {
        let reading = Reading::noting();
        let toml = std::fs::read_to_string(stimuli().join(name)).unwrap();
        assert!(asked_of(&reading, name, &toml), "{name}");
        let known = |path: &String| asked.iter().any(|asked| asked.keys.contains_key(path));
        reading.asked().keys.into_keys().filter(|path| !known(path)).collect()
    };
    for name in ["hutan", "arjuna-dance", "benchmark"] {
        assert_eq!(lacking(&asked, &format!("scenes/{name}.toml")), Vec::<String>::new());
    }
    // Negative control: a key that the page lacks is seen.
    let [mut scene, stage, manifest] = asked;
    scene.keys.remove("timeline.loop").unwrap();
    assert_eq!(lacking(&[scene, stage, manifest], "scenes/arjuna-dance.toml"), ["timeline.loop"]);
}
