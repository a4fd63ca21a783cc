#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::definition::StudyDefinition;
use kelir_fixtures as fixtures;
use serde_json::json;

fn read_with(size: &str, files: &str) -> Result<StudyDefinition, String> {
    let photo = format!("[conditions.pa]\ntechnique = \"pa\"\n[conditions.photo]\nfiles = {{ a = {files} }}");
    let block = fixtures::block(
        "b",
        &format!("conditions = [\"pa\", \"photo\"]\n{}", fixtures::items(["a"], "a.toml")),
    );
    let mut text = fixtures::study(&format!("{size}\n{photo}"), [block]);
    if !size.lines().any(|line| line.starts_with("size")) {
        // What the fixture says of it otherwise.
        text = text.replacen("size = [64, 36]\n", "", 1);
    }
    StudyDefinition::parse("s.toml", &text).map_err(|errors| errors.to_string())
}

fn study(size: &str) -> StudyDefinition {
    read_with(size, "\"a.png\"").unwrap()
}

const TWO: &str = "[display]\nsizes = [[592, 333], [1110, 624]]";

#[test]
fn sizes_are_one_or_several_and_the_smallest_is_the_studys() {
    let one = study("size = [592, 333]");
    assert_eq!((one.sizes(), one.fit()), (&[[592, 333]][..], Fit::Native));
    let two = read_with(TWO, "[\"a.png\", \"b.png\"]").unwrap();
    assert_eq!((two.size, two.sizes()), ([592, 333], &[[592, 333], [1110, 624]][..]));
    let both = read_with(&format!("size = [592, 333]\n{TWO}"), "[\"a.png\", \"b.png\"]").unwrap();
    assert_eq!(both, two);
    assert_eq!(study("size = [1110, 624]").size, [1110, 624], "no width of a window's bounds it");
}

#[test]
fn the_edition_says_what_fills_the_room_unless_the_file_does() {
    let fit = |text: &str| study(&format!("size = [64, 36]\n{text}")).fit();
    assert_eq!((fit("edition = 1"), fit("edition = 2")), (Fit::Native, Fit::Integer));
    assert_eq!(fit("edition = 1\n[display]\nfit = \"fill\""), Fit::Fill);
    assert_eq!(fit("edition = 2\n[display]\nfit = \"native\""), Fit::Native);
}

#[test]
fn older_studies_keep_their_hashes_and_one_size_is_one_study_however_written() {
    let one = study("size = [592, 333]");
    let value: serde_json::Value = serde_json::from_str(&one.to_json()).unwrap();
    assert!(value.get("display").is_none(), "{value}");
    assert_eq!(value["conditions"]["photo"]["files"]["a"], "a.png");
    let listed = study("[display]\nsizes = [[592, 333]]");
    assert_eq!((listed.file_hash(), listed.design_hash()), (one.file_hash(), one.design_hash()));
    let two = read_with(TWO, "[\"a.png\", \"b.png\"]").unwrap();
    assert_ne!(two.design_hash(), one.design_hash());
    let read: StudyDefinition = serde_json::from_str(&two.to_json()).unwrap();
    assert_eq!((read.file_hash(), &read), (two.file_hash(), &two));
}

#[test]
fn what_is_no_list_of_sizes_is_refused_by_name() {
    for (size, field) in [
        ("", "size: is missing"),
        ("size = [4000, 333]", "size = [4000, 333]"),
        ("[display]\nfit = \"native\"", "size: is missing"),
        ("[display]\nsizes = []", "display.sizes = []"),
        ("[display]\nsizes = [[592, 333], [592, 333]]", "display.sizes"),
        ("[display]\nsizes = [[1110, 624], [592, 333]]", "display.sizes"),
        ("[display]\nsizes = [[592, 333], [1110, 626]]", "display.sizes"),
        ("[display]\nsizes = [[592, 333], [5920, 3330]]", "display.sizes"),
        ("size = [600, 333]\n[display]\nsizes = [[592, 333]]", "size = [600, 333]: must be the first"),
        ("size = [64, 36]\n[display]\nfit = \"stretch\"", "display.fit = \"stretch\""),
        ("size = [64, 36]\n[display]\nsize = 1", "display.size = 1: is not a known key"),
        ("size = [64, 36]\ndisplay = 1", "display = 1: a table is wanted here, not a number"),
    ] {
        let error = read_with(size, "\"a.png\"").unwrap_err();
        assert!(error.contains(field), "{size}: {error}");
    }
    // To within a pixel they are of one aspect: rounding is no error.
    assert!(read_with("[display]\nsizes = [[592, 333], [1110, 625]]", "[\"a.png\", \"b.png\"]").is_ok());
}

#[test]
fn each_size_needs_its_picture_file() {
    let error = read_with(TWO, "\"a.png\"").unwrap_err();
    assert!(
        error.contains("conditions.photo.files.a") && error.contains("1 picture for the study's 2 sizes"),
        "{error}"
    );
    let error = read_with("size = [64, 36]", "[\"a.png\", \"b.png\"]").unwrap_err();
    assert!(error.contains("2 pictures for the study's 1 size"), "{error}");
    assert!(read_with(TWO, "[\"a.png\", 7]").unwrap_err().contains("must be a .png"));
    let read = read_with(TWO, "[\"a.png\", \"b.jpg\"]").unwrap();
    let value = serde_json::to_value(&read.conditions["photo"]).unwrap();
    assert_eq!(value["files"], json!({ "a": ["a.png", "b.jpg"] }));
    assert_eq!(
        study("[display]\nsizes = [[64, 36]]").conditions,
        read_with("size = [64, 36]", "[\"a.png\"]").unwrap().conditions
    );
}

#[test]
fn the_choice_is_told_in_words() {
    let two = read_with(&format!("edition = 2\n{TWO}"), "[\"a.png\", \"b.png\"]").unwrap();
    let said = two.display_in_words();
    assert!(said.contains("592 × 333 or 1110 × 624 pixels, natively at each"), "{said}");
    assert!(said.contains("the largest of these that fits") && said.contains("whole multiple"), "{said}");
    assert!(study("size = [64, 36]").display_in_words().contains("never enlarged"));
    assert!(study("size = [64, 36]\n[display]\nfit = \"fill\"").display_in_words().contains("resampled"));
}
