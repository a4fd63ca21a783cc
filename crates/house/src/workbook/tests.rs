#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
//! Read back by Python's own zip and XML readers: a reader that shares our code would share our mistakes.

use super::*;
use std::process::Command;

/// Prints each sheet as JSON: its name and its rows, a text as itself, a number as a number; a formula or a link fails.
const READER: &str = r#"
import json, sys, zipfile, xml.etree.ElementTree as ET
n = {"m": "http://schemas.openxmlformats.org/spreadsheetml/2006/main"}
z = zipfile.ZipFile(sys.argv[1])
texts = ["".join(t.text or "" for t in s.iter("{%s}t" % n["m"])) for s in ET.fromstring(z.read("xl/sharedStrings.xml"))]
names = [s.get("name") for s in ET.fromstring(z.read("xl/workbook.xml")).find("m:sheets", n)]
sheets = []
for i, name in enumerate(names, 1):
    xml = z.read(f"xl/worksheets/sheet{i}.xml").decode()
    assert "<f>" not in xml and "hyperlink" not in xml, xml
    rows = []
    for row in ET.fromstring(xml).find("m:sheetData", n):
        cells = {}
        for c in row:
            v = c.find("m:v", n)
            letters = "".join(x for x in c.get("r") if x.isalpha())
            if v is not None:
                cells[letters] = texts[int(v.text)] if c.get("t") == "s" else float(v.text)
        rows.append(cells)
    sheets.append([name, rows])
print(json.dumps(sheets))
"#;

fn read(file: &[u8]) -> serde_json::Value {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.xlsx");
    std::fs::write(&path, file).unwrap();
    let read = Command::new("python3").args(["-c", READER]).arg(&path).output().unwrap();
    assert!(read.status.success(), "{}", String::from_utf8_lossy(&read.stderr));
    serde_json::from_slice(&read.stdout).unwrap()
}

fn table(rows: &[[&str; 2]]) -> Table {
    let column = |name: &str, kind: &str| Column {
        name: name.to_owned(),
        kind: kind.to_owned(),
        unit: String::new(),
        meaning: "m".to_owned(),
        values: Vec::new(),
    };
    Table {
        name: "responses",
        columns: vec![column("subject_id", "text"), column("rt", "number")],
        rows: rows.iter().map(|row| row.map(str::to_owned).to_vec()).collect(),
    }
}

#[test]
fn numbers_are_numbers_and_texts_are_texts() {
    let rows = [
        ["007", "1275.595"],
        ["=1+1", "0.1"],
        ["https://example.org", "-0.30000000000000004"],
        ["1,5", ""],
        ["a\u{202e}b\nc", "1e-7"],
        ["مرحبا 👋🏽", "n/a"],
    ];
    let sheets = read(&workbook(&[table(&rows)]).unwrap());
    let expected = serde_json::json!([
        { "A": "subject_id", "B": "rt" },
        { "A": "007", "B": 1275.595 },
        { "A": "=1+1", "B": 0.1 },
        { "A": "https://example.org", "B": -0.30000000000000004 },
        { "A": "1,5" },
        { "A": "a⟨U+202E⟩b⟨U+000A⟩c", "B": 1e-7 },
        { "A": "مرحبا 👋🏽", "B": "n/a" },
    ]);
    assert_eq!(sheets[0], serde_json::json!(["responses", expected]));
    assert_eq!(sheets[1][0], "codebook");
    assert_eq!(sheets[1][1][2], serde_json::json!({ "A": "responses", "B": "rt", "C": "number", "E": "m" }));
}

#[test]
fn what_a_sheet_cannot_hold_goes_on_in_the_next() {
    let rows: Vec<[String; 2]> = (0..7).map(|i| [format!("s{i}"), i.to_string()]).collect();
    let rows: Vec<[&str; 2]> = rows.iter().map(|row| [row[0].as_str(), row[1].as_str()]).collect();
    let sheets = read(&with_most_rows(&[table(&rows)], 4).unwrap());
    let names: Vec<&str> =
        sheets.as_array().unwrap().iter().map(|sheet| sheet[0].as_str().unwrap()).collect();
    assert_eq!(&names[..3], ["responses", "responses 2", "responses 3"]);
    let numbers: Vec<f64> = (0..3)
        .flat_map(|i| sheets[i][1].as_array().unwrap().iter().skip(1).map(|row| row["B"].as_f64().unwrap()))
        .collect();
    assert_eq!(numbers, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(sheets[2][1][0]["A"], "subject_id", "each sheet has the header");
}

#[test]
fn nothing_is_too_long_and_no_rows_are_a_sheet_too() {
    let long = "x".repeat(40_000);
    let sheets = read(&workbook(&[table(&[[&long, "1"]])]).unwrap());
    let shown = sheets[0][1][1]["A"].as_str().unwrap();
    assert_eq!((shown.chars().count(), shown.chars().last()), (32_767, Some('…')));
    assert_eq!(read(&workbook(&[table(&[])]).unwrap())[0][1].as_array().unwrap().len(), 1);
    let same = || workbook(&[table(&[["a", "1"]])]).unwrap();
    assert_eq!(same(), same());
}
