//! The server as its operating system sees it: floods of sockets, few descriptors, a log that nobody can write, being asked to stop.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use kelir_tests::{Server, Taking, binary, edit, free_port, kelir_ok, small_data, sql};
use serde_json::{Value, json};

/// Connections that say nothing, or not enough.
fn hang(server: &Server, count: usize, text: &[u8]) -> Vec<TcpStream> {
    let address = server.base.strip_prefix("http://").unwrap();
    let open = |_| {
        let mut stream = TcpStream::connect(address).unwrap();
        // A server that has closed it already is what is asked for.
        let _ = stream.write_all(text);
        stream
    };
    (0..count).map(open).collect()
}

#[test]
fn idle_and_half_sent_connections_keep_nobody_out_and_end_with_the_server() {
    let data = small_data();
    let server = Server::start_small(data.path());
    let head = b"POST /api/v1/studies/small/sessions HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: 50\r\n\r\n{";
    // Fewer descriptors than this test process may have, more than the server lets one address hold.
    let mut held = hang(&server, 250, b"");
    held.extend(hang(&server, 250, b"GET /healthz HT"));
    held.extend(hang(&server, 250, head));
    let taking = Taking::begin(&server, "small", "5f0a");
    assert_eq!(taking.answer(0, "left", 700.0).0, 200);
    held.extend(hang(&server, 50, head));
    assert_eq!(server.call("GET", "/healthz", None, &Value::Null).0, 200);
    assert!(server.terminate().success(), "it ends well, whoever is still talking");
    drop(held);
}

/// A server started by a shell line; its log goes to `log`.
fn start_by(line: &str, data: &Path, port: u16, log: Stdio) -> Child {
    let serve = format!(
        "{line} exec {} serve --listen 127.0.0.1:{port} --data {}",
        binary().display(),
        data.display()
    );
    let mut command = Command::new("sh");
    command.args(["-c", &serve]).stdin(Stdio::null()).stdout(Stdio::null()).stderr(log);
    command.spawn().unwrap()
}

/// Waits for the study and takes a trial of it.
fn can_be_taken(port: u16) {
    let begun = std::time::Instant::now();
    let agent: ureq::Agent = ureq::Agent::config_builder().http_status_as_error(false).build().into();
    let status =
        |path: &str| agent.get(format!("http://127.0.0.1:{port}{path}")).call().map(|a| a.status().as_u16());
    while status("/api/v1/studies/small").ok() != Some(200) {
        assert!(begun.elapsed().as_secs() < 600, "the study is never ready");
        std::thread::sleep(std::time::Duration::from_millis(100));
    }
    let begin = format!("http://127.0.0.1:{port}/api/v1/studies/small/sessions");
    assert_eq!(agent.post(begin).send_json(json!({})).unwrap().status().as_u16(), 201);
    let wrong = json!({ "password": "not the password" });
    let sign_in = format!("http://127.0.0.1:{port}/api/v1/auth/session");
    assert_eq!(
        agent.post(sign_in).send_json(wrong).unwrap().status().as_u16(),
        401,
        "what is logged loudest"
    );
}

fn stop(mut child: Child) {
    assert!(Command::new("kill").arg(child.id().to_string()).status().unwrap().success());
    assert!(child.wait().unwrap().success());
}

#[test]
fn few_descriptors_are_enough() {
    let (data, port) = (small_data(), free_port());
    let child = start_by("ulimit -n 100;", data.path(), port, Stdio::inherit());
    can_be_taken(port);
    let held: Vec<TcpStream> =
        (0..300).filter_map(|_| TcpStream::connect(("127.0.0.1", port)).ok()).collect();
    assert!(held.len() > 200);
    can_be_taken(port);
    drop(held);
    stop(child);
}

#[test]
fn a_log_that_cannot_be_written_takes_no_answer_with_it() {
    let data = small_data();
    for line in ["exec 2>&-;", "exec 2>/dev/full;", "exec 1>/dev/full;"] {
        let port = free_port();
        let child = start_by(line, data.path(), port, Stdio::inherit());
        can_be_taken(port);
        stop(child);
    }
    // A pipe that nobody reads, and one whose reader is gone.
    for close in [false, true] {
        let port = free_port();
        let mut child = start_by("export KELIR_LOG=trace;", data.path(), port, Stdio::piped());
        let pipe = child.stderr.take();
        let kept = if close { None } else { pipe };
        for _ in 0..5 {
            can_be_taken(port);
        }
        stop(child);
        drop(kept);
    }
}

#[test]
fn the_log_says_what_was_asked_and_nobodys_secrets() {
    let (data, port) = (small_data(), free_port());
    let mut child = start_by("", data.path(), port, Stdio::piped());
    let mut pipe = child.stderr.take().unwrap();
    can_be_taken(port);
    let agent: ureq::Agent = ureq::Agent::config_builder().http_status_as_error(false).build().into();
    let base = format!("http://127.0.0.1:{port}");
    let begin = agent.post(format!("{base}/api/v1/studies/small/sessions"));
    let begun: Value = begin
        .send_json(json!({ "params": { "PROLIFIC_PID": "5f0asecret" } }))
        .unwrap()
        .into_body()
        .read_json()
        .unwrap();
    let (id, token) = (begun["session_id"].as_str().unwrap(), begun["token"].as_str().unwrap());
    let state =
        agent.get(format!("{base}/api/v1/sessions/{id}")).header("Authorization", format!("Bearer {token}"));
    assert_eq!(state.call().unwrap().status().as_u16(), 200);
    agent.get(format!("{base}/study/small?PROLIFIC_PID=5f0asecret")).call().unwrap();
    agent.get(format!("{base}/nowhere/5f0asecret")).call().unwrap();
    stop(child);
    let mut log = String::new();
    pipe.read_to_string(&mut log).unwrap();
    for said in [
        "kelir::access: method=POST route=\"/api/v1/studies/{study}/sessions\" status=201 ms=",
        "kelir::access: method=GET route=\"/api/v1/sessions/{session}\" status=200 ms=",
        "kelir::access: method=GET route=\"/study/{study}\" status=200 ms=",
        "kelir::access: method=GET route=\"none\" status=404 ms=",
        "kelir::audit: a sign-in failed",
        "kelir::audit: started",
        "kelir::audit: stopped",
    ] {
        assert!(log.contains(said), "{said} in\n{log}");
    }
    for secret in [id, token, "5f0asecret", "not the password"] {
        assert!(!log.contains(secret), "{secret} in\n{log}");
    }
}

#[test]
fn stopping_while_pictures_are_drawn_is_no_fault_of_their_study() {
    // The built-in study, whose pictures take minutes.
    let (data, port) = (tempfile::tempdir().unwrap(), free_port());
    let mut child = start_by("", data.path(), port, Stdio::piped());
    let mut pipe = child.stderr.take().unwrap();
    let agent: ureq::Agent = ureq::Agent::config_builder().http_status_as_error(false).build().into();
    let asked = || agent.get(format!("http://127.0.0.1:{port}/healthz")).call();
    while !asked().is_ok_and(|answer| answer.status().as_u16() == 200) {
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    let stimuli = data.path().join("stimuli");
    let drawn = || std::fs::read_dir(&stimuli).is_ok_and(|mut files| files.next().is_some());
    while !drawn() {
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    stop(child);
    let mut log = String::new();
    pipe.read_to_string(&mut log).unwrap();
    assert!(log.contains("kelir::audit: stopped"), "{log}");
    assert!(!log.contains("cannot be taken") && !log.contains("ERROR"), "{log}");
}

/// A server at a terminal, of a user who gives everybody rights to what they make.
fn start_at_terminal(data: &Path, port: u16) -> Child {
    let serve = format!(
        "umask 0; echo $$ > {}; unset KELIR_LOG; exec {} serve --listen 127.0.0.1:{port} --data {}",
        data.join("pid").display(),
        binary().display(),
        data.display()
    );
    let mut terminal = Command::new("script");
    terminal.args(["-qec", &serve, "/dev/null"]).stdin(Stdio::null()).stdout(Stdio::piped()).spawn().unwrap()
}

/// Stops it; what was to be seen.
fn stop_at_terminal(data: &Path, mut terminal: Child) -> String {
    let server = std::fs::read_to_string(data.join("pid")).unwrap();
    assert!(Command::new("kill").arg(server.trim()).status().unwrap().success());
    let mut seen = String::new();
    terminal.stdout.take().unwrap().read_to_string(&mut seen).unwrap();
    assert!(terminal.wait().unwrap().success(), "{seen}");
    seen
}

/// Paths that others than their owner have rights to, and how many there are in all.
fn open_to_others(path: &Path, found: &mut Vec<String>) -> usize {
    let known = path.symlink_metadata().unwrap();
    if known.permissions().mode() & 0o077 != 0 {
        found.push(format!("{} {:o}", path.display(), known.permissions().mode()));
    }
    let inside = if known.is_dir() { Some(std::fs::read_dir(path).unwrap()) } else { None };
    1 + inside.into_iter().flatten().map(|entry| open_to_others(&entry.unwrap().path(), found)).sum::<usize>()
}

#[test]
fn nobody_else_has_rights_to_anything_in_the_folder_of_a_served_study() {
    let (data, port) = (small_data(), free_port());
    let folder = data.path().to_str().unwrap();
    let terminal = start_at_terminal(data.path(), port);
    can_be_taken(port);
    let files = ["kelir.sqlite", "kelir.sqlite-wal", "kelir.lock", "scenes.json", "server.log", "link-key"];
    for name in [&files[..], &["researcher-password", "stimuli", "studies/small.toml"]].concat() {
        assert!(data.path().join(name).exists(), "{name} is looked at too");
    }
    // Looked at before each command: whoever opens the folder closes what was left open.
    let mut found = Vec::new();
    assert!(open_to_others(data.path(), &mut found) > 20);
    for command in [["study", "link", "small"], ["study", "versions", "small"], ["chain", "check", "small"]] {
        kelir_ok(&[&command[..], &["--data", folder]].concat());
        open_to_others(data.path(), &mut found);
    }
    stop_at_terminal(data.path(), terminal);
    open_to_others(data.path(), &mut found);
    assert_eq!(found, [""; 0]);
}

#[test]
fn a_terminal_gets_links_and_warnings_and_a_file_all_that_is_logged() {
    let (data, port) = (small_data(), free_port());
    edit(data.path(), "studies/small.toml", "cc=[CODE]", "cc=");
    let terminal = start_at_terminal(data.path(), port);
    can_be_taken(port);
    let seen = stop_at_terminal(data.path(), terminal);
    let (kept, link) = (format!("{}/server.log", data.path().display()), format!(":{port}/study/small"));
    for said in [link.as_str(), &kept, "completion.redirect"] {
        assert!(seen.contains(said), "{said} in\n{seen}");
    }
    assert!(!seen.contains("kelir::access") && !seen.contains("started"), "{seen}");
    let log = std::fs::read_to_string(&kept).unwrap();
    for said in
        ["kelir::access: method=POST", "a sign-in failed", "started", "completion.redirect", "stopped"]
    {
        assert!(log.contains(said), "{said} in\n{log}");
    }
}

#[test]
fn a_scene_that_may_be_mistaken_is_told_by_check_and_by_the_log_of_each_start() {
    let data = small_data();
    // A scan without alpha, in a scene that two blocks show.
    image::RgbImage::new(64, 64).save(data.path().join("puppets/scan.png")).unwrap();
    edit(data.path(), "scenes/near.toml", "puppets/square.svg", "puppets/scan.png");
    let study = data.path().join("studies/small.toml");
    let said = kelir_ok(&["study", "check", study.to_str().unwrap()]);
    let told: Vec<&str> = said.lines().filter(|line| line.starts_with("warning: ")).collect();
    assert_eq!(told.len(), 1, "{said}");
    for part in [
        study.to_str().unwrap(),
        "blocks[0].pairs[0].scene = \"../scenes/near.toml\"",
        "scenes/near.toml:15:9: puppets[0].image = \"../puppets/scan.png\"",
        "is this a scan without alpha?",
    ] {
        assert!(told[0].contains(part), "no {part:?} in {told:?}");
    }
    let (_, of_scene) = told[0].split_once("scene = ").unwrap();
    let logged = |said: &str| {
        let port = free_port();
        let terminal = start_at_terminal(data.path(), port);
        can_be_taken(port);
        stop_at_terminal(data.path(), terminal);
        let log = std::fs::read_to_string(data.path().join("server.log")).unwrap();
        log.lines().filter(|line| line.contains("studies/small.toml: ") && line.contains(said)).count()
    };
    assert_eq!(logged(of_scene), 1);
    assert_eq!(logged(of_scene), 2, "what is remembered is said again");
    // Control: the second start did not read the scene.
    edit(data.path(), "scenes.json", "is this a scan without alpha?", "as was remembered");
    assert_eq!(logged("as was remembered"), 1);
    // Mended, it is told no longer.
    edit(data.path(), "scenes/near.toml", "puppets/scan.png", "puppets/square.svg");
    assert!(kelir_ok(&["study", "check", study.to_str().unwrap()]).contains("small.toml: good ("));
    assert_eq!(logged("scene = "), 3);
}

#[test]
fn the_greeting_says_whose_password_is_in_force_and_links_can_be_opened() {
    let data = small_data();
    let greeting = |password: Option<&str>, listen: &str| {
        let mut command = Command::new(binary());
        command.args(["serve", "--listen", listen, "--data"]).arg(data.path()).stdin(Stdio::null());
        command.env_remove("KELIR_RESEARCHER_PASSWORD").stdout(Stdio::piped()).stderr(Stdio::null());
        if let Some(password) = password {
            command.env("KELIR_RESEARCHER_PASSWORD", password);
        }
        let mut child = command.spawn().unwrap();
        let mut text = Vec::new();
        let mut out = child.stdout.take().unwrap();
        while !String::from_utf8_lossy(&text).contains("sign in with") || text.last() != Some(&b'\n') {
            let mut byte = [0];
            assert_eq!(out.read(&mut byte).unwrap(), 1, "{}", String::from_utf8_lossy(&text));
            text.push(byte[0]);
        }
        child.kill().unwrap();
        child.wait().unwrap();
        String::from_utf8(text).unwrap()
    };
    let file = data.path().join("researcher-password").display().to_string();
    let own = greeting(None, "127.0.0.1:0");
    assert!(own.contains(&file) && !own.contains("KELIR_RESEARCHER_PASSWORD"), "{own}");
    let given = greeting(Some("wayang kulit"), "0.0.0.0:0");
    assert!(given.contains("KELIR_RESEARCHER_PASSWORD") && !given.contains(&file), "{given}");
    assert!(given.contains("http://127.0.0.1:") && !given.contains("0.0.0.0"), "{given}");
}

#[test]
fn a_program_that_reads_the_database_beside_the_server_takes_nothing_away() {
    let data = small_data();
    let server = Server::start_small(data.path());
    let database = server.data.join("kelir.sqlite");
    for begun in 1..=3 {
        let body = json!({ "params": {}, "display": {} });
        assert_eq!(server.call("POST", "/api/v1/studies/small/sessions", None, &body).0, 201);
        // Each look is a process of its own: when it goes, it must know that it is not the last.
        assert_eq!(sql(&database, "SELECT count(*) AS n FROM sessions")[0]["n"], begun);
    }
    drop(server);
    assert_eq!(sql(&database, "SELECT count(*) AS n FROM sessions")[0]["n"], 3);
}
