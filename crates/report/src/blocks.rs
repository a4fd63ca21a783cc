//! One block: its numbers as a table, its notes, its psychometric function.

use crate::document::{Cell, Piece, Row, Section, Table};
use crate::figures;
use crate::format::{MISSING, below, count, fixed, resolved_p, significant};
use crate::numbers::{Number, Sample, of_block, psychometric};
use kelir_study::analysis::BlockSummary;
use kelir_study::report::{BlockReport, LEVEL};

/// The section of a block.
pub(crate) fn section(block: &BlockReport) -> Section {
    let summary = &block.summary;
    let [a, b] = &summary.conditions;
    let mut pieces = vec![Piece::Text(format!(
        "{a} against {b}, {} of {}; counted are choices of {}.",
        count(summary.items as u64, "pair"),
        shown(summary),
        summary.target
    ))];
    if block.first.is_none() {
        pieces.push(Piece::Text(sentence(&none_judged(summary))));
        return Section::new(title(block), pieces);
    }
    let notes = block.analysis.notes.iter().chain(block.pairs.iter().flat_map(|pairs| &pairs.notes));
    pieces.extend(notes.map(|note| Piece::Warning(sentence(note))));
    pieces.extend(figures::distribution(block));
    pieces.push(Piece::Table(table("", &of_block(Sample::Screened, block))));
    if let Some(found) = &block.psychometric {
        pieces.push(Piece::Heading("Psychometric function".to_owned()));
        pieces.extend(found.notes.iter().map(|note| Piece::Warning(sentence(note))));
        pieces.extend(figures::psychometric(block));
        pieces.push(Piece::Table(table("", &psychometric(Sample::Screened, &summary.id, found))));
    }
    Section::new(title(block), pieces)
}

/// Of a block that nobody who is judged has answered wholly: how far they came.
pub(crate) fn none_judged(summary: &BlockSummary) -> String {
    let some = match summary.incomplete {
        0 => String::new(),
        n => format!(", {n} answered some"),
    };
    format!("of the participants who are judged, none answered every pair{some}")
}

/// What is shown, and how.
fn shown(summary: &BlockSummary) -> String {
    let kind = match summary.kind {
        kelir_study::Kind::Still => "still pictures",
        kelir_study::Kind::Animation => "animations",
    };
    format!("{kind}, {}", summary.layout)
}

fn title(block: &BlockReport) -> String {
    format!("{} ({})", block.summary.title, block.summary.id)
}

/// With a capital and a full stop.
fn sentence(note: &str) -> String {
    let mut letters = note.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    let end = if note.ends_with(['.', '!', '?']) { "" } else { "." };
    format!("{first}{}{end}", letters.as_str())
}

/// Numbers as a table, one a row, grouped by analysis.
pub(crate) fn table(caption: &str, numbers: &[Number]) -> Table {
    let mut rows = Vec::new();
    let mut group = "";
    for number in numbers {
        if number.analysis != group {
            group = number.analysis;
            rows.push(Row::Group(capital(group)));
        }
        rows.push(Row::Cells(cells(number)));
    }
    Table::new(caption, &["statistic", "value#", "95% interval#", "p#", "n#"], rows)
}

fn capital(name: &str) -> String {
    // Names such as "t-test" keep their small letter.
    if name.starts_with("t-") { name.to_owned() } else { sentence(name).trim_end_matches('.').to_owned() }
}

fn cells(number: &Number) -> Vec<Cell> {
    let shown = |x: f64, decimals: usize| {
        // Very small and very large numbers keep their digits.
        let hidden =
            x != 0.0 && decimals > 0 && (x.abs() < 5.0 * 0.1f64.powi(decimals as i32) || x.abs() >= 1e6);
        match x {
            _ if hidden => significant(x, 3),
            // A share of 0.9996 is not 1.
            x if x > 0.0 && x < 1.0 => below(x, 1.0, decimals),
            _ => fixed(x, decimals),
        }
    };
    let statistic = Cell::text(&number.statistic);
    let interval = number.interval.map_or_else(Cell::default, |i| {
        let level =
            if i.level == LEVEL { String::new() } else { format!("{}%: ", fixed(100.0 * i.level, 0)) };
        let end = |x: f64| if x.is_finite() { fixed(x, number.decimals.max(1)) } else { "beyond".to_owned() };
        let ends: Vec<String> =
            [i.low, i.high].iter().filter(|x| x.is_finite()).map(f64::to_string).collect();
        let shown = format!("{level}{} to {}", end(i.low), end(i.high));
        Cell { shown, exact: Some(ends.join(" ")).filter(|ends| !ends.is_empty()), note: None }
    });
    vec![
        if number.note.is_empty() { statistic } else { statistic.noted(&number.note) },
        number.value.map_or_else(|| Cell::text(MISSING), |x| Cell::number(shown(x, number.decimals), x)),
        interval,
        number.p.map_or_else(Cell::default, |p| Cell::number(resolved_p(p, number.p_smallest), p)),
        number.n.map_or_else(Cell::default, Cell::whole),
    ]
}
