//! A server in a folder of its own, asked without a network.

use crate::placeholder::Placeholder;
use axum::Router;
use axum::body::{Body, to_bytes};
use axum::http::{HeaderMap, Method, Request, StatusCode, header};
use kelir_fixtures as fixtures;
use kelir_house::Maker;
use kelir_server::{Server, ServerConfig, TrustedProxies};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, LazyLock};
use tempfile::TempDir;
use tower::ServiceExt;

pub(crate) const PASSWORD: &str = "wayang kulit";

/// The study that the tests use: two stills and one animation, small. It hides the built-in study by having its name.
pub(crate) static STUDY: LazyLock<String> = LazyLock::new(|| {
    let keys = [
        ("title", "\"Small\""),
        ("question", "\"Which?\""),
        ("seed", "3"),
        ("completion", r#"{ redirect = "https://example.org/?cc=[CODE]&who=[PROLIFIC_PID]" }"#),
    ];
    let pairs =
        r#"[{ id = "a", scene = "../scenes/near.toml" }, { id = "b", scene = "../scenes/far.toml" }]"#;
    let stills = [("title", "\"Stills\""), ("pairs", pairs)];
    let pairs = r#"[{ id = "c", scene = "../scenes/dance.toml" }]"#;
    let film = [("title", "\"Loop\""), ("kind", "\"animation\""), ("pairs", pairs)];
    fixtures::study(&keys, [fixtures::block("stills", &stills), fixtures::block("loop", &film)])
});

const TIMELINE: &str = r#"
[timeline]
fps = 10
seconds = 0.4
loop = true
[[timeline.tracks]]
target = "puppets[0].position_m"
easing = "linear"
keys = [{ t = 0.0, value = [0.0, 0.0, -0.2] }, { t = 0.4, value = [0.1, 0.0, -0.2] }]
"#;

/// A data folder with the small study, its three scenes and their puppet.
pub(crate) fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let (near, far) = (fixtures::SCENE, fixtures::SCENE.replace("-0.2]", "-0.5]"));
    let files = [
        ("studies/shadow-puppets.toml", &**STUDY),
        ("scenes/near.toml", near),
        ("scenes/far.toml", &far),
        ("scenes/dance.toml", &format!("{near}{TIMELINE}")),
        ("puppets/square.svg", fixtures::SQUARE),
    ];
    fixtures::write(folder.path(), &files);
    folder
}

/// What came back.
pub(crate) struct Answer {
    pub status: StatusCode,
    pub headers: HeaderMap,
    pub bytes: Vec<u8>,
}

impl Answer {
    pub(crate) fn json(&self) -> Value {
        serde_json::from_slice(&self.bytes).unwrap_or_else(|_| panic!("no JSON: {}", self.text()))
    }

    pub(crate) fn text(&self) -> String {
        String::from_utf8_lossy(&self.bytes).into_owned()
    }

    pub(crate) fn header(&self, name: &str) -> &str {
        self.headers.get(name).map_or("", |value| value.to_str().unwrap())
    }
}

/// Sends a request to a router.
pub(crate) async fn send(router: Router, request: Request<Body>) -> Answer {
    let response = router.oneshot(request).await.unwrap();
    let (status, headers) = (response.status(), response.headers().clone());
    let bytes = to_bytes(response.into_body(), 64 << 20).await.unwrap().to_vec();
    Answer { status, headers, bytes }
}

pub(crate) struct Client {
    pub server: Server,
    pub folder: TempDir,
    pub drawer: Arc<Placeholder>,
}

pub(crate) fn config(folder: &Path, maker: Arc<dyn Maker>) -> ServerConfig {
    ServerConfig {
        data: folder.to_owned(),
        listen: ([127, 0, 0, 1], 0).into(),
        password: Some(PASSWORD.to_owned()),
        secure_cookies: false,
        trusted_proxies: TrustedProxies::default(),
        maker,
        progress: Arc::new(|_| {}),
    }
}

impl Client {
    /// A server with the small study, its stimuli made.
    pub(crate) async fn ready() -> Client {
        let client = Client::unready().await;
        client.server.make_stimuli(&|_| {}).await.unwrap();
        client
    }

    /// The same before its stimuli are made.
    pub(crate) async fn unready() -> Client {
        let folder = folder();
        let drawer = Arc::new(Placeholder::default());
        let server = Server::open(&config(folder.path(), drawer.clone())).await.unwrap();
        Client { server, folder, drawer }
    }

    /// The version that is served.
    pub(crate) async fn version(&self) -> String {
        self.server.store().study_versions("shadow-puppets").await.unwrap()[0].version.clone()
    }

    pub(crate) async fn send(&self, request: Request<Body>) -> Answer {
        send(self.server.router(), request).await
    }

    /// A request with a JSON body (none for null) and a bearer token (none for "").
    pub(crate) async fn call(&self, method: &str, path: &str, token: &str, body: &Value) -> Answer {
        let mut request = Request::builder().method(Method::from_bytes(method.as_bytes()).unwrap()).uri(path);
        if !token.is_empty() {
            request = request.header(header::AUTHORIZATION, format!("Bearer {token}"));
        }
        let body = if body.is_null() {
            Body::empty()
        } else {
            request = request.header(header::CONTENT_TYPE, "application/json");
            Body::from(body.to_string())
        };
        self.send(request.body(body).unwrap()).await
    }

    pub(crate) async fn get(&self, path: &str) -> Answer {
        self.call("GET", path, "", &Value::Null).await
    }

    /// Signs in; answers the cookie.
    pub(crate) async fn sign_in(&self) -> String {
        let answer = self.call("POST", "/api/v1/auth/session", "", &json!({ "password": PASSWORD })).await;
        assert_eq!(answer.status, StatusCode::NO_CONTENT, "{}", answer.text());
        answer.header("set-cookie").split(';').next().unwrap().to_owned()
    }

    /// A GET as a signed-in researcher.
    pub(crate) async fn research(&self, cookie: &str, path: &str) -> Answer {
        let request = Request::get(path).header(header::COOKIE, cookie).body(Body::empty()).unwrap();
        self.send(request).await
    }

    /// The rows of a table of the small study's current version, each by the names of its columns.
    pub(crate) async fn rows(&self, cookie: &str, table: &str) -> Vec<HashMap<String, String>> {
        let path = format!("/api/v1/studies/shadow-puppets/versions/current/{table}");
        let text = self.research(cookie, &path).await.text();
        csv::Reader::from_reader(text.as_bytes()).deserialize().map(Result::unwrap).collect()
    }

    /// Begins a session and consents; answers its address, token and state.
    pub(crate) async fn join(&self, params: Value) -> (String, String, Value) {
        let body = json!({ "params": params, "display": { "width": 1280 } });
        let answer = self.call("POST", "/api/v1/studies/shadow-puppets/sessions", "", &body).await;
        assert_eq!(answer.status, StatusCode::CREATED, "{}", answer.text());
        let state = answer.json();
        let token = state["token"].as_str().unwrap().to_owned();
        let path = format!("/api/v1/sessions/{}", state["session_id"].as_str().unwrap());
        let answer = self.call("POST", &format!("{path}/consent"), &token, &Value::Null).await;
        assert_eq!(answer.status, StatusCode::OK, "{}", answer.text());
        (path, token, answer.json())
    }

    /// Answers one trial.
    pub(crate) async fn choose(&self, path: &str, token: &str, trial: u32, choice: &str) -> Answer {
        self.call("PUT", &format!("{path}/trials/{trial}"), token, &body_of(choice)).await
    }

    /// Takes the whole study with one choice; answers the completion.
    pub(crate) async fn take(&self, params: Value, choices: [&str; 3]) -> Value {
        let (path, token, _) = self.join(params).await;
        for (trial, choice) in (0..).zip(choices) {
            assert_eq!(self.choose(&path, &token, trial, choice).await.status, StatusCode::OK);
        }
        let answer = self.call("POST", &format!("{path}/completion"), &token, &Value::Null).await;
        assert_eq!(answer.status, StatusCode::OK, "{}", answer.text());
        answer.json()
    }
}

/// An answer as the participant's page sends it.
pub(crate) fn body_of(choice: &str) -> Value {
    json!({
        "choice": choice, "rt": 812.5, "onset": 100.25, "time_elapsed": 5000, "trial_type": "two-alternative",
        "plugin_version": "0.1.0", "input": "keyboard", "scale": 1.0, "device_pixel_ratio": 1.0, "viewport": [1280, 800],
        "refresh_hz": 60.0, "reload_count": 0, "timestamp": "2026-11-22T10:30:00.000Z", "frames": { "left": { "fps": 12, "late": [1, 2, 3] } },
    })
}
