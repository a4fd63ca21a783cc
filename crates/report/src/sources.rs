//! The last sections of a report: how its numbers were got, what they are of, and how to cite it all.

use crate::StudyReport;
use crate::display;
use crate::document::{Cell, Piece, Row, Section, Table};
use crate::format::significant;

pub(crate) fn methods(report: &StudyReport) -> Section {
    let mut pieces: Vec<Piece> = report.report.methods.iter().cloned().map(Piece::Text).collect();
    pieces.push(Piece::Text(format!(
        "All statistics were computed by kelir {}, in double precision, with the seed {} for resampling.",
        report.kelir_version, report.design.seed
    )));
    Section::reference("Methods", pieces)
}

pub(crate) fn data(report: &StudyReport) -> Section {
    let fact = |name: &str, value: &str| Row::Cells(vec![Cell::text(name), Cell::text(value)]);
    let counted = |name: &str, n: u64| Row::Cells(vec![Cell::text(name), Cell::whole(n)]);
    let mut rows = vec![
        fact("study", &report.study),
        fact("version (SHA-256 of its design and pictures)", &report.version),
        fact("design (SHA-256 of what is judged by)", &report.design.design_hash()),
        fact("file (SHA-256 of all its values)", &report.design.file_hash()),
        counted("seed", report.design.seed),
        fact("kelir", &report.kelir_version),
        counted("stored answers in the chain", report.chain.rows),
        fact("chain of answers ends in", &report.chain.head),
        counted("answers blanked by withdrawal", report.chain.blanked),
    ];
    for version in report.pooled.iter().skip(1) {
        rows.push(fact("pooled with version", &version.version));
    }
    if report.chain.faults.is_empty() {
        rows.push(fact("check of the chain", "every stored answer is what was written, in order"));
    }
    for fault in &report.chain.faults {
        let note =
            fault.note.as_ref().map_or_else(|| "unexplained".to_owned(), |note| format!("noted: {note}"));
        rows.push(fact("chain", &format!("{} ({note})", fault.sentence())));
    }
    let versions = Table::new("", &["what", "value"], rows);
    let mut pieces = vec![Piece::Table(versions)];
    if report.stimuli.is_empty() {
        pieces.push(Piece::Text("No stimulus has been made yet.".to_owned()));
    } else {
        let rows = report.stimuli.iter().map(|stimulus| {
            Row::Cells(vec![
                Cell::text(&stimulus.item),
                Cell::text(&stimulus.condition),
                Cell::text(display::size(stimulus.size)),
                Cell::maybe(stimulus.error().map(|e| e.rms), |e| significant(e, 3)),
                Cell::text(&stimulus.sha256),
            ])
        });
        let columns = ["pair", "condition", "size, px", "RMS error#", "SHA-256"];
        pieces.push(Piece::Table(Table::new(
            "Stimuli, by the hash of their files.",
            &columns,
            rows.collect(),
        )));
    }
    Section::reference("Data, versions and hashes", pieces)
}

pub(crate) fn citation(report: &StudyReport) -> Section {
    let year = report
        .answered
        .as_ref()
        .and_then(|[_, last]| last.get(..4))
        .map_or(String::new(), |y| format!(" ({y})"));
    let study = format!(
        "{}{year} [study {}, version SHA-256 {}, answers' chain {}].",
        report.title, report.study, report.version, report.chain.head
    );
    let kelir = format!(
        "kelir {}: a platform for perceptual studies of shadows [computer software].",
        report.kelir_version
    );
    let mut pieces = vec![
        Piece::Text("Cite the data with its hashes, the software with its version, and the methods that a conclusion rests on.".to_owned()),
        Piece::List(vec![study, kelir]),
    ];
    let mut references = report.report.references.clone();
    if report.paper.is_some() {
        references.push("Taylor, C., & Cameron, K. (n.d.). Rendering virtual shadow puppet theatres [Poster]. Department of Computer Science, University of Bath. [The survey that this study repeats.]".to_owned());
    }
    references.sort();
    if !references.is_empty() {
        pieces.push(Piece::Heading("References".to_owned()));
        pieces.push(Piece::List(references));
    }
    Section::reference("How to cite", pieces)
}
