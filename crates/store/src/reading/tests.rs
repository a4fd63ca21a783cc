#![allow(clippy::unwrap_used)]

use super::*;
use crate::{NewResponse, NewSession, PlannedSession, PlannedTrial};
use kelir_study::TrialPlan;

/// Three pairs over two conditions.
fn study(seed: u64) -> StudyDefinition {
    let text = format!(
        "title = \"t\"\nquestion = \"q\"\nseed = {seed}\nsize = [64, 36]\nestimated_minutes = 1\n\
         texts = {{ welcome = \"w\", consent = \"c\", instructions = \"i\", debriefing = \"d\", thanks = \"t\" }}\n\
         conditions = {{ pa = {{ technique = \"pa\" }}, mc = {{ technique = \"mc\" }} }}\n\
         [[blocks]]\nid = \"b\"\ntitle = \"t\"\nkind = \"still\"\nconditions = [\"pa\", \"mc\"]\ntarget = \"pa\"\n\
         pairs = [{{ id = \"x\", scene = \"a.toml\" }}, {{ id = \"y\", scene = \"a.toml\" }}, {{ id = \"z\", scene = \"a.toml\" }}]\n"
    );
    StudyDefinition::parse("small.toml", &text).unwrap()
}

/// Participants of two versions of a study answer in turn; each chooses and hesitates in a way of its own.
async fn take(store: &Store, people: usize) {
    let sha = store.put_stimulus("image/png", b"x".to_vec()).await.unwrap();
    let mut sessions = Vec::new();
    for i in 0..people {
        let study = study(1 + i as u64 % 2);
        store.put_study(&study).await.unwrap();
        let new = NewSession {
            study_id: study.id.clone(),
            config_hash: study.config_hash(),
            subject_id: None,
            token_hash: "t".to_owned(),
            params: serde_json::json!({}),
            display: serde_json::json!({}),
            idle: Duration::from_secs(60),
        };
        let plan = |slot| {
            let plan = TrialPlan::for_slot(&study, slot);
            let filled = |trial| PlannedTrial { trial, left_sha256: sha.clone(), right_sha256: sha.clone() };
            PlannedSession { seed: plan.seed, trials: plan.trials.into_iter().map(filled).collect() }
        };
        sessions.push(store.create_session(new, plan).await.unwrap());
    }
    for trial_index in 0..3u32 {
        for (i, session) in sessions.iter().enumerate() {
            let chose_left = (i * 7 + trial_index as usize).is_multiple_of(3);
            let rt_ms = 100.1 * (i + 1) as f64 + f64::from(trial_index);
            let new = NewResponse { trial_index, chose_left, rt_ms, payload: "{}".to_owned() };
            store.append_response(session, new).await.unwrap();
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_cursor_on_several_threads_reads_what_the_rows_say() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path()).await.unwrap();
    let study = study(1);
    let mut stored = StoredAnswers::new(&study);
    store.read_on(&mut stored).await.unwrap();
    assert!(stored.answers().is_empty());
    for people in [5, 8] {
        take(&store, people).await;
        // The other reader of the same rows: sqlx, whole rows, one thread.
        let rows = store.responses(&study.id, &study.config_hash()).await.unwrap();
        let mut expected = Answers::new(&study);
        for (row, _) in &rows {
            expected.push(Row {
                session_id: &row.session_id,
                item_id: &row.pair_id,
                left_condition: &row.left_condition,
                chose_left: row.choice == "left",
                rt_ms: row.rt_ms,
            });
        }
        assert_eq!(expected.len(), rows.len());
        store.read_on(&mut stored).await.unwrap();
        assert_eq!(stored.answers().participants(), expected.participants());
        for share in [1, 4, 1000] {
            let source = Source {
                database: folder.path().join(DATABASE),
                study_id: study.id.as_str().into(),
                config_hash: study.config_hash().into(),
                empty: Answers::new(&study),
            };
            let (through, parts) = source.read(0, share).unwrap();
            assert_eq!(through, stored.through);
            assert_eq!(
                parts.len() == 1,
                share == 1000 || std::thread::available_parallelism().unwrap().get() == 1
            );
            let mut whole = Answers::new(&study);
            parts.into_iter().for_each(|part| whole.append(part));
            assert_eq!(whole.participants(), expected.participants());
        }
    }
    // The negative control: the other version's answers are others.
    let mut other = StoredAnswers::new(&self::study(2));
    store.read_on(&mut other).await.unwrap();
    assert_ne!(other.answers().participants(), stored.answers().participants());
    assert_eq!(other.answers().len() + stored.answers().len(), 39);
}
