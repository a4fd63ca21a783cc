//! The paper that a study repeats, beside the study's own results.

use crate::document::{Cell, Piece, Row, Section, Table};
use crate::format::{MISSING, fixed, p_value, range, significant};
use crate::{StudyReport, figures};
use kelir_stats::paper::{Comparison, Replication};

/// The paper's own tests beside this study's.
pub(crate) fn section(report: &StudyReport) -> Option<Section> {
    let paper = report.paper.as_ref()?;
    let mut rows = Vec::new();
    // The study's blocks repeat the paper's comparisons, in the paper's order.
    let blocks = &report.report.blocks;
    for (k, theirs) in paper.comparisons.iter().enumerate() {
        let effect = |g: f64, low: f64, high: f64| {
            Cell::estimate(format!("{}, {}", fixed(g, 3), range(low, high, 3)), g, low, high)
        };
        rows.push(Row::Group(theirs.title.to_owned()));
        rows.push(Row::Cells(vec![
            Cell::text("the paper, as printed"),
            Cell::whole(theirs.test.n),
            Cell::number(fixed(theirs.printed.t, 3), theirs.printed.t),
            Cell::default(),
            Cell::default(),
            Cell::default(),
        ]));
        rows.push(Row::Cells(vec![
            Cell::text("the paper, from its counts"),
            Cell::whole(theirs.test.n),
            Cell::number(fixed(theirs.test.t, 3), theirs.test.t),
            Cell::number(p_value(theirs.test.p), theirs.test.p),
            Cell::number(p_value(theirs.p_holm), theirs.p_holm),
            effect(theirs.effect.g, theirs.effect.g_interval.low, theirs.effect.g_interval.high),
        ]));
        if let Some(ours) = blocks.get(k).filter(|_| blocks.len() == paper.comparisons.len()) {
            let g = ours.analysis.effect.as_ref();
            rows.push(Row::Cells(vec![
                Cell::text("this study"),
                Cell::whole(ours.summary.n),
                Cell::maybe(ours.summary.t, |t| fixed(t, 3)),
                Cell::maybe(ours.summary.p, p_value),
                Cell::maybe(ours.p_holm, p_value),
                g.map_or_else(|| Cell::text(MISSING), |e| effect(e.g, e.g_interval.low, e.g_interval.high)),
            ]));
        }
    }
    let columns = ["of PA", "n#", "t#", "p#", "p, Holm#", "Hedges' g, 95% interval#"];
    let mut pieces = vec![
        Piece::Text(
            "Taylor & Cameron's three tests, computed again from the counts that their printed means and standard deviations imply, beside this study's \
             own. This study's pictures, scenes and participants are others; its photographs are simulated until real ones stand in their place."
                .to_owned(),
        ),
        Piece::Table(Table::new("", &columns, rows)),
        Piece::Table(beyond_the_test(paper)),
        Piece::Table(equivalence(paper)),
    ];
    pieces.extend(paper.comparisons.iter().map(figures::equivalence));
    for theirs in paper.comparisons.iter().filter(|c| !c.t_as_printed) {
        let (from, to) = paper.printed_t.participants;
        pieces.push(Piece::Warning(format!(
            "The printed t = {} does not follow from the printed mean and standard deviation, whose counts give {}; no whole number of {from} to {to} \
             participants gives it.",
            fixed(theirs.printed.t, 3),
            fixed(theirs.test.t, 3)
        )));
    }
    Some(Section::new("The paper that this study repeats", pieces))
}

/// What the paper's counts say besides its tests.
fn beyond_the_test(paper: &Replication) -> Table {
    let rows = paper.comparisons.iter().map(|theirs| {
        let chosen: Vec<String> = theirs.counts.iter().map(|(k, people)| format!("{k}: {people}")).collect();
        Row::Cells(vec![
            Cell::text(theirs.title),
            Cell::text(chosen.join(", ")),
            Cell::number(fixed(theirs.printed.mean, 3), theirs.printed.mean),
            Cell::number(fixed(theirs.printed.sd, 3), theirs.printed.sd),
            Cell::number(significant(theirs.bayes.bf01, 3), theirs.bayes.bf01),
        ])
    });
    let columns = ["comparison", "chose PA", "mean#", "SD#", "BF₀₁#"];
    let caption = "The paper's counts (how often PA was chosen: by how many participants), its printed means and standard deviations, and how much likelier \
         the counts are under no effect (JZS Bayes factor).";
    Table::new(caption, &columns, rows.collect())
}

/// The tests of equivalence by their bound: the paper states none, and what the counts show depends on it.
fn equivalence(paper: &Replication) -> Table {
    let bounds = paper.comparisons.first().into_iter().flat_map(Comparison::tabled);
    let rows = bounds.enumerate().map(|(k, bound)| {
        let p = paper.comparisons.iter().filter_map(|c| Some(c.tabled().nth(k)?.tests.p));
        let bound = Cell::number(format!("±{}", fixed(bound.within, 2)), bound.within);
        Row::Cells(std::iter::once(bound).chain(p.map(|p| Cell::number(p_value(p), p))).collect())
    });
    let columns: Vec<String> = std::iter::once("bound on the share#".to_owned())
        .chain(paper.comparisons.iter().map(|c| format!("{}#", c.title)))
        .collect();
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    let caption = "p of the two one-sided tests that PA's share is equivalent to a half, by how far from a half it may lie; at ±0.5 any share is. Below 0.05 \
         equivalence is shown.";
    Table::new(caption, &columns, rows.collect())
}
