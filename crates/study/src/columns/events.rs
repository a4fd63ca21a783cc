//! The table of events: one row for each thing that happened to a page while a trial was taken.

use super::plain;
use crate::plan::Trial;
use crate::schema::{Column, Record};
use crate::trials::{TrialEvent, TrialName};
use serde::Serialize;
use serde_json::Value;
use utoipa::ToSchema;

/// The session that events belong to.
pub struct EventSession<'a> {
    /// Participant.
    pub subject_id: &'a str,
    /// Session.
    pub session_id: &'a str,
    /// Study.
    pub study_id: &'a str,
    /// Version of the study.
    pub version: &'a str,
}

/// What a row says of where its event belongs.
#[derive(Serialize, ToSchema)]
struct Belonging {
    /// Participant: the recruiting panel's id, else the session's id.
    subject_id: String,
    /// Session (UUID v7).
    session_id: String,
    /// Study.
    study_id: String,
    /// Version of the study: SHA-256 of its design and of the pixels of all that it shows.
    version: String,
    /// Place of the trial in the session, from 0.
    trial_index: u32,
    /// Kind of the trial.
    trial_kind: TrialName,
    /// Place of the event in its trial, from 0.
    event_index: usize,
}

/// What a page sends in one field and the table has in two.
#[derive(Serialize, ToSchema)]
struct Viewport {
    /// Of a resize: width of the window's inside.
    #[schema(extensions(("x-unit" = json!("CSS px"))))]
    viewport_width: Option<f64>,
    /// Of a resize: height of the window's inside.
    #[schema(extensions(("x-unit" = json!("CSS px"))))]
    viewport_height: Option<f64>,
}

/// Every column of the table of events, in order.
pub fn events_codebook() -> Vec<Column> {
    let records = [Record::of::<Belonging>(), Record::of::<TrialEvent>(), Record::of::<Viewport>()];
    records.iter().flat_map(Record::columns).filter(|column| column.name != "viewport").collect()
}

/// The rows of one answer's events; none where the page sent none, as older ones do.
pub fn event_rows(session: &EventSession<'_>, trial: &Trial, payload: &Value) -> Vec<Vec<String>> {
    let columns = events_codebook();
    let sent = trial.trial.rules().record().sound(payload).value;
    let events = sent["events"].as_array().map_or(&[][..], Vec::as_slice);
    let row = |(event_index, event): (usize, &Value)| {
        let belonging = Belonging {
            subject_id: session.subject_id.to_owned(),
            session_id: session.session_id.to_owned(),
            study_id: session.study_id.to_owned(),
            version: session.version.to_owned(),
            trial_index: trial.trial_index,
            trial_kind: trial.trial.rules().name(),
            event_index,
        };
        let viewport = Viewport {
            viewport_width: event["viewport"][0].as_f64(),
            viewport_height: event["viewport"][1].as_f64(),
        };
        let own =
            [serde_json::to_value(belonging), serde_json::to_value(viewport)].map(Result::unwrap_or_default);
        let cell = |column: &Column| {
            let value = own.iter().chain([event]).find_map(|record| record.get(&column.name));
            value.map(plain).unwrap_or_default()
        };
        columns.iter().map(cell).collect()
    };
    events.iter().enumerate().map(row).collect()
}
