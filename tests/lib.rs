//! Helpers of the end-to-end tests: the real binary, a server, a database shell, a browser.
#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

pub mod soak;

/// The repository's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_path_buf()
}

/// The `kelir` that is tried: that of `KELIR_BIN`, or the one built beside this program; `cargo xtask test` builds it first.
pub fn binary() -> PathBuf {
    if let Some(named) = std::env::var_os("KELIR_BIN") {
        return named.into();
    }
    let this = std::env::current_exe().unwrap();
    let built =
        this.ancestors().skip(1).take(2).map(|folder| folder.join("kelir")).find(|path| path.is_file());
    built.expect("kelir is missing: run `cargo build --workspace` first (cargo xtask test does)")
}

/// A port that nobody listens on.
pub fn free_port() -> u16 {
    std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

/// Runs `kelir ARGS` to its end.
pub fn kelir<S: AsRef<std::ffi::OsStr>>(args: &[S]) -> Output {
    Command::new(binary()).args(args).current_dir(root()).stdin(Stdio::null()).output().unwrap()
}

/// Runs `kelir ARGS`, expects success, and answers its standard output.
pub fn kelir_ok<S: AsRef<std::ffi::OsStr> + std::fmt::Debug>(args: &[S]) -> String {
    let out = kelir(args);
    assert!(out.status.success(), "kelir {args:?}: {}\n{}", out.status, String::from_utf8_lossy(&out.stderr));
    String::from_utf8(out.stdout).unwrap()
}

/// A running `kelir serve`; killed (SIGKILL) when dropped.
pub struct Server {
    child: Child,
    /// `http://127.0.0.1:PORT`.
    pub base: String,
    /// Its data folder.
    pub data: PathBuf,
}

impl Server {
    /// Starts on a free port and waits until it answers; `ready` also waits until the built-in study can be taken.
    pub fn start(data: &Path, ready: bool) -> Self {
        let mut child = Command::new(binary())
            .args(["serve", "--listen", "127.0.0.1:0", "--data"])
            .arg(data)
            .current_dir(std::env::temp_dir())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let mut base = None;
        for line in lines.by_ref() {
            let line = line.unwrap();
            if let Some(at) = line.find("http://") {
                let url = line[at..].split_whitespace().next().unwrap();
                let end = url[7..].find('/').map_or(url.len(), |slash| slash + 7);
                base = Some(url[..end].to_owned());
                break;
            }
        }
        // Keep the pipe drained, or the server would block on a full one.
        std::thread::spawn(move || lines.for_each(drop));
        let server =
            Self { child, base: base.expect("the server prints its links"), data: data.to_path_buf() };
        server.wait(if ready { "/api/v1/studies/shadow-puppets" } else { "/healthz" });
        server
    }

    /// Starts on a folder of [`small_data`] and waits until `small` can be taken.
    pub fn start_small(data: &Path) -> Self {
        Self::start_with(data, "small")
    }

    /// Starts and waits until `study` can be taken.
    pub fn start_with(data: &Path, study: &str) -> Self {
        let server = Self::start(data, false);
        server.wait(&format!("/api/v1/studies/{study}"));
        server
    }

    /// Signs in with the password beside the data; answers the cookie.
    pub fn sign_in(&self) -> String {
        let password = std::fs::read_to_string(self.data.join("researcher-password")).unwrap();
        let signed = ureq::post(format!("{}/api/v1/auth/session", self.base))
            .send_json(serde_json::json!({ "password": password.trim() }))
            .unwrap();
        signed.headers()["set-cookie"].to_str().unwrap().split(';').next().unwrap().to_owned()
    }

    /// A GET as a researcher who is signed in: its text as JSON where it is any.
    pub fn research(&self, cookie: &str, path: &str) -> Value {
        let agent: ureq::Agent = ureq::Agent::config_builder().http_status_as_error(false).build().into();
        let text = agent.get(format!("{}{path}", self.base)).header("Cookie", cookie).call().unwrap();
        let text = text.into_body().read_to_string().unwrap();
        serde_json::from_str(&text).unwrap_or(Value::String(text))
    }

    fn wait(&self, path: &str) {
        let begun = Instant::now();
        loop {
            if ureq::get(format!("{}{path}", self.base)).call().is_ok() {
                return;
            }
            assert!(begun.elapsed() < Duration::from_secs(900), "{path} did not answer");
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Its process.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// `kill -9`, at once.
    pub fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }

    /// Ends it the way a service manager does (SIGTERM) and waits.
    pub fn terminate(mut self) -> std::process::ExitStatus {
        let pid = self.child.id().to_string();
        assert!(Command::new("kill").arg(&pid).status().unwrap().success());
        self.child.wait().unwrap()
    }

    /// Sends a request with a JSON body (none for `Value::Null`) and answers (status, JSON body).
    pub fn call(&self, method: &str, path: &str, token: Option<&str>, body: &Value) -> (u16, Value) {
        let agent: ureq::Agent = ureq::Agent::config_builder().http_status_as_error(false).build().into();
        let mut request = ureq::http::Request::builder().method(method).uri(format!("{}{path}", self.base));
        if let Some(token) = token {
            request = request.header("Authorization", format!("Bearer {token}"));
        }
        let text = if body.is_null() { String::new() } else { body.to_string() };
        if !body.is_null() {
            request = request.header("Content-Type", "application/json");
        }
        let mut answer = agent.run(request.body(text).unwrap()).unwrap();
        let status = answer.status().as_u16();
        let text = answer.body_mut().read_to_string().unwrap();
        (status, serde_json::from_str(&text).unwrap_or(Value::String(text)))
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Rows of a query, read with the sqlite3 shell: a program that is not ours.
pub fn sql(database: &Path, query: &str) -> Vec<Value> {
    let out =
        Command::new("sqlite3").arg("-json").arg(database).arg(query).output().expect("sqlite3 is installed");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    if out.stdout.trim_ascii().is_empty() { Vec::new() } else { serde_json::from_slice(&out.stdout).unwrap() }
}

/// The rows of a CSV, each by its columns' names.
pub fn table(csv: &str) -> Vec<BTreeMap<String, String>> {
    let rows = csv::Reader::from_reader(csv.as_bytes()).into_deserialize();
    rows.collect::<Result<_, _>>().expect("rows as long as their header")
}

/// Runs a script of tests/browser with one JSON argument and answers the JSON of its last line.
pub fn browser(script: &str, argument: &Value) -> Value {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    assert!(
        folder.join("node_modules/playwright-core").is_dir(),
        "run `npm ci --ignore-scripts` in tests/ first"
    );
    let out = Command::new("node")
        .arg(folder.join("browser").join(script))
        .arg(argument.to_string())
        .current_dir(folder)
        .stderr(Stdio::inherit())
        .output()
        .expect("node is installed");
    let text = String::from_utf8(out.stdout).unwrap();
    assert!(out.status.success(), "{script} failed:\n{text}");
    serde_json::from_str(text.trim_end().lines().last().expect("output")).unwrap()
}

/// A participant's session at a server.
pub struct Taking<'a> {
    server: &'a Server,
    /// Its id.
    pub id: String,
    /// Its secret.
    pub token: String,
    /// The state as last told.
    pub state: Value,
}

impl<'a> Taking<'a> {
    /// Opens a session of a study and consents.
    pub fn begin(server: &'a Server, study: &str, who: &str) -> Taking<'a> {
        let body = serde_json::json!({ "params": { "PROLIFIC_PID": who }, "display": {} });
        let (status, begun) = server.call("POST", &format!("/api/v1/studies/{study}/sessions"), None, &body);
        assert_eq!(status, 201, "{begun}");
        let text = |key: &str| begun[key].as_str().unwrap().to_owned();
        let (id, token) = (text("session_id"), text("token"));
        let (status, state) =
            server.call("POST", &format!("/api/v1/sessions/{id}/consent"), Some(&token), &Value::Null);
        assert_eq!(status, 200, "{state}");
        Taking { server, id, token, state }
    }

    /// Goes on with a session that was begun before.
    pub fn resume(server: &'a Server, id: &str, token: &str) -> Taking<'a> {
        let mut taking = Taking { server, id: id.to_owned(), token: token.to_owned(), state: Value::Null };
        let (status, state) = taking.call("GET", "", &Value::Null);
        assert_eq!(status, 200, "{state}");
        taking.state = state;
        taking
    }

    /// A request below the session's address.
    pub fn call(&self, method: &str, path: &str, body: &Value) -> (u16, Value) {
        self.server.call(method, &format!("/api/v1/sessions/{}{path}", self.id), Some(&self.token), body)
    }

    /// Answers a trial as its page does.
    pub fn answer(&self, trial: usize, choice: &str, rt: f64) -> (u16, Value) {
        let body = serde_json::json!({
            "choice": choice, "rt": rt, "onset": 100.0, "time_elapsed": 5000, "trial_type": "test", "plugin_version": "1",
            "input": "keyboard", "scale": 1.0, "device_pixel_ratio": 1.0, "viewport": [1280, 800], "refresh_hz": 60.0,
            "reload_count": 0, "timestamp": "2026-11-28T10:30:00.000Z",
        });
        let plan = self.state["plan"].as_str().expect("a session has a plan");
        self.call("PUT", &format!("/trials/{trial}?plan={plan}"), &body)
    }

    /// Finishes; answers the code.
    pub fn finish(&self) -> String {
        let (status, done) = self.call("POST", "/completion", &Value::Null);
        assert_eq!(status, 200, "{done}");
        done["completion_code"].as_str().unwrap().to_owned()
    }
}

/// Someone takes a study to its end with these choices, in the order of the trials.
pub fn take(server: &Server, study: &str, who: &str, choices: &[&str]) -> String {
    let taking = Taking::begin(server, study, who);
    for (trial, choice) in choices.iter().enumerate() {
        let (status, answer) = taking.answer(trial, choice, 700.0 + 10.0 * trial as f64);
        assert_eq!(status, 200, "{answer}");
    }
    taking.finish();
    taking.id
}

/// A data folder with small studies alone, which render in a moment: `small` (two stills, a catch trial, an animation), and the built-in one
/// hidden by one like it.
pub fn small_data() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for part in ["studies", "scenes", "puppets"] {
        copy(&fixture("answered").join(part), folder.path());
    }
    folder
}

/// A data folder that the program of 944eaa2 wrote.
pub fn fixture(name: &str) -> PathBuf {
    root().join("tests/fixtures/944eaa2").join(name)
}

/// Copies a folder into another.
pub fn copy(from: &Path, into: &Path) {
    assert!(Command::new("cp").arg("-a").arg(from).arg(into).status().unwrap().success());
}

/// Changes a text in a file of a data folder; it must be there.
pub fn edit(folder: &Path, file: &str, from: &str, to: &str) {
    let path = folder.join(file);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "{from} in {file}");
    std::fs::write(path, text.replace(from, to)).unwrap();
}

/// A data folder with the built-in study's stimuli, of few samples, made once for the whole test run and copied for each test.
pub fn prepared_data() -> tempfile::TempDir {
    static MADE: std::sync::OnceLock<PathBuf> = std::sync::OnceLock::new();
    let made = MADE.get_or_init(|| {
        // Beside the build, so that a test run cleans up after the one before it.
        let data = binary().parent().unwrap().parent().unwrap().join("tmp/e2e-data");
        let _ = std::fs::remove_dir_all(&data);
        std::fs::create_dir_all(data.join("studies")).unwrap();
        // As it ships but for the samples of its reference, which take minutes: an animation is drawn at two sizes.
        let shipped = std::fs::read_to_string(root().join("stimuli/studies/shadow-puppets.toml")).unwrap();
        assert!(shipped.contains("spp = 1024"));
        std::fs::write(data.join("studies/shadow-puppets.toml"), shipped.replace("spp = 1024", "spp = 16"))
            .unwrap();
        let status = Server::start(&data, true).terminate();
        assert!(status.success(), "a server that is asked to stop ends well: {status}");
        data
    });
    let copy = tempfile::tempdir().unwrap();
    let done = Command::new("cp").arg("-a").arg(made.join(".")).arg(copy.path()).status().unwrap();
    assert!(done.success());
    copy
}
