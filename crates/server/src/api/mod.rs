//! The wire: every type that a request or an answer is made of, typed once. The OpenAPI document, the checks of what comes in and the
//! pages' TypeScript are read from these.

mod auth;
mod integrity;
mod links;
mod lists;
mod problem;
mod refusals;
mod sessions;
mod studies;
mod versions;

pub use auth::{SignIn, SignedIn};
pub use integrity::IntegrityReport;
pub use kelir_house::versions::StudyVersion;
pub use kelir_study::trials::Answer;
pub use links::{Link, NewLink, Trying, VisitKind};
pub use lists::ListQuery;
pub use problem::{Problem, ProblemCode, StoredAnswer};
pub use sessions::{
    Acknowledgement, Completion, CreatedSession, Held, Known, NewSession, SessionState, SessionStatus,
    SizedStimuli, StimulusRef, Trial,
};
pub use studies::{Codebook, Display, Progress, Study, StudyList, StudyStatus, StudySummary, VersionList};
pub use versions::{Pooling, version_ref};

pub(crate) use refusals::{refusals, responses};
