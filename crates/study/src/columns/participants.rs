//! The table of participants: one row a session, all that is known of it but its answers.

use super::{SessionStatus, plain};
use crate::schema::{Column, Record};
use crate::visits::{Flag, SessionKind, parameter};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use utoipa::ToSchema;

/// What a row says of a session.
#[derive(Clone, Debug, Default, Serialize, ToSchema)]
pub struct ParticipantColumns {
    /// Participant: the id that the link named, as it was sent; else the session's id.
    pub subject_id: String,
    /// Session (UUID v7).
    pub session_id: String,
    /// Study.
    pub study_id: String,
    /// Parameter of the link that named the participant; empty where none did.
    pub id_parameter: Option<String>,
    /// Whose session it is.
    pub session_kind: SessionKind,
    /// How far the session is.
    pub status: SessionStatus,
    /// 1 where the analysis counts the session's answers; else 0.
    pub judged: u8,
    /// Why it does not, where it has a reason.
    pub reject_reason: Option<String>,
    /// What was noticed of the session, in words apart by a blank, whether or not it leaves out.
    pub flags: String,
    /// Part of the session's trials that have an answer; of the most there can be where answers decide how many.
    #[schema(extensions(("x-unit" = json!("%"))))]
    pub percent_complete: f64,
    /// Answers that are stored.
    pub answers: u64,
    /// Version of the study: SHA-256 of its design and of the pixels of all that it shows.
    pub version: String,
    /// SHA-256 of the study's design: of all values of its file but those that nobody judges by.
    pub design_hash: String,
    /// SHA-256 of all values of the study's file that the session began with.
    pub file_hash: String,
    /// Place in the design; slots 2k and 2k + 1 are mirror images in side or order.
    pub slot: u32,
    /// Seed of the session's trial plan.
    pub plan_seed: String,
    /// When the session began, ISO 8601.
    pub created_at: String,
    /// When consent was given, ISO 8601.
    pub consented_at: Option<String>,
    /// SHA-256 of the text that was agreed to.
    pub consent_sha256: Option<String>,
    /// When the code was given, ISO 8601.
    pub completed_at: Option<String>,
    /// When the session was last heard of, ISO 8601.
    pub last_seen_at: String,
    /// From consent to the code.
    #[schema(extensions(("x-unit" = json!("s"))))]
    pub duration_s: Option<f64>,
    /// Code given at the end.
    pub completion_code: Option<String>,
    /// What the browser calls itself.
    pub user_agent: Option<String>,
    /// Language that the study was read in, or else the browser's.
    pub language: Option<String>,
    /// Width of the screen.
    #[schema(extensions(("x-unit" = json!("device px"))))]
    pub resolution_width: Option<f64>,
    /// Height of the screen.
    #[schema(extensions(("x-unit" = json!("device px"))))]
    pub resolution_height: Option<f64>,
    /// Width of the window's inside when the session began.
    #[schema(extensions(("x-unit" = json!("CSS px"))))]
    pub viewport_width: Option<f64>,
    /// Height of the window's inside when the session began.
    #[schema(extensions(("x-unit" = json!("CSS px"))))]
    pub viewport_height: Option<f64>,
    /// Device pixels per CSS pixel when the session began.
    pub device_pixel_ratio: Option<f64>,
    /// Bits per pixel of the screen.
    #[schema(extensions(("x-unit" = json!("bit"))))]
    pub color_depth: Option<f64>,
    /// 1 where the screen shows more than sRGB's colours (P3); else 0.
    pub wide_gamut: Option<u8>,
    /// 1 where the screen shows high dynamic range; else 0.
    pub high_dynamic_range: Option<u8>,
    /// 1 where the main pointer is a finger; else 0.
    pub touch: Option<u8>,
    /// 1 where less motion is asked for; else 0.
    pub reduced_motion: Option<u8>,
    /// Refresh rate, as the last answer measured it.
    #[schema(extensions(("x-unit" = json!("Hz"))))]
    pub refresh_hz: Option<f64>,
    /// How often the page was loaded again before the last answer.
    pub reload_count: Option<u64>,
}

/// The first columns, in this order; the others follow by their names.
const FIRST: [&str; 21] = [
    "subject_id",
    "session_id",
    "study_id",
    "id_parameter",
    "session_kind",
    "status",
    "judged",
    "reject_reason",
    "flags",
    "percent_complete",
    "answers",
    "version",
    "slot",
    "created_at",
    "consented_at",
    "completed_at",
    "last_seen_at",
    "duration_s",
    "completion_code",
    "user_agent",
    "language",
];

/// Every column of the table of participants, in order: those of every study, and of the parameters that this one lists.
pub fn participants_codebook(params: &[String]) -> Vec<Column> {
    let mut all = Record::of::<ParticipantColumns>().columns();
    let place = |column: &Column| FIRST.iter().position(|name| *name == column.name).unwrap_or(FIRST.len());
    all.sort_by_key(place);
    if let Some(flags) = all.iter_mut().find(|column| column.name == "flags") {
        flags.values = flag_meanings();
    }
    all.extend(params.iter().map(|name| Column {
        name: param(name),
        kind: "text".to_owned(),
        unit: String::new(),
        meaning: format!(
            "Parameter {name} of the participant's link, as it was sent; empty where it was not there."
        ),
        values: Vec::new(),
    }));
    all
}

fn flag_meanings() -> Vec<crate::schema::Meaning> {
    let of = |flag: &Flag| crate::schema::Meaning {
        value: flag.as_str().to_owned(),
        meaning: flag.meaning().to_owned(),
    };
    Flag::ALL.iter().map(of).collect()
}

fn param(name: &str) -> String {
    format!("param_{name}")
}

impl ParticipantColumns {
    /// Fills in what the browser said of its display when the session began. What it did not say as it should stays empty.
    pub fn with_display(mut self, display: &Value) -> ParticipantColumns {
        let text = |key: &str| display[key].as_str().map(str::to_owned);
        let is = |key: &str| display[key].as_bool().map(u8::from);
        self.user_agent = self.user_agent.or_else(|| text("user_agent"));
        self.language = text("language");
        [self.resolution_width, self.resolution_height] = [0, 1].map(|i| display["resolution"][i].as_f64());
        [self.viewport_width, self.viewport_height] = [0, 1].map(|i| display["viewport"][i].as_f64());
        self.device_pixel_ratio = display["device_pixel_ratio"].as_f64();
        self.color_depth = display["color_depth"].as_f64();
        self.wide_gamut = is("wide_gamut");
        self.high_dynamic_range = is("high_dynamic_range");
        self.touch = is("touch");
        self.reduced_motion = is("reduced_motion");
        self
    }

    /// The cells of the columns of [`participants_codebook`].
    pub fn cells(
        &self,
        params: &[String],
        sent: &BTreeMap<String, String>,
        columns: &[Column],
    ) -> Vec<String> {
        let mut values: Map<String, Value> = serde_json::to_value(self)
            .ok()
            .and_then(|record| record.as_object().cloned())
            .unwrap_or_default();
        values.extend(
            params.iter().map(|name| (param(name), json!(parameter(sent, name).map(|(_, value)| value)))),
        );
        columns.iter().map(|column| values.get(&column.name).map(plain).unwrap_or_default()).collect()
    }
}
