//! Plans that grow: what comes next is asked for under the writer's lock and is a function of what is stored.

use crate::setting::{IDLE, Served, adaptive, answer, answer_of, append, begin, serve, stranger};
use kelir_store::{Appended, Completed, NextTrials, Session, Store, StoreError};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering::SeqCst};
use tempfile::TempDir;

async fn open() -> (TempDir, Store, Arc<Served>, Session) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path()).await.unwrap();
    let served = Arc::new(serve(&store, adaptive(), 1).await);
    let session = begin(&store, &served, IDLE).await;
    (folder, store, served, session)
}

/// Answers a trial; the first half of the staircase's trials with its target.
async fn give(store: &Store, served: &Served, session: &Session, index: u32) -> Appended {
    let trials = store.trials(&session.session_id).await.unwrap();
    let trial = &trials[index as usize].trial;
    let new = answer_of(trial.trial.rules(), index, trial.is_first("pa") == (index < 6), 100.0);
    let (served, slot) = (served.clone(), session.slot);
    let next = move |progress| Ok::<_, StoreError>(served.next(slot, &progress));
    store.append_answer(session, &new, next).await.unwrap()
}

/// (trial_index, after_seq) of each decided trial.
async fn decided(folder: &Path) -> Vec<(i64, i64)> {
    let query = "SELECT trial_index, after_seq FROM session_trials ORDER BY trial_index";
    sqlx::query_as(query).fetch_all(&mut stranger(folder).await).await.unwrap()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_plan_goes_on_from_the_answers_and_is_complete_when_nothing_follows() {
    let (folder, store, served, session) = open().await;
    // Three stills and the first trial of the staircase.
    assert_eq!(decided(folder.path()).await, [(0, 0), (1, 0), (2, 0), (3, 0)]);
    for index in [1, 0, 2] {
        give(&store, &served, &session, index).await;
        assert_eq!(store.trials(&session.session_id).await.unwrap().len(), 4, "nothing hangs on a still");
    }
    assert_eq!(store.complete(&session, "CODE").await.unwrap(), Completed::Missing(vec![3]));
    for (index, trials) in [(3, 5), (4, 6), (5, 7), (6, 8)] {
        give(&store, &served, &session, index).await;
        assert_eq!(store.trials(&session.session_id).await.unwrap().len(), trials);
        assert!(store.session(&session.session_id).await.unwrap().unwrap().more);
        assert_eq!(store.complete(&session, "CODE").await.unwrap(), Completed::Missing(vec![index + 1]));
    }
    give(&store, &served, &session, 7).await;
    let session = store.session(&session.session_id).await.unwrap().unwrap();
    assert!(!session.more);
    assert_eq!(store.complete(&session, "CODE").await.unwrap(), Completed::Code("CODE".to_owned()));
    // The sequence up to which answers decided is that of the answer just stored.
    let after = [0, 0, 0, 0, 4, 5, 6, 7];
    assert_eq!(decided(folder.path()).await, (0..).zip(after).collect::<Vec<(i64, i64)>>());
    // Another who answers the same in the same slot is shown the same: from the answers alone.
    let trials = store.trials(&session.session_id).await.unwrap();
    let answers = store.answer_rows("adaptive", std::slice::from_ref(&session.version)).await.unwrap();
    let answers = answers.into_iter().map(|row| (row.trial_index, row.answer.unwrap())).collect();
    let mut progress = kelir_store::Progress { trials: served.plan(0).next.trials, answers };
    while let [next, ..] = &served.next(0, &progress).trials[..] {
        progress.trials.push(next.clone());
    }
    assert_eq!(progress.trials, trials);
    assert_eq!(trials[3].trial.trial.name(), "two-interval");
    let levels: Vec<u32> = trials[3..].iter().map(|planned| planned.trial.item_index).collect();
    assert!(levels.windows(2).any(|pair| pair[0] != pair[1]), "the answers moved it: {levels:?}");
    let report = store.verify_chain("adaptive").await.unwrap();
    assert_eq!((report.rows, report.faults), (8, vec![]));
}

#[tokio::test(flavor = "multi_thread")]
async fn complete_refuses_while_answers_will_decide_more() {
    let (_folder, store, _, session) = open().await;
    for index in 0..4 {
        let trial = &store.trials(&session.session_id).await.unwrap()[index as usize].trial;
        let new = answer_of(trial.trial.rules(), index, true, 1.0);
        let undecided = |_| Ok::<_, StoreError>(NextTrials { trials: vec![], more: true });
        assert_eq!(store.append_answer(&session, &new, undecided).await.unwrap(), Appended::Stored);
    }
    assert_eq!(store.complete(&session, "CODE").await.unwrap(), Completed::Missing(vec![]));
    assert_eq!(store.session(&session.session_id).await.unwrap().unwrap().completed_at, None);
}

#[tokio::test(flavor = "multi_thread")]
async fn racing_answers_decide_each_trial_once_and_one_after_the_other() {
    let (folder, store, served, session) = open().await;
    for index in 0..3 {
        give(&store, &served, &session, index).await;
    }
    let within = Arc::new(AtomicU32::new(0));
    for index in 3..8 {
        let trial = store.trials(&session.session_id).await.unwrap()[index as usize].trial.clone();
        let racers = (0..8u32).map(|racer| {
            let (store, served, session) = (store.clone(), served.clone(), session.clone());
            let (within, rules) = (within.clone(), trial.trial.rules());
            tokio::spawn(async move {
                let slot = session.slot;
                let next = move |progress: kelir_store::Progress| {
                    assert_eq!(within.fetch_add(1, SeqCst), 0, "two decide at once");
                    assert_eq!(progress.answers.len(), index as usize + 1, "its own answer is among them");
                    std::thread::sleep(std::time::Duration::from_millis(2));
                    within.fetch_sub(1, SeqCst);
                    Ok::<_, StoreError>(served.next(slot, &progress))
                };
                let new = answer_of(rules, index, racer % 2 == 0, f64::from(racer));
                store.append_answer(&session, &new, next).await.unwrap()
            })
        });
        let mut stored = 0;
        for racer in racers.collect::<Vec<_>>() {
            stored += usize::from(racer.await.unwrap() == Appended::Stored);
        }
        assert_eq!(stored, 1);
    }
    let indices: Vec<i64> = decided(folder.path()).await.into_iter().map(|(index, _)| index).collect();
    assert_eq!(indices, (0..8).collect::<Vec<i64>>());
}

#[tokio::test(flavor = "multi_thread")]
async fn an_error_of_what_decides_stores_nothing() {
    let (folder, store, served, session) = open().await;
    give(&store, &served, &session, 0).await;
    let before = crate::setting::dump(folder.path()).await;
    let fails = |_| Err::<NextTrials, _>(StoreError::Undecodable("cannot say".to_owned()));
    let error = store.append_answer(&session, &answer(1, true, 1.0), fails).await.unwrap_err();
    assert!(matches!(error, StoreError::Undecodable(_)));
    // Neither does one that decides what is decided already.
    let plan = served.plan(session.slot).next;
    let again = |_| Ok::<_, StoreError>(plan);
    let error = store.append_answer(&session, &answer(1, true, 1.0), again).await.unwrap_err();
    assert!(error.to_string().contains("plans are append-only"), "{error}");
    assert!(crate::setting::dump(folder.path()).await == before);
    assert_eq!(give(&store, &served, &session, 1).await, Appended::Stored);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_resend_and_a_stranger_trial_decide_nothing() {
    let (_folder, store, served, session) = open().await;
    give(&store, &served, &session, 0).await;
    let trial = &store.trials(&session.session_id).await.unwrap()[0].trial;
    let same = answer_of(trial.trial.rules(), 0, trial.is_first("pa"), 100.0);
    assert_eq!(append(&store, &session, same).await, Appended::Same);
    assert!(matches!(append(&store, &session, answer(0, true, 9.0)).await, Appended::Different(_)));
    assert_eq!(append(&store, &session, answer(4, true, 9.0)).await, Appended::NoSuchTrial);
}
