//! What came of a study, written: for the terminal, a spreadsheet, a browser, a paper.
//!
//! [`StudyReport`] holds every number; [`Document`] is what is said of them, once, and [`text`](fn@text), [`html`](fn@html) and [`markdown`](fn@markdown) only write it
//! down. [`csv`](fn@csv) has one row a number. Pure: strings in, strings out, the same bytes for the same answers.

mod blocks;
mod csv;
mod devices;
mod display;
mod document;
mod figures;
mod format;
mod headline;
mod html;
mod markdown;
mod numbers;
mod order;
mod paper;
mod record;
mod sections;
mod sources;
mod standing;
mod text;

pub use self::csv::{csv, csv_table, visible};
pub use ::csv::Terminator;
pub use devices::DeviceCount;
pub use display::ShownAt;
pub use document::{Cell, Column, Document, Figure, Piece, Row, Section, Table};
pub use html::{escaped, html};
pub use markdown::{Figures, Markdown, markdown};
pub use numbers::{Number, Sample, numbers};
pub use record::Served;
pub use standing::{Excluded, Flagged, Standing};
pub use text::text;

use kelir_stats::pairwise::ScaleIntervals;
use kelir_stats::paper::Replication;
use kelir_study::report::{BlockReport, Report};
use kelir_study::{Screening, StudyDefinition};
use serde::Serialize;
use serde_json::Value;
use utoipa::ToSchema;

/// Everything kelir can say of one version of a study, as a report or a paper's methods and results need it.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct StudyReport {
    /// Study's id.
    pub study: String,
    /// Study's title.
    pub title: String,
    /// The question over every pair.
    pub question: String,
    /// Version of the study that this is of: SHA-256 of its design and of the pixels that it shows.
    pub version: String,
    /// The versions whose answers are in here, the one above first: others only where somebody named them.
    pub pooled: Vec<PooledVersion>,
    /// What the pooled versions do not show alike.
    pub different_stimuli: Vec<DifferentStimulus>,
    /// Version of kelir that judged.
    pub kelir_version: String,
    /// When the first and the last answer came, ISO-8601 UTC; null without answers.
    pub answered: Option<[String; 2]>,
    /// When the version was served; null where that is not known.
    pub served: Option<Served>,
    /// How many people take part.
    pub participants: Participants,
    /// Who is judged, and who is not.
    pub standing: Standing,
    /// Who is left out by the study's rules of screening, and why.
    pub excluded: Vec<Excluded>,
    /// The study's rules of screening.
    pub screening: Screening,
    /// Blocks, scale and methods, without the excluded.
    #[serde(flatten)]
    pub report: Report,
    /// The blocks with everybody; null when nobody is excluded.
    pub blocks_with_excluded: Option<Vec<BlockReport>>,
    /// The scale with everybody; null when nobody is excluded or there is none.
    pub scale_with_excluded: Option<ScaleIntervals>,
    /// What was shown, with how it was made and its measured error.
    pub stimuli: Vec<Stimulus>,
    /// In which sizes it was shown, by rising size.
    pub shown: Vec<ShownAt>,
    /// With which devices those who are judged took part, counted.
    pub devices: Vec<DeviceCount>,
    /// Other versions of the study that have sessions; their answers are not in here.
    pub other_versions: Vec<PooledVersion>,
    /// Whether the stored answers are what was written: the study's own chain and, before it, the one that all studies used to share.
    pub chain: Chain,
    /// The paper's own tests, computed again, for the study that repeats them.
    pub paper: Option<Replication>,
    /// The study's definition, every value of it.
    pub design: StudyDefinition,
}

/// How many people take part in one version of a study.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, ToSchema)]
pub struct Participants {
    /// Sessions ever begun.
    pub started: u64,
    /// Not finished, and seen within the idle time.
    pub in_progress: u64,
    /// Finished.
    pub completed: u64,
}

/// A version of a study and what it has gathered.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct PooledVersion {
    /// SHA-256 of its design and of the pixels that it shows.
    pub version: String,
    /// Sessions begun with it.
    pub sessions: u64,
    /// Answers to it.
    pub answers: u64,
}

/// An item that pooled versions show in different ways under one condition.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct DifferentStimulus {
    /// Item's id.
    pub item: String,
    /// Condition's name.
    pub condition: String,
    /// The versions that show it otherwise than the first of the pooled ones, or not at all.
    pub versions: Vec<String>,
}

/// What one item of a study shows under one condition.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Stimulus {
    /// Item's id.
    pub item: String,
    /// Condition's name.
    pub condition: String,
    /// [width, height] in pixels; [0, 0] where that was never known.
    pub size: [u32; 2],
    /// Hash of the stimulus's file.
    pub sha256: String,
    /// Hash of its decoded pixels.
    pub pixels_sha256: String,
    /// How it was made, with its measured error.
    pub provenance: Value,
}

/// How wrong a stimulus is, in units of the brightest unshadowed point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhysicalError {
    /// Root mean square: in penumbra against the reference, or the stimulus's own standard error.
    pub rms: f64,
    /// What the reference's own noise adds to any error measured against it; `None` where it is not known or where `rms` is
    /// the stimulus's own.
    pub floor: Option<f64>,
    /// Whether `rms` is the stimulus's own standard error (Monte Carlo, over the sampled pixels), for want of a better reference.
    pub own: bool,
}

impl PhysicalError {
    /// Whether most of the error may be the reference's: rms² < 2 floor².
    pub fn is_mostly_noise(&self) -> bool {
        self.floor.is_some_and(|floor| self.rms < std::f64::consts::SQRT_2 * floor)
    }
}

impl Stimulus {
    /// Its error as measured when it was made; `None` where nothing was.
    pub fn error(&self) -> Option<PhysicalError> {
        let number = |path| self.provenance.pointer(path).and_then(Value::as_f64).filter(|x: &f64| *x > 0.0);
        if let Some(rms) = number("/error/penumbra/rmse") {
            return Some(PhysicalError { rms, floor: number("/error/floor"), own: false });
        }
        Some(PhysicalError { rms: number("/standard_error/rms_sampled")?, floor: None, own: true })
    }
}

/// What checking the stored answers found.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct Chain {
    /// Rows that were checked.
    pub rows: u64,
    /// Hash of the last row; noting it elsewhere also proves that no later rows were cut off.
    pub head: String,
    /// Rows that are not what was written.
    pub faults: Vec<Fault>,
    /// Answers that were blanked by a withdrawal.
    pub blanked: u64,
}

/// A stored answer that is not what was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct Fault {
    /// Version of the chain: 1 (all studies in one, closed) or 2 (the study's own).
    pub chain: u32,
    /// Place in its chain, from 1.
    pub seq: i64,
    /// What is wrong with it.
    pub what: String,
    /// What somebody who looked into it noted; null while it is unexplained.
    pub note: Option<String>,
}

impl Fault {
    /// The row and what is wrong with it, as a sentence without its end.
    pub fn sentence(&self) -> String {
        let first = if self.chain == 1 { " of the closed first chain" } else { "" };
        format!("Stored answer {}{first} is not what was written: {}", self.seq, self.what)
    }
}

impl StudyReport {
    /// The stimuli at the study's smallest size: what is drawn at several is told once.
    pub(crate) fn smallest(&self) -> impl Iterator<Item = &Stimulus> {
        let is_larger = |one: &Stimulus, other: &Stimulus| {
            (&one.item, &one.condition) == (&other.item, &other.condition) && one.size > other.size
        };
        self.stimuli.iter().filter(move |one| !self.stimuli.iter().any(|other| is_larger(one, other)))
    }

    /// Whether nobody whose answers are judged has answered anything that is analysed.
    pub fn is_empty(&self) -> bool {
        self.report.blocks.iter().all(|block| block.first.is_none())
    }
}
