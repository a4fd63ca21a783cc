//! Slots are found at constant cost and are the very ones that the plain definition gives.

use crate::setting::{IDLE, Served, answer, append, begin, open, stranger};
use kelir_store::{Begun, Session, SessionKind, Store, StoreError};
use kelir_study::plan::lowest_free_slot;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use sqlx::sqlite::SqliteConnection;
use std::collections::HashSet;
use std::path::Path;

const MINUTES: u64 = 60;

/// Something that happens to a study.
#[derive(Clone, Debug)]
enum Event {
    Starts(SessionKind),
    /// One of the sessions completes.
    Completes(usize),
    /// One answers something.
    Answers(usize),
    /// One is back, and is moved where somebody else has its slot and it has no answer.
    Returns(usize),
    /// One consents; otherwise the same.
    Consents(usize),
    MinutesPass(u32),
}

fn event() -> impl Strategy<Value = Event> {
    prop_oneof![
        6 => Just(Event::Starts(SessionKind::Participant)),
        1 => Just(Event::Starts(SessionKind::Pilot)),
        2 => any::<usize>().prop_map(Event::Completes),
        1 => any::<usize>().prop_map(Event::Answers),
        2 => any::<usize>().prop_map(Event::Returns),
        2 => any::<usize>().prop_map(Event::Consents),
        3 => (1u32..90).prop_map(Event::MinutesPass),
    ]
}

/// Slots that participants hold, by definition: those completed, and those of who was seen within the idle time.
async fn held(raw: &mut SqliteConnection, but: &str) -> Vec<u32> {
    let query = "SELECT slot FROM sessions WHERE kind = 'participant' AND session_id <> $1
                 AND (completed_at IS NOT NULL OR last_seen_at > strftime('%Y-%m-%dT%H:%M:%fZ', 'now', '-60 minutes'))";
    sqlx::query_scalar(query).bind(but).fetch_all(raw).await.unwrap()
}

async fn start(store: &Store, served: &Served, kind: SessionKind) -> Session {
    let mut new = crate::setting::newcomer(served, std::time::Duration::from_secs(60 * MINUTES));
    new.kind = kind;
    let plan = served.clone();
    let begun = store.create_session(new, move |slot| Ok::<_, StoreError>(plan.plan(slot))).await.unwrap();
    let Begun::New(session) = begun else { panic!("{begun:?}") };
    session
}

async fn holds(
    folder: &Path,
    store: &Store,
    served: &Served,
    events: Vec<Event>,
) -> Result<(), TestCaseError> {
    let mut raw = stranger(folder).await;
    let mut sessions: Vec<Session> = Vec::new();
    let mut answered = HashSet::new();
    for event in events {
        let of = |n: usize| (!sessions.is_empty()).then(|| sessions[n % sessions.len()].clone());
        match event {
            Event::Starts(kind) => {
                let expected = lowest_free_slot(held(&mut raw, "").await);
                let session = start(store, served, kind).await;
                prop_assert_eq!(session.slot, expected);
                sessions.push(session);
            }
            Event::Completes(n) => {
                let Some(session) = of(n) else { continue };
                let done = "UPDATE sessions SET completed_at = created_at, completion_code = 'C' WHERE session_id = $1";
                sqlx::query(done).bind(&session.session_id).execute(&mut raw).await.unwrap();
            }
            Event::Answers(n) => {
                let Some(session) = of(n) else { continue };
                append(store, &session, answer(0, true, 500.0)).await;
                answered.insert(session.session_id);
            }
            Event::Returns(n) | Event::Consents(n) => {
                let Some(session) = of(n) else { continue };
                let before = store.session(&session.session_id).await.unwrap().unwrap();
                let others = held(&mut raw, &session.session_id).await;
                let all = held(&mut raw, "").await;
                let moves = before.kind == SessionKind::Participant
                    && before.completed_at.is_none()
                    && !answered.contains(&before.session_id)
                    && others.contains(&before.slot);
                let plan = served.clone();
                let idle = std::time::Duration::from_secs(60 * MINUTES);
                let plan = move |slot| Ok::<_, StoreError>(plan.plan(slot));
                let after = match event {
                    Event::Consents(_) => store.consent(&before, "text", idle, plan).await.unwrap(),
                    _ => store.resume(&before, idle, plan).await.unwrap(),
                };
                prop_assert_eq!(
                    after.consented_at.is_some(),
                    before.consented_at.is_some() || matches!(event, Event::Consents(_))
                );
                prop_assert_eq!(after.slot, if moves { lowest_free_slot(all) } else { before.slot });
                let trials = store.trials(&after.session_id).await.unwrap();
                prop_assert_eq!(trials, served.plan(after.slot).next.trials);
                prop_assert_eq!(after.plan_seed, served.plan(after.slot).seed);
            }
            Event::MinutesPass(minutes) => {
                for (table, column) in [("sessions", "last_seen_at"), ("slots", "seen_at")] {
                    let pass = format!(
                        "UPDATE {table} SET {column} = coalesce(strftime('%Y-%m-%dT%H:%M:%fZ', {column}, '-{minutes} minutes'), '')"
                    );
                    sqlx::query(sqlx::AssertSqlSafe(pass)).execute(&mut raw).await.unwrap();
                }
            }
        }
    }
    Ok(())
}

#[test]
fn slots_are_those_of_the_plain_definition_whatever_happens() {
    let runtime = tokio::runtime::Runtime::new().unwrap();
    let config =
        Config { rng_seed: RngSeed::Fixed(20_261_130), failure_persistence: None, ..Config::with_cases(24) };
    let run = TestRunner::new(config).run(&proptest::collection::vec(event(), 1..40), |events| {
        runtime.block_on(async {
            let (folder, store, served) = open().await;
            holds(folder.path(), &store, &served, events).await
        })
    });
    run.unwrap_or_else(|failed| panic!("{failed}"));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_start_reads_as_many_rows_with_many_slots_held_as_with_none() {
    let (folder, store, served) = open().await;
    begin(&store, &served, IDLE).await;
    let mut raw = stranger(folder.path()).await;
    for query in [
        "SELECT min(slot) FROM slots WHERE study_id = '' AND version = '' AND is_free = 1",
        "SELECT slot FROM slots WHERE study_id = '' AND version = '' AND is_free = 0 AND seen_at <= ''",
        "SELECT max(completed_at IS NOT NULL), max(last_seen_at) FROM sessions
         WHERE study_id = '' AND version = '' AND slot = 0 AND kind = 'participant'",
        "SELECT top FROM slot_tops WHERE study_id = '' AND version = ''",
    ] {
        let plan: Vec<(i64, i64, i64, String)> =
            sqlx::query_as(sqlx::AssertSqlSafe(format!("EXPLAIN QUERY PLAN {query}")))
                .fetch_all(&mut raw)
                .await
                .unwrap();
        let [(.., plan)] = &plan[..] else { panic!("{plan:?}") };
        assert!(plan.starts_with("SEARCH ") && plan.contains("version=?"), "{query}: {plan}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn the_same_key_gives_the_same_session_until_it_has_consent() {
    let (_folder, store, served) = open().await;
    let ask = async |key: &str, token: &str| {
        let mut new = crate::setting::newcomer(&served, IDLE);
        (new.start_key, new.token_hash) = (Some(key.to_owned()), token.to_owned());
        let plan = served.clone();
        store.create_session(new, move |slot| Ok::<_, StoreError>(plan.plan(slot))).await.unwrap()
    };
    let Begun::New(first) = ask("k", "first").await else { panic!("nobody had this key") };
    let Begun::Again(again) = ask("k", "second").await else { panic!("the reply was lost") };
    assert_eq!((&again.session_id, again.slot), (&first.session_id, first.slot));
    let stored = store.session(&first.session_id).await.unwrap().unwrap();
    assert_eq!(stored.token_hash, "second", "the old token is void");
    let Begun::New(other) = ask("another", "third").await else { panic!("another key is another session") };
    assert_eq!(other.slot, first.slot + 1);
    let moved = |_| -> Result<_, StoreError> { panic!("nobody else has its slot") };
    store.consent(&first, "text", IDLE, moved).await.unwrap();
    assert!(matches!(ask("k", "fourth").await, Begun::KeyUsed));
    let stored = store.session(&first.session_id).await.unwrap().unwrap();
    assert_eq!(stored.token_hash, "second", "and the token stays");
}
