//! Taking part: sessions, their trials, what is said back.

use super::Study;
use kelir_study::Kind;
use kelir_study::schema::worded;
use kelir_study::trials::{Role, TrialName, TrialSettings};
use kelir_study::visits::{ID_PARAMETERS, LONGEST_ID, SessionKind};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use utoipa::openapi::schema::{Object, ObjectBuilder, SchemaType, Type};
use utoipa::{IntoParams, ToSchema};

/// What is known of someone who begins.
#[derive(Clone, Debug, Default, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct NewSession {
    /// The parameters of the address that they came by.
    #[schema(schema_with = parameters)]
    pub params: Option<BTreeMap<String, String>>,
    /// What the browser says about its display; kept as it comes. `language` is the one in which the study is read.
    pub display: Option<Map<String, Value>>,
    /// Whose session it is; only who is signed in may begin one that is no participant's.
    pub kind: Option<SessionKind>,
}

/// At most 64 texts; the longest names and values that are taken.
fn parameters() -> Object {
    let text = |most| ObjectBuilder::new().schema_type(Type::String).max_length(Some(most));
    ObjectBuilder::new()
        .schema_type(SchemaType::from_iter([Type::Object, Type::Null]))
        .max_properties(Some(64))
        .property_names(Some(text(64)))
        .additional_properties(Some(text(1024)))
        .description(Some(format!(
            "The parameters of the address that they came by. The participant is named by the one that the study file says, or else by the \
             first that is there of {}; an id has at most {LONGEST_ID} bytes and no control characters.",
            ID_PARAMETERS.map(|name| format!("`{name}`")).join(", ")
        )))
        .build()
}

worded! {
    /// How far a session is.
    pub enum SessionStatus {
        /// Consent has not been given yet.
        Consent = "consent",
        /// Trials are being answered.
        InProgress = "in_progress",
        /// Every trial is stored and the code has been given.
        Completed = "completed",
    }
}

/// The bytes of one stimulus as this session gets them: what they hash to and where they are. Other sessions get other bytes and
/// addresses for the same picture.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct StimulusRef {
    /// SHA-256 of the bytes.
    pub sha256: String,
    /// Their address on this server; who knows it may have them.
    pub url: String,
}

/// One trial as the page needs it; its conditions stay on the server.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Trial {
    /// Place in the session, from 0.
    pub trial_index: u32,
    /// How it is shown and asked.
    pub trial: TrialName,
    /// Place of its block in the study, from 0.
    pub block_index: u32,
    /// Place of its item in the block's file order, from 0.
    pub item_index: u32,
    /// Stills or animations.
    pub kind: Kind,
    /// What is shown at the study's smallest size, by role: `left` and `right`, or `first` and `second`.
    pub shown: BTreeMap<Role, StimulusRef>,
    /// The same at each further size, by rising width; all stimuli of a trial are shown at one size.
    pub larger: Vec<SizedStimuli>,
    /// Settings of its kind; null for kinds that have none.
    #[schema(required)]
    pub settings: Option<TrialSettings>,
    /// Width in pixels of the smallest size.
    pub width: u32,
    /// Height in pixels of the smallest size.
    pub height: u32,
    /// Whether its answer is stored.
    pub answered: bool,
}

/// What a trial shows at one size.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct SizedStimuli {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// What is shown, by role.
    pub shown: BTreeMap<Role, StimulusRef>,
}

/// Where a session stands.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct SessionState {
    /// Its id (UUID v7).
    pub session_id: String,
    /// The study's id.
    pub study_id: String,
    /// The study as it was when the session began: its texts and its question stay the session's own.
    pub study: Study,
    /// The language in which it is taken: the `language` of the display that it began with where the study has it, else the study's own.
    pub language: String,
    /// How far it is.
    pub status: SessionStatus,
    /// Whether the link named the participant: who comes by it again is the same person.
    pub named: bool,
    /// Whether consent has been given.
    pub consented: bool,
    /// The trials that are decided so far, by index from 0. The list of a plan only grows.
    pub trials: Vec<Trial>,
    /// Which plan these are of: the session has another one where it was decided anew. Absent in a preview, whose plan stays.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub plan: Option<String>,
    /// Whether more trials will be decided, from the answers to these.
    pub more: bool,
    /// Most trials there can be.
    pub most_trials: usize,
    /// The first decided trial without an answer; null when there is none.
    #[schema(required)]
    pub next_trial: Option<u32>,
    /// The code at the end, once completed.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub completion_code: Option<String>,
    /// Where to go on to, once completed, if the study leads anywhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub redirect: Option<String>,
}

/// A session that has just begun.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct CreatedSession {
    /// Where it stands.
    #[serde(flatten)]
    pub state: SessionState,
    /// The session's secret, for `Authorization: Bearer`; it is told this once.
    pub token: String,
}

/// What a page that answers knows already.
#[derive(Clone, Debug, Default, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub struct Known {
    /// Number of trials that the page knows: those from this index on are told. Absent: none are.
    pub known: Option<usize>,
    /// The `plan` of the session that the trial was shown of. Where it has another one now, the answer is refused. Absent: it is taken to be of
    /// the one that it has.
    pub plan: Option<String>,
}

/// What a page that comes back holds.
#[derive(Clone, Copy, Debug, Default, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub struct Held {
    /// Number of answers that the page holds and has not sent yet: where there are any, the plan that they are of stays.
    pub unsent: Option<usize>,
}

/// That an answer is on disk.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Acknowledgement {
    /// Always true: what is not stored is refused.
    pub acknowledged: bool,
    /// The first decided trial without an answer; null when there is none.
    #[schema(required)]
    pub next_trial: Option<u32>,
    /// Whether more trials will be decided.
    pub more: bool,
    /// The decided trials from `known` on; none without `known`.
    pub trials: Vec<Trial>,
}

/// The end of a session.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Completion {
    /// The code that says so, the same each time.
    pub completion_code: String,
    /// Where to go on to, if the study leads anywhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub redirect: Option<String>,
}
