//! The sections of a report, in order.

use crate::blocks::{self, table};
use crate::document::{Cell, Document, Piece, Row, Section, Table, short};
use crate::format::{count, fixed, list, p_equals, p_value, percent, range, share, significant};
use crate::numbers::{Sample, of_scale};
use crate::record::{self, minute};
use crate::{StudyReport, devices, display, figures, headline, order, paper, sources};
use kelir_stats::pairwise::ScaleIntervals;
use kelir_study::report::{ALPHA, BlockReport};
use kelir_study::visits::Repeated;
use kelir_study::{Condition, Kind, StudyDefinition};
use std::collections::BTreeSet;

/// Excluded participants that are named one by one.
const MOST_LISTED: usize = 100;

impl Document {
    /// What is to be said of a study.
    pub fn of(report: &StudyReport) -> Document {
        Document {
            title: report.title.clone(),
            subtitle: format!(
                "Report of the study {}, version {}, by kelir {}",
                report.study,
                short(&report.version),
                report.kelir_version
            ),
            sections: all(report),
        }
    }
}

/// Everything there is to say.
pub(crate) fn all(report: &StudyReport) -> Vec<Section> {
    let mut sections = vec![headline::section(report)];
    sections.extend(preferences(&report.report.blocks));
    sections.push(participants(report));
    sections.push(design(report));
    sections.extend(devices::section(report));
    sections.extend(report.report.blocks.iter().map(blocks::section));
    sections.extend(scale(report));
    sections.extend(times(report));
    sections.extend(order::section(report));
    sections.extend(errors(report));
    sections.extend(both_ways(report));
    sections.extend(paper::section(report));
    sections.push(sources::methods(report));
    sections.extend(record::preregistration(report));
    sections.push(record::statements(report));
    sections.push(sources::data(report));
    sections.push(sources::citation(report));
    sections
}

/// The blocks side by side: their shares, and the paper's test of each.
fn preferences(blocks: &[BlockReport]) -> Option<Section> {
    let figure = figures::choices(blocks)?;
    let rows = blocks.iter().map(|block| {
        let summary = &block.summary;
        let title = Cell::text(&summary.title);
        Row::Cells(vec![
            summary.note.iter().fold(title, |cell, note| cell.noted(note)),
            Cell::text(&summary.target),
            Cell::whole(summary.n),
            Cell::maybe(summary.mean, |x| fixed(x, 4)),
            Cell::maybe(summary.sd, |x| fixed(x, 4)),
            Cell::number(fixed(summary.mu, 1), summary.mu),
            Cell::maybe(summary.t, |t| fixed(t, 3)),
            Cell::maybe(summary.df, |df| fixed(df, 0)),
            Cell::maybe(summary.p, p_value),
            Cell::maybe(block.p_holm, p_value),
        ])
    });
    let columns = ["block", "counted", "n#", "mean#", "SD#", "chance#", "t#", "df#", "p#", "p, Holm#"];
    let caption = "Choices of the counted condition per participant, over those who answered every pair of the block. Two-tailed one-sample t-test \
         against chance, half the pairs.";
    let table = Piece::Table(Table::new(caption, &columns, rows.collect()));
    Some(Section::new("Who preferred what", vec![figure, table]))
}

fn participants(report: &StudyReport) -> Section {
    let times = report.answered.as_ref().map_or(String::new(), |[first, last]| {
        format!(" The first answer came at {}, the last at {}.", minute(first), minute(last))
    });
    let mut pieces = vec![Piece::Text(format!("{}{times}", report.standing.summary))];
    let others: u64 = report.other_versions.iter().map(|v| v.sessions).sum();
    if others > 0 {
        pieces.push(Piece::Warning(format!(
            "{} belong to {} of the study and are not in this report.",
            count(others, "more session"),
            count(report.other_versions.len() as u64, "other version")
        )));
    }
    if report.excluded.is_empty() {
        let rules = report.screening == kelir_study::Screening::default();
        let why = if rules {
            "The study file states no rules of exclusion."
        } else {
            "Nobody broke the study's rules of exclusion."
        };
        pieces.push(Piece::Text(format!("Nobody is excluded. {why}")));
    } else {
        let rows =
            report.excluded.iter().take(MOST_LISTED).map(|excluded| {
                Row::Cells(vec![Cell::text(&excluded.session_id), Cell::text(&excluded.why)])
            });
        let caption = format!(
            "{} excluded by the study's rules, which are part of the version that was answered.",
            count(report.excluded.len() as u64, "participant")
        );
        pieces.push(Piece::Table(Table::new(caption, &["session", "reason"], rows.collect())));
        if report.excluded.len() > MOST_LISTED {
            pieces.push(Piece::Text(format!(
                "And {} more: the table of participants and kelir stats {} --format json name them all.",
                report.excluded.len() - MOST_LISTED,
                report.study
            )));
        }
    }
    let repeated = &report.standing.repeated;
    if !repeated.is_empty() {
        let rows = repeated.iter().take(MOST_LISTED);
        let row = |one: &Repeated| Row::Cells(vec![Cell::text(&one.session_id), Cell::text(&one.counted)]);
        let caption = format!(
            "{} of persons who had taken part before; their first complete one counts.",
            count(repeated.len() as u64, "session")
        );
        pieces.push(Piece::Table(Table::new(
            caption,
            &["session", "the one that counts"],
            rows.map(row).collect(),
        )));
    }
    pieces.extend(looks(report));
    pieces.extend(flagged(report));
    let balance = &report.standing.balance_summary;
    if !balance.is_empty() {
        pieces.push(Piece::Text(balance.clone()));
    }
    Section::new("Participants", pieces)
}

/// What a look at results before the end does to them.
fn looks(report: &StudyReport) -> Option<Piece> {
    let planned = report.design.primary.as_ref().and_then(|named| named.participants).map(u64::from);
    let judged = report.standing.judged;
    let inflates = "each look that could have ended the study raises the chance of a false alarm above the level of its tests. kelir keeps no record of how often results were \
         looked at: say in the paper when they were, and why collecting ended.";
    let under_way = count(report.participants.in_progress, "participant");
    match planned {
        _ if report.is_empty() => None,
        Some(planned) if judged < planned => Some(Piece::Warning(format!(
            "{judged} of the {planned} participants that the study file plans are judged here. What is decided by this report is not decided by the plan: {inflates}"
        ))),
        Some(planned) if judged == planned => {
            Some(Piece::Text(format!("As many participants are judged as the study file plans, {planned}.")))
        }
        Some(planned) => Some(Piece::Warning(format!(
            "{judged} participants are judged here, more than the {planned} that the study file plans. If results were looked at before: {inflates}"
        ))),
        None if report.participants.in_progress > 0 => Some(Piece::Warning(format!(
            "The study is still collecting, {under_way} in progress, and its file plans no number of participants: {inflates}"
        ))),
        None => Some(Piece::Text(format!(
            "The study file plans no number of participants after which results are looked at: {inflates}"
        ))),
    }
}

/// What was noticed of sessions, whether or not it leaves them out.
fn flagged(report: &StudyReport) -> Option<Piece> {
    let flagged = &report.standing.flagged;
    let rows = flagged.iter().map(|one| {
        let leaves_out = if one.excludes { "yes" } else { "no" };
        Row::Cells(vec![
            Cell::text(one.flag.as_str()),
            Cell::text(&one.meaning),
            Cell::whole(one.sessions),
            Cell::text(leaves_out),
        ])
    });
    let columns = ["noticed", "meaning", "sessions#", "leaves out"];
    let table = Table::new("What was noticed of sessions.", &columns, rows.collect());
    (!flagged.is_empty()).then_some(Piece::Table(table))
}

fn design(report: &StudyReport) -> Section {
    let study = &report.design;
    let rows = study.blocks.iter().map(|block| {
        let title =
            if block.catch { format!("{} (catch, not analysed)", block.title) } else { block.title.clone() };
        let kind = match block.kind {
            Kind::Still => "stills",
            Kind::Animation => "animations",
        };
        let [a, b] = &block.conditions;
        Row::Cells(vec![
            Cell::text(title),
            Cell::text(format!("{kind}, {}", block.trial.rules().layout())),
            Cell::text(format!("{a} / {b}")),
            Cell::text(&block.target),
            Cell::whole(block.items.len() as u64),
        ])
    });
    let blocks = Table::new("", &["block", "shown as", "conditions", "counted", "pairs#"], rows.collect());
    let rows = study.conditions.iter().map(|(name, condition)| {
        let made = match condition {
            Condition::Rendered { technique, knobs, camera } => {
                let settings = |map: &std::collections::BTreeMap<String, serde_json::Value>| {
                    map.iter().map(|(k, v)| format!(", {k} {v}")).collect::<String>()
                };
                let camera = camera
                    .as_ref()
                    .map_or(String::new(), |c| format!("; through a simulated camera{}", settings(c)));
                format!("drawn by {technique}{}{camera}", settings(knobs))
            }
            Condition::Files { files } => format!("picture files ({})", files.len()),
        };
        Row::Cells(vec![Cell::text(name), Cell::text(made)])
    });
    let conditions = Table::new("", &["condition", "made by"], rows.collect());
    let text = format!(
        "“{}”, asked of {} in {}, two pictures {}; one of the two had to be chosen.",
        study.question,
        count(study.most_trials() as u64, "trial"),
        count(study.blocks.len() as u64, "block"),
        shown(study)
    );
    let mut pieces = vec![Piece::Text(text), Piece::Table(blocks), Piece::Table(conditions)];
    pieces.extend(display::pieces(report));
    Section::new("Design", pieces)
}

/// How the two pictures of a trial are shown.
fn shown(study: &StudyDefinition) -> String {
    let layouts: BTreeSet<&str> = study.blocks.iter().map(|block| block.trial.rules().layout()).collect();
    let says = if layouts.len() > 1 { ", as the table says" } else { "" };
    format!("{}{says}", Vec::from_iter(layouts).join(" or "))
}

fn scale(report: &StudyReport) -> Option<Section> {
    let judged = &report.report;
    let title = "All conditions on one scale";
    let Some(found) = &judged.scale else {
        // Two conditions have no scale, and nobody misses it.
        let names: BTreeSet<&String> = judged.blocks.iter().flat_map(|b| &b.summary.conditions).collect();
        let note = judged.scale_note.as_ref().filter(|_| names.len() > 2 && !report.is_empty())?;
        return Some(Section::new(title, vec![Piece::Text(note.clone())]));
    };
    let mut pieces = vec![Piece::Text(judged.scale_pools.clone())];
    pieces.extend(found.note.clone().map(Piece::Warning));
    pieces.extend(figures::scale(report));
    if found.scale.deviance_df > 0 && found.scale.deviance_p < 0.05 {
        pieces.push(Piece::Warning(
            "One axis does not hold these choices (small p of the deviance): how two conditions compare depends on more than their positions.".to_owned(),
        ));
    }
    pieces.extend(disagreeing(found));
    pieces.push(Piece::Table(table("", &of_scale(Sample::Screened, found))));
    if let Some(consistency) = &judged.consistency {
        let triads = &consistency.triads;
        if triads.triads > 0 {
            let mean = triads
                .consistence
                .map_or(String::new(), |z| format!("; mean coefficient of consistence {}", fixed(z, 2)));
            pieces.push(Piece::Text(format!(
                "Circular triads: {} of {} ({}; tossing a coin makes 25%){mean}.",
                triads.circular,
                triads.triads,
                percent(triads.circular as f64 / triads.triads as f64)
            )));
        }
        if consistency.observers > 0 {
            let names: Vec<&str> = consistency.odd.iter().map(|o| o.id.as_str()).collect();
            pieces.push(Piece::Text(if names.is_empty() {
                format!("No participant of {} chooses far off the scale of all the others.", consistency.observers)
            } else {
                format!(
                    "{} of {} choose far off the scale of all the others and are worth a look; they are not excluded: {}.",
                    names.len(),
                    count(consistency.observers, "participant"),
                    names.join(", ")
                )
            }));
        }
    }
    Some(Section::new(title, pieces))
}

/// Differences whose p and interval say different things of 5%: two methods, and a result on the border.
fn disagreeing(found: &ScaleIntervals) -> Option<Piece> {
    let named: Vec<String> = found
        .differences
        .iter()
        .filter_map(|d| {
            let (low, high) = d.low.zip(d.high)?;
            let disagree = (low > 0.0 || high < 0.0) != (d.p < ALPHA);
            disagree
                .then(|| format!("{} − {} ({}, interval {})", d.a, d.b, p_equals(d.p), range(low, high, 2)))
        })
        .collect();
    (!named.is_empty()).then(|| {
        Piece::Warning(format!(
            "The uncorrected p by sign flips and the {} interval by leaving out participants disagree about none at all of {}. They are different methods, and the result is on the \
             border: the test decides, and another sample may well decide otherwise.",
            percent(found.level),
            list(&named)
        ))
    })
}

fn times(report: &StudyReport) -> Option<Section> {
    let figure = figures::times(&report.report.blocks)?;
    let rows = report.report.blocks.iter().filter_map(|block| {
        let times = block.rt_ms?;
        let ms = |x: f64| Cell::number(fixed(x, 0), x);
        Some(Row::Cells(vec![
            Cell::text(&block.summary.title),
            ms(times.q1),
            ms(times.median),
            ms(times.q3),
            Cell::whole(times.n),
        ]))
    });
    let columns = ["block", "first quartile, ms#", "median, ms#", "third quartile, ms#", "answers#"];
    Some(Section::new("Response times", vec![figure, Piece::Table(Table::new("", &columns, rows.collect()))]))
}

fn errors(report: &StudyReport) -> Option<Section> {
    let figure = figures::errors(report)?;
    let judged = figures::judged(report);
    let mut pieces = vec![figure];
    let noisy = judged.iter().filter(|j| j.error.is_mostly_noise()).count();
    if noisy > 0 {
        pieces.push(Piece::Warning(format!(
            "The measured error of {} is mostly the noise of the reference it was measured against: the true error is smaller, and how such stimuli \
             compare in it means nothing. A reference with more samples would tell.",
            if noisy == 1 { "1 stimulus".to_owned() } else { format!("{noisy} stimuli") }
        )));
    }
    let rows = judged.iter().map(|j| {
        let condition = Cell::text(j.condition);
        Row::Cells(vec![
            Cell::text(j.pair),
            if j.error.own { condition.noted("error: its own standard error") } else { condition },
            Cell::number(significant(j.error.rms, 3), j.error.rms),
            j.error.floor.map_or_else(Cell::default, |floor| Cell::number(significant(floor, 3), floor)),
            match j.interval {
                Some(i) => Cell::estimate(share(j.share, Some(i)), j.share, i.low, i.high),
                None => Cell::number(share(j.share, None), j.share),
            },
        ])
    });
    let columns =
        ["pair", "condition", "RMS error#", "reference's noise in it#", "preferred it, 95% interval#"];
    pieces.push(Piece::Table(Table::new(
        "Errors in units of the brightest unshadowed point.",
        &columns,
        rows.collect(),
    )));
    Some(Section::new("Physical error and preference", pieces))
}

/// The paper's test with and without the excluded.
fn both_ways(report: &StudyReport) -> Option<Section> {
    let everybody = report.blocks_with_excluded.as_ref()?;
    let mut rows = Vec::new();
    for (screened, all) in report.report.blocks.iter().zip(everybody) {
        for (whose, block) in [("without the excluded", screened), ("everybody", all)] {
            let share = block.analysis.proportion.as_ref().map(|p| p.proportion);
            let cells = vec![
                Cell::text(&block.summary.title),
                Cell::text(whose),
                Cell::whole(block.summary.n),
                Cell::maybe(share, percent),
                Cell::maybe(block.summary.t, |t| fixed(t, 3)),
                Cell::maybe(block.summary.p, p_value),
                Cell::maybe(block.p_holm, p_value),
            ];
            rows.push(Row::Cells(cells));
        }
    }
    let columns = ["block", "answers of", "n#", "share#", "t#", "p#", "p, Holm#"];
    Some(Section::new("With and without the excluded", vec![Piece::Table(Table::new("", &columns, rows))]))
}
