//! People who take part without a pause, and never give up: what fails is sent again until it is answered.

use super::ledger::Ledger;
use super::random::Random;
use super::wire::{Wire, ask, request};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What a crowd has in common.
#[derive(Default)]
pub struct Crowd {
    ledger: Mutex<Ledger>,
    /// What must not be, and how often it was.
    complaints: Mutex<BTreeMap<String, usize>>,
    /// Answers that were refused because another one stands.
    pub refused: AtomicUsize,
    /// Requests that were put off with 503.
    pub put_off: AtomicUsize,
    /// Requests whose connection ended.
    pub cut_off: AtomicUsize,
    stop: AtomicBool,
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Crowd {
    /// Lets everybody go home.
    pub fn stop(&self) {
        self.stop.store(true, Relaxed);
    }

    /// What people were told so far.
    pub fn ledger(&self) -> MutexGuard<'_, Ledger> {
        held(&self.ledger)
    }

    /// Answers that were acknowledged so far.
    pub fn acknowledged(&self) -> usize {
        self.ledger().answers.len()
    }

    /// Notes something that must not be.
    pub fn complain(&self, fault: String) {
        *held(&self.complaints).entry(fault).or_default() += 1;
    }

    /// All of that.
    pub fn complaints(&self) -> Vec<String> {
        held(&self.complaints).iter().map(|(fault, times)| format!("{fault} ({times} ×)")).collect()
    }

    /// Takes part again and again until the crowd is stopped.
    pub fn take_part(&self, port: u16, mut random: Random) {
        let mut wire = Wire::new(port);
        while !self.stop.load(Relaxed) {
            self.visit(&mut wire, &mut random);
        }
    }

    /// One visit; `None` where it was stopped or went wrong.
    pub fn visit(&self, wire: &mut Wire, random: &mut Random) -> Option<()> {
        let key = format!("{:x}", random.draw());
        let begin = request(
            "POST",
            "/api/v1/studies/small/sessions",
            &[("Content-Type", "application/json"), ("Idempotency-Key", &key)],
            Some(json!({ "params": { "PROLIFIC_PID": key }, "display": {} }).to_string().as_bytes()),
        );
        let begun = self.persist(wire, random, "begin", 201, &begin)?;
        let (id, token, trials) = told(&begun)?;
        self.ledger().sessions.push(id.clone());
        let at = |rest: &str| format!("/api/v1/sessions/{id}{rest}");
        self.persist(wire, random, "consent", 200, &ask("POST", &at("/consent"), &token, ""))?;
        for trial in 0..trials {
            let answer = answer(random);
            let put = ask("PUT", &at(&format!("/trials/{trial}")), &token, &answer);
            self.persist(wire, random, "answer", 200, &put)?;
            self.ledger().answers.push((id.clone(), trial, answer));
        }
        let end =
            self.persist(wire, random, "complete", 200, &ask("POST", &at("/completion"), &token, ""))?;
        let code = end["completion_code"].as_str()?.to_owned();
        self.ledger().codes.push((id, code));
        Some(())
    }

    /// Sends a request until it is answered as it should be; `None` where the crowd is stopped or it is answered otherwise.
    fn persist(
        &self,
        wire: &mut Wire,
        random: &mut Random,
        at: &str,
        wanted: u16,
        bytes: &[u8],
    ) -> Option<Value> {
        while !self.stop.load(Relaxed) {
            match wire.send(bytes) {
                Ok(reply) if reply.status == wanted => return Some(reply.json()),
                Ok(reply) if reply.status == 503 && reply.header("retry-after").is_some() => {
                    self.put_off.fetch_add(1, Relaxed);
                }
                Ok(reply) => {
                    self.complain(format!("{at}: {} {}", reply.status, reply.json()["code"]));
                    return None;
                }
                Err(_) => drop(self.cut_off.fetch_add(1, Relaxed)),
            }
            std::thread::sleep(random.ms(5, 25));
        }
        None
    }
}

/// Id, token and number of trials of a session that was begun.
pub fn told(begun: &Value) -> Option<(String, String, u32)> {
    let text = |key: &str| begun[key].as_str().map(str::to_owned);
    Some((text("session_id")?, text("token")?, begun["trials"].as_array()?.len() as u32))
}

/// What a page sends of a trial.
pub fn answer(random: &mut Random) -> String {
    let choice = if random.chance(50) { "left" } else { "right" };
    let rt = 200.0 + random.below(3_000_000) as f64 / 1000.0;
    json!({
        "choice": choice, "rt": rt, "onset": 100.5, "time_elapsed": 5000, "trial_type": "soak", "plugin_version": "1", "input": "mouse",
        "scale": 1.0, "device_pixel_ratio": 1.0, "viewport": [1280, 800], "refresh_hz": 60.0, "reload_count": 0,
        "timestamp": "2026-11-28T10:30:00.000Z",
    })
    .to_string()
}
