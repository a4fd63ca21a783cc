//! How many participants a study needs: simulated observers take the study itself (its plans, sides, catch trials, screening), and the
//! report that judges real answers judges theirs.

mod crowd;
mod design;
mod findings;
#[cfg(test)]
mod tests;

pub use design::{Design, DesignFile, Observers, Supposed, Truth};
pub use kelir_stats::simulate::Rate;

use crate::answers::Participant;
use crate::primary::PrimaryEndpoint;
use crate::report::{LEVEL, REPLICATES, Report};
use crate::screening::screen;
use crowd::Crowd;
use findings::{Claims, Outcome};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use utoipa::ToSchema;

/// What simulated studies of several sizes found.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Power {
    /// Study's id.
    pub study: String,
    /// Hash of the study's design; which pictures it shows makes no difference here.
    pub design_hash: String,
    /// Simulated studies of each size.
    pub simulations: u64,
    /// Seed that repeats them.
    pub seed: u64,
    /// Level of the tests.
    pub alpha: f64,
    /// The power that is wanted.
    pub power: f64,
    /// Level of the intervals.
    pub level: f64,
    /// Resamples of a threshold's bootstrap.
    pub replicates: usize,
    /// The one test that the study is made to decide, judged by itself; null where the study file names none.
    pub primary: Option<PrimaryEndpoint>,
    /// By number of participants, rising.
    pub sizes: Vec<Size>,
    /// For each test that asks for something that is there: the fewest participants, of those tried, with which it is found often enough.
    pub needed: Vec<Needed>,
}

/// Simulated studies of one size.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Size {
    /// Participants who began.
    pub participants: u32,
    /// Mean share of them that the study's rules exclude, drop-outs included where they do.
    pub excluded: f64,
    /// The report's tests.
    pub tests: Vec<TestRate>,
    /// The report's intervals.
    pub intervals: Vec<IntervalRate>,
}

/// How often a test says yes.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct TestRate {
    /// Block's id, or two conditions.
    pub of: String,
    /// Which test.
    pub test: &'static str,
    /// Whether it is the primary endpoint; such a row comes first.
    pub primary: bool,
    /// Whether the test's null hypothesis is true, so that the rate is of false alarms.
    pub null: bool,
    /// How often it is significant at the level `alpha`; in studies where it is not defined it finds nothing. A test that was defined in no
    /// simulated study of any size (a random intercept with one choice each) is left out, the primary endpoint never.
    pub rate: Rate,
}

/// How often an interval holds what is true.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct IntervalRate {
    /// Block's id, or two conditions.
    pub of: String,
    /// Which interval.
    pub interval: &'static str,
    /// The true value; null where it is not defined (then nothing is covered).
    pub truth: Option<f64>,
    /// How often the interval holds it.
    pub coverage: Rate,
    /// Its mean width, in the value's unit; null without intervals.
    pub width: Option<f64>,
}

/// The fewest participants for a wanted power.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Needed {
    /// Block's id, or two conditions.
    pub of: String,
    /// Which test.
    pub test: &'static str,
    /// Whether it is the primary endpoint.
    pub primary: bool,
    /// The fewest of those tried; null: more than any.
    pub participants: Option<u32>,
    /// The test's rate there, or at the most that were tried.
    pub rate: Rate,
}

/// Told after each simulated study of every size: how many there have been, and what they come to so far.
pub type Watch<'a> = &'a (dyn Fn(u64, &dyn Fn() -> Power) + Sync);

/// Simulates the design on so many threads. Studies are added up in their order, whichever thread did them and when: neither the result nor what
/// `watch` is told after so many of them depends on the threads.
pub fn power(design: &Design, threads: usize, watch: Watch<'_>) -> Power {
    let crowd = Crowd::new(design);
    let claims = Claims::new(design);
    let next = AtomicU64::new(0);
    let line = Mutex::new(Line { total: Sums::new(design, &claims), added: 0, waiting: BTreeMap::new() });
    let work = || loop {
        let run = next.fetch_add(1, Ordering::Relaxed);
        if run >= design.simulations {
            return;
        }
        let mut sums = Sums::new(design, &claims);
        sums.add(&crowd, &claims, run);
        let mut line = line.lock().unwrap_or_else(PoisonError::into_inner);
        line.waiting.insert(run, sums);
        line.advance(|total, added| watch(added, &|| total.power(design, &claims, added)));
    };
    std::thread::scope(|scope| {
        (1..threads).for_each(|_| drop(scope.spawn(work)));
        work();
    });
    let line = line.into_inner().unwrap_or_else(PoisonError::into_inner);
    line.total.power(design, &claims, line.added)
}

/// Simulated studies as they are added up: in their order.
struct Line {
    total: Sums,
    added: u64,
    /// Those that were done before an earlier one was.
    waiting: BTreeMap<u64, Sums>,
}

impl Line {
    /// Adds whatever is next; `tell` hears of each.
    fn advance(&mut self, tell: impl Fn(&Sums, u64)) {
        while let Some(sums) = self.waiting.remove(&self.added) {
            self.total.merge(&sums);
            self.added += 1;
            tell(&self.total, self.added);
        }
    }
}

/// Sums over simulated studies, by size.
struct Sums {
    sizes: Vec<SizeSums>,
}

struct SizeSums {
    excluded: u64,
    runs: u64,
    tests: Vec<Tally>,
    intervals: Vec<Tally>,
    widths: Vec<(f64, u64)>,
}

/// Yes, counted, undefined, and of the counted those that were defined.
#[derive(Clone, Copy, Default)]
struct Tally {
    hits: u64,
    runs: u64,
    undefined: u64,
    defined: u64,
}

impl Tally {
    fn add(&mut self, found: Option<bool>) {
        match found {
            Some(found) => {
                self.runs += 1;
                self.defined += 1;
                self.hits += u64::from(found);
            }
            None => self.undefined += 1,
        }
    }

    /// A test that is not defined finds nothing.
    fn add_test(&mut self, found: Option<bool>) {
        self.runs += 1;
        self.defined += u64::from(found.is_some());
        self.hits += u64::from(found == Some(true));
    }

    fn merge(&mut self, other: &Tally) {
        self.hits += other.hits;
        self.runs += other.runs;
        self.undefined += other.undefined;
        self.defined += other.defined;
    }

    fn rate(&self) -> Rate {
        Rate::new(self.hits, self.runs, self.undefined)
    }
}

impl Sums {
    fn new(design: &Design, claims: &Claims) -> Sums {
        let size = || SizeSums {
            excluded: 0,
            runs: 0,
            tests: vec![Tally::default(); claims.tests.len()],
            intervals: vec![Tally::default(); claims.intervals.len()],
            widths: vec![(0.0, 0); claims.intervals.len()],
        };
        Sums { sizes: design.participants.iter().map(|_| size()).collect() }
    }

    /// One simulated study of each size; a larger one is a smaller one and more people.
    fn add(&mut self, crowd: &Crowd<'_>, claims: &Claims, run: u64) {
        let answers = crowd.take(run);
        let everybody = answers.participants();
        for (sums, &size) in self.sizes.iter_mut().zip(&crowd.design.participants) {
            let of_size = everybody.iter().copied().filter(|p| crowd::index(&p.session_id) < size);
            let (kept, excluded): (Vec<&Participant>, Vec<&Participant>) =
                of_size.partition(|p| screen(&crowd.design.study, p, &[]).is_empty());
            let report = Report::claims(&crowd.design.study, &kept);
            let Outcome { tests, intervals } = claims.check(&report, crowd.design.alpha);
            sums.runs += 1;
            sums.excluded += excluded.len() as u64;
            sums.tests.iter_mut().zip(tests).for_each(|(tally, found)| tally.add_test(found));
            for (i, interval) in intervals.into_iter().enumerate() {
                let truth = claims.intervals[i].truth;
                sums.intervals[i].add(interval.zip(truth).map(|([low, high], x)| low <= x && x <= high));
                if let Some([low, high]) = interval {
                    sums.widths[i].0 += high - low;
                    sums.widths[i].1 += 1;
                }
            }
        }
    }

    fn merge(&mut self, other: &Sums) {
        for (own, other) in self.sizes.iter_mut().zip(&other.sizes) {
            own.excluded += other.excluded;
            own.runs += other.runs;
            own.tests.iter_mut().zip(&other.tests).for_each(|(a, b)| a.merge(b));
            own.intervals.iter_mut().zip(&other.intervals).for_each(|(a, b)| a.merge(b));
            for (a, b) in own.widths.iter_mut().zip(&other.widths) {
                *a = (a.0 + b.0, a.1 + b.1);
            }
        }
    }

    fn power(&self, design: &Design, claims: &Claims, simulations: u64) -> Power {
        let made: Vec<usize> = (0..claims.tests.len())
            .filter(|&i| claims.tests[i].primary || self.sizes.iter().any(|sums| sums.tests[i].defined > 0))
            .collect();
        let sizes: Vec<Size> = design
            .participants
            .iter()
            .zip(&self.sizes)
            .map(|(&participants, sums)| Size {
                participants,
                excluded: sums.excluded as f64 / (sums.runs.max(1) * u64::from(participants)) as f64,
                tests: made
                    .iter()
                    .map(|&i| (&claims.tests[i], &sums.tests[i]))
                    .map(|(claim, tally)| TestRate {
                        of: claim.of.clone(),
                        test: claim.test,
                        primary: claim.primary,
                        null: claim.null,
                        rate: tally.rate(),
                    })
                    .collect(),
                intervals: claims
                    .intervals
                    .iter()
                    .zip(sums.intervals.iter().zip(&sums.widths))
                    .map(|(claim, (tally, &(width, n)))| IntervalRate {
                        of: claim.of.clone(),
                        interval: claim.interval,
                        truth: claim.truth,
                        coverage: tally.rate(),
                        width: (n > 0).then(|| width / n as f64),
                    })
                    .collect(),
            })
            .collect();
        let needed = made
            .iter()
            .map(|&i| &claims.tests[i])
            .enumerate()
            .filter(|(_, claim)| !claim.null)
            .filter_map(|(i, claim)| {
                let enough = sizes.iter().find(|size| size.tests[i].rate.rate >= design.power);
                let rate = enough.or(sizes.last())?.tests[i].rate;
                let participants = enough.map(|size| size.participants);
                let (of, test, primary) = (claim.of.clone(), claim.test, claim.primary);
                Some(Needed { of, test, primary, participants, rate })
            })
            .collect();
        Power {
            study: design.study.id.clone(),
            design_hash: design.study.design_hash(),
            simulations,
            seed: design.seed,
            alpha: design.alpha,
            power: design.power,
            level: LEVEL,
            replicates: REPLICATES,
            primary: design.study.primary.clone(),
            sizes,
            needed,
        }
    }
}
