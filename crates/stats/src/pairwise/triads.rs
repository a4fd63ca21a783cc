//! Kendall's circular triads: A over B, B over C, C over A.

use super::Wins;
use crate::normal;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use utoipa::ToSchema;

/// How often one observer's choices run in a circle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct CircularTriads {
    /// Triads of conditions all of whose three pairs have a majority choice.
    pub triads: u64,
    /// Those that run in a circle.
    pub circular: u64,
    /// Kendall & Babington Smith's coefficient of consistence ζ = 1 − circular / the largest possible number: 1 without circles, 0 at the
    /// most. `None` unless every pair has a majority, or with fewer than three conditions.
    pub consistence: Option<f64>,
    /// P(at most this many circles) if every choice were a coin toss: small for an observer who judges consistently. Exact up to 10
    /// conditions, else Kendall's χ². `None` as above.
    pub p: Option<f64>,
}

/// Counts the circular triads of one observer's choices. Pairs never shown, or chosen equally often both ways, are left out.
///
/// Source: Kendall & Babington Smith (1940), Biometrika 31, 324.
pub fn circular_triads(wins: &Wins) -> CircularTriads {
    let n = wins.conditions();
    let majority = |i: usize, j: usize| wins.count(i, j).cmp(&wins.count(j, i)) as i32;
    let (mut triads, mut circular) = (0u64, 0u64);
    for i in 0..n {
        for j in i + 1..n {
            let ij = majority(i, j);
            if ij == 0 {
                continue;
            }
            for k in j + 1..n {
                let (jk, ki) = (majority(j, k), majority(k, i));
                if jk != 0 && ki != 0 {
                    triads += 1;
                    circular += u64::from(ij == jk && jk == ki);
                }
            }
        }
    }
    let size = n as u64;
    let complete = n >= 3 && triads == size * (size - 1) * (size - 2) / 6;
    let most =
        if n % 2 == 1 { size * (size * size - 1) / 24 } else { size * (size * size).saturating_sub(4) / 24 };
    CircularTriads {
        triads,
        circular,
        consistence: complete.then(|| 1.0 - circular as f64 / most as f64),
        p: complete
            .then(|| if n <= 10 { exact(n, circular) } else { approximate(n as f64, circular as f64) }),
    }
}

/// P(circles ≤ d) over all 2^(n(n−1)/2) tournaments, which differ only by their multiset of scores: add the conditions one by one.
fn exact(n: usize, d: u64) -> f64 {
    let mut scores: BTreeMap<Vec<u8>, f64> = BTreeMap::from([(vec![0], 1.0)]);
    for k in 1..n {
        let mut next: BTreeMap<Vec<u8>, f64> = BTreeMap::new();
        for (vector, probability) in &scores {
            for losers in 0..1u32 << k {
                // The newcomer beats those in `losers`; the others gain a point.
                let mut v: Vec<u8> =
                    vector.iter().enumerate().map(|(i, s)| s + u8::from(losers >> i & 1 == 0)).collect();
                v.push(losers.count_ones() as u8);
                v.sort_unstable();
                *next.entry(v).or_default() += probability / f64::from(1u32 << k);
            }
        }
        scores = next;
    }
    let n = n as u64;
    let all = n * (n - 1) * (n - 2) / 6;
    // A transitive triad has one condition that wins both its pairs.
    let circles =
        |v: &[u8]| all - v.iter().map(|&s| u64::from(s) * u64::from(s).saturating_sub(1) / 2).sum::<u64>();
    scores.iter().filter(|(v, _)| circles(v) <= d).map(|(_, p)| p).sum::<f64>().min(1.0)
}

/// Kendall's χ² with n(n−1)(n−2)/(n−4)² degrees of freedom, with continuity correction.
fn approximate(n: f64, d: f64) -> f64 {
    let triads = n * (n - 1.0) * (n - 2.0) / 6.0;
    let df = n * (n - 1.0) * (n - 2.0) / (n - 4.0).powi(2);
    let chi = 8.0 / (n - 4.0) * (0.25 * triads - d + 0.5) + df;
    normal::chi_squared_sf(chi.max(0.0), df)
}
