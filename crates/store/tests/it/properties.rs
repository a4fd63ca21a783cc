//! Whatever is answered, to whatever is shown: it is read as it was written, and what is hashed is what is stored.

use crate::setting::{IDLE, Served, append, open, stranger};
use kelir_store::{
    Appended, NewAnswer, NewSession, NextTrials, PlannedSession, ShownStimulus, StimulusHashes, Store,
    StoreError, sha256_hex,
};
use kelir_study::trials::{Placed, Role};
use proptest::collection::{btree_map, vec};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use serde_json::{Value, json};
use sqlx::sqlite::SqliteConnection;
use std::collections::BTreeMap;

const SEED: u64 = 20_261_128;
const CASES: u32 = 192;

/// Any text, with what is hard about texts often in it.
fn text() -> impl Strategy<Value = String> {
    let hard = prop::sample::select(vec![
        '\0',
        '\u{1}',
        '\u{8}',
        '\n',
        '\r',
        '\t',
        '\u{1f}',
        '\u{7f}',
        '"',
        '\\',
        '/',
        '\u{85}',
        '\u{a0}',
        '\u{2028}',
        '\u{2029}',
        '\u{d7ff}',
        '\u{e000}',
        '\u{feff}',
        '\u{fffd}',
        '\u{ffff}',
        '\u{1f600}',
        '\u{10ffff}',
        'e',
        '\u{301}',
    ]);
    vec(prop_oneof![2 => any::<char>(), 3 => hard], 0..12).prop_map(|chars| chars.into_iter().collect())
}

/// Any number that JSON has: all bit patterns, with the ends of every range often.
fn number() -> impl Strategy<Value = f64> {
    let hard = prop::sample::select(vec![
        0.0,
        -0.0,
        f64::from_bits(1),
        -f64::from_bits(1),
        f64::MIN_POSITIVE,
        f64::from_bits(0x000f_ffff_ffff_ffff),
        f64::MAX,
        f64::MIN,
        9_007_199_254_740_993.0,
        1e21,
        1e-7,
        0.1 + 0.2,
        1e23,
    ]);
    prop_oneof![any::<u64>().prop_map(f64::from_bits), hard]
        .prop_filter("JSON has no such number", |x| x.is_finite())
}

/// Any JSON value.
fn value() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        any::<u64>().prop_map(Value::from),
        number().prop_map(Value::from),
        text().prop_map(Value::from),
    ];
    leaf.prop_recursive(4, 24, 5, |inner| {
        prop_oneof![
            vec(inner.clone(), 0..5).prop_map(Value::from),
            btree_map(text(), inner, 0..5).prop_map(Value::from_iter),
        ]
    })
}

/// One trial with whatever it shows, and an answer to it.
#[derive(Clone, Debug)]
struct Case {
    shown: [[String; 4]; 2],
    answer: Value,
    payload: Value,
    pretty: bool,
}

fn case() -> impl Strategy<Value = Case> {
    let stimulus = || [text(), text(), text(), text()];
    let parts = ([stimulus(), stimulus()], value(), value(), any::<bool>());
    parts.prop_map(|(shown, answer, payload, pretty)| Case { shown, answer, payload, pretty })
}

async fn holds(
    store: &Store,
    served: &Served,
    raw: &mut SqliteConnection,
    case: Case,
) -> Result<(), TestCaseError> {
    let mut planned = served.plan(0).next.trials.remove(0);
    let mut expected = BTreeMap::new();
    for (role, [item, condition, sha256, pixels_sha256]) in
        [Role::Left, Role::Right].into_iter().zip(case.shown)
    {
        let placed = Placed { item: item.clone().into(), condition: condition.clone().into() };
        planned.trial.shown.insert(role, placed);
        let hashes = StimulusHashes { sha256: sha256.clone(), pixels_sha256: pixels_sha256.clone() };
        planned.stimuli.insert(role, hashes);
        expected.insert(role, ShownStimulus { item, condition, sha256, pixels_sha256 });
    }
    let new = NewSession {
        study_id: served.study.id.clone(),
        version: served.version.clone(),
        file_hash: served.study.file_hash(),
        subject_id: None,
        token_hash: "t".to_owned(),
        kind: Default::default(),
        flags: Vec::new(),
        repeat: Default::default(),
        start_key: None,
        user_agent: None,
        params: case.payload.clone(),
        display: case.answer.clone(),
        idle: IDLE,
    };
    let next = NextTrials { trials: vec![planned.clone()], more: false };
    let plan = |_| Ok::<_, StoreError>(PlannedSession { seed: "s".to_owned(), next });
    let session = store.create_session(new, plan).await.unwrap().session().unwrap();
    prop_assert_eq!(&store.trials(&session.session_id).await.unwrap(), &[planned]);
    let back = store.session(&session.session_id).await.unwrap().unwrap();
    prop_assert_eq!((&back.params, &back.display), (&case.payload, &case.answer));

    let written = if case.pretty {
        serde_json::to_string_pretty(&case.payload)
    } else {
        serde_json::to_string(&case.payload)
    };
    let new = NewAnswer {
        trial_index: 0,
        answer: kelir_jcs::canonical(case.answer).unwrap(),
        payload: written.unwrap(),
        stimulus_size: None,
    };
    prop_assert_eq!(append(store, &session, new.clone()).await, Appended::Stored);
    prop_assert_eq!(append(store, &session, new.clone()).await, Appended::Same);

    // As it lies there, read by another.
    let stored: (Vec<u8>, String, Vec<u8>, Vec<u8>, Vec<u8>) = sqlx::query_as(
        "SELECT CAST(row AS BLOB), row_hash, nonce, CAST(answer AS BLOB), CAST(payload AS BLOB)
         FROM answers JOIN answer_contents USING (study_id, seq) WHERE session_id = $1",
    )
    .bind(&session.session_id)
    .fetch_one(raw)
    .await
    .unwrap();
    let (row, row_hash, nonce, answer, payload) = stored;
    prop_assert_eq!((&answer[..], &payload[..]), (new.answer.as_bytes(), new.payload.as_bytes()));
    prop_assert_eq!(sha256_hex(&row), row_hash);
    let values: Value = serde_json::from_slice(&row).unwrap();
    let answer_hash = sha256_hex(&[&nonce[..], &answer, b"\n", &payload].concat());
    prop_assert_eq!(nonce.len(), 16);
    let [_, _, _, _, kind, shown, received_at, ..] = &values.as_array().unwrap()[..] else {
        panic!("{values}")
    };
    prop_assert_eq!(shown, &serde_json::to_value(&expected).unwrap());
    prop_assert_eq!(&values[7], &json!(answer_hash));
    let rows = store.answer_rows(&session.study_id, std::slice::from_ref(&session.version)).await.unwrap();
    let read = rows.last().unwrap();
    let place = json!([session.study_id, rows.len(), session.session_id, 0]);
    prop_assert_eq!(&values.as_array().unwrap()[..4], &place.as_array().unwrap()[..]);
    // Canonical: one text for one value.
    prop_assert_eq!(kelir_jcs::canonical(values.clone()).unwrap(), String::from_utf8_lossy(&row));

    prop_assert_eq!(
        (&read.session_id, read.seq, read.trial_index),
        (&session.session_id, rows.len() as i64, 0)
    );
    prop_assert_eq!((&json!(read.trial_kind), &json!(read.received_at)), (kind, received_at));
    prop_assert_eq!(&read.shown, &expected);
    prop_assert_eq!((read.answer.as_ref(), read.payload.as_ref()), (Some(&new.answer), Some(&new.payload)));
    prop_assert_eq!(&read.answer_hash, &answer_hash);
    Ok(())
}

#[test]
fn what_is_written_is_what_is_hashed_and_what_is_read() {
    eprintln!("seed: {SEED}");
    let runtime = tokio::runtime::Runtime::new().unwrap();
    let (folder, store, served) = runtime.block_on(open());
    let raw = std::cell::RefCell::new(runtime.block_on(stranger(folder.path())));
    let config =
        Config { rng_seed: RngSeed::Fixed(SEED), failure_persistence: None, ..Config::with_cases(CASES) };
    let run = TestRunner::new(config)
        .run(&case(), |case| runtime.block_on(holds(&store, &served, &mut raw.borrow_mut(), case)));
    run.unwrap_or_else(|failed| panic!("{failed}"));
    let report = runtime.block_on(store.verify_chain(&served.study.id)).unwrap();
    assert_eq!((report.rows, report.faults), (u64::from(CASES), vec![]));
}
