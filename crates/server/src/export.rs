//! Answers as a table: one tidy row a trial, and a codebook that says what each column is.

use crate::selection::Selection;
use kelir_store::{PlannedTrial, Store, StoreError, sha256_hex};
use kelir_study::columns::{Answered, Rows, SessionColumns, SessionStatus, codebook};
use serde_json::Value;
use std::collections::HashMap;

/// A session with its trials, and what its rows say of it.
struct Taken {
    columns: SessionColumns,
    trials: Vec<PlannedTrial>,
}

/// One row for each answer to the chosen versions, in the order they came.
///
/// # Errors
/// The store cannot be read.
pub async fn responses_csv(store: &Store, selection: &Selection) -> Result<String, StoreError> {
    let study = &selection.study;
    let rows = store.answer_rows(&study.id, &selection.versions).await?;
    let mut answered: HashMap<&str, usize> = HashMap::new();
    for row in &rows {
        *answered.entry(&row.session_id).or_default() += 1;
    }
    let designs = designs(store, &study.id).await?;
    let mut sessions = HashMap::new();
    for session in store.sessions(&study.id, &selection.versions).await? {
        let trials = store.trials(&session.session_id).await?;
        let answers = answered.get(session.session_id.as_str()).copied().unwrap_or_default();
        let most = if session.more { study.most_trials() } else { trials.len() };
        let columns = SessionColumns {
            subject_id: session.subject_id,
            session_id: session.session_id.clone(),
            study_id: session.study_id,
            config_hash: session.version.clone(),
            design_hash: designs.get(&session.version).cloned().unwrap_or_default(),
            version: session.version,
            status: match session.completed_at {
                Some(_) => SessionStatus::Completed,
                None => SessionStatus::InProgress,
            },
            percent_complete: 100.0 * answers as f64 / most.max(1) as f64,
            slot: session.slot,
            plan_seed: session.plan_seed,
        };
        sessions.insert(session.session_id, Taken { columns, trials });
    }
    let table = Rows::default();
    let mut out = String::new();
    write_row(&mut out, table.names().to_vec());
    for row in &rows {
        let Some(taken) = sessions.get(&row.session_id) else { continue };
        let Some(planned) = taken.trials.get(row.trial_index as usize) else { continue };
        let payload = row.payload.as_deref().and_then(|payload| serde_json::from_str(payload).ok());
        write_row(
            &mut out,
            table.cells(&Answered {
                study,
                session: &taken.columns,
                trial: &planned.trial,
                sha256: row.shown.iter().map(|(role, shown)| (*role, shown.sha256.as_str())).collect(),
                answer: row.answer.as_deref().filter(|_| row.payload.is_some()),
                payload: &payload.unwrap_or(Value::Null),
                payload_hash: row.payload.as_ref().map(|payload| sha256_hex(payload.as_bytes())),
                answer_hash: &row.answer_hash,
                received_at: &row.received_at,
                place: (row.chain, row.seq),
            }),
        );
    }
    Ok(out)
}

/// Hash of the design of each version.
async fn designs(store: &Store, study_id: &str) -> Result<HashMap<String, String>, StoreError> {
    let versions = store.study_versions(study_id).await?;
    Ok(versions.into_iter().map(|version| (version.version, version.design_hash)).collect())
}

/// The codebook: `column,type,unit,meaning,values`.
pub fn codebook_csv() -> String {
    let mut out = String::new();
    write_row(&mut out, ["column", "type", "unit", "meaning", "values"].map(str::to_owned));
    for column in codebook() {
        let values: Vec<String> =
            column.values.iter().map(|v| format!("{}: {}", v.value, v.meaning)).collect();
        write_row(&mut out, [column.name, column.kind, column.unit, column.meaning, values.join("; ")]);
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
