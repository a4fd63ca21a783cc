//! Numbers of the scale of all conditions.

use super::{Number, Rows, Sample};
use crate::format::count;
use kelir_stats::inference::Interval;
use kelir_stats::pairwise::ScaleIntervals;

/// Every number of a scale.
pub(crate) fn of_scale(sample: Sample, found: &ScaleIntervals) -> Vec<Number> {
    let rows = Rows::of(sample, "", "scale");
    let within = |low: Option<f64>, high: Option<f64>| {
        low.zip(high).map(|(low, high)| Interval { low, high, level: found.level })
    };
    let observers = Some(found.observers as u64);
    let mut all: Vec<Number> = found
        .conditions
        .iter()
        .map(|c| {
            let row = rows.number(format!("{} (JOD)", c.condition), c.jod, 3);
            Number { n: observers, interval: within(c.low, c.high), ..row }
        })
        .collect();
    for d in &found.differences {
        let row = rows.named("scale, differences").number(format!("{} − {} (JOD)", d.a, d.b), d.jod, 3);
        let row = Number { interval: within(d.low, d.high), ..row };
        let patterns = if d.p_exact {
            "all patterns of signs".to_owned()
        } else {
            count(found.flips as u64, "random pattern")
        };
        let floor = (!d.p_exact).then_some(d.p_smallest);
        all.push(row.with_p(d.p).resolved_to(floor).noted(format!("sign flips of participants, {patterns}")));
        let corrected = format!("{} − {}, p corrected by Holm for all differences (JOD)", d.a, d.b);
        let row = rows.named("scale, differences").number(corrected, d.jod, 3).with_p(d.p_holm);
        all.push(row);
    }
    let fit = &found.scale;
    if fit.deviance_df > 0 {
        let row =
            rows.named("scale, fit").number(format!("deviance (df = {})", fit.deviance_df), fit.deviance, 3);
        all.push(row.with_p(fit.deviance_p).noted("small p: one axis does not hold the choices"));
    }
    all
}
