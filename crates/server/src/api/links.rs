//! Links by which a study is tried.

use kelir_house::links::Visit;
use kelir_study::schema::worded;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

worded! {
    /// What a link is for.
    pub enum Trying {
        /// Stored, counted apart, left out of every analysis.
        Pilot = "pilot",
        /// Nothing is stored.
        Preview = "preview",
    }
}

impl From<Trying> for Visit {
    fn from(trying: Trying) -> Visit {
        match trying {
            Trying::Pilot => Visit::Pilot,
            Trying::Preview => Visit::Preview,
        }
    }
}

/// A link that is asked for.
#[derive(Clone, Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct NewLink {
    /// What it is for.
    pub visit: Trying,
    /// For how many days it is good; 7 unless something else is said.
    #[schema(minimum = 1, maximum = 90)]
    pub days: Option<u32>,
}

/// A link by which a study may be tried by who has it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct Link {
    /// Path and query, below the server's address.
    pub path: String,
    /// When it ends, seconds since 1970.
    pub expires_at_s: u64,
}

/// What a visit to a study is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct VisitKind {
    /// What it is.
    pub visit: Visit,
}
