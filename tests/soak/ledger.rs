//! What people were told, and whether the database says the same.

use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::process::Command;

/// The hash before a chain's first row.
const GENESIS: &str = "0000000000000000000000000000000000000000000000000000000000000000";
/// Rows that are read in one go.
const PAGE: usize = 20_000;
/// Faults of one kind that are named.
const MOST_NAMED: usize = 3;

/// Everything that was acknowledged.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    /// Sessions that somebody was told of.
    pub sessions: Vec<String>,
    /// Answers: session, trial, the bytes that were sent.
    pub answers: Vec<(String, u32, String)>,
    /// Codes by session.
    pub codes: Vec<(String, String)>,
}

/// A row of the table of answers, with what lies beside it.
#[derive(Clone, Debug, Default)]
pub struct Row {
    seq: i64,
    session: String,
    trial: u32,
    row: String,
    row_hash: String,
    nonce: Vec<u8>,
    answer: String,
    payload: String,
}

/// What the database holds, read by a program that is not ours.
#[derive(Clone, Debug, Default)]
pub struct Stored {
    /// The chain of the study `small`.
    pub rows: Vec<Row>,
    /// Codes by session, of those that have none too.
    pub codes: HashMap<String, Option<String>>,
    /// What SQLite finds wrong with its file.
    pub damage: Vec<String>,
}

impl Stored {
    /// Reads a database.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn read(database: &Path) -> Result<Stored, String> {
        let mut stored = Stored::default();
        let text = |row: &Value, column: &str| row[column].as_str().unwrap_or_default().to_owned();
        for check in ["integrity_check", "foreign_key_check"] {
            let found = rows(database, &format!("PRAGMA {check}"))?;
            let found = found.iter().filter(|row| row[check] != "ok");
            stored.damage.extend(found.map(|row| format!("{check}: {row}")));
        }
        for row in rows(database, "SELECT session_id, completion_code FROM sessions")? {
            let code = row["completion_code"].as_str().map(str::to_owned);
            stored.codes.insert(text(&row, "session_id"), code);
        }
        loop {
            let after = stored.rows.last().map_or(0, |row| row.seq);
            let page = format!(
                "SELECT a.seq, session_id, trial_index, row, row_hash, hex(nonce) AS nonce, answer, payload
                 FROM answers a LEFT JOIN answer_contents USING (study_id, seq)
                 WHERE study_id = 'small' AND a.seq > {after} ORDER BY a.seq LIMIT {PAGE}"
            );
            let page = rows(database, &page)?;
            if page.is_empty() {
                return Ok(stored);
            }
            stored.rows.extend(page.iter().map(|row| Row {
                seq: row["seq"].as_i64().unwrap_or_default(),
                session: text(row, "session_id"),
                trial: row["trial_index"].as_u64().unwrap_or_default() as u32,
                row: text(row, "row"),
                row_hash: text(row, "row_hash"),
                nonce: hex::decode(text(row, "nonce")).unwrap_or_default(),
                answer: text(row, "answer"),
                payload: text(row, "payload"),
            }));
        }
    }

    /// Everything that is wrong with it, and everything that people were told and it does not hold.
    pub fn faults(&self, ledger: &Ledger) -> Vec<String> {
        let mut wrong = Wrong::default();
        for damage in &self.damage {
            wrong.note("damage", damage.clone());
        }
        self.chain(&mut wrong);
        let mut held: HashMap<(&str, u32), &str> = HashMap::new();
        for row in &self.rows {
            if held.insert((&row.session, row.trial), &row.payload).is_some() {
                wrong.note("answers stored twice", format!("{} {}", row.session, row.trial));
            }
        }
        for (session, trial, sent) in &ledger.answers {
            match held.get(&(session.as_str(), *trial)) {
                None => wrong.note("acknowledged answers lost", format!("{session} {trial}")),
                Some(stored) if stored != sent => {
                    wrong.note("acknowledged answers changed", format!("{session} {trial}: {stored}"));
                }
                Some(_) => {}
            }
        }
        for session in ledger.sessions.iter().filter(|session| !self.codes.contains_key(*session)) {
            wrong.note("sessions lost", session.clone());
        }
        for (session, code) in &ledger.codes {
            if self.codes.get(session).and_then(Option::as_ref) != Some(code) {
                wrong.note("codes lost or changed", format!("{session} {code}"));
            }
        }
        wrong.told()
    }

    /// The chain, computed again from its definition: no row missing, each the hash of its text, its contents and the row before.
    fn chain(&self, wrong: &mut Wrong) {
        let mut before = (0, GENESIS);
        for row in &self.rows {
            let fault = |what: &str| format!("row {}: {what}", row.seq);
            if row.seq != before.0 + 1 {
                wrong.note("chain", fault("does not follow the one before"));
            }
            if sha256(&[row.row.as_bytes()]) != row.row_hash {
                wrong.note("chain", fault("has another hash"));
            }
            let values: Value = serde_json::from_str(&row.row).unwrap_or_default();
            if values[1] != row.seq || values[2] != row.session || values[3] != row.trial {
                wrong.note("chain", fault("stands in another's place"));
            }
            if values[7] != sha256(&[&row.nonce, row.answer.as_bytes(), b"\n", row.payload.as_bytes()]) {
                wrong.note("chain", fault("holds another answer"));
            }
            if values[8] != before.1 {
                wrong.note("chain", fault("names another row before it"));
            }
            before = (row.seq, &row.row_hash);
        }
    }
}

/// Faults by kind: thousands of one are one line.
#[derive(Default)]
struct Wrong(BTreeMap<&'static str, Vec<String>>);

impl Wrong {
    fn note(&mut self, kind: &'static str, what: String) {
        self.0.entry(kind).or_default().push(what);
    }

    fn told(self) -> Vec<String> {
        let line = |(kind, what): (&str, Vec<String>)| {
            let named = what[..what.len().min(MOST_NAMED)].join("; ");
            format!("{kind}: {} ({named})", what.len())
        };
        self.0.into_iter().map(line).collect()
    }
}

/// Rows of a query, by the sqlite3 shell; a lock is waited for.
///
/// # Errors
/// What the shell says.
pub fn rows(database: &Path, query: &str) -> Result<Vec<Value>, String> {
    let mut shell = Command::new("sqlite3");
    let out = shell.args(["-json", "-cmd", ".timeout 10000"]).arg(database).arg(query).output();
    let out = out.map_err(|error| format!("sqlite3: {error}"))?;
    if !out.status.success() {
        return Err(format!("sqlite3: {}", String::from_utf8_lossy(&out.stderr).trim()));
    }
    match out.stdout.trim_ascii() {
        [] => Ok(Vec::new()),
        json => serde_json::from_slice(json).map_err(|error| format!("sqlite3: {error}")),
    }
}

fn sha256(parts: &[&[u8]]) -> String {
    let hasher = parts.iter().fold(Sha256::new(), |hasher, part| hasher.chain_update(part));
    hex::encode(hasher.finalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// A chain of three answers, as its definition has it, and what their people were told.
    fn whole() -> (Stored, Ledger) {
        let (mut stored, mut ledger) = (Stored::default(), Ledger::default());
        let mut before = GENESIS.to_owned();
        for seq in 1..=3 {
            let (session, trial, nonce) = (format!("s{}", seq / 2), seq as u32 % 2, vec![seq as u8; 16]);
            let (answer, payload) = (r#"{"choice":"left"}"#.to_owned(), format!(r#"{{"rt":{seq}}}"#));
            let hash = sha256(&[&nonce, answer.as_bytes(), b"\n", payload.as_bytes()]);
            let row = json!(["small", seq, session, trial, "k", {}, "t", hash, before]).to_string();
            before = sha256(&[row.as_bytes()]);
            stored.codes.insert(session.clone(), Some(format!("C{session}")));
            ledger.sessions.push(session.clone());
            ledger.codes.push((session.clone(), format!("C{session}")));
            ledger.answers.push((session.clone(), trial, payload.clone()));
            stored.rows.push(Row {
                seq,
                session,
                trial,
                row,
                row_hash: before.clone(),
                nonce,
                answer,
                payload,
            });
        }
        (stored, ledger)
    }

    #[test]
    fn each_fault_is_found_and_what_is_whole_has_none() {
        let (stored, ledger) = whole();
        assert_eq!(stored.faults(&ledger), [""; 0]);
        type Break = fn(&mut Stored, &mut Ledger);
        let breaks: [(&str, Break); 12] = [
            ("acknowledged answers lost: 1", |stored, _| drop(stored.rows.pop())),
            ("acknowledged answers lost: 1", |_, ledger| ledger.answers.push(("s9".into(), 0, "{}".into()))),
            ("acknowledged answers changed: 1", |_, ledger| ledger.answers[1].2.push(' ')),
            ("answers stored twice: 1", |stored, _| stored.rows.push(stored.rows[0].clone())),
            ("sessions lost: 1", |_, ledger| ledger.sessions.push("s9".into())),
            ("codes lost or changed", |_, ledger| ledger.codes[0].1.push('x')),
            ("row 3: does not follow the one before", |stored, _| drop(stored.rows.remove(1))),
            ("has another hash", |stored, _| stored.rows[1].row_hash.replace_range(..1, "x")),
            ("holds another answer", |stored, _| stored.rows[1].answer.push(' ')),
            ("holds another answer", |stored, _| stored.rows[1].nonce[0] ^= 1),
            ("stands in another's place", |stored, _| stored.rows[1].trial ^= 1),
            ("damage: 1", |stored, _| stored.damage.push("page 7".into())),
        ];
        for (expected, breaks) in breaks {
            let (mut stored, mut ledger) = whole();
            breaks(&mut stored, &mut ledger);
            let faults = stored.faults(&ledger).join("\n");
            assert!(faults.contains(expected), "{expected}: {faults}");
        }
    }
}
