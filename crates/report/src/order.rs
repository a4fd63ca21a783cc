//! Sides, order and speed: what besides the conditions went with the choices.

use crate::StudyReport;
use crate::blocks::table;
use crate::document::{Piece, Section};
use crate::format::{count, fixed, list, percent, resolved_p_equals};
use crate::numbers::{of_block_order, of_order};
use kelir_stats::clustered::WithinSlope;
use kelir_study::report::{ALPHA, BlockOrder, FENCES, FirstTest, OrderReport};

/// Participants that are named one by one.
const MOST_NAMED: usize = 20;

/// The section; nothing without answers.
pub(crate) fn section(report: &StudyReport) -> Option<Section> {
    let found = report.report.order.as_ref()?;
    let mut lines: Vec<String> = found.first.iter().map(first).collect();
    lines.push(leaning(found));
    lines.extend(found.agreement.as_ref().map(|slope| {
        changed("From a block's first trial to its last, agreement with most others in the same pair", slope)
    }));
    let mut pieces = vec![
        Piece::Text("The study file plans none of what stands here, and no result rests on it: it is to look at, and to plan the next study by.".to_owned()),
        Piece::List(lines),
        Piece::Table(table("All blocks together.", &of_order(found))),
    ];
    for block in &found.blocks {
        let numbers = of_block_order(block);
        if numbers.is_empty() {
            continue;
        }
        let summary = report.report.blocks.iter().map(|b| &b.summary).find(|summary| summary.id == block.id);
        let (title, target) = summary.map_or(("", ""), |summary| (&summary.title, &summary.target));
        pieces.push(Piece::Heading(title.to_owned()));
        let lines = of_block(block, target);
        pieces.extend((!lines.is_empty()).then_some(Piece::List(lines)));
        pieces.push(Piece::Table(table("", &numbers)));
    }
    Some(Section::new("Sides, order and speed (exploratory)", pieces))
}

fn first(found: &FirstTest) -> String {
    let (twice, trials) = (2 * found.chosen, found.trials);
    let p = resolved_p_equals(found.test.p, (!found.test.exact).then_some(found.test.smallest));
    let what = format!(
        "What stood first (left, above or earlier) was chosen in {} of {} by {}",
        percent(found.chosen as f64 / trials as f64),
        count(trials, "choice"),
        count(found.participants, "participant")
    );
    let verdict = match twice.cmp(&trials) {
        _ if found.test.p >= ALPHA => "not shown to be other than half",
        std::cmp::Ordering::Less => "less often than half",
        _ => "more often than half",
    };
    format!("{what}: {verdict}, {p} by sign flips.")
}

fn leaning(found: &OrderReport) -> String {
    // The least p that all choices on one side can have, times as many as were tested.
    let least = 2.0 * 0.5f64.powf(found.most_trials as f64) * found.tested as f64;
    if found.leaning.is_empty() {
        let could = if least >= ALPHA {
            format!(": with at most {} each nobody could be", count(found.most_trials, "choice"))
        } else {
            String::new()
        };
        return format!(
            "Of {} none is shown to keep to one side (exact binomial test, corrected by Holm){could}.",
            count(found.tested, "participant")
        );
    }
    let mut named: Vec<String> = found
        .leaning
        .iter()
        .take(MOST_NAMED)
        .map(|one| format!("{} ({} of {} first)", one.session_id, one.first, one.trials))
        .collect();
    if found.leaning.len() > MOST_NAMED {
        named.push(format!("{} more", found.leaning.len() - MOST_NAMED));
    }
    let keeps = if found.leaning.len() == 1 { "keeps" } else { "keep" };
    format!(
        "Of {} {} {keeps} to one side (exact binomial test, corrected by Holm): {}.",
        count(found.tested, "participant"),
        found.leaning.len(),
        list(&named)
    )
}

/// What a slope of a share comes to.
fn changed(what: &str, slope: &WithinSlope) -> String {
    let p = resolved_p_equals(slope.p, Some(slope.p_smallest));
    let points = |x: f64| fixed(100.0 * x, 0);
    let interval = match slope.low.zip(slope.high) {
        Some((low, high)) => format!(", 95% interval {} to {}", points(low), points(high)),
        None => String::new(),
    };
    let by = format!("{} percentage points{interval}, {p}", points(slope.slope));
    match slope.slope {
        _ if slope.p >= ALPHA => format!("{what} is not shown to change ({by})."),
        x if x > 0.0 => format!("{what} grows ({by})."),
        _ => format!("{what} falls ({by})."),
    }
}

fn of_block(block: &BlockOrder, target: &str) -> Vec<String> {
    let mut lines = Vec::new();
    lines.extend(
        block
            .place
            .as_ref()
            .map(|slope| changed(&format!("From the first trial to the last, the share of {target}"), slope)),
    );
    lines.extend(block.speed.as_ref().map(|slope| {
        let what = format!("As response time grows by a tenth within a participant, the share of {target}");
        changed(&what, slope)
    }));
    lines.extend(block.outliers.map(|o| {
        format!(
            "Response times: {} below {} ms and {} above {} ms are outliers, of {} (beyond {FENCES} interquartile ranges of the logarithm); they are counted, not \
             left out.",
            o.fast,
            fixed(o.below_ms, 0),
            o.slow,
            fixed(o.above_ms, 0),
            count(o.answers, "answer")
        )
    }));
    lines
}
