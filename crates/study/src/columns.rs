//! The table of responses: one tidy row a trial. What each column is, is said by the records here and by the answers of each kind of trial;
//! the codebook, the header and the cells are made from these.

mod events;
mod participants;

pub use events::{EventSession, event_rows, events_codebook};
pub use participants::{ParticipantColumns, participants_codebook};

use crate::definition::{Block, Kind, StudyDefinition};
use crate::plan::Trial;
use crate::schema::{Column, Record, Sound, worded};
use crate::trials::{Role, TrialKind, TrialName};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::collections::BTreeMap;
use utoipa::ToSchema;

worded! {
    /// How far a session is.
    pub enum SessionStatus {
        /// every trial has an answer, and the code was given
        Completed = "completed",
        /// not finished
        InProgress = "in progress",
    }
}

#[expect(clippy::derivable_impls, reason = "`worded!` writes the enum")]
impl Default for SessionStatus {
    fn default() -> SessionStatus {
        SessionStatus::InProgress
    }
}

/// What a row says of its session.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct SessionColumns {
    /// Participant: the recruiting panel's id, else the session's id.
    pub subject_id: String,
    /// Session (UUID v7).
    pub session_id: String,
    /// Study.
    pub study_id: String,
    /// Another name of version, as it was called before; it goes with the next release.
    pub config_hash: String,
    /// Version of the study: SHA-256 of its design and of the pixels of all that it shows.
    pub version: String,
    /// SHA-256 of the study's design: of all values of its file but those that nobody judges by.
    pub design_hash: String,
    /// How far the session is.
    pub status: SessionStatus,
    /// Part of the session's trials that have an answer; of the most there can be where answers decide how many.
    #[schema(extensions(("x-unit" = json!("%"))))]
    pub percent_complete: f64,
    /// Place in the design; slots 2k and 2k + 1 are mirror images in side or order.
    pub slot: u32,
    /// Seed of the session's trial plan.
    pub plan_seed: String,
    /// 1 where the analysis counts the session's answers; else 0.
    pub judged: u8,
    /// Why it does not, where it has a reason.
    pub reject_reason: Option<String>,
}

/// What a row says of its trial and answer, beside what the page sent.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct TrialColumns {
    /// Place of the trial in the session, from 0.
    pub trial_index: u32,
    /// Kind of the trial.
    pub trial_kind: TrialName,
    /// Block.
    pub block_id: String,
    /// Place of the block in the study, from 0.
    pub block_index: u32,
    /// Item: what is shown under both conditions.
    pub item_id: String,
    /// Another name of item_id.
    pub pair_id: String,
    /// Place of the item in its block's file order, from 0.
    pub pair_index: u32,
    /// How often the session had shown the item before.
    pub repeat: u32,
    /// Level of the item on the axis of the block's psychometric function; empty without one.
    pub level: Option<f64>,
    /// still or animation.
    pub kind: String,
    /// 1 in a catch trial, which screens and is not analysed; else 0.
    pub is_catch: u8,
    /// 1 in a practice trial; else 0. No study has any yet.
    pub is_practice: u8,
    /// JSON array of the SHA-256 of the stimuli's files: left then right, or first then second.
    pub stimulus: String,
    /// Width in its own pixels of the size at which the stimuli were shown.
    #[schema(extensions(("x-unit" = json!("px"))))]
    pub stimulus_width_px: u32,
    /// Height in its own pixels of that size.
    #[schema(extensions(("x-unit" = json!("px"))))]
    pub stimulus_height_px: u32,
    /// Condition shown on the left; empty in trials of other kinds.
    pub left_condition: Option<String>,
    /// Condition shown on the right; empty in trials of other kinds.
    pub right_condition: Option<String>,
    /// SHA-256 of the stimulus on the left; empty in trials of other kinds.
    pub left_sha256: Option<String>,
    /// SHA-256 of the stimulus on the right; empty in trials of other kinds.
    pub right_sha256: Option<String>,
    /// What was chosen: left or right, first or second. Empty once withdrawn.
    pub response: Option<String>,
    /// Condition chosen.
    pub chosen_condition: Option<String>,
    /// Condition whose choices the block counts.
    pub target_condition: String,
    /// 1 when the target was chosen, else 0.
    pub target_chosen: Option<u8>,
    /// In catch trials 1 when the target was chosen, else 0. Empty in others: a preference has no right answer.
    pub correct: Option<u8>,
    /// What ended the trial: response.
    pub ended_on: String,
    /// Fields of the answer that the page sent against their rules, separated by spaces: what breaks a rule is empty here, and in the stored
    /// answer as it was sent.
    pub flags: String,
    /// Width of the window's inside.
    #[schema(extensions(("x-unit" = json!("CSS px"))))]
    pub viewport_width: Option<f64>,
    /// Height of the window's inside.
    #[schema(extensions(("x-unit" = json!("CSS px"))))]
    pub viewport_height: Option<f64>,
    /// When the server committed the answer, ISO 8601.
    pub received_at: String,
    /// SHA-256 of all that the page sent.
    pub payload_hash: Option<String>,
    /// What the chain of answers holds of this one: of chain 2 the SHA-256 of a nonce, the answer and all that the page sent; of chain 1
    /// payload_hash.
    pub answer_hash: String,
    /// Version of the chain that the row is in: 1 (all studies in one, closed) or 2 (the study's own).
    pub chain: u32,
    /// Place of the row in its chain, from 1.
    pub chain_seq: i64,
}

/// An answer with what it belongs to.
pub struct Answered<'a> {
    /// Definition of the study's version.
    pub study: &'a StudyDefinition,
    /// The session.
    pub session: &'a SessionColumns,
    /// The trial.
    pub trial: &'a Trial,
    /// Hash of the file of each role.
    pub sha256: BTreeMap<Role, &'a str>,
    /// The size at which they were shown.
    pub size: [u32; 2],
    /// What was answered, as stored; `None` once withdrawn.
    pub answer: Option<&'a str>,
    /// All that the page sent; null once withdrawn.
    pub payload: &'a Value,
    /// SHA-256 of it.
    pub payload_hash: Option<String>,
    /// What the chain holds of it.
    pub answer_hash: &'a str,
    /// When it was committed.
    pub received_at: &'a str,
    /// Version of its chain, and its place there.
    pub place: (u32, i64),
}

/// Today's columns come first and in the order that they have had.
const FIRST: [&str; 41] = [
    "subject_id",
    "session_id",
    "study_id",
    "config_hash",
    "status",
    "percent_complete",
    "slot",
    "plan_seed",
    "trial_index",
    "trial_type",
    "plugin_version",
    "block_id",
    "block_index",
    "pair_id",
    "pair_index",
    "kind",
    "stimulus",
    "left_condition",
    "right_condition",
    "left_sha256",
    "right_sha256",
    "response",
    "chosen_condition",
    "target_condition",
    "target_chosen",
    "correct",
    "rt",
    "time_elapsed",
    "ended_on",
    "input",
    "scale",
    "arrangement",
    "device_pixel_ratio",
    "viewport_width",
    "viewport_height",
    "refresh_hz",
    "hidden_ms",
    "reload_count",
    "timestamp",
    "received_at",
    "payload_hash",
];

/// What pages send and rows say in columns of their own.
const ELSEWHERE: [&str; 5] = ["choice", "viewport", "frames", "events", "stimulus_size"];

/// The path of a page's field as a column: `requested_ms.first` is `requested_ms_first`.
fn flat(name: &str) -> String {
    name.replace('.', "_")
}

/// Fields that pages send, by kind, as (path, column).
fn sent() -> Vec<(String, Column)> {
    let mut fields: Vec<(String, Column)> = Vec::new();
    for kind in TrialKind::all() {
        for column in kind.rules().record().columns() {
            let path = column.name.clone();
            let known = fields.iter().any(|(known, _)| *known == path);
            if !known && !ELSEWHERE.contains(&path.as_str()) {
                fields.push((path.clone(), Column { name: flat(&path), ..column }));
            }
        }
    }
    fields
}

/// The columns of one role, in trials that have it.
fn of_role(role: Role) -> [Column; 2] {
    let column = |what: &str, meaning: &str| Column {
        name: format!("shown_{}_{what}", role.as_str()),
        kind: "text".to_owned(),
        unit: String::new(),
        meaning: format!("{meaning} {}; empty in trials without", role.meaning()),
        values: Vec::new(),
    };
    [column("condition", "Condition shown"), column("sha256", "SHA-256 of the file shown")]
}

/// Every column of the table of responses, in order.
pub fn codebook() -> Vec<Column> {
    let own = [Record::of::<SessionColumns>(), Record::of::<TrialColumns>()];
    let mut all: Vec<Column> = own.iter().flat_map(Record::columns).collect();
    all.extend(sent().into_iter().map(|(_, column)| column));
    let mut columns: Vec<Column> = Vec::new();
    for name in FIRST {
        columns.extend(all.iter().find(|column| column.name == name).cloned());
    }
    all.retain(|column| !FIRST.contains(&column.name.as_str()));
    columns.extend(all);
    columns.extend(Role::ALL.iter().copied().flat_map(of_role));
    columns
}

/// Cells of the columns of [`codebook`], row by row.
pub struct Rows {
    names: Vec<String>,
    sent: Vec<(Vec<String>, String)>,
}

impl Default for Rows {
    fn default() -> Rows {
        let path = |path: String| path.split('.').map(str::to_owned).collect();
        Rows {
            names: codebook().into_iter().map(|column| column.name).collect(),
            sent: sent().into_iter().map(|(from, column)| (path(from), column.name)).collect(),
        }
    }
}

impl Rows {
    /// The header.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The cells of one answer.
    pub fn cells(&self, answered: &Answered<'_>) -> Vec<String> {
        let mut values = Map::new();
        let sent = match answered.payload {
            // Withdrawn.
            Value::Null => Sound { value: Cow::Owned(Value::Null), broken: Vec::new() },
            payload => with_known_size(answered.trial.trial.rules().record().sound(payload), answered.study),
        };
        for (path, column) in &self.sent {
            let value = path.iter().try_fold(sent.value.as_ref(), |value, key| value.get(key));
            values.insert(column.clone(), value.cloned().unwrap_or_default());
        }
        let trial = serde_json::to_value(trial_columns(answered, &sent));
        for record in [serde_json::to_value(answered.session), trial] {
            values.extend(record.ok().and_then(|record| record.as_object().cloned()).unwrap_or_default());
        }
        for (role, placed) in &answered.trial.shown {
            let sha256 = answered.sha256.get(role).copied().unwrap_or_default();
            let cells = [json!(placed.condition), json!(sha256)];
            values.extend(of_role(*role).map(|column| column.name).into_iter().zip(cells));
        }
        self.names.iter().map(|name| values.get(name).map(plain).unwrap_or_default()).collect()
    }
}

/// A size that the study has not is none that a page can have shown.
fn with_known_size<'a>(mut sent: Sound<'a>, study: &StudyDefinition) -> Sound<'a> {
    const FIELD: &str = "stimulus_size";
    let named = serde_json::from_value::<Option<[u32; 2]>>(sent.value[FIELD].clone());
    let known = named.is_ok_and(|size| size.is_none_or(|size| study.sizes().contains(&size)));
    if !known && !sent.broken.iter().any(|field| field == FIELD) {
        sent.broken.push(FIELD.to_owned());
    }
    sent
}

fn trial_columns(answered: &Answered<'_>, sent: &Sound<'_>) -> TrialColumns {
    let Answered { study, trial, .. } = answered;
    let viewport = &sent.value["viewport"];
    let block = study.block(&trial.block_id);
    let target = block.map(|block| block.target.as_str()).unwrap_or_default();
    let chosen = answered.answer.and_then(|answer| trial.trial.rules().chosen(answer));
    let chosen_condition =
        chosen.and_then(|role| trial.shown.get(&role)).map(|placed| placed.condition.to_string());
    let target_chosen = chosen_condition.as_ref().map(|condition| u8::from(condition == target));
    let is_catch = block.is_some_and(|block| block.catch);
    let condition = |role| trial.shown.get(&role).map(|placed| placed.condition.to_string());
    let sha256 = |role| answered.sha256.get(&role).map(|sha256| (*sha256).to_owned());
    let hashes: Vec<&str> =
        trial.shown.keys().filter_map(|role| answered.sha256.get(role).copied()).collect();
    TrialColumns {
        trial_index: trial.trial_index,
        trial_kind: trial.trial.rules().name(),
        block_id: trial.block_id.clone(),
        block_index: trial.block_index,
        item_id: trial.item_id.clone(),
        pair_id: trial.item_id.clone(),
        pair_index: trial.item_index,
        repeat: trial.repeat,
        level: block.and_then(|block| level(block, &trial.item_id)),
        kind: match trial.kind {
            Kind::Still => "still",
            Kind::Animation => "animation",
        }
        .to_owned(),
        is_catch: is_catch.into(),
        is_practice: 0,
        stimulus: json!(hashes).to_string(),
        stimulus_width_px: answered.size[0],
        stimulus_height_px: answered.size[1],
        left_condition: condition(Role::Left),
        right_condition: condition(Role::Right),
        left_sha256: sha256(Role::Left),
        right_sha256: sha256(Role::Right),
        response: chosen.map(|role| role.as_str().to_owned()),
        chosen_condition,
        target_condition: target.to_owned(),
        target_chosen,
        correct: target_chosen.filter(|_| is_catch),
        ended_on: "response".to_owned(),
        flags: sent.broken.join(" "),
        viewport_width: viewport[0].as_f64(),
        viewport_height: viewport[1].as_f64(),
        received_at: answered.received_at.to_owned(),
        payload_hash: answered.payload_hash.clone(),
        answer_hash: answered.answer_hash.to_owned(),
        chain: answered.place.0,
        chain_seq: answered.place.1,
    }
}

fn level(block: &Block, item: &str) -> Option<f64> {
    block.items.iter().find(|known| known.id == item)?.level
}

/// A JSON value as a cell: texts bare, null empty, whole numbers without a point.
fn plain(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Number(number) => match number.as_f64() {
            Some(x) if number.is_f64() => x.to_string(),
            _ => number.to_string(),
        },
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests;
