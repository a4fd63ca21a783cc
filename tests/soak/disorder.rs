//! People whose line is bad and who press everything: requests are dropped, repeated, sent out of order and with other answers, by several tabs.

use super::crowd::{Crowd, answer, told};
use super::random::Random;
use super::victim::Victim;
use super::wire::{Wire, ask, request};
use super::{Outcome, Plan, judge};
use serde_json::Value;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// People at once, each with three tabs.
const AT_ONCE: usize = 40;
/// Of a hundred requests so many are never heard of again.
const DROPPED: usize = 20;
const TABS: usize = 3;

pub(super) fn attack(plan: &Plan) -> Result<Outcome, String> {
    let data = crate::small_data();
    let victim = Victim::start(data.path())?;
    let (crowd, next) = (Crowd::default(), AtomicUsize::new(0));
    std::thread::scope(|scope| {
        for _ in 0..AT_ONCE.min(plan.people) {
            scope.spawn(|| {
                loop {
                    let n = next.fetch_add(1, Relaxed);
                    if n >= plan.people {
                        return;
                    }
                    if let Err(fault) = take_part(&crowd, victim.port, plan.random(n)) {
                        crowd.complain(fault);
                    }
                }
            });
        }
    });
    let ledger = crowd.ledger().clone();
    let (stored, mut wrong) = judge(victim, &ledger)?;
    wrong.extend(crowd.complaints());
    for (what, n) in [("sessions", stored.codes.len()), ("codes", ledger.codes.len())] {
        if n != plan.people {
            wrong.push(format!("{} people have {n} {what}", plan.people));
        }
    }
    let refused = crowd.refused.load(Relaxed);
    if refused == 0 {
        wrong.push("no answer was refused for another: nothing was tried".to_owned());
    }
    let did = format!(
        "{} people in disorder: {} answers acknowledged {} times, {refused} others refused",
        plan.people,
        stored.rows.len(),
        ledger.answers.len(),
    );
    Ok(Outcome { did, wrong })
}

fn take_part(crowd: &Crowd, port: u16, mut random: Random) -> Result<(), String> {
    let (mut wire, visit, trials) = begin(crowd, port, &mut random)?;
    let answers: Vec<(u32, String)> = (0..trials).map(|trial| (trial, answer(&mut random))).collect();
    let mut jobs = Vec::new();
    for (trial, mine) in &answers {
        jobs.extend(std::iter::repeat_n((*trial, mine.clone()), 1 + random.below(3)));
        if random.chance(50) {
            jobs.push((*trial, answer(&mut random)));
        }
    }
    random.shuffle(&mut jobs);
    let tab = |jobs: &[(u32, String)], mut random: Random| {
        let mut wire = Wire::new(port);
        jobs.iter().try_for_each(|(trial, sent)| visit.put(&mut wire, *trial, sent, &mut random, DROPPED))?;
        // Too soon, or not: whoever has answered everything gets the code.
        visit.send(&mut wire, "POST", "/completion", "", &[200, 409]).map(drop)
    };
    std::thread::scope(|scope| {
        let tabs: Vec<_> = jobs
            .chunks(jobs.len().div_ceil(TABS))
            .map(|jobs| (jobs, random.fork(), &tab))
            .map(|(jobs, random, tab)| scope.spawn(move || tab(jobs, random)))
            .collect();
        tabs.into_iter().try_for_each(|tab| tab.join().unwrap_or_else(|_| Err("a tab fell over".to_owned())))
    })?;
    // What was dropped was stored or was not: sent again, each trial has one answer.
    for (trial, mine) in &answers {
        visit.put(&mut wire, *trial, mine, &mut random, 0)?;
    }
    let codes = (0..3).map(|_| visit.send(&mut wire, "POST", "/completion", "", &[200]));
    let codes: BTreeSet<String> =
        codes.map(|end| end.map(|(_, end)| end["completion_code"].to_string())).collect::<Result<_, _>>()?;
    if codes.len() != 1 {
        return Err(format!("a session has the codes {codes:?}"));
    }
    let code = codes.iter().map(|code| code.trim_matches('"').to_owned());
    crowd.ledger().codes.extend(code.map(|code| (visit.id.clone(), code)));
    Ok(())
}

/// A session whose replies may be lost: asked for again, nothing begins twice.
fn begin<'a>(crowd: &'a Crowd, port: u16, random: &mut Random) -> Result<(Wire, Visit<'a>, u32), String> {
    let (mut wire, key) = (Wire::new(port), format!("{:x}", random.draw()));
    let headers = [("Content-Type", "application/json"), ("Idempotency-Key", key.as_str())];
    let begin = request("POST", "/api/v1/studies/small/sessions", &headers, Some(b"{}"));
    for _ in 0..random.below(3) {
        let _ = wire.abandon(&begin, random.ms(0, 4));
    }
    // The token that was told last is the one in force: what was abandoned must have been answered before.
    std::thread::sleep(random.ms(50, 60));
    let mut begun = wire.send(&begin).map_err(|error| error.to_string())?.json();
    let (id, token, trials) = told(&begun).ok_or_else(|| begun.take().to_string())?;
    crowd.ledger().sessions.push(id.clone());
    let visit = Visit { crowd, id, token };
    let consent = visit.request("POST", "/consent", "");
    let _ = wire.abandon(&consent, random.ms(0, 4));
    for _ in 0..2 {
        visit.send(&mut wire, "POST", "/consent", "", &[200])?;
    }
    Ok((wire, visit, trials))
}

/// A session as its tabs share it.
struct Visit<'a> {
    crowd: &'a Crowd,
    id: String,
    token: String,
}

impl Visit<'_> {
    fn request(&self, method: &str, rest: &str, body: &str) -> Vec<u8> {
        ask(method, &format!("/api/v1/sessions/{}{rest}", self.id), &self.token, body)
    }

    /// Sends an answer, or the half of it; `dropped` in a hundred are not waited for.
    fn put(
        &self,
        wire: &mut Wire,
        trial: u32,
        sent: &str,
        random: &mut Random,
        dropped: usize,
    ) -> Result<(), String> {
        let rest = format!("/trials/{trial}");
        if random.chance(dropped) {
            let _ = wire.abandon(&self.request("PUT", &rest, sent), random.ms(0, 4));
            return Ok(());
        }
        match self.send(wire, "PUT", &rest, sent, &[200, 409])?.0 {
            200 => self.crowd.ledger().answers.push((self.id.clone(), trial, sent.to_owned())),
            _ => drop(self.crowd.refused.fetch_add(1, Relaxed)),
        }
        Ok(())
    }

    /// A request that is to be answered with one of these.
    fn send(
        &self,
        wire: &mut Wire,
        method: &str,
        rest: &str,
        body: &str,
        wanted: &[u16],
    ) -> Result<(u16, Value), String> {
        let reply =
            wire.send(&self.request(method, rest, body)).map_err(|error| format!("{rest}: {error}"))?;
        if !wanted.contains(&reply.status) {
            self.crowd.complain(format!("{method} {rest}: {} {}", reply.status, reply.json()["code"]));
        }
        Ok((reply.status, reply.json()))
    }
}
