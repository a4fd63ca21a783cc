//! The rooms' walls: which crate may know which other, read from `cargo metadata`; who may name what, read from the sources.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

/// Crates that stay pure: no async runtime, database, web server or GPU anywhere below them.
const PURE: [&str; 8] = [
    "kelir-reader",
    "kelir-mesh",
    "kelir-scene",
    "kelir-stats",
    "kelir-study",
    "kelir-vision",
    "kelir-plot",
    "kelir-report",
];
const IMPURE: [&str; 5] = ["tokio", "sqlx", "rusqlite", "axum", "wgpu"];
/// What answers requests, and judges passwords for it: the house knows no HTTP.
const HTTP: [&str; 6] = ["axum", "hyper", "tower", "tower-http", "argon2", "kelir-server"];
/// What some rooms alone may name, beside tests.
const OWNED: [(&str, &[&str]); 11] = [
    ("wgpu", &["kelir-frame", "kelir-theatre"]),
    ("sqlx", &["kelir-store"]),
    ("rusqlite", &["kelir-store"]),
    ("axum", &["kelir-server"]),
    ("kelir-frame", &["kelir-theatre", "kelir-stage", "kelir-render"]),
    ("kelir-stage", &["kelir-render"]),
    ("kelir-theatre", &["kelir-render"]),
    ("kelir-render", &["kelir-house", "kelir"]),
    ("kelir-house", &["kelir-server", "kelir"]),
    ("kelir-server", &["kelir"]),
    ("kelir-fixtures", &[]),
];

/// Rooms that must not reach another: the reader knows nothing of what it reads, a study nothing of what is drawn, an image nothing of what
/// it shows.
const APART: [(&str, &str); 4] = [
    ("kelir-reader", "kelir-scene"),
    ("kelir-reader", "kelir-study"),
    ("kelir-study", "kelir-scene"),
    ("kelir-frame", "kelir-scene"),
];

/// Every broken invariant, as a sentence.
fn violations(metadata: &Value) -> Vec<String> {
    let names: BTreeMap<&str, &str> = packages(metadata)
        .map(|p| (p["id"].as_str().expect("id"), p["name"].as_str().expect("name")))
        .collect();
    let members: BTreeSet<&str> =
        metadata["workspace_members"].as_array().expect("members").iter().filter_map(Value::as_str).collect();
    let edges: BTreeMap<&str, Vec<&str>> = metadata["resolve"]["nodes"]
        .as_array()
        .expect("nodes")
        .iter()
        .map(|node| (node["id"].as_str().expect("id"), normal_dependencies(node)))
        .collect();

    let mut found = Vec::new();
    for &member in &members {
        let name = names[member];
        let direct: BTreeSet<&str> = edges[member].iter().map(|id| names[id]).collect();
        for (named, owners) in OWNED {
            if direct.contains(named) && !owners.contains(&name) {
                let owners = if owners.is_empty() { "tests".to_owned() } else { owners.join(" and ") };
                found.push(format!("{name} names {named}: only {owners} may"));
            }
        }
        for (room, other) in APART {
            if name == room && closure(member, &edges).iter().any(|id| names[id] == other) {
                found.push(format!("{room} reaches {other}: it must know nothing of it"));
            }
        }
        let (unreached, why): (&[&str], _) = match name {
            "kelir-house" => (&HTTP, "it must know no HTTP"),
            _ if PURE.contains(&name) => (&IMPURE, "it must stay pure"),
            _ => continue,
        };
        let below = closure(member, &edges);
        for library in unreached.iter().filter(|library| below.iter().any(|id| names[id] == **library)) {
            found.push(format!("{name} reaches {library}: {why}"));
        }
    }
    for room in PURE.iter().chain(OWNED.iter().flat_map(|(_, owners)| *owners)) {
        if !members.iter().any(|id| names[id] == *room) {
            found.push(format!("{room} is not a member: rename it here too"));
        }
    }
    found
}

pub(crate) fn packages(metadata: &Value) -> impl Iterator<Item = &Value> {
    metadata["packages"].as_array().expect("packages").iter()
}

fn normal_dependencies(node: &Value) -> Vec<&str> {
    let normal = |dep: &&Value| {
        dep["dep_kinds"].as_array().is_some_and(|kinds| kinds.iter().any(|k| k["kind"].is_null()))
    };
    node["deps"]
        .as_array()
        .expect("deps")
        .iter()
        .filter(normal)
        .filter_map(|dep| dep["pkg"].as_str())
        .collect()
}

fn closure<'a>(from: &'a str, edges: &BTreeMap<&'a str, Vec<&'a str>>) -> BTreeSet<&'a str> {
    let mut seen = BTreeSet::new();
    let mut open = vec![from];
    while let Some(id) = open.pop() {
        if seen.insert(id) {
            open.extend(edges[id].iter().copied());
        }
    }
    seen
}

pub(crate) fn metadata() -> Value {
    let version = Command::new(env!("CARGO")).arg("-vV").output().expect("cargo -vV");
    let version = String::from_utf8_lossy(&version.stdout).into_owned();
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).expect("a host");
    // Only this machine's packages: those of other platforms are not downloaded by a build.
    let out = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--offline", "--filter-platform", host])
        .output()
        .expect("cargo metadata");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    serde_json::from_slice(&out.stdout).expect("json")
}

#[test]
fn rooms_keep_their_walls() {
    assert_eq!(violations(&metadata()), Vec::<String>::new());
}

#[test]
fn a_broken_wall_is_seen() {
    let mut doctored = metadata();
    for (from, to) in [
        ("kelir-stats", "axum"),
        ("kelir-house", "kelir-server"),
        ("kelir-server", "kelir-render"),
        ("kelir-study", "kelir-scene"),
        ("kelir-study", "kelir-fixtures"),
        ("kelir-render", "wgpu"),
        ("kelir-house", "kelir-theatre"),
        ("kelir-house", "kelir-frame"),
        ("kelir-frame", "kelir-scene"),
    ] {
        add_edge(&mut doctored, from, to);
    }
    let found = violations(&doctored);
    for broken in [
        "kelir-stats names axum: only kelir-server may",
        "kelir-stats reaches axum: it must stay pure",
        // axum brings tokio, and study builds on stats: both are seen through the chain.
        "kelir-stats reaches tokio: it must stay pure",
        "kelir-house names kelir-server: only kelir may",
        "kelir-house reaches hyper: it must know no HTTP",
        "kelir-house reaches argon2: it must know no HTTP",
        "kelir-server names kelir-render: only kelir-house and kelir may",
        "kelir-study reaches kelir-scene: it must know nothing of it",
        "kelir-study names kelir-fixtures: only tests may",
        "kelir-render names wgpu: only kelir-frame and kelir-theatre may",
        "kelir-house names kelir-theatre: only kelir-render may",
        "kelir-house names kelir-frame: only kelir-theatre and kelir-stage and kelir-render may",
        "kelir-frame reaches kelir-scene: it must know nothing of it",
    ] {
        assert!(found.iter().any(|v| v == broken), "{broken}: {found:?}");
    }
}

/// Makes one package depend on another.
fn add_edge(metadata: &mut Value, from: &str, to: &str) {
    let id_of = |name: &str| {
        let package = packages(metadata).find(|p| p["name"] == name).expect("package");
        package["id"].as_str().expect("id").to_owned()
    };
    let (from, to) = (id_of(from), id_of(to));
    let edge = serde_json::json!({"name": "added", "pkg": to, "dep_kinds": [{"kind": null, "target": null}]});
    let nodes = metadata["resolve"]["nodes"].as_array_mut().expect("nodes");
    let node = nodes.iter_mut().find(|node| node["id"] == from.as_str()).expect("node");
    node["deps"].as_array_mut().expect("deps").push(edge);
}

/// What the house may name of the renderer: the door, and what goes in and comes out by it.
const DOOR: [&str; 7] = ["job", "camera", "Backend", "Pixel", "RenderError", "Technique", "View"];

/// The first names that a text has behind `prefix`, lists in braces apart.
fn named_after(text: &str, prefix: &str) -> Vec<String> {
    let first = |item: &str| -> String {
        item.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let mut found = Vec::new();
    for named in text.split(prefix).skip(1) {
        let Some(list) = named.strip_prefix('{') else {
            found.push(first(named));
            continue;
        };
        // A comma parts two names where it stands in no inner list, and the list ends with its own brace.
        let (mut depth, mut start) = (0, 0);
        for (at, c) in list.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth > 0 => depth -= 1,
                ',' | '}' if depth == 0 => {
                    found.push(first(&list[start..at]));
                    start = at + 1;
                    if c == '}' {
                        break;
                    }
                }
                _ => {}
            }
        }
    }
    found.retain(|name| !name.is_empty());
    found
}

/// What a text names of the renderer beside the door.
fn past_the_door(text: &str) -> Vec<String> {
    let named = named_after(text, "kelir_render::").into_iter();
    named.filter(|name| !DOOR.contains(&name.as_str())).collect()
}

/// Rust and TypeScript files below these folders of the project, each by its path there and with its text.
fn sources(folders: &[&str]) -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("root");
    let (mut found, mut open) = (Vec::new(), folders.iter().map(|f| root.join(f)).collect::<Vec<_>>());
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(fs::read_dir(&path).expect("folder").map(|entry| entry.expect("entry").path()));
        } else if path.extension().is_some_and(|e| e == "rs" || e == "ts") {
            let name = path.strip_prefix(root).expect("below").to_string_lossy().into_owned();
            found.push((name, fs::read_to_string(&path).expect("text")));
        }
    }
    found
}

#[test]
fn the_house_reaches_the_renderer_through_one_door() {
    let sources = sources(&["crates/house/src"]);
    let past: Vec<_> = sources
        .iter()
        .flat_map(|(name, text)| past_the_door(text).into_iter().map(move |past| (name, past)))
        .collect();
    assert_eq!(past, []);
    assert!(sources.iter().any(|(_, text)| text.contains("kelir_render::job")), "the door has another name");
    // Controls: by a path, from a list, and from the middle of an expression.
    let text = "use kelir_render::pa::Knobs;\nuse kelir_render::{View, mc, job::run};\nlet a = kelir_render::gpu::open();";
    assert_eq!(past_the_door(text), ["pa", "mc", "gpu"]);
}

/// What draws, and the door to it.
const RENDERERS: [&str; 2] = ["crates/theatre/src/", "crates/render/src/"];
/// What of these may know techniques by name: their lists, the crates' faces, and what compares them.
const KNOW_TECHNIQUES: [&str; 8] =
    ["lib.rs", "techniques/mod.rs", "accuracy/", "bench.rs", "bench/", "numerics/", "kernels.rs", "twins.rs"];

/// Every technique that a file of the renderer knows and should not: a technique itself alone, what they share none. Tests compare freely.
fn known_techniques(file: &str, text: &str, techniques: &BTreeSet<String>) -> Vec<String> {
    if file.ends_with("tests.rs") || KNOW_TECHNIQUES.iter().any(|known| file.starts_with(known)) {
        return Vec::new();
    }
    let own = file.strip_prefix("techniques/").and_then(|rest| rest.split('/').next());
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
    let named = ["crate::", "super::", "techniques::", "kelir_theatre::"]
        .into_iter()
        .flat_map(|prefix| named_after(code, prefix));
    named
        .filter(|name| techniques.contains(name) && Some(name.as_str()) != own)
        .map(|name| format!("{file} names {name}"))
        .collect()
}

#[test]
fn techniques_do_not_know_each_other() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("root");
    let techniques: BTreeSet<String> = fs::read_dir(root.join(RENDERERS[0]).join("techniques"))
        .expect("techniques")
        .map(|entry| entry.expect("an entry"))
        .filter(|entry| entry.path().is_dir())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    assert!(techniques.len() >= 5, "{techniques:?}");
    let mut known = Vec::new();
    for crate_src in RENDERERS {
        let files = sources(&[crate_src.trim_end_matches('/')]);
        assert!(!files.is_empty(), "{crate_src}");
        known.extend(
            files
                .iter()
                .flat_map(|(path, text)| known_techniques(&path[crate_src.len()..], text, &techniques)),
        );
    }
    assert_eq!(known, Vec::<String>::new());

    // Negative control: a name in a list, one by way of the parent and one in full are seen; the technique itself and tests are not.
    let text = "use crate::{View, gpu::{Gpu, Output}, mc};\nuse super::super::oracle;\nlet a = crate::pa::plan();\n\
                let b = kelir_theatre::points::one();\n#[cfg(test)]\nmod tests {\n    use crate::pcss;\n}";
    let seen = |file: &str| known_techniques(file, text, &techniques).len();
    assert_eq!(known_techniques("techniques/points/mod.rs", text, &techniques).len(), 3);
    assert_eq!([seen("techniques/pa/plan.rs"), seen("trace/mod.rs"), seen("kernels.rs")], [3, 4, 0]);
    assert_eq!(known_techniques("techniques/points/tests.rs", text, &techniques), Vec::<String>::new());
}

#[test]
fn commands_that_answer_no_requests_need_no_server() {
    let sources = sources(&["crates/cli/src"]);
    let named: Vec<&str> =
        sources.iter().filter(|(_, text)| text.contains("kelir_server")).map(|(name, _)| &**name).collect();
    let may = |name: &&str| {
        *name == "crates/cli/src/commands/serve.rs" || name.starts_with("crates/cli/src/commands/bench/")
    };
    assert!(named.iter().all(may), "{named:?}");
    assert!(named.contains(&"crates/cli/src/commands/serve.rs"), "the server has another name: {named:?}");
}

/// Where a kind of trial may be named outside its own folders: what wrote and reads the first layout knew one kind.
const OF_THE_FIRST_LAYOUT: [&str; 2] = ["crates/store/src/first_chain.rs", "crates/store/src/upgrade.rs"];

/// Files of these folders that name one of the kinds, as `file: name`. Tests may.
fn naming_kinds(kinds: &[String]) -> Vec<String> {
    let mut found = Vec::new();
    for (name, text) in sources(&["crates", "web/participant", "web/console", "web/shared"]) {
        let of_a_kind = name.starts_with("crates/study/src/trials/")
            || kinds.iter().any(|kind| name.contains(&format!("trials/{kind}/")));
        let of_tests = name.split('/').any(|part| part == "tests" || part == "tests.rs");
        if of_a_kind || of_tests || OF_THE_FIRST_LAYOUT.contains(&&*name) {
            continue;
        }
        let named = |kind: &String| {
            let variant: String = kind.split('-').map(|w| w[..1].to_uppercase() + &w[1..]).collect();
            text.contains(&format!("\"{kind}\"")) || text.contains(&variant)
        };
        found.extend(kinds.iter().filter(|k| named(k)).map(|kind| format!("{name}: {kind}")));
    }
    found
}

#[test]
fn a_kind_of_trial_is_a_variant_and_a_folder() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("root");
    let folders =
        fs::read_dir(root.join("web/participant/trials")).expect("kinds").map(|e| e.expect("entry").path());
    let kinds: Vec<String> = folders
        .filter(|folder| folder.join("index.ts").exists())
        .map(|folder| folder.file_name().expect("name").to_string_lossy().into_owned())
        .collect();
    assert!(kinds.len() > 1, "{kinds:?}");
    let list = fs::read_to_string(root.join("crates/study/src/trials/mod.rs")).expect("list");
    for kind in &kinds {
        assert!(list.contains(&format!("= \"{kind}\",")), "{kind} has a folder and no name");
    }
    assert_eq!(naming_kinds(&kinds), Vec::<String>::new());
    // Control: a word that many files have is found in them.
    assert!(!naming_kinds(&["studies".to_owned()]).is_empty());
}
