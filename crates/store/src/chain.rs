//! The chain of answers: each row's hash covers the row, the hash of what the browser sent with it, and the row before.

use crate::error::StoreError;
use crate::files::sha256_hex;
use crate::responses::{ResponseRow, read_response};
use crate::sqlite::Store;
use serde::Serialize;
use serde_json::json;
use sqlx::Row;

/// `prev_hash` of the first row.
pub const GENESIS: &str = "0000000000000000000000000000000000000000000000000000000000000000";

/// The part of a row that its hash covers, besides the previous hash.
#[derive(Clone, Debug, PartialEq)]
pub struct ChainRow<'a> {
    /// The row.
    pub row: &'a ResponseRow,
    /// Hash of the row before.
    pub prev_hash: &'a str,
}

impl ChainRow<'_> {
    /// SHA-256 (hex) over a JSON array of the row's values in column order.
    pub fn hash(&self) -> String {
        let r = self.row;
        let values = json!([
            r.response_id,
            r.session_id,
            r.trial_index,
            r.block_id,
            r.pair_id,
            r.left_sha256,
            r.right_sha256,
            r.left_condition,
            r.right_condition,
            r.choice,
            r.chosen_condition,
            r.rt_ms,
            r.received_at,
            r.payload_hash,
            self.prev_hash,
        ]);
        sha256_hex(values.to_string().as_bytes())
    }
}

/// What checking the chain found.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ChainReport {
    /// Rows that were checked, up to and including a broken one.
    pub rows: u64,
    /// Hash of the last good row; noting it elsewhere also proves that no later rows were cut off.
    pub head: String,
    /// `response_id` of the first row that is not what was written, and what is wrong with it.
    pub broken: Option<(i64, String)>,
    /// Payloads that were blanked by a withdrawal.
    pub blanked: u64,
}

impl Store {
    /// Proves that no answer was changed, removed from the middle, reordered or slipped in, and that every payload that is
    /// there is the one that came.
    pub async fn verify_chain(&self) -> Result<ChainReport, StoreError> {
        let mut report = ChainReport { rows: 0, head: GENESIS.to_owned(), broken: None, blanked: 0 };
        let mut after = 0i64;
        loop {
            let rows = sqlx::query(
                "SELECT r.*, s.subject_id, p.payload FROM responses r LEFT JOIN sessions s USING (session_id)
                 LEFT JOIN response_payloads p USING (response_id)
                 WHERE r.response_id > $1 ORDER BY r.response_id LIMIT 10000",
            )
            .bind(after)
            .fetch_all(&self.reader)
            .await?;
            if rows.is_empty() {
                return Ok(report);
            }
            for row in &rows {
                let response = read_response(row)?;
                let (prev_hash, row_hash): (String, String) =
                    (row.try_get("prev_hash")?, row.try_get("row_hash")?);
                let payload: Option<String> = row.try_get("payload")?;
                report.rows += 1;
                let wrong = if response.response_id != after + 1 {
                    Some("rows before it are missing")
                } else if prev_hash != report.head {
                    Some("it does not follow the row before")
                } else if (ChainRow { row: &response, prev_hash: &prev_hash }).hash() != row_hash {
                    Some("its values are not those that were written")
                } else if payload.as_ref().is_some_and(|p| sha256_hex(p.as_bytes()) != response.payload_hash)
                {
                    Some("its payload is not the one that came")
                } else {
                    None
                };
                if let Some(wrong) = wrong {
                    report.broken = Some((response.response_id, wrong.to_owned()));
                    return Ok(report);
                }
                report.blanked += u64::from(payload.is_none());
                report.head = row_hash;
                after = response.response_id;
            }
        }
    }
}
