//! Chain version 1, as the program of 944eaa2 wrote it: verified by its own rule, and the beginning of version 2.

use crate::chain::{Case, FOLLOWS, MISSING, VALUES, faults};
use crate::setting::{answer, append, fixture, half, stranger, tamper};
use kelir_store::{Appended, GENESIS, NewAnswer, Store, StoredAnswers};
use std::path::Path;

const PAYLOAD: &str = "its payload is not the one that came";
const GONE: &str = "its payload is gone, and not by a withdrawal";

async fn head_of_the_first(folder: &Path) -> String {
    let query = "SELECT row_hash FROM responses ORDER BY response_id DESC LIMIT 1";
    sqlx::query_scalar(query).fetch_one(&mut stranger(folder).await).await.unwrap()
}

#[tokio::test(flavor = "multi_thread")]
async fn every_row_that_was_tampered_with_is_named() {
    let cases: [Case; 13] = [
        (&["UPDATE responses SET rt_ms = 1 WHERE response_id = 2"], &[(2, VALUES)]),
        (
            &[
                "UPDATE responses SET choice = 'right', chosen_condition = right_condition WHERE choice = 'left' AND response_id = 1",
            ],
            &[(1, VALUES)],
        ),
        (&["UPDATE responses SET pair_id = CAST(x'ff' AS TEXT) WHERE response_id = 34"], &[(34, VALUES)]),
        // A study's own: the session says whose a row is.
        (&["UPDATE responses SET session_id = 'of another study' WHERE response_id = 2"], &[(2, VALUES)]),
        (
            &["UPDATE responses SET row_hash = prev_hash || 'x' WHERE response_id = 2"],
            &[(2, VALUES), (3, FOLLOWS)],
        ),
        (&["UPDATE responses SET prev_hash = row_hash WHERE response_id = 2"], &[(2, FOLLOWS), (2, VALUES)]),
        (&["DELETE FROM responses WHERE response_id = 1"], &[(2, MISSING)]),
        (&["DELETE FROM responses WHERE response_id IN (7, 8)"], &[(9, MISSING)]),
        (&["UPDATE response_payloads SET payload = '{\"trial\":9}' WHERE response_id = 2"], &[(2, PAYLOAD)]),
        (
            &["UPDATE response_payloads SET payload = CAST(x'ff' AS TEXT) WHERE response_id = 2"],
            &[(2, PAYLOAD)],
        ),
        (&["DELETE FROM response_payloads WHERE response_id = 2"], &[(2, GONE)]),
        (
            &[
                "UPDATE responses SET response_id = 100 WHERE response_id = 2",
                "UPDATE responses SET response_id = 2 WHERE response_id = 3",
                "UPDATE responses SET response_id = 3 WHERE response_id = 100",
            ],
            // The numbers are hashed, and the payloads stay where they were.
            &[(2, FOLLOWS), (2, VALUES), (2, PAYLOAD), (3, FOLLOWS), (3, VALUES), (3, PAYLOAD), (4, FOLLOWS)],
        ),
        (
            &[
                "UPDATE responses SET rt_ms = 1 WHERE response_id = 2",
                "UPDATE response_payloads SET payload = '{}' WHERE response_id IN (2, 20)",
                "DELETE FROM responses WHERE response_id = 33",
            ],
            &[(2, VALUES), (2, PAYLOAD), (20, PAYLOAD), (34, MISSING)],
        ),
    ];
    for (statements, expected) in cases {
        let folder = fixture("answered");
        let store = Store::open(folder.path()).await.unwrap();
        tamper(folder.path(), statements).await;
        let report = store.verify_chain("small").await.unwrap();
        assert_eq!(faults(&report, 1), expected, "{statements:?}");
        assert_eq!((report.blanked, faults(&report, 2)), (0, vec![]), "{statements:?}");
        assert_eq!(store.verify_chain("another study").await.unwrap(), report, "one chain for all");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_withdrawal_blanks_a_payload_and_notes_are_for_every_study() {
    let folder = fixture("answered");
    let store = Store::open(folder.path()).await.unwrap();
    let blank = "UPDATE response_payloads SET payload = NULL WHERE response_id IN (1, 2)";
    sqlx::query(blank).execute(&mut stranger(folder.path()).await).await.unwrap();
    let report = store.verify_chain("small").await.unwrap();
    assert_eq!((report.rows, report.blanked, report.faults), (34, 2, vec![]));
    tamper(folder.path(), &["UPDATE responses SET rt_ms = 1 WHERE response_id IN (5, 6)"]).await;
    store.note_on_chain("small", 1, 5, "edited by hand", "ana").await.unwrap();
    for study in ["small", "another study"] {
        let report = store.verify_chain(study).await.unwrap();
        assert_eq!(report.faults[0].note.as_deref(), Some("edited by hand"));
        assert_eq!(report.unexplained().map(|fault| fault.seq).collect::<Vec<_>>(), [6]);
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_half_finished_session_goes_on_in_the_second_chain() {
    let folder = fixture("answered");
    let store = Store::open(folder.path()).await.unwrap();
    let session = half(&store).await;
    assert_eq!(store.trials(&session.session_id).await.unwrap().len(), 4);
    assert_eq!(store.answered(&session.session_id).await.unwrap(), [0, 1]);
    let before = store.verify_chain("small").await.unwrap();
    assert_eq!((before.rows, before.head.clone()), (34, head_of_the_first(folder.path()).await));
    assert_eq!(append(&store, &session, answer(2, true, 500.0)).await, Appended::Stored);
    let mut stranger = stranger(folder.path()).await;
    let row: (i64, String, String) =
        sqlx::query_as("SELECT seq, json_extract(row, '$[8]'), row_hash FROM answers")
            .fetch_one(&mut stranger)
            .await
            .unwrap();
    let report = store.verify_chain("small").await.unwrap();
    assert_eq!((report.rows, report.faults), (35, vec![]));
    assert_eq!(row, (1, before.head.clone(), report.head));
    assert_ne!(before.head, GENESIS);
    // A study that begins later begins there too; a changed end of the first chain is seen from the second.
    assert_eq!(store.verify_chain("another study").await.unwrap().head, before.head);
    tamper(folder.path(), &["DELETE FROM responses WHERE response_id = 34"]).await;
    assert_eq!(faults(&store.verify_chain("small").await.unwrap(), 2), [(1, FOLLOWS)]);
}

#[tokio::test(flavor = "multi_thread")]
async fn what_was_sent_to_the_first_chain_is_known_again() {
    let folder = fixture("answered");
    let store = Store::open(folder.path()).await.unwrap();
    let session = half(&store).await;
    let payload: String = sqlx::query_scalar(
        "SELECT payload FROM responses JOIN response_payloads USING (response_id) WHERE session_id = $1 AND trial_index = 0",
    )
    .bind(&session.session_id)
    .fetch_one(&mut stranger(folder.path()).await)
    .await
    .unwrap();
    let sent: serde_json::Value = serde_json::from_str(&payload).unwrap();
    let again = |payload: String| NewAnswer { payload, ..answer(0, true, 1.0) };
    // Its own writer's JSON is all that version 1 kept: other spaces are the same.
    for same in [payload.clone(), serde_json::to_string_pretty(&sent).unwrap()] {
        assert_eq!(append(&store, &session, again(same)).await, Appended::Same);
    }
    let other = payload.replace("mouse", "touch");
    assert_ne!(other, payload);
    let Appended::Different(stored) = append(&store, &session, again(other)).await else { panic!() };
    assert_eq!(stored.payload, Some(sent.clone()));
    let expected = serde_json::json!({ "choice": sent["choice"], "rt_ms": sent["rt"] });
    assert_eq!(stored.answer, Some(expected));
    assert_eq!(store.verify_chain("small").await.unwrap().rows, 34, "nothing was added");
}

#[tokio::test(flavor = "multi_thread")]
async fn analyses_read_both_chains_as_one() {
    let folder = fixture("answered");
    let store = Store::open(folder.path()).await.unwrap();
    let session = half(&store).await;
    let study = store.study_file("small", &session.file_hash).await.unwrap().unwrap();
    let mut stored = StoredAnswers::new(&study, std::slice::from_ref(&session.version));
    store.read_on(&mut stored).await.unwrap();
    assert_eq!(stored.answers().len(), 34);
    append(&store, &session, answer(2, true, 500.0)).await;
    store.read_on(&mut stored).await.unwrap();
    let answers = stored.answers();
    assert_eq!((answers.len(), answers.participants().len()), (35, 9));
    let own = answers.participants().into_iter().find(|p| *p.session_id == *session.session_id).unwrap();
    assert_eq!(own.answers().iter().map(|given| given.trial_index).collect::<Vec<_>>().len(), 3);
    let rows = store.answer_rows("small", std::slice::from_ref(&session.version)).await.unwrap();
    let chains: Vec<(u32, i64)> = rows.iter().map(|row| (row.chain, row.seq)).collect();
    assert_eq!(chains, (1..=34).map(|seq| (1, seq)).chain([(2, 1)]).collect::<Vec<_>>());
    let times = store.answer_times("small", std::slice::from_ref(&session.version)).await.unwrap();
    assert_eq!(times, Some((rows[0].received_at.clone(), rows[34].received_at.clone())));
    // A text that is none hides its own row alone.
    tamper(folder.path(), &["UPDATE responses SET pair_id = CAST(x'ff' AS TEXT) WHERE response_id = 2"])
        .await;
    let mut stored = StoredAnswers::new(&study, &[session.version]);
    store.read_on(&mut stored).await.unwrap();
    assert_eq!(stored.answers().len(), 34);
}
