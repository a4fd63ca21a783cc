//! Whether something goes with something else within participants: choices with their place in the session, or with the time they took.

use crate::normal;
use crate::random::Random;
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A slope within participants, and the test that there is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct WithinSlope {
    /// By how much y grows when x grows by 1, one line for all, each group about its own means.
    pub slope: f64,
    /// Lower end of the interval over participants; null where all say the same.
    pub low: Option<f64>,
    /// Upper end, likewise.
    pub high: Option<f64>,
    /// Confidence level.
    pub level: f64,
    /// P(a slope at least as far from 0) when y is dealt out anew within each group.
    pub p: f64,
    /// The smallest p that so many ways of dealing can give.
    pub p_smallest: f64,
    /// Participants whose x varies within a group.
    pub participants: u64,
    /// Their observations.
    pub observations: u64,
}

/// One participant's observations (x, y), in groups within which y could have come with any x.
pub type Groups = Vec<Vec<(f64, f64)>>;

/// The slope of y over x within groups. The interval is the cluster-robust one of Liang & Zeger with the factor m/(m − 1) and t with m − 1 degrees of
/// freedom; p is by `deals` random permutations of y within groups, exact whatever participants have in common; deterministic for a seed.
///
/// Errors: fewer than two participants whose x varies within a group; fewer than 1,000 deals; a level outside (0, 1); x or y that is
/// not finite.
pub fn within_slope(participants: &[Groups], deals: usize, level: f64, seed: u64) -> Result<WithinSlope> {
    StatsError::open_probability("level", level)?;
    if deals < 1000 {
        let rule = "must be at least 1000";
        return Err(StatsError::Invalid { name: "deals", value: deals as f64, rule });
    }
    for (x, y) in participants.iter().flatten().flatten() {
        StatsError::finite("x", *x)?;
        StatsError::finite("y", *y)?;
    }
    let people: Vec<Vec<Centred>> = participants
        .iter()
        .map(|groups| groups.iter().filter_map(|group| Centred::of(group)).collect())
        .filter(|groups: &Vec<Centred>| !groups.is_empty())
        .collect();
    let m = people.len() as f64;
    if people.len() < 2 {
        return Err(StatsError::TooFew {
            name: "participants within whom x varies",
            len: people.len() as u64,
            needed: 2,
        });
    }
    let squares: f64 = people.iter().flatten().map(|group| group.x.iter().map(|x| x * x).sum::<f64>()).sum();
    let products: f64 = people.iter().flatten().map(|group| group.product(&group.y)).sum();
    let slope = products / squares;
    let scores = people.iter().map(|groups| {
        let of =
            |group: &Centred| group.product(&group.y) - slope * group.x.iter().map(|x| x * x).sum::<f64>();
        groups.iter().map(of).sum::<f64>()
    });
    let error = (m / (m - 1.0) * scores.map(|s| s * s).sum::<f64>()).sqrt() / squares;
    let half =
        (error > 1e-9 * (1.0 + slope.abs())).then(|| error * normal::t_quantile(0.5 + 0.5 * level, m - 1.0));
    let mut random = Random::new(seed);
    let mut dealt: Vec<Vec<f64>> = people.iter().flatten().map(|group| group.y.clone()).collect();
    let floor = products.abs() - 1e-9 * squares.sqrt();
    let reached = (0..deals)
        .filter(|_| {
            let products: f64 = people
                .iter()
                .flatten()
                .zip(&mut dealt)
                .map(|(group, y)| {
                    random.shuffle(y);
                    group.product(y)
                })
                .sum();
            products.abs() >= floor
        })
        .count();
    Ok(WithinSlope {
        slope,
        low: half.map(|half| slope - half),
        high: half.map(|half| slope + half),
        level,
        p: (reached + 1) as f64 / (deals + 1) as f64,
        p_smallest: 1.0 / (deals + 1) as f64,
        participants: people.len() as u64,
        observations: people.iter().flatten().map(|group| group.x.len() as u64).sum(),
    })
}

/// A group about its means.
struct Centred {
    x: Vec<f64>,
    y: Vec<f64>,
}

impl Centred {
    /// Nothing where all x are the same.
    fn of(group: &[(f64, f64)]) -> Option<Centred> {
        let centred = |of: fn(&(f64, f64)) -> f64| -> Vec<f64> {
            let mean = group.iter().map(of).sum::<f64>() / group.len() as f64;
            group.iter().map(|o| of(o) - mean).collect()
        };
        let varies = group.iter().any(|o| o.0 != group[0].0);
        varies.then(|| Centred { x: centred(|o| o.0), y: centred(|o| o.1) })
    }

    fn product(&self, y: &[f64]) -> f64 {
        self.x.iter().zip(y).map(|(x, y)| x * y).sum()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    /// Five participants with two groups each.
    fn people() -> Vec<Groups> {
        let ys = [
            ([0.0, 1.0, 1.0, 0.0], [1.0, 1.0, 0.0]),
            ([0.0, 0.0, 1.0, 1.0], [0.0, 1.0, 1.0]),
            ([1.0, 0.0, 1.0, 1.0], [0.0, 0.0, 1.0]),
            ([0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 1.0]),
            ([0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
        ];
        let group = |y: &[f64]| y.iter().enumerate().map(|(k, y)| (k as f64 / 2.0, *y)).collect();
        ys.iter().map(|(a, b)| vec![group(a), group(b)]).collect()
    }

    /// R 4.2.2: `lm(y ~ x + factor(group))`; the standard error from x's residuals on the groups times its residuals, summed by participant, 5/4
    /// of their squares.
    const R: [f64; 3] = [0.34285714285714, -0.16817132635287, 0.85388561206716];

    #[test]
    fn the_slope_and_its_interval_are_those_of_r() {
        let found = within_slope(&people(), 1000, 0.95, 1).unwrap();
        assert!((found.slope - R[0]).abs() < 1e-12, "{found:?}");
        assert!(
            (found.low.unwrap() - R[1]).abs() < 1e-9 && (found.high.unwrap() - R[2]).abs() < 1e-9,
            "{found:?}"
        );
        assert_eq!((found.participants, found.observations), (5, 35));
    }

    #[test]
    fn p_is_that_of_all_permutations() {
        // Two participants of three observations each: 3 × 3 places of the one target choice, by hand.
        let own =
            |hit: usize| vec![(0..3).map(|k| (k as f64, f64::from(u8::from(k == hit)))).collect::<Vec<_>>()];
        // Both last: sums of x − 1 are 2; of nine ways (2, 2), (0, 0) reach ±2, the others not.
        let found = within_slope(&[own(2), own(2)], 20_000, 0.95, 1).unwrap();
        assert!((found.p - 2.0 / 9.0).abs() < 4.0 * (2.0f64 / 9.0 * 7.0 / 9.0 / 2e4).sqrt(), "{found:?}");
        assert!(found.low.is_none(), "both say the same");
        // Nothing at all: the sums are 0 and every way reaches them.
        assert_eq!(within_slope(&[own(1), own(1)], 1000, 0.95, 1).unwrap().p, 1.0);
    }

    #[test]
    fn what_does_not_vary_says_nothing() {
        let alone = vec![vec![(0.0, 1.0)], vec![(1.0, 0.0)]];
        let error = within_slope(&[alone.clone(), alone], 1000, 0.95, 1).unwrap_err();
        assert!(error.to_string().contains("within whom x varies"), "{error}");
        let still = vec![vec![(0.0, 1.0), (1.0, 1.0)]];
        let found = within_slope(&[still.clone(), still], 1000, 0.95, 1).unwrap();
        assert_eq!((found.slope, found.p, found.low), (0.0, 1.0, None));
        assert!(within_slope(&people(), 999, 0.95, 1).is_err());
        assert!(within_slope(&[vec![vec![(f64::NAN, 1.0)]]], 1000, 0.95, 1).is_err());
    }
}
