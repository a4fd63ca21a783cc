//! The chain of a study's answers, tampered with: every fault is named, and checking goes on behind it.

use crate::setting::{IDLE, Served, answer, append, begin, open, serve, stranger, tamper};
use kelir_store::{ChainReport, Fault, Session, Store, StoredAnswers, sha256_hex};
use std::path::Path;
use tempfile::TempDir;

pub(crate) const VALUES: &str = "its values are not those that were written";
pub(crate) const MISSING: &str = "rows before it are missing";
pub(crate) const FOLLOWS: &str = "it does not follow the row before";
const PLACE: &str = "it stands in another row's place";
const ANSWER: &str = "its answer is not the one that came";
const GONE: &str = "its answer is gone, and not by a withdrawal";
const NO_ROW: &str = "it is no row of answers";

/// Statements of somebody who tampers, and what is wrong afterwards, by row.
pub(crate) type Case = (&'static [&'static str], &'static [(i64, &'static str)]);

/// What is wrong, by row.
pub(crate) fn faults(report: &ChainReport, chain: u32) -> Vec<(i64, &str)> {
    report.faults.iter().filter(|f| f.chain == chain).map(|f| (f.seq, f.what.as_str())).collect()
}

/// Two sessions with three answers each: rows 1, 3, 5 and 2, 4, 6.
async fn six() -> (TempDir, Store, Served, Session) {
    let (folder, store, served) = open().await;
    let sessions = [begin(&store, &served, IDLE).await, begin(&store, &served, IDLE).await];
    for trial in 0..3 {
        for session in &sessions {
            append(&store, session, answer(trial, true, 100.0 + f64::from(trial))).await;
        }
    }
    let report = store.verify_chain(&served.study.id).await.unwrap();
    assert_eq!((report.rows, report.blanked, faults(&report, 2)), (6, 0, vec![]));
    let [first, _] = sessions;
    (folder, store, served, first)
}

const SWAP: &str = "CREATE TABLE swapped AS SELECT * FROM";

#[tokio::test(flavor = "multi_thread")]
async fn every_row_that_was_tampered_with_is_named() {
    let cases: [Case; 14] = [
        (&["UPDATE answers SET row = replace(row, ':\"pa\"', ':\"mc\"') WHERE seq = 2"], &[(2, VALUES)]),
        (&["UPDATE answers SET row = row || ' ' WHERE seq = 2"], &[(2, VALUES)]),
        (&["UPDATE answers SET row = '[1]' WHERE seq = 2"], &[(2, VALUES), (2, NO_ROW)]),
        (&["UPDATE answers SET row = CAST(x'ff' AS TEXT) WHERE seq = 2"], &[(2, VALUES), (2, NO_ROW)]),
        (
            &["UPDATE answers SET row_hash = lower(hex(zeroblob(32))) WHERE seq = 2"],
            &[(2, VALUES), (3, FOLLOWS)],
        ),
        (
            &["UPDATE answers SET row = json_set(row, '$[8]', lower(hex(zeroblob(32)))) WHERE seq = 2"],
            &[(2, VALUES), (2, FOLLOWS)],
        ),
        (&["DELETE FROM answers WHERE seq = 2"], &[(3, MISSING)]),
        (&["DELETE FROM answers WHERE seq = 1"], &[(2, MISSING)]),
        (
            &["DELETE FROM answers WHERE seq IN (2, 3)", "DELETE FROM answers WHERE seq = 5"],
            &[(4, MISSING), (6, MISSING)],
        ),
        (&["DELETE FROM answer_contents WHERE seq = 2"], &[(2, GONE)]),
        (&["UPDATE answer_contents SET payload = NULL WHERE seq = 2"], &[(2, ANSWER)]),
        (&["UPDATE answer_contents SET nonce = randomblob(16) WHERE seq = 2"], &[(2, ANSWER)]),
        (
            &[
                "UPDATE answers SET session_id = 'x' WHERE seq = 2",
                "UPDATE answers SET trial_index = 7 WHERE seq = 4",
            ],
            &[(2, PLACE), (4, PLACE)],
        ),
        // All at once: each fault is named, and a row can have several.
        (
            &[
                "DELETE FROM answers WHERE seq = 1",
                "UPDATE answers SET row = row || ' ' WHERE seq = 2",
                "UPDATE answer_contents SET payload = payload || ' ' WHERE seq IN (2, 4)",
                "UPDATE answers SET row_hash = lower(hex(zeroblob(32))) WHERE seq = 5",
                "DELETE FROM answer_contents WHERE seq = 6",
            ],
            &[(2, MISSING), (2, VALUES), (2, ANSWER), (4, ANSWER), (5, VALUES), (6, FOLLOWS), (6, GONE)],
        ),
    ];
    for (statements, expected) in cases {
        let (folder, store, served, _) = six().await;
        tamper(folder.path(), statements).await;
        let report = store.verify_chain(&served.study.id).await.unwrap();
        assert_eq!(faults(&report, 2), expected, "{statements:?}");
        assert_eq!(report.blanked, 0, "{statements:?}");
        assert_eq!(report.unexplained().count(), expected.len());
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn rows_and_answers_that_were_swapped_are_named() {
    let (folder, store, served, _) = six().await;
    let swap = format!("{SWAP} answer_contents");
    tamper(folder.path(), &[]).await;
    sqlx::query(sqlx::AssertSqlSafe(swap)).execute(&mut stranger(folder.path()).await).await.unwrap();
    let of =
        |column| format!("{column} = (SELECT {column} FROM swapped s WHERE s.seq = 5 - answer_contents.seq)");
    let set = format!(
        "UPDATE answer_contents SET {}, {}, {} WHERE seq IN (2, 3)",
        of("nonce"),
        of("answer"),
        of("payload")
    );
    tamper(folder.path(), &[&set]).await;
    let report = store.verify_chain(&served.study.id).await.unwrap();
    assert_eq!(faults(&report, 2), [(2, ANSWER), (3, ANSWER)]);

    let (folder, store, served, _) = six().await;
    // Rows 2 and 4, of the same session, with their answers: only their numbers are another's.
    let number =
        |table: &str, from: i64, to: i64| format!("UPDATE {table} SET seq = {to} WHERE seq = {from}");
    let moves = [(2, 100), (4, 2), (100, 4)]
        .map(|(from, to)| ["answers", "answer_contents"].map(|t| number(t, from, to)));
    let moves: Vec<&str> = moves.iter().flatten().map(String::as_str).collect();
    tamper(folder.path(), &moves).await;
    let report = store.verify_chain(&served.study.id).await.unwrap();
    let each = [(2, PLACE), (2, FOLLOWS), (3, FOLLOWS), (4, PLACE), (4, FOLLOWS), (5, FOLLOWS)];
    assert_eq!(faults(&report, 2), each);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_forger_who_hashes_anew_is_given_away_by_the_next_row() {
    let (folder, store, served, _) = six().await;
    let mut stranger = stranger(folder.path()).await;
    let row: String =
        sqlx::query_scalar("SELECT row FROM answers WHERE seq = 3").fetch_one(&mut stranger).await.unwrap();
    let forged = row.replace("\"pa\"", "\"mc\"");
    assert_ne!(forged, row);
    let set = format!(
        "UPDATE answers SET row = '{forged}', row_hash = '{}' WHERE seq = 3",
        sha256_hex(forged.as_bytes())
    );
    tamper(folder.path(), &[&set]).await;
    let report = store.verify_chain(&served.study.id).await.unwrap();
    assert_eq!(faults(&report, 2), [(4, FOLLOWS)]);
    // Nobody can tell of the last row, but whoever noted the head.
    let (folder, store, served, _) = six().await;
    let head = store.verify_chain(&served.study.id).await.unwrap().head;
    tamper(folder.path(), &["DELETE FROM answers WHERE seq = 6"]).await;
    let report = store.verify_chain(&served.study.id).await.unwrap();
    assert_eq!((report.rows, faults(&report, 2)), (5, vec![]));
    assert_ne!(report.head, head);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_row_of_another_study_is_named_in_both() {
    let (folder, store, served, _) = six().await;
    let mut other = served.study.clone();
    other.id = "other".to_owned();
    let other = serve(&store, other, 50).await;
    let session = begin(&store, &other, IDLE).await;
    append(&store, &session, answer(0, true, 1.0)).await;
    assert_eq!(store.verify_chain("other").await.unwrap().faults, []);
    let moved = ["answers", "answer_contents"]
        .map(|t| format!("UPDATE {t} SET study_id = 'other' WHERE study_id = 'small' AND seq = 2"));
    tamper(folder.path(), &[&moved[0], &moved[1]]).await;
    assert_eq!(faults(&store.verify_chain("small").await.unwrap(), 2), [(3, MISSING)]);
    assert_eq!(faults(&store.verify_chain("other").await.unwrap(), 2), [(2, PLACE), (2, FOLLOWS)]);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_withdrawal_blanks_an_answer_without_breaking_the_chain() {
    let (folder, store, served, session) = six().await;
    let head = store.verify_chain(&served.study.id).await.unwrap().head;
    let blank = "UPDATE answer_contents SET nonce = NULL, answer = NULL, payload = NULL WHERE seq IN (2, 6)";
    let mut stranger = stranger(folder.path()).await;
    assert_eq!(sqlx::query(blank).execute(&mut stranger).await.unwrap().rows_affected(), 2);
    append(&store, &session, answer(0, true, 100.0)).await;
    let report = store.verify_chain(&served.study.id).await.unwrap();
    assert_eq!((report.rows, report.blanked, report.faults), (6, 2, vec![]));
    assert_eq!(report.head, head);
    let rows = store.answer_rows("small", std::slice::from_ref(&served.version)).await.unwrap();
    let blanked: Vec<i64> =
        rows.iter().filter(|r| r.answer.is_none() && r.payload.is_none()).map(|r| r.seq).collect();
    assert_eq!((rows.len(), blanked), (6, vec![2, 6]));
    assert_eq!(read(&store, &served).await, 4);
}

/// How many answers analyses read.
async fn read(store: &Store, served: &Served) -> usize {
    let mut stored = StoredAnswers::new(&served.study, std::slice::from_ref(&served.version));
    store.read_on(&mut stored).await.unwrap();
    stored.answers().len()
}

#[tokio::test(flavor = "multi_thread")]
async fn analyses_pass_over_rows_that_say_nothing() {
    let (folder, store, served, _) = six().await;
    assert_eq!(read(&store, &served).await, 6);
    let said_nothing: [(&str, &[&str]); 5] = [
        ("no text", &["UPDATE answers SET row = CAST(x'5bff' AS TEXT) WHERE seq = 1"]),
        ("no row", &["UPDATE answers SET row = '{}' WHERE seq = 2"]),
        ("no kind", &["UPDATE answers SET row = replace(row, 'two-alternative', 'two-fold') WHERE seq = 3"]),
        ("no answer", &["DELETE FROM answer_contents WHERE seq = 4"]),
        ("no place", &["UPDATE answers SET trial_index = 5000000000 WHERE seq = 5"]),
    ];
    for (left, (what, statements)) in (0..5).rev().zip(said_nothing) {
        tamper(folder.path(), statements).await;
        assert_eq!(read(&store, &served).await, left + 1, "{what}");
    }
    tamper(folder.path(), &["UPDATE answer_contents SET answer = CAST(x'ff' AS TEXT) WHERE seq = 6"]).await;
    assert_eq!(read(&store, &served).await, 0);
}

#[tokio::test(flavor = "multi_thread")]
async fn the_last_note_explains_a_row_and_notes_are_the_studys_own() {
    let (folder, store, served, _) = six().await;
    tamper(folder.path(), &["UPDATE answers SET row = row || ' ' WHERE seq IN (2, 4)"]).await;
    store.note_on_chain("small", 2, 2, "the first note", "ana").await.unwrap();
    store.note_on_chain("small", 2, 2, "the second note", "budi").await.unwrap();
    store.note_on_chain("another", 2, 4, "of another study", "ana").await.unwrap();
    store.note_on_chain("small", 1, 4, "of another chain", "ana").await.unwrap();
    let report = store.verify_chain(&served.study.id).await.unwrap();
    let fault = |seq, note: Option<&str>| Fault {
        chain: 2,
        seq,
        what: VALUES.to_owned(),
        note: note.map(str::to_owned),
    };
    assert_eq!(report.faults, [fault(2, Some("the second note")), fault(4, None)]);
    assert_eq!(report.unexplained().collect::<Vec<_>>(), [&fault(4, None)]);
    for (chain, note, author) in [(2, "", "ana"), (2, "a note", ""), (3, "a note", "ana")] {
        assert!(
            store.note_on_chain("small", chain, 4, note, author).await.is_err(),
            "{chain} {note:?} {author:?}"
        );
    }
    assert_eq!(notes(folder.path()).await, 4);
}

async fn notes(folder: &Path) -> i64 {
    sqlx::query_scalar("SELECT count(*) FROM chain_notes")
        .fetch_one(&mut stranger(folder).await)
        .await
        .unwrap()
}
