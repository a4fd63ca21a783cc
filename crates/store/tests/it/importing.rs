//! Sessions brought in many at a time.

use crate::chain::{FOLLOWS, VALUES, faults};
use crate::setting::{IDLE, answer, append, begin, open, tamper};
use kelir_store::ImportedSession;

#[tokio::test(flavor = "multi_thread")]
async fn imported_sessions_are_rows_of_the_same_chain_all_or_none() {
    let (_folder, store, served) = open().await;
    let session = begin(&store, &served, IDLE).await;
    append(&store, &session, answer(0, true, 500.0)).await;
    let imported = |trials: [u32; 3]| ImportedSession {
        study_id: session.study_id.clone(),
        version: session.version.clone(),
        file_hash: session.file_hash.clone(),
        slot: 1,
        planned: served.plan(1),
        answers: trials.map(|trial| answer(trial, trial == 1, 321.5)).to_vec(),
        completion_code: Some("CODE".to_owned()),
    };
    assert!(store.import_sessions(vec![imported([0, 1, 2]), imported([0, 1, 3])]).await.is_err());
    let chain = store.verify_chain(&session.study_id).await.unwrap();
    assert_eq!(chain.rows, 1, "none of the two is stored");
    store.import_sessions(vec![imported([0, 1, 2]), imported([2, 1, 0])]).await.unwrap();
    append(&store, &session, answer(1, true, 500.0)).await;
    let chain = store.verify_chain(&session.study_id).await.unwrap();
    assert_eq!((chain.rows, chain.faults), (8, vec![]));
    let counts = store.version_counts(&session.study_id, IDLE).await.unwrap()[&session.version];
    assert_eq!((counts.participants.started, counts.participants.completed, counts.answers), (3, 2, 8));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_chain_is_verified_beyond_what_is_read_in_one_go() {
    let (folder, store, served) = open().await;
    let mut planned = served.plan(0);
    let trial = planned.next.trials[0].clone();
    let numbered = |trial_index| {
        let mut planned = trial.clone();
        planned.trial.trial_index = trial_index;
        planned
    };
    const ROWS: u32 = 10_003;
    planned.next.trials = (0..ROWS).map(numbered).collect();
    let session = ImportedSession {
        study_id: served.study.id.clone(),
        version: served.version.clone(),
        file_hash: served.study.file_hash(),
        slot: 0,
        planned,
        answers: (0..ROWS).map(|trial| answer(trial, true, 321.5)).collect(),
        completion_code: None,
    };
    store.import_sessions(vec![session]).await.unwrap();
    let chain = store.verify_chain("small").await.unwrap();
    assert_eq!((chain.rows, chain.faults), (u64::from(ROWS), vec![]));
    let hash = "UPDATE answers SET row_hash = printf('%064d', seq) WHERE seq IN (9999, 10000, 10002)";
    tamper(folder.path(), &[hash]).await;
    let chain = store.verify_chain("small").await.unwrap();
    let expected = [
        (9999, VALUES),
        (10_000, VALUES),
        (10_000, FOLLOWS),
        (10_001, FOLLOWS),
        (10_002, VALUES),
        (10_003, FOLLOWS),
    ];
    assert_eq!(faults(&chain, 2), expected);
}
