//! A store with a small study and sessions in it.

use kelir_store::{NewResponse, NewSession, PlannedSession, PlannedTrial, Session, Store};
use kelir_study::{StudyDefinition, TrialPlan};
use serde_json::json;
use std::time::Duration;
use tempfile::TempDir;

const STUDY: &str = r#"
title = "Small"
question = "Which?"
seed = 3
size = [64, 36]
estimated_minutes = 1
texts = { welcome = "w", consent = "c", instructions = "i", debriefing = "d", thanks = "t" }
conditions = { pa = { technique = "pa" }, mc = { technique = "mc" } }
[[blocks]]
id = "stills"
title = "Stills"
kind = "still"
conditions = ["pa", "mc"]
target = "pa"
pairs = [{ id = "a", scene = "a.toml" }, { id = "b", scene = "b.toml" }, { id = "c", scene = "c.toml" }]
"#;

pub async fn open() -> (TempDir, Store) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path()).await.unwrap();
    store.put_study(&study()).await.unwrap();
    (folder, store)
}

pub fn study() -> StudyDefinition {
    StudyDefinition::parse("small.toml", STUDY).unwrap()
}

/// Begins a session; sessions not seen for `idle` give up their slots.
pub async fn begin(store: &Store, idle: Duration) -> Session {
    let study = study();
    let left_sha256 = store.put_stimulus("image/png", b"left".to_vec()).await.unwrap();
    let right_sha256 = store.put_stimulus("image/png", b"right".to_vec()).await.unwrap();
    let new = NewSession {
        study_id: study.id.clone(),
        config_hash: study.config_hash(),
        subject_id: None,
        token_hash: "t".to_owned(),
        params: json!({}),
        display: json!({}),
        idle,
    };
    let plan = |slot| {
        let plan = TrialPlan::for_slot(&study, slot);
        let filled = |trial| PlannedTrial {
            trial,
            left_sha256: left_sha256.clone(),
            right_sha256: right_sha256.clone(),
        };
        PlannedSession { seed: plan.seed, trials: plan.trials.into_iter().map(filled).collect() }
    };
    store.create_session(new, plan).await.unwrap()
}

pub fn answer(trial_index: u32, chose_left: bool, rt_ms: f64) -> NewResponse {
    NewResponse { trial_index, chose_left, rt_ms, payload: format!("{{\"trial\":{trial_index}}}") }
}
