//! What came of the primary endpoint.

use super::{ALPHA, Report};
use crate::primary::{PrimaryEndpoint, PrimaryTest};
use kelir_stats::inference::binomial_test;
use serde::Serialize;
use utoipa::ToSchema;

/// The primary endpoint judged: one test, so that its p is not corrected for others.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct PrimaryReport {
    /// What was named.
    pub named: PrimaryEndpoint,
    /// What is tested, in words.
    pub of: String,
    /// Its p; null where the test is not defined.
    pub p: Option<f64>,
    /// The smallest p that random patterns of signs can give; null for a p that is computed.
    pub p_smallest: Option<f64>,
    /// Whether it decides: p below 0.05.
    pub found: bool,
    /// Participants who are judged in it.
    pub participants: u64,
}

/// Looks the named test up in a report.
pub(super) fn of(named: &PrimaryEndpoint, report: &Report) -> PrimaryReport {
    let block = named.block.as_ref().and_then(|id| report.blocks.iter().find(|b| b.summary.id == *id));
    let analysis = block.map(|block| &block.analysis);
    let (mut p_smallest, mut participants) = (None, block.map_or(0, |block| block.summary.n));
    let mut of = block.map_or(String::new(), |block| {
        let [a, b] = &block.summary.conditions;
        format!("{a} against {b} in the block {}", block.summary.title)
    });
    let p = match named.test {
        PrimaryTest::TTest => analysis.and_then(|a| a.t_test.p),
        PrimaryTest::Sign => analysis.and_then(|a| Some(a.sign.as_ref()?.p)),
        PrimaryTest::Wilcoxon => analysis.and_then(|a| Some(a.wilcoxon.as_ref()?.p)),
        PrimaryTest::Equivalence => analysis.and_then(|a| Some(a.equivalence?.tests.p)),
        PrimaryTest::Binomial => {
            let item =
                block.and_then(|b| b.by_item.iter().find(|item| Some(&item.id) == named.item.as_ref()));
            of = format!("the item {} of {of}", named.item.as_deref().unwrap_or_default());
            let share = item.and_then(|item| item.target.as_ref());
            participants = share.map_or(0, |share| share.participants);
            share.and_then(|share| Some(binomial_test(share.chosen, share.trials, 0.5).ok()?.p))
        }
        PrimaryTest::Scale => {
            let [a, b] = named.compare.clone().unwrap_or_default();
            of = format!("{a} against {b} on the scale");
            let scale = report.scale.as_ref();
            participants = scale.map_or(0, |scale| scale.observers as u64);
            let is_it = |x: &str, y: &str| (x, y) == (&*a, &*b) || (y, x) == (&*a, &*b);
            let found = scale.and_then(|scale| scale.differences.iter().find(|d| is_it(&d.a, &d.b)));
            p_smallest = found.filter(|d| !d.p_exact).map(|d| d.p_smallest);
            found.map(|d| d.p)
        }
    };
    PrimaryReport {
        named: named.clone(),
        of,
        p,
        p_smallest,
        found: p.is_some_and(|p| p < ALPHA),
        participants,
    }
}
