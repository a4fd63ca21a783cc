//! Looking at a study as participants will: the same answers as a session's, and nothing is stored.

use super::plans::{TrialPath, next_of, planned, trials_of};
use super::studies::told;
use super::{Answered, Fresh};
use crate::api::{
    Acknowledgement, Answer, Completion, CreatedSession, Known, Problem, ProblemCode, SessionState,
    SessionStatus, refusals,
};
use crate::app::App;
use crate::extract::{Object, Parameters, Query, Token};
use crate::loaded::Begun;
use crate::presenting::Whose;
use crate::previews::Preview;
use axum::extract::State;
use kelir_house::random_token;
use kelir_store::{PlannedTrial, sha256_hex};
use kelir_study::{StudyDefinition, TrialPlan};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::Arc;
use utoipa::IntoParams;

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Path)]
pub(crate) struct PreviewPath {
    /// The preview's id.
    session: String,
}

/// Begins a preview of a study as it is served now.
pub(super) async fn begin(
    app: &App,
    begun: Begun,
    language: Option<&str>,
) -> Result<CreatedSession, Box<Problem>> {
    // Each preview has a plan of its own, so that restarting shows other orders and sides.
    let slot =
        u32::from_le_bytes(uuid::Uuid::new_v4().into_bytes()[..4].try_into().unwrap_or_default()) >> 12;
    let TrialPlan { trials, more, .. } = TrialPlan::for_slot(&begun.study, slot);
    let token = random_token();
    let preview = Preview {
        token_hash: sha256_hex(token.as_bytes()),
        trials: planned(&begun.stimuli, trials)?,
        language: begun.study.language_for(language).to_owned(),
        begun,
        slot,
        more,
        consented: false,
        answers: BTreeMap::new(),
        is_finished: false,
    };
    let token_hash = preview.token_hash.clone();
    let id = app.previews.begin(preview);
    let state = app.previews.with(&id, &token_hash, |preview| state_of(&id, preview));
    let state = state.ok_or_else(|| Problem::internal("a preview is gone"))?;
    Ok(CreatedSession { state: state.told(app, &token_hash).await?, token })
}

fn gone() -> Box<Problem> {
    Problem::new(
        ProblemCode::Unauthorized,
        "This preview has ended, or the token is not its own. Please begin again.",
    )
}

refusals!(NoPreview: Unauthorized, NotFound);

/// Where a preview stands.
#[utoipa::path(
    get, path = "/api/v1/previews/{session}", tag = "participants", security(("session" = [])), params(PreviewPath),
    responses((status = OK, description = "The preview.", body = SessionState), NoPreview)
)]
pub(crate) async fn get_preview(
    State(app): State<Arc<App>>,
    Token(token): Token,
    Parameters(PreviewPath { session }): Parameters<PreviewPath>,
) -> Answered<SessionState> {
    let state =
        app.previews.with(&session, &token, |preview| state_of(&session, preview)).ok_or_else(gone)?;
    Ok(Fresh(state.told(&app, &token).await?))
}

/// Give consent in a preview.
#[utoipa::path(
    post, path = "/api/v1/previews/{session}/consent", tag = "participants", security(("session" = [])), params(PreviewPath),
    responses((status = OK, description = "The preview.", body = SessionState), NoPreview)
)]
pub(crate) async fn consent_preview(
    State(app): State<Arc<App>>,
    Token(token): Token,
    Parameters(PreviewPath { session }): Parameters<PreviewPath>,
) -> Answered<SessionState> {
    let consent = |preview: &mut Preview| {
        preview.consented = true;
        state_of(&session, preview)
    };
    let state = app.previews.with(&session, &token, consent).ok_or_else(gone)?;
    Ok(Fresh(state.told(&app, &token).await?))
}

refusals!(NotTaken: Unauthorized, NotFound, InvalidParameter, BadBody, BadJson, NotJson, TooLarge, InvalidField, NoConsent);

/// Answer a trial of a preview: checked as a session's, and stored nowhere.
#[utoipa::path(
    put, path = "/api/v1/previews/{session}/trials/{trial_index}", tag = "participants", security(("session" = [])),
    params(TrialPath, Known), request_body = Answer,
    responses((status = OK, description = "It was checked.", body = Acknowledgement), NotTaken)
)]
pub(crate) async fn answer_preview(
    State(app): State<Arc<App>>,
    Token(token): Token,
    Parameters(TrialPath { session, trial_index }): Parameters<TrialPath>,
    Query(known): Query<Known>,
    body: Object,
) -> Answered<Acknowledgement> {
    let answer = |preview: &mut Preview| {
        let index = trial_index.parse().ok().filter(|i: &u32| i.to_string() == trial_index);
        let planned = index.and_then(|index| preview.trials.get(index as usize));
        let trial = planned.ok_or_else(|| Problem::not_found("trial"))?.trial.clone();
        if !preview.consented {
            return Err(Problem::new(ProblemCode::NoConsent, "An answer can be given only after consent."));
        }
        let checked = trial.trial.rules().check(&body.value);
        let answer = checked.map_err(|errors| Problem::fields(ProblemCode::InvalidField, errors))?.answer;
        preview.answer(trial.trial_index, answer, next_of)?;
        let answered: Vec<u32> = preview.answers.keys().copied().collect();
        let from = known.known.unwrap_or(usize::MAX);
        let next_trial = preview.missing().first().copied();
        let ack = Acknowledgement { acknowledged: true, next_trial, more: preview.more, trials: Vec::new() };
        let new: Vec<PlannedTrial> = preview.trials.iter().skip(from).cloned().collect();
        Ok((ack, new, answered, preview.begun.study.clone()))
    };
    let taken = app.previews.with(&session, &token, answer).unwrap_or_else(|| Err(gone()));
    let (mut ack, new, answered, study) = taken?;
    let whose = Whose { session_id: &session, token_hash: &token };
    ack.trials = trials_of(&app, whose, &study, &new, &answered).await?;
    Ok(Fresh(ack))
}

refusals!(NotOver: Unauthorized, NotFound, Incomplete);

/// Finish a preview. Its code is none that a panel would take.
#[utoipa::path(
    post, path = "/api/v1/previews/{session}/completion", tag = "participants", security(("session" = [])), params(PreviewPath),
    responses((status = OK, description = "The end.", body = Completion), NotOver)
)]
pub(crate) async fn complete_preview(
    State(app): State<Arc<App>>,
    Token(token): Token,
    Parameters(PreviewPath { session }): Parameters<PreviewPath>,
) -> Answered<Completion> {
    let complete = |preview: &mut Preview| {
        let missing = preview.missing();
        if !missing.is_empty() || preview.more {
            let mut problem = Problem::new(ProblemCode::Incomplete, "Trials have no answer yet.");
            (problem.missing, problem.more) = (Some(missing), Some(preview.more));
            return Err(problem);
        }
        preview.is_finished = true;
        Ok(Fresh(end()))
    };
    app.previews.with(&session, &token, complete).unwrap_or_else(|| Err(gone()))
}

/// The end of every preview: it leads nowhere, so that no panel is told that somebody took part.
fn end() -> Completion {
    Completion { completion_code: "PREVIEW".to_owned(), redirect: None }
}

/// Where a preview stands, before its page is told what its trials show.
struct Untold {
    state: SessionState,
    trials: Vec<PlannedTrial>,
    answered: Vec<u32>,
    study: Arc<StudyDefinition>,
}

impl Untold {
    async fn told(self, app: &App, token_hash: &str) -> Result<SessionState, Box<Problem>> {
        let whose = Whose { session_id: &self.state.session_id, token_hash };
        let trials = trials_of(app, whose, &self.study, &self.trials, &self.answered).await?;
        Ok(SessionState { trials, ..self.state })
    }
}

fn state_of(id: &str, preview: &Preview) -> Untold {
    let study = &preview.begun.study;
    let answered: Vec<u32> = preview.answers.keys().copied().collect();
    let status = match (preview.is_finished, preview.consented) {
        (true, _) => SessionStatus::Completed,
        (false, true) => SessionStatus::InProgress,
        (false, false) => SessionStatus::Consent,
    };
    let state = SessionState {
        session_id: id.to_owned(),
        study_id: study.id.clone(),
        study: told(study),
        language: preview.language.clone(),
        status,
        named: false,
        consented: preview.consented,
        plan: None,
        more: preview.more,
        most_trials: if preview.more { study.most_trials() } else { preview.trials.len() },
        next_trial: preview.missing().first().copied(),
        trials: Vec::new(),
        completion_code: preview.is_finished.then(|| end().completion_code),
        redirect: None,
    };
    Untold { state, trials: preview.trials.clone(), answered, study: preview.begun.study.clone() }
}
