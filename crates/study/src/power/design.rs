//! A design file: a study, a supposed truth about its observers, and what is to be tried.

use crate::definition::StudyDefinition;
use crate::fields::{Fields, Gatherer, integer, number, text};
use crate::problems::StudyErrors;
use std::collections::{BTreeMap, BTreeSet};
use toml::{Table, Value};

/// Most participants of one simulated study.
const MOST_PARTICIPANTS: i64 = 100_000;
/// Most different numbers of participants.
const MOST_SIZES: usize = 50;

/// A design file's text, read as far as it goes without the study it names.
#[derive(Clone, Debug)]
pub struct DesignFile {
    file: String,
    table: Table,
    /// The study file, relative to the design file.
    pub study: String,
}

/// What is simulated; every value has been checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The study that observers take.
    pub study: StudyDefinition,
    /// Numbers of participants who begin, rising, at least 2.
    pub participants: Vec<u32>,
    /// Simulated studies of each size.
    pub simulations: u64,
    /// Seed of it all.
    pub seed: u64,
    /// Level of the tests.
    pub alpha: f64,
    /// The power that is wanted.
    pub power: f64,
    /// What is true of each block, in study order; `None` for catch blocks.
    pub truths: Vec<Option<Supposed>>,
    /// How people take part.
    pub observers: Observers,
}

/// A truth and the entry of the file that states it: one observer's own deviation is the same in all blocks of one entry.
#[derive(Clone, Debug, PartialEq)]
pub struct Supposed {
    /// Number of the file's `[[truth]]`, from 0.
    pub entry: usize,
    /// What is true.
    pub truth: Truth,
    /// Share of answers by a coin.
    pub lapse: f64,
}

/// What is true of the observers' choices in a block.
#[derive(Clone, Debug, PartialEq)]
pub enum Truth {
    /// The target is chosen with a probability that varies from observer to observer.
    Preference {
        /// Its mean.
        probability: f64,
        /// Intraclass correlation of one observer's choices: the variance of their probabilities is icc · p(1 − p).
        icc: f64,
    },
    /// Conditions have a quality.
    Quality {
        /// By condition, in JOD: one apart is chosen by 75%.
        jod: BTreeMap<String, f64>,
        /// Standard deviation of an observer's own quality of each condition about that, in JOD.
        observer_sd: f64,
    },
    /// The block's psychometric function.
    Threshold {
        /// Level halfway between guessing and lapsing.
        threshold: f64,
        /// From 5% to 95% of the curve, in levels.
        width: f64,
        /// Standard deviation of observers' own thresholds, in levels.
        threshold_sd: f64,
    },
}

/// How simulated people take part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observers {
    /// Share who stop after a trial that is as likely any as another.
    pub dropout: f64,
    /// Share who choose by a coin, quickly.
    pub careless: f64,
    /// Share of wrong answers in catch blocks by those who are not careless.
    pub catch_errors: f64,
    /// Median response time in ms.
    pub rt_median_ms: f64,
    /// The careless ones' median response time in ms.
    pub careless_rt_ms: f64,
}

impl Default for Observers {
    /// Everybody finishes with care, in 1.5 s a trial.
    fn default() -> Observers {
        Observers {
            dropout: 0.0,
            careless: 0.0,
            catch_errors: 0.0,
            rt_median_ms: 1500.0,
            careless_rt_ms: 300.0,
        }
    }
}

impl DesignFile {
    /// Reads a design file's text. `file` names it in messages.
    ///
    /// # Errors
    /// It is no TOML, or names no study.
    pub fn parse(file: &str, source: &str) -> Result<DesignFile, StudyErrors> {
        let table = crate::parse::table(file, source)?;
        let gatherer = Gatherer::new(file);
        let mut fields = Fields::new(&gatherer, "", &table);
        let study = fields.need("study", "a study file relative to this one, ending in .toml", |v| {
            text(v, 400).filter(|s| s.ends_with(".toml"))
        });
        match study {
            Some(study) => Ok(DesignFile { file: file.to_owned(), table, study }),
            None => Err(StudyErrors(gatherer.into_problems())),
        }
    }

    /// The design of `study`, which the caller has read from the file named.
    ///
    /// # Errors
    /// Every problem of the design file, in one list.
    pub fn design(&self, study: StudyDefinition) -> Result<Design, StudyErrors> {
        let gatherer = Gatherer::new(&self.file);
        let design = self.read(&gatherer, study);
        match (design, gatherer.into_problems()) {
            (Some(design), problems) if problems.is_empty() => Ok(design),
            (_, problems) => Err(StudyErrors(problems)),
        }
    }

    fn read(&self, gatherer: &Gatherer<'_>, study: StudyDefinition) -> Option<Design> {
        let mut fields = Fields::new(gatherer, "", &self.table);
        fields.raw("study");
        let sizes = format!(
            "a list of 1 to {MOST_SIZES} different numbers from 2 to {MOST_PARTICIPANTS}, or a table with from, to and step that gives \
             one"
        );
        let participants = fields.need("participants", &sizes, participants);
        let simulations =
            fields.need("simulations", "a count from 20 to 1000000", |v| integer(v, 20, 1_000_000));
        let seed = fields.need("seed", "an integer from 0 to 2^53", |v| integer(v, 0, 1 << 53));
        let share = |v: &Value| number(v, 0.0, 1.0).filter(|x| *x > 0.0 && *x < 1.0);
        let alpha = fields.get("alpha", "a number above 0 and below 1", share);
        let power = fields.get("power", "a number above 0 and below 1", share);
        let observers = observers(gatherer, &mut fields);
        let truths = truths(gatherer, &mut fields, &study);
        fields.finish();
        Some(Design {
            study,
            participants: participants?,
            simulations: simulations?,
            seed: seed?,
            alpha: alpha.unwrap_or(0.05),
            power: power.unwrap_or(0.8),
            truths: truths?,
            observers: observers?,
        })
    }
}

fn participants(value: &Value) -> Option<Vec<u32>> {
    let size = |v: &Value| integer(v, 2, MOST_PARTICIPANTS).map(|n| n as u32);
    let sizes: BTreeSet<u32> = match value {
        Value::Array(items) => {
            let sizes: BTreeSet<u32> = items.iter().map(size).collect::<Option<_>>()?;
            (sizes.len() == items.len()).then_some(sizes)?
        }
        Value::Table(table) if table.len() == 3 => {
            let (from, to) = (size(table.get("from")?)?, size(table.get("to")?)?);
            let step = integer(table.get("step")?, 1, MOST_PARTICIPANTS)?;
            (from..=to).step_by(step as usize).take(MOST_SIZES + 1).collect()
        }
        _ => return None,
    };
    (1..=MOST_SIZES).contains(&sizes.len()).then(|| sizes.into_iter().collect())
}

fn observers(gatherer: &Gatherer<'_>, fields: &mut Fields<'_>) -> Option<Observers> {
    let Some(value) = fields.raw("observers") else { return Some(Observers::default()) };
    let mut fields = Fields::of(gatherer, "observers".to_owned(), value)?;
    let usual = Observers::default();
    let mut share = |key| fields.get(key, "a share from 0 to 1", |v| number(v, 0.0, 1.0)).unwrap_or(0.0);
    let (dropout, careless, catch_errors) = (share("dropout"), share("careless"), share("catch_errors"));
    let mut time = |key, default| {
        fields.get(key, "milliseconds from 1 to 600000", |v| number(v, 1.0, 600_000.0)).unwrap_or(default)
    };
    let (rt_median_ms, careless_rt_ms) =
        (time("rt_median_ms", usual.rt_median_ms), time("careless_rt_ms", usual.careless_rt_ms));
    fields.finish();
    Some(Observers { dropout, careless, catch_errors, rt_median_ms, careless_rt_ms })
}

fn truths(
    gatherer: &Gatherer<'_>,
    fields: &mut Fields<'_>,
    study: &StudyDefinition,
) -> Option<Vec<Option<Supposed>>> {
    let mut of_block: Vec<Option<Supposed>> = vec![None; study.blocks.len()];
    let mut rest = None;
    let mut good = true;
    for (entry, mut fields) in fields.tables("truth").into_iter().enumerate() {
        let blocks =
            fields.get("blocks", "a list of ids of the study's blocks that are no catch blocks", |v| {
                let items = v.as_array().filter(|items| !items.is_empty())?;
                items.iter().map(|v| analysed(study, v.as_str()?)).collect::<Option<Vec<usize>>>()
            });
        let named = fields.raw("blocks").is_some();
        let supposed = truth(gatherer, &mut fields, entry);
        match (blocks, named, supposed) {
            (Some(blocks), _, Some(supposed)) => {
                for block in blocks {
                    if of_block[block].replace(supposed.clone()).is_some() {
                        let id = Value::String(study.blocks[block].id.clone());
                        fields.report("blocks", Some(&id), "an earlier [[truth]] names this block already");
                    }
                }
            }
            (None, false, Some(supposed)) => {
                if rest.replace(supposed).is_some() {
                    fields.report(
                        "blocks",
                        None,
                        "missing; one [[truth]] alone may stand for all other blocks",
                    );
                }
            }
            _ => good = false,
        }
        fields.finish();
    }
    if !good {
        return None;
    }
    for (block, supposed) in study.blocks.iter().zip(&mut of_block).filter(|(block, _)| !block.catch) {
        if supposed.is_none() {
            *supposed = rest.clone();
        }
        let id = &block.id;
        match supposed {
            None => fields.report("truth", None, format!("no [[truth]] is of block {id}")),
            Some(Supposed { truth: Truth::Quality { jod, .. }, .. }) => {
                for name in block.conditions.iter().filter(|name| !jod.contains_key(*name)) {
                    fields.report(
                        "truth",
                        None,
                        format!("jod gives no quality for condition {name} of block {id}"),
                    );
                }
            }
            Some(Supposed { truth: Truth::Threshold { .. }, .. }) if block.psychometric.is_none() => {
                let rule =
                    format!("a threshold is of a block with levels and [blocks.psychometric]; {id} has none");
                fields.report("truth", None, rule);
            }
            Some(_) => {}
        }
    }
    Some(of_block)
}

/// The place of a block that is analysed.
fn analysed(study: &StudyDefinition, id: &str) -> Option<usize> {
    study.blocks.iter().position(|block| block.id == id && !block.catch)
}

fn truth(gatherer: &Gatherer<'_>, fields: &mut Fields<'_>, entry: usize) -> Option<Supposed> {
    let lapse = fields.get("lapse", "a share from 0 to 1", |v| number(v, 0.0, 1.0)).unwrap_or(0.0);
    let spread = |v: &Value| number(v, 0.0, 1e9);
    let given: Vec<&str> =
        ["preference", "jod", "threshold"].into_iter().filter(|key| fields.raw(key).is_some()).collect();
    let truth = match given[..] {
        ["preference"] => preference(fields)?,
        ["jod"] => {
            let jod = fields.raw("jod").and_then(|v| qualities(gatherer, &fields.path_of("jod"), v));
            let observer_sd = fields.get("observer_sd", "JOD from 0 to 1e9", spread).unwrap_or(0.0);
            Truth::Quality { jod: jod?, observer_sd }
        }
        ["threshold"] => {
            let threshold = fields.get("threshold", "a level within ±1e12", |v| number(v, -1e12, 1e12));
            let width =
                fields.need("width", "a number above 0 up to 1e9", |v| spread(v).filter(|x| *x > 0.0));
            let threshold_sd = fields.get("threshold_sd", "levels from 0 to 1e9", spread).unwrap_or(0.0);
            Truth::Threshold { threshold: threshold?, width: width?, threshold_sd }
        }
        _ => {
            fields.report("preference", None, "give one of preference, jod and threshold (with width)");
            return None;
        }
    };
    Some(Supposed { entry, truth, lapse })
}

fn preference(fields: &mut Fields<'_>) -> Option<Truth> {
    let probability = fields.get("preference", "a probability from 0 to 1", |v| number(v, 0.0, 1.0));
    let icc = fields.get("icc", "a number from 0 to 1", |v| number(v, 0.0, 1.0));
    let sd = fields.get("sd", "a standard deviation from 0 to 0.5", |v| number(v, 0.0, 0.5));
    let probability = probability?;
    let most = probability * (1.0 - probability);
    let icc = match (icc, sd) {
        (Some(_), Some(_)) => {
            fields.report("sd", None, "give icc or sd, not both");
            return None;
        }
        (None, Some(sd)) if sd * sd > most => {
            let rule = format!("must not exceed √(p(1 − p)) = {:.4}", most.sqrt());
            fields.report("sd", Some(&Value::Float(sd)), rule);
            return None;
        }
        (None, Some(sd)) if most > 0.0 => sd * sd / most,
        (icc, _) => icc.unwrap_or(0.0),
    };
    Some(Truth::Preference { probability, icc })
}

fn qualities(gatherer: &Gatherer<'_>, path: &str, value: &Value) -> Option<BTreeMap<String, f64>> {
    let Some(table) = value.as_table() else {
        gatherer.report(path, Some(value), "must be a table of condition = JOD");
        return None;
    };
    let mut qualities = BTreeMap::new();
    for (name, value) in table {
        match number(value, -100.0, 100.0) {
            Some(jod) => {
                qualities.insert(name.clone(), jod);
            }
            None => gatherer.report(
                &format!("{path}.{name}"),
                Some(value),
                "must be a number of JOD from -100 to 100",
            ),
        }
    }
    (qualities.len() == table.len()).then_some(qualities)
}
