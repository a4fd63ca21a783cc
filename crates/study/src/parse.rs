//! From a study file's text to a [`StudyDefinition`], or to every problem it has.

mod adaptive;
mod completion;
mod conditions;
mod psychometric;

use crate::conduct::{NEWEST_EDITION, ResponseRules, SessionRules};
use crate::definition::{Block, Item, ItemsKey, Kind, Screening, StudyDefinition, Texts};
use crate::display;
use crate::fields::{Fields, Gatherer, IDENTIFIER, identifier, integer, number, text};
use crate::languages;
use crate::problems::{Problem, StudyErrors};
use crate::trials::TrialKind;
use crate::visits::Flag;
use std::collections::BTreeSet;
use toml::{Table, Value};

pub(crate) const TITLE: &str = "a text of 1 to 200 characters, none of them a control character";
pub(crate) const QUESTION: &str = "a text of 1 to 300 characters, none of them a control character";

impl StudyDefinition {
    /// Reads a study file. `file` names it in messages; its stem is the study's id.
    ///
    /// # Errors
    /// Every problem of the file, in one list.
    pub fn parse(file: &str, source: &str) -> Result<StudyDefinition, StudyErrors> {
        match StudyDefinition::parse_as_far(file, source) {
            (Some(study), problems) if problems.is_empty() => Ok(study),
            (_, problems) => Err(StudyErrors(problems)),
        }
    }

    /// Reads a study file as far as it goes: what is wrong with it and, where every block and item could be read, a study whose other refused
    /// values stand at a default. It is for looking at what the file names, and must not be served while there are problems.
    pub fn parse_as_far(file: &str, source: &str) -> (Option<StudyDefinition>, Vec<Problem>) {
        let table = match table(file, source) {
            Ok(table) => table,
            Err(errors) => return (None, errors.0),
        };
        let gatherer = Gatherer::new(file);
        let study = read_study(&gatherer, file, &table).filter(|study| whole(study, &table));
        (study, gatherer.into_problems())
    }
}

/// The file's text as TOML, or where it is none.
pub(crate) fn table(file: &str, source: &str) -> Result<Table, StudyErrors> {
    source.parse::<Table>().map_err(|error| {
        let field = match error.span() {
            Some(span) => position(source, span.start),
            None => "text".to_owned(),
        };
        let rule = format!("is no TOML: {}", error.message());
        StudyErrors(vec![Problem { file: file.to_owned(), field, value: None, rule }])
    })
}

/// Whether every block of the file with every item was read, so that their places are those of the file.
fn whole(study: &StudyDefinition, table: &Table) -> bool {
    let count = |value: Option<&Value>| value.and_then(Value::as_array).map_or(0, Vec::len);
    let blocks = table.get("blocks").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    let items = |block: &Block, value: &Value| block.items.len() == count(value.get(block.items_key.0));
    blocks.len() == study.blocks.len()
        && study.blocks.iter().zip(blocks).all(|(block, value)| items(block, value))
}

fn position(source: &str, offset: usize) -> String {
    let before = source.get(..offset).unwrap_or(source);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |tail| tail.chars().count()) + 1;
    format!("line {line}, column {column}")
}

fn read_study(gatherer: &Gatherer<'_>, file: &str, table: &Table) -> Option<StudyDefinition> {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let id = name.strip_suffix(".toml").unwrap_or(name).to_owned();
    if !identifier(&id) {
        gatherer.report("file name", Some(&Value::String(id.clone())), format!("must be {IDENTIFIER}"));
    }
    let mut fields = Fields::new(gatherer, "", table);
    let title = fields.need("title", TITLE, |v| text(v, 200));
    let question = fields.need("question", QUESTION, |v| text(v, 300));
    let seed = fields.need("seed", "an integer from 0 to 2^53", |v| integer(v, 0, 1 << 53));
    let (size, display) = display::read(gatherer, &mut fields);
    let surround = fields
        .get("surround", "a linear luminance from 0 to 1", |v| number(v, 0.0, 1.0))
        .or_else(|| fields_default(table, "surround", 0.2));
    let estimated_minutes =
        fields.need("estimated_minutes", "whole minutes from 1 to 600", |v| integer(v, 1, 600));
    let idle_minutes = fields
        .get("idle_minutes", "whole minutes from 1 to 100000", |v| integer(v, 1, 100_000))
        .or_else(|| fields_default(table, "idle_minutes", 60));
    let edition = fields
        .get("edition", "1 or 2", |v| integer(v, 1, i64::from(NEWEST_EDITION)))
        .or_else(|| fields_default(table, "edition", 1));
    let response = ResponseRules::read(gatherer, &mut fields);
    let session = SessionRules::read(gatherer, &mut fields);
    let completion = completion::read(gatherer, &mut fields, session.as_ref(), edition);
    let screening = read_screening(gatherer, &mut fields);
    let texts = read_texts(gatherer, &mut fields);
    let language = languages::read_language(&mut fields);
    let translations = languages::read_translations(gatherer, &mut fields, language.as_deref());
    let blocks = read_blocks(gatherer, &mut fields);
    let conditions =
        conditions::read(gatherer, &mut fields, &blocks, size.map(|_| display.sizes.len().max(1)));
    fields.finish();
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
        blocks,
        screening: screening.unwrap_or_default(),
        edition: u32::try_from(edition?).ok()?,
        response: response?,
        session: session?,
        language: language?,
        translations: translations?,
    })
}

/// The default of an absent key; a key that is there and wrong has been reported already.
fn fields_default<T>(table: &Table, key: &str, default: T) -> Option<T> {
    (!table.contains_key(key)).then_some(default)
}

fn read_screening(gatherer: &Gatherer<'_>, fields: &mut Fields<'_>) -> Option<Screening> {
    let Some(value) = fields.raw("screening") else { return Some(Screening::default()) };
    let mut fields = Fields::of(gatherer, "screening".to_owned(), value)?;
    let min_rt_ms = fields.get("min_rt_ms", "milliseconds from 0 to 60000", |v| number(v, 0.0, 60_000.0));
    let max_fast_trials = fields.get("max_fast_trials", "a count from 0 to 10000", |v| integer(v, 0, 10_000));
    let max_failed_catch_trials =
        fields.get("max_failed_catch_trials", "a count from 0 to 10000", |v| integer(v, 0, 10_000));
    let incomplete = fields.get("incomplete", "true or false", Value::as_bool);
    let straight_lining = fields.get("straight_lining", "true or false", Value::as_bool);
    let known: Vec<String> = Flag::ALL.iter().map(|flag| format!("\"{}\"", flag.as_str())).collect();
    let flags = fields.get("flags", &format!("a list of different ones of {}", known.join(", ")), |v| {
        let flags: Vec<Flag> =
            v.as_array()?.iter().map(|v| Flag::named(v.as_str()?)).collect::<Option<_>>()?;
        let different: BTreeSet<&Flag> = flags.iter().collect();
        (different.len() == flags.len()).then_some(flags)
    });
    fields.finish();
    Some(Screening {
        min_rt_ms,
        max_fast_trials: u32::try_from(max_fast_trials.unwrap_or(0)).ok()?,
        max_failed_catch_trials: max_failed_catch_trials.and_then(|n| u32::try_from(n).ok()),
        straight_lining: straight_lining.unwrap_or(false),
        incomplete: incomplete.unwrap_or(false),
        flags: flags.unwrap_or_default(),
    })
}

pub(crate) fn read_texts(gatherer: &Gatherer<'_>, fields: &mut Fields<'_>) -> Option<Texts> {
    let value =
        fields.need("texts", "a table with welcome, consent, instructions, debriefing and thanks", Some)?;
    let mut fields = Fields::of(gatherer, fields.path_of("texts"), value)?;
    let mut read = |key| {
        fields.need(
            key,
            "plain text of at most 20000 characters, paragraphs apart by an empty line",
            paragraphs,
        )
    };
    let texts = (read("welcome"), read("consent"), read("instructions"), read("debriefing"), read("thanks"));
    fields.finish();
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
fn paragraphs(value: &Value) -> Option<Vec<String>> {
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

fn read_blocks(gatherer: &Gatherer<'_>, fields: &mut Fields<'_>) -> Vec<Block> {
    let (mut block_ids, mut pair_ids) = (BTreeSet::new(), BTreeSet::new());
    let mut blocks = Vec::new();
    for mut fields in fields.tables("blocks") {
        let id = read_id(&mut fields, &mut block_ids);
        let title = fields.need("title", TITLE, |v| text(v, 200));
        let kind = fields.need("kind", "\"still\" or \"animation\"", |v| match v.as_str()? {
            "still" => Some(Kind::Still),
            "animation" => Some(Kind::Animation),
            _ => None,
        });
        let conditions = fields.need("conditions", "two different condition names", |v| {
            let [a, b] = v.as_array()?.as_slice() else { return None };
            let (a, b) = (a.as_str()?, b.as_str()?);
            (identifier(a) && identifier(b) && a != b).then(|| [a.to_owned(), b.to_owned()])
        });
        let target = fields.need("target", "one of the block's two conditions", |v| {
            let target = v.as_str()?;
            conditions.as_ref().is_none_or(|c| c.iter().any(|name| name == target)).then(|| target.to_owned())
        });
        let catch = fields.get("catch", "true or false", Value::as_bool).unwrap_or(false);
        let mut items = Vec::new();
        let key = items_key(&fields);
        for mut fields in fields.tables(key) {
            let id = read_id(&mut fields, &mut pair_ids);
            let scene =
                fields.get("scene", "a scene file relative to the study file, ending in .toml", |v| {
                    text(v, 400).filter(|s| relative(s) && s.ends_with(".toml"))
                });
            let level = fields.get("level", "a finite number within ±1e12", |v| number(v, -1e12, 1e12));
            fields.finish();
            items.extend(id.map(|id| Item { id, scene, level }));
        }
        let psychometric = psychometric::read(gatherer, &mut fields, key, &items, catch);
        let adaptive = adaptive::read(&mut fields);
        if adaptive.is_some() && psychometric.is_none() {
            fields.report(
                "adaptive",
                None,
                "needs the block's [blocks.psychometric], whose levels it moves over",
            );
        }
        let trial = TrialKind::read(&mut fields);
        fields.finish();
        if let (Some(id), Some(title), Some(kind), Some(conditions), Some(target), Some(trial)) =
            (id, title, kind, conditions, target, trial)
        {
            let (items_key, block_index) = (ItemsKey(key), blocks.len());
            let block = Block {
                id,
                title,
                kind,
                conditions,
                target,
                items,
                items_key,
                catch,
                trial,
                adaptive,
                psychometric,
            };
            check_adaptive(gatherer, block_index, &block);
            blocks.push(block);
        }
    }
    let trials: usize = blocks.iter().map(Block::most_trials).sum();
    if trials > 10_000 {
        gatherer.report("blocks", None, format!("have {trials} trials; a study has at most 10000"));
    }
    blocks
}

/// Whether the procedure goes with the block's levels.
fn check_adaptive(gatherer: &Gatherer<'_>, index: usize, block: &Block) {
    let (Some(adaptive), Some(_)) = (&block.adaptive, &block.psychometric) else { return };
    if let Err(error) = adaptive.next_level(block, []) {
        gatherer.report(&format!("blocks[{index}].adaptive"), None, error.to_string());
    }
}

/// The key that the block's items stand under: `items`, or `pairs` as it used to be called.
fn items_key(block: &Fields<'_>) -> &'static str {
    if block.has("pairs") && !block.has("items") { "pairs" } else { "items" }
}

fn read_id(fields: &mut Fields<'_>, taken: &mut BTreeSet<String>) -> Option<String> {
    let id = fields.need("id", IDENTIFIER, |v| v.as_str().filter(|s| identifier(s)).map(str::to_owned))?;
    if !taken.insert(id.clone()) {
        fields.report("id", Some(&Value::String(id.clone())), "must be unique in the study");
    }
    Some(id)
}

fn relative(path: &str) -> bool {
    !path.starts_with('/') && !path.contains(['\\', ':', '\0'])
}

#[cfg(test)]
mod tests;
