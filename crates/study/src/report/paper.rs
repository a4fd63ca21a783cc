//! Taylor & Cameron's survey, judged again from the counts behind its summaries.
//!
//! The abstract prints mean, standard deviation and t of three blocks of 32 participants. The counts (12, 14, 6) and (3, 10, 19)
//! of 0, 1 and 2 choices give the first two exactly; the third summary (0.212, 0.415) is that of 7 choices among 33, whose t is not the
//! one printed.

use super::choices::ChoiceAnalysis;
use crate::analysis::TTest;
use kelir_stats::inference::holm;
use serde::Serialize;
use std::collections::BTreeMap;

/// The paper's three tests and what it left out.
#[derive(Clone, Debug, Serialize)]
pub struct PaperReport {
    /// Where the printed numbers stand.
    pub source: &'static str,
    /// The three blocks.
    pub blocks: Vec<PaperBlock>,
}

/// One block of the paper.
#[derive(Clone, Debug, Serialize)]
pub struct PaperBlock {
    /// What was compared.
    pub title: &'static str,
    /// Number of pairs.
    pub pairs: u32,
    /// Reconstructed: number of choices of the fast method → participants.
    pub counts: BTreeMap<u32, u64>,
    /// The mean as printed.
    pub printed_mean: f64,
    /// The standard deviation as printed.
    pub printed_sd: f64,
    /// The t as printed.
    pub printed_t: f64,
    /// Whether the counts give the printed numbers when rounded like them: mean, sd, t.
    pub agrees: [bool; 3],
    /// p corrected by Holm's method for the three tests.
    pub p_holm: Option<f64>,
    /// Everything said of the counts.
    pub analysis: ChoiceAnalysis,
    /// What does not fit.
    pub remarks: Vec<String>,
}

/// (title, pairs, counts, printed mean, sd, t)
type Printed = (&'static str, u32, &'static [u64], f64, f64, f64);
const PRINTED: [Printed; 3] = [
    ("Fast method against reference, two pairs of stills", 2, &[12, 14, 6], 0.813, 0.738, -1.438),
    ("Photograph against fast method, two pairs of stills", 2, &[3, 10, 19], 1.5, 0.672, 4.209),
    ("Fast method against reference, one pair of animations", 1, &[26, 7], 0.212, 0.415, -3.293),
];

/// Judges the paper's three blocks from their counts.
pub fn taylor_cameron() -> PaperReport {
    let mut blocks: Vec<PaperBlock> = PRINTED.iter().map(block).collect();
    let p: Vec<f64> = blocks.iter().filter_map(|b| b.analysis.t_test.p).collect();
    let corrected = holm(&p).unwrap_or_default();
    for (block, p) in blocks.iter_mut().zip(corrected) {
        block.p_holm = Some(p);
    }
    let source = "Taylor & Cameron, Shadow puppets (abstract): x̄, σ and t of three two-tailed t-tests";
    PaperReport { source, blocks }
}

fn block(&(title, pairs, table, printed_mean, printed_sd, printed_t): &Printed) -> PaperBlock {
    let counts: BTreeMap<u32, u64> = (0..).zip(table.iter().copied()).collect();
    let analysis = ChoiceAnalysis::of_counts(&counts, pairs, 1);
    let test = &analysis.t_test;
    let agrees = [(test.mean, printed_mean), (test.sd, printed_sd), (test.t, printed_t)]
        .map(|(ours, printed)| ours.is_some_and(|ours| rounds_to(ours, printed)));
    let mut remarks = Vec::new();
    if !agrees[2] {
        let t = test.t.unwrap_or(f64::NAN);
        let mut remark = format!(
            "The printed t = {printed_t} does not follow from the printed mean and standard deviation: {} of {} choices give t = {t:.6}.",
            table.get(1).copied().unwrap_or_default(),
            test.n
        );
        let giving = people_giving(printed_t, 25..=40);
        if pairs == 1 && giving.is_empty() {
            remark.push_str(" No whole number of participants from 25 to 40 gives it, whatever they chose.");
        }
        remarks.push(remark);
    }
    PaperBlock {
        title,
        pairs,
        counts,
        printed_mean,
        printed_sd,
        printed_t,
        agrees,
        p_holm: None,
        analysis,
        remarks,
    }
}

/// (participants, choices) of one pair whose t against ½ is `t` to the three decimals printed.
fn people_giving(t: f64, participants: std::ops::RangeInclusive<u64>) -> Vec<(u64, u64)> {
    let all = participants.flat_map(|n| (0..=n).map(move |k| (n, k)));
    all.filter(|(n, k)| {
        TTest::of_counts(&[(0, n - k), (1, *k)].into(), 0.5).t.is_some_and(|ours| rounds_to(ours, t))
    })
    .collect()
}

/// Whether a number printed with three decimals may stand for `ours`; a last 5 may have been rounded either way.
fn rounds_to(ours: f64, printed: f64) -> bool {
    (ours - printed).abs() <= 0.0005 + 1e-12
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use kelir_stats::inference::Bounds;

    #[test]
    fn the_papers_tests_come_out_as_the_issue_says() {
        let report = taylor_cameron();
        let expected = [(-1.437_591, 0.160_569), (4.208_834, 2.037_82e-4), (-3.983_482, 3.668_64e-4)];
        for (block, (t, p)) in report.blocks.iter().zip(expected) {
            let test = &block.analysis.t_test;
            assert!(
                (test.t.unwrap() / t - 1.0).abs() < 1e-6 && (test.p.unwrap() / p - 1.0).abs() < 1e-5,
                "{test:?}"
            );
        }
        let agrees: Vec<_> = report.blocks.iter().map(|b| b.agrees).collect();
        assert_eq!(agrees, [[true; 3], [true; 3], [true, true, false]]);
        assert!(report.blocks[2].remarks[0].contains("No whole number of participants"));
        // Negative control: the search finds what there is.
        assert_eq!(people_giving(-3.983, 33..=33), [(33, 7)]);
    }

    #[test]
    fn what_the_paper_left_out_comes_out_as_the_issue_says() {
        let first = &taylor_cameron().blocks[0].analysis;
        let p_of = |bounds: Bounds| first.equivalence.iter().find(|e| e.bounds == bounds).unwrap().p;
        assert!((p_of(Bounds::Points(0.5)) - 0.0114).abs() < 5e-5);
        assert!((p_of(Bounds::Sd(0.5)) - 0.087).abs() < 5e-4);
        assert!((first.bayes.unwrap().bf01 - 2.1).abs() < 0.05);
        let effect = first.effect.unwrap();
        for (ours, printed) in
            [(effect.g, -0.248), (effect.g_interval.low, -0.590), (effect.g_interval.high, 0.098)]
        {
            assert!((ours - printed).abs() < 5.1e-4, "{ours} is not {printed}");
        }
        assert_eq!(first.power.len(), 3);
        assert!((first.intraclass.as_ref().unwrap().icc - 0.093).abs() < 5e-4);
        assert!((taylor_cameron().blocks[1].analysis.intraclass.as_ref().unwrap().icc - 0.167).abs() < 5e-4);
        assert!(first.notes.iter().any(|n| n.contains("not shown to be absent")), "{:?}", first.notes);
    }
}
