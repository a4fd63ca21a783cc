//! What intervals and tests over participants promise, held to exact enumeration where there is one and to simulation elsewhere.
#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use kelir_stats::clustered::{Cluster, ShareMethod, share_interval};
use kelir_stats::inference::{clopper_pearson, wilson};
use kelir_stats::pairwise::{Choice, Model, Observer, ScaleIntervals, ScaleOptions, observer_intervals};
use kelir_stats::psychometric::{Level, Task, fit, resampled_threshold};
use kelir_stats::random::Random;
use kelir_stats::simulate::{CELLS, Coverage, Rate, Shown, coverage, shortfalls};

/// P(k of `pairs`) for choices of mean `p` and intraclass correlation `icc`: the beta-binomial by Pólya's urn.
fn urn(pairs: usize, p: f64, icc: f64) -> Vec<f64> {
    let theta = icc / (1.0 - icc);
    let rising = |c: f64, k: usize| (0..k).map(|j| c + j as f64 * theta).product::<f64>();
    let choose = |k: usize| (0..k).map(|j| (pairs - j) as f64 / (k - j) as f64).product::<f64>();
    (0..=pairs).map(|k| choose(k) * rising(p, k) * rising(1.0 - p, pairs - k) / rising(1.0, pairs)).collect()
}

/// Every table of `n` participants over the numbers 0 … `kinds` − 1, with its probability when each number has the given one.
fn tables(n: u64, of: &[f64], mut seen: impl FnMut(&[u64], f64)) {
    fn walk(
        left: u64,
        at: usize,
        of: &[f64],
        p: f64,
        counts: &mut Vec<u64>,
        seen: &mut impl FnMut(&[u64], f64),
    ) {
        if at + 1 == of.len() {
            counts.push(left);
            seen(counts, p * of[at].powi(left as i32));
            counts.pop();
            return;
        }
        let mut ways = 1.0;
        for k in 0..=left {
            counts.push(k);
            walk(left - k, at + 1, of, p * ways * of[at].powi(k as i32), counts, seen);
            counts.pop();
            ways *= (left - k) as f64 / (k + 1) as f64;
        }
    }
    walk(n, 0, of, 1.0, &mut Vec::new(), &mut seen);
}

/// Exact coverage of the 95% interval of a share.
fn share_coverage(n: u64, pairs: usize, p: f64, icc: f64) -> f64 {
    let mut covered = 0.0;
    tables(n, &urn(pairs, p, icc), |counts, probability| {
        let found = share_interval(&Cluster::from_counts(counts), 0.95).unwrap();
        if found.low <= p && p <= found.high {
            covered += probability;
        }
    });
    covered
}

#[test]
fn intervals_of_a_share_cover() {
    let total: f64 = {
        let mut sum = 0.0;
        tables(6, &urn(3, 0.8, 0.3), |_, probability| sum += probability);
        sum
    };
    assert!((total - 1.0).abs() < 1e-12, "the enumeration is of everything: {total}");
    let (mut sum, mut cells) = (0.0, 0.0);
    for (n, pairs) in [(6, 2), (6, 4), (12, 2), (12, 4), (20, 3), (32, 1), (32, 2), (40, 2)] {
        for p in [0.5, 0.6, 0.75, 0.9, 0.95] {
            for icc in [0.0, 0.1, 0.3, 0.6] {
                let coverage = share_coverage(n, pairs, p, icc);
                let least = if n < 12 { 0.88 } else { 0.92 };
                assert!(coverage >= least, "n = {n}, {pairs} pairs, p = {p}, icc = {icc}: {coverage}");
                (sum, cells) = (sum + coverage, cells + 1.0);
            }
        }
    }
    assert!(sum / cells >= 0.94, "on average {}", sum / cells);
}

#[test]
fn an_interval_of_a_share_is_what_its_method_says() {
    let of = |counts: &[u64]| share_interval(&Cluster::from_counts(counts), 0.95).unwrap();
    // Six of six at least as often as in one of forty samples: .025^(1/6).
    let unanimous = of(&[0, 0, 6]);
    assert_eq!((unanimous.method, unanimous.high), (ShareMethod::ClopperPearson, 1.0));
    assert!((unanimous.low - 0.025f64.powf(1.0 / 6.0)).abs() < 1e-14, "{unanimous:?}");
    assert_eq!(unanimous.low, clopper_pearson(6, 6, 0.95).unwrap().low);
    // One choice each: choices are participants.
    let single = of(&[7, 13]);
    assert_eq!(
        (single.low, single.high),
        (wilson(13, 20, 0.95).unwrap().low, wilson(13, 20, 0.95).unwrap().high)
    );
    // Who never contradicts themselves counts once, however often they were asked; statsmodels 0.14, proportion_confint(13, 20, method = "wilson").
    let consistent = share_interval(&Cluster::from_counts(&[7, 0, 0, 0, 13]), 0.95).unwrap();
    assert_eq!((consistent.method, consistent.effective_trials), (ShareMethod::ClusteredWilson, 20.0));
    assert!(
        (consistent.low - 0.4329).abs() < 5e-5 && (consistent.high - 0.8188).abs() < 5e-5,
        "{consistent:?}"
    );
    // Everybody splits in half: an interval about a half, and never of width 0.
    let halves = of(&[0, 20, 0]);
    assert!(halves.low < 0.4 && halves.high > 0.6 && halves.effective_trials <= 40.0, "{halves:?}");
    // One participant with several choices tells nothing of others.
    let alone = share_interval(&[Cluster { successes: 1, trials: 2 }], 0.95).unwrap_err();
    assert!(alone.to_string().contains("one participant"), "{alone}");
    assert!(
        share_interval(&[], 0.95).is_err() && share_interval(&Cluster::from_counts(&[1, 1]), 1.0).is_err()
    );
}

fn names() -> Vec<String> {
    ["a", "b", "c"].map(String::from).to_vec()
}

/// An observer who chose by the bits of `pattern` in (a, b), (b, c), (a, c).
fn observer(id: usize, pattern: usize) -> Observer {
    let choice = |(k, [first, second]): (usize, [usize; 2])| {
        let [winner, loser] = if pattern >> k & 1 == 1 { [first, second] } else { [second, first] };
        Choice { winner, loser, times: 1 }
    };
    Observer {
        id: id.to_string(),
        choices: [[0, 1], [1, 2], [0, 2]].into_iter().enumerate().map(choice).collect(),
    }
}

fn judged(patterns: impl IntoIterator<Item = usize>) -> ScaleIntervals {
    let observers: Vec<Observer> = patterns.into_iter().enumerate().map(|(id, p)| observer(id, p)).collect();
    observer_intervals(&names(), &observers, ScaleOptions::default(), 1999, 0.95, 7).unwrap()
}

#[test]
fn unanimous_observers_give_the_sign_tests_p_and_no_interval() {
    for n in 2..=8 {
        let found = judged(std::iter::repeat_n(0b111, n));
        for d in &found.differences {
            assert!((d.p - 2.0 / 2f64.powi(n as i32)).abs() < 1e-12 && d.p_exact, "{n}: {d:?}");
            assert_eq!((d.low, d.high), (None, None));
        }
        assert!(found.conditions.iter().all(|c| c.low.is_none() && c.standard_error.is_none()));
        assert!(found.note.as_ref().unwrap().contains("chose alike"), "{:?}", found.note);
    }
    // Many: p is bounded by the number of patterns that were tried.
    let many = judged(std::iter::repeat_n(0b111, 30));
    assert!(
        many.differences.iter().all(|d| !d.p_exact && d.p == d.p_smallest && d.p == 1.0 / 2000.0),
        "{many:?}"
    );
}

#[test]
fn observers_who_split_two_conditions_in_half_show_no_difference() {
    // Each chose a over b once and b over a once, and both alike over c.
    let choices = |other: usize| {
        let pair = |winner, loser| Choice { winner, loser, times: 1 };
        vec![pair(0, 1), pair(1, 0), pair(0, 2), pair(1, 2), pair(2, other)]
    };
    let observers: Vec<Observer> =
        (0..14).map(|id| Observer { id: id.to_string(), choices: choices(id % 2) }).collect();
    let found = observer_intervals(&names(), &observers, ScaleOptions::default(), 1999, 0.95, 7).unwrap();
    assert!(
        found.differences[0].jod.abs() < 1e-9 && found.differences[0].p > 0.5,
        "{:?}",
        found.differences[0]
    );
    let same: Vec<Observer> =
        (0..14).map(|id| Observer { id: id.to_string(), choices: choices(0)[..4].to_vec() }).collect();
    let found = observer_intervals(&names(), &same, ScaleOptions::default(), 1999, 0.95, 7).unwrap();
    assert_eq!((found.differences[0].p, found.differences[0].low), (1.0, None));
}

#[test]
fn differences_that_are_not_there_are_not_found_too_often() {
    // Every table of six observers who toss a coin for each of three pairs: exact false alarms, at every level that the test can have.
    for n in [4, 6] {
        let mut alarms = [0.0; 3];
        let levels = [0.05, 0.15, 0.3];
        tables(n, &[0.125; 8], |counts, probability| {
            let patterns = counts.iter().enumerate().flat_map(|(p, k)| std::iter::repeat_n(p, *k as usize));
            for d in judged(patterns).differences {
                for (alarms, level) in alarms.iter_mut().zip(levels) {
                    *alarms += if d.p <= level { probability / 3.0 } else { 0.0 };
                }
            }
        });
        for (alarms, level) in alarms.into_iter().zip(levels) {
            assert!(alarms <= level + 1e-9, "{n} observers: {alarms} at {level}");
            // Control: it is no test that never speaks.
            assert!(level < 0.1 || alarms > 0.2 * level, "{n} observers: {alarms} at {level}");
        }
    }
}

/// How often intervals of differences hold the truth, and tests find what is not there, in `runs` simulated studies; the share of differences
/// without an interval.
fn scale_rates(jod: [f64; 3], n: usize, repeats: u64, runs: u64) -> [f64; 3] {
    let (mut covered, mut with, mut alarms, mut null, mut all) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for run in 0..runs {
        let mut random = Random::stream(n as u64, run);
        let observers: Vec<Observer> = (0..n)
            .map(|id| {
                let mut choices = Vec::new();
                for [i, j] in [[0, 1], [1, 2], [0, 2]] {
                    let won = random.binomial(repeats, Model::Thurstone.probability(jod[i] - jod[j]));
                    choices.push(Choice { winner: i, loser: j, times: won });
                    choices.push(Choice { winner: j, loser: i, times: repeats - won });
                }
                Observer { id: id.to_string(), choices }
            })
            .collect();
        let found =
            observer_intervals(&names(), &observers, ScaleOptions::default(), 1000, 0.95, run).unwrap();
        for (d, [i, j]) in found.differences.iter().zip([[0, 1], [0, 2], [1, 2]]) {
            let truth = jod[i] - jod[j];
            all += 1.0;
            if let (Some(low), Some(high)) = (d.low, d.high) {
                with += 1.0;
                covered += f64::from(u8::from(low <= truth && truth <= high));
            }
            if truth == 0.0 {
                null += 1.0;
                alarms += f64::from(u8::from(d.p <= 0.05));
            }
        }
    }
    [covered / with, alarms / f64::max(null, 1.0), 1.0 - with / all]
}

#[test]
fn intervals_of_a_scale_cover() {
    let (mut sum, mut cells) = (0.0, 0.0);
    for (jod, n, repeats) in [
        ([0.0, 0.0, 1.0], 6, 2),
        ([0.0, 0.5, 1.0], 12, 1),
        ([0.0, 0.0, 2.0], 12, 2),
        ([0.0, 0.0, 0.8], 24, 1),
    ] {
        let [coverage, alarms, without] = scale_rates(jod, n, repeats, 400);
        let least = if n < 12 { 0.88 } else { 0.92 };
        assert!(coverage >= least, "{jod:?}, n = {n}: {coverage}");
        assert!(
            alarms <= 0.05 + 4.0 * (0.05f64 * 0.95 / 400.0).sqrt(),
            "{jod:?}, n = {n}: {alarms} false alarms"
        );
        assert!(without < 0.2, "{jod:?}, n = {n}: {without} have no interval");
        (sum, cells) = (sum + coverage, cells + 1.0);
    }
    assert!(sum / cells >= 0.94, "on average {}", sum / cells);
}

/// Eight people at five levels: guessing up to the third, right beyond it but for one, so that the curve is a step that many places fit.
fn steps() -> Vec<Vec<Level>> {
    let right = |person: usize, k: usize| match k {
        0..=2 => (person + k).is_multiple_of(2),
        _ => person > 0,
    };
    let level = |person, k| Level { x: k as f64, correct: u64::from(right(person, k)), trials: 1 };
    (0..8).map(|person| (0..5).map(|k| level(person, k)).collect()).collect()
}

#[test]
fn a_resampled_threshold_is_searched_as_widely_as_everybodys() {
    let (people, task, replicates, seed) = (steps(), Task::default(), 2000, 3);
    let found = resampled_threshold(&people, &task, replicates, 0.95, seed).unwrap();
    // The definition: whole people drawn with replacement, each sample fitted from nothing.
    let (mut thresholds, mut at_bound) = (Vec::new(), 0);
    for replicate in 0..replicates as u64 {
        let mut random = Random::stream(seed, replicate);
        let drawn: Vec<Level> =
            (0..people.len()).flat_map(|_| people[random.below(people.len())].clone()).collect();
        let fitted = fit(&drawn, &task).unwrap();
        let edge = fitted.at_bound.iter().any(|name| name == "threshold" || name == "width");
        at_bound += usize::from(edge || fitted.standard_errors[0].is_none());
        thresholds.push(fitted.curve.threshold);
    }
    // Within 2.365 √(8/7) standard deviations, where t with 7 degrees of freedom has 95%, lie 98.85% of a normal distribution.
    let estimate = fit(&people.concat(), &task).unwrap().curve.threshold;
    let mut distances: Vec<f64> = thresholds.iter().map(|x| (x - estimate).abs()).collect();
    distances.sort_by(f64::total_cmp);
    let (half, ours) = (distances[1976], found.bootstrap.high - estimate);
    assert!((ours / half - 1.0).abs() < 0.1, "{estimate} ± {ours} is not ± {half}");
    assert!((estimate - found.bootstrap.low - ours).abs() < 1e-6);
    let flagged = found.at_bound as f64 / at_bound as f64;
    assert!(at_bound > 100 && (0.8..1.25).contains(&flagged), "{} and {at_bound} at a bound", found.at_bound);
    // Control: many answers show the whole curve, and nothing ends on an edge.
    let shares = [52, 60, 75, 90, 98];
    let level = |person: u64, k: usize| Level { x: k as f64, correct: shares[k] - person % 3, trials: 100 };
    let plenty: Vec<Vec<Level>> = (0..10).map(|person| (0..5).map(|k| level(person, k)).collect()).collect();
    assert_eq!(resampled_threshold(&plenty, &task, replicates, 0.95, seed).unwrap().at_bound, 0);
}

#[test]
fn a_threshold_resampled_from_six_participants_holds_the_truth() {
    // Plain quantiles of the resamples, which know nothing of how few there are, hold it in 86% of studies of six, and fail here.
    let cells = CELLS.iter().filter(|cell| cell.participants == 6);
    let found: Vec<Coverage> =
        cells.map(|cell| coverage(Shown::ResampledThreshold, cell, 40, 1).unwrap()).collect();
    assert_eq!((found.len(), shortfalls(&found)), (3, Vec::new()), "{found:?}");
}

/// Four of the twelve cells that `kelir bench coverage` tries.
fn four(shown: Shown, runs: u64) -> Vec<Coverage> {
    CELLS.iter().step_by(3).map(|cell| coverage(shown, cell, runs, 1).unwrap()).collect()
}

#[test]
fn resampled_intervals_hold_the_truth_in_four_cells() {
    for (shown, runs) in [
        (Shown::Share, 400),
        (Shown::Scale, 100),
        (Shown::ResampledThreshold, 12),
        (Shown::PosteriorThreshold, 12),
    ] {
        let found = four(shown, runs);
        assert_eq!(shortfalls(&found), [""; 0]);
        // Control: an interval that holds too little in one cell is named, and so is an average that does.
        let mut short = found.clone();
        let n = short[3].rate.runs;
        short[3].rate = Rate::new(n / 2, n, 0);
        let named = shortfalls(&short);
        assert!(named[0].contains("with 32 participants") && named[0].starts_with(shown.name()), "{named:?}");
    }
}
