//! Whether what is stored is whole.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// What the server found when it last looked at all that it stores.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct IntegrityReport {
    /// What is damaged and could not be mended, a sentence each; empty where all is well.
    pub faults: Vec<String>,
}
