//! How often the intervals of a report hold the truth, in fixed cells.

use super::{Rate, check_runs};
use crate::Result;
use crate::clustered::{Cluster, share_interval};
use crate::normal;
use crate::pairwise::{Choice, Model, Observer, ScaleOptions, observer_intervals};
use crate::psychometric::{Level, Sigmoid, Task, posterior, resampled_threshold};
use crate::random::Random;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Confidence level of every interval.
const LEVEL: f64 = 0.95;
/// Random patterns of signs, and resamples: the fewest there may be.
const FLIPS: usize = 1000;
const REPLICATES: usize = 2000;
/// The least coverage in a cell of at least [`MANY`] participants, in one of fewer, and on average.
const BARS: [f64; 3] = [0.92, 0.88, 0.94];
/// From so many participants on a cell has the higher bar.
const MANY: u64 = 12;

/// An interval that a report shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Shown {
    /// The share of target choices, over participants: in closed form.
    Share,
    /// The differences on the scale of three conditions, by leaving out participants.
    Scale,
    /// The threshold of a psychometric function, by resampling participants.
    ResampledThreshold,
    /// The same by its posterior, which takes a participant's answers as independent.
    PosteriorThreshold,
}

/// A design with a truth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct CoverageCell {
    /// Participants.
    pub participants: u64,
    /// Choices each makes: of a share in all, of a scale between each two conditions, of a threshold at each level.
    pub pairs: u64,
    /// True share: of target choices; of choices of the first condition over the second and the third; of F at the middle level.
    pub share: f64,
    /// True intraclass correlation of a participant's choices; of scale and threshold, on the latent scale.
    pub icc: f64,
}

const fn cell(participants: u64, pairs: u64, share: f64, icc: f64) -> CoverageCell {
    CoverageCell { participants, pairs, share, icc }
}

/// The cells, every third of which is one of the four that are tried at each change.
pub const CELLS: [CoverageCell; 12] = [
    cell(6, 2, 0.5, 0.3),
    cell(6, 4, 0.75, 0.1),
    cell(6, 4, 0.9, 0.0),
    cell(12, 1, 0.75, 0.0),
    cell(12, 2, 0.9, 0.1),
    cell(12, 4, 0.5, 0.3),
    cell(20, 4, 0.6, 0.1),
    cell(20, 2, 0.75, 0.3),
    cell(20, 1, 0.9, 0.0),
    cell(32, 2, 0.9, 0.3),
    cell(32, 4, 0.75, 0.1),
    cell(32, 1, 0.5, 0.0),
];

/// How often one interval held the truth in one cell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Coverage {
    /// Which interval.
    pub shown: Shown,
    /// Where.
    pub cell: CoverageCell,
    /// How often; what has no interval, for which a report says why, is not counted.
    pub rate: Rate,
}

impl Shown {
    /// Every interval.
    pub const ALL: [Shown; 4] =
        [Shown::Share, Shown::Scale, Shown::ResampledThreshold, Shown::PosteriorThreshold];

    /// What it is of and how it is found.
    pub fn name(self) -> &'static str {
        match self {
            Shown::Share => "share of choices",
            Shown::Scale => "differences on the scale",
            Shown::ResampledThreshold => "threshold, participants resampled",
            Shown::PosteriorThreshold => "threshold, posterior",
        }
    }

    /// Whether each interval of one simulated study holds the truth; `None`: it has none.
    fn study(self, cell: &CoverageCell, random: &mut Random) -> Vec<Option<bool>> {
        match self {
            Shown::Share => vec![share(cell, random)],
            Shown::Scale => scale(cell, random),
            Shown::ResampledThreshold | Shown::PosteriorThreshold => vec![threshold(self, cell, random)],
        }
    }
}

/// Simulates `runs` studies in a cell; deterministic for a seed. Errors: no runs.
pub fn coverage(shown: Shown, cell: &CoverageCell, runs: u64, seed: u64) -> Result<Coverage> {
    check_runs(runs)?;
    let outcomes = (0..runs).flat_map(|run| shown.study(cell, &mut Random::stream(seed, run)));
    Ok(Coverage { shown, cell: *cell, rate: Rate::of(outcomes) })
}

impl CoverageCell {
    /// The least coverage that is good enough here.
    pub fn least(&self) -> f64 {
        if self.participants < MANY { BARS[1] } else { BARS[0] }
    }

    /// Variance of participants' own leanings, where that of a single choice is 1.
    fn latent_variance(&self) -> f64 {
        self.icc / (1.0 - self.icc)
    }
}

impl Coverage {
    /// Monte-Carlo standard error of the rate.
    pub fn error(&self) -> f64 {
        let (p, n) = (self.rate.rate, self.rate.runs.max(1) as f64);
        (p * (1.0 - p) / n).sqrt()
    }
}

/// What of these falls below its bar by more than two Monte-Carlo errors (those at the bar), a sentence each: cells, then each interval on average.
pub fn shortfalls(found: &[Coverage]) -> Vec<String> {
    let missed = |rate: f64, bar: f64, runs: f64| rate < bar - 2.0 * (bar * (1.0 - bar) / runs).sqrt();
    let mut short: Vec<String> = found
        .iter()
        .filter(|c| missed(c.rate.rate, c.cell.least(), c.rate.runs.max(1) as f64))
        .map(|Coverage { shown, cell, rate }| {
            format!(
                "{}: {:.1}% of {} are held with {} participants, {} choices, a share of {} and a correlation of {}; at least {}% must be",
                shown.name(),
                100.0 * rate.rate,
                rate.runs,
                cell.participants,
                cell.pairs,
                cell.share,
                cell.icc,
                100.0 * cell.least()
            )
        })
        .collect();
    for shown in Shown::ALL {
        let own: Vec<&Coverage> = found.iter().filter(|c| c.shown == shown).collect();
        let runs: u64 = own.iter().map(|c| c.rate.runs).sum();
        let mean = own.iter().map(|c| c.rate.rate).sum::<f64>() / own.len().max(1) as f64;
        if !own.is_empty() && missed(mean, BARS[2], runs.max(1) as f64) {
            short.push(format!(
                "{}: {:.1}% on average; at least {}% must be held",
                shown.name(),
                100.0 * mean,
                100.0 * BARS[2]
            ));
        }
    }
    short
}

fn share(cell: &CoverageCell, random: &mut Random) -> Option<bool> {
    let clusters: Vec<Cluster> = (0..cell.participants)
        .map(|_| {
            let p = random.beta(cell.share, cell.icc);
            Cluster { successes: random.binomial(cell.pairs, p), trials: cell.pairs }
        })
        .collect();
    let found = share_interval(&clusters, LEVEL).ok()?;
    Some(found.low <= cell.share && cell.share <= found.high)
}

/// Observers with positions of their own, whose pooled choices are Thurstone's with the truth that the share says.
fn scale(cell: &CoverageCell, random: &mut Random) -> Vec<Option<bool>> {
    let unit = Model::Thurstone.jod();
    // A difference of two own positions has the latent variance, each of them half.
    let (own_sd, stretch) =
        ((0.5 * cell.latent_variance()).sqrt() * unit, (1.0 + cell.latent_variance()).sqrt());
    let truth = [unit * normal::quantile(cell.share), 0.0, 0.0];
    let pairs = [[0, 1], [0, 2], [1, 2]];
    let observer = |id: u64, random: &mut Random| {
        let own = truth.map(|x| x * stretch + own_sd * random.normal());
        let mut choices = Vec::new();
        for [i, j] in pairs {
            let won = random.binomial(cell.pairs, Model::Thurstone.probability(own[i] - own[j]));
            choices.push(Choice { winner: i, loser: j, times: won });
            choices.push(Choice { winner: j, loser: i, times: cell.pairs - won });
        }
        Observer { id: id.to_string(), choices }
    };
    let observers: Vec<Observer> = (0..cell.participants).map(|id| observer(id, random)).collect();
    let names = ["a", "b", "c"].map(str::to_owned);
    let Ok(found) = observer_intervals(&names, &observers, ScaleOptions::default(), FLIPS, LEVEL, 1) else {
        return vec![None; pairs.len()];
    };
    let held = found.differences.iter().zip(pairs).map(|(d, [i, j])| {
        let truth = truth[i] - truth[j];
        d.low.zip(d.high).map(|(low, high)| low <= truth && truth <= high)
    });
    held.collect()
}

/// Lapses of the simulated participants.
const LAPSE: f64 = 0.02;
/// Levels, in standard deviations of one participant's curve.
const LEVELS: [f64; 6] = [-2.5, -1.5, -0.5, 0.5, 1.5, 2.5];

/// Participants with thresholds of their own, whose pooled answers are a normal curve about the truth that the share says.
fn threshold(shown: Shown, cell: &CoverageCell, random: &mut Random) -> Option<bool> {
    let stretch = (1.0 + cell.latent_variance()).sqrt();
    let truth = -normal::quantile(cell.share) * stretch;
    let people: Vec<Vec<Level>> = (0..cell.participants)
        .map(|_| {
            let own = truth + cell.latent_variance().sqrt() * random.normal();
            let level = |x: &f64| {
                let x = x * stretch;
                let p = 0.5 + (0.5 - LAPSE) * normal::cdf(x - own);
                Level { x, correct: random.binomial(cell.pairs, p), trials: cell.pairs }
            };
            LEVELS.iter().map(level).collect()
        })
        .collect();
    let task = Task { sigmoid: Sigmoid::Gaussian, ..Task::default() };
    let (low, high) = if shown == Shown::ResampledThreshold {
        let found = resampled_threshold(&people, &task, REPLICATES, LEVEL, 1).ok()?.bootstrap;
        (found.low, found.high)
    } else {
        let all: Vec<Level> = people.into_iter().flatten().collect();
        let found = posterior(&all, &Task { overdispersion: true, ..task }, LEVEL, &[]).ok()?.threshold;
        (found.low_centred, found.high_centred)
    };
    Some(low <= truth && truth <= high)
}
