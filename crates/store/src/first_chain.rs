//! Chain version 1: the answers of before there were kinds of trials, one chain for all studies, closed since. Its rows stay as they are,
//! readable and verified by their own rule.

use crate::answer_row::{AnswerRow, ShownStimulus};
use crate::error::StoreError;
use crate::files::sha256_hex;
use crate::text::{bytes, text as text_of};
use kelir_study::trials::Role;
use rusqlite::{Connection, OptionalExtension};
use serde_json::{Value, json};
use sqlx::Row;
use sqlx::sqlite::SqliteRow;
use std::collections::BTreeMap;

/// `prev_hash` of the first row.
pub const GENESIS: &str = "0000000000000000000000000000000000000000000000000000000000000000";

/// What a chain of version 2 begins with: the last hash of version 1.
pub(crate) fn genesis(connection: &Connection) -> Result<String, StoreError> {
    let mut last =
        connection.prepare_cached("SELECT row_hash FROM responses ORDER BY response_id DESC LIMIT 1")?;
    Ok(last.query_row([], |row| row.get(0)).optional()?.unwrap_or_else(|| GENESIS.to_owned()))
}

/// Columns of a row with what it refers to.
pub(crate) const SELECT: &str =
    "SELECT r.*, s.subject_id, s.study_id, p.payload, p.response_id AS held, l.pixels_sha256 AS left_pixels, x.pixels_sha256 AS right_pixels
     FROM responses r LEFT JOIN sessions s USING (session_id) LEFT JOIN response_payloads p USING (response_id)
     LEFT JOIN stimuli l ON l.sha256 = r.left_sha256 LEFT JOIN stimuli x ON x.sha256 = r.right_sha256";

/// A row of `responses`.
pub(crate) struct FirstRow {
    response_id: i64,
    text: BTreeMap<&'static str, String>,
    trial_index: i64,
    rt_ms: f64,
    payload: Option<Vec<u8>>,
    /// Whether there is a place for its payload, with or without one.
    held: bool,
}

const TEXTS: [&str; 12] = [
    "session_id",
    "block_id",
    "pair_id",
    "left_sha256",
    "right_sha256",
    "left_condition",
    "right_condition",
    "choice",
    "chosen_condition",
    "received_at",
    "payload_hash",
    "prev_hash",
];

impl FirstRow {
    pub(crate) fn read(row: &SqliteRow) -> Result<FirstRow, StoreError> {
        let mut text = BTreeMap::new();
        for name in TEXTS.into_iter().chain(["row_hash"]) {
            text.insert(name, text_of(row, name)?.into_owned());
        }
        Ok(FirstRow {
            response_id: row.try_get("response_id")?,
            text,
            trial_index: row.try_get("trial_index")?,
            rt_ms: row.try_get("rt_ms")?,
            payload: bytes(row, "payload")?.map(<[u8]>::to_vec),
            held: row.try_get::<Option<i64>, _>("held")?.is_some(),
        })
    }

    fn of(&self, name: &str) -> &str {
        self.text.get(name).map_or("", String::as_str)
    }

    /// SHA-256 (hex) over a JSON array of the row's values in column order, with this response time.
    fn hash(&self, rt_ms: f64) -> String {
        let mut values = vec![json!(self.response_id), json!(self.of("session_id")), json!(self.trial_index)];
        values.extend(TEXTS[1..9].iter().map(|name| json!(self.of(name))));
        values.push(json!(rt_ms));
        values.extend(TEXTS[9..].iter().map(|name| json!(self.of(name))));
        sha256_hex(Value::Array(values).to_string().as_bytes())
    }

    /// What is wrong with the row after `previous` (its number and hash).
    pub(crate) fn faults(&self, previous: (i64, &str)) -> Vec<&'static str> {
        let mut faults = Vec::new();
        if self.response_id != previous.0 + 1 {
            faults.push("rows before it are missing");
        } else if self.of("prev_hash") != previous.1 {
            faults.push("it does not follow the row before");
        }
        // SQLite reads a stored −0.0 back as 0.0: what was hashed is then the other zero.
        let whole = |rt: f64| self.hash(rt) == self.of("row_hash");
        if !(whole(self.rt_ms) || self.rt_ms == 0.0 && whole(-0.0)) {
            faults.push("its values are not those that were written");
        }
        if !self.held {
            faults.push("its payload is gone, and not by a withdrawal");
        }
        if self.payload.as_ref().is_some_and(|payload| sha256_hex(payload) != self.of("payload_hash")) {
            faults.push("its payload is not the one that came");
        }
        faults
    }

    pub(crate) fn place(&self) -> (i64, &str) {
        (self.response_id, self.of("row_hash"))
    }

    pub(crate) fn is_blanked(&self) -> bool {
        self.held && self.payload.is_none()
    }
}

/// The answer of a row of `responses`, as rows of version 2 have it.
pub(crate) fn answer(choice: &str, rt_ms: f64) -> Result<String, StoreError> {
    let answer = json!({ "choice": choice, "rt_ms": rt_ms });
    kelir_jcs::canonical(answer).map_err(|error| StoreError::corrupt("answer", error))
}

/// A row of [`SELECT`] in the shape of all others.
pub(crate) fn read_answer(row: &SqliteRow) -> Result<AnswerRow, StoreError> {
    let payload: Option<String> = row.try_get("payload")?;
    let stimulus = |side: &str| -> Result<ShownStimulus, StoreError> {
        Ok(ShownStimulus {
            item: row.try_get("pair_id")?,
            condition: row.try_get(format!("{side}_condition").as_str())?,
            sha256: row.try_get(format!("{side}_sha256").as_str())?,
            pixels_sha256: row
                .try_get::<Option<String>, _>(format!("{side}_pixels").as_str())?
                .unwrap_or_default(),
        })
    };
    Ok(AnswerRow {
        chain: 1,
        seq: row.try_get("response_id")?,
        session_id: row.try_get("session_id")?,
        subject_id: row.try_get("subject_id")?,
        trial_index: row.try_get("trial_index")?,
        trial_kind: "two-alternative".to_owned(),
        shown: [(Role::Left, stimulus("left")?), (Role::Right, stimulus("right")?)].into(),
        received_at: row.try_get("received_at")?,
        answer: Some(answer(row.try_get("choice")?, row.try_get("rt_ms")?)?),
        answer_hash: row.try_get("payload_hash")?,
        payload,
    })
}
