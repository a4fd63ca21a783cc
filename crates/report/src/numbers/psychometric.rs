//! Numbers of psychometric functions.

use super::{Number, Rows, Sample, resampled};
use kelir_stats::inference::Interval;
use kelir_study::report::{LEVEL, Parameter, PsychometricReport};

/// Every number of a psychometric function.
pub(crate) fn psychometric(sample: Sample, block: &str, found: &PsychometricReport) -> Vec<Number> {
    let unit = match &found.asked.unit {
        Some(unit) => format!("{}, {unit}", found.asked.label),
        None => found.asked.label.clone(),
    };
    let rows = Rows::of(sample, block, "psychometric function");
    let mut all = Vec::new();
    for point in &found.points {
        all.extend(
            point
                .target
                .as_ref()
                .map(|share| rows.share(format!("share of target at {} (proportion)", point.level), share)),
        );
    }
    let Some(fit) = &found.fit else { return all };
    let posterior = |name: String, p: &Parameter| {
        let interval = Interval { low: p.low, high: p.high, level: LEVEL };
        let note =
            if p.on_edge { "posterior interval; not bounded by the data" } else { "posterior interval" };
        rows.number(name, p.value, 4).within(interval).noted(note)
    };
    all.push(posterior(format!("threshold, F = ½ ({unit})"), &fit.threshold));
    all.push(posterior(format!("width, F = 5% to 95% ({unit})"), &fit.width));
    all.push(posterior("lapse rate (proportion)".to_owned(), &fit.lapse));
    all.push(posterior("overdispersion η (0 to 1)".to_owned(), &fit.eta));
    if let Some(found) = &fit.threshold_by_participant {
        let b = &found.bootstrap;
        let row = rows.number(format!("threshold, maximum likelihood ({unit})"), b.estimate, 4);
        let note = match found.at_bound {
            0 => "interval from resampled participants".to_owned(),
            n => format!(
                "interval from resampled participants; {n} of {} resamples ended on the edge of the range searched",
                b.replicates
            ),
        };
        all.push(row.within(resampled(b)).noted(note));
    }
    for at in &fit.at {
        let name = format!("level at a share of {} ({unit})", at.share);
        // What no level reaches is beyond all of them.
        let interval = Interval {
            low: at.low.unwrap_or(f64::NEG_INFINITY),
            high: at.high.unwrap_or(f64::INFINITY),
            level: LEVEL,
        };
        let reached = if at.level.is_some() { "" } else { "; the curve itself never reaches this share" };
        let note = match (at.low, at.high) {
            (Some(_), Some(_)) => format!("posterior interval{reached}"),
            (None, None) => format!("posterior interval: both ends are beyond every level{reached}"),
            (None, _) => format!("posterior interval; its lower end is beyond every level{reached}"),
            (_, None) => format!("posterior interval; its upper end is beyond every level{reached}"),
        };
        all.push(Number { value: at.level, ..rows.number(name, f64::NAN, 4) }.within(interval).noted(note));
    }
    if let Some(goodness) = &fit.goodness {
        let row = rows.number("deviance", goodness.deviance, 3).with_p(goodness.p_simulated);
        let row = row.resolved_to(Some(1.0 / (1.0 + goodness.simulations as f64)));
        all.push(row.of_n(goodness.simulations as u64, "n: simulated observers"));
    }
    all
}
