//! What may be built in: licences, sources and versions as `deny.toml` has them, for every package of this machine's build.

use std::fs;
use std::path::Path;

use serde_json::Value;
use spdx::{Expression, Licensee, ParseMode};

use crate::invariants::{metadata, packages};

const CRATES_IO: &str = "registry+https://github.com/rust-lang/crates.io-index";

/// What `deny.toml` allows.
struct Policy {
    licences: Vec<Licensee>,
}

fn policy() -> Policy {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../deny.toml");
    let text = fs::read_to_string(file).expect("deny.toml");
    let table: toml::Table = text.parse().expect("TOML");
    // The rules that are kept below are those of the file.
    assert_eq!(table["bans"]["wildcards"].as_str(), Some("deny"));
    assert_eq!(table["sources"]["unknown-registry"].as_str(), Some("deny"));
    assert_eq!(table["sources"]["unknown-git"].as_str(), Some("deny"));
    let allowed = table["licenses"]["allow"].as_array().expect("licenses.allow");
    let licensee = |name: &toml::Value| {
        Licensee::parse(name.as_str().expect("a name")).unwrap_or_else(|error| panic!("{name}: {error}"))
    };
    Policy { licences: allowed.iter().map(licensee).collect() }
}

/// Every package that may not be built in, as a sentence.
fn refused(metadata: &Value, policy: &Policy) -> Vec<String> {
    let mut found = Vec::new();
    for package in packages(metadata) {
        let name = package["name"].as_str().expect("name");
        if let Some(source) = package["source"].as_str()
            && source != CRATES_IO
        {
            found.push(format!("{name} comes from {source}"));
        }
        let licence = package["license"].as_str().unwrap_or("no licence");
        let allowed = Expression::parse_mode(licence, ParseMode::LAX)
            .is_ok_and(|any| any.evaluate(|one| policy.licences.iter().any(|ours| ours.satisfies(one))));
        if !allowed {
            found.push(format!("{name}: {licence}"));
        }
        for dependency in package["dependencies"].as_array().expect("dependencies") {
            // What lies in the repository has no version to name.
            if package["source"].is_null() && dependency["path"].is_null() && dependency["req"] == "*" {
                let of = dependency["name"].as_str().expect("name");
                found.push(format!("{name} takes any version of {of}"));
            }
        }
    }
    found
}

#[test]
fn every_package_is_one_that_may_be_built_in() {
    assert_eq!(refused(&metadata(), &policy()), Vec::<String>::new());
}

#[test]
fn a_package_that_may_not_is_seen() {
    let mut doctored = metadata();
    let package = |name: &str, source: Option<&str>, licence: Option<&str>, req: &str| {
        let wanted = serde_json::json!([{ "name": "serde", "req": req, "path": null }]);
        serde_json::json!({ "name": name, "source": source, "license": licence, "dependencies": wanted })
    };
    let git = "git+https://example.org/a.git";
    let more = [
        package("copyleft", Some(CRATES_IO), Some("GPL-3.0-only"), "^1"),
        // One of both would do, but both are asked for.
        package("half", Some(CRATES_IO), Some("MIT AND AGPL-3.0-only"), "^1"),
        package("silent", Some(CRATES_IO), None, "^1"),
        package("elsewhere", Some(git), Some("MIT"), "^1"),
        package("anything", None, Some("MIT"), "*"),
        package("fine", Some(CRATES_IO), Some("GPL-3.0-only OR MIT/Apache-2.0"), "*"),
    ];
    doctored["packages"].as_array_mut().expect("packages").extend(more);
    let expected = [
        "copyleft: GPL-3.0-only",
        "half: MIT AND AGPL-3.0-only",
        "silent: no licence",
        &format!("elsewhere comes from {git}"),
        "anything takes any version of serde",
    ];
    assert_eq!(refused(&doctored, &policy()), expected);
}
