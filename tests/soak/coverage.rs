//! Chance against the report's intervals: simulated studies, whose truth is known, through the real binary.

use super::{Outcome, Plan};

/// Simulated studies of each interval in each cell, for each round of the plan.
const STUDIES: usize = 20;

pub(super) fn attack(plan: &Plan) -> Result<Outcome, String> {
    let (rounds, seed) = ((STUDIES * plan.rounds).to_string(), plan.seed.to_string());
    let ended = crate::kelir(&["bench", "coverage", "--rounds", &rounds, "--seed", &seed].map(str::to_owned));
    let (table, said) = (String::from_utf8_lossy(&ended.stdout), String::from_utf8_lossy(&ended.stderr));
    if !table.contains("on average") {
        return Err(format!("kelir bench coverage: {}", said.trim()));
    }
    let wrong = if ended.status.success() { Vec::new() } else { said.lines().map(str::to_owned).collect() };
    Ok(Outcome { did: format!("{rounds} studies a cell\n{}", table.trim_end()), wrong })
}
