//! `kill -9` at moments that nobody chose, while people write and another program reads the database.

use super::crowd::Crowd;
use super::ledger::rows;
use super::victim::Victim;
use super::{Outcome, Plan, judge};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

pub(super) fn attack(plan: &Plan) -> Result<Outcome, String> {
    let data = crate::small_data();
    let mut victim = Victim::start(data.path())?;
    let (crowd, done) = (Crowd::default(), AtomicBool::new(false));
    let (port, database) = (victim.port, victim.database());
    let (restarts, beside) = std::thread::scope(|scope| {
        for n in 0..plan.writers {
            let (crowd, random) = (&crowd, plan.random(n));
            scope.spawn(move || crowd.take_part(port, random));
        }
        let reader = scope.spawn(|| look(&database, &done));
        let mut random = plan.random(usize::MAX);
        let restarts: Result<Vec<Duration>, String> = (0..plan.rounds)
            .map(|_| {
                std::thread::sleep(random.ms(100, 1000));
                victim.kill_and_restart()
            })
            .collect();
        std::thread::sleep(Duration::from_millis(300));
        crowd.stop();
        done.store(true, Relaxed);
        (restarts, reader.join().unwrap_or_else(|_| Err("the reader fell over".to_owned())))
    });
    let ledger = crowd.ledger().clone();
    let (stored, mut wrong) = judge(victim, &ledger)?;
    wrong.extend(crowd.complaints());
    let looks =
        beside.map_err(|fault| wrong.push(format!("read beside the server: {fault}"))).unwrap_or_default();
    let longest = restarts.map(|restarts| restarts.into_iter().max().unwrap_or_default());
    let longest = longest.map_err(|fault| wrong.push(fault)).unwrap_or_default();
    if ledger.answers.is_empty() {
        wrong.push("nothing was acknowledged: nothing was tried".to_owned());
    }
    let did = format!(
        "{} kills under {} writers: {} answers acknowledged, {} more stored, {} sessions, {} codes, {} requests cut off; {looks} looks from beside; back in at most {} ms",
        plan.rounds,
        plan.writers,
        ledger.answers.len(),
        stored.rows.len().saturating_sub(ledger.answers.len()),
        ledger.sessions.len(),
        ledger.codes.len(),
        crowd.cut_off.load(Relaxed),
        longest.as_millis(),
    );
    Ok(Outcome { did, wrong })
}

/// Counts answers again and again, each time by a program of its own: what has been seen once must never be gone.
fn look(database: &Path, done: &AtomicBool) -> Result<usize, String> {
    let (mut looks, mut seen) = (0, 0);
    while !done.load(Relaxed) {
        let counted = rows(
            database,
            "SELECT count(*) AS n, coalesce(max(seq), 0) AS last FROM answers WHERE study_id = 'small'",
        )?;
        let [n, last] = ["n", "last"]
            .map(|column| counted.first().and_then(|row| row[column].as_u64()).unwrap_or_default());
        if n < seen || n != last {
            return Err(format!("{n} answers up to number {last}, after {seen} were seen"));
        }
        (looks, seen) = (looks + 1, n);
        std::thread::sleep(Duration::from_millis(20));
    }
    Ok(looks)
}
