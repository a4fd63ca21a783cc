//! What a report claims, and what is true.

use super::crowd::chances;
use super::design::{Design, Truth};
use crate::answers::{blocks, compares, conditions};
use crate::definition::Item;
use crate::primary::{PrimaryEndpoint, PrimaryTest};
use crate::report::{ChoiceAnalysis, Report};
use kelir_stats::pairwise::{ScaleOptions, Wins, scale};

/// Everything that a report of the design's study may claim, in an order that every report keeps.
pub(super) struct Claims {
    pub(super) tests: Vec<TestClaim>,
    pub(super) intervals: Vec<IntervalClaim>,
    /// Whether the first test is the primary endpoint.
    primary: bool,
    /// Of each analysed block, whether a procedure steers its choices.
    steered: Vec<bool>,
    differences: usize,
}

/// One test.
pub(super) struct TestClaim {
    pub(super) of: String,
    pub(super) test: &'static str,
    pub(super) primary: bool,
    pub(super) null: bool,
}

/// One interval.
pub(super) struct IntervalClaim {
    pub(super) of: String,
    pub(super) interval: &'static str,
    pub(super) truth: Option<f64>,
}

/// What one report claims, in the order of [`Claims`].
pub(super) struct Outcome {
    /// Whether each test is significant; `None`: not defined.
    pub(super) tests: Vec<Option<bool>>,
    /// Each interval.
    pub(super) intervals: Vec<Option<[f64; 2]>>,
}

/// The p-value of a test; `None` where it is not defined.
type PValue = fn(&ChoiceAnalysis) -> Option<f64>;

/// A block's tests but Holm's. That of equivalence asks for the opposite of the others.
const TESTS: [(&str, PValue); 7] = [
    ("t-test of participants' counts (the paper's)", |a| a.t_test.p),
    (SECOND, |a| a.sign.as_ref().map(|t| t.p)),
    ("Wilcoxon test of the counts", |a| a.wilcoxon.as_ref().map(|t| t.p)),
    ("cluster-robust logit", |a| a.robust_logit.as_ref().map(|l| l.coefficients[0].p)),
    ("random-intercept logit", |a| a.mixed_logit.as_ref().map(|l| l.coefficients[0].p)),
    (PER_TRIAL, |a| a.binomial.as_ref().map(|t| t.p)),
    (EQUIVALENCE, |a| a.equivalence.map(|e| e.tests.p)),
];

/// The test that no clustered data should be judged by; right where each participant makes one choice.
pub(super) const PER_TRIAL: &str = "binomial test of all choices, ignoring who made them";
const SECOND: &str = "sign test of the counts";
/// Beside a t-test of Holm's family, before [`SECOND`].
const HOLM: &str = "t-test, Holm over blocks";
const EQUIVALENCE: &str = "equivalence within the study's bound";
const SCALE: &str = "difference on the scale";

impl Claims {
    pub(super) fn new(design: &Design) -> Claims {
        let (mut tests, mut intervals) = (Vec::new(), Vec::new());
        let analysed: Vec<usize> =
            (0..design.study.blocks.len()).filter(|&b| !design.study.blocks[b].catch).collect();
        let differences = true_differences(design);
        if let Some(named) = &design.study.primary {
            tests.push(TestClaim {
                of: named.subject(),
                test: named.test.in_words(),
                primary: true,
                null: asks_for_nothing(design, named, &differences),
            });
        }
        for &b in &analysed {
            let block = &design.study.blocks[b];
            let mean = chances(design, b).map_or(f64::NAN, |chances| chances.iter().sum());
            let share = Some(mean / block.items.len() as f64).filter(|share| share.is_finite());
            let of = || block.id.clone();
            for (test, _) in TESTS {
                let null = match test {
                    EQUIVALENCE => !is_equivalent(design, b),
                    _ => is_even(design, b),
                };
                if test == SECOND && !design.study.is_primary_t_test(block) {
                    tests.push(TestClaim { of: of(), test: HOLM, primary: false, null });
                }
                // With one choice a participant there is nobody to ignore.
                let test = if test == PER_TRIAL && block.items.len() == 1 { "binomial test" } else { test };
                tests.push(TestClaim { of: of(), test, primary: false, null });
            }
            let threshold = match design.truths[b].as_ref().map(|t| &t.truth) {
                Some(Truth::Threshold { threshold, .. }) => Some(*threshold),
                _ => None,
            };
            for (interval, truth) in [
                ("share of target choices, over participants", share),
                ("share of target choices, ignoring who made them (Wilson)", share),
                ("threshold, posterior", threshold),
                ("threshold, participants resampled", threshold),
            ] {
                let there = match interval.starts_with("threshold") {
                    true => block.psychometric.is_some(),
                    // A procedure steers the share.
                    false => block.adaptive.is_none(),
                };
                if there {
                    intervals.push(IntervalClaim { of: of(), interval, truth });
                }
            }
        }
        for (a, b, truth) in &differences {
            let of = format!("{a} − {b}");
            let null = is_no_difference(*truth);
            tests.push(TestClaim { of: of.clone(), test: SCALE, primary: false, null });
            intervals.push(IntervalClaim {
                of,
                interval: "difference in JOD, over participants",
                truth: *truth,
            });
        }
        let steered = analysed.iter().map(|&b| design.study.blocks[b].adaptive.is_some()).collect();
        let primary = design.study.primary.is_some();
        Claims { tests, intervals, primary, steered, differences: differences.len() }
    }

    /// What a report claims at the level `alpha`.
    pub(super) fn check(&self, report: &Report, alpha: f64) -> Outcome {
        let (mut tests, mut intervals) = (Vec::new(), Vec::new());
        debug_assert_eq!(report.blocks.len(), self.steered.len());
        if self.primary {
            tests.push(report.primary.as_ref().and_then(|primary| primary.p).map(|p| p < alpha));
        }
        for (block, steered) in report.blocks.iter().zip(&self.steered) {
            let analysis = &block.analysis;
            for (test, p) in TESTS {
                if test == SECOND && !block.primary {
                    tests.push(block.p_holm.map(|p| p < alpha));
                }
                tests.push(p(analysis).map(|p| p < alpha));
            }
            let proportion = analysis.proportion.as_ref();
            if !steered {
                let over_participants = proportion.and_then(|p| p.interval());
                intervals.push(over_participants.map(|i| [i.low, i.high]));
                intervals.push(proportion.map(|p| [p.wilson.low, p.wilson.high]));
            }
            if let Some(psychometric) = &block.psychometric {
                let fit = psychometric.fit.as_ref();
                intervals.push(fit.map(|f| [f.threshold.low, f.threshold.high]));
                let resampled = fit.and_then(|f| f.threshold_by_participant.as_ref());
                intervals.push(resampled.map(|found| [found.bootstrap.low, found.bootstrap.high]));
            }
        }
        for i in 0..self.differences {
            let found = report.scale.as_ref().and_then(|scale| scale.differences.get(i));
            tests.push(found.map(|d| d.p < alpha));
            intervals.push(found.and_then(|d| Some([d.low?, d.high?])));
        }
        Outcome { tests, intervals }
    }
}

/// Whether the observers of a block choose its target as often as not.
fn is_even(design: &Design, block: usize) -> bool {
    let mean = chances(design, block).map_or(f64::NAN, |chances| chances.iter().sum());
    (mean - design.study.blocks[block].mu()).abs() < 1e-12
}

/// Whether they do so within the study's bound. What is equal is equivalent: there the tests of it have power.
fn is_equivalent(design: &Design, block: usize) -> bool {
    let of = &design.study.blocks[block];
    let mean = chances(design, block).map_or(f64::NAN, |chances| chances.iter().sum());
    let bound = design.study.equivalence.as_ref();
    bound.is_some_and(|bound| (mean - of.mu()).abs() < bound.within * of.items.len() as f64)
}

/// Whether a true difference on the scale is none.
fn is_no_difference(truth: Option<f64>) -> bool {
    truth.is_some_and(|d| d.abs() < 1e-6)
}

/// Whether what the primary endpoint looks for is not there.
fn asks_for_nothing(
    design: &Design,
    named: &PrimaryEndpoint,
    differences: &[(String, String, Option<f64>)],
) -> bool {
    let block = design.study.blocks.iter().position(|block| named.block.as_ref() == Some(&block.id));
    match (named.test, block) {
        (PrimaryTest::Scale, _) => {
            let compares =
                |name: &String| named.compare.as_ref().is_some_and(|compared| compared.contains(name));
            let found = differences.iter().find(|(a, b, _)| compares(a) && compares(b));
            is_no_difference(found.and_then(|(_, _, truth)| *truth))
        }
        (PrimaryTest::Binomial, Some(b)) => {
            let is_it = |item: &Item| named.item.as_ref() == Some(&item.id);
            let item = design.study.blocks[b].items.iter().position(is_it);
            let chance = item.and_then(|item| chances(design, b)?.get(item).copied());
            chance.is_some_and(|chance| (chance - 0.5).abs() < 1e-12)
        }
        (PrimaryTest::Equivalence, Some(b)) => !is_equivalent(design, b),
        (_, block) => block.is_some_and(|b| is_even(design, b)),
    }
}

/// The differences of all conditions on the scale that endless answers would give, in the order of a report's; none without a scale.
fn true_differences(design: &Design) -> Vec<(String, String, Option<f64>)> {
    // Endless: shares are then known to nine digits.
    const ENDLESS: f64 = 1e9;
    let study = &design.study;
    let compared = || blocks(study).enumerate().filter(|(_, (block, _))| compares(block));
    let names = conditions(study);
    if names.len() < 3 {
        return Vec::new();
    }
    let wins = || {
        let mut wins = Wins::new(names.len());
        for (b, (block, _)) in compared() {
            let place = |name: &str| names.iter().position(|known| known == name);
            let (target, other) = (place(&block.target)?, place(block.other())?);
            for chance in chances(design, b)? {
                if !(1e-6..=1.0 - 1e-6).contains(&chance) {
                    return None;
                }
                let hits = (ENDLESS * chance).round();
                wins.add(target, other, hits as u64).ok()?;
                wins.add(other, target, (ENDLESS - hits) as u64).ok()?;
            }
        }
        scale(&names, &wins, ScaleOptions::default()).ok()
    };
    let jod = wins().map(|scale| scale.jod);
    let mut differences = Vec::new();
    for a in 0..names.len() {
        for b in a + 1..names.len() {
            let truth = jod.as_ref().map(|jod| jod[a] - jod[b]);
            differences.push((names[a].clone(), names[b].clone(), truth));
        }
    }
    differences
}
