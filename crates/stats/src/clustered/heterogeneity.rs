//! Do pairs differ, whatever the choices of one participant have in common?

use super::pairs_of;
use crate::linalg;
use crate::normal;
use crate::random::Random;
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use utoipa::ToSchema;

/// Cochran's Q of pairs within participants, with its p by permutation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Heterogeneity {
    /// Cochran's Q; where some participants left pairs out, the generalised Mantel–Haenszel statistic that it is a case of.
    pub q: f64,
    /// Pairs less one.
    pub df: f64,
    /// P(a Q at least as large) when each participant's choices are dealt out anew over the pairs they answered.
    pub p: f64,
    /// Whether every way of dealing was counted.
    pub exact: bool,
    /// The smallest p that so many random ways can give; null where p is exact.
    pub p_smallest: Option<f64>,
    /// P(χ² ≥ Q), which holds for many participants.
    pub p_asymptotic: f64,
    /// Participants who chose the target in some pairs and not in others: nobody else tells pairs apart.
    pub participants: u64,
}

/// Ways of dealing are counted as long as the numbers of target choices by pair have no more possible values.
const MOST_STATES: usize = 20_000;
/// And as long as one participant's choices can be dealt in no more ways.
const MOST_WAYS: usize = 256;
/// Values that are equal but for rounding count as equal.
const ROUNDING: f64 = 1e-9;

/// Tests whether pairs differ in their share of target choices: given how often each participant chose the target, every way to deal these choices
/// over the pairs they answered is as likely, if pairs do not differ. Exact, or over `deals` random ways; deterministic for a seed. With two pairs
/// it is McNemar's exact test.
///
/// `choices` as for [`crossed_logit`](super::crossed_logit). Errors: rows of unequal length; fewer than two pairs that can be told apart; nobody
/// whose choices differ; fewer than 1,000 deals. Source: Cochran (1950); Mantel & Haenszel's test generalised by Landis, Heyman & Koch (1978).
pub fn heterogeneity(choices: &[Vec<Option<bool>>], deals: usize, seed: u64) -> Result<Heterogeneity> {
    if deals < 1000 {
        let rule = "must be at least 1000";
        return Err(StatsError::Invalid { name: "deals", value: deals as f64, rule });
    }
    let columns = pairs_of(choices)?;
    let hands: Vec<Hand> = choices.iter().filter_map(|row| Hand::of(row)).collect();
    let test = Quadratic::of(&hands, columns)?;
    let mut seen = vec![0; columns];
    for (hand, row) in hands.iter().zip(choices.iter().filter(|row| Hand::of(row).is_some())) {
        hand.pairs.iter().filter(|&&j| row[j] == Some(true)).for_each(|&j| seen[j] += 1);
    }
    let q = test.value(&seen);
    let reached = |sums: &[u32]| test.value(sums) >= q * (1.0 - ROUNDING);
    let counted = count(&hands, columns);
    let (p, exact) = match counted {
        Some(sums) => {
            (sums.iter().filter(|(sums, _)| reached(sums)).map(|(_, p)| p).sum::<f64>().min(1.0), true)
        }
        None => {
            let mut random = Random::new(seed);
            let hits = (0..deals).filter(|_| reached(&deal(&hands, columns, &mut random))).count();
            ((hits + 1) as f64 / (deals + 1) as f64, false)
        }
    };
    let df = test.used.len() as f64;
    Ok(Heterogeneity {
        q,
        df,
        p,
        exact,
        p_smallest: (!exact).then(|| 1.0 / (deals + 1) as f64),
        p_asymptotic: normal::chi_squared_sf(q, df),
        participants: hands.len() as u64,
    })
}

/// A participant whose choices differ: the pairs they answered, and in how many they chose the target.
struct Hand {
    pairs: Vec<usize>,
    hits: usize,
}

impl Hand {
    fn of(row: &[Option<bool>]) -> Option<Hand> {
        let pairs: Vec<usize> = (0..row.len()).filter(|&j| row[j].is_some()).collect();
        let hits = row.iter().filter(|y| **y == Some(true)).count();
        (hits > 0 && hits < pairs.len()).then_some(Hand { pairs, hits })
    }

    fn share(&self) -> f64 {
        self.hits as f64 / self.pairs.len() as f64
    }

    /// Every way to deal the target choices, as bits over the pairs answered; `None`: too many.
    fn ways(&self) -> Option<Vec<u32>> {
        if self.pairs.len() > 16 {
            return None;
        }
        let ways = (0..1u32 << self.pairs.len()).filter(|bits| bits.count_ones() as usize == self.hits);
        Some(ways.take(MOST_WAYS + 1).collect::<Vec<u32>>()).filter(|ways| ways.len() <= MOST_WAYS)
    }
}

/// The statistic: (T − E)ᵀ V⁻¹ (T − E) over all pairs but one.
struct Quadratic {
    /// The pairs that are in.
    used: Vec<usize>,
    expected: Vec<f64>,
    factor: Vec<f64>,
}

impl Quadratic {
    fn of(hands: &[Hand], columns: usize) -> Result<Quadratic> {
        if hands.is_empty() {
            return Err(StatsError::NoSolution {
                what: "the test of pairs",
                reason: "no participant chose the target in some pairs and not in others",
            });
        }
        let (mut expected, mut variance) = (vec![0.0; columns], vec![0.0; columns * columns]);
        for hand in hands {
            let (n, p) = (hand.pairs.len() as f64, hand.share());
            let scale = p * (1.0 - p) * n / (n - 1.0);
            for &a in &hand.pairs {
                expected[a] += p;
                for &b in &hand.pairs {
                    variance[a * columns + b] += scale * (f64::from(u8::from(a == b)) - 1.0 / n);
                }
            }
        }
        let mut used: Vec<usize> = (0..columns).filter(|&j| variance[j * columns + j] > 0.0).collect();
        // The target choices by pair add up to what they are: one follows from the others.
        used.pop();
        let inner: Vec<f64> = used
            .iter()
            .flat_map(|&a| used.iter().map(move |&b| (a, b)))
            .map(|(a, b)| variance[a * columns + b])
            .collect();
        let factor = linalg::cholesky(&inner, used.len()).ok_or(StatsError::NoSolution {
            what: "the test of pairs",
            reason: "the pairs fall apart into groups that no participant's differing choices link",
        })?;
        Ok(Quadratic { used, expected, factor })
    }

    fn value(&self, sums: &[u32]) -> f64 {
        let off: Vec<f64> = self.used.iter().map(|&j| f64::from(sums[j]) - self.expected[j]).collect();
        let mut solved = off.clone();
        linalg::solve(&self.factor, self.used.len(), &mut solved);
        off.iter().zip(&solved).map(|(a, b)| a * b).sum()
    }
}

/// The numbers of target choices by pair with their probabilities, over all ways of dealing; `None`: there are too many.
fn count(hands: &[Hand], columns: usize) -> Option<BTreeMap<Vec<u32>, f64>> {
    let mut sums = BTreeMap::from([(vec![0; columns], 1.0)]);
    for hand in hands {
        let ways = hand.ways()?;
        let mut next = BTreeMap::new();
        for (sum, p) in &sums {
            for bits in &ways {
                let mut sum: Vec<u32> = sum.clone();
                hand.pairs.iter().enumerate().for_each(|(k, &j)| sum[j] += bits >> k & 1);
                *next.entry(sum).or_insert(0.0) += p / ways.len() as f64;
            }
        }
        sums = next;
        if sums.len() > MOST_STATES {
            return None;
        }
    }
    Some(sums)
}

/// One random way of dealing.
fn deal(hands: &[Hand], columns: usize, random: &mut Random) -> Vec<u32> {
    let mut sums = vec![0; columns];
    for hand in hands {
        // Selection sampling: each pair in turn, as likely as there are target choices left for those left.
        let mut left = hand.hits;
        for (k, &j) in hand.pairs.iter().enumerate() {
            if random.below(hand.pairs.len() - k) < left {
                sums[j] += 1;
                left -= 1;
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;
    use crate::clustered::tests::rows;

    /// R 4.2.2: `mantelhaen.test(table(pair, choice, participant))`, which is Cochran's Q where nobody left a pair out.
    #[test]
    fn q_is_that_of_r() {
        for (text, q, df, p) in [
            (
                "101001 001111 001000 011001 001011 101101 111011 001000 101001 001110 111111 111111 001000 111111 011101 101101 001100 101110",
                23.2300884956,
                5.0,
                0.0003050321382,
            ),
            (
                "10001 01000 101-- 10101 11110 11101 -0000 00000 11111 11111 10111 1---- 01110 10111",
                3.38832155014,
                4.0,
                0.4950611345,
            ),
        ] {
            let found = heterogeneity(&rows(text), 9999, 1).unwrap();
            assert!((found.q - q).abs() < 1e-9 && found.df == df, "{found:?}");
            assert!((found.p_asymptotic - p).abs() < 1e-9, "{found:?}");
            // Permutation and χ² agree about what they are of.
            assert!(found.p < 5.0 * p.max(0.002) && found.p > p / 5.0, "{found:?}");
        }
    }

    #[test]
    fn two_pairs_are_mcnemars_exact_test() {
        // Ten chose the target in the first pair alone, two in the second alone; R 4.2.2: binom.test(2, 12)$p.value.
        let text = ["10"; 10].into_iter().chain(["01"; 2]).chain(["11"; 7]).collect::<Vec<_>>().join(" ");
        let found = heterogeneity(&rows(&text), 1000, 1).unwrap();
        assert!(
            (found.p - 0.03857421875).abs() < 1e-12 && found.exact && found.participants == 12,
            "{found:?}"
        );
    }

    /// Every table of a few participants over all patterns of three pairs: exact false alarms.
    #[test]
    fn pairs_that_do_not_differ_are_not_found_too_often() {
        let participants = 5usize;
        // One in two leans to the target by 65%, the other by 35%: a mixture, so that choices of one are correlated.
        let pattern = |bits: usize| {
            let of = |p: f64| (0..3).map(|k| if bits >> k & 1 == 1 { p } else { 1.0 - p }).product::<f64>();
            0.5 * of(0.65) + 0.5 * of(0.35)
        };
        let levels = [0.1, 0.3];
        let mut alarms = [0.0; 2];
        for table in 0..8usize.pow(participants as u32) {
            let bits: Vec<usize> = (0..participants).map(|i| table / 8usize.pow(i as u32) % 8).collect();
            let probability: f64 = bits.iter().map(|&b| pattern(b)).product();
            let choices: Vec<Vec<Option<bool>>> =
                bits.iter().map(|b| (0..3).map(|k| Some(b >> k & 1 == 1)).collect()).collect();
            let Ok(found) = heterogeneity(&choices, 1000, 1) else { continue };
            assert!(found.exact);
            for (alarms, level) in alarms.iter_mut().zip(levels) {
                *alarms += if found.p <= level { probability } else { 0.0 };
            }
        }
        for (alarms, level) in alarms.into_iter().zip(levels) {
            assert!(alarms <= level && alarms > 0.1 * level, "{alarms} at {level}");
        }
    }

    #[test]
    fn what_was_counted_and_what_was_drawn_agree() {
        let text = "100 110 010 001 100 100 110 101 100 100 010 110";
        let hands: Vec<Hand> = rows(text).iter().filter_map(|row| Hand::of(row)).collect();
        let exact = heterogeneity(&rows(text), 1000, 1).unwrap();
        let test = Quadratic::of(&hands, 3).unwrap();
        let mut random = Random::new(3);
        let hits = (0..20_000)
            .filter(|_| test.value(&deal(&hands, 3, &mut random)) >= exact.q * (1.0 - ROUNDING))
            .count();
        let share = hits as f64 / 20_000.0;
        assert!(
            (share - exact.p).abs() < 4.0 * (exact.p * (1.0 - exact.p) / 2e4).sqrt(),
            "{share} {}",
            exact.p
        );
    }

    #[test]
    fn nobody_who_tells_pairs_apart_is_said() {
        let none = heterogeneity(&rows("11 00 11"), 1000, 1).unwrap_err();
        assert!(none.to_string().contains("no participant chose"), "{none}");
        let apart = heterogeneity(&rows("10-- --01 01-- --10"), 1000, 1).unwrap_err();
        assert!(apart.to_string().contains("fall apart"), "{apart}");
        assert!(heterogeneity(&rows("10 01"), 999, 1).is_err());
        assert!(heterogeneity(&rows("10 1"), 1000, 1).is_err());
    }
}
