//! From a study file's text to a [`StudyDefinition`], or to every problem it has.

mod adaptive;
mod completion;
mod conditions;
mod psychometric;

use crate::conduct::{NEWEST_EDITION, ResponseRules, SessionRules};
use crate::definition::{Block, EquivalenceBound, Item, ItemsKey, Kind, Screening, StudyDefinition, Texts};
use crate::display;
use crate::fields::{IDENTIFIER, SECTION, identifier, integer, number, text};
use crate::languages;
use crate::trials::TrialKind;
use crate::visits::Flag;
use kelir_reader::{Fields, Node, Problem, Problems, Reading, Source};
use std::collections::BTreeSet;

pub(crate) const TITLE: &str = "a text of 1 to 200 characters, none of them a control character";
pub(crate) const QUESTION: &str = "a text of 1 to 300 characters, none of them a control character";

impl StudyDefinition {
    /// Reads a study file. `file` names it in messages; its stem is the study's id.
    ///
    /// # Errors
    /// Every problem of the file, in one list.
    pub fn parse(file: &str, source: &str) -> Result<StudyDefinition, Problems> {
        let reading = Reading::default();
        let study = read_into(&reading, file, source);
        reading.end(study)
    }

    /// Reads a study file as far as it goes: what is wrong with it and, where every block and item could be read, a study whose other refused
    /// values stand at a default. It is for looking at what the file names, and must not be served while there are problems.
    pub fn parse_as_far(file: &str, source: &str) -> (Option<StudyDefinition>, Vec<Problem>) {
        let reading = Reading::default();
        let study = read_into(&reading, file, source);
        (study, reading.into_problems())
    }
}

/// Reads a study file into a reading, as far as it goes.
pub(crate) fn read_into(reading: &Reading, file: &str, source: &str) -> Option<StudyDefinition> {
    let source = reading.source(file, source);
    source.read(|root| read_study(&source, file, root).filter(|study| whole(study, root)))
}

/// Whether every block of the file with every item was read, so that their places are those of the file.
fn whole(study: &StudyDefinition, root: &Node) -> bool {
    fn list<'a>(node: &Node<'a>, key: &str) -> Vec<Node<'a>> {
        node.get(key).and_then(|node| node.as_array()).unwrap_or_default()
    }
    let blocks = list(root, "blocks");
    let items = |block: &Block, node: &Node| block.items.len() == list(node, block.items_key.0).len();
    blocks.len() == study.blocks.len()
        && study.blocks.iter().zip(&blocks).all(|(block, node)| items(block, node))
}

fn read_study(source: &Source, file: &str, root: &Node) -> Option<StudyDefinition> {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let id = name.strip_suffix(".toml").unwrap_or(name).to_owned();
    if !identifier(&id) {
        source.refuse("file name", Some(format!("{id:?}")), format!("must be {IDENTIFIER}"));
    }
    let mut fields = root.table()?;
    let title = fields.must("title", TITLE, |v| text(v, 200));
    let question = fields.must("question", QUESTION, |v| text(v, 300));
    let seed = fields.must("seed", "an integer from 0 to 2^53", |v| integer(v, 0, 1 << 53));
    let (size, display) = display::read(&mut fields);
    let surround =
        fields.defaulted("surround", "a linear luminance from 0 to 1", 0.2, |v| number(v, 0.0, 1.0));
    let estimated_minutes =
        fields.must("estimated_minutes", "whole minutes from 1 to 600", |v| integer(v, 1, 600));
    let idle_minutes =
        fields.defaulted("idle_minutes", "whole minutes from 1 to 100000", 60, |v| integer(v, 1, 100_000));
    let edition = fields.defaulted("edition", "1 or 2", 1, |v| integer(v, 1, i64::from(NEWEST_EDITION)));
    let response = ResponseRules::read(&mut fields);
    let session = SessionRules::read(&mut fields);
    let completion = completion::read(&mut fields, session.as_ref(), edition);
    let screening = read_screening(&mut fields);
    let equivalence = read_equivalence(&mut fields);
    let texts = read_texts(&mut fields);
    let language = languages::read_language(&mut fields);
    let translations = languages::read_translations(&mut fields, language.as_deref());
    let blocks = read_blocks(&mut fields);
    let conditions = conditions::read(&mut fields, &blocks, size.map(|_| display.sizes.len().max(1)));
    fields.done();
    Some(StudyDefinition {
        id,
        title: title.unwrap_or_default(),
        question: question.unwrap_or_default(),
        seed: seed.unwrap_or_default(),
        size: size.unwrap_or_default(),
        display,
        surround: surround.unwrap_or_default(),
        estimated_minutes: u32::try_from(estimated_minutes.unwrap_or_default()).ok()?,
        idle_minutes: u32::try_from(idle_minutes.unwrap_or_default()).ok()?,
        completion: completion.unwrap_or_default(),
        texts: texts.unwrap_or_default(),
        conditions,
        blocks: blocks.into_iter().map(|read| read.block).collect(),
        screening: screening.unwrap_or_default(),
        equivalence,
        edition: u32::try_from(edition?).ok()?,
        response: response?,
        session: session?,
        language: language?,
        translations: translations?,
    })
}

fn read_screening(fields: &mut Fields<'_>) -> Option<Screening> {
    let Some(node) = fields.given("screening", SECTION) else { return Some(Screening::default()) };
    let mut fields = node.table()?;
    let min_rt_ms = fields.may("min_rt_ms", "milliseconds from 0 to 60000", |v| number(v, 0.0, 60_000.0));
    let max_fast_trials = fields.may("max_fast_trials", "a count from 0 to 10000", |v| integer(v, 0, 10_000));
    let max_failed_catch_trials =
        fields.may("max_failed_catch_trials", "a count from 0 to 10000", |v| integer(v, 0, 10_000));
    let incomplete = fields.may("incomplete", "true or false", Node::as_bool);
    let straight_lining = fields.may("straight_lining", "true or false", Node::as_bool);
    let known: Vec<String> = Flag::ALL.iter().map(|flag| format!("\"{}\"", flag.as_str())).collect();
    let flags = fields.may("flags", &format!("a list of different ones of {}", known.join(", ")), |v| {
        let flags: Vec<Flag> =
            v.as_array()?.iter().map(|v| Flag::named(v.as_str()?)).collect::<Option<_>>()?;
        let different: BTreeSet<&Flag> = flags.iter().collect();
        (different.len() == flags.len()).then_some(flags)
    });
    fields.done();
    Some(Screening {
        min_rt_ms,
        max_fast_trials: u32::try_from(max_fast_trials.unwrap_or(0)).ok()?,
        max_failed_catch_trials: max_failed_catch_trials.and_then(|n| u32::try_from(n).ok()),
        straight_lining: straight_lining.unwrap_or(false),
        incomplete: incomplete.unwrap_or(false),
        flags: flags.unwrap_or_default(),
    })
}

fn read_equivalence(fields: &mut Fields<'_>) -> Option<EquivalenceBound> {
    let mut fields = fields.given("equivalence", SECTION)?.table()?;
    let rule = "a share of choices above 0 and below 0.5: from one half minus it to one half plus it";
    let within = fields.must("within", rule, |v| number(v, 0.0, 0.5).filter(|x| *x > 0.0 && *x < 0.5));
    let rule = "why a smaller difference does not matter, a text of 1 to 1000 characters";
    let reason = fields.must("reason", rule, |v| text(v, 1000));
    fields.done();
    Some(EquivalenceBound { within: within?, reason: reason? })
}

pub(crate) fn read_texts(fields: &mut Fields<'_>) -> Option<Texts> {
    let mut fields = fields.need(
        "texts",
        "a table with welcome, consent, instructions, debriefing and thanks",
        Node::table,
    )?;
    let mut read = |key| {
        fields.must(
            key,
            "plain text of at most 20000 characters, paragraphs apart by an empty line",
            paragraphs,
        )
    };
    let texts = (read("welcome"), read("consent"), read("instructions"), read("debriefing"), read("thanks"));
    fields.done();
    let (welcome, consent, instructions, debriefing, thanks) = texts;
    Some(Texts {
        welcome: welcome?,
        consent: consent?,
        instructions: instructions?,
        debriefing: debriefing?,
        thanks: thanks?,
    })
}

/// Paragraphs are apart by an empty line; a line break inside one is a blank.
fn paragraphs(value: &Node) -> Option<Vec<String>> {
    let text = text(value, 20_000)?;
    let mut paragraphs = vec![String::new()];
    for line in text.lines().map(str::trim) {
        let last = paragraphs.last_mut()?;
        match (line.is_empty(), last.is_empty()) {
            (true, true) => {}
            (true, false) => paragraphs.push(String::new()),
            (false, true) => last.push_str(line),
            (false, false) => {
                last.push(' ');
                last.push_str(line);
            }
        }
    }
    Some(paragraphs)
}

/// A block with where it and its items stand in the file.
struct ReadBlock<'a> {
    block: Block,
    node: Node<'a>,
    items: Vec<Node<'a>>,
}

fn read_blocks<'a>(fields: &mut Fields<'a>) -> Vec<ReadBlock<'a>> {
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

fn relative(path: &str) -> bool {
    !path.starts_with('/') && !path.contains(['\\', ':', '\0'])
}

#[cfg(test)]
mod tests;
