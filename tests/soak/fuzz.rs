//! Every operation of the server's own document, and its pages, with addresses, bodies and headers that nobody should send.

use super::crowd::{Crowd, told};
use super::hostile;
use super::random::Random;
use super::victim::Victim;
use super::wire::{Reply, Wire, ask, request};
use super::{Outcome, Plan, judge};
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

const AT_ONCE: usize = 16;

/// Besides what the document names.
const PAGES: [&str; 8] =
    ["/", "/study/{x}", "/study/{x}/", "/console", "/console/{x}", "/assets/{x}", "/{x}", "/api/v1/{x}"];

/// What only the inside of a server says.
const INSIDE: [&str; 8] =
    ["SELECT ", "INSERT ", "sqlx", "rusqlite", "panicked", "stack backtrace", "kelir.sqlite", "crates/"];

/// Resampling a report takes seconds: now and then.
const SLOW: [&str; 4] = ["/report", "/report.html", "/report.md", "/export.xlsx"];

pub(super) fn attack(plan: &Plan) -> Result<Outcome, String> {
    let data = crate::small_data();
    let victim = Victim::start(data.path())?;
    let crowd = Crowd::default();
    let fuzz = Fuzz::aim(&victim)?;
    let until = Instant::now() + Duration::from_secs(plan.seconds);
    std::thread::scope(|scope| {
        for n in 0..AT_ONCE {
            let (fuzz, crowd, random) = (&fuzz, &crowd, plan.random(n));
            scope.spawn(move || fuzz.run(crowd, random, until));
        }
    });
    // Whoever comes afterwards takes part as if nothing had been.
    if crowd.visit(&mut Wire::new(victim.port), &mut plan.random(AT_ONCE)).is_none() {
        crowd.complain("nobody can take part afterwards".to_owned());
    }
    let (_, mut wrong) = judge(victim, &crowd.ledger())?;
    wrong.extend(crowd.complaints());
    let counts = fuzz.statuses.into_inner().unwrap_or_default();
    let all: usize = counts.values().sum();
    if fuzz.routes.len() < 30 || !counts.contains_key(&200) {
        wrong.push("the server's document was not read: little was tried".to_owned());
    }
    let counts: Vec<String> = counts.iter().map(|(status, n)| format!("{status}: {n}")).collect();
    Ok(Outcome {
        did: format!("{all} hostile requests to {} routes ({})", fuzz.routes.len(), counts.join(", ")),
        wrong,
    })
}

struct Fuzz {
    port: u16,
    /// Addresses with what they take.
    routes: Vec<(String, Vec<String>)>,
    /// Texts that no answer may hold.
    inside: Vec<String>,
    session: String,
    token: String,
    cookie: String,
    /// Answers by status; 0 where there was none.
    statuses: Mutex<BTreeMap<u16, usize>>,
}

impl Fuzz {
    /// Looks for what there is to be asked, begins a session and signs in.
    fn aim(victim: &Victim) -> Result<Fuzz, String> {
        let mut wire = Wire::new(victim.port);
        let mut send = |bytes: Vec<u8>| wire.send(&bytes).map_err(|error| error.to_string());
        let document = send(request("GET", "/api/v1/openapi.json", &[], None))?.json();
        let paths = document["paths"].as_object().ok_or("there is no document")?;
        let methods = |of: &Value| {
            of.as_object().map_or(Vec::new(), |of| of.keys().map(|of| of.to_uppercase()).collect())
        };
        let routes = paths.iter().map(|(path, of)| (path.clone(), methods(of)));
        let routes = routes.chain(PAGES.map(|page| (page.to_owned(), vec!["GET".to_owned()]))).collect();
        let begun = send(ask("POST", "/api/v1/studies/small/sessions", "", "{}"))?.json();
        let (session, token, _) = told(&begun).ok_or("no session begins")?;
        send(ask("POST", &format!("/api/v1/sessions/{session}/consent"), &token, ""))?;
        let password = std::fs::read_to_string(victim.data.join("researcher-password")).unwrap_or_default();
        let body = serde_json::json!({ "password": password.trim() }).to_string();
        let signed_in = send(ask("POST", "/api/v1/auth/session", "", &body))?;
        let cookie = signed_in.header("set-cookie").and_then(|cookie| cookie.split(';').next());
        let cookie = cookie.ok_or("nobody can sign in")?.replacen("kelir_session=", "", 1);
        let inside =
            INSIDE.map(str::to_owned).into_iter().chain([victim.data.display().to_string()]).collect();
        Ok(Fuzz { port: victim.port, routes, inside, session, token, cookie, statuses: Mutex::default() })
    }

    fn run(&self, crowd: &Crowd, mut random: Random, until: Instant) {
        let mut wire = Wire::new(self.port);
        while Instant::now() < until {
            let (route, methods) = random.pick(&self.routes);
            if SLOW.iter().any(|slow| route.ends_with(slow)) && random.chance(95) {
                continue;
            }
            let method =
                if random.chance(80) { random.pick(methods) } else { *random.pick(hostile::METHODS) };
            let reply = wire.send(&self.request(method, route, &mut random));
            let status = reply.as_ref().map_or(0, |reply| reply.status);
            *self.statuses.lock().unwrap_or_else(PoisonError::into_inner).entry(status).or_default() += 1;
            // Without an answer the server thought of the bytes as no request: its right.
            if let Ok(reply) = reply
                && let Some(fault) = fault(&reply, route, &self.inside)
            {
                crowd.complain(format!("{method} {route}: {fault}"));
            }
        }
    }

    fn request(&self, method: &str, route: &str, random: &mut Random) -> Vec<u8> {
        let parts = route.split('/').map(|part| match part.strip_prefix('{') {
            None => part.to_owned(),
            Some("session}") if random.chance(60) => self.session.clone(),
            Some("study}") if random.chance(60) => "small".to_owned(),
            Some("version}") if random.chance(60) => "current".to_owned(),
            Some("trial_index}") if random.chance(60) => random.below(6).to_string(),
            Some(_) if random.chance(5) => "a".repeat(*random.pick(&[64, 3000])),
            Some(_) => (*random.pick(hostile::PARTS)).to_owned(),
        });
        let path = Vec::from_iter(parts).join("/") + *random.pick(hostile::QUERIES);
        let mut headers = hostile::headers(random);
        let (bearer, cookie) = (format!("Bearer {}", self.token), format!("kelir_session={}", self.cookie));
        let wrong = ["Bearer", "Bearer ", "Basic x", "\u{ff}", "Bearer x"];
        headers
            .push(("Authorization", if random.chance(60) { bearer.as_str() } else { *random.pick(&wrong) }));
        // Whoever signs out is out, and wrong passwords take time.
        let is_auth = route.ends_with("/auth/session");
        let wrong = ["kelir_session=", "kelir_session=x; kelir_session=y", ";;;=", "a"];
        headers.push((
            "Cookie",
            if random.chance(60) && !is_auth { cookie.as_str() } else { *random.pick(&wrong) },
        ));
        let body = (!matches!(method, "GET" | "HEAD") && random.chance(90)).then(|| hostile::body(random));
        request(method, &path, &headers, body.as_deref())
    }
}

/// What is wrong with an answer, whatever was asked.
fn fault(reply: &Reply, route: &str, inside: &[String]) -> Option<String> {
    let text = reply.text();
    if reply.status == 503 && reply.header("retry-after").is_none() {
        return Some("503 without a time to come back".to_owned());
    }
    if reply.status >= 500 && reply.status != 503 {
        return Some(format!("{} {}", reply.status, text.chars().take(200).collect::<String>()));
    }
    // These speak of themselves.
    if ["/assets", "/docs", "openapi.json", "report"].iter().any(|known| route.contains(known)) {
        return None;
    }
    let leak = inside.iter().find(|word| text.contains(word.as_str()))?;
    Some(format!("says {leak:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_that_breaks_or_leaks_is_found() {
        let inside = INSIDE.map(str::to_owned);
        let of = |status, head: &str, body: &str| {
            let reply = Reply { status, head: head.to_owned(), body: body.as_bytes().to_vec() };
            fault(&reply, "/api/v1/studies/{study}", &inside)
        };
        assert_eq!(of(200, "", "{}"), None);
        assert_eq!(of(503, "retry-after: 10\r\n", "{}"), None);
        assert!(of(503, "", "{}").is_some());
        assert!(of(500, "", "{}").is_some());
        assert!(of(404, "", "no such table: SELECT x").is_some());
    }
}
