//! A disk that is full for a while, and a database that another program holds for a while: people are put off, nothing is lost, and it goes on.

use super::crowd::Crowd;
use super::trouble::{Disk, Filler, Holder};
use super::victim::Victim;
use super::{Outcome, Plan, faults, judge};
use std::sync::atomic::Ordering::Relaxed;
use std::time::{Duration, Instant};

/// The disk that is filled: what a server wants to be free, and as much again.
const DISK_MB: usize = 64;
/// How long the trouble lasts: longer than a lock is waited for.
const TROUBLE: Duration = Duration::from_secs(8);
const WRITERS: usize = 8;

pub(super) fn fill(plan: &Plan) -> Result<Outcome, String> {
    let disk = Disk::mount(DISK_MB)?;
    crate::copy(&crate::small_data().path().join("."), &disk.outside());
    let mut victim = Victim::start_by(disk.folder(), &disk.enter())?;
    let (crowd, went) = write_through(plan, &victim, || Filler::fill(&disk.outside()));
    let ended = victim.terminate();
    let copy = tempfile::tempdir().map_err(|error| error.to_string())?;
    crate::copy(&disk.outside().join("."), copy.path());
    let (_, mut wrong) = faults(copy.path(), &victim.log(), &crowd.ledger())?;
    wrong.extend(ended.err());
    Ok(told("a full disk", &crowd, went?, wrong))
}

pub(super) fn lock(plan: &Plan) -> Result<Outcome, String> {
    let data = crate::small_data();
    let victim = Victim::start(data.path())?;
    let (crowd, went) = write_through(plan, &victim, || Holder::lock(&victim.database()));
    let (_, wrong) = judge(victim, &crowd.ledger())?;
    Ok(told("a held database", &crowd, went?, wrong))
}

/// How it went around the trouble.
struct Went {
    /// Answers acknowledged before it and after it.
    before: usize,
    after: usize,
    /// From its end until the server called itself healthy.
    back: Duration,
}

/// People write before, while and after what `begin` brings about, and its result, dropped, takes away.
fn write_through<T>(
    plan: &Plan,
    victim: &Victim,
    begin: impl FnOnce() -> Result<T, String>,
) -> (Crowd, Result<Went, String>) {
    let crowd = Crowd::default();
    let went = std::thread::scope(|scope| {
        for n in 0..WRITERS {
            let (crowd, random, port) = (&crowd, plan.random(n), victim.port);
            scope.spawn(move || crowd.take_part(port, random));
        }
        let went = through(&crowd, victim, begin);
        crowd.stop();
        went
    });
    (crowd, went)
}

fn through<T>(
    crowd: &Crowd,
    victim: &Victim,
    begin: impl FnOnce() -> Result<T, String>,
) -> Result<Went, String> {
    std::thread::sleep(Duration::from_secs(1));
    let before = crowd.acknowledged();
    let trouble = begin()?;
    let begun = Instant::now();
    victim.wait_for("/healthz", 503)?;
    std::thread::sleep(TROUBLE.saturating_sub(begun.elapsed()));
    let during = crowd.acknowledged();
    drop(trouble);
    let ended = Instant::now();
    victim.wait_for("/healthz", 200)?;
    let back = ended.elapsed();
    std::thread::sleep(Duration::from_secs(1));
    Ok(Went { before, after: crowd.acknowledged() - during, back })
}

fn told(name: &str, crowd: &Crowd, went: Went, mut wrong: Vec<String>) -> Outcome {
    let put_off = crowd.put_off.load(Relaxed);
    if put_off == 0 {
        wrong.push("nobody was put off: nothing was tried".to_owned());
    }
    let Went { before, after, back } = went;
    if before == 0 || after == 0 {
        wrong.push(format!("{before} answers were acknowledged before it and {after} after it"));
    }
    wrong.extend(crowd.complaints());
    let (seconds, answers) = (TROUBLE.as_secs(), crowd.acknowledged());
    let did = format!(
        "{name} for {seconds} s: {answers} answers acknowledged, {put_off} requests put off, healthy again after {} ms",
        back.as_millis()
    );
    Outcome { did, wrong }
}
