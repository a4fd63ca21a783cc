//! Answers as a table: one tidy row a trial, and a codebook that says what each column is.

use kelir_store::{ResponseRow, Session, Store, StoreError};
use kelir_study::StudyDefinition;
use kelir_study::schema::Column;
use serde_json::Value;
use std::collections::HashMap;

/// Columns of the responses table and what they are: (name, type, unit, meaning). Names follow jsPsych where it has one.
pub const CODEBOOK: &[(&str, &str, &str, &str)] = &[
    ("subject_id", "text", "", "Participant: the recruiting panel's id, else the session's id"),
    ("session_id", "text", "", "Session (UUID v7)"),
    ("study_id", "text", "", "Study"),
    ("config_hash", "text", "", "SHA-256 of the study's definition"),
    ("status", "text", "", "Of the session: completed or in progress"),
    ("percent_complete", "number", "%", "Part of the session's trials that have an answer"),
    ("slot", "integer", "", "Place in the design; slots 2k and 2k + 1 are mirror images in side"),
    ("plan_seed", "text", "", "Seed of the session's trial plan"),
    ("trial_index", "integer", "", "Place of the trial in the session, from 0"),
    ("trial_type", "text", "", "Plugin that showed the trial"),
    ("plugin_version", "text", "", "Version of that plugin"),
    ("block_id", "text", "", "Block"),
    ("block_index", "integer", "", "Place of the block in the study, from 0"),
    ("pair_id", "text", "", "Item"),
    ("pair_index", "integer", "", "Place of the pair in its block's file order, from 0"),
    ("kind", "text", "", "still or animation"),
    ("stimulus", "text", "", "JSON array of the SHA-256 of the stimuli, left then right"),
    ("left_condition", "text", "", "Condition shown on the left"),
    ("right_condition", "text", "", "Condition shown on the right"),
    ("left_sha256", "text", "", "SHA-256 of the stimulus on the left"),
    ("right_sha256", "text", "", "SHA-256 of the stimulus on the right"),
    ("response", "text", "", "Side chosen: left or right"),
    ("chosen_condition", "text", "", "Condition chosen"),
    ("target_condition", "text", "", "Condition whose choices the block counts"),
    ("target_chosen", "integer", "", "1 when the target was chosen, else 0"),
    ("correct", "text", "", "Empty: a preference has no right answer"),
    ("rt", "number", "ms", "From the first frame that showed the pair to the choice"),
    ("time_elapsed", "number", "ms", "From the start of the page's session to the choice"),
    ("ended_on", "text", "", "What ended the trial: response"),
    ("input", "text", "", "mouse, touch, pen or keyboard"),
    ("scale", "number", "", "CSS pixels shown per stimulus pixel; 1 is native when device_pixel_ratio is 1"),
    ("arrangement", "text", "", "How the two stimuli stood: beside or below each other"),
    ("device_pixel_ratio", "number", "", "Device pixels per CSS pixel"),
    ("viewport_width", "number", "CSS px", "Width of the window's inside"),
    ("viewport_height", "number", "CSS px", "Height of the window's inside"),
    ("refresh_hz", "number", "Hz", "Measured refresh rate of the display"),
    ("hidden_ms", "number", "ms", "How long the page was hidden during the trial"),
    ("reload_count", "integer", "", "How often the page had been reloaded"),
    ("timestamp", "text", "ISO 8601", "When the browser had the answer, by its own clock"),
    ("received_at", "text", "ISO 8601", "When the server committed the answer"),
    ("payload_hash", "text", "", "SHA-256 of all that the browser sent; the chain of answers covers it"),
];

/// One row for each answer to this version of a study, in the order they came.
///
/// # Errors
/// The store cannot be read.
pub async fn responses_csv(store: &Store, study: &StudyDefinition) -> Result<String, StoreError> {
    let config_hash = study.config_hash();
    let rows = store.responses(&study.id, &config_hash).await?;
    let sessions = store.sessions(&study.id, &config_hash).await?;
    let sessions: HashMap<&str, &Session> = sessions.iter().map(|s| (s.session_id.as_str(), s)).collect();
    let mut answered: HashMap<&str, usize> = HashMap::new();
    for (row, _) in &rows {
        *answered.entry(&row.session_id).or_default() += 1;
    }
    let mut out = String::new();
    write_row(&mut out, CODEBOOK.iter().map(|column| column.0.to_owned()));
    for (row, payload) in &rows {
        let Some(session) = sessions.get(row.session_id.as_str()) else { continue };
        let payload: Value =
            payload.as_deref().and_then(|p| serde_json::from_str(p).ok()).unwrap_or_default();
        let answered = answered.get(row.session_id.as_str()).copied().unwrap_or_default();
        let cells = CODEBOOK.iter().map(|column| cell(column.0, study, session, row, &payload, answered));
        write_row(&mut out, cells);
    }
    Ok(out)
}

fn cell(
    column: &str,
    study: &StudyDefinition,
    session: &Session,
    row: &ResponseRow,
    payload: &Value,
    answered: usize,
) -> String {
    let planned = session.trials.get(row.trial_index as usize).map(|planned| &planned.trial);
    let target = study.block(&row.block_id).map(|block| block.target.as_str()).unwrap_or_default();
    match column {
        "subject_id" => row.subject_id.clone(),
        "session_id" => row.session_id.clone(),
        "study_id" => session.study_id.clone(),
        "config_hash" => session.config_hash.clone(),
        "status" => if session.completed_at.is_some() { "completed" } else { "in progress" }.to_owned(),
        "percent_complete" => (100.0 * answered as f64 / session.trials.len() as f64).to_string(),
        "slot" => session.slot.to_string(),
        "plan_seed" => session.plan_seed.clone(),
        "trial_index" => row.trial_index.to_string(),
        "block_id" => row.block_id.clone(),
        "block_index" => planned.map(|t| t.block_index.to_string()).unwrap_or_default(),
        "pair_id" => row.pair_id.clone(),
        "pair_index" => planned.map(|t| t.item_index.to_string()).unwrap_or_default(),
        "kind" => planned.map(|t| plain(&serde_json::json!(t.kind))).unwrap_or_default(),
        "stimulus" => serde_json::json!([row.left_sha256, row.right_sha256]).to_string(),
        "left_condition" => row.left_condition.clone(),
        "right_condition" => row.right_condition.clone(),
        "left_sha256" => row.left_sha256.clone(),
        "right_sha256" => row.right_sha256.clone(),
        "response" => row.choice.clone(),
        "chosen_condition" => row.chosen_condition.clone(),
        "target_condition" => target.to_owned(),
        "target_chosen" => u8::from(row.chosen_condition == target).to_string(),
        "correct" => String::new(),
        "rt" => row.rt_ms.to_string(),
        "ended_on" => "response".to_owned(),
        "viewport_width" => plain(&payload["viewport"][0]),
        "viewport_height" => plain(&payload["viewport"][1]),
        "received_at" => row.received_at.clone(),
        "payload_hash" => row.payload_hash.clone(),
        from_browser => plain(&payload[from_browser]),
    }
}

/// A JSON value as a cell: texts bare, null empty.
fn plain(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// What each column is.
pub fn codebook() -> Vec<Column> {
    let column = |(name, kind, unit, meaning): &(&str, &str, &str, &str)| Column {
        name: (*name).to_owned(),
        kind: (*kind).to_owned(),
        unit: (*unit).to_owned(),
        meaning: (*meaning).to_owned(),
        values: Vec::new(),
    };
    CODEBOOK.iter().map(column).collect()
}

/// The codebook: `column,type,unit,meaning`.
pub fn codebook_csv() -> String {
    let mut out = String::new();
    write_row(&mut out, ["column", "type", "unit", "meaning"].map(str::to_owned));
    for (name, kind, unit, meaning) in CODEBOOK {
        write_row(&mut out, [name, kind, unit, meaning].map(|s| (*s).to_owned()));
    }
    out
}

/// RFC 4180: quoted where need be, CRLF at the end. A cell that a spreadsheet would take for a formula gets an apostrophe before it.
pub(crate) fn write_row(out: &mut String, cells: impl IntoIterator<Item = String>) {
    for (i, mut cell) in cells.into_iter().enumerate() {
        if i > 0 {
            out.push(',');
        }
        if cell.starts_with(['=', '+', '@', '\t', '\r'])
            || (cell.starts_with('-') && cell.parse::<f64>().is_err())
        {
            cell.insert(0, '\'');
        }
        if cell.contains([',', '"', '\n', '\r']) {
            out.push_str(&format!("\"{}\"", cell.replace('"', "\"\"")));
        } else {
            out.push_str(&cell);
        }
    }
    out.push_str("\r\n");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_quoted_and_no_formula_survives() {
        let mut out = String::new();
        write_row(&mut out, ["a", "b,c", "d\"e", "=1+1", "-3.5", "-cmd"].map(str::to_owned));
        assert_eq!(out, "a,\"b,c\",\"d\"\"e\",'=1+1,-3.5,'-cmd\r\n");
    }
}
