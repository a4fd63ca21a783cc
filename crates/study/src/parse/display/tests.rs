#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::definition::StudyDefinition;
use kelir_fixtures as fixtures;
use serde_json::json;

type Keys<'a> = &'a [(&'a str, &'a str)];

fn read_with(keys: Keys, files: &str) -> Result<StudyDefinition, String> {
    let conditions = format!("{{ pa = {{ technique = \"pa\" }}, photo = {{ files = {{ a = {files} }} }} }}");
    let keys = [keys, &[("conditions", &conditions)]].concat();
    let pair = [("conditions", "[\"pa\", \"photo\"]"), ("items", &fixtures::items(["a"], "a.toml"))];
    let mut text = fixtures::study(&keys, [fixtures::block("b", &pair)]);
    if keys.iter().all(|(key, _)| *key != "size") {
        // What the fixture says of it otherwise.
        text = text.replacen("size = [64, 36]\n", "", 1);
    }
    StudyDefinition::parse("s.toml", &text).map_err(|errors| errors.to_string())
}

fn study(keys: Keys) -> StudyDefinition {
    read_with(keys, "\"a.png\"").unwrap()
}

const SMALL: (&str, &str) = ("size", "[64, 36]");
const TWO: (&str, &str) = ("display", "{ sizes = [[592, 333], [1110, 624]] }");
const PICTURES: &str = "[\"a.png\", \"b.png\"]";

#[test]
fn sizes_are_one_or_several_and_the_smallest_is_the_studys() {
    let one = study(&[("size", "[592, 333]")]);
    assert_eq!((one.sizes(), one.fit()), (&[[592, 333]][..], Fit::Native));
    let two = read_with(&[TWO], PICTURES).unwrap();
    assert_eq!((two.size, two.sizes()), ([592, 333], &[[592, 333], [1110, 624]][..]));
    let both = read_with(&[("size", "[592, 333]"), TWO], PICTURES).unwrap();
    assert_eq!(both, two);
    assert_eq!(study(&[("size", "[1110, 624]")]).size, [1110, 624], "no width of a window's bounds it");
}

#[test]
fn the_edition_says_what_fills_the_room_unless_the_file_does() {
    let fit =
        |edition: &str, display: &str| study(&[SMALL, ("edition", edition), ("display", display)]).fit();
    assert_eq!((fit("1", "{}"), fit("2", "{}")), (Fit::Native, Fit::Integer));
    assert_eq!(fit("1", "{ fit = \"fill\" }"), Fit::Fill);
    assert_eq!(fit("2", "{ fit = \"native\" }"), Fit::Native);
}

#[test]
fn older_studies_keep_their_hashes_and_one_size_is_one_study_however_written() {
    let one = study(&[("size", "[592, 333]")]);
    let value: serde_json::Value = serde_json::from_str(&one.to_json()).unwrap();
    assert!(value.get("display").is_none(), "{value}");
    assert_eq!(value["conditions"]["photo"]["files"]["a"], "a.png");
    let listed = study(&[("display", "{ sizes = [[592, 333]] }")]);
    assert_eq!((listed.file_hash(), listed.design_hash()), (one.file_hash(), one.design_hash()));
    let two = read_with(&[TWO], PICTURES).unwrap();
    assert_ne!(two.design_hash(), one.design_hash());
    let read: StudyDefinition = serde_json::from_str(&two.to_json()).unwrap();
    assert_eq!((read.file_hash(), &read), (two.file_hash(), &two));
}

#[test]
fn what_is_no_list_of_sizes_is_refused_by_name() {
    let cases: [(Keys, &str); 12] = [
        (&[], "size: is missing"),
        (&[("size", "[4000, 333]")], "size = [4000, 333]"),
        (&[("display", "{ fit = \"native\" }")], "size: is missing"),
        (&[("display", "{ sizes = [] }")], "display.sizes = []"),
        (&[("display", "{ sizes = [[592, 333], [592, 333]] }")], "display.sizes"),
        (&[("display", "{ sizes = [[1110, 624], [592, 333]] }")], "display.sizes"),
        (&[("display", "{ sizes = [[592, 333], [1110, 626]] }")], "display.sizes"),
        (&[("display", "{ sizes = [[592, 333], [5920, 3330]] }")], "display.sizes"),
        (
            &[("size", "[600, 333]"), ("display", "{ sizes = [[592, 333]] }")],
            "size = [600, 333]: must be the first",
        ),
        (&[SMALL, ("display", "{ fit = \"stretch\" }")], "display.fit = \"stretch\""),
        (&[SMALL, ("display", "{ size = 1 }")], "display.size = 1: is not a known key"),
        (&[SMALL, ("display", "1")], "display = 1: a table is wanted here, not a number"),
    ];
    for (keys, field) in cases {
        let error = read_with(keys, "\"a.png\"").unwrap_err();
        assert!(error.contains(field), "{keys:?}: {error}");
    }
    // To within a pixel they are of one aspect: rounding is no error.
    assert!(read_with(&[("display", "{ sizes = [[592, 333], [1110, 625]] }")], PICTURES).is_ok());
}

#[test]
fn each_size_needs_its_picture_file() {
    let error = read_with(&[TWO], "\"a.png\"").unwrap_err();
    assert!(
        error.contains("conditions.photo.files.a") && error.contains("1 picture for the study's 2 sizes"),
        "{error}"
    );
    let error = read_with(&[SMALL], PICTURES).unwrap_err();
    assert!(error.contains("2 pictures for the study's 1 size"), "{error}");
    assert!(read_with(&[TWO], "[\"a.png\", 7]").unwrap_err().contains("must be a .png"));
    let read = read_with(&[TWO], "[\"a.png\", \"b.jpg\"]").unwrap();
    let value = serde_json::to_value(&read.conditions["photo"]).unwrap();
    assert_eq!(value["files"], json!({ "a": ["a.png", "b.jpg"] }));
    assert_eq!(
        study(&[("display", "{ sizes = [[64, 36]] }")]).conditions,
        read_with(&[SMALL], "[\"a.png\"]").unwrap().conditions
    );
}

#[test]
fn the_choice_is_told_in_words() {
    let two = read_with(&[("edition", "2"), TWO], PICTURES).unwrap();
    let said = two.display_in_words();
    assert!(said.contains("592 × 333 or 1110 × 624 pixels, natively at each"), "{said}");
    assert!(said.contains("the largest of these that fits") && said.contains("whole multiple"), "{said}");
    assert!(study(&[SMALL]).display_in_words().contains("never enlarged"));
    assert!(study(&[SMALL, ("display", "{ fit = \"fill\" }")]).display_in_words().contains("resampled"));
}
