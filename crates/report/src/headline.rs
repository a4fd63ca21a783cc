//! What was asked, what was found, and what was not shown.

use crate::StudyReport;
use crate::document::{Piece, Section, short};
use crate::format::{count, fixed, list, p_equals, percent, resolved_p_equals, significant};
use kelir_study::PrimaryTest;
use kelir_study::report::{ALPHA, BlockReport, DETECTION_POWER, PrimaryReport};

/// The report's first section.
pub(crate) fn section(report: &StudyReport) -> Section {
    let mut pieces = Vec::new();
    let unexplained = report.chain.faults.iter().filter(|fault| fault.note.is_none());
    pieces.extend(unexplained.take(MOST_FAULTS).map(|fault| {
        Piece::Warning(format!("{}. Do not use these data before you know why.", fault.sentence()))
    }));
    if report.pooled.len() > 1 {
        pieces.push(Piece::Warning(pooling(report)));
    }
    pieces.push(Piece::Heading("Asked".to_owned()));
    pieces.push(Piece::List(asked(report)));
    match &report.report.primary {
        Some(primary) if !report.is_empty() => {
            pieces.push(Piece::Heading("Found, primary endpoint".to_owned()));
            pieces.push(Piece::List(vec![decided(primary)]));
            pieces.push(Piece::Heading("Found besides, secondary and exploratory".to_owned()));
        }
        _ => pieces.push(Piece::Heading("Found".to_owned())),
    }
    pieces.push(Piece::List(found(report)));
    if !report.is_empty() {
        pieces.push(Piece::Heading("Not shown".to_owned()));
        pieces.push(Piece::List(not_shown(report)));
    }
    Section::new("In short", pieces)
}

/// Faults that are told in short; the table of data has them all.
const MOST_FAULTS: usize = 5;

/// Which versions are pooled, and what they do not show alike.
fn pooling(report: &StudyReport) -> String {
    let versions: Vec<String> = report
        .pooled
        .iter()
        .map(|v| {
            format!(
                "{} ({}, {})",
                short(&v.version),
                count(v.sessions, "session"),
                count(v.answers, "answer")
            )
        })
        .collect();
    let different: Vec<String> =
        report.different_stimuli.iter().map(|s| format!("{} ({})", s.item, s.condition)).collect();
    let shown = match different.as_slice() {
        [] => "They show the same pictures.".to_owned(),
        some => {
            format!("They do not show the same: {}. A number below is of all of these together.", list(some))
        }
    };
    format!("Answers to {} versions of the study are pooled: {}. {shown}", versions.len(), list(&versions))
}

/// What came of the primary endpoint.
fn decided(primary: &PrimaryReport) -> String {
    let test = primary.named.test;
    let people = count(primary.participants, "participant");
    let Some(p) = primary.p else {
        return format!("{}: the {} of {people} is not defined.", primary.of, test.in_words());
    };
    let what = if test == PrimaryTest::Equivalence { "equivalence to a half" } else { "a difference" };
    let verdict = if primary.found { "shown" } else { "not shown" };
    let p = resolved_p_equals(p, primary.p_smallest);
    format!(
        "{}: {what} is {verdict} by the {} of {people}, {p}, uncorrected as the only primary test.",
        primary.of,
        test.in_words()
    )
}

/// Which result was singled out beforehand.
fn endpoint(report: &StudyReport) -> String {
    match &report.report.primary {
        None => "The study file names no primary endpoint: none of the results was singled out beforehand."
            .to_owned(),
        Some(primary) => {
            format!("Primary endpoint: {}, by the {}.", primary.of, primary.named.test.in_words())
        }
    }
}

fn asked(report: &StudyReport) -> Vec<String> {
    let comparisons = report.report.blocks.iter().map(|block| {
        let [a, b] = &block.summary.conditions;
        format!("{}: {a} against {b}, {}.", block.summary.title, count(block.summary.items as u64, "pair"))
    });
    let question = std::iter::once(format!("“{}”", report.question));
    question.chain(comparisons).chain([endpoint(report)]).collect()
}

/// The other condition of a block.
fn other(block: &BlockReport) -> &str {
    let [a, b] = &block.summary.conditions;
    if *a == block.summary.target { b } else { a }
}

/// Whether the share is shown to be equivalent to a half.
fn equivalent(block: &BlockReport) -> bool {
    block.analysis.equivalence.is_some_and(|found| found.tests.p < ALPHA)
}

fn significant_after_holm(block: &BlockReport) -> bool {
    block.p_holm.is_some_and(|p| p < ALPHA)
}

fn found(report: &StudyReport) -> Vec<String> {
    if report.is_empty() {
        return vec![report.standing.summary.clone()];
    }
    let line = |block: &BlockReport| [of_block(block), pairs(block)].join(" ").trim_end().to_owned();
    let mut lines: Vec<String> = report.report.blocks.iter().map(line).collect();
    if let Some(scale) = &report.report.scale {
        let mut order: Vec<_> = scale.conditions.iter().collect();
        order.sort_by(|a, b| b.jod.total_cmp(&a.jod));
        let names: Vec<String> =
            order.iter().map(|c| format!("{} ({})", c.condition, fixed(c.jod, 2))).collect();
        let sure = scale.differences.iter().filter(|d| d.p_holm < ALPHA).count();
        lines.push(format!(
            "On one scale, in JOD, from the highest place to the lowest: {}. {} of {} differences have p < {ALPHA} after Holm's correction.",
            list(&names),
            sure,
            scale.differences.len()
        ));
    }
    for block in &report.report.blocks {
        let Some(fit) = block.psychometric.as_ref().and_then(|p| p.fit.as_ref()) else { continue };
        let t = &fit.threshold;
        lines.push(format!(
            "{}: threshold at {} (95% posterior interval {} to {}).",
            block.summary.title,
            significant(t.value, 4),
            significant(t.low, 4),
            significant(t.high, 4)
        ));
    }
    lines
}

fn of_block(block: &BlockReport) -> String {
    let (summary, analysis) = (&block.summary, &block.analysis);
    let (title, target, other) = (&summary.title, &summary.target, other(block));
    let Some(share) = &analysis.proportion else {
        if let (true, Some(note)) = (block.first.is_some() && summary.counts.is_empty(), &summary.note) {
            return format!(
                "{title}: {} went to the end of the procedure; {note}.",
                count(summary.n, "participant")
            );
        }
        return format!("{title}: {}.", crate::blocks::none_judged(summary));
    };
    let interval = share.interval().map_or("no interval".to_owned(), |i| {
        format!("95% interval {} to {}", percent(i.low), percent(i.high))
    });
    let chose = format!(
        "{title}: {} chose {target} over {other} in {} of {} ({interval})",
        count(summary.n, "participant"),
        percent(share.proportion),
        count(share.trials, "choice"),
    );
    let (Some(t), Some(df), Some(p), Some(mean)) = (summary.t, summary.df, summary.p, summary.mean) else {
        let why = summary.note.as_deref().unwrap_or("t is not defined");
        // Where everybody chose alike, who is above and who below half the pairs still says something.
        let sign = analysis
            .sign
            .as_ref()
            .map_or(String::new(), |sign| format!(", but the exact sign test gives {}", p_equals(sign.p)));
        return format!("{chose}; no t-test: {why}{sign}.");
    };
    let holm = match block.p_holm {
        Some(corrected) if corrected != p => format!(", after Holm {}", p_equals(corrected)),
        _ => String::new(),
    };
    let test = format!("t({df}) = {}, {}{holm}", fixed(t, 3), p_equals(p));
    let way = if mean > summary.mu { "more" } else { "less" };
    if significant_after_holm(block) {
        let g = analysis.effect.as_ref().map_or(String::new(), |e| format!(", g = {}", fixed(e.g, 2)));
        format!("{chose}: {way} often than half the time, {test}{g}.")
    } else if !block.planned {
        format!("{chose}. Its t-test was not planned, {test}: nothing is concluded from it.")
    } else if let Some(found) = analysis.equivalence.filter(|_| equivalent(block)) {
        format!(
            "{chose}: not significantly different from half the time, {test}, and equivalent to it within the study's bound of ±{} on the share, {}.",
            found.within,
            p_equals(found.tests.p)
        )
    } else {
        format!("{chose}: not significantly different from half the time, {test}.")
    }
}

/// Whether the pairs behind a block's share may be taken together; nothing where it has no share of several.
fn pairs(block: &BlockReport) -> String {
    let shares = block.by_item.iter().filter_map(|item| Some(item.target.as_ref()?.proportion));
    let (Some(pairs), Some(_)) = (&block.pairs, &block.analysis.proportion) else { return String::new() };
    let (low, high) = shares.fold((1.0, 0.0), |(low, high), x| (f64::min(low, x), f64::max(high, x)));
    let shares = if low == high {
        format!("each {}", percent(low))
    } else {
        format!("{} to {}", percent(low), percent(high))
    };
    match &pairs.test {
        None => format!("Whether its pairs differ ({shares}) cannot be tested."),
        Some(test) => {
            let p = resolved_p_equals(test.p, test.p_smallest);
            if test.p < ALPHA {
                format!(
                    "Its pairs differ ({shares}; Cochran's Q, {p}): the share above is a mean of different ones."
                )
            } else {
                format!("Its pairs are not shown to differ ({shares}; Cochran's Q, {p}).")
            }
        }
    }
}

fn not_shown(report: &StudyReport) -> Vec<String> {
    let mut lines = Vec::new();
    for block in &report.report.blocks {
        let (summary, analysis) = (&block.summary, &block.analysis);
        let (title, [a, b]) = (&summary.title, &summary.conditions);
        if let Some(found) = block.psychometric.as_ref().filter(|found| found.fit.is_none()) {
            lines.push(format!("{title}: a threshold. {}", found.notes.join(" ")));
        }
        if !block.planned {
            continue;
        }
        let Some(p) = summary.p else {
            let why = summary.note.as_deref().unwrap_or("t is not defined");
            lines.push(format!(
                "{title}: whether participants can tell {a} from {b}, by the planned t-test: {why}."
            ));
            continue;
        };
        if p < ALPHA && !significant_after_holm(block) {
            lines.push(format!(
                "{title}: a difference. The test alone has {}, but not after correction for {} planned tests.",
                p_equals(p),
                report.report.blocks.iter().filter(|b| b.planned && !b.primary).count()
            ));
        }
        if significant_after_holm(block) || equivalent(block) {
            continue;
        }
        let equivalence = match analysis.equivalence {
            Some(found) => format!(
                "equivalence within the study's bound of ±{} on the share is not shown ({})",
                found.within,
                p_equals(found.tests.p)
            ),
            None => "the study file states no bound within which a share would count as equivalent to a half"
                .to_owned(),
        };
        let mut line = format!(
            "{title}: that participants cannot tell {a} from {b}. Not significant is not the same: {equivalence}"
        );
        if let Some(bayes) = &analysis.bayes {
            let (ratio, hypothesis) =
                if bayes.bf01 >= 1.0 { (bayes.bf01, "no effect") } else { (bayes.bf10, "an effect") };
            line.push_str(&format!(
                "; the data are {} times likelier under {hypothesis}",
                significant(ratio, 2)
            ));
        }
        if let Some(plan) = &analysis.detectable {
            line.push_str(&format!(
                "; with {} a true effect below d = {} is missed more than one time in {}",
                count(plan.n, "participant"),
                fixed(plan.d, 2),
                fixed(1.0 / (1.0 - DETECTION_POWER), 0)
            ));
        }
        lines.push(line + ".");
    }
    if let Some(everybody) = &report.blocks_with_excluded {
        for (screened, all) in report.report.blocks.iter().zip(everybody) {
            if significant_after_holm(screened) != significant_after_holm(all) {
                lines.push(format!(
                    "{}: a result that does not depend on who is excluded. With everybody, p after Holm is {}; with the study's rules, {}.",
                    screened.summary.title,
                    all.p_holm.map_or("not defined".to_owned(), crate::format::p_value),
                    screened.p_holm.map_or("not defined".to_owned(), crate::format::p_value)
                ));
            }
        }
    }
    let items: usize = report.report.blocks.iter().map(|b| b.summary.items).sum();
    lines.push(format!(
        "Anything about other scenes: intervals and tests speak of other participants who see these {}.",
        count(items as u64, "pair")
    ));
    lines
}
