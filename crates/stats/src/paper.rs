//! The paper, replicated: Taylor & Cameron, "Rendering Virtual Shadow Puppet Theatres". Its three t-tests
//! from the counts that its printed summaries imply, what they leave out, and a printed t that no data give.

use serde::Serialize;
use utoipa::ToSchema;

use crate::Result;
use crate::inference::{
    BinomialTest, EffectSize, JzsBayesFactor, ORDINARY_PRIOR_SCALE, ShareEquivalence, SignedRank, TPlan,
    TTest, detectable_effect_t, effect_size, holm, jzs_bayes_factor, power_t, share_equivalence, sign_test,
    t_test_from_counts, wilcoxon_signed_rank,
};

/// What the paper prints about one comparison, to three decimals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Printed {
    /// Mean number of PA images chosen.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
    /// t.
    pub t: f64,
}

/// One comparison of the paper, computed again.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Comparison {
    /// `still-mc`, `still-photo` or `animation-mc`.
    pub id: &'static str,
    /// What was compared.
    pub title: &'static str,
    /// What the paper prints.
    pub printed: Printed,
    /// (PA images chosen, participants), reconstructed.
    pub counts: Vec<(f64, u64)>,
    /// How many tables of counts, at this number of participants, round to the printed mean and sd: 1 when the
    /// reconstruction is unique.
    pub reconstructions: usize,
    /// The paper's test.
    pub test: TTest,
    /// Does its t round to the printed one?
    pub t_as_printed: bool,
    /// Its p-value, corrected for the three tests by Holm's method.
    pub p_holm: f64,
    /// Effect size with 95% intervals.
    pub effect: EffectSize,
    /// Is the share of PA images chosen equivalent to one half? The paper states no bound: by a range of them, rising.
    pub equivalence: Vec<ShareEquivalence>,
    /// Evidence for no effect against an effect.
    pub bayes: JzsBayesFactor,
    /// Sign test of the same hypothesis, without assuming normality.
    pub sign: BinomialTest,
    /// Wilcoxon's signed-rank test, ties exact.
    pub wilcoxon: SignedRank,
    /// Power at this number of participants for small, medium and large effects (d = 0.2, 0.5, 0.8), α = 0.05.
    pub power: Vec<TPlan>,
    /// The effect that would be found with a probability of 80%.
    pub detectable: TPlan,
}

/// Every so many of the bounds that were tried stand in a table; a figure has all.
const TABLED: usize = 5;

impl Comparison {
    /// The tests of equivalence that a table shows.
    pub fn tabled(&self) -> impl Iterator<Item = &ShareEquivalence> {
        self.equivalence.iter().skip(TABLED - 1).step_by(TABLED)
    }
}

/// The bounds that are tried, in hundredths: up to the whole scale, which proves nothing, and no further.
const BOUNDS: std::ops::Range<u32> = 1..50;

/// A split of binary answers and its t.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Split {
    /// Participants.
    pub n: u64,
    /// Of whom so many chose PA.
    pub chosen: u64,
    /// t against ½.
    pub t: f64,
}

/// Whether the printed t of the third comparison can come from any data.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct PrintedT {
    /// The t in question.
    pub printed: f64,
    /// The numbers of participants that were tried, from and to.
    pub participants: (u64, u64),
    /// Splits of that many participants whose t rounds to it.
    pub splits_with_this_t: Vec<Split>,
    /// Numbers of participants at which the printed mean and sd, anywhere within their rounding, allow it.
    pub participants_with_this_t: Vec<u64>,
    /// Splits that round to the printed mean and sd.
    pub splits_with_this_summary: Vec<Split>,
    /// The split whose t comes closest.
    pub closest: Split,
}

/// The whole replication.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Replication {
    /// The three comparisons in the paper's order.
    pub comparisons: Vec<Comparison>,
    /// About the third t.
    pub printed_t: PrintedT,
}

/// Computes the paper's three tests again, and what it left out.
///
/// # Errors
/// None for the data it holds; the type is that of the functions it calls.
pub fn taylor_cameron() -> Result<Replication> {
    let still_mc = Source {
        id: "still-mc",
        title: "PA against MC, two pairs of still images",
        printed: Printed { mean: 0.813, sd: 0.738, t: -1.438 },
        counts: &[12, 14, 6],
    };
    let still_photo = Source {
        id: "still-photo",
        title: "PA against photographs, two pairs of still images",
        printed: Printed { mean: 1.5, sd: 0.672, t: 4.209 },
        counts: &[3, 10, 19],
    };
    let animation = Source {
        id: "animation-mc",
        title: "PA against MC, one pair of animations",
        printed: Printed { mean: 0.212, sd: 0.415, t: -3.293 },
        counts: &[26, 7],
    };
    let mut comparisons =
        [still_mc, still_photo, animation].iter().map(Source::compare).collect::<Result<Vec<_>>>()?;
    let p: Vec<f64> = comparisons.iter().map(|c| c.test.p).collect();
    for (comparison, adjusted) in comparisons.iter_mut().zip(holm(&p)?) {
        comparison.p_holm = adjusted;
    }
    Ok(Replication { printed_t: search_printed_t(animation.printed, (25, 40))?, comparisons })
}

/// A comparison as the paper leaves it: the number of participants choosing PA 0, 1, … times.
#[derive(Clone, Copy)]
struct Source {
    id: &'static str,
    title: &'static str,
    printed: Printed,
    counts: &'static [u64],
}

impl Source {
    fn compare(&self) -> Result<Comparison> {
        let counts = table(self.counts);
        // By chance half of the pairs.
        let pairs = self.counts.len() as u32 - 1;
        let mu = f64::from(pairs) / 2.0;
        let test = t_test_from_counts(&counts, mu)?;
        let values: Vec<f64> =
            counts.iter().flat_map(|&(value, count)| std::iter::repeat_n(value, count as usize)).collect();
        let power = [0.2, 0.5, 0.8].map(|d| power_t(test.n, d, 0.05));
        Ok(Comparison {
            id: self.id,
            title: self.title,
            printed: self.printed,
            reconstructions: tables(test.n, self.counts.len())
                .filter(|counts| summary_is(counts, mu, self.printed))
                .count(),
            counts,
            t_as_printed: rounds_to(test.t, self.printed.t),
            p_holm: test.p,
            effect: effect_size(&test, 0.95)?,
            equivalence: BOUNDS
                .map(|hundredths| share_equivalence(&test, pairs, f64::from(hundredths) / 100.0))
                .collect::<Result<_>>()?,
            bayes: jzs_bayes_factor(&test, ORDINARY_PRIOR_SCALE)?,
            sign: sign_test(&values, mu)?,
            wilcoxon: wilcoxon_signed_rank(&values, mu)?,
            power: power.into_iter().collect::<Result<_>>()?,
            detectable: detectable_effect_t(test.n, 0.05, 0.8)?,
            test,
        })
    }
}

/// (value, count) with the values 0, 1, …
fn table(counts: &[u64]) -> Vec<(f64, u64)> {
    counts.iter().enumerate().map(|(value, &count)| (value as f64, count)).collect()
}

/// All tables of n participants over two or three values.
fn tables(n: u64, values: usize) -> impl Iterator<Item = Vec<u64>> {
    (0..=n).flat_map(move |first| {
        let rest = n - first;
        let seconds = if values == 2 { rest..=rest } else { 0..=rest };
        seconds.map(
            move |second| {
                if values == 2 { vec![first, second] } else { vec![first, second, rest - second] }
            },
        )
    })
}

fn summary_is(counts: &[u64], mu: f64, printed: Printed) -> bool {
    t_test_from_counts(&table(counts), mu)
        .is_ok_and(|test| rounds_to(test.mean, printed.mean) && rounds_to(test.sd, printed.sd))
}

/// Equal to three printed decimals, ties rounded either way.
fn rounds_to(value: f64, printed: f64) -> bool {
    (value - printed).abs() <= 0.0005 + 1e-12
}

fn search_printed_t(printed: Printed, participants: (u64, u64)) -> Result<PrintedT> {
    let mu = 0.5;
    let mut splits = Vec::new();
    let mut with_this_summary = Vec::new();
    let mut participants_with_this_t = Vec::new();
    for n in participants.0..=participants.1 {
        // All the same answer has no t.
        for chosen in 1..n {
            let counts = [n - chosen, chosen];
            let split = Split { n, chosen, t: t_test_from_counts(&table(&counts), mu)?.t };
            if summary_is(&counts, mu, printed) {
                with_this_summary.push(split);
            }
            splits.push(split);
        }
        let t = |mean: f64, sd: f64| (mean - mu) / (sd / (n as f64).sqrt());
        let half = 0.0005;
        let (least, most) =
            (t(printed.mean - half, printed.sd - half), t(printed.mean + half, printed.sd + half));
        if least <= printed.t + half && printed.t - half <= most {
            participants_with_this_t.push(n);
        }
    }
    let distance = |split: &Split| (split.t - printed.t).abs();
    let closest = splits.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    Ok(PrintedT {
        printed: printed.t,
        participants,
        splits_with_this_t: splits.iter().copied().filter(|s| rounds_to(s.t, printed.t)).collect(),
        participants_with_this_t,
        splits_with_this_summary: with_this_summary,
        closest: closest.expect("the range of participants is not empty"),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    #[test]
    fn says_what_the_issue_asks_for() {
        let Replication { comparisons, printed_t } = taylor_cameron().unwrap();
        let [mc, photo, video] = &comparisons[..] else { panic!() };
        let close = |value: f64, expected: f64, digit: f64| {
            assert!((value - expected).abs() < digit, "{value} is not {expected}");
        };
        close(mc.test.t, -1.437591, 5e-7);
        close(mc.test.p, 0.160569, 5e-7);
        close(photo.test.t, 4.208834, 5e-7);
        close(photo.test.p, 2.03782e-4, 5e-10);
        close(video.test.t, -3.983482, 5e-7);
        close(video.test.p, 3.66864e-4, 5e-10);
        // Half a choice of two pairs is a quarter of the share.
        let within =
            |c: &Comparison, share: f64| c.equivalence.iter().find(|e| e.within == share).unwrap().tests.p;
        close(within(mc, 0.25), 0.0114, 5e-5);
        // The curve falls as the bound grows, and what differs significantly is equivalent within no bound that a reader would take.
        assert!(mc.equivalence.windows(2).all(|two| two[0].tests.p > two[1].tests.p));
        assert!(within(video, 0.25) > 0.5 && within(photo, 0.2) > 0.5);
        close(mc.bayes.bf01, 2.1, 0.05);
        close(mc.effect.g, -0.248, 5e-4);
        close(mc.effect.g_interval.low, -0.590, 5e-4);
        close(mc.effect.g_interval.high, 0.098, 5e-4);
        close(mc.sign.p, 0.2379, 5e-5);
        assert!(mc.t_as_printed && photo.t_as_printed && !video.t_as_printed);
        assert_eq!((mc.reconstructions, photo.reconstructions, video.reconstructions), (1, 1, 1));
        assert_eq!(photo.p_holm, 3.0 * photo.test.p);
        assert_eq!(video.p_holm, 2.0 * video.test.p);
        assert_eq!(mc.p_holm, mc.test.p);
        assert!((mc.detectable.power - 0.8).abs() < 1e-9, "{:?}", mc.detectable);
        assert!(printed_t.splits_with_this_t.is_empty() && printed_t.participants_with_this_t.is_empty());
        assert_eq!(
            printed_t.splits_with_this_summary.iter().map(|s| (s.n, s.chosen)).collect::<Vec<_>>(),
            [(33, 7)]
        );
    }

    /// Control: the search finds a t that some split does give.
    #[test]
    fn the_search_finds_what_is_there() {
        let printed = Printed { mean: 0.212, sd: 0.415, t: -3.983 };
        let found = search_printed_t(printed, (25, 40)).unwrap();
        assert_eq!(found.participants_with_this_t, [33]);
        assert!(found.splits_with_this_t.iter().any(|s| (s.n, s.chosen) == (33, 7)));
        // The printed summary would need 22.5 participants.
        let any_number = search_printed_t(Printed { t: -3.293, ..printed }, (2, 60)).unwrap();
        assert!(any_number.participants_with_this_t.is_empty());
    }
}
