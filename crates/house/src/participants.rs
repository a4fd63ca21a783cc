//! Sessions as a table: one row each, with whether its answers are judged, and why not.

use crate::results::read;
use crate::selection::Selection;
use crate::table::Table;
use crate::versions::designs;
use kelir_store::{AnswerRow, Session, Store, StoreError};
use kelir_study::columns::{ParticipantColumns, SessionStatus, participants_codebook};
use kelir_study::visits::{Flag, Judged};
use serde::Deserialize;
use serde_json::Value;
use std::collections::{BTreeMap, HashMap};

/// What the analysis makes of a session.
#[derive(Clone, Debug, Default)]
pub(crate) struct Verdict {
    /// Whether its answers are judged.
    pub(crate) is_judged: bool,
    /// Why not, where there is a reason.
    pub(crate) reason: Option<String>,
    /// What was noticed of it.
    pub(crate) flags: Vec<Flag>,
}

/// What the analysis makes of each session of the chosen versions, by its id.
pub(crate) async fn verdicts(
    store: &Store,
    selection: &Selection,
) -> Result<HashMap<String, Verdict>, StoreError> {
    let answers = read(store, selection).await?;
    let visits = selection.visits(store).await?;
    let judged = Judged::of(&selection.study, &answers, &visits, &selection.include.0);
    let unanswered = || Verdict { reason: Some("no answers".to_owned()), ..Verdict::default() };
    let mut verdicts: HashMap<String, Verdict> =
        visits.iter().map(|visit| (visit.session_id.clone(), unanswered())).collect();
    for participant in &judged.judged {
        let verdict = Verdict { is_judged: true, ..Verdict::default() };
        verdicts.insert(participant.session_id.to_string(), verdict);
    }
    for (visit, why) in &judged.left_out {
        let verdict = Verdict { reason: Some(why.to_string()), ..Verdict::default() };
        verdicts.insert(visit.session_id.clone(), verdict);
    }
    for (session, flags) in &judged.flags {
        verdicts.entry((*session).to_owned()).or_default().flags = flags.clone();
    }
    Ok(verdicts)
}

/// What answers say of a session.
#[derive(Default)]
struct Answered {
    answers: u64,
    refresh_hz: Option<f64>,
    reload_count: Option<u64>,
}

impl Answered {
    fn add(&mut self, row: &AnswerRow) {
        let payload: Value =
            row.payload.as_deref().and_then(|text| serde_json::from_str(text).ok()).unwrap_or_default();
        self.answers += 1;
        self.refresh_hz = payload["refresh_hz"].as_f64().or(self.refresh_hz);
        self.reload_count = self.reload_count.max(payload["reload_count"].as_u64());
    }
}

/// One row for each session of the chosen versions, in the order they began.
///
/// # Errors
/// The store cannot be read.
pub async fn participants_table(store: &Store, selection: &Selection) -> Result<Table, StoreError> {
    let study = &selection.study;
    let mut answered = HashMap::<String, Answered>::new();
    for row in store.answer_rows(&study.id, &selection.versions).await? {
        answered.entry(row.session_id.clone()).or_default().add(&row);
    }
    let (designs, verdicts) = (designs(store, &study.id).await?, verdicts(store, selection).await?);
    let params = &study.session.params;
    let columns = participants_codebook(params);
    let mut rows = Vec::new();
    for session in store.sessions(&study.id, &selection.versions).await? {
        let trials = store.trials(&session.session_id).await?.len();
        let most = if session.more { study.most_trials() } else { trials };
        let sent = BTreeMap::<String, String>::deserialize(&session.params).unwrap_or_default();
        let answered = answered.remove(&session.session_id).unwrap_or_default();
        let verdict = verdicts.get(&session.session_id).cloned().unwrap_or_default();
        let named = study.session.identify(&sent).ok().flatten();
        let id_parameter = named.filter(|(_, id)| *id == session.subject_id).map(|(name, _)| name.to_owned());
        let flags: Vec<&str> = verdict.flags.iter().map(|flag| flag.as_str()).collect();
        let row = ParticipantColumns {
            id_parameter,
            session_kind: session.kind,
            status: status(&session),
            judged: verdict.is_judged.into(),
            reject_reason: verdict.reason,
            flags: flags.join(" "),
            percent_complete: 100.0 * answered.answers as f64 / most.max(1) as f64,
            answers: answered.answers,
            design_hash: designs.get(&session.version).cloned().unwrap_or_default(),
            duration_s: seconds(session.consented_at.as_deref(), session.completed_at.as_deref()),
            refresh_hz: answered.refresh_hz,
            reload_count: answered.reload_count,
            ..of_session(&session)
        };
        rows.push(row.cells(params, &sent, &columns));
    }
    Ok(Table { name: "participants", columns, rows })
}

/// How far a session is.
pub(crate) fn status(session: &Session) -> SessionStatus {
    match session.completed_at {
        Some(_) => SessionStatus::Completed,
        None => SessionStatus::InProgress,
    }
}

/// What is stored of a session; what its answers and the analysis say is still to be filled in.
pub(crate) fn of_session(session: &Session) -> ParticipantColumns {
    let session = session.clone();
    let row = ParticipantColumns {
        subject_id: session.subject_id,
        session_id: session.session_id,
        study_id: session.study_id,
        version: session.version,
        file_hash: session.file_hash,
        slot: session.slot,
        plan_seed: session.plan_seed,
        created_at: session.created_at,
        consented_at: session.consented_at,
        consent_sha256: session.consent_sha256,
        completed_at: session.completed_at,
        last_seen_at: session.last_seen_at,
        completion_code: session.completion_code,
        user_agent: session.user_agent,
        ..ParticipantColumns::default()
    };
    row.with_display(&session.display)
}

/// Seconds between two times; `None` where one of them is not there.
fn seconds(from: Option<&str>, to: Option<&str>) -> Option<f64> {
    let micros = |time: Option<&str>| kelir_store::micros(time?);
    Some((micros(to)? - micros(from)?) as f64 / 1e6)
}
