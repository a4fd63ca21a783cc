//! `[[blocks]]` and their items.

use super::texts::TITLE;
use super::{adaptive, psychometric};
use crate::definition::{Block, Item, ItemsKey, Kind};
use crate::fields::{IDENTIFIER, identifier, number, text};
use crate::trials::TrialKind;
use kelir_reader::{Fields, Node};
use std::collections::BTreeSet;

/// A block with where it and its items stand in the file.
pub(super) struct ReadBlock<'a> {
    pub block: Block,
    pub node: Node<'a>,
    pub items: Vec<Node<'a>>,
}

/// The study's blocks as far as they could be read; what is wrong with them has been reported.
pub(super) fn read<'a>(fields: &mut Fields<'a>) -> Vec<ReadBlock<'a>> {
    let (mut block_ids, mut pair_ids) = (BTreeSet::new(), BTreeSet::new());
    let mut blocks = Vec::new();
    for mut fields in fields.tables("blocks") {
        let id = read_id(&mut fields, &mut block_ids);
        let title = fields.must("title", TITLE, |v| text(v, 200));
        let kind = fields.must("kind", "\"still\" or \"animation\"", |v| match v.as_str()? {
            "still" => Some(Kind::Still),
            "animation" => Some(Kind::Animation),
            _ => None,
        });
        let conditions = fields.must("conditions", "two different condition names", |v| {
            let [a, b] = &v.as_array()?[..] else { return None };
            let (a, b) = (a.as_str()?, b.as_str()?);
            (identifier(a) && identifier(b) && a != b).then(|| [a.to_owned(), b.to_owned()])
        });
        let target = fields.must("target", "one of the block's two conditions", |v| {
            let target = v.as_str()?;
            conditions.as_ref().is_none_or(|c| c.iter().any(|name| name == target)).then(|| target.to_owned())
        });
        let catch = fields.may("catch", "true or false", Node::as_bool).unwrap_or(false);
        let (mut items, mut nodes) = (Vec::new(), Vec::new());
        let key = items_key(&fields);
        for mut fields in fields.tables(key) {
            let id = read_id(&mut fields, &mut pair_ids);
            let scene =
                fields.may("scene", "a scene file relative to the study file, ending in .toml", |v| {
                    text(v, 400).filter(|s| relative(s) && s.ends_with(".toml"))
                });
            let level = fields.may("level", "a finite number within ±1e12", |v| number(v, -1e12, 1e12));
            if let Some(id) = id {
                items.push(Item { id, scene, level });
                nodes.push(fields.node().clone());
            }
            fields.done();
        }
        let psychometric = psychometric::read(&mut fields, key, (&items, &nodes), catch);
        let adaptive = adaptive::read(&mut fields);
        if adaptive.is_some() && psychometric.is_none() {
            fields.report("adaptive", "needs the block's [blocks.psychometric], whose levels it moves over");
        }
        let trial = TrialKind::read(&mut fields);
        let node = fields.node().clone();
        fields.done();
        if let (Some(id), Some(title), Some(kind), Some(conditions), Some(target), Some(trial)) =
            (id, title, kind, conditions, target, trial)
        {
            let block = Block {
                id,
                title,
                kind,
                conditions,
                target,
                items,
                items_key: ItemsKey(key),
                catch,
                trial,
                adaptive,
                psychometric,
            };
            check_adaptive(&node, &block);
            blocks.push(ReadBlock { block, node, items: nodes });
        }
    }
    let trials: usize = blocks.iter().map(|read| read.block.most_trials()).sum();
    if trials > 10_000 {
        fields.report("blocks", format!("have {trials} trials; a study has at most 10000"));
    }
    blocks
}

/// Whether the procedure goes with the block's levels.
fn check_adaptive(node: &Node, block: &Block) {
    let (Some(adaptive), Some(_)) = (&block.adaptive, &block.psychometric) else { return };
    if let Err(error) = adaptive.next_level(block, []) {
        node.report("adaptive", error.to_string());
    }
}

/// The key that the block's items stand under: `items`, or `pairs` as it used to be called.
fn items_key(block: &Fields<'_>) -> &'static str {
    if block.has("pairs") && !block.has("items") { "pairs" } else { "items" }
}

fn read_id(fields: &mut Fields<'_>, taken: &mut BTreeSet<String>) -> Option<String> {
    fields.need("id", IDENTIFIER, |node| {
        let id = node.must(IDENTIFIER, |v| v.as_str().filter(|s| identifier(s)).map(str::to_owned))?;
        if !taken.insert(id.clone()) {
            node.refuse::<()>("must be unique in the study");
        }
        Some(id)
    })
}

/// Whether a path leads from where the study file is, on any system.
pub(super) fn relative(path: &str) -> bool {
    !path.starts_with('/') && !path.contains(['\\', ':', '\0'])
}
