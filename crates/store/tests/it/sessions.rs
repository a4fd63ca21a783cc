//! Sessions and their slots; how the database is opened.

use crate::setting::{IDLE, answer, append, begin, open, stranger};
use kelir_store::{Store, StoreError};
use std::time::Duration;

#[tokio::test(flavor = "multi_thread")]
async fn racing_newcomers_get_slots_of_their_own() {
    let (_folder, store, served) = open().await;
    let served = std::sync::Arc::new(served);
    let newcomers: Vec<_> = (0..20)
        .map(|_| {
            let (store, served) = (store.clone(), served.clone());
            tokio::spawn(async move { begin(&store, &served, IDLE).await.slot })
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
    let (_folder, store, served) = open().await;
    let never = Duration::ZERO;
    let first = begin(&store, &served, never).await;
    for trial in 0..3 {
        append(&store, &first, answer(trial, true, 1.0)).await;
    }
    store.complete(&first, "CODE").await.unwrap();
    tokio::time::sleep(Duration::from_millis(5)).await;
    assert_eq!(begin(&store, &served, never).await.slot, 1, "0 is completed");
    tokio::time::sleep(Duration::from_millis(5)).await;
    assert_eq!(begin(&store, &served, never).await.slot, 1, "the one before was idle at once");
    assert_eq!(begin(&store, &served, IDLE).await.slot, 2, "and is active for whoever waits longer");
}

#[tokio::test(flavor = "multi_thread")]
async fn slots_are_a_versions_own() {
    let (_folder, store, served) = open().await;
    assert_eq!(begin(&store, &served, IDLE).await.slot, 0);
    let other = crate::setting::serve(&store, served.study.clone(), 100).await;
    assert_ne!(other.version, served.version);
    assert_eq!(begin(&store, &other, IDLE).await.slot, 0);
    assert_eq!(begin(&store, &served, IDLE).await.slot, 1);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_session_whose_plan_fails_is_not_there() {
    let (_folder, store, served) = open().await;
    let session = begin(&store, &served, IDLE).await;
    let new = kelir_store::NewSession {
        study_id: session.study_id.clone(),
        version: session.version.clone(),
        file_hash: session.file_hash.clone(),
        subject_id: Some("somebody".to_owned()),
        token_hash: "t".to_owned(),
        kind: Default::default(),
        flags: Vec::new(),
        repeat: Default::default(),
        start_key: None,
        user_agent: None,
        params: session.params.clone(),
        display: session.display.clone(),
        idle: IDLE,
    };
    let fails = |_| Err::<kelir_store::PlannedSession, _>(StoreError::Undecodable("no plan".to_owned()));
    assert!(matches!(store.create_session(new, fails).await, Err(StoreError::Undecodable(_))));
    assert_eq!(store.sessions(&session.study_id, &[session.version]).await.unwrap().len(), 1);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_database_of_a_newer_version_is_refused() {
    let (folder, store, _) = open().await;
    store.close().await;
    let later = "INSERT INTO _sqlx_migrations VALUES (9999, 'later', '2030-01-01', 1, x'00', 0)";
    sqlx::query(later).execute(&mut stranger(folder.path()).await).await.unwrap();
    assert!(matches!(Store::open(folder.path()).await, Err(StoreError::Migrate(_))));
}

#[tokio::test(flavor = "multi_thread")]
async fn every_connection_has_the_pragmas_that_durability_rests_on() {
    let (folder, store, _) = open().await;
    let mode: String = sqlx::query_scalar("PRAGMA journal_mode")
        .fetch_one(&mut stranger(folder.path()).await)
        .await
        .unwrap();
    assert_eq!(mode, "wal");
    let (full, keys) = store.pragmas().await.unwrap();
    assert_eq!((full, keys), (2, 1), "synchronous = FULL, foreign_keys = on");
}
