//! `cargo xtask soak`: every attack, one after the other, and a table of what came of it.
#![allow(clippy::print_stdout, reason = "its table is for a terminal")]

use kelir_tests::soak::{ATTACKS, Plan};
use std::process::ExitCode;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

const USAGE: &str = "soak [--seed N] [--rounds N] [--writers N] [--people N] [--starts N] [--seconds N] [--idle N] [ATTACK …]
attacks: kill, disorder, starts, fuzz, noise, full, lock, coverage; all of them where none is named. KELIR_BIN names the binary.";

fn main() -> ExitCode {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let mut plan =
        Plan { seed: now, rounds: 50, writers: 40, people: 300, starts: 200, seconds: 60, idle: 2000 };
    let named = match read(std::env::args().skip(1), &mut plan) {
        Ok(named) => named,
        Err(wrong) => {
            eprintln!("{wrong}\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    println!("{} with seed {}", kelir_tests::binary().display(), plan.seed);
    let mut held = true;
    for (name, attack) in ATTACKS {
        if !named.is_empty() && !named.iter().any(|known| known == name) {
            continue;
        }
        let begun = Instant::now();
        let (did, wrong) = match attack(&plan) {
            Ok(outcome) => (outcome.did, outcome.wrong),
            Err(fault) => ("could not be tried".to_owned(), vec![fault]),
        };
        held &= wrong.is_empty();
        let verdict = if wrong.is_empty() { "held" } else { "BROKE" };
        println!("{name:<9} {verdict:<5} {:>4} s  {did}", begun.elapsed().as_secs());
        for wrong in wrong {
            println!("          {wrong}");
        }
    }
    if held { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Reads options into the plan; answers the attacks that are named.
fn read(mut args: impl Iterator<Item = String>, plan: &mut Plan) -> Result<Vec<String>, String> {
    let mut named = Vec::new();
    while let Some(arg) = args.next() {
        let Some(option) = arg.strip_prefix("--") else {
            if ATTACKS.iter().all(|(name, _)| *name != arg) {
                return Err(format!("{arg}: no such attack"));
            }
            named.push(arg);
            continue;
        };
        let value = args.next().and_then(|value| value.parse::<u64>().ok());
        let value = value.ok_or_else(|| format!("{arg}: wants a whole number"))?;
        match option {
            "seed" => plan.seed = value,
            "seconds" => plan.seconds = value,
            "rounds" => plan.rounds = value as usize,
            "writers" => plan.writers = value as usize,
            "people" => plan.people = value as usize,
            // An even number: places of the design are mirrored in pairs.
            "starts" => plan.starts = value.next_multiple_of(2) as usize,
            "idle" => plan.idle = value as usize,
            _ => return Err(format!("{arg}: no such option")),
        }
    }
    Ok(named)
}
