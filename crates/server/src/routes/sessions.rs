//! Taking part: a session from its beginning to its code. Conditions never leave the server.

use super::plans::{TrialPath, next_of, plan_of, trials_of};
use super::studies::{StudyPath, told};
use super::{Answered, Fresh, links, previews};
use crate::api::{
    Acknowledgement, Answer, Completion, CreatedSession, Held, Known, NewSession, Problem, ProblemCode,
    SessionState, SessionStatus, refusals,
};
use crate::app::App;
use crate::extract::{Body, Claim, ClientAddress, Object, Parameters, Participant, Query, SignedIn};
use crate::loaded::idle;
use crate::password::random_code;
use crate::presenting::Whose;
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode, header};
use kelir_house::links::{Visit, is_of_link};
use kelir_house::random_token;
use kelir_store::{
    Appended, Begun, Completed, Progress, SentAnswer, Session, SessionKind, StoreError, Taken, sha256_hex,
};
use kelir_study::visits::Flag;
use kelir_study::{StudyDefinition, trials};
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;
use utoipa::IntoParams;

/// Sessions that are begun at one address within ten minutes before the next is flagged: a class in a laboratory is fewer.
const MOST_STARTS: usize = 30;

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Path)]
pub(crate) struct SessionPath {
    /// The session's id.
    #[expect(dead_code, reason = "`Participant` reads it, with the token")]
    session: String,
}

refusals!(NotCreated: InvalidParameter, Unauthorized, LinkRefused, AlreadyBegun, AlreadyFinished, NotFound, NotReady, StimuliFailed, BadBody, BadJson, NotJson, TooLarge, InvalidField);

/// Begin a session. The answer holds its token, which is told this once.
///
/// Where somebody with the same id has begun before, the study file says what happens: another session begins, flagged; the one that is there
/// goes on, with a new token in place of the old one; or none does.
///
/// A reply can be lost: the same `Idempotency-Key` gives the session that it began again, with a new token in place of the old one, while it has
/// no consent yet; then `already_begun`.
#[utoipa::path(
    post, path = "/api/v1/studies/{study}/sessions", tag = "participants", request_body = NewSession,
    params(StudyPath, ("Idempotency-Key" = Option<String>, Header, description = "The browser's own key of its wish to begin, 1 to 255 visible ASCII characters.")),
    responses((status = CREATED, description = "The session.", body = CreatedSession), NotCreated)
)]
pub(crate) async fn create_session(
    State(app): State<Arc<App>>,
    Parameters(StudyPath { study }): Parameters<StudyPath>,
    SignedIn(researcher): SignedIn,
    ClientAddress(address): ClientAddress,
    headers: HeaderMap,
    Body(new): Body<NewSession>,
) -> Result<(StatusCode, Fresh<CreatedSession>), Box<Problem>> {
    let loaded = app.study(&study)?;
    let served = loaded.ready()?;
    let token = random_token();
    let params = new.params.unwrap_or_default();
    let pairs: Vec<(String, String)> = params.clone().into_iter().collect();
    let visit = links::visit(&app, &loaded.study.id, &pairs, researcher.is_some())?;
    if visit == Visit::Preview {
        let begun = crate::loaded::Begun { study: loaded.study.clone(), stimuli: served.stimuli.clone() };
        let language = new.display.as_ref().and_then(|display| display.get("language")?.as_str());
        return Ok((StatusCode::CREATED, Fresh(previews::begin(&app, begun, language).await?)));
    }
    let is_pilot = visit == Visit::Pilot;
    let kind = if is_pilot { SessionKind::Pilot } else { new.kind.unwrap_or_default() };
    if kind != SessionKind::Participant && !is_pilot && researcher.is_none() {
        let detail = "Sign in first: a session that is no participant's is a researcher's.";
        return Err(Problem::new(ProblemCode::Unauthorized, detail));
    }
    let person = loaded.study.session.identify(&params).map_err(Problem::refused_id)?;
    let is_one_of_many =
        kind == SessionKind::Participant && app.starts.note(address, Instant::now()) > MOST_STARTS;
    let new = kelir_store::NewSession {
        study_id: loaded.study.id.clone(),
        version: served.version.clone(),
        file_hash: loaded.file_hash.clone(),
        subject_id: person.map(|(_, id)| id.to_owned()),
        token_hash: sha256_hex(token.as_bytes()),
        kind,
        flags: is_one_of_many.then(|| Flag::ManyStarts.as_str().to_owned()).into_iter().collect(),
        repeat: loaded.study.session.repeat,
        start_key: start_key(&headers)?,
        user_agent: user_agent(&headers),
        params: params.into_iter().filter(|(name, _)| !is_pilot || !is_of_link(name)).collect(),
        display: new.display.unwrap_or_default().into(),
        idle: idle(&loaded.study),
    };
    let study = loaded.study.clone();
    let plan = move |slot| plan_of(&study, &served.stimuli, slot);
    let session = match app.store.create_session(new, plan).await? {
        Begun::New(session) | Begun::Again(session) => session,
        Begun::Refused { is_finished } => return Err(taken(is_finished)),
        Begun::KeyUsed => {
            let detail =
                "The session that this key began has consent and goes on with the token that was told.";
            return Err(Problem::new(ProblemCode::AlreadyBegun, detail));
        }
    };
    let state = state_of(&app, &session).await?;
    Ok((StatusCode::CREATED, Fresh(CreatedSession { state, token })))
}

/// Why the person of a link does not begin anew. The code is told to nobody but the browser that holds the session's token: an id can be guessed.
fn taken(is_finished: bool) -> Box<Problem> {
    if is_finished {
        let detail = "This study has been finished with this link, and can be taken once. Its code is shown in the browser where it was finished.";
        return Problem::new(ProblemCode::AlreadyFinished, detail);
    }
    let detail = "This study has been begun with this link, and can be taken once. Please go on in the browser where it was begun.";
    Problem::new(ProblemCode::AlreadyBegun, detail)
}

/// The header of a browser's own key of its wish to begin.
const IDEMPOTENCY_KEY: &str = "Idempotency-Key";

fn start_key(headers: &HeaderMap) -> Result<Option<String>, Box<Problem>> {
    let Some(sent) = headers.get(IDEMPOTENCY_KEY) else { return Ok(None) };
    let bytes = sent.as_bytes();
    if (1..=255).contains(&bytes.len()) && bytes.iter().all(u8::is_ascii_graphic) {
        return Ok(Some(String::from_utf8_lossy(bytes).into_owned()));
    }
    let text = String::from_utf8_lossy(bytes);
    Err(Problem::parameter(IDEMPOTENCY_KEY, &text, "must be 1 to 255 visible ASCII characters"))
}

/// What the browser calls itself, at most 512 characters of it.
fn user_agent(headers: &HeaderMap) -> Option<String> {
    let sent = String::from_utf8_lossy(headers.get(header::USER_AGENT)?.as_bytes());
    Some(sent.chars().filter(|c| !c.is_control()).take(512).collect())
        .filter(|name: &String| !name.is_empty())
}

refusals!(NoSession: Unauthorized, NotFound);
refusals!(NoState: Unauthorized, NotFound, InvalidParameter);

/// Where a session stands; asking keeps its place in the design.
///
/// Who comes back so late that somebody else has got that place, and has answered nothing yet, takes another one, with other trials.
#[utoipa::path(
    get, path = "/api/v1/sessions/{session}", tag = "participants", security(("session" = [])), params(SessionPath, Held),
    responses((status = OK, description = "The session.", body = SessionState), NoState)
)]
pub(crate) async fn get_session(
    Participant(session): Participant,
    State(app): State<Arc<App>>,
    Query(held): Query<Held>,
) -> Answered<SessionState> {
    if held.unsent.unwrap_or_default() > 0 {
        app.store.touch_session(&session.session_id).await?;
        return Ok(Fresh(state_of(&app, &session).await?));
    }
    let crate::loaded::Begun { study, stimuli } = app.begun(&session).await?;
    let idle = idle(&study);
    let plan = move |slot| plan_of(&study, &stimuli, slot);
    let session = app.store.resume(&session, idle, plan).await?;
    Ok(Fresh(state_of(&app, &session).await?))
}

/// Give consent; the first time counts.
#[utoipa::path(
    post, path = "/api/v1/sessions/{session}/consent", tag = "participants", security(("session" = [])), params(SessionPath),
    responses((status = OK, description = "The session.", body = SessionState), NoSession)
)]
pub(crate) async fn give_consent(
    Participant(session): Participant,
    State(app): State<Arc<App>>,
) -> Answered<SessionState> {
    let crate::loaded::Begun { study, stimuli } = app.begun(&session).await?;
    // The text that was read, in the language in which it was.
    let text = study.texts_in(language(&study, &session)).consent.join("\n\n");
    let idle = idle(&study);
    let plan = move |slot| plan_of(&study, &stimuli, slot);
    let session = app.store.consent(&session, &sha256_hex(text.as_bytes()), idle, plan).await?;
    Ok(Fresh(state_of(&app, &session).await?))
}

refusals!(NotStored: Unauthorized, NotFound, InvalidParameter, BadBody, BadJson, NotJson, TooLarge, InvalidField, NoConsent, AlreadyAnswered, PlanChanged);

/// Answer a trial. The same answer may be sent again; another one is refused, and the first one stands.
///
/// Only the choice is asked of an answer: whatever else is in it is kept as it comes, and what breaks a rule of the schema is named in the
/// responses' `flags` and stands in no other column. An acknowledgement means that the answer is on disk.
#[utoipa::path(
    put, path = "/api/v1/sessions/{session}/trials/{trial_index}", tag = "participants", security(("session" = [])),
    params(TrialPath, Known), request_body = Answer,
    responses((status = OK, description = "It is stored.", body = Acknowledgement), NotStored)
)]
pub(crate) async fn put_answer(
    claim: Claim,
    State(app): State<Arc<App>>,
    Parameters(TrialPath { trial_index, .. }): Parameters<TrialPath>,
    Query(known): Query<Known>,
    body: Object,
) -> Answered<Acknowledgement> {
    let no_trial = || Problem::not_found("trial");
    // Plain digits alone: "+1" and "01" are other addresses, not other names of a trial.
    let index = trial_index.parse().ok().filter(|i: &u32| i.to_string() == trial_index);
    let Known { known, plan } = known;
    let known = known.map(|known| u32::try_from(known).unwrap_or(u32::MAX));
    let Object { value, text } = body;
    let sent = SentAnswer {
        session_id: claim.session_id.clone(),
        trial_index: index.ok_or_else(no_trial)?,
        payload: text,
        known,
        plan,
    };
    let (claim, value) = (Arc::new(claim), Arc::new(value));
    let taken = match take(&app, &claim, &sent, &value).await {
        Err(Turned::Unloaded(session)) => {
            app.begun(&session).await?;
            take(&app, &claim, &sent, &value).await
        }
        taken => taken,
    };
    let taken = taken?;
    match taken.appended {
        Appended::Stored | Appended::Same => {}
        Appended::Different(stored) => {
            let detail = "This trial has an answer already; the first one stands.";
            let mut problem = Problem::new(ProblemCode::AlreadyAnswered, detail);
            problem.stored = Some((*stored).into());
            return Err(problem);
        }
        Appended::NoSuchTrial => return Err(no_trial()),
        Appended::OtherPlan => {
            let detail =
                "The session has another plan by now: what was answered is not what its trial shows.";
            return Err(Problem::new(ProblemCode::PlanChanged, detail));
        }
    }
    let mut trials = Vec::new();
    if !taken.trials.is_empty() {
        let (session, study) = (&taken.session, app.begun(&taken.session).await?.study);
        trials = trials_of(&app, Whose::of(session), &study, &taken.trials, &taken.answered).await?;
    }
    let (next_trial, more) = (taken.next_trial, taken.more);
    Ok(Fresh(Acknowledgement { acknowledged: true, next_trial, more, trials }))
}

/// Why an answer is not taken.
enum Turned {
    Away(Box<Problem>),
    /// What the session began with has to be read first: the one writer waits for no reader.
    Unloaded(Box<Session>),
}

impl From<StoreError> for Turned {
    fn from(error: StoreError) -> Turned {
        Turned::Away(error.into())
    }
}

impl From<Turned> for Box<Problem> {
    fn from(turned: Turned) -> Box<Problem> {
        match turned {
            Turned::Away(problem) => problem,
            Turned::Unloaded(_) => Problem::internal("what a session began with does not stay in memory"),
        }
    }
}

/// Takes an answer in one job of the writer: who sends it, whether it may be stored, what follows from it.
async fn take(
    app: &Arc<App>,
    claim: &Arc<Claim>,
    sent: &SentAnswer,
    value: &Arc<Value>,
) -> Result<Taken, Turned> {
    let (claim, value, deciding) = (claim.clone(), value.clone(), app.clone());
    let admit = move |session| {
        let session = claim.admit(session).map_err(Turned::Away)?;
        if session.consented_at.is_none() {
            let detail = "An answer can be stored only after consent.";
            return Err(Turned::Away(Problem::new(ProblemCode::NoConsent, detail)));
        }
        Ok(session)
    };
    // Before the one writer's turn, where the page says which kind of trial it answers.
    let said = value.get("trial_type").and_then(Value::as_str).and_then(trials::rules);
    let checked = said.map(|rules| (rules.name(), rules.check(&value)));
    let check = move |trial: &kelir_study::Trial| {
        let refused = |errors| Turned::Away(Problem::fields(ProblemCode::InvalidField, errors));
        let rules = trial.trial.rules();
        let checked = checked.filter(|(name, _)| *name == rules.name()).map(|(_, checked)| checked);
        checked.unwrap_or_else(|| rules.check(&value)).map_err(refused)
    };
    let next = move |session: &Session, progress: Progress| {
        let unloaded = || Turned::Unloaded(Box::new(session.clone()));
        let begun = deciding.begun_here(session).ok_or_else(unloaded)?;
        next_of(&begun, session.slot, &progress).map_err(Turned::Away)
    };
    app.store.take_answer(sent.clone(), admit, check, next).await
}

/// Answer a trial, where what lies between browser and server lets no PUT pass: the same as PUT.
#[utoipa::path(
    post, path = "/api/v1/sessions/{session}/trials/{trial_index}", tag = "participants", security(("session" = [])),
    params(TrialPath, Known), request_body = Answer,
    responses((status = OK, description = "It is stored.", body = Acknowledgement), NotStored)
)]
pub(crate) async fn post_answer(
    claim: Claim,
    app: State<Arc<App>>,
    address: Parameters<TrialPath>,
    known: Query<Known>,
    body: Object,
) -> Answered<Acknowledgement> {
    put_answer(claim, app, address, known, body).await
}

refusals!(NotComplete: Unauthorized, NotFound, Incomplete);

/// Finish a session whose every trial is stored; the code is the same each time.
#[utoipa::path(
    post, path = "/api/v1/sessions/{session}/completion", tag = "participants", security(("session" = [])), params(SessionPath),
    responses((status = OK, description = "The end.", body = Completion), NotComplete)
)]
pub(crate) async fn complete_session(
    Participant(session): Participant,
    State(app): State<Arc<App>>,
) -> Answered<Completion> {
    let study = app.begun(&session).await?.study;
    let code = study.completion.code.clone().unwrap_or_else(|| {
        let code = random_code(8);
        format!("{}-{}", &code[..4], &code[4..])
    });
    match app.store.complete(&session, &code).await? {
        Completed::Code(code) => Ok(Fresh(completion(&study, &session, code))),
        Completed::Missing(missing) => {
            let detail = match missing.len() {
                0 => "More trials follow from the answers.".to_owned(),
                1 => "1 trial has no answer yet.".to_owned(),
                n => format!("{n} trials have no answer yet."),
            };
            let mut problem = Problem::new(ProblemCode::Incomplete, detail);
            (problem.missing, problem.more) = (Some(missing), Some(session.more));
            Err(problem)
        }
    }
}

async fn state_of(app: &App, session: &Session) -> Result<SessionState, Box<Problem>> {
    let study = app.begun(session).await?.study;
    let answered = app.store.answered(&session.session_id).await?;
    // Read before its trials: where they are decided anew between the two, answers to the new ones are refused, and none is taken for another's.
    let plan = app.store.plan(&session.session_id).await?;
    let planned = app.store.trials(&session.session_id).await?;
    let trials = trials_of(app, Whose::of(session), &study, &planned, &answered).await?;
    let status = match (&session.completed_at, &session.consented_at) {
        (Some(_), _) => SessionStatus::Completed,
        (None, Some(_)) => SessionStatus::InProgress,
        (None, None) => SessionStatus::Consent,
    };
    let end = session.completion_code.clone().map(|code| completion(&study, session, code));
    let (completion_code, redirect) = end.map(|end| (end.completion_code, end.redirect)).unzip();
    Ok(SessionState {
        session_id: session.session_id.clone(),
        study_id: session.study_id.clone(),
        study: told(&study),
        language: language(&study, session).to_owned(),
        status,
        named: session.subject_id != session.session_id,
        consented: session.consented_at.is_some(),
        plan,
        more: session.more,
        most_trials: if session.more { study.most_trials() } else { trials.len() },
        next_trial: trials.iter().find(|trial| !trial.answered).map(|trial| trial.trial_index),
        trials,
        completion_code,
        redirect: redirect.flatten(),
    })
}

/// The language in which a session is taken.
fn language<'a>(study: &'a StudyDefinition, session: &'a Session) -> &'a str {
    study.language_for(session.display.get("language").and_then(Value::as_str))
}

fn completion(study: &StudyDefinition, session: &Session, completion_code: String) -> Completion {
    let params = BTreeMap::deserialize(&session.params).unwrap_or_default();
    Completion { redirect: study.completion.redirect_to(&completion_code, &params), completion_code }
}
