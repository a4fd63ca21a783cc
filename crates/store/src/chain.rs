//! The chains of answers, proved: no answer was changed, removed from the middle, reordered or slipped in.

use crate::answers::{RowValues, answer_hash, genesis};
use crate::clock;
use crate::error::StoreError;
use crate::files::sha256_hex;
use crate::first_chain::{self, FirstRow, GENESIS};
use crate::sqlite::Store;
use serde::Serialize;
use serde::de::IgnoredAny;
use sqlx::Row;
use sqlx::sqlite::SqliteRow;
use utoipa::ToSchema;

/// What checking a study's answers found, those of chain version 1 (all studies of before) among them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct ChainReport {
    /// Rows that were checked.
    pub rows: u64,
    /// Hash of the last row; noting it elsewhere also proves that no later rows were cut off.
    pub head: String,
    /// Rows that are not what was written; checking went on behind them.
    pub faults: Vec<Fault>,
    /// Answers that were blanked by a withdrawal.
    pub blanked: u64,
}

/// A row that does not verify.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct Fault {
    /// Version of the chain: 1 (all studies in one, closed) or 2 (the study's own).
    pub chain: u32,
    /// Place in its chain.
    pub seq: i64,
    /// What is wrong with it.
    pub what: String,
    /// What is known of it: the last note that somebody left.
    pub note: Option<String>,
}

impl ChainReport {
    /// Rows that do not verify and that nobody has explained.
    pub fn unexplained(&self) -> impl Iterator<Item = &Fault> {
        self.faults.iter().filter(|fault| fault.note.is_none())
    }
}

/// Rows that are looked at in one go.
const PAGE: i64 = 10_000;

impl Store {
    /// Proves the chain of a study's answers and, before it, the one that all studies shared. A row that does not verify is named, and
    /// checking goes on behind it.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn verify_chain(&self, study_id: &str) -> Result<ChainReport, StoreError> {
        let mut report = ChainReport { rows: 0, head: GENESIS.to_owned(), faults: Vec::new(), blanked: 0 };
        self.verify_first(&mut report).await?;
        report.head = genesis(&mut *self.reader.acquire().await?).await?;
        self.verify_second(study_id, &mut report).await?;
        for fault in &mut report.faults {
            fault.note = sqlx::query_scalar(
                "SELECT note FROM chain_notes WHERE chain = $1 AND seq = $2 AND (chain = 1 OR study_id = $3)
                 ORDER BY note_id DESC LIMIT 1",
            )
            .bind(fault.chain)
            .bind(fault.seq)
            .bind(study_id)
            .fetch_optional(&self.reader)
            .await?;
        }
        Ok(report)
    }

    async fn verify_first(&self, report: &mut ChainReport) -> Result<(), StoreError> {
        let query =
            format!("{} WHERE r.response_id > $1 ORDER BY r.response_id LIMIT {PAGE}", first_chain::SELECT);
        let mut previous = (0, GENESIS.to_owned());
        loop {
            let page =
                sqlx::query(sqlx::AssertSqlSafe(query.clone())).bind(previous.0).fetch_all(&self.reader);
            let page = page.await?;
            if page.is_empty() {
                return Ok(());
            }
            for row in &page {
                let row = FirstRow::read(row)?;
                let (seq, hash) = row.place();
                report.note(1, seq, row.fault((previous.0, &previous.1)), row.is_blanked());
                previous = (seq, hash.to_owned());
            }
        }
    }

    async fn verify_second(&self, study_id: &str, report: &mut ChainReport) -> Result<(), StoreError> {
        let mut seq = 0;
        loop {
            let query = sqlx::query(
                "SELECT a.*, c.nonce, c.answer, c.payload, c.seq AS held FROM answers a
                 LEFT JOIN answer_contents c ON c.study_id = a.study_id AND c.seq = a.seq
                 WHERE a.study_id = $1 AND a.seq > $2 ORDER BY a.seq LIMIT $3",
            );
            let page = query.bind(study_id).bind(seq).bind(PAGE).fetch_all(&self.reader).await?;
            if page.is_empty() {
                return Ok(());
            }
            for row in &page {
                let fault = fault(row, seq + 1, &report.head)?;
                seq = row.try_get("seq")?;
                let blanked = row.try_get::<Option<Vec<u8>>, _>("nonce")?.is_none();
                report.note(2, seq, fault, blanked);
                report.head = row.try_get("row_hash")?;
            }
        }
    }

    /// Leaves a note on a row of a study's chain, for whoever verifies it later. Notes are never changed; the last one counts.
    ///
    /// # Errors
    /// The database refuses, as it does an empty text or an unknown chain.
    pub async fn note_on_chain(
        &self,
        study_id: &str,
        chain: u32,
        seq: i64,
        note: &str,
        author: &str,
    ) -> Result<(), StoreError> {
        sqlx::query(
            "INSERT INTO chain_notes (chain, study_id, seq, note, author, written_at) VALUES ($1, $2, $3, $4, $5, $6)",
        )
        .bind(chain)
        .bind(study_id)
        .bind(seq)
        .bind(note)
        .bind(author)
        .bind(clock::now())
        .execute(&self.writer)
        .await?;
        Ok(())
    }
}

impl ChainReport {
    fn note(&mut self, chain: u32, seq: i64, fault: Option<&str>, blanked: bool) {
        self.rows += 1;
        self.blanked += u64::from(blanked);
        if let Some(what) = fault {
            self.faults.push(Fault { chain, seq, what: what.to_owned(), note: None });
        }
    }
}

/// What is wrong with a row of `answers` that should be number `seq` and follow `prev_hash`.
fn fault(row: &SqliteRow, seq: i64, prev_hash: &str) -> Result<Option<&'static str>, StoreError> {
    let text: String = row.try_get("row")?;
    if row.try_get::<i64, _>("seq")? != seq {
        return Ok(Some("rows before it are missing"));
    }
    if sha256_hex(text.as_bytes()) != row.try_get::<String, _>("row_hash")? {
        return Ok(Some("its values are not those that were written"));
    }
    let Ok(values) = serde_json::from_str::<RowValues<IgnoredAny>>(&text) else {
        return Ok(Some("it is no row of answers"));
    };
    let (study_id, own_seq, session_id, trial_index, _, _, _, hash, prev) = values;
    let (of_study, of_session): (String, String) = (row.try_get("study_id")?, row.try_get("session_id")?);
    let in_place = study_id == of_study && own_seq == seq && session_id == of_session;
    if !in_place || i64::from(trial_index) != row.try_get::<i64, _>("trial_index")? {
        return Ok(Some("it stands in another row's place"));
    }
    if prev != prev_hash {
        return Ok(Some("it does not follow the row before"));
    }
    if row.try_get::<Option<i64>, _>("held")?.is_none() {
        return Ok(Some("its answer is gone, and not by a withdrawal"));
    }
    let nonce: Option<Vec<u8>> = row.try_get("nonce")?;
    let (answer, payload): (Option<String>, Option<String>) =
        (row.try_get("answer")?, row.try_get("payload")?);
    Ok(match (nonce, answer, payload) {
        (None, None, None) => None,
        (Some(nonce), Some(answer), Some(payload)) if answer_hash(&nonce, &answer, &payload) == hash => None,
        _ => Some("its answer is not the one that came"),
    })
}
