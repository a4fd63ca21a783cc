//! `[conditions.NAME]`: how pictures come to be.

use super::blocks::{ReadBlock, relative};
use crate::definition::{Block, Condition, Kind, Pictures};
use crate::fields::{IDENTIFIER, SECTION, identifier, text};
use kelir_reader::{Fields, Node};
use serde_json::Value as Json;
use std::collections::BTreeMap;

/// Blocks that a condition is looked at with, and how many sizes the study has where that is known.
#[derive(Clone, Copy)]
struct Around<'a> {
    blocks: &'a [ReadBlock<'a>],
    sizes: Option<usize>,
}

impl<'a> Around<'a> {
    /// The blocks that show a condition.
    fn users(self, name: &'a str) -> impl Iterator<Item = &'a Block> {
        self.blocks.iter().map(|read| &read.block).filter(move |b| b.conditions.iter().any(|c| c == name))
    }
}

/// The study's conditions; what is wrong with them, and with the items that need them, has been reported.
pub(super) fn read(
    fields: &mut Fields<'_>,
    blocks: &[ReadBlock<'_>],
    sizes: Option<usize>,
) -> BTreeMap<String, Condition> {
    let around = Around { blocks, sizes };
    let mut conditions = BTreeMap::new();
    let Some(table) = fields.must("conditions", "a table of conditions", Node::as_entries) else {
        return conditions;
    };
    for (name, node) in &table {
        if !identifier(name) {
            node.refuse::<()>(format!("a condition's name must be {IDENTIFIER}"));
        }
        if around.users(name).next().is_none() {
            node.refuse::<()>("no block uses this condition");
        }
        if let Some(condition) = read_condition(node, name, around) {
            conditions.insert((*name).to_owned(), condition);
        }
    }
    for ReadBlock { block, node, items } in blocks {
        let named = node.get("conditions").and_then(|node| node.as_array()).unwrap_or_default();
        for (name, named) in block.conditions.iter().zip(named) {
            if !table.iter().any(|(known, _)| known == name) {
                named.refuse::<()>("must be defined under [conditions]");
            }
            if let Some(Condition::Rendered { .. }) = conditions.get(name) {
                for item in items.iter().filter(|item| item.get("scene").is_none()) {
                    item.report("scene", format!("is missing: condition {name} is drawn from it"));
                }
            }
        }
    }
    conditions
}

fn read_condition<'a>(node: &Node, name: &'a str, around: Around<'a>) -> Option<Condition> {
    let mut fields = node.table()?;
    let moves = around.users(name).any(|b| b.kind == Kind::Animation);
    if let Some(files) = fields.given("files", SECTION) {
        if moves {
            fields.report("files", "a picture file cannot be an animation; use a technique");
        }
        let files = read_files(&files, name, around);
        fields.done();
        return Some(Condition::Files { files: files? });
    }
    let technique =
        fields.must("technique", "a technique's name (or give files = { pair = \"picture\" })", |v| {
            v.as_str().filter(|s| identifier(s)).map(str::to_owned)
        });
    let camera = match fields.given("camera", SECTION) {
        None => Some(None),
        Some(camera) => {
            if moves {
                fields.report("camera", "a simulated photograph is a still; this block shows animations");
            }
            camera.must("a table of camera settings", |v| v.as_entries()).map(|all| Some(knobs(all, &[])))
        }
    };
    let knobs = knobs(node.as_entries()?, &["technique", "camera"]);
    Some(Condition::Rendered { technique: technique?, knobs, camera: camera? })
}

/// Settings that the renderer reads itself: numbers, texts, booleans and lists of them.
fn knobs(entries: Vec<(&str, Node<'_>)>, skip: &[&str]) -> BTreeMap<String, Json> {
    fn scalar(value: &Node) -> Option<Json> {
        if let Some(items) = value.as_array() {
            return items.iter().map(scalar).collect::<Option<Vec<_>>>().map(Json::Array);
        }
        let text = || value.as_str().map(Json::from);
        let truth = || value.as_bool().map(Json::from);
        let number = || value.as_number().and_then(serde_json::Number::from_f64).map(Json::Number);
        value.as_integer().map(Json::from).or_else(number).or_else(text).or_else(truth)
    }
    let rule = "a finite number, a text, true or false, or a list of these";
    let settings = entries.into_iter().filter(|(key, _)| !skip.contains(key));
    settings.filter_map(|(key, node)| Some((key.to_owned(), node.must(rule, scalar)?))).collect()
}

fn read_files<'a>(node: &Node, name: &'a str, around: Around<'a>) -> Option<BTreeMap<String, Pictures>> {
    let table = node.must("a table of pair id = picture file", |v| v.as_entries())?;
    let items = || around.users(name).flat_map(|b| &b.items);
    let mut files = BTreeMap::new();
    for (item, node) in &table {
        if !items().any(|known| known.id == *item) {
            node.refuse::<()>("no block with this condition has a pair of this id");
        }
        match pictures(node, around.sizes) {
            Ok(paths) => {
                files.insert((*item).to_owned(), paths);
            }
            Err(rule) => {
                node.refuse::<()>(rule);
            }
        }
    }
    for item in items().filter(|item| !table.iter().any(|(id, _)| *id == item.id)) {
        node.report(&item.id, "is missing: every pair needs its picture");
    }
    Some(files)
}

/// The picture files of one item, one for each of `sizes` where that is known; or the rule that the value breaks.
fn pictures(value: &Node, sizes: Option<usize>) -> Result<Pictures, String> {
    let path = |value: &Node| {
        let picture =
            |s: &str| [".png", ".jpg", ".jpeg"].iter().any(|end| s.to_ascii_lowercase().ends_with(end));
        text(value, 400).filter(|s| relative(s) && picture(s))
    };
    let given = value.as_array().unwrap_or_else(|| vec![value.clone()]);
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
