//! What goes wrong around a server, as people see it: they are put off with a time to come back, nothing is lost, and it goes on by itself.

use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};

use kelir_tests::soak::ledger::{Ledger, Stored};
use kelir_tests::soak::trouble::Holder;
use kelir_tests::soak::victim::Victim;
use kelir_tests::soak::wire::{Reply, Wire, ask, request};
use kelir_tests::{Server, binary, free_port, small_data};

/// Somebody who answers a trial, whatever comes of it.
struct Person {
    wire: Wire,
    id: String,
    token: String,
}

impl Person {
    fn begin(port: u16) -> Person {
        let mut wire = Wire::new(port);
        let begun = wire.send(&ask("POST", "/api/v1/studies/small/sessions", "", "{}")).unwrap();
        let text = |key: &str| begun.json()[key].as_str().unwrap().to_owned();
        let mut person = Person { wire, id: text("session_id"), token: text("token") };
        assert_eq!(person.send("POST", "/consent", "").status, 200);
        person
    }

    fn send(&mut self, method: &str, rest: &str, body: &str) -> Reply {
        self.wire
            .send(&ask(method, &format!("/api/v1/sessions/{}{rest}", self.id), &self.token, body))
            .unwrap()
    }

    fn answer(&mut self, trial: u32) -> Reply {
        self.send("PUT", &format!("/trials/{trial}"), ANSWER)
    }
}

const ANSWER: &str = r#"{"choice":"left","rt":700}"#;

/// That somebody is put off: 503, when to come back, and why in words.
fn assert_put_off(reply: &Reply, why: &str) {
    assert_eq!((reply.status, reply.header("retry-after")), (503, Some("10")), "{}", reply.text());
    let problem = reply.json();
    assert_eq!(problem["code"], "unavailable");
    assert!(problem["detail"].as_str().unwrap().contains(why), "{problem}");
}

/// How large a file of a process may be: `0` refuses each byte of it that is to be written, as a full disk would.
fn limit_files(process: u32, bytes: &str) {
    let limit = format!("--fsize={bytes}:");
    assert!(
        Command::new("prlimit").args(["--pid", &process.to_string(), &limit]).status().unwrap().success()
    );
}

#[test]
fn a_disk_that_takes_nothing_for_a_while_stops_nothing_for_good() {
    let data = small_data();
    // A process is killed for a file that grows too large, unless it does not listen to that.
    let deaf = ["sh", "-c", "trap '' XFSZ; exec \"$0\" \"$@\""].map(str::to_owned);
    let mut victim = Victim::start_by(data.path(), &deaf).unwrap();
    let mut person = Person::begin(victim.port);
    assert_eq!(person.answer(0).status, 200);
    limit_files(victim.id(), "0");
    for _ in 0..3 {
        assert_put_off(&person.answer(1), "disk");
        assert_put_off(
            &person.wire.send(&ask("POST", "/api/v1/studies/small/sessions", "", "{}")).unwrap(),
            "disk",
        );
        assert_put_off(&person.wire.send(&request("GET", "/healthz", &[], None)).unwrap(), "disk");
    }
    limit_files(victim.id(), "unlimited");
    assert_eq!(victim.status("/healthz"), 200, "at once, without a restart");
    for trial in 0..4 {
        assert_eq!(person.answer(trial).status, 200);
    }
    let done = person.send("POST", "/completion", "");
    assert_eq!(done.status, 200);
    victim.terminate().unwrap();
    let code = done.json()["completion_code"].as_str().unwrap().to_owned();
    let ledger = Ledger {
        sessions: vec![person.id.clone()],
        answers: (0..4).map(|trial| (person.id.clone(), trial, ANSWER.to_owned())).collect(),
        codes: vec![(person.id.clone(), code)],
    };
    assert_eq!(Stored::read(&victim.database()).unwrap().faults(&ledger), [""; 0]);
}

#[test]
fn a_database_that_another_program_holds_is_waited_for_and_then_said() {
    let data = small_data();
    let mut victim = Victim::start(data.path()).unwrap();
    let mut person = Person::begin(victim.port);
    let holder = Holder::lock(&victim.database()).unwrap();
    assert_put_off(&person.answer(0), "Another program holds the server's database.");
    assert_eq!(victim.status("/api/v1/studies/small"), 200, "what needs no writing goes on");
    drop(holder);
    assert_eq!(person.answer(0).status, 200);
    assert_eq!(victim.status("/healthz"), 200);
    victim.terminate().unwrap();
    let told = vec![(person.id.clone(), 0, ANSWER.to_owned())];
    let ledger = Ledger { answers: told, ..Ledger::default() };
    assert_eq!(Stored::read(&victim.database()).unwrap().faults(&ledger), [""; 0]);
}

#[test]
fn while_it_starts_a_server_says_so_everywhere() {
    let data = small_data();
    Victim::start(data.path()).unwrap().terminate().unwrap();
    // Its database cannot be opened yet: the start takes as long as this test looks.
    let holder = Holder::lock(&data.path().join("kelir.sqlite")).unwrap();
    let port = free_port();
    let mut command = Command::new(binary());
    command.args(["serve", "--listen", &format!("127.0.0.1:{port}"), "--data"]).arg(data.path());
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let get = |path: &str, accept: &str| loop {
        if let Ok(reply) = Wire::new(port).send(&request("GET", path, &[("Accept", accept)], None)) {
            return reply;
        }
        assert!(child.try_wait().unwrap().is_none(), "it ended");
        std::thread::sleep(std::time::Duration::from_millis(10));
    };
    let mut get = get;
    for path in ["/healthz", "/api/v1/studies/small"] {
        let reply = get(path, "*/*");
        assert_eq!((reply.status, reply.header("retry-after")), (503, Some("2")), "{path}: {}", reply.text());
        assert_eq!(reply.json()["code"], "not_ready");
    }
    let page = get("/study/small", "text/html");
    assert_eq!(page.status, 503);
    assert!(
        page.text().starts_with("<!doctype html>") && page.text().contains("starting"),
        "{}",
        page.text()
    );
    drop(holder);
    while get("/healthz", "*/*").status != 200 {}
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_second_server_on_a_folder_ends_and_names_the_first() {
    let data = small_data();
    let first = Server::start(data.path(), false);
    let second = |data: &Path| {
        let mut command = Command::new(binary());
        command.args(["serve", "--listen", "127.0.0.1:0", "--data"]).arg(data).stdout(Stdio::null());
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        let mut said = String::new();
        child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        (child.wait().unwrap(), said)
    };
    let (status, said) = second(data.path());
    assert!(!status.success());
    let holder = format!("another kelir serves this data folder (process {}, http://127.0.0.1:", first.id());
    assert!(said.contains(&holder), "{said}");
    assert_eq!(first.call("GET", "/healthz", None, &serde_json::Value::Null).0, 200, "which goes on");
}
