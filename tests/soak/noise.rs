//! Bytes on bare sockets: what is no request, too much of one, or half of one.

use super::crowd::Crowd;
use super::victim::Victim;
use super::wire::{Wire, connect};
use super::{Outcome, Plan, judge};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::process::Command;
use std::time::{Duration, Instant};

const HUNDRED_MB: usize = 100 << 20;
/// How long a second answer to one request is waited for.
const AFTERWARDS: Duration = Duration::from_millis(200);
/// Descriptors that may be left: of the database, and of answers under way.
const KEPT: usize = 16;

/// Something that is sent, and the statuses that may come back; 0 is an end without an answer.
struct Case {
    name: &'static str,
    chunks: Box<dyn Iterator<Item = Vec<u8>>>,
    allowed: &'static [u16],
}

fn case(name: &'static str, bytes: impl Into<Vec<u8>>, allowed: &'static [u16]) -> Case {
    Case { name, chunks: Box::new(std::iter::once(bytes.into())), allowed }
}

fn many(name: &'static str, head: &str, chunk: Vec<u8>, allowed: &'static [u16]) -> Case {
    let chunks =
        std::iter::once(head.as_bytes().to_vec()).chain(std::iter::repeat_n(chunk, HUNDRED_MB >> 16));
    Case { name, chunks: Box::new(chunks), allowed }
}

fn cases() -> Vec<Case> {
    let post = |path: &str, more: &str| {
        format!("POST {path} HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n{more}\r\n")
    };
    let (auth, trial) = ("/api/v1/auth/session", "/api/v1/sessions/x/trials/0");
    let headers: String = (0..500).map(|n| format!("X-{n}: a\r\n")).collect();
    let mut chunk = b"10000\r\n".to_vec();
    chunk.extend(vec![b'a'; 1 << 16]);
    chunk.extend(b"\r\n");
    vec![
        case("100 MB announced", post(auth, "Content-Length: 104857600\r\n") + &"a".repeat(70_000), &[413]),
        many("100 MB sent", &post(auth, "Content-Length: 104857600\r\n"), vec![b'a'; 1 << 16], &[0, 413]),
        many("100 MB in chunks", &post(trial, "Transfer-Encoding: chunked\r\n"), chunk, &[0, 401, 413]),
        case("500 headers", format!("GET /healthz HTTP/1.1\r\nHost: x\r\n{headers}\r\n"), &[431]),
        case(
            "1 MB of header",
            format!("GET /healthz HTTP/1.1\r\nHost: x\r\nX: {}\r\n\r\n", "a".repeat(1 << 20)),
            &[0, 431],
        ),
        case(
            "100 kB of address",
            format!("GET /{} HTTP/1.1\r\nHost: x\r\n\r\n", "a".repeat(100_000)),
            &[0, 414, 431],
        ),
        case("no host", "GET /healthz HTTP/1.1\r\n\r\n", &[200, 400]),
        case(
            "a length and chunks",
            post(auth, "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n")
                + "0\r\n\r\nGET /x HTTP/1.1\r\n\r\n",
            &[400],
        ),
        case("two lengths", post(auth, "Content-Length: 5\r\nContent-Length: 6\r\n") + "abcdef", &[400]),
        case("a length below zero", post(auth, "Content-Length: -1\r\n"), &[400]),
        case(
            "a chunk of no size",
            post(trial, "Transfer-Encoding: chunked\r\n") + "zz\r\n\r\n",
            &[0, 400, 401],
        ),
        case("garbage", (0..400u32).map(|n| (n * 167 + 13) as u8).collect::<Vec<u8>>(), &[0, 400]),
        case("nothing but line ends", "\r\n\r\n\r\n\r\n", &[0, 400]),
        case(
            "an absolute address",
            "GET http://evil.example/healthz HTTP/1.1\r\nHost: x\r\n\r\n",
            &[200, 400],
        ),
        case("HTTP/0.9", "GET /healthz\r\n\r\n", &[0, 400]),
        case("HTTP/3.0", "GET /healthz HTTP/3.0\r\nHost: x\r\n\r\n", &[0, 400]),
        case("HTTP/2's preface", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n\0\0\0\x04\0\0\0\0\0", &[0, 400]),
        case("a NUL in a header", "GET /healthz HTTP/1.1\r\nHost: x\r\nX: a\0b\r\n\r\n", &[400]),
        case("a folded header", "GET /healthz HTTP/1.1\r\nHost: x\r\n X: a\r\n\r\n", &[400]),
        case("CONNECT", "CONNECT evil.example:443 HTTP/1.1\r\nHost: x\r\n\r\n", &[400, 404, 405]),
    ]
}

pub(super) fn attack(plan: &Plan) -> Result<Outcome, String> {
    let data = crate::small_data();
    let victim = Victim::start(data.path())?;
    let crowd = Crowd::default();
    let visit = |n| crowd.visit(&mut Wire::new(victim.port), &mut plan.random(n));
    let can = |when: &str, n| {
        if visit(n).is_none() {
            crowd.complain(format!("nobody can take part {when}"));
        }
    };
    can("at all", 0);
    let before = victim.descriptors();
    let cases = cases();
    let poked = cases.len();
    for case in cases {
        if let Some(fault) = fault(case.name, &poke(victim.port, case.chunks), case.allowed) {
            crowd.complain(fault);
        }
    }
    can("after noise", 1);
    let held = hang(victim.port, plan.idle)?;
    can("beside silent connections", 2);
    let most = victim.descriptors();
    drop(held);
    let begun = Instant::now();
    while victim.descriptors() > before + KEPT && begun.elapsed() < Duration::from_secs(30) {
        std::thread::sleep(Duration::from_millis(50));
    }
    let after = victim.descriptors();
    if after > before + KEPT {
        crowd.complain(format!("{before} descriptors became {after}"));
    }
    can("afterwards", 3);
    let (_, mut wrong) = judge(victim, &crowd.ledger())?;
    wrong.extend(crowd.complaints());
    let did = format!(
        "{poked} kinds of noise, {} silent connections; descriptors {before}, at most {most}, then {after}",
        plan.idle
    );
    Ok(Outcome { did, wrong })
}

/// Everything that comes back when these are sent, or as much of them as is taken.
fn poke(port: u16, chunks: impl Iterator<Item = Vec<u8>>) -> Vec<u8> {
    let Ok(mut stream) = connect(port) else { return Vec::new() };
    for chunk in chunks {
        if stream.write_all(&chunk).is_err() {
            break;
        }
    }
    let (mut came, mut part) = (Vec::new(), [0; 4096]);
    while let Ok(n @ 1..) = stream.read(&mut part) {
        came.extend(&part[..n]);
        let _ = stream.set_read_timeout(Some(AFTERWARDS));
    }
    came
}

/// What is wrong with what came back: another status, a second answer, or a header that was slipped in.
fn fault(name: &str, came: &[u8], allowed: &[u16]) -> Option<String> {
    let text = String::from_utf8_lossy(came);
    let statuses = text.lines().filter_map(|line| line.strip_prefix("HTTP/1.")?.get(2..5)?.parse().ok());
    let statuses: Vec<u16> = statuses.collect();
    let one = match statuses[..] {
        [] => 0,
        [one] => one,
        _ => return Some(format!("{name}: answered {statuses:?}")),
    };
    (!allowed.contains(&one)).then(|| format!("{name}: answered {one}"))
}

/// Connections that say nothing, half a head, or half a body.
fn hang(port: u16, count: usize) -> Result<Vec<TcpStream>, String> {
    // Their other ends are this process's; where it may not have more, the machine's limit shows below.
    let limit = format!("--nofile={}:", count + 256);
    let _ = Command::new("prlimit").args(["--pid", &std::process::id().to_string(), &limit]).status();
    let half_a_body = b"POST /api/v1/studies/small/sessions HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: 50\r\n\r\n{";
    let words: [&[u8]; 3] = [b"", b"GET /healthz HT", half_a_body];
    (0..count)
        .map(|n| {
            let mut stream = connect(port).map_err(|error| format!("connection {n}: {error}"))?;
            // A server that has closed it already is what is asked for.
            let _ = stream.write_all(words[n % words.len()]);
            Ok(stream)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_status_and_a_second_answer_are_found() {
        let one = b"HTTP/1.1 400 Bad Request\r\n\r\n";
        assert_eq!(fault("x", one, &[400]), None);
        assert_eq!(fault("x", b"", &[0, 400]), None);
        assert!(fault("x", one, &[413]).is_some());
        assert!(fault("x", b"", &[400]).is_some());
        assert!(fault("x", &[*one, *one].concat(), &[400]).is_some(), "smuggled");
    }
}
