//! The whole report of a study: the paper's tests, and beside them what the paper left out.

mod choices;
mod methods;
mod order;
mod pairs;
mod primary;
mod psychometric;
mod scaling;
mod words;

pub use choices::{ALPHA, ChoiceAnalysis, DETECTION_POWER, LEVEL, POWER_EFFECTS, Proportion, REPLICATES};
pub use order::{BlockOrder, FENCES, FirstTest, Leaning, OrderReport, Outliers};
pub use pairs::PairsReport;
pub use primary::PrimaryReport;
pub use psychometric::{
    CurvePoint, Goodness, LevelPoint, Parameter, PsychometricFit, PsychometricReport, ThresholdAt,
};
pub use scaling::{Consistency, Triads};

use crate::analysis::{BlockSummary, summarise};
use crate::answers::{Given, Participant, blocks};
use crate::definition::{Block, StudyDefinition};
use crate::trials::Role;
use kelir_stats::clustered::{Cluster, IccEstimator, Intraclass, intraclass};
use kelir_stats::inference::holm;
use kelir_stats::pairwise::ScaleIntervals;
use serde::Serialize;
use std::ops::Range;
use utoipa::ToSchema;

/// A study judged.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Report {
    /// What came of the primary endpoint; null where the study file names none.
    pub primary: Option<PrimaryReport>,
    /// Each block, in study order.
    pub blocks: Vec<BlockReport>,
    /// All conditions on one axis, in JOD, where the blocks join them; with intervals and tests over participants.
    pub scale: Option<ScaleIntervals>,
    /// What was shown in the choices that a scale takes together.
    pub scale_pools: String,
    /// Why there is no scale.
    pub scale_note: Option<String>,
    /// How far observers contradict that scale and themselves; null without one.
    pub consistency: Option<Consistency>,
    /// Sides, order and speed; null without answers.
    pub order: Option<OrderReport>,
    /// How the numbers that are there were got, paragraph by paragraph, as a methods section says it.
    pub methods: Vec<String>,
    /// What to cite for the methods that were used, in order of appearance.
    pub references: Vec<String>,
}

/// A block judged.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct BlockReport {
    /// Counts and the paper's test.
    #[serde(flatten)]
    pub summary: BlockSummary,
    /// Whether its t-test was planned: of an adaptive block it never is, of one with a psychometric function where the file says so.
    pub planned: bool,
    /// Whether that test is the primary endpoint.
    pub primary: bool,
    /// p corrected by Holm's method for all planned tests but the primary endpoint, those that are not defined among them; of the primary endpoint
    /// p itself; null where p is, and of a test that was not planned.
    pub p_holm: Option<f64>,
    /// What is beside the paper's test.
    pub analysis: ChoiceAnalysis,
    /// Each item alone, with all who answered it; empty for an adaptive block, which shows one item many times.
    pub by_item: Vec<ItemReport>,
    /// Whether the pairs differ, and what holds of others; null with one pair, with levels, and where a procedure chose.
    pub pairs: Option<PairsReport>,
    /// How the choices depend on the pairs' level; null where the study file asks for no psychometric function.
    pub psychometric: Option<PsychometricReport>,
    /// The role that stands first: left, or the first interval.
    pub first_role: Role,
    /// Choices of what stood first, over all trials of the block: far from a half shows a bias of side, or of order.
    pub first: Option<Proportion>,
    /// How alike one participant's choices of what stood first are: above 0, some lean to one side and some to the other, which cancels in the share.
    /// Null where nobody answered twice, or all chose one side.
    pub first_intraclass: Option<Intraclass>,
    /// Response times in ms; null without answers.
    pub rt_ms: Option<Quartiles>,
    /// Their 1st to 99th percentile, interpolated likewise; empty without answers.
    pub rt_percentiles_ms: Vec<f64>,
}

/// One pair of a block.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct ItemReport {
    /// Item's id.
    pub id: String,
    /// Share of target choices, by everybody who answered it. Null without answers.
    pub target: Option<Proportion>,
}

/// Quartiles by linear interpolation between order statistics (R's type 7).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Quartiles {
    /// Number of values.
    pub n: u64,
    /// First quartile.
    pub q1: f64,
    /// Median.
    pub median: f64,
    /// Third quartile.
    pub q3: f64,
}

impl Report {
    /// Judges the answers to a study; excluded participants are to be left out by the caller. Resampling is seeded by the
    /// study's seed.
    pub fn of(study: &StudyDefinition, participants: &[&Participant]) -> Report {
        let mut report = Report::claims(study, participants);
        let analysed = blocks(study).filter(|(block, _)| !block.catch);
        for (judged, (block, places)) in report.blocks.iter_mut().zip(analysed) {
            let seen: Vec<&[Given]> = participants.iter().map(|p| p.answers_to(&places)).collect();
            judged.pairs = pairs::of(block, &places, &seen, study.seed);
        }
        report.order = order::of(study, participants);
        (report.methods, report.references) = methods::of(study, &report);
        report
    }

    /// What a study is planned for, without what is only there to look at: the same numbers, sooner.
    pub(crate) fn claims(study: &StudyDefinition, participants: &[&Participant]) -> Report {
        let summaries = summarise(study, participants);
        let analysed = || blocks(study).filter(|(block, _)| !block.catch);
        // What was planned is tested whether or not its t came out defined: an undefined one rejects nothing, and counts.
        let planned: Vec<f64> = analysed()
            .zip(&summaries)
            .filter(|((block, _), _)| block.plans_t_test() && !study.is_primary_t_test(block))
            .map(|(_, summary)| summary.p.unwrap_or(1.0))
            .collect();
        let mut corrected = holm(&planned).unwrap_or_default().into_iter();
        let blocks = analysed()
            .zip(summaries)
            .map(|((block, items), summary)| {
                let p_holm = match block.plans_t_test() {
                    // One test is a family of its own.
                    true if study.is_primary_t_test(block) => summary.p,
                    true => corrected.next().and_then(|p| summary.p.and(Some(p))),
                    false => None,
                };
                block_report(study, block, &items, summary, p_holm, participants)
            })
            .collect();
        let (scale, consistency, scale_note) = match scaling::scale(study, participants) {
            Ok((scale, consistency)) => (Some(scale), Some(consistency), None),
            Err(note) => (None, None, Some(note)),
        };
        let mut report = Report {
            primary: None,
            blocks,
            scale,
            scale_pools: scaling::pooled(study),
            scale_note,
            consistency,
            order: None,
            methods: Vec::new(),
            references: Vec::new(),
        };
        report.primary = study.primary.as_ref().map(|named| primary::of(named, &report));
        report
    }
}

fn block_report(
    study: &StudyDefinition,
    block: &Block,
    places: &Range<u32>,
    summary: BlockSummary,
    p_holm: Option<f64>,
    participants: &[&Participant],
) -> BlockReport {
    let analysis = match block.adaptive {
        None => {
            let within = study.equivalence.as_ref().map(|bound| bound.within);
            ChoiceAnalysis::of_counts(&summary.counts, summary.items as u32, within)
        }
        Some(_) => ChoiceAnalysis::none(&summary.note),
    };
    let seen: Vec<&[Given]> = participants.iter().map(|p| p.answers_to(places)).collect();
    let given = || seen.iter().copied().flatten();
    // One trial a participant and item, but in adaptive blocks.
    let mut of_item = vec![Vec::new(); block.items.len()];
    for answer in given() {
        let cluster = Cluster { successes: u64::from(answer.chose_target), trials: 1 };
        of_item[(answer.item - places.start) as usize].push(cluster);
    }
    let by_item = block
        .items
        .iter()
        .zip(&of_item)
        .filter(|_| block.adaptive.is_none())
        .map(|(pair, clusters)| ItemReport { id: pair.id.clone(), target: Proportion::of(clusters) })
        .collect();
    let psychometric = psychometric::of(block, places, &seen, study.seed);
    let mut times: Vec<f64> = given().map(|answer| answer.rt_ms).filter(|ms| ms.is_finite()).collect();
    times.sort_by(f64::total_cmp);
    let firsts: Vec<Cluster> = seen.iter().map(|answers| firsts(answers)).collect();
    BlockReport {
        planned: block.plans_t_test(),
        primary: study.is_primary_t_test(block),
        p_holm,
        analysis,
        by_item,
        pairs: None,
        psychometric,
        first_role: block.trial.rules().roles()[0],
        first: Proportion::of(&firsts),
        first_intraclass: intraclass(&firsts, IccEstimator::FleissCuzick).ok(),
        rt_ms: Quartiles::of_sorted(&times),
        rt_percentiles_ms: (1..100).filter_map(|p| quantile(&times, f64::from(p) / 100.0)).collect(),
        summary,
    }
}

/// One participant's choices of what stood first.
fn firsts(answers: &[Given]) -> Cluster {
    let chosen = answers.iter().filter(|answer| answer.chose_first).count();
    Cluster { successes: chosen as u64, trials: answers.len() as u64 }
}

impl Quartiles {
    /// Quartiles of finite values in rising order; `None` without any.
    fn of_sorted(values: &[f64]) -> Option<Quartiles> {
        let at = |q| quantile(values, q);
        Some(Quartiles { n: values.len() as u64, q1: at(0.25)?, median: at(0.5)?, q3: at(0.75)? })
    }
}

/// The q-quantile of values in rising order, by R's type 7; `None` without any.
fn quantile(values: &[f64], q: f64) -> Option<f64> {
    let last = values.len().checked_sub(1)?;
    let place = q * last as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(last);
    Some(values[below] + (place - below as f64) * (values[above] - values[below]))
}

#[cfg(test)]
mod tests;
