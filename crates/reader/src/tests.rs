#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use crate::{Place, Problem, Problems, Reading, did_you_mean, list, shorten};

/// Reads `title` (needed), `level` and `items` of `{ t = … }`; every problem.
fn problems(text: &str) -> Vec<Problem> {
    let reading = Reading::default();
    reading.source("f.toml", text).read(|root| {
        let mut fields = root.table()?;
        fields.need("title", "what it is called", |n| n.string());
        fields.may("level", "a number from 0 to 1", |n| n.as_number().filter(|x| (0.0..=1.0).contains(x)));
        fields.optional("items", "tables", Vec::new(), |n| {
            let read = n.array(3)?.into_iter().map(|item| {
                let mut fields = item.table()?;
                let t = fields.need("t", "a time", |n| n.number_in(0.0.., "a time is from 0"));
                fields.done();
                t
            });
            Some(read.collect())
        });
        fields.done();
        Some(())
    });
    reading.into_problems()
}

fn told(text: &str) -> Vec<String> {
    problems(text).iter().map(Problem::to_string).collect()
}

#[test]
fn every_problem_is_named_by_place_field_value_and_rule() {
    let text =
        "# ä\ntitel = \"x\"\nlevel = 2.50  # ü\nitems = [{ t = 1 }, { \"größe\" = 1, t =\n -1 }, {}]\n";
    assert_eq!(
        told(text),
        [
            "f.toml: title: is missing: what it is called",
            "f.toml:3:9: level = 2.50: must be a number from 0 to 1",
            "f.toml:5:2: items[1].t = -1: a time is from 0",
            "f.toml:4:33: items[1].\"größe\" = 1: is not a known key; known are t",
            "f.toml:5:8: items[2].t: is missing: a time",
            "f.toml:2:9: titel = \"x\": is not a known key (did you mean title?); known are title, level and items",
        ]
    );
    assert_eq!(told("title = \"x\"\nlevel = 0.5\nitems = [{ t = 0 }]"), Vec::<String>::new());
}

#[test]
fn every_error_of_the_text_has_its_place() {
    let found = problems("title == 1\nlevel = 0,5\n");
    let places: Vec<_> = found.iter().map(|p| p.place.unwrap().line).collect();
    assert!(places.contains(&1) && places.contains(&2), "{found:?}");
    assert!(found.iter().all(|p| p.rule.starts_with("is no TOML: ")), "{found:?}");
    // The place is the field, and is said once.
    let first = &found[0];
    assert_eq!(first.field, format!("line 1, column {}", first.place.unwrap().column));
    assert!(!first.to_string().contains("line"), "{first}");
}

#[test]
fn a_problem_is_one_line_and_survives_its_json() {
    let [problem] = &problems("title = \"a\"\nlevel = \"\"\"x\n\ty\"\"\"")[..] else { panic!("one problem") };
    assert!(!problem.to_string().contains(char::is_control), "{problem}");
    let json = serde_json::to_value(problem).unwrap();
    assert_eq!(json["place"], serde_json::json!({ "line": 2, "column": 9 }));
    assert_eq!(serde_json::from_value::<Problem>(json).unwrap(), *problem);
    // What has no text at hand has no place; programs find the key all the same.
    let json = serde_json::to_value(Problem::new("f", "g", None, "r")).unwrap();
    assert_eq!(
        json,
        serde_json::json!({ "file": "f", "field": "g", "value": null, "rule": "r", "place": null })
    );
}

#[test]
fn a_reading_ends_with_what_was_read_or_with_why_not() {
    let end = |text: &str| -> Result<(), Problems> {
        let reading = Reading::default();
        // Read all the same: a problem alone refuses it.
        let read = reading.source("f", text).read(|root| {
            root.get("a")?.integer();
            Some(())
        });
        reading.end(read)
    };
    assert_eq!(end("a = 1"), Ok(()));
    assert_eq!(end("a = 1.5").unwrap_err().len(), 1);
    assert_eq!(end("a = ").unwrap_err()[0].place, Some(Place { line: 1, column: 5 }));
}

#[test]
fn what_is_asked_for_is_noted_once_and_in_order() {
    let reading = Reading::noting();
    reading.source("f", "b = [{ c = 1 }, { c = 2 }]").read(|root| {
        let mut fields = root.table()?;
        fields.given("z", "first | said");
        fields.given("z", "said again");
        fields.need("b", "a list", |n| {
            n.array(9)?.iter().for_each(|item| {
                let mut fields = item.table().unwrap();
                fields.need("c", "a count", |n| n.integer_in(0.., "is from 0"));
                fields.done();
            });
            Some(())
        });
        fields.done();
        Some(())
    });
    assert_eq!(
        reading.asked().rows(),
        "| `z` |  | first \\| said |\n| `b` | yes | a list |\n| `b[].c` | yes | a count (is from 0) |"
    );
    assert!(Reading::default().asked().keys.is_empty());
}

#[test]
fn columns_count_characters_however_long_a_line_is() {
    let keys: Vec<String> = (0..10_000).map(|i| format!("\"ä{i}\" = 1")).collect();
    let text = format!("title = \"x\"\nitems = [{{ t = 0, {} }}]", keys.join(", "));
    let found = problems(&text);
    assert_eq!(found.len(), 10_000);
    let last = found.iter().map(|p| p.place.unwrap().column).max().unwrap();
    assert_eq!(last, text.lines().last().unwrap().chars().count() - 3);
}

#[test]
fn words_of_messages() {
    let known = ["width_m", "height_m"];
    assert_eq!(did_you_mean("widht_m", &known), " (did you mean width_m?)");
    assert_eq!(did_you_mean("colour", &known), "");
    assert_eq!(list(&known), "width_m and height_m");
    assert_eq!(list::<&str>(&[]), "none");
    assert_eq!(shorten(" a\n\t b "), Some("a b".to_owned()));
    assert_eq!(shorten(&"x".repeat(90)), Some(format!("{}…", "x".repeat(80))));
    assert_eq!(shorten(" \n"), None);
}

#[test]
fn a_document_is_written_back_with_the_values_it_was_read_with() {
    let written = |text: &str| {
        let reading = Reading::default();
        let both = reading.source("f", text).read(|root| Some((root.to_toml(), root.canonical())));
        reading.end(both).unwrap_or_else(|problems| panic!("{problems}\n{text}"))
    };
    let text = r#"
# a comment
day = 1979-05-27
big = 0x10
tiny = 1e-320
minus = -0.0
none = []
mixed = [1, [2, { a = 'b' }], "c\n\"d\" \u00e4"]
"a.b" = """
two
lines"""
inline = { b = 1, a.c = 2 }
[outer]
[outer.inner.deep]
x = 1
[[list]]
[[list.items]]
t = 1
[[list.items.deeper]]
u = 2
[[list]]
name = "it's"
"#;
    let (toml, canonical) = written(text);
    assert_eq!(written(&toml), (toml.clone(), canonical.clone()), "{toml}");
    assert!(toml.contains("tiny = 1e-320\n") && toml.contains("big = 0x10\n"), "as written: {toml}");
    assert!(toml.contains("[[list.items]]\ndeeper = [{ u = 2 }]\nt = 1\n"), "{toml}");
    // Negative control: each other value is another document.
    for (from, to) in [("t = 1", "t = 2"), ("two", "too"), ("[]", "[0]")] {
        assert!(text.contains(from), "{from}");
        assert_ne!(written(&text.replacen(from, to, 1)).1, canonical, "{from} → {to}");
    }
}
