#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet};

worded! {
    /// How an answer was given.
    pub(super) enum Input {
        /// A click.
        Mouse = "mouse",
        /// A finger on the screen.
        Touch = "touch",
    }
}

/// A name.
#[derive(Serialize, Deserialize, ToSchema, PartialEq, Eq, PartialOrd, Ord)]
#[schema(max_length = 4)]
struct Name(String);

/// Where a window is.
#[derive(Serialize, Deserialize, ToSchema)]
struct Window {
    /// Its width.
    #[schema(minimum = 0, extensions(("x-unit" = json!("px"))))]
    width: f64,
}

#[derive(Serialize, Deserialize, ToSchema)]
struct Common {
    /// Response time.
    #[schema(minimum = 0, maximum = 86_400_000, extensions(("x-unit" = json!("ms"))))]
    rt: f64,
    /// How it was answered.
    input: Option<Input>,
}

#[derive(Serialize, Deserialize, ToSchema)]
struct Answer {
    #[serde(flatten)]
    common: Common,
    /// Which it was.
    choice: Choice,
    /// The window.
    window: Option<Window>,
    /// Width and height.
    #[schema(min_items = 2, max_items = 2, value_type = Option<Vec<f64>>)]
    size: Option<[f64; 2]>,
    /// How often.
    #[schema(maximum = 9)]
    count: Option<u32>,
    /// Anything by name.
    #[serde(default)]
    notes: BTreeMap<Name, String>,
}

#[derive(Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
enum Choice {
    Left,
    Right,
}

#[derive(Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Strict {
    #[schema(max_length = 3, write_only, format = Password)]
    word: Option<String>,
}

fn told(record: &Record, value: Value) -> Vec<(String, Option<Value>, String)> {
    record.check(&value).into_iter().map(|error| (error.pointer, error.value, error.rule)).collect()
}

#[test]
fn every_breach_is_told_with_its_place_its_value_and_its_rule() {
    let record = Record::of::<Answer>();
    assert_eq!(record.unsupported(), Vec::<String>::new());
    let right = json!({
        "rt": 0, "choice": "left", "input": "touch", "window": { "width": 1.5 }, "size": [1, 2], "count": 9, "notes": { "a/b": "x" },
        "other": [1],
    });
    assert_eq!(told(&record, right), []);
    assert_eq!(
        told(
            &record,
            json!({ "rt": 1, "choice": "right", "input": null, "window": null, "size": null, "count": null })
        ),
        []
    );
    let wrong = json!({
        "rt": -1, "choice": "middle", "input": "pen", "window": { "width": "wide" }, "size": [1, "2", 3], "count": 1.5,
        "notes": { "a/~long": 1 },
    });
    let expected = [
        ("/rt", json!(-1), "must be a number from 0 to 86400000"),
        ("/input", json!("pen"), "must be \"mouse\" or \"touch\""),
        ("/choice", json!("middle"), "must be \"left\" or \"right\""),
        ("/count", json!(1.5), "must be a whole number from 0 to 9 or null"),
        ("/notes/a~1~0long", json!(1), "has a name that must be a text of at most 4 characters"),
        ("/notes/a~1~0long", json!(1), "must be a text"),
        ("/size", json!([1, "2", 3]), "must be a list of 2 items or null"),
        ("/window/width", json!("wide"), "must be a number from 0"),
    ];
    let mut found = told(&record, wrong);
    found.sort_by(|a, b| (&a.0, &a.2).cmp(&(&b.0, &b.2)));
    let mut expected: Vec<_> =
        expected.map(|(pointer, value, rule)| (pointer.to_owned(), Some(value), rule.to_owned())).into();
    expected.sort_by(|a, b| (&a.0, &a.2).cmp(&(&b.0, &b.2)));
    assert_eq!(found, expected);
    let missing = told(&record, json!({}));
    let missing: Vec<_> =
        missing.iter().map(|(pointer, value, rule)| (pointer.as_str(), value, rule.as_str())).collect();
    assert_eq!(
        missing,
        [
            ("/rt", &None, "must be given: a number from 0 to 86400000"),
            ("/choice", &None, "must be given: \"left\" or \"right\"")
        ]
    );
    assert_eq!(told(&record, json!([1]))[0].2, "must be an object");
}

#[test]
fn unknown_keys_are_told_where_a_record_is_closed_and_secrets_are_kept() {
    let record = Record::of::<Strict>();
    assert_eq!(
        told(&record, json!({ "word": "long", "a/b": 1 })),
        [
            ("/a~1b".to_owned(), Some(json!(1)), "is not known here; known are word".to_owned()),
            ("/word".to_owned(), None, "must be a text of at most 3 characters or null".to_owned()),
        ]
    );
}

#[test]
fn what_an_error_shows_is_short() {
    let long = words::shortened(&json!("ä".repeat(101)));
    assert_eq!(long.as_str().unwrap().chars().count(), 101);
    assert_eq!(words::shortened(&json!([1, 2])), json!([1, 2]));
    assert_eq!(words::shortened(&json!(vec![1; 999])), "a list of 999 items");
}

#[test]
fn a_codebook_has_the_fields_with_their_units_meanings_and_values() {
    let columns = Record::of::<Answer>().columns();
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, ["choice", "count", "input", "notes", "rt", "size", "window.width"]);
    let column = |name: &str| columns.iter().find(|column| column.name == name).unwrap();
    let said = |name: &str| {
        let Column { kind, unit, meaning, .. } = column(name);
        [kind.as_str(), unit.as_str(), meaning.as_str()]
    };
    assert_eq!(said("rt"), ["number", "ms", "Response time."]);
    assert_eq!(said("window.width"), ["number", "px", "The window. Its width."]);
    assert_eq!(said("count"), ["integer", "", "How often."]);
    assert_eq!(said("size"), ["list", "", "Width and height."]);
    assert_eq!(said("notes"), ["object", "", "Anything by name."]);
    assert_eq!(said("input"), ["text", "", "How it was answered."]);
    let meaning =
        |value: &str, meaning: &str| Meaning { value: value.to_owned(), meaning: meaning.to_owned() };
    assert_eq!(
        column("input").values,
        [meaning("mouse", "A click."), meaning("touch", "A finger on the screen.")]
    );
    assert_eq!(column("choice").values, [meaning("left", ""), meaning("right", "")]);
}

#[test]
fn a_worded_enum_is_its_texts() {
    assert_eq!(serde_json::to_value(Input::Touch).unwrap(), "touch");
    assert_eq!(serde_json::from_value::<Input>(json!("mouse")).unwrap(), Input::Mouse);
    assert_eq!((Input::Mouse.as_str(), Input::Mouse.meaning(), Input::ALL.len()), ("mouse", "A click.", 2));
}

/// One schema and what jsonschema 4 (`tests/data/schema.py`) finds wrong with many values of it.
#[derive(Deserialize)]
struct Case {
    schema: Value,
    #[serde(default)]
    components: Map<String, Value>,
    /// Values, each with the pointers at which something is wrong.
    values: Vec<(Value, BTreeSet<String>)>,
}

#[test]
fn a_second_opinion_finds_the_same_places() {
    let cases: Vec<Case> = serde_json::from_str(include_str!("../../tests/data/schema.json")).unwrap();
    let (mut right, mut wrong) = (0, 0);
    for Case { schema, components, values } in cases {
        let record = Record::of_json(schema, components);
        assert_eq!(record.unsupported(), Vec::<String>::new(), "{}", record.schema);
        for (value, places) in values {
            let found: BTreeSet<String> =
                record.check(&value).into_iter().map(|error| error.pointer).collect();
            assert_eq!(found, places, "{value} by {}", record.schema);
            *(if found.is_empty() { &mut right } else { &mut wrong }) += 1;
        }
    }
    // Both verdicts are common, so a walker that always says one of them fails.
    assert!(right > 500 && wrong > 500, "{right} right, {wrong} wrong");
}
