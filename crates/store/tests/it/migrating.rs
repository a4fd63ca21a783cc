//! A data folder of an earlier version goes on as it was.

use crate::setting::{answer, begin};
use kelir_store::{Appended, Store};
use sqlx::SqlSafeStr;
use sqlx::migrate::{Migration, MigrationType, Migrator};
use sqlx::sqlite::{SqliteConnectOptions, SqlitePool};
use std::time::Duration;

#[tokio::test(flavor = "multi_thread")]
async fn answers_of_the_first_layout_are_kept_counted_and_added_to() {
    // Answers, written by a store; then the layout is put back to what it was before the second migration.
    let (folder, store) = crate::setting::open().await;
    let session = begin(&store, Duration::from_secs(60)).await;
    store.append_response(&session, answer(0, true, 500.0)).await.unwrap();
    store.close().await;
    let database = folder.path().join("kelir.sqlite");
    let stranger = SqlitePool::connect_with(SqliteConnectOptions::new().filename(&database)).await.unwrap();
    for sql in [
        "DROP INDEX sessions_by_study",
        "CREATE INDEX sessions_by_study ON sessions (study_id, config_hash, slot)",
        "DELETE FROM _sqlx_migrations WHERE version > 1",
    ] {
        sqlx::query(sql).execute(&stranger).await.unwrap();
    }
    // That is the first layout: its own migrations find nothing to do.
    let first = include_str!("../../../../migrations/sqlite/0001_first.sql");
    let first = Migration::new(1, "first".into(), MigrationType::Simple, first.into_sql_str(), false);
    Migrator::with_migrations(vec![first]).run(&stranger).await.unwrap();
    stranger.close().await;

    let store = Store::open(folder.path()).await.unwrap();
    let same = store.session(&session.session_id).await.unwrap().unwrap();
    assert_eq!(store.append_response(&same, answer(0, true, 500.0)).await.unwrap(), Appended::Same);
    assert_eq!(store.append_response(&same, answer(1, false, 400.0)).await.unwrap(), Appended::Stored);
    let counts =
        store.participants(&same.study_id, &same.config_hash, Duration::from_secs(60)).await.unwrap();
    assert_eq!((counts.started, counts.in_progress), (1, 1));
    assert_eq!(store.verify_chain().await.unwrap().rows, 2);
    let database = SqlitePool::connect_with(SqliteConnectOptions::new().filename(database)).await.unwrap();
    let plan: Vec<(i64, i64, i64, String)> = sqlx::query_as(
        "EXPLAIN QUERY PLAN SELECT count(completed_at) FROM sessions WHERE study_id = '' AND config_hash = ''",
    )
    .fetch_all(&database)
    .await
    .unwrap();
    assert!(plan[0].3.contains("COVERING INDEX"), "{plan:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn imported_sessions_are_rows_of_the_same_chain_all_or_none() {
    use kelir_store::{ImportedSession, PlannedSession};
    let (_folder, store) = crate::setting::open().await;
    let session = begin(&store, Duration::from_secs(60)).await;
    store.append_response(&session, answer(0, true, 500.0)).await.unwrap();
    let imported = |trials: [u32; 3]| ImportedSession {
        study_id: session.study_id.clone(),
        config_hash: session.config_hash.clone(),
        slot: 1,
        planned: PlannedSession { seed: session.plan_seed.clone(), trials: session.trials.clone() },
        answers: trials.map(|trial| answer(trial, trial == 1, 321.5)).to_vec(),
        completion_code: Some("CODE".to_owned()),
    };
    assert!(store.import_sessions(vec![imported([0, 1, 2]), imported([0, 1, 3])]).await.is_err());
    assert_eq!(store.verify_chain().await.unwrap().rows, 1, "none of the two is stored");
    store.import_sessions(vec![imported([0, 1, 2]), imported([2, 1, 0])]).await.unwrap();
    store.append_response(&session, answer(1, true, 500.0)).await.unwrap();
    let chain = store.verify_chain().await.unwrap();
    assert_eq!((chain.rows, chain.broken), (8, None));
    let counts =
        store.participants(&session.study_id, &session.config_hash, Duration::from_secs(60)).await.unwrap();
    assert_eq!((counts.started, counts.completed), (3, 2));
}
