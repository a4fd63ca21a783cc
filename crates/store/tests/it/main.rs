//! What any database behind the store must keep: append-only answers, one order, nothing acknowledged is lost.
#![allow(clippy::unwrap_used)]

mod killed;
mod migrating;
mod setting;

use kelir_store::{Appended, Completed, Store, StoreError, StoredAnswers};
use setting::{answer, begin, open};
use sqlx::sqlite::{SqliteConnectOptions, SqlitePool};
use std::path::Path;
use std::time::Duration;

/// A connection of someone who is not the store.
async fn stranger(folder: &Path) -> SqlitePool {
    SqlitePool::connect_with(SqliteConnectOptions::new().filename(folder.join("kelir.sqlite"))).await.unwrap()
}

#[tokio::test(flavor = "multi_thread")]
async fn the_first_answer_stands_and_the_code_waits_for_the_last() {
    let (_folder, store) = open().await;
    let session = begin(&store, Duration::from_secs(60)).await;
    assert_eq!(store.complete(&session, "CODE").await.unwrap(), Completed::Missing(vec![0, 1, 2]));
    assert_eq!(store.append_response(&session, answer(1, true, 500.0)).await.unwrap(), Appended::Stored);
    assert_eq!(store.append_response(&session, answer(1, true, 500.0)).await.unwrap(), Appended::Same);
    assert_eq!(store.append_response(&session, answer(1, true, 501.0)).await.unwrap(), Appended::Different);
    assert_eq!(store.append_response(&session, answer(1, false, 500.0)).await.unwrap(), Appended::Different);
    assert_eq!(store.append_response(&session, answer(3, true, 500.0)).await.unwrap(), Appended::NoSuchTrial);
    assert_eq!(store.complete(&session, "CODE").await.unwrap(), Completed::Missing(vec![0, 2]));
    for trial in [0, 2] {
        store.append_response(&session, answer(trial, false, 400.0)).await.unwrap();
    }
    assert_eq!(store.complete(&session, "FIRST").await.unwrap(), Completed::Code("FIRST".to_owned()));
    assert_eq!(store.complete(&session, "SECOND").await.unwrap(), Completed::Code("FIRST".to_owned()));
    let rows = store.responses(&session.study_id, &session.config_hash).await.unwrap();
    let (row, payload) = &rows[0];
    assert_eq!((row.trial_index, row.choice.as_str(), row.rt_ms), (1, "left", 500.0));
    assert_eq!(row.chosen_condition, session.trials[1].trial.left);
    assert_eq!(payload.as_deref(), Some("{\"trial\":1}"));
    let counts =
        store.participants(&session.study_id, &session.config_hash, Duration::from_secs(60)).await.unwrap();
    assert_eq!((counts.started, counts.in_progress, counts.completed), (1, 0, 1));
}

#[tokio::test(flavor = "multi_thread")]
async fn racing_writers_leave_one_row_a_trial_and_an_unbroken_chain() {
    let (_folder, store) = open().await;
    let session = begin(&store, Duration::from_secs(60)).await;
    let mut racers = Vec::new();
    for racer in 0..60u32 {
        let (store, session) = (store.clone(), session.clone());
        racers.push(tokio::spawn(async move {
            store
                .append_response(&session, answer(racer % 3, racer % 2 == 0, f64::from(racer)))
                .await
                .unwrap()
        }));
    }
    let mut stored = 0;
    for racer in racers {
        stored += usize::from(racer.await.unwrap() == Appended::Stored);
    }
    assert_eq!(stored, 3);
    assert_eq!(store.answered(&session.session_id).await.unwrap(), [0, 1, 2]);
    let report = store.verify_chain().await.unwrap();
    assert_eq!((report.rows, report.broken), (3, None));
}

#[tokio::test(flavor = "multi_thread")]
async fn racing_newcomers_get_slots_of_their_own() {
    let (_folder, store) = open().await;
    let newcomers: Vec<_> = (0..20)
        .map(|_| {
            let store = store.clone();
            tokio::spawn(async move { begin(&store, Duration::from_secs(60)).await.slot })
        })
        .collect();
    let mut slots = Vec::new();
    for newcomer in newcomers {
        slots.push(newcomer.await.unwrap());
    }
    slots.sort_unstable();
    assert_eq!(slots, (0..20).collect::<Vec<u32>>());
}

#[tokio::test(flavor = "multi_thread")]
async fn an_idle_session_frees_its_slot_and_a_completed_one_keeps_it() {
    let (_folder, store) = open().await;
    let never = Duration::ZERO;
    let first = begin(&store, never).await;
    for trial in 0..3 {
        store.append_response(&first, answer(trial, true, 1.0)).await.unwrap();
    }
    store.complete(&first, "CODE").await.unwrap();
    tokio::time::sleep(Duration::from_millis(5)).await;
    assert_eq!(begin(&store, never).await.slot, 1, "0 is completed");
    tokio::time::sleep(Duration::from_millis(5)).await;
    assert_eq!(begin(&store, never).await.slot, 1, "the one before was idle at once");
    assert_eq!(
        begin(&store, Duration::from_secs(60)).await.slot,
        2,
        "and is active for whoever waits longer"
    );
}

#[tokio::test(flavor = "multi_thread")]
async fn the_database_refuses_to_change_an_answer_whoever_asks() {
    let (folder, store) = open().await;
    let session = begin(&store, Duration::from_secs(60)).await;
    store.append_response(&session, answer(0, true, 500.0)).await.unwrap();
    let stranger = stranger(folder.path()).await;
    for sql in [
        "UPDATE responses SET choice = 'right', chosen_condition = right_condition",
        "UPDATE responses SET rt_ms = 1",
        "DELETE FROM responses",
        "INSERT OR REPLACE INTO responses SELECT * FROM responses",
        "REPLACE INTO responses SELECT response_id + 1, session_id, trial_index, block_id, pair_id, left_sha256, right_sha256,
         left_condition, right_condition, 'right', right_condition, rt_ms, received_at, payload_hash, prev_hash, 'x' FROM responses",
        "UPDATE response_payloads SET payload = '{}'",
        "DELETE FROM response_payloads",
        "INSERT OR REPLACE INTO response_payloads VALUES (1, '{}')",
    ] {
        let error = sqlx::query(sql).execute(&stranger).await.unwrap_err().to_string();
        assert!(error.contains("append-only"), "{sql}: {error}");
    }
    let rows = store.responses(&session.study_id, &session.config_hash).await.unwrap();
    assert_eq!((rows.len(), rows[0].0.rt_ms), (1, 500.0));
}

#[tokio::test(flavor = "multi_thread")]
async fn the_chain_names_the_first_row_that_was_tampered_with() {
    // (what someone does who can drop triggers, the row that gives it away, why)
    let cases = [
        ("UPDATE responses SET rt_ms = 1 WHERE response_id = 2", 2, "its values"),
        (
            "UPDATE responses SET choice = 'right', chosen_condition = right_condition WHERE response_id = 3",
            3,
            "its values",
        ),
        ("DELETE FROM responses WHERE response_id = 1", 2, "rows before it are missing"),
        ("UPDATE response_payloads SET payload = '{\"trial\":9}' WHERE response_id = 2", 2, "its payload"),
        ("UPDATE responses SET prev_hash = row_hash WHERE response_id = 2", 2, "does not follow"),
    ];
    for (sql, row, why) in cases {
        let (folder, store) = open().await;
        let session = begin(&store, Duration::from_secs(60)).await;
        for trial in 0..3 {
            store.append_response(&session, answer(trial, true, 100.0)).await.unwrap();
        }
        assert_eq!(store.verify_chain().await.unwrap().broken, None);
        let stranger = stranger(folder.path()).await;
        for setup in [
            "PRAGMA foreign_keys = off",
            "DROP TRIGGER responses_no_update",
            "DROP TRIGGER responses_no_delete",
            "DROP TRIGGER payloads_only_blanked",
        ] {
            sqlx::query(setup).execute(&stranger).await.unwrap();
        }
        // One connection of the pool: the pragma must hold for what follows.
        let mut connection = stranger.acquire().await.unwrap();
        sqlx::query("PRAGMA foreign_keys = off").execute(&mut *connection).await.unwrap();
        assert_eq!(sqlx::query(sql).execute(&mut *connection).await.unwrap().rows_affected(), 1, "{sql}");
        let (broken, found) = store.verify_chain().await.unwrap().broken.unwrap();
        assert!(broken == row && found.contains(why), "{sql}: row {broken}, {found}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_withdrawal_may_blank_a_payload_without_breaking_the_chain() {
    let (folder, store) = open().await;
    let session = begin(&store, Duration::from_secs(60)).await;
    store.append_response(&session, answer(0, true, 100.0)).await.unwrap();
    let stranger = stranger(folder.path()).await;
    sqlx::query("UPDATE response_payloads SET payload = NULL").execute(&stranger).await.unwrap();
    let report = store.verify_chain().await.unwrap();
    assert_eq!((report.rows, report.blanked, report.broken), (1, 1, None));
}

#[tokio::test(flavor = "multi_thread")]
async fn what_is_stored_survives_closing_and_opening() {
    let (folder, store) = open().await;
    let session = begin(&store, Duration::from_secs(60)).await;
    store.consent(&session.session_id).await.unwrap();
    store.append_response(&session, answer(0, true, 100.0)).await.unwrap();
    store.close().await;
    let store = Store::open(folder.path()).await.unwrap();
    let back = store.session(&session.session_id).await.unwrap().unwrap();
    assert_eq!((back.trials.clone(), back.slot), (session.trials, 0));
    assert!(back.consented_at.is_some());
    store.append_response(&back, answer(1, true, 100.0)).await.unwrap();
    assert_eq!(store.verify_chain().await.unwrap().rows, 2);
    let versions = store.study_versions(&back.study_id).await.unwrap();
    assert_eq!(versions[0].study.config_hash(), back.config_hash);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_database_of_a_newer_version_is_refused() {
    let (folder, store) = open().await;
    store.close().await;
    let stranger = stranger(folder.path()).await;
    sqlx::query("INSERT INTO _sqlx_migrations VALUES (9999, 'later', '2030-01-01', 1, x'00', 0)")
        .execute(&stranger)
        .await
        .unwrap();
    stranger.close().await;
    assert!(matches!(Store::open(folder.path()).await, Err(StoreError::Migrate(_))));
}

#[tokio::test(flavor = "multi_thread")]
async fn every_connection_has_the_pragmas_that_durability_rests_on() {
    let (folder, _store) = open().await;
    let mode: String =
        sqlx::query_scalar("PRAGMA journal_mode").fetch_one(&stranger(folder.path()).await).await.unwrap();
    assert_eq!(mode, "wal");
    let (full, keys) = _store.pragmas().await.unwrap();
    assert_eq!((full, keys), (2, 1), "synchronous = FULL, foreign_keys = on");
}

#[tokio::test(flavor = "multi_thread")]
async fn reading_on_adds_what_has_come_since_and_nothing_twice() {
    let (_folder, store) = open().await;
    let session = begin(&store, Duration::from_secs(60)).await;
    let study = setting::study();
    let mut stored = StoredAnswers::new(&study);
    store.read_on(&mut stored).await.unwrap();
    assert!(stored.answers().is_empty());
    for (trial, answers) in [(2, 1), (0, 2), (1, 3)] {
        store.append_response(&session, answer(trial, trial == 0, 7.5)).await.unwrap();
        store.read_on(&mut stored).await.unwrap();
        store.read_on(&mut stored).await.unwrap();
        assert_eq!(stored.answers().len(), answers);
    }
    let answers = stored.answers();
    let [participant] = answers.participants()[..] else { panic!("one took part") };
    assert_eq!(*participant.session_id, *session.session_id);
    for given in participant.answers() {
        let planned = session.trials.iter().find(|t| t.trial.item_index == given.item).unwrap();
        let chose_left = planned.trial.trial_index == 0;
        assert_eq!((given.chose_left, given.rt_ms), (chose_left, 7.5));
        assert_eq!(given.chose_target, planned.trial.target_left == chose_left);
    }
    let mut whole = StoredAnswers::new(&study);
    store.read_on(&mut whole).await.unwrap();
    assert_eq!(whole.answers().participants(), answers.participants());
    let mut changed = study.clone();
    changed.title = "Another version".to_owned();
    let mut other = StoredAnswers::new(&changed);
    store.read_on(&mut other).await.unwrap();
    assert!(other.answers().is_empty());
}
