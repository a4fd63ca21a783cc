//! Everything that is said of one table of choices: the paper's test, and what it leaves out.

use crate::analysis::TTest;
use kelir_stats::StatsError;
use kelir_stats::clustered::{
    Cluster, Correction, IccEstimator, Intraclass, MixedLogit, RobustLogit, Row, ShareInterval,
    independence_warning, intraclass, mixed_logit, robust_logit, share_interval,
};
use kelir_stats::inference::{
    BinomialTest, EffectSize, Interval, JzsBayesFactor, ORDINARY_PRIOR_SCALE, ShareEquivalence, SignedRank,
    TPlan, binomial_test, detectable_effect_t, effect_size, jzs_bayes_factor, power_t, share_equivalence,
    sign_test, t_test_from_counts, wilcoxon_signed_rank, wilson,
};
use serde::Serialize;
use std::collections::BTreeMap;
use utoipa::ToSchema;

/// Level of every interval.
pub const LEVEL: f64 = 0.95;
/// Level of every test that a power is worked out for.
pub const ALPHA: f64 = 0.05;
/// Resamples of a bootstrap.
pub const REPLICATES: usize = 2000;
/// The power that a detectable effect is worked out for.
pub const DETECTION_POWER: f64 = 0.8;
/// True effects, in standard deviations, that powers are worked out for.
pub const POWER_EFFECTS: [f64; 3] = [0.2, 0.5, 0.8];

/// Numbers of target choices per participant, judged.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct ChoiceAnalysis {
    /// The paper's two-tailed t-test against half the pairs.
    pub t_test: TTest,
    /// Cohen's d and Hedges' g with their intervals; null where t is not defined.
    pub effect: Option<EffectSize>,
    /// Two one-sided tests: is the share of target choices equivalent to ½, within the study file's bound? Null where it states none, or where t
    /// is not defined.
    pub equivalence: Option<ShareEquivalence>,
    /// Evidence for and against "no effect".
    pub bayes: Option<JzsBayesFactor>,
    /// Power of this test with as many participants, for true effects of [`POWER_EFFECTS`].
    pub power: Vec<TPlan>,
    /// The true effect that this test, with as many participants, finds with a probability of [`DETECTION_POWER`].
    pub detectable: Option<TPlan>,
    /// Exact sign test of the participants' numbers against half the items: the t-test's question without normality. Null
    /// when nobody's number differs from it.
    pub sign: Option<BinomialTest>,
    /// Wilcoxon's signed-rank test of the same numbers, ties exact; null likewise.
    pub wilcoxon: Option<SignedRank>,
    /// Exact binomial test of all choices against ½. It counts every choice as independent: right where each participant
    /// made one, else see the clustered results.
    pub binomial: Option<BinomialTest>,
    /// Target choices over all trials.
    pub proportion: Option<Proportion>,
    /// How alike one participant's choices are.
    pub intraclass: Option<Intraclass>,
    /// Logistic regression with standard errors from the participants (log odds of a target choice).
    pub robust_logit: Option<RobustLogit>,
    /// Logistic regression with a random intercept for each participant.
    pub mixed_logit: Option<MixedLogit>,
    /// What is not defined and why, and what a reader must not conclude.
    pub notes: Vec<String>,
}

/// A share of choices.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Proportion {
    /// Choices of the target.
    pub chosen: u64,
    /// Choices made.
    pub trials: u64,
    /// Participants who made them.
    pub participants: u64,
    /// chosen / trials.
    pub proportion: f64,
    /// Wilson's interval, which takes the choices as independent: right where each participant made one.
    pub wilson: Interval,
    /// The interval over participants, which a report shows; null where the choices give none.
    pub by_participant: Option<ShareInterval>,
    /// Why they give none.
    pub note: Option<String>,
}

impl Proportion {
    /// The share of target choices, one cluster a participant; `None` without choices.
    pub fn of(clusters: &[Cluster]) -> Option<Proportion> {
        let sum = |of: fn(&Cluster) -> u64| clusters.iter().map(of).sum::<u64>();
        let (chosen, trials) = (sum(|c| c.successes), sum(|c| c.trials));
        let mut notes = Vec::new();
        Some(Proportion {
            chosen,
            trials,
            participants: sum(|c| u64::from(c.trials > 0)),
            proportion: chosen as f64 / trials as f64,
            wilson: wilson(chosen, trials, LEVEL).ok()?,
            by_participant: keep("interval of the share", share_interval(clusters, LEVEL), &mut notes),
            note: notes.pop(),
        })
    }

    /// The interval that a report shows.
    pub fn interval(&self) -> Option<Interval> {
        self.by_participant.map(|ShareInterval { low, high, level, .. }| Interval { low, high, level })
    }
}

impl ChoiceAnalysis {
    /// Nothing, and why: of a block whose numbers of choices say nothing.
    pub(super) fn none(why: &Option<String>) -> ChoiceAnalysis {
        ChoiceAnalysis {
            t_test: TTest { note: why.clone(), ..TTest::default() },
            effect: None,
            equivalence: None,
            bayes: None,
            power: Vec::new(),
            detectable: None,
            sign: None,
            wilcoxon: None,
            binomial: None,
            proportion: None,
            intraclass: None,
            robust_logit: None,
            mixed_logit: None,
            notes: why.iter().cloned().collect(),
        }
    }

    /// Judges `counts`: number of target choices out of `items` → number of participants; `within`: how far from ½ a share may lie and still count
    /// as equivalent to it.
    pub fn of_counts(counts: &BTreeMap<u32, u64>, items: u32, within: Option<f64>) -> ChoiceAnalysis {
        let mu = f64::from(items) / 2.0;
        let t_test = TTest::of_counts(counts, mu);
        let mut notes = Vec::new();
        notes.extend(t_test.note.clone());
        let table: Vec<(f64, u64)> = counts.iter().map(|(x, k)| (f64::from(*x), *k)).collect();
        let judged = t_test_from_counts(&table, mu).ok();
        let mut effect = None;
        let mut bayes = None;
        let (mut equivalence, mut power, mut detectable) = (None, Vec::new(), None);
        if let Some(test) = &judged {
            effect = keep("effect size", effect_size(test, LEVEL), &mut notes);
            bayes = keep("Bayes factor", jzs_bayes_factor(test, ORDINARY_PRIOR_SCALE), &mut notes);
            equivalence = within.and_then(|within| {
                keep("test of equivalence", share_equivalence(test, items, within), &mut notes)
            });
            let powers = POWER_EFFECTS.iter().map(|d| power_t(test.n, *d, ALPHA));
            power = powers.filter_map(Result::ok).collect();
            detectable =
                keep("detectable effect", detectable_effect_t(test.n, ALPHA, DETECTION_POWER), &mut notes);
            if test.p >= ALPHA && equivalence.is_none_or(|e| e.tests.p >= ALPHA) {
                let line = match equivalence {
                    Some(_) => {
                        "A difference that is not significant is not shown to be absent: see the test of equivalence and the Bayes factor."
                    }
                    None => {
                        "A difference that is not significant is not shown to be absent: see the Bayes factor. The study file states no bound \
                             within which a share would count as equivalent to a half."
                    }
                };
                notes.push(line.to_owned());
            }
        }
        let clusters: Vec<Cluster> = counts
            .iter()
            .flat_map(|(successes, people)| {
                let cluster = Cluster { successes: u64::from(*successes), trials: u64::from(items) };
                std::iter::repeat_n(cluster, usize::try_from(*people).unwrap_or_default())
            })
            .collect();
        let numbers: Vec<f64> = clusters.iter().map(|c| c.successes as f64).collect();
        // Both leave out who is at half the pairs; with nobody else there is nothing to test, which t's note has said.
        let sign = sign_test(&numbers, mu).ok();
        let wilcoxon = wilcoxon_signed_rank(&numbers, mu).ok();
        let proportion = Proportion::of(&clusters);
        notes.extend(proportion.as_ref().and_then(|p| p.note.clone()));
        let binomial = proportion.as_ref().and_then(|p| binomial_test(p.chosen, p.trials, 0.5).ok());
        let several = items > 1 && clusters.len() > 1;
        let mut intraclass_found = None;
        let (mut robust, mut mixed) = (None, None);
        if clusters.len() > 1 {
            let rows = Row::intercept_only(&clusters);
            robust = keep("robust logit", robust_logit(&rows, Correction::Cr1), &mut notes);
            if several {
                let icc = intraclass(&clusters, IccEstimator::FleissCuzick);
                intraclass_found = keep("intraclass correlation", icc, &mut notes);
                mixed = keep("random-intercept logit", mixed_logit(&rows), &mut notes);
                notes.extend(independence_warning(&clusters).ok().flatten().map(|warning| {
                    format!(
                        "The binomial test and Wilson's interval of all choices are per-trial ones. {}",
                        warning.message
                    )
                }));
            }
        }
        ChoiceAnalysis {
            t_test,
            effect,
            equivalence,
            bayes,
            power,
            detectable,
            sign,
            wilcoxon,
            binomial,
            proportion,
            intraclass: intraclass_found,
            robust_logit: robust,
            mixed_logit: mixed,
            notes,
        }
    }
}

/// What came out, or `None` and a note that says why not.
pub(super) fn keep<T>(what: &str, result: Result<T, StatsError>, notes: &mut Vec<String>) -> Option<T> {
    result.map_err(|error| notes.push(format!("No {what}: {error}."))).ok()
}
