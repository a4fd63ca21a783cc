//! From a study file's text to a [`StudyDefinition`], or to every problem it has.

mod adaptive;
mod blocks;
mod completion;
mod conditions;
mod display;
mod languages;
mod psychometric;
mod texts;

use self::texts::{QUESTION, TITLE};
use crate::conduct::{NEWEST_EDITION, ResponseRules, SessionRules};
use crate::definition::{Block, EquivalenceBound, Screening, StudyDefinition};
use crate::fields::{IDENTIFIER, SECTION, identifier, integer, number, text};
use crate::primary;
use crate::visits::Flag;
use kelir_reader::{Fields, Node, Problem, Problems, Reading, Source};
use std::collections::BTreeSet;

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
    let texts = texts::read(&mut fields);
    let language = languages::read_own(&mut fields);
    let translations = languages::read_translations(&mut fields, language.as_deref());
    let blocks = blocks::read(&mut fields);
    let analysed: Vec<&Block> = blocks.iter().map(|read| &read.block).collect();
    let primary = primary::read(&mut fields, &analysed, equivalence.is_some());
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
        primary,
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

#[cfg(test)]
mod tests;
