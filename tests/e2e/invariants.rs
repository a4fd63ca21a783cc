//! The rooms' walls: which crate may know which library, read from `cargo metadata`.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use serde_json::Value;

/// Crates that stay pure: no async runtime, database, web server or GPU anywhere below them.
const PURE: [&str; 6] =
    ["kelir-scene", "kelir-stats", "kelir-study", "kelir-vision", "kelir-plot", "kelir-report"];
const IMPURE: [&str; 5] = ["tokio", "sqlx", "rusqlite", "axum", "wgpu"];
/// Libraries that one room alone may name.
const OWNED: [(&str, &str); 4] = [
    ("wgpu", "kelir-render"),
    ("sqlx", "kelir-store"),
    ("rusqlite", "kelir-store"),
    ("axum", "kelir-server"),
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
        for (library, owner) in OWNED {
            if direct.contains(library) && name != owner {
                found.push(format!("{name} names {library}: only {owner} may"));
            }
        }
        if PURE.contains(&name) {
            let below = closure(member, &edges);
            for library in IMPURE {
                if below.iter().any(|id| names[id] == library) {
                    found.push(format!("{name} reaches {library}: it must stay pure"));
                }
            }
        }
    }
    for pure in PURE {
        if !members.iter().any(|id| names[id] == pure) {
            found.push(format!("{pure} is not a member: rename it here too"));
        }
    }
    found
}

fn packages(metadata: &Value) -> impl Iterator<Item = &Value> {
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

fn metadata() -> Value {
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
    let id_of = |name: &str| {
        let package = packages(&doctored).find(|p| p["name"] == name).expect("package");
        package["id"].as_str().expect("id").to_owned()
    };
    let (stats, axum) = (id_of("kelir-stats"), id_of("axum"));
    let edge =
        serde_json::json!({"name": "axum", "pkg": axum, "dep_kinds": [{"kind": null, "target": null}]});
    let nodes = doctored["resolve"]["nodes"].as_array_mut().expect("nodes");
    let node = nodes.iter_mut().find(|node| node["id"] == stats.as_str()).expect("node");
    node["deps"].as_array_mut().expect("deps").push(edge);
    let found = violations(&doctored);
    assert!(found.iter().any(|v| v == "kelir-stats names axum: only kelir-server may"), "{found:?}");
    assert!(found.iter().any(|v| v == "kelir-stats reaches axum: it must stay pure"), "{found:?}");
    // axum brings tokio, and study builds on stats: both are seen through the chain.
    assert!(found.iter().any(|v| v == "kelir-stats reaches tokio: it must stay pure"), "{found:?}");
}
