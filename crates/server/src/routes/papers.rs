//! Published results to lay beside one's own.

use super::{Answered, Fresh};
use crate::api::{Problem, refusals};
use crate::extract::Researcher;
use kelir_stats::paper::{Replication, taylor_cameron};

refusals!(Paper: Unauthorized);

/// The survey of Taylor and Cameron, its three tests computed again.
#[utoipa::path(
    get, path = "/api/v1/papers/taylor-cameron", tag = "results", security(("researcher" = [])),
    responses((status = OK, description = "The tests, from the paper's own counts.", body = Replication), Paper)
)]
pub(crate) async fn get_taylor_cameron(_: Researcher) -> Answered<Replication> {
    taylor_cameron().map(Fresh).map_err(Problem::internal)
}
