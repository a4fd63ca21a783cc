//! `[conditions.NAME]`: how pictures come to be.

use super::relative;
use crate::definition::{Block, Condition, Kind, Pictures};
use crate::fields::{Fields, Gatherer, IDENTIFIER, identifier, text};
use serde_json::Value as Json;
use std::collections::BTreeMap;
use toml::{Table, Value};

/// The study's conditions; what is wrong with them, and with the items that need them, has been reported.
pub(super) fn read(
    gatherer: &Gatherer<'_>,
    fields: &mut Fields<'_>,
    blocks: &[Block],
    sizes: Option<usize>,
) -> BTreeMap<String, Condition> {
    let mut conditions = BTreeMap::new();
    let value = fields.need("conditions", "a table of conditions", Some);
    let Some(table) = value
        .and_then(|v| Fields::of(gatherer, "conditions".to_owned(), v).map(|_| v))
        .and_then(Value::as_table)
    else {
        return conditions;
    };
    for (name, value) in table {
        let path = format!("conditions.{name}");
        if !identifier(name) {
            gatherer.report(&path, None, format!("a condition's name must be {IDENTIFIER}"));
        }
        if !blocks.iter().any(|b| b.conditions.contains(name)) {
            gatherer.report(&path, None, "no block uses this condition");
        }
        if let Some(condition) = read_condition(gatherer, &path, value, (name, blocks, sizes)) {
            conditions.insert(name.clone(), condition);
        }
    }
    for (i, block) in blocks.iter().enumerate() {
        for (j, name) in block.conditions.iter().enumerate() {
            if !table.contains_key(name) {
                let field = format!("blocks[{i}].conditions[{j}]");
                gatherer.report(
                    &field,
                    Some(&Value::String(name.clone())),
                    "must be defined under [conditions]",
                );
            }
            if let Some(Condition::Rendered { .. }) = conditions.get(name) {
                for (k, _) in block.items.iter().enumerate().filter(|(_, pair)| pair.scene.is_none()) {
                    let rule = format!("missing; condition {name} is drawn from it");
                    gatherer.report(&format!("blocks[{i}].{}[{k}].scene", block.items_key), None, rule);
                }
            }
        }
    }
    conditions
}

fn read_condition(
    gatherer: &Gatherer<'_>,
    path: &str,
    value: &Value,
    (name, blocks, sizes): (&str, &[Block], Option<usize>),
) -> Option<Condition> {
    let mut fields = Fields::of(gatherer, path.to_owned(), value)?;
    let mut users = blocks.iter().filter(|b| b.conditions.iter().any(|c| c == name));
    if let Some(files) = fields.raw("files") {
        if users.any(|b| b.kind == Kind::Animation) {
            fields.report("files", None, "a picture file cannot be an animation; use a technique");
        }
        let files = read_files(gatherer, &fields.path_of("files"), files, (name, blocks, sizes));
        fields.finish();
        return Some(Condition::Files { files: files? });
    }
    let technique =
        fields.need("technique", "a technique's name (or give files = { pair = \"picture\" })", |v| {
            v.as_str().filter(|s| identifier(s)).map(str::to_owned)
        });
    let camera = match fields.raw("camera") {
        None => Some(None),
        Some(value) => {
            if users.any(|b| b.kind == Kind::Animation) {
                fields.report(
                    "camera",
                    None,
                    "a simulated photograph is a still; this block shows animations",
                );
            }
            value
                .as_table()
                .map(|t| read_knobs(gatherer, &fields.path_of("camera"), t, &[]))
                .map(Some)
                .or_else(|| {
                    fields.report("camera", Some(value), "must be a table of camera settings");
                    None
                })
        }
    };
    let knobs = value.as_table().map(|t| read_knobs(gatherer, path, t, &["technique", "camera"]));
    Some(Condition::Rendered { technique: technique?, knobs: knobs?, camera: camera? })
}

/// Settings that the renderer reads itself: numbers, texts, booleans and lists of them.
fn read_knobs(gatherer: &Gatherer<'_>, path: &str, table: &Table, skip: &[&str]) -> BTreeMap<String, Json> {
    fn scalar(value: &Value) -> Option<Json> {
        match value {
            Value::String(s) => Some(Json::from(s.as_str())),
            Value::Integer(i) => Some(Json::from(*i)),
            Value::Float(x) => serde_json::Number::from_f64(*x).map(Json::Number),
            Value::Boolean(b) => Some(Json::from(*b)),
            Value::Array(items) => items.iter().map(scalar).collect::<Option<Vec<_>>>().map(Json::Array),
            _ => None,
        }
    }
    let mut knobs = BTreeMap::new();
    for (key, value) in table.iter().filter(|(key, _)| !skip.contains(&key.as_str())) {
        match scalar(value) {
            Some(json) => {
                knobs.insert(key.clone(), json);
            }
            None => gatherer.report(
                &format!("{path}.{key}"),
                Some(value),
                "must be a finite number, a text, true or false, or a list of these",
            ),
        }
    }
    knobs
}

fn read_files(
    gatherer: &Gatherer<'_>,
    path: &str,
    value: &Value,
    (name, blocks, sizes): (&str, &[Block], Option<usize>),
) -> Option<BTreeMap<String, Pictures>> {
    let Some(table) = value.as_table() else {
        gatherer.report(path, Some(value), "must be a table of pair id = picture file");
        return None;
    };
    let users = || blocks.iter().filter(|b| b.conditions.iter().any(|c| c == name));
    let mut files = BTreeMap::new();
    for (pair, value) in table {
        let field = format!("{path}.{pair}");
        if !users().any(|b| b.items.iter().any(|p| p.id == *pair)) {
            gatherer.report(&field, Some(value), "no block with this condition has a pair of this id");
        }
        match pictures(value, sizes) {
            Ok(paths) => {
                files.insert(pair.clone(), paths);
            }
            Err(rule) => gatherer.report(&field, Some(value), rule),
        }
    }
    for pair in users().flat_map(|b| &b.items).filter(|p| !table.contains_key(&p.id)) {
        gatherer.report(&format!("{path}.{}", pair.id), None, "missing; every pair needs its picture");
    }
    Some(files)
}

/// The picture files of one item, one for each of `sizes` where that is known; or the rule that the value breaks.
fn pictures(value: &Value, sizes: Option<usize>) -> Result<Pictures, String> {
    let path = |value: &Value| {
        let picture =
            |s: &str| [".png", ".jpg", ".jpeg"].iter().any(|end| s.to_ascii_lowercase().ends_with(end));
        text(value, 400).filter(|s| relative(s) && picture(s))
    };
    let (listed, one) = (value.as_array(), std::slice::from_ref(value));
    let given = listed.map_or(one, Vec::as_slice);
    if let Some(sizes) = sizes.filter(|sizes| given.len() != *sizes) {
        let of_study = if sizes == 1 { "1 size".to_owned() } else { format!("{sizes} sizes") };
        return Err(format!(
            "has {} for the study's {of_study}; a picture for each, in the order of display.sizes",
            if given.len() == 1 { "1 picture".to_owned() } else { format!("{} pictures", given.len()) }
        ));
    }
    let mut paths = given
        .iter()
        .map(path)
        .collect::<Option<Vec<String>>>()
        .ok_or("must be a .png, .jpg or .jpeg file relative to the study file")?;
    Ok(match paths.len() {
        1 => Pictures::One(paths.remove(0)),
        _ => Pictures::OfSizes(paths),
    })
}
