//! The reference page of scene files and puppet manifests, made of what their reader asks for while it reads scenes that use every key.
#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

use crate::read::Noted;
use crate::{DirAssets, Scene};

/// What is known of a key.
#[derive(Default)]
struct Key {
    place: usize,
    needed: bool,
    what: String,
    rules: Vec<String>,
}

thread_local! {
    static ASKED: RefCell<BTreeMap<String, Key>> = RefCell::default();
}

/// Writes down what was asked for; `[3]` becomes `[]`, since every item is read alike.
pub(crate) fn noted(path: &str, what: Noted) {
    let mut place = String::new();
    for part in path.split_inclusive(['[', ']']) {
        if !part.ends_with(']') {
            place.push_str(part);
        } else {
            place.push(']');
        }
    }
    ASKED.with_borrow_mut(|asked| {
        let next = asked.len();
        match what {
            Noted::Key { needed, what } => {
                let key = asked.entry(place).or_insert_with(|| Key { place: next, ..Key::default() });
                (key.needed, key.what) = (needed, what.to_owned());
            }
            // A rule of an item is its key's.
            Noted::Rule(rule) => {
                if let Some(key) = asked.get_mut(place.trim_end_matches("[]"))
                    && !key.rules.iter().any(|known| known == rule)
                    && key.what != rule
                {
                    key.rules.push(rule.to_owned());
                }
            }
        }
    });
}

/// Between them these ask for every key.
const SAMPLES: [&str; 2] = [
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
];

fn page() -> String {
    let stimuli = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../stimuli");
    let good = Scene::parse("sample.toml", SAMPLES[0], &DirAssets::new(&stimuli));
    good.unwrap_or_else(|errors| panic!("{errors}"));
    // The cloth's picture is not there; its key has been asked for by then.
    Scene::parse("sample.toml", SAMPLES[1], &DirAssets::new(&stimuli)).unwrap_err();
    ASKED.with_borrow(|asked| {
        // A manifest's keys stand at the root of their own file.
        let manifest = |path: &str| {
            let first = path.split(['.', '[']).next().unwrap_or_default();
            ["title", "source", "license", "image", "parts"].contains(&first)
        };
        let table = |of_manifest: bool| {
            let mut keys: Vec<_> = asked.iter().filter(|(path, _)| manifest(path) == of_manifest).collect();
            keys.sort_by_key(|(_, key)| key.place);
            let line = |(path, key): &(&String, &Key)| {
                let rules = if key.rules.is_empty() { String::new() } else { format!(" ({})", key.rules.join("; ")) };
                let needed = if key.needed { "yes" } else { "" };
                format!("| `{path}` | {needed} | {}{rules} |", key.what.replace('|', "\\|"))
            };
            keys.iter().map(line).collect::<Vec<_>>().join("\n")
        };
        format!(
            "# Scene files and puppet manifests\n\n\
             Made of what their reader asks for: `KELIR_BLESS=1 cargo test -p kelir-scene reference` writes this page, and a test compares it.\n\
             Both are TOML. Lengths are in metres, angles in degrees; the middle of the cloth is the origin, the audience is at z > 0, puppets and lamp are\n\
             at z < 0. Paths are relative to the file that names them. A key that is not listed is refused. `kelir scene check FILE` names every problem.\n\n\
             ## A scene\n\n| key | needed | what it is |\n|---|---|---|\n{}\n\n\
             ## A puppet's manifest\n\n| key | needed | what it is |\n|---|---|---|\n{}\n",
            table(false),
            table(true)
        )
    })
}

#[test]
fn the_page_lists_every_key_that_the_reader_asks_for() {
    let page = page();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/scene-file.md");
    if std::env::var_os("KELIR_BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, &page).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&path).unwrap_or_default(), page, "KELIR_BLESS=1 writes it anew");
    // Each key of the scenes that ship is in it: nothing was left out by what the samples lack.
    for sample in ["hutan", "arjuna-dance", "benchmark"] {
        let stimuli = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../stimuli");
        let before = ASKED.with_borrow(BTreeMap::len);
        Scene::from_path(&stimuli.join(format!("scenes/{sample}.toml"))).unwrap();
        assert_eq!(ASKED.with_borrow(BTreeMap::len), before, "{sample} has keys that the page lacks");
    }
    // Negative control: what is asked for and not in the page is seen.
    noted("screen.curvature", Noted::Key { needed: false, what: "bent" });
    assert!(
        !page.contains("screen.curvature")
            && ASKED.with_borrow(|asked| asked.contains_key("screen.curvature"))
    );
}
