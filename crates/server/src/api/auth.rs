//! Signing in.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// What signs a researcher in.
#[derive(Clone, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct SignIn {
    /// The researcher's password, as in the data folder's `researcher-password`.
    #[schema(max_length = 1024, format = Password, write_only)]
    pub password: String,
}

/// Who is signed in.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct SignedIn {
    /// The researcher's name.
    pub name: String,
}
