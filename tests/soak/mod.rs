//! Attacks on a served kelir, from outside and on this machine alone, and on what its reports say: `cargo xtask soak`.

mod coverage;
pub mod crowd;
mod disorder;
mod fuzz;
mod hostile;
mod kill;
pub mod ledger;
mod noise;
pub mod random;
mod room;
mod starts;
pub mod trouble;
pub mod victim;
pub mod wire;

use ledger::{Ledger, Stored};
use random::Random;
use std::path::Path;
use victim::Victim;

/// How much of everything.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What all chance comes from.
    pub seed: u64,
    /// `kill -9`s; simulated studies are twenty times as many in each cell.
    pub rounds: usize,
    /// People who write at once.
    pub writers: usize,
    /// People who do everything in the wrong order.
    pub people: usize,
    /// People who begin at the same moment, in as many places of the design; an even number.
    pub starts: usize,
    /// Seconds of hostile requests.
    pub seconds: u64,
    /// Connections that say nothing.
    pub idle: usize,
}

/// What an attack did, and what it found.
#[derive(Debug)]
pub struct Outcome {
    /// What was done, in numbers; a table may follow.
    pub did: String,
    /// What must not be; empty where the server held.
    pub wrong: Vec<String>,
}

impl Plan {
    /// The numbers of one attacker.
    fn random(&self, stream: usize) -> Random {
        Random::new(self.seed, stream as u64)
    }
}

/// An attack: what could not even be tried is an error.
pub type Attack = fn(&Plan) -> Result<Outcome, String>;

/// All of them, by name.
pub const ATTACKS: [(&str, Attack); 8] = [
    ("kill", kill::attack),
    ("disorder", disorder::attack),
    ("starts", starts::attack),
    ("fuzz", fuzz::attack),
    ("noise", noise::attack),
    ("full", room::fill),
    ("lock", room::lock),
    ("coverage", coverage::attack),
];

/// What the database of a server that has ended, its log and kelir's own check of the chain have against what people were told.
fn faults(data: &Path, log: &str, ledger: &Ledger) -> Result<(Stored, Vec<String>), String> {
    let stored = Stored::read(&data.join("kelir.sqlite"))?;
    let mut faults = stored.faults(ledger);
    let check = ["chain", "check", "small", "--data", &*data.to_string_lossy()].map(str::to_owned);
    let check = crate::kelir(&check);
    if !check.status.success() {
        faults.push(format!("kelir chain check: {}", String::from_utf8_lossy(&check.stderr).trim()));
    }
    faults.extend(panics(log));
    Ok((stored, faults))
}

/// Lines of a log that no server should write.
fn panics(log: &str) -> Vec<String> {
    log.lines().filter(|line| line.contains("panicked at")).map(str::to_owned).collect()
}

/// Ends a server well and looks at all that it leaves.
fn judge(mut victim: Victim, ledger: &Ledger) -> Result<(Stored, Vec<String>), String> {
    let ended = victim.terminate();
    let (stored, mut faults) = faults(&victim.data, &victim.log(), ledger)?;
    faults.extend(ended.err());
    Ok((stored, faults))
}
