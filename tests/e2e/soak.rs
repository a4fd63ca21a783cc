//! The attacks of `cargo xtask soak`, in small: each is tried, and the server holds.

use kelir_tests::small_data;
use kelir_tests::soak::crowd::Crowd;
use kelir_tests::soak::ledger::Stored;
use kelir_tests::soak::random::Random;
use kelir_tests::soak::victim::Victim;
use kelir_tests::soak::wire::Wire;
use kelir_tests::soak::{ATTACKS, Plan};

#[test]
fn attacks_in_small_find_nothing() {
    let plan =
        Plan { seed: 20_261_130, rounds: 3, writers: 8, people: 12, starts: 20, seconds: 1, idle: 100 };
    for (name, attack) in ATTACKS {
        // These take as long as what they wait for, and `trouble.rs` has them; of coverage four cells are among the statistics' own tests.
        if ["full", "lock", "coverage"].contains(&name) {
            continue;
        }
        let outcome = attack(&plan).unwrap();
        assert_eq!(outcome.wrong, [""; 0], "{name}: {}", outcome.did);
    }
}

#[test]
fn what_people_were_told_is_held_against_the_database() {
    let data = small_data();
    let mut victim = Victim::start(data.path()).unwrap();
    let crowd = Crowd::default();
    crowd.visit(&mut Wire::new(victim.port), &mut Random::new(1, 0)).unwrap();
    victim.terminate().unwrap();
    let (stored, told) = (Stored::read(&victim.database()).unwrap(), crowd.ledger().clone());
    assert_eq!((told.sessions.len(), told.codes.len(), told.answers.len()), (1, 1, stored.rows.len()));
    assert_eq!(stored.faults(&told), [""; 0]);
    // Negative controls: somebody was told something else.
    let mut other = told.clone();
    other.answers[0].2.push(' ');
    assert_eq!(stored.faults(&other).len(), 1);
    let mut other = told.clone();
    other.answers.push((told.sessions[0].clone(), 99, "{}".to_owned()));
    assert_eq!(stored.faults(&other).len(), 1);
    let mut other = told.clone();
    other.codes[0].1.push('x');
    assert_eq!(stored.faults(&other).len(), 1);
    let mut other = told;
    other.sessions.push("nobody".to_owned());
    assert_eq!(stored.faults(&other).len(), 1);
}
