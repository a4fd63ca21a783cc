#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::{NewAnswer, NewSession, NextTrials, PlannedSession, PlannedTrial};
use kelir_fixtures as fixtures;
use kelir_study::TrialPlan;
use kelir_study::trials::Placed;
use std::path::Path;
use std::time::Duration;

/// Three items over two conditions, in two intervals where `seed` is even.
fn study(seed: u64) -> StudyDefinition {
    let trial = if seed.is_multiple_of(2) { "\"two-interval\"" } else { "\"two-alternative\"" };
    let items = fixtures::items(["x", "y", "z"], "a.toml");
    let block = fixtures::block("b", &[("trial", trial), ("items", &items)]);
    let text = fixtures::study(&[("seed", &seed.to_string())], [block]);
    StudyDefinition::parse("small.toml", &text).unwrap()
}

/// Participants of two versions of a study answer in turn; each chooses and hesitates in a way of its own.
async fn take(store: &Store, people: usize) {
    let mut sessions = Vec::new();
    for i in 0..people {
        let study = study(1 + i as u64 % 2);
        let new = NewSession {
            study_id: study.id.clone(),
            version: store.put_version(&study, &[]).await.unwrap(),
            file_hash: study.file_hash(),
            subject_id: None,
            token_hash: "t".to_owned(),
            kind: Default::default(),
            flags: Vec::new(),
            repeat: Default::default(),
            start_key: None,
            user_agent: None,
            params: serde_json::json!({}),
            display: serde_json::json!({}),
            idle: Duration::from_secs(60),
        };
        let hashes = crate::StimulusHashes { sha256: "s".to_owned(), pixels_sha256: "p".to_owned() };
        let planned = study.clone();
        let plan = move |slot| {
            let plan = TrialPlan::for_slot(&planned, slot);
            let stimuli =
                |trial: &kelir_study::Trial| trial.shown.keys().map(|role| (*role, hashes.clone())).collect();
            let filled = |trial| PlannedTrial { stimuli: stimuli(&trial), trial, larger: Vec::new() };
            let trials = plan.trials.into_iter().map(filled).collect();
            Ok::<_, StoreError>(PlannedSession { seed: plan.seed, next: NextTrials { trials, more: false } })
        };
        sessions.push((
            study.blocks[0].trial.rules(),
            store.create_session(new, plan).await.unwrap().session().unwrap(),
        ));
    }
    for trial_index in 0..3u32 {
        for (i, (rules, session)) in sessions.iter().enumerate() {
            let chose_first = (i * 7 + trial_index as usize).is_multiple_of(3);
            let sent = rules.simulate(chose_first, 100.1 * (i + 1) as f64 + f64::from(trial_index));
            let answer = rules.check(&sent).unwrap().answer;
            let new = NewAnswer { trial_index, answer, payload: sent.to_string(), stimulus_size: None };
            let nothing = |_| Ok::<_, StoreError>(NextTrials::default());
            store.append_answer(session, &new, nothing).await.unwrap();
        }
    }
}

/// The other reader of the same rows: sqlx, whole rows, one thread.
async fn as_rows_say(store: &Store, study: &StudyDefinition, versions: &[String], chain: u32) -> Answers {
    let rows = store.answer_rows(&study.id, versions).await.unwrap();
    let rows: Vec<_> = rows.into_iter().filter(|row| row.chain == chain).collect();
    let mut answers = Answers::new(study);
    for row in &rows {
        let placed = |shown: &crate::ShownStimulus| Placed {
            item: shown.item.clone().into(),
            condition: shown.condition.clone().into(),
        };
        let shown: Shown<'_> = row.shown.iter().map(|(role, shown)| (*role, placed(shown))).collect();
        let rules = rules(&row.trial_kind).unwrap();
        let observation = rules.observe(&shown, row.answer.as_deref().unwrap()).unwrap();
        answers.push(Row {
            session_id: &row.session_id,
            trial_index: row.trial_index,
            observation,
            received_us: micros(&row.received_at),
        });
    }
    assert_eq!(answers.len(), rows.len());
    answers
}

/// Reads a chain in shares of several sizes; answers the number of its last row.
fn read_in_shares(
    chain: &Chain,
    folder: &Path,
    study: &StudyDefinition,
    versions: &[String],
    expected: &Answers,
) -> i64 {
    let source = Source {
        database: folder.join(DATABASE),
        study_id: study.id.as_str().into(),
        versions: versions.into(),
        empty: Answers::new(study),
    };
    let alone = std::thread::available_parallelism().unwrap().get() == 1;
    let mut last = 0;
    for share in [1, 4, 1000] {
        let (through, parts) = source.read(chain, 0, share).unwrap();
        assert_eq!(parts.len() == 1, share == 1000 || alone);
        let mut whole = Answers::new(study);
        parts.into_iter().for_each(|part| whole.append(part));
        assert_eq!(whole.participants(), expected.participants());
        // From the middle on there is less.
        let (_, rest) = source.read(chain, through / 2, share).unwrap();
        let rest: usize = rest.iter().map(Answers::len).sum();
        assert!(rest < expected.len());
        assert!(source.read(chain, through, share).unwrap().1.is_empty());
        last = through;
    }
    last
}

#[tokio::test(flavor = "multi_thread")]
async fn a_cursor_on_several_threads_reads_what_the_rows_say() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path()).await.unwrap();
    let study = study(1);
    let versions = [store.put_version(&study, &[]).await.unwrap()];
    let mut stored = StoredAnswers::new(&study, &versions);
    store.read_on(&mut stored).await.unwrap();
    assert!(stored.answers().is_empty());
    for people in [5, 8] {
        take(&store, people).await;
        store.read_on(&mut stored).await.unwrap();
        let expected = as_rows_say(&store, &study, &versions, 2).await;
        assert_eq!(stored.answers().participants(), expected.participants());
        let last = read_in_shares(&SECOND, folder.path(), &study, &versions, &expected);
        assert_eq!([0, last], stored.through);
    }
    // The negative control: the other version's answers are others.
    let other = self::study(2);
    let mut others = StoredAnswers::new(&other, &[store.put_version(&other, &[]).await.unwrap()]);
    store.read_on(&mut others).await.unwrap();
    assert_ne!(others.answers().participants(), stored.answers().participants());
    assert_eq!(others.answers().len() + stored.answers().len(), 39);
    // Pooled, they are all of them.
    let both = [versions[0].clone(), others.versions[0].clone()];
    let mut pooled = StoredAnswers::new(&study, &both);
    store.read_on(&mut pooled).await.unwrap();
    assert_eq!(pooled.answers().len(), 39);
}

#[tokio::test(flavor = "multi_thread")]
async fn the_first_chain_is_read_as_its_rows_say() {
    let fixture = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures/944eaa2/changed");
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(fixture.join(DATABASE), folder.path().join(DATABASE)).unwrap();
    let store = Store::open(folder.path()).await.unwrap();
    let versions = store.study_versions("small").await.unwrap();
    let study = &versions[0].study;
    let hashes: Vec<String> = versions.iter().map(|version| version.version.clone()).collect();
    let mut answers = 0;
    for versions in [&hashes[..1], &hashes[1..], &hashes[..]] {
        let expected = as_rows_say(&store, study, versions, 1).await;
        assert_eq!(read_in_shares(&FIRST, folder.path(), study, versions, &expected), 20);
        answers += expected.len();
    }
    assert_eq!(answers, 2 * 20, "each version alone, and both");
    let mut stored = StoredAnswers::new(study, &hashes);
    store.read_on(&mut stored).await.unwrap();
    assert_eq!((stored.through, stored.answers().len()), ([20, 0], 20));
}
