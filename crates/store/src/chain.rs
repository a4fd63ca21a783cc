//! The chains of answers, proved: no answer was changed, removed from the middle, reordered or slipped in.

use crate::answer_row::{RowValues, answer_hash};
use crate::clock;
use crate::error::StoreError;
use crate::files::sha256_hex;
use crate::first_chain::{self, FirstRow, GENESIS, genesis};
use crate::sqlite::Store;
use crate::text::{bytes, text};
use crate::threads::patiently;
use rusqlite::params;
use serde::Serialize;
use serde::de::IgnoredAny;
use sqlx::Row;
use sqlx::sqlite::SqliteRow;
use tokio::runtime::Handle;
use utoipa::ToSchema;

/// What checking a study's answers found, those of chain version 1 (all studies of before) among them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct ChainReport {
    /// Rows that were checked.
    pub rows: u64,
    /// Hash of the last row; noting it elsewhere also proves that no later rows were cut off.
    pub head: String,
    /// All that is wrong, row by row; checking went on behind each. A row can have several.
    pub faults: Vec<Fault>,
    /// Answers that were blanked by a withdrawal.
    pub blanked: u64,
}

/// Something wrong with a row.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct Fault {
    /// Version of the chain: 1 (all studies in one, closed) or 2 (the study's own).
    pub chain: u32,
    /// Place in its chain.
    pub seq: i64,
    /// What is wrong.
    pub what: String,
    /// What is known of the row: the last note that somebody left.
    pub note: Option<String>,
}

impl ChainReport {
    /// Faults of rows that nobody has explained.
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
        let (store, study_id) = (self.clone(), study_id.to_owned());
        patiently(move || Handle::current().block_on(store.verify(&study_id))).await
    }

    async fn verify(&self, study_id: &str) -> Result<ChainReport, StoreError> {
        let mut report = ChainReport { rows: 0, head: GENESIS.to_owned(), faults: Vec::new(), blanked: 0 };
        self.verify_first(&mut report).await?;
        report.head = self.readers.read(genesis).await?;
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
                report.add(1, seq, row.faults((previous.0, &previous.1)), row.is_blanked());
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
                let held = Held::read(row)?;
                let faults = faults(row, &held, (seq, &report.head))?;
                seq = row.try_get("seq")?;
                report.add(2, seq, faults, held == Held::Blanked);
                report.head = text(row, "row_hash")?.into_owned();
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
        let [study_id, note, author] = [study_id, note, author].map(str::to_owned);
        self.write(move |writer| {
            writer.execute(
                "INSERT INTO chain_notes (chain, study_id, seq, note, author, written_at) VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
                params![chain, study_id, seq, note, author, clock::now()],
            )?;
            Ok(())
        })
        .await
    }
}

impl ChainReport {
    fn add(&mut self, chain: u32, seq: i64, faults: Vec<&str>, blanked: bool) {
        self.rows += 1;
        self.blanked += u64::from(blanked);
        let fault = |what: &str| Fault { chain, seq, what: what.to_owned(), note: None };
        self.faults.extend(faults.into_iter().map(fault));
    }
}

/// What lies beside a row of `answers`.
#[derive(PartialEq)]
enum Held<'a> {
    /// Nonce, answer and payload.
    Whole([&'a [u8]; 3]),
    /// What a withdrawal leaves.
    Blanked,
    /// Nothing: not even an empty place.
    Gone,
}

impl<'a> Held<'a> {
    fn read(row: &'a SqliteRow) -> Result<Held<'a>, StoreError> {
        if row.try_get::<Option<i64>, _>("held")?.is_none() {
            return Ok(Held::Gone);
        }
        let [nonce, answer, payload] = ["nonce", "answer", "payload"].map(|column| bytes(row, column));
        Ok(match (nonce?, answer?, payload?) {
            (None, None, None) => Held::Blanked,
            (nonce, answer, payload) => Held::Whole([nonce, answer, payload].map(Option::unwrap_or_default)),
        })
    }
}

/// What is wrong with a row of `answers` after `previous` (its number and hash).
fn faults(row: &SqliteRow, held: &Held<'_>, previous: (i64, &str)) -> Result<Vec<&'static str>, StoreError> {
    let mut faults = Vec::new();
    let seq: i64 = row.try_get("seq")?;
    let adjoins = seq == previous.0 + 1;
    if !adjoins {
        faults.push("rows before it are missing");
    }
    let written = bytes(row, "row")?.unwrap_or_default();
    if sha256_hex(written) != text(row, "row_hash")? {
        faults.push("its values are not those that were written");
    }
    let Ok(values) = serde_json::from_slice::<RowValues<IgnoredAny>>(written) else {
        faults.push("it is no row of answers");
        return Ok(faults);
    };
    let (study_id, own_seq, session_id, trial_index, _, _, _, hash, prev_hash) = values;
    let in_place =
        study_id == text(row, "study_id")? && own_seq == seq && session_id == text(row, "session_id")?;
    if !in_place || i64::from(trial_index) != row.try_get::<i64, _>("trial_index")? {
        faults.push("it stands in another row's place");
    }
    if adjoins && prev_hash != previous.1 {
        faults.push("it does not follow the row before");
    }
    match held {
        Held::Gone => faults.push("its answer is gone, and not by a withdrawal"),
        Held::Whole([nonce, answer, payload]) if answer_hash(nonce, answer, payload) != hash => {
            faults.push("its answer is not the one that came");
        }
        Held::Whole(_) | Held::Blanked => {}
    }
    Ok(faults)
}
