//! What kelir can bear witness to of what was planned when, and what authors have to say themselves.

use crate::StudyReport;
use crate::document::{Cell, Piece, Row, Section, Table};
use crate::format::count;
use serde::Serialize;
use utoipa::ToSchema;

/// When a version of a study was served.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct Served {
    /// For the first time, ISO-8601 UTC.
    pub first: String,
    /// For the last time.
    pub last: String,
}

/// "2026-11-22 14:22 UTC" of an ISO-8601 time; whatever else it is, as it is.
pub(crate) fn minute(time: &str) -> String {
    match (time.get(..10), time.get(10..11), time.get(11..16)) {
        (Some(date), Some("T"), Some(minute)) if time.ends_with('Z') => format!("{date} {minute} UTC"),
        _ => time.to_owned(),
    }
}

/// What was fixed before the first answer, by the study's own record.
pub(crate) fn preregistration(report: &StudyReport) -> Option<Section> {
    let served = report.served.as_ref()?;
    let fact = |name: &str, value: String| Row::Cells(vec![Cell::text(name), Cell::text(value)]);
    let mut rows = vec![
        fact("design (SHA-256)", report.design.design_hash()),
        fact("version (SHA-256 of design and pictures)", report.version.clone()),
        fact("version first served", served.first.clone()),
    ];
    let [first, last] = report.answered.clone().map_or([None, None], |times| times.map(Some));
    rows.extend(first.iter().map(|time| fact("first answer", time.clone())));
    rows.extend(last.iter().map(|time| fact("last answer", time.clone())));
    let fixed = "The question, pairs, conditions, rules of exclusion, bound of equivalence and primary endpoint are part of the design, as far as the study file \
         states them: with any other the hash would be another.";
    let order = match &first {
        _ if report.pooled.len() > 1 => {
            "Answers to several versions are pooled: only the first of them has its times of serving here.".to_owned()
        }
        None => "There is no answer yet: a hash that is deposited elsewhere now (a registry, a repository, a dated letter) bears witness later.".to_owned(),
        Some(first) if served.first <= *first => format!(
            "By the record of the data folder this design was served from {} on, before its first answer at {}. The folder's clock and files are the researcher's own: \
             what proves it to others is the hash, deposited elsewhere before the first answer. [Registered at: …, on: …]",
            minute(&served.first),
            minute(first)
        ),
        Some(first) => format!(
            "The record of serving begins at {}, after the first answer at {}: it does not show that the design was fixed before.",
            minute(&served.first),
            minute(first)
        ),
    };
    let pieces = vec![
        Piece::Text(fixed.to_owned()),
        Piece::Text(order),
        Piece::Table(Table::new("", &["what", "value"], rows)),
    ];
    Some(Section::reference("Preregistration record", pieces))
}

/// Statements that a paper needs, with blanks for what kelir cannot know.
pub(crate) fn statements(report: &StudyReport) -> Section {
    let people = &report.participants;
    let when = report
        .answered
        .as_ref()
        .map_or("[when]".to_owned(), |[first, last]| format!("from {} to {}", minute(first), minute(last)));
    let sentences = vec![
        format!(
            "Data: the {} behind this report are available at [address, identifier or reason why not], under [licence]. Version of the study: SHA-256 {}; the chain of \
             stored answers ends in {}.",
            count(report.chain.rows, "stored answer"),
            report.version,
            report.chain.head
        ),
        format!(
            "Code: the study was run and analysed with kelir {} [source, commit]; study file and scenes are available at [address], file SHA-256 {}.",
            report.kelir_version,
            report.design.file_hash()
        ),
        "Ethics: the study was approved by [board, number, date]. Nobody could answer before agreeing to the consent text of the study file. [How data are protected, for \
         how long they are kept, how participants can withdraw.]"
            .to_owned(),
        format!(
            "Recruitment: participants were recruited through [where], who were [eligible how], paid [how much]; {} began and {} completed it, {when}. The number of \
             participants was decided by [how].",
            people.started, people.completed
        ),
        "Interests and funding: [statement].".to_owned(),
    ];
    let pieces = vec![
        Piece::Text("To be completed where brackets stand: kelir cannot know it.".to_owned()),
        Piece::List(sentences),
    ];
    Section::reference("Statements for the paper", pieces)
}
