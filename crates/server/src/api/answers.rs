//! What is sent for one trial, as its kind asks. Keys beside these are kept as they come.

use kelir_study::trials::{TwoAlternativeAnswer, TwoIntervalAnswer};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The answer to a trial, as its kind asks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub enum Answer {
    /// To a two-alternative trial.
    TwoAlternative(TwoAlternativeAnswer),
    /// To a two-interval trial.
    TwoInterval(TwoIntervalAnswer),
}
