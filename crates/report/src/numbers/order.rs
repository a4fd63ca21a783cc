//! Numbers of sides, order and speed.

use super::{Number, Rows, Sample};
use kelir_stats::clustered::WithinSlope;
use kelir_stats::inference::Interval;
use kelir_study::report::{BlockOrder, OrderReport};

/// What is of all blocks together.
pub(crate) fn of_order(found: &OrderReport) -> Vec<Number> {
    let rows = Rows::of(Sample::Screened, "", "order");
    let mut all = Vec::new();
    if let Some(first) = &found.first {
        let share = first.chosen as f64 / first.trials as f64;
        let row =
            rows.number("share of what stood first, all blocks (proportion)", share, 3).with_p(first.test.p);
        let floor = (!first.test.exact).then_some(first.test.smallest);
        all.push(row.resolved_to(floor).of_n(first.trials, "sign flips of participants; n: choices"));
    }
    let leaning = rows.whole("keep to one side, after Holm (participants)", found.leaning.len() as u64);
    all.push(Number { n: Some(found.tested), ..leaning });
    let name = "agreement with most others, from a block's first trial to its last (proportion)";
    all.extend(found.agreement.as_ref().map(|slope| of_slope(rows, name, slope)));
    all
}

/// What is of one block.
pub(crate) fn of_block_order(found: &BlockOrder) -> Vec<Number> {
    let rows = Rows::of(Sample::Screened, &found.id, "order");
    let mut all = Vec::new();
    let name = "choice of the target, from the first trial to the last (proportion)";
    all.extend(found.place.as_ref().map(|slope| of_slope(rows, name, slope)));
    let name = "choice of the target, as response time grows by a tenth (proportion)";
    all.extend(found.speed.as_ref().map(|slope| of_slope(rows, name, slope)));
    if let Some(outliers) = found.outliers {
        let rows = rows.named("response time outliers");
        let fences = [
            ("fast", "below", outliers.below_ms, outliers.fast),
            ("slow", "above", outliers.above_ms, outliers.slow),
        ];
        for (what, side, ms, n) in fences {
            all.push(rows.number(format!("fence {side} which answers are {what} outliers (ms)"), ms, 0));
            all.push(
                rows.whole(format!("{what} outliers (answers)"), n).of_n(outliers.answers, "n: answers"),
            );
        }
    }
    all
}

fn of_slope(rows: Rows<'_>, name: &str, slope: &WithinSlope) -> Number {
    let interval = slope.low.zip(slope.high).map(|(low, high)| Interval { low, high, level: slope.level });
    let row = rows.number(name, slope.slope, 3).with_p(slope.p).resolved_to(Some(slope.p_smallest));
    Number { interval, ..row }
        .of_n(slope.participants, "change in the share; choices dealt out anew within participants")
}
