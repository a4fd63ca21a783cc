//! Taking part: a session from its beginning to its code. Conditions never leave the server.

use crate::app::App;
use crate::error::ApiError;
use crate::extract::{Object, Parameters, bearer};
use crate::password::{random_code, random_token};
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode};
use axum::response::Response;
use kelir_store::{
    Appended, Completed, NewResponse, NewSession, PlannedSession, PlannedTrial, Session, sha256_hex,
};
use kelir_study::{StudyDefinition, TrialPlan};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

/// Longest response time that is believed, in ms: a day.
const MAX_RT_MS: f64 = 86_400_000.0;

/// Parameters by which recruiting panels name their participants, in order of preference.
const SUBJECT_PARAMS: [&str; 4] = ["PROLIFIC_PID", "workerId", "subject_id", "id"];

pub(crate) async fn post_session(
    State(app): State<Arc<App>>,
    Parameters(study): Parameters<String>,
    body: Object,
) -> Result<Response, ApiError> {
    let loaded = app.study(&study)?;
    let stimuli = loaded.ready()?;
    body.only(&["params", "display"])?;
    let params = parameters(&body)?;
    let display = match body.0.get("display") {
        None | Some(Value::Null) => Map::new(),
        Some(Value::Object(display)) => display.clone(),
        Some(_) => return Err(ApiError::field("display", "must be an object")),
    };
    let token = random_token();
    let new = NewSession {
        study_id: loaded.study.id.clone(),
        config_hash: loaded.config_hash.clone(),
        subject_id: subject(&params),
        token_hash: sha256_hex(token.as_bytes()),
        params: json!(params),
        display: Value::Object(display),
        idle: Duration::from_secs(60 * u64::from(loaded.study.idle_minutes)),
    };
    let hash = |pair: &str, condition: &str| {
        stimuli.get(&(pair.to_owned(), condition.to_owned())).cloned().unwrap_or_default()
    };
    let plan = |slot| {
        let plan = TrialPlan::for_slot(&loaded.study, slot);
        let filled = |trial: kelir_study::Trial| PlannedTrial {
            left_sha256: hash(&trial.item_id, &trial.left),
            right_sha256: hash(&trial.item_id, &trial.right),
            trial,
        };
        PlannedSession { seed: plan.seed, trials: plan.trials.into_iter().map(filled).collect() }
    };
    let session = app.store.create_session(new, plan).await?;
    let mut state = state_of(&app, &session).await?;
    state["token"] = token.into();
    Ok(super::fresh(StatusCode::CREATED, state))
}

pub(crate) async fn get_session(
    State(app): State<Arc<App>>,
    Parameters(session): Parameters<String>,
    headers: HeaderMap,
) -> Result<Response, ApiError> {
    let session = authorised(&app, &session, &headers).await?;
    app.store.touch_session(&session.session_id).await?;
    Ok(super::fresh(StatusCode::OK, state_of(&app, &session).await?))
}

pub(crate) async fn post_consent(
    State(app): State<Arc<App>>,
    Parameters(session): Parameters<String>,
    headers: HeaderMap,
) -> Result<Response, ApiError> {
    let session = authorised(&app, &session, &headers).await?;
    app.store.consent(&session.session_id).await?;
    let session = authorised(&app, &session.session_id, &headers).await?;
    Ok(super::fresh(StatusCode::OK, state_of(&app, &session).await?))
}

pub(crate) async fn put_trial(
    State(app): State<Arc<App>>,
    Parameters((session, trial)): Parameters<(String, String)>,
    headers: HeaderMap,
    body: Object,
) -> Result<Response, ApiError> {
    let session = authorised(&app, &session, &headers).await?;
    let no_trial = || ApiError::not_found("trial");
    // Plain digits alone: "+1" and "01" are other addresses, not other names of a trial.
    let trial_index: u32 =
        trial.parse().ok().filter(|i: &u32| i.to_string() == trial).ok_or_else(no_trial)?;
    if session.consented_at.is_none() {
        return Err(ApiError::conflict("no_consent", "An answer can be stored only after consent."));
    }
    let chose_left = match body.string("choice")? {
        "left" => true,
        "right" => false,
        _ => return Err(ApiError::field("choice", "must be \"left\" or \"right\"")),
    };
    let rt_ms = body.number("rt", 0.0, MAX_RT_MS)?;
    check_columns(&body)?;
    let payload = Value::Object(body.0).to_string();
    let new = NewResponse { trial_index, chose_left, rt_ms, payload };
    match app.store.append_response(&session, new).await? {
        Appended::Stored | Appended::Same => {}
        Appended::Different => {
            let message = "This trial has an answer already; the first one stands.";
            return Err(ApiError::conflict("already_answered", message));
        }
        Appended::NoSuchTrial => return Err(no_trial()),
    }
    let answered = app.store.answered(&session.session_id).await?;
    let next_trial = next_trial(&session, &answered);
    Ok(super::fresh(StatusCode::OK, json!({ "acknowledged": true, "next_trial": next_trial })))
}

pub(crate) async fn post_complete(
    State(app): State<Arc<App>>,
    Parameters(session): Parameters<String>,
    headers: HeaderMap,
) -> Result<Response, ApiError> {
    let session = authorised(&app, &session, &headers).await?;
    let study = app.version(&session.study_id, &session.config_hash).await?;
    let code = study.completion.code.clone().unwrap_or_else(|| {
        let code = random_code(8);
        format!("{}-{}", &code[..4], &code[4..])
    });
    match app.store.complete(&session, &code).await? {
        Completed::Code(code) => Ok(super::fresh(StatusCode::OK, completion(&study, &session, &code))),
        Completed::Missing(missing) => {
            let message = format!("{} of {} trials have no answer yet.", missing.len(), session.trials.len());
            Err(ApiError::conflict("incomplete", &message).with("missing", json!(missing)))
        }
    }
}

/// The session, if the request holds its token. An unknown session and a wrong token look the same.
async fn authorised(app: &App, session_id: &str, headers: &HeaderMap) -> Result<Session, ApiError> {
    let token_hash = sha256_hex(bearer(headers).ok_or_else(ApiError::unauthorized)?.as_bytes());
    let session = app.store.session(session_id).await?.ok_or_else(ApiError::unauthorized)?;
    // Hashes of secrets: how long comparing takes says nothing about the secret.
    if session.token_hash == token_hash { Ok(session) } else { Err(ApiError::unauthorized()) }
}

async fn state_of(app: &App, session: &Session) -> Result<Value, ApiError> {
    let study = app.version(&session.study_id, &session.config_hash).await?;
    let answered = app.store.answered(&session.session_id).await?;
    let stimulus = |sha256: &str| json!({ "sha256": sha256, "url": format!("/stimuli/{sha256}") });
    let [width, height] = study.size;
    let trials: Vec<Value> = session
        .trials
        .iter()
        .map(|planned| {
            let trial = &planned.trial;
            json!({
                "trial_index": trial.trial_index,
                "block_id": trial.block_id,
                "block_index": trial.block_index,
                "pair_index": trial.item_index,
                "kind": trial.kind,
                "left": stimulus(&planned.left_sha256),
                "right": stimulus(&planned.right_sha256),
                "width": width,
                "height": height,
                "answered": answered.contains(&trial.trial_index),
            })
        })
        .collect();
    let status = match (&session.completed_at, &session.consented_at) {
        (Some(_), _) => "completed",
        (None, Some(_)) => "in_progress",
        (None, None) => "consent",
    };
    let mut state = json!({
        "session_id": session.session_id,
        "study_id": session.study_id,
        "status": status,
        "consented": session.consented_at.is_some(),
        "trials": trials,
        "next_trial": next_trial(session, &answered),
    });
    if let Some(code) = &session.completion_code {
        let Value::Object(more) = completion(&study, session, code) else { return Ok(state) };
        state.as_object_mut().into_iter().for_each(|state| state.extend(more.clone()));
    }
    Ok(state)
}

fn completion(study: &StudyDefinition, session: &Session, code: &str) -> Value {
    let params: BTreeMap<String, String> = serde_json::from_value(session.params.clone()).unwrap_or_default();
    match study.completion.redirect_to(code, &params) {
        Some(redirect) => json!({ "completion_code": code, "redirect": redirect }),
        None => json!({ "completion_code": code }),
    }
}

fn next_trial(session: &Session, answered: &[u32]) -> Option<u32> {
    (0..session.trials.len() as u32).find(|index| !answered.contains(index))
}

/// The address's parameters: at most 64 texts, names up to 64 and values up to 512 bytes.
fn parameters(body: &Object) -> Result<BTreeMap<String, String>, ApiError> {
    let map = match body.0.get("params") {
        None | Some(Value::Null) => return Ok(BTreeMap::new()),
        Some(Value::Object(map)) if map.len() <= 64 => map,
        Some(_) => return Err(ApiError::field("params", "must be an object of at most 64 texts")),
    };
    map.iter()
        .map(|(name, value)| match value.as_str() {
            Some(text) if name.len() <= 64 && text.len() <= 512 => Ok((name.clone(), text.to_owned())),
            _ => Err(ApiError::field(format!("params.{name}"), "must be a text of at most 512 bytes")),
        })
        .collect()
}

/// The panel's name for the participant; only what can stand in a file name and starts no spreadsheet formula.
fn subject(params: &BTreeMap<String, String>) -> Option<String> {
    let plain = |s: &&String| {
        (1..=128).contains(&s.len())
            && s.starts_with(|c: char| c.is_ascii_alphanumeric())
            && s.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_')
    };
    SUBJECT_PARAMS.iter().filter_map(|name| params.get(*name)).find(plain).cloned()
}

/// The columns that analyses read have the types they say; others are kept as they came.
fn check_columns(body: &Object) -> Result<(), ApiError> {
    for (key, high) in [
        ("onset", 1e12),
        ("time_elapsed", 1e12),
        ("scale", 100.0),
        ("device_pixel_ratio", 100.0),
        ("refresh_hz", 10_000.0),
        ("reload_count", 1e9),
        ("hidden_ms", 1e12),
    ] {
        body.optional_number(key, 0.0, high)?;
    }
    for key in ["trial_type", "plugin_version", "arrangement", "timestamp"] {
        body.optional_text(key, 100)?;
    }
    match body.0.get("input").map(Value::as_str) {
        None | Some(Some("mouse" | "touch" | "keyboard" | "pen")) => {}
        Some(_) => return Err(ApiError::field("input", "must be mouse, touch, pen or keyboard")),
    }
    match body.0.get("viewport") {
        None | Some(Value::Null) => Ok(()),
        Some(Value::Array(size))
            if size.len() == 2 && size.iter().all(|v| v.as_f64().is_some_and(|x| x >= 0.0)) =>
        {
            Ok(())
        }
        Some(_) => Err(ApiError::field("viewport", "must be [width, height]")),
    }
}
