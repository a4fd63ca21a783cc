//! A design file: a study, a supposed truth about its observers, and what is to be tried.

use crate::definition::StudyDefinition;
use crate::fields::{SECTION, integer, number, text};
use kelir_reader::{Fields, Node, Problems, Reading};
use std::collections::{BTreeMap, BTreeSet};

/// Most participants of one simulated study.
const MOST_PARTICIPANTS: i64 = 100_000;
/// Most different numbers of participants.
const MOST_SIZES: usize = 50;

/// A design file's text, read as far as it goes without the study it names.
#[derive(Clone, Debug)]
pub struct DesignFile {
    file: String,
    text: String,
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
    pub fn parse(file: &str, source: &str) -> Result<DesignFile, Problems> {
        let reading = Reading::default();
        let study = reading.source(file, source).read(|root| {
            let mut fields = root.table()?;
            // What the other keys may be depends on the study.
            let rule = "a study file relative to this one, ending in .toml";
            fields.must("study", rule, |v| text(v, 400).filter(|s| s.ends_with(".toml")))
        });
        let study = reading.end(study)?;
        Ok(DesignFile { file: file.to_owned(), text: source.to_owned(), study })
    }

    /// The design of `study`, which the caller has read from the file named.
    ///
    /// # Errors
    /// Every problem of the design file, in one list.
    pub fn design(&self, study: StudyDefinition) -> Result<Design, Problems> {
        let reading = Reading::default();
        let design = reading.source(&self.file, &self.text).read(|root| read(root, study));
        reading.end(design)
    }
}

fn read(root: &Node, study: StudyDefinition) -> Option<Design> {
    let mut fields = root.table()?;
    fields.get("study");
    let sizes = format!(
        "a list of 1 to {MOST_SIZES} different numbers from 2 to {MOST_PARTICIPANTS}, or a table with from, to and step that gives \
         one"
    );
    let participants = fields.must("participants", &sizes, participants);
    let simulations = fields.must("simulations", "a count from 20 to 1000000", |v| integer(v, 20, 1_000_000));
    let seed = fields.must("seed", "an integer from 0 to 2^53", |v| integer(v, 0, 1 << 53));
    let share = |v: &Node| number(v, 0.0, 1.0).filter(|x| *x > 0.0 && *x < 1.0);
    let alpha = fields.may("alpha", "a number above 0 and below 1", share);
    let power = fields.may("power", "a number above 0 and below 1", share);
    let observers = observers(&mut fields);
    let truths = truths(&mut fields, &study);
    fields.done();
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

fn participants(value: &Node) -> Option<Vec<u32>> {
    let size = |v: &Node| integer(v, 2, MOST_PARTICIPANTS).map(|n| n as u32);
    let sizes: BTreeSet<u32> = if let Some(items) = value.as_array() {
        let sizes: BTreeSet<u32> = items.iter().map(size).collect::<Option<_>>()?;
        (sizes.len() == items.len()).then_some(sizes)?
    } else if value.as_entries()?.len() == 3 {
        let (from, to) = (size(&value.get("from")?)?, size(&value.get("to")?)?);
        let step = integer(&value.get("step")?, 1, MOST_PARTICIPANTS)?;
        (from..=to).step_by(step as usize).take(MOST_SIZES + 1).collect()
    } else {
        return None;
    };
    (1..=MOST_SIZES).contains(&sizes.len()).then(|| sizes.into_iter().collect())
}

fn observers(fields: &mut Fields<'_>) -> Option<Observers> {
    let Some(node) = fields.given("observers", SECTION) else { return Some(Observers::default()) };
    let mut fields = node.table()?;
    let usual = Observers::default();
    let mut share = |key| fields.may(key, "a share from 0 to 1", |v| number(v, 0.0, 1.0)).unwrap_or(0.0);
    let (dropout, careless, catch_errors) = (share("dropout"), share("careless"), share("catch_errors"));
    let mut time = |key, default| {
        fields.may(key, "milliseconds from 1 to 600000", |v| number(v, 1.0, 600_000.0)).unwrap_or(default)
    };
    let (rt_median_ms, careless_rt_ms) =
        (time("rt_median_ms", usual.rt_median_ms), time("careless_rt_ms", usual.careless_rt_ms));
    fields.done();
    Some(Observers { dropout, careless, catch_errors, rt_median_ms, careless_rt_ms })
}

fn truths(fields: &mut Fields<'_>, study: &StudyDefinition) -> Option<Vec<Option<Supposed>>> {
    let mut of_block: Vec<Option<Supposed>> = vec![None; study.blocks.len()];
    let mut rest = None;
    let mut good = true;
    for (entry, mut fields) in fields.tables("truth").into_iter().enumerate() {
        let blocks =
            fields.may("blocks", "a list of ids of the study's blocks that are no catch blocks", |v| {
                let items = v.as_array().filter(|items| !items.is_empty())?;
                items.iter().map(|v| analysed(study, v.as_str()?)).collect::<Option<Vec<usize>>>()
            });
        let named = fields.has("blocks");
        let supposed = truth(&mut fields, entry);
        match (blocks, named, supposed) {
            (Some(blocks), _, Some(supposed)) => {
                let items = fields.get("blocks").and_then(|node| node.as_array()).unwrap_or_default();
                for (block, item) in blocks.into_iter().zip(items) {
                    if of_block[block].replace(supposed.clone()).is_some() {
                        item.refuse::<()>("an earlier [[truth]] names this block already");
                    }
                }
            }
            (None, false, Some(supposed)) => {
                if rest.replace(supposed).is_some() {
                    let rule = "is missing: one [[truth]] alone may stand for all other blocks";
                    fields.report("blocks", rule);
                }
            }
            _ => good = false,
        }
        fields.done();
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
            None => fields.report("truth", format!("no [[truth]] is of block {id}")),
            Some(Supposed { truth: Truth::Quality { jod, .. }, .. }) => {
                for name in block.conditions.iter().filter(|name| !jod.contains_key(*name)) {
                    let rule = format!("jod gives no quality for condition {name} of block {id}");
                    fields.report("truth", rule);
                }
            }
            Some(Supposed { truth: Truth::Threshold { .. }, .. }) if block.psychometric.is_none() => {
                let rule =
                    format!("a threshold is of a block with levels and [blocks.psychometric]; {id} has none");
                fields.report("truth", rule);
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

fn truth(fields: &mut Fields<'_>, entry: usize) -> Option<Supposed> {
    let lapse = fields.may("lapse", "a share from 0 to 1", |v| number(v, 0.0, 1.0)).unwrap_or(0.0);
    let spread = |v: &Node| number(v, 0.0, 1e9);
    let given: Vec<&str> =
        ["preference", "jod", "threshold"].into_iter().filter(|key| fields.get(key).is_some()).collect();
    let truth = match given[..] {
        ["preference"] => preference(fields)?,
        ["jod"] => {
            let jod = fields.get("jod").and_then(|v| qualities(&v));
            let observer_sd = fields.may("observer_sd", "JOD from 0 to 1e9", spread).unwrap_or(0.0);
            Truth::Quality { jod: jod?, observer_sd }
        }
        ["threshold"] => {
            let threshold = fields.may("threshold", "a level within ±1e12", |v| number(v, -1e12, 1e12));
            let width =
                fields.must("width", "a number above 0 up to 1e9", |v| spread(v).filter(|x| *x > 0.0));
            let threshold_sd = fields.may("threshold_sd", "levels from 0 to 1e9", spread).unwrap_or(0.0);
            Truth::Threshold { threshold: threshold?, width: width?, threshold_sd }
        }
        _ => {
            fields.report("preference", "give one of preference, jod and threshold (with width)");
            return None;
        }
    };
    Some(Supposed { entry, truth, lapse })
}

fn preference(fields: &mut Fields<'_>) -> Option<Truth> {
    let probability = fields.may("preference", "a probability from 0 to 1", |v| number(v, 0.0, 1.0));
    let icc = fields.may("icc", "a number from 0 to 1", |v| number(v, 0.0, 1.0));
    let sd = fields.may("sd", "a standard deviation from 0 to 0.5", |v| number(v, 0.0, 0.5));
    let probability = probability?;
    let most = probability * (1.0 - probability);
    let icc = match (icc, sd) {
        (Some(_), Some(_)) => {
            fields.report("sd", "give icc or sd, not both");
            return None;
        }
        (None, Some(sd)) if sd * sd > most => {
            let rule = format!("must not exceed √(p(1 − p)) = {:.4}", most.sqrt());
            fields.reject("sd", &rule);
            return None;
        }
        (None, Some(sd)) if most > 0.0 => sd * sd / most,
        (icc, _) => icc.unwrap_or(0.0),
    };
    Some(Truth::Preference { probability, icc })
}

fn qualities(node: &Node) -> Option<BTreeMap<String, f64>> {
    let table = node.must("a table of condition = JOD", |v| v.as_entries())?;
    let rule = "a number of JOD from -100 to 100";
    let read: Vec<_> = table
        .iter()
        .map(|(name, v)| Some(((*name).to_owned(), v.must(rule, |v| number(v, -100.0, 100.0))?)))
        .collect();
    read.into_iter().collect()
}
