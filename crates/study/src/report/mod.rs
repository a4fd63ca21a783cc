//! The whole report of a study: the paper's tests, and beside them what the paper left out.

mod choices;
mod psychometric;

pub use choices::{ALPHA, ChoiceAnalysis, LEVEL, POWER_EFFECTS, Proportion, REPLICATES};
pub use psychometric::{
    CurvePoint, Goodness, LevelPoint, Parameter, PsychometricFit, PsychometricReport, ThresholdAt,
};

use crate::analysis::{Answer, BlockSummary, summarise};
use crate::definition::{GUESS, StudyDefinition};
use kelir_stats::inference::holm;
use kelir_stats::pairwise::{Choice, Observer, ScaleIntervals, ScaleOptions, observer_intervals};
use serde::Serialize;
use std::collections::{BTreeMap, HashMap};

/// One answer as the report reads it.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// Whose and what was chosen.
    pub answer: Answer<'a>,
    /// Whether the left picture was chosen.
    pub chose_left: bool,
    /// Response time in ms.
    pub rt_ms: f64,
}

/// A study judged.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Each block, in study order.
    pub blocks: Vec<BlockReport>,
    /// All conditions on one axis, in JOD, where the blocks join them; with an interval from resampled participants.
    pub scale: Option<ScaleIntervals>,
    /// Why there is no scale.
    pub scale_note: Option<String>,
    /// How the numbers were got, sentence by sentence, as a methods section says it.
    pub methods: Vec<String>,
}

/// A block judged.
#[derive(Clone, Debug, Serialize)]
pub struct BlockReport {
    /// Counts and the paper's test.
    #[serde(flatten)]
    pub summary: BlockSummary,
    /// p corrected by Holm's method for the number of blocks; null where p is.
    pub p_holm: Option<f64>,
    /// What is beside the paper's test.
    pub analysis: ChoiceAnalysis,
    /// Each pair alone, with all who answered it.
    pub by_pair: Vec<PairReport>,
    /// How the choices depend on the pairs' level; null where the study file asks for no psychometric function.
    pub psychometric: Option<PsychometricReport>,
    /// Choices of the left picture over all trials of the block: far from a half shows a bias of side.
    pub left: Option<Proportion>,
    /// Response times in ms; null without answers.
    pub rt_ms: Option<Quartiles>,
}

/// One pair of a block.
#[derive(Clone, Debug, Serialize)]
pub struct PairReport {
    /// Pair's id.
    pub id: String,
    /// Share of target choices; one trial a participant, so Wilson's interval is right. Null without answers.
    pub target: Option<Proportion>,
}

/// Quartiles by linear interpolation between order statistics (R's type 7).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
    /// Judges the answers to a study; those of excluded participants are to be left out by the caller. Resampling is seeded
    /// by the study's seed.
    pub fn of(study: &StudyDefinition, observations: &[Observation<'_>]) -> Report {
        let summaries = summarise(study, observations.iter().map(|o| o.answer));
        let defined: Vec<f64> = summaries.iter().filter_map(|s| s.p).collect();
        let mut corrected = holm(&defined).unwrap_or_default().into_iter();
        let mut by_block: HashMap<&str, Vec<&Observation<'_>>> = HashMap::new();
        for observation in observations {
            by_block.entry(observation.answer.block_id).or_default().push(observation);
        }
        let blocks = summaries
            .into_iter()
            .map(|summary| {
                let p_holm = summary.p.and_then(|_| corrected.next());
                let seen = by_block.get(summary.id.as_str()).map(Vec::as_slice).unwrap_or_default();
                block_report(study, summary, p_holm, seen)
            })
            .collect();
        let (scale, scale_note) = match scale(study, observations) {
            Ok(scale) => (Some(scale), None),
            Err(note) => (None, Some(note)),
        };
        Report { blocks, scale, scale_note, methods: methods(study) }
    }
}

fn block_report(
    study: &StudyDefinition,
    summary: BlockSummary,
    p_holm: Option<f64>,
    seen: &[&Observation<'_>],
) -> BlockReport {
    let analysis = ChoiceAnalysis::of_counts(&summary.counts, summary.pairs as u32, study.seed);
    let pairs = study.block(&summary.id).map(|block| block.pairs.as_slice()).unwrap_or_default();
    let by_pair = pairs
        .iter()
        .map(|pair| {
            let of_pair = seen.iter().filter(|o| o.answer.pair_id == pair.id);
            let (mut chosen, mut trials) = (0, 0);
            for observation in of_pair {
                trials += 1;
                chosen += u64::from(observation.answer.chosen_condition == summary.target);
            }
            PairReport { id: pair.id.clone(), target: Proportion::of(chosen, trials) }
        })
        .collect();
    let psychometric = study.block(&summary.id).and_then(|block| psychometric::of(block, seen, study.seed));
    let lefts = seen.iter().filter(|o| o.chose_left).count() as u64;
    BlockReport {
        p_holm,
        analysis,
        by_pair,
        psychometric,
        left: Proportion::of(lefts, seen.len() as u64),
        rt_ms: Quartiles::of(seen.iter().map(|o| o.rt_ms)),
        summary,
    }
}

impl Quartiles {
    /// Quartiles of finite values; `None` without any.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Quartiles> {
        let mut values: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let at = |q: f64| {
            let place = q * last as f64;
            let below = place.floor() as usize;
            let above = (below + 1).min(last);
            values[below] + (place - below as f64) * (values[above] - values[below])
        };
        Some(Quartiles { n: values.len() as u64, q1: at(0.25), median: at(0.5), q3: at(0.75) })
    }
}

/// The conditions' positions from all blocks but catch blocks. Blocks of stills and of animations are pooled: the scale is
/// of conditions, whatever is shown.
fn scale(study: &StudyDefinition, observations: &[Observation<'_>]) -> Result<ScaleIntervals, String> {
    let blocks: HashMap<&str, &[String; 2]> =
        study.blocks.iter().filter(|b| !b.catch).map(|b| (b.id.as_str(), &b.conditions)).collect();
    let mut names: Vec<String> = blocks.values().flat_map(|c| c.iter().cloned()).collect();
    names.sort();
    names.dedup();
    if names.len() < 3 {
        return Err("A scale needs three conditions; two are compared by their proportion.".to_owned());
    }
    let index: HashMap<&str, usize> = names.iter().enumerate().map(|(i, n)| (n.as_str(), i)).collect();
    let mut observers: BTreeMap<&str, BTreeMap<(usize, usize), u64>> = BTreeMap::new();
    for Observation { answer, .. } in observations {
        let Some([a, b]) = blocks.get(answer.block_id) else { continue };
        let (winner, loser) = if answer.chosen_condition == a {
            (a, b)
        } else if answer.chosen_condition == b {
            (b, a)
        } else {
            continue;
        };
        let choices = observers.entry(answer.session_id).or_default();
        *choices.entry((index[winner.as_str()], index[loser.as_str()])).or_default() += 1;
    }
    let observers: Vec<Observer> = observers
        .into_iter()
        .map(|(id, choices)| {
            let choice = |((winner, loser), times)| Choice { winner, loser, times };
            Observer { id: id.to_owned(), choices: choices.into_iter().map(choice).collect() }
        })
        .collect();
    let options = ScaleOptions::default();
    observer_intervals(&names, &observers, options, REPLICATES, LEVEL, study.seed)
        .map_err(|error| format!("No scale: {error}."))
}

fn methods(study: &StudyDefinition) -> Vec<String> {
    let mut methods = vec![
        format!(
            "Participants saw {} pairs of stimuli in {} blocks and were asked: \"{}\" They had to choose one of each pair.",
            study.trial_count(),
            study.blocks.len(),
            study.question
        ),
        "The order of pairs within a block was random; sides were balanced within participants and, over participants, pair by \
         pair (mirrored plans, allocated to the lowest slot that no completed or active session held)."
            .to_owned(),
        "Per block, the number of choices of the target condition by each participant who answered all its pairs was compared \
         with half the number of pairs by a two-tailed one-sample t-test; p-values are also given corrected for the number of blocks \
         by Holm's method."
            .to_owned(),
        format!(
            "Effect sizes are Cohen's d and Hedges' g with {:.0}% intervals from the noncentral t distribution; equivalence was tested by \
             two one-sided t-tests with bounds of ±0.5 choices and ±0.5 standard deviations; the Bayes factor is that of Jeffreys, Zellner and \
             Siow with a Cauchy prior of scale √2/2.",
            100.0 * LEVEL
        ),
        format!(
            "Choices of one participant are not independent: the interval of the overall proportion comes from {REPLICATES} resamples of \
             participants (percentile method, seed {}), with the intraclass correlation after Fleiss and Cuzick, a logistic regression with \
             cluster-robust standard errors (CR1), and one with a random intercept per participant (maximum likelihood).",
            study.seed
        ),
    ];
    if study.blocks.iter().any(|block| block.psychometric.is_some()) {
        methods.push(format!(
            "Psychometric functions have a guess rate of {GUESS} (two alternatives) and a lapse rate with the prior Beta(1, 10) where \
             the study file does not fix it; threshold (halfway between guessing and lapsing) and width (from 5% to 95%) are given where \
             the posterior under psignifit 4's priors is highest, with {:.0}% posterior intervals and beta-binomial overdispersion; the \
             threshold also by maximum likelihood with an interval from {REPLICATES} resamples of participants; goodness of fit is the \
             deviance against that of simulated observers.",
            100.0 * LEVEL
        ));
    }
    let rules = &study.screening;
    let mut excluded = Vec::new();
    if let Some(least) = rules.min_rt_ms {
        excluded.push(format!("with more than {} answers faster than {least} ms", rules.max_fast_trials));
    }
    if let Some(most) = rules.max_failed_catch_trials {
        excluded.push(format!("with more than {most} wrong answers in catch trials"));
    }
    if rules.straight_lining {
        excluded.push("who chose the same side in every trial".to_owned());
    }
    if rules.incomplete {
        excluded.push("who did not finish".to_owned());
    }
    methods.push(if excluded.is_empty() {
        "The study file states no rules of exclusion, and nobody was excluded.".to_owned()
    } else {
        let who = excluded.join("; ");
        format!("By rules stated in the study file before data were seen, participants were excluded {who}.")
    });
    methods
}

#[cfg(test)]
mod tests;
