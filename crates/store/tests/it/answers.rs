//! Answers: the first one stands, whoever races whom.

use crate::setting::{IDLE, answer, append, begin, fixture, half, open, stranger};
use kelir_store::{Appended, Completed, Store, StoreError, StoredAnswers};
use kelir_study::trials::Role;
use serde_json::json;

#[tokio::test(flavor = "multi_thread")]
async fn the_first_answer_stands_and_the_code_waits_for_the_last() {
    let (_folder, store, served) = open().await;
    let session = begin(&store, &served, IDLE).await;
    assert_eq!(store.complete(&session, "CODE").await.unwrap(), Completed::Missing(vec![0, 1, 2]));
    assert_eq!(append(&store, &session, answer(1, true, 500.0)).await, Appended::Stored);
    assert_eq!(append(&store, &session, answer(1, true, 500.0)).await, Appended::Same);
    for other in [answer(1, true, 501.0), answer(1, false, 500.0)] {
        let Appended::Different(stored) = append(&store, &session, other).await else { panic!() };
        assert_eq!(stored.answer, Some(json!({ "choice": "left", "rt_ms": 500 })));
        assert_eq!(stored.payload.unwrap()["rt"], 500.0);
    }
    assert_eq!(append(&store, &session, answer(3, true, 500.0)).await, Appended::NoSuchTrial);
    assert_eq!(store.complete(&session, "CODE").await.unwrap(), Completed::Missing(vec![0, 2]));
    for trial in [0, 2] {
        append(&store, &session, answer(trial, false, 400.0)).await;
    }
    assert_eq!(store.complete(&session, "FIRST").await.unwrap(), Completed::Code("FIRST".to_owned()));
    assert_eq!(store.complete(&session, "SECOND").await.unwrap(), Completed::Code("FIRST".to_owned()));
    let rows = store.answer_rows(&session.study_id, std::slice::from_ref(&session.version)).await.unwrap();
    let row = &rows[0];
    assert_eq!((row.chain, row.seq, row.trial_index, row.trial_kind.as_str()), (2, 1, 1, "two-alternative"));
    assert_eq!(row.answer.as_deref(), Some(r#"{"choice":"left","rt_ms":500}"#));
    assert_eq!(row.payload, Some(answer(1, true, 500.0).payload));
    let planned = &store.trials(&session.session_id).await.unwrap()[1];
    assert_eq!(row.shown, planned.shown(None).unwrap());
    let left = &row.shown[&Role::Left];
    let shown = served.stimuli.iter().find(|s| (&s.item, &s.condition) == (&left.item, &left.condition));
    assert_eq!(left.pixels_sha256, shown.unwrap().pixels_sha256);
    let counts = store.version_counts(&session.study_id, IDLE).await.unwrap()[&session.version];
    let people = counts.participants;
    assert_eq!((people.started, people.in_progress, people.completed, counts.answers), (1, 0, 1, 3));
}

#[tokio::test(flavor = "multi_thread")]
async fn the_next_trial_is_the_lowest_without_an_answer_in_whatever_order_they_come() {
    let (_folder, store, served) = open().await;
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let session = begin(&store, &served, IDLE).await;
        let mut open = vec![0, 1, 2];
        for trial in order {
            assert_eq!(store.next_trial(&session.session_id).await.unwrap(), open.first().copied());
            append(&store, &session, answer(trial, true, 500.0)).await;
            open.retain(|other| *other != trial);
        }
        assert_eq!(store.next_trial(&session.session_id).await.unwrap(), None);
    }
    // One whose first answers are in the first chain.
    let folder = fixture("answered");
    let store = Store::open(folder.path()).await.unwrap();
    let session = half(&store).await;
    let mut answered = store.answered(&session.session_id).await.unwrap();
    let trials = store.trials(&session.session_id).await.unwrap();
    let open =
        |answered: &[u32]| trials.iter().map(|t| t.trial.trial_index).find(|index| !answered.contains(index));
    assert_eq!(store.next_trial(&session.session_id).await.unwrap(), open(&answered));
    let first = open(&answered).unwrap();
    assert!(first > 0, "it is half finished");
    append(&store, &session, answer(first, true, 500.0)).await;
    answered.push(first);
    assert_eq!(store.next_trial(&session.session_id).await.unwrap(), open(&answered));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_resend_is_the_same_only_when_its_bytes_are() {
    let (folder, store, served) = open().await;
    let session = begin(&store, &served, IDLE).await;
    let mut sent = answer(0, true, 500.0);
    append(&store, &session, sent.clone()).await;
    // The same value in other bytes.
    sent.payload += " ";
    let Appended::Different(stored) = append(&store, &session, sent).await else { panic!() };
    let mut stranger = stranger(folder.path()).await;
    let row: (String, String) = sqlx::query_as(
        "SELECT json_extract(row, '$[6]'), payload FROM answers JOIN answer_contents USING (seq)",
    )
    .fetch_one(&mut stranger)
    .await
    .unwrap();
    assert_eq!(stored.received_at, row.0);
    assert_eq!(stored.payload.unwrap(), serde_json::from_str::<serde_json::Value>(&row.1).unwrap());
    // Once withdrawn, nothing is the same: what is stored is nothing.
    let withdrawal = "UPDATE answer_contents SET nonce = NULL, answer = NULL, payload = NULL";
    sqlx::query(withdrawal).execute(&mut stranger).await.unwrap();
    let Appended::Different(stored) = append(&store, &session, answer(0, true, 500.0)).await else {
        panic!()
    };
    assert_eq!((stored.answer, stored.payload), (None, None));
    assert_eq!(store.answered(&session.session_id).await.unwrap(), [0], "and its place is taken");
}

#[tokio::test(flavor = "multi_thread")]
async fn racing_writers_leave_one_row_a_trial_and_an_unbroken_chain() {
    let (_folder, store, served) = open().await;
    let session = begin(&store, &served, IDLE).await;
    let mut racers = Vec::new();
    for racer in 0..60u32 {
        let (store, session) = (store.clone(), session.clone());
        racers.push(tokio::spawn(async move {
            append(&store, &session, answer(racer % 3, racer % 2 == 0, f64::from(racer))).await
        }));
    }
    let mut stored = 0;
    for racer in racers {
        stored += usize::from(racer.await.unwrap() == Appended::Stored);
    }
    assert_eq!(stored, 3);
    assert_eq!(store.answered(&session.session_id).await.unwrap(), [0, 1, 2]);
    let report = store.verify_chain(&session.study_id).await.unwrap();
    assert_eq!((report.rows, report.faults), (3, vec![]));
}

#[tokio::test(flavor = "multi_thread")]
async fn what_is_stored_survives_closing_and_opening() {
    let (folder, store, served) = open().await;
    let session = begin(&store, &served, IDLE).await;
    for text in ["hash of the text", "hash of another"] {
        let moved = |_| -> Result<_, StoreError> { panic!("nobody else has its slot") };
        store.consent(&session, text, IDLE, moved).await.unwrap();
    }
    append(&store, &session, answer(0, true, 100.0)).await;
    let trials = store.trials(&session.session_id).await.unwrap();
    store.close().await;
    let store = Store::open(folder.path()).await.unwrap();
    let back = store.session(&session.session_id).await.unwrap().unwrap();
    assert_eq!(store.trials(&back.session_id).await.unwrap(), trials);
    assert_eq!(trials, served.plan(0).next.trials);
    assert_eq!((back.slot, back.version.as_str()), (0, served.version.as_str()));
    assert_eq!(
        (back.consented_at.is_some(), back.consent_sha256.as_deref()),
        (true, Some("hash of the text"))
    );
    append(&store, &back, answer(1, true, 100.0)).await;
    assert_eq!(store.verify_chain(&back.study_id).await.unwrap().rows, 2);
    let versions = store.study_versions(&back.study_id).await.unwrap();
    assert_eq!(versions[0].study.file_hash(), back.file_hash);
    let mut stranger = stranger(folder.path()).await;
    let ends: (String, String) =
        sqlx::query_as("SELECT min(json_extract(row, '$[6]')), max(json_extract(row, '$[6]')) FROM answers")
            .fetch_one(&mut stranger)
            .await
            .unwrap();
    let times = store.answer_times(&back.study_id, std::slice::from_ref(&back.version)).await.unwrap();
    assert_eq!(times, Some(ends));
    assert_eq!(store.answer_times(&back.study_id, &["another".to_owned()]).await.unwrap(), None);
}

#[tokio::test(flavor = "multi_thread")]
async fn reading_on_adds_what_has_come_since_and_nothing_twice() {
    let (_folder, store, served) = open().await;
    let session = begin(&store, &served, IDLE).await;
    let trials = store.trials(&session.session_id).await.unwrap();
    let versions = [session.version.clone()];
    let mut stored = StoredAnswers::new(&served.study, &versions);
    store.read_on(&mut stored).await.unwrap();
    assert!(stored.answers().is_empty());
    for (trial, answers) in [(2, 1), (0, 2), (1, 3)] {
        append(&store, &session, answer(trial, trial == 0, 7.5)).await;
        store.read_on(&mut stored).await.unwrap();
        store.read_on(&mut stored).await.unwrap();
        assert_eq!(stored.answers().len(), answers);
    }
    let answers = stored.answers();
    let [participant] = answers.participants()[..] else { panic!("one took part") };
    assert_eq!(*participant.session_id, *session.session_id);
    for given in participant.answers() {
        let planned = trials.iter().find(|t| t.trial.item_index == given.item).unwrap();
        let chose_left = planned.trial.trial_index == 0;
        assert_eq!((given.chose_first, given.rt_ms), (chose_left, 7.5));
        assert_eq!(given.chose_target, planned.trial.is_first("pa") == chose_left);
    }
    let mut whole = StoredAnswers::new(&served.study, &versions);
    store.read_on(&mut whole).await.unwrap();
    assert_eq!(whole.answers().participants(), answers.participants());
    let mut other = StoredAnswers::new(&served.study, &["another".to_owned()]);
    store.read_on(&mut other).await.unwrap();
    assert!(other.answers().is_empty());
}
