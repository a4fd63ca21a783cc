//! The document as JSON, which the researcher's pages lay out: what it says is what the other forms say.

use crate::fixture::{Study, hostile, levels, paper, triangle};
use kelir_report::{Document, Piece, Row, StudyReport, html, text};
use kelir_stats::paper::taylor_cameron;
use serde_json::Value;

/// A report with every section and every kind of piece.
fn whole() -> StudyReport {
    let mut study = paper([[12, 14, 6], [3, 10, 19], [26, 7, 0]]);
    study.screening = "min_rt_ms = 200".to_owned();
    study.people.push(vec![("still-a", "pa", 50.0), ("still-b", "pa", 50.0), ("loop-a", "pa", 50.0)]);
    StudyReport { paper: taylor_cameron().ok(), ..study.report() }
}

/// What somebody reads of a document's JSON: headings, sentences, cells and captions, of all sections or of the terminal's.
fn read(json: &Value, all: bool) -> Vec<&str> {
    let sections = json["sections"].as_array().unwrap().iter();
    let mut found = vec![json["title"].as_str().unwrap(), json["subtitle"].as_str().unwrap()];
    for section in sections.filter(|section| all || section["reference"] == false) {
        found.extend(section["title"].as_str());
        for piece in section["pieces"].as_array().unwrap() {
            let content = &piece["content"];
            match piece["kind"].as_str().unwrap() {
                "heading" | "text" | "warning" => found.extend(content.as_str()),
                "list" => found.extend(content.as_array().unwrap().iter().filter_map(Value::as_str)),
                "figure" if all => found.extend(content["caption"].as_str()),
                "figure" => {}
                "table" => {
                    found.extend(content["caption"].as_str());
                    found.extend(
                        content["columns"].as_array().unwrap().iter().filter_map(|c| c["name"].as_str()),
                    );
                    for row in content["rows"].as_array().unwrap() {
                        match &row["content"] {
                            Value::String(group) => found.push(group),
                            cells => {
                                found.extend(
                                    cells.as_array().unwrap().iter().filter_map(|c| c["shown"].as_str()),
                                );
                            }
                        }
                    }
                }
                other => panic!("a piece of kind {other}"),
            }
        }
    }
    found
}

/// Only letters, digits and signs: lines are broken, escaped and padded in each form's own way.
fn bare(text: &str) -> String {
    let text = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&#39;", "'"), ("&amp;", "&")]
        .iter()
        .fold(text.to_owned(), |text, (from, to)| text.replace(from, to));
    text.chars().filter(|c| !c.is_whitespace() && !c.is_control() && *c != '\u{fffd}').collect()
}

/// What of these texts a form doesn't say.
fn missing<'a>(texts: &[&'a str], form: &str) -> Vec<&'a str> {
    let form = bare(form);
    texts.iter().filter(|text| !form.contains(&bare(text))).copied().collect()
}

#[test]
fn what_the_pages_lay_out_is_what_page_and_terminal_say() {
    for report in
        [whole(), levels().report(), triangle(6, 14).report(), hostile().report(), Study::default().report()]
    {
        let document = Document::of(&report);
        let json = serde_json::to_value(&document).unwrap();
        assert_eq!(missing(&read(&json, true), &html(&document)), [""; 0]);
        assert_eq!(missing(&cells(&json), &text(&document)), [""; 0]);
        let figures = document.figures().filter(|figure| html(&document).contains(&figure.svg)).count();
        assert_eq!(figures, json.to_string().matches("\"svg\":").count());
    }
    // Control: another t is missed, and so is a heading that only the page has.
    let document = Document::of(&whole());
    let mut json = serde_json::to_value(&document).unwrap();
    let changed: Value =
        serde_json::from_str(&json.to_string().replace("\"−1.4376\"", "\"−1.4377\"")).unwrap();
    // t stands there twice, the second time with the p that Holm corrects.
    assert_eq!(missing(&read(&changed, true), &html(&document)), ["−1.4377"; 2]);
    json["sections"][0]["title"] = "In long".into();
    assert_eq!(missing(&read(&json, true), &html(&document)), ["In long"]);
    assert!(missing(&read(&json, true), &text(&document)).contains(&"How to cite"));
}

/// The cells that the terminal shows too; long ones of words are broken there, so each word is looked for.
fn cells(json: &Value) -> Vec<&str> {
    read(json, false).into_iter().flat_map(str::split_whitespace).collect()
}

/// Cells of numbers that show a digit and hold no number.
fn inexact(document: &Document) -> Vec<String> {
    let tables =
        document.sections.iter().flat_map(|section| &section.pieces).filter_map(|piece| match piece {
            Piece::Table(table) => Some(table),
            _ => None,
        });
    let mut found = Vec::new();
    for table in tables {
        for row in &table.rows {
            let Row::Cells(cells) = row else { continue };
            assert_eq!(cells.len(), table.columns.len(), "{}", table.caption);
            for (cell, column) in cells.iter().zip(&table.columns) {
                let numbers = cell.exact.as_deref().unwrap_or_default();
                let exact = !numbers.is_empty() && numbers.split(' ').all(|x| x.parse::<f64>().is_ok());
                if column.numeric && cell.shown.contains(|c: char| c.is_ascii_digit()) && !exact {
                    found.push(format!("{}: {}", column.name, cell.shown));
                }
            }
        }
    }
    found
}

#[test]
fn every_number_of_a_table_carries_its_exact_value() {
    for report in [whole(), levels().report(), triangle(6, 14).report()] {
        assert_eq!(inexact(&Document::of(&report)), [""; 0]);
    }
    // Control: a rounded number alone is found.
    let mut document = Document::of(&whole());
    let cells = document.sections.iter_mut().flat_map(|s| &mut s.pieces).find_map(|piece| match piece {
        Piece::Table(table) => table.rows.iter_mut().find_map(|row| match row {
            Row::Cells(cells) => Some(cells),
            Row::Group(_) => None,
        }),
        _ => None,
    });
    cells.unwrap()[2].exact = None;
    assert_eq!(inexact(&document), ["n: 32"]);
}

/// A document that the pages' own tests lay out; `KELIR_BLESS=1` writes it anew.
#[test]
fn the_pages_are_tested_with_a_document_as_it_is() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../web/test/document.json");
    let Document { title, subtitle, sections } = Document::of(&whole());
    // A section a line, so that a change of one is seen as that.
    let lines: Vec<String> = sections.iter().map(|s| serde_json::to_string(s).unwrap()).collect();
    let [title, subtitle] = [title, subtitle].map(Value::String);
    let now =
        format!("{{\"title\":{title},\"subtitle\":{subtitle},\"sections\":[\n{}\n]}}\n", lines.join(",\n"));
    if std::env::var_os("KELIR_BLESS").is_some() {
        std::fs::write(path, &now).unwrap();
    }
    let stored = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        stored == now,
        "web/test/document.json is not what a report is now: KELIR_BLESS=1 cargo test --workspace --test it -- pages"
    );
}
