//! The reference page of study files, made of what their parser asks for; the guide beside the studies names every key of it.
#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use crate::parse::read_into;
use crate::trials::TrialKind;
use kelir_reader::{Asked, Reading};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Has every table, so that every key of each is asked for; whether its values are right does not matter.
const SAMPLE: &str = r#"
[display]
[response]
[session]
[completion]
[screening]
[equivalence]
[primary]
test = "TEST"
[texts]
[translations.TAG]
texts = {}
[conditions.NAME]
technique = "pa"
camera = {}
[conditions.files]
files = {}
[[blocks]]
id = "stills"
title = "t"
kind = "still"
conditions = ["NAME", "files"]
target = "NAME"
items = [{ id = "a" }, { id = "b" }]
trial = "KIND"
trial_settings = {}
adaptive = { procedure = "staircase" }
psychometric = {}
[[blocks]]
items = [{}]
adaptive = { procedure = "quest-plus" }
"#;

/// What is asked for; `pairs` is what `items` used to be called, and `[conditions]` holds names.
fn asked() -> Asked {
    let reading = Reading::noting();
    for kind in TrialKind::all() {
        read_into(&reading, "sample.toml", &SAMPLE.replace("KIND", kind.name()));
    }
    for test in ["binomial", "scale"] {
        read_into(&reading, "sample.toml", &SAMPLE.replace("TEST", test));
    }
    let keys = reading.asked().keys.into_iter();
    let keys = keys.filter(|(path, _)| !path.contains("pairs") && path != "conditions.files");
    Asked {
        keys: keys.map(|(path, key)| (path.replace("conditions.files.", "conditions.NAME."), key)).collect(),
    }
}

fn page() -> String {
    format!(
        "# Study files\n\n\
         Made of what their parser asks for: `KELIR_BLESS=1 cargo test -p kelir-study reference` writes this page, and a test compares it.\n\
         `stimuli/studies/README.md` says what each key means; this page says what each may be. `[]` stands for every entry of a list. A key that\n\
         is not listed is refused, but for a technique's knobs under `conditions.NAME`. A key below a table is needed where its table is there.\n\n\
         | key | needed | must be |\n|---|---|---|\n{}\n",
        asked().rows()
    )
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn the_page_lists_every_key_that_the_parser_asks_for() {
    let page = page();
    let path = root().join("docs/reference/study-file.md");
    if std::env::var_os("KELIR_BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, &page).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&path).unwrap_or_default(), page, "KELIR_BLESS=1 writes it anew");
    for key in
        ["title", "blocks[].items[].level", "blocks[].adaptive.precise_enough", "conditions.NAME.camera"]
    {
        assert!(page.contains(&format!("| `{key}` |")), "{key}");
    }
}

/// The names in the first column of the guide's tables of keys, up to where it comes to designs.
fn explained(guide: &str) -> BTreeSet<String> {
    let part = guide.split("## How many participants").next().unwrap();
    let (mut names, mut of_keys) = (BTreeSet::new(), false);
    for line in part.lines() {
        let Some(row) = line.strip_prefix("| ") else {
            of_keys &= line.starts_with('|');
            continue;
        };
        let first = row.split(" | ").next().unwrap_or_default();
        of_keys |= first == "key";
        let quoted = first.split('`').skip(1).step_by(2).filter(|_| of_keys);
        names.extend(
            quoted
                .filter(|name| name.bytes().all(|b| b.is_ascii_lowercase() || b == b'_'))
                .map(str::to_owned),
        );
    }
    names
}

#[test]
fn the_guide_names_every_key_and_no_other() {
    let guide = std::fs::read_to_string(root().join("stimuli/studies/README.md")).unwrap();
    let keys: BTreeSet<String> = asked()
        .keys
        .keys()
        .map(|path| path.rsplit('.').next().unwrap().trim_end_matches("[]").to_owned())
        .collect();
    let missing: Vec<_> = keys
        .iter()
        .filter(|key| {
            !guide.contains(&format!("`{key}`"))
                && !guide.contains(&format!(".{key}]"))
                && !guide.contains(&format!("[{key}"))
        })
        .collect();
    assert!(missing.is_empty(), "the guide does not name {missing:?}");
    let unknown: Vec<_> = explained(&guide).into_iter().filter(|name| !keys.contains(name)).collect();
    assert!(unknown.is_empty(), "the guide explains {unknown:?}, which nothing asks for");
    // Negative control.
    assert!(explained("| key | meaning |\n|---|---|\n| `colour_of_ink` | what |").contains("colour_of_ink"));
}
