//! The document says what the server does.

use crate::client::{Answer, Client, body_of, send};
use axum::body::Body;
use axum::http::{Method, Request, header};
use kelir_server::api::Problem;
use kelir_study::schema::Record;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// An operation of the document.
struct Operation {
    method: String,
    path: String,
    said: Value,
}

fn document() -> Value {
    serde_json::from_str(kelir_server::openapi_json()).unwrap()
}

fn operations() -> Vec<Operation> {
    let document = document();
    let mut operations = Vec::new();
    for (path, item) in document["paths"].as_object().unwrap() {
        for (method, said) in item.as_object().unwrap() {
            let (method, path) = (method.to_uppercase(), path.clone());
            operations.push(Operation { method, path, said: said.clone() });
        }
    }
    operations
}

impl Operation {
    fn id(&self) -> &str {
        self.said["operationId"].as_str().unwrap()
    }

    /// The codes that it may refuse with, by status.
    fn codes(&self) -> BTreeSet<(u16, String)> {
        let mut codes = BTreeSet::new();
        for (status, response) in self.said["responses"].as_object().unwrap() {
            let schema = &response["content"]["application/problem+json"]["schema"];
            for code in schema["allOf"][1]["properties"]["code"]["enum"].as_array().into_iter().flatten() {
                codes.insert((status.parse().unwrap(), code.as_str().unwrap().to_owned()));
            }
        }
        codes
    }
}

#[test]
fn the_snapshot_is_the_document() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web/api/openapi.json");
    let document = kelir_server::openapi_json();
    if std::env::var_os("KELIR_BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, document).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        kept == document,
        "web/api/openapi.json is not what the routes say of themselves. If the change is meant, run\n  \
         KELIR_BLESS=1 cargo test -p kelir-server --test it openapi\nand `npm run types` in web/, and read what changed."
    );
}

/// What can be turned on each technique is told where a condition's knobs are.
#[test]
fn knobs_are_those_of_the_techniques() {
    let knobs = &document()["components"]["schemas"]["Condition"]["oneOf"][0]["properties"]["knobs"];
    let told = knobs["description"].as_str().unwrap();
    for phrase in [
        "`mc`, Monte Carlo",
        "`spp` in samples a pixel (a whole number from 1 to",
        "`bias_m` in m (a number from 0, 0.0 unless given)",
    ] {
        assert!(told.contains(phrase), "no {phrase:?} in {told}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn the_document_is_served() {
    let client = Client::unready().await;
    let answer = client.get("/api/v1/openapi.json").await;
    assert_eq!(answer.header("content-type"), "application/json");
    assert!(answer.text() == kelir_server::openapi_json() && document()["openapi"] == "3.1.0");
}

#[tokio::test(flavor = "multi_thread")]
async fn the_page_of_the_document_needs_its_style_and_nothing_else() {
    let client = Client::unready().await;
    let found = client.get("/api/v1/docs").await;
    assert_eq!((found.status.as_u16(), found.header("location")), (308, "/api/v1/docs/"));
    let page = client.get("/api/v1/docs/").await;
    assert_eq!(page.header("content-type"), "text/html; charset=utf-8");
    let policy = page.header("content-security-policy");
    assert!(
        policy.starts_with("default-src 'none'; style-src 'self';") && !policy.contains("script"),
        "{policy}"
    );
    let text = page.text();
    let loads: Vec<&str> = text.split("<link rel=\"stylesheet\" href=\"").skip(1).collect();
    let [style] = loads[..] else { panic!("one style: {loads:?}") };
    let style = client.get(style.split('"').next().unwrap()).await;
    assert_eq!((style.status.as_u16(), style.header("content-type")), (200, "text/css; charset=utf-8"));
    assert!(!text.contains("<script") && !text.contains("src=\""));
}

/// Addresses of an operation, with each of its variable parts right, unknown, and nonsense.
fn addresses(path: &str, session: &str) -> Vec<String> {
    let values = |name: &str| match name {
        "study" => vec!["shadow-puppets", "nobody", "%ff"],
        "version" => vec!["current", "00000000", "x", "%ff"],
        "session" => vec![session, "x", "%ff"],
        "trial_index" => vec!["0", "1", "99", "x", "%ff"],
        "sha256" => vec!["x", "%ff"],
        "file" => vec!["x", "%ff"],
        "address" => vec!["x", "%ff"],
        other => panic!("{other}: what is a right value of it?"),
    };
    let mut made = vec![String::new()];
    for part in path.split('/').skip(1) {
        let parts = match part.strip_prefix('{') {
            Some(name) => values(name.trim_end_matches('}')),
            None => vec![part],
        };
        made =
            made.iter().flat_map(|start| parts.iter().map(move |part| format!("{start}/{part}"))).collect();
    }
    made
}

/// Bodies: content type and bytes.
fn bodies(of: &Operation) -> Vec<(&'static str, Vec<u8>)> {
    if of.said["requestBody"].is_null() {
        return vec![("", Vec::new())];
    }
    let json = "application/json";
    let mut wrong = body_of("left");
    wrong["rt"] = json!(-1);
    vec![
        ("", Vec::new()),
        (json, Vec::new()),
        (json, b"[]".to_vec()),
        (json, b"{\"x\": 1, \"password\": 1, \"params\": 1}".to_vec()),
        (json, b"{\"password\": \"gong\"}".to_vec()),
        (json, b"{\"kind\": \"simulated\"}".to_vec()),
        (json, wrong.to_string().into_bytes()),
        (json, body_of("left").to_string().into_bytes()),
        (json, body_of("right").to_string().into_bytes()),
        (json, format!("{{\"x\": \"{}\"}}", "y".repeat(1 << 20)).into_bytes()),
        ("text/plain", b"{}".to_vec()),
    ]
}

/// A preview that a researcher begins: its id and its token.
async fn preview(router: axum::Router, cookie: &str, consented: bool) -> (String, String) {
    let body = json!({ "params": { "preview": "" } }).to_string();
    let request = Request::post("/api/v1/studies/shadow-puppets/sessions")
        .header(header::COOKIE, cookie)
        .header(header::CONTENT_TYPE, "application/json");
    let begun = send(router.clone(), request.body(Body::from(body)).unwrap()).await.json();
    let text = |key: &str| begun[key].as_str().unwrap().to_owned();
    let (id, token) = (text("session_id"), text("token"));
    if consented {
        let request = Request::post(format!("/api/v1/previews/{id}/consent"))
            .header(header::AUTHORIZATION, format!("Bearer {token}"));
        let answer = send(router, request.body(Body::empty()).unwrap()).await;
        assert_eq!(answer.status.as_u16(), 200, "{}", answer.text());
    }
    (id, token)
}

/// Sends every mixture of right and wrong addresses, parameters, credentials and bodies; answers what came back.
async fn garbage(client: &Client, operation: &Operation) -> Vec<Answer> {
    let (path, token, _) = client.join(json!({})).await;
    let agreed = (path.rsplit('/').next().unwrap().to_owned(), token);
    let fresh = client.call("POST", "/api/v1/studies/shadow-puppets/sessions", "", &json!({})).await.json();
    let text = |key: &str| fresh[key].as_str().unwrap().to_owned();
    let sessions = [agreed, (text("session_id"), text("token"))];
    let researcher = format!("token-of-{}", operation.id());
    let signed_in = kelir_store::sha256_hex(researcher.as_bytes());
    let minute = std::time::Duration::from_secs(60);
    client.server.store().sign_in("researcher", &signed_in, minute).await.unwrap();
    let researcher = format!("kelir_session={researcher}");
    let router = client.server.router();
    let sessions = if operation.path.contains("/previews/") {
        [preview(router.clone(), &researcher, true).await, preview(router.clone(), &researcher, false).await]
    } else {
        sessions
    };
    let mut queries = vec!["", "?limit=0&cursor=zz&with=nonsense&known=-1&limit=7&x"];
    let parameters = operation.said["parameters"].as_array().into_iter().flatten();
    queries.extend(parameters.filter(|parameter| parameter["name"] == "plan").map(|_| "?plan=x"));
    let mut answers = Vec::new();
    for (session, token) in &sessions {
        for address in addresses(&operation.path, session) {
            for query in &queries {
                for (bearer, cookie) in
                    [("", ""), ("x", "kelir_session=x"), (token.as_str(), researcher.as_str())]
                {
                    for (media_type, body) in bodies(operation) {
                        let mut request = Request::builder()
                            .method(operation.method.as_str())
                            .uri(format!("{address}{query}"));
                        if !query.is_empty() {
                            request = request.header("idempotency-key", "k".repeat(300));
                        }
                        for (name, value) in [
                            (header::CONTENT_TYPE, media_type),
                            (header::AUTHORIZATION, &format!("Bearer {bearer}")),
                            (header::COOKIE, cookie),
                        ] {
                            if !value.is_empty() {
                                request = request.header(name, value);
                            }
                        }
                        answers.push(send(router.clone(), request.body(Body::from(body)).unwrap()).await);
                    }
                }
            }
        }
    }
    answers
}

#[tokio::test(flavor = "multi_thread")]
async fn every_operation_refuses_as_it_is_documented() {
    // What this test cannot bring about: failures of the server, two versions of one hash's beginning, people who come again where a study
    // refuses them, signatures that are wrong, and requests of other sites.
    let rare = [
        ["internal", "unavailable", "bad_body", "ambiguous_version", "stimuli_failed"].as_slice(),
        &["not_ready", "already_begun", "already_finished", "link_refused", "cross_site"],
    ]
    .concat();
    let client = Client::ready().await;
    let mut differ = Vec::new();
    for operation in operations() {
        let (id, documented) = (operation.id().to_owned(), operation.codes());
        let mut seen = BTreeSet::new();
        for answer in garbage(&client, &operation).await {
            let status = answer.status.as_u16();
            if status < 400 {
                let known = &operation.said["responses"][status.to_string()];
                assert!(known.is_object(), "{id}: {status} is not documented");
                continue;
            }
            assert_eq!(answer.header("content-type"), "application/problem+json", "{id}: {}", answer.text());
            let problem: Problem = serde_json::from_slice(&answer.bytes).unwrap();
            assert_eq!((problem.status, problem.kind.as_str()), (status, "about:blank"), "{id}");
            assert!(!problem.detail.is_empty() && !problem.title.is_empty(), "{id}");
            let said = &operation.said["responses"][status.to_string()]["headers"]["Retry-After"];
            assert_eq!(said.is_object(), !answer.header("retry-after").is_empty(), "{id}: {}", answer.text());
            seen.insert((status, problem.code.as_str().to_owned()));
        }
        let common: BTreeSet<_> =
            documented.iter().filter(|(_, code)| !rare.contains(&code.as_str())).cloned().collect();
        if seen != common {
            differ.push(format!("{id}: seen {seen:?}, documented {common:?}"));
        }
    }
    assert!(differ.is_empty(), "{differ:#?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn nothing_below_api_v1_is_undocumented_but_the_one_alias() {
    let client = Client::unready().await;
    let mut methods = BTreeMap::<String, BTreeSet<String>>::new();
    for Operation { method, path, .. } in operations() {
        methods.entry(path).or_default().insert(method);
    }
    methods.insert("/api/v1/sessions/{session}/complete".to_owned(), BTreeSet::from(["POST".to_owned()]));
    // The router lists its paths when it is printed.
    let printed = format!("{:?}", client.server.router());
    let paths: BTreeSet<&str> = printed.split('"').filter(|text| text.starts_with("/api/")).collect();
    let known: BTreeSet<&str> =
        methods.keys().map(String::as_str).filter(|path| path.starts_with("/api/")).collect();
    assert!(paths.len() > 15 && printed.contains("/console"), "{printed}");
    assert_eq!(paths, known);
    for (path, known) in &methods {
        for method in ["GET", "POST", "PUT", "DELETE", "PATCH"] {
            let request = Request::builder().method(Method::from_bytes(method.as_bytes()).unwrap());
            let request = request.uri(path.replace(['{', '}'], "")).body(Body::empty()).unwrap();
            let answer = client.send(request).await;
            let status = answer.status.as_u16();
            assert_eq!(status != 405, known.contains(method), "{method} {path}: {status}");
            assert_eq!(status == 405, !answer.header("allow").is_empty(), "{method} {path}");
        }
    }
}

/// What `answer` breaks of what the document says that `operation` answers with.
fn breaches(operation: &str, answer: &Answer) -> Vec<String> {
    let document = document();
    let said = operations().into_iter().find(|known| known.id() == operation).unwrap().said;
    let response = &said["responses"][answer.status.as_str()];
    let media_type = answer.header("content-type");
    let schema = &response["content"][media_type]["schema"];
    assert!(schema.is_object(), "{operation}: {} with {media_type} is not documented", answer.status);
    let record =
        Record::of_json(schema.clone(), document["components"]["schemas"].as_object().unwrap().clone());
    record.check(&answer.json()).iter().map(|error| format!("{} {}", error.pointer, error.rule)).collect()
}

#[tokio::test(flavor = "multi_thread")]
async fn answers_are_what_the_document_says() {
    let unready = Client::unready().await;
    let cookie = unready.sign_in().await;
    assert_eq!(breaches("list_studies", &unready.research(&cookie, "/api/v1/studies").await), [""; 0]);
    let problem = unready.get("/api/v1/studies/shadow-puppets").await;
    assert_eq!(breaches("get_study", &problem), [""; 0]);

    let client = Client::ready().await;
    for choices in [["left", "right", "left"], ["right", "right", "left"], ["left", "left", "left"]] {
        client.take(json!({ "PROLIFIC_PID": "abc" }), choices).await;
    }
    let sessions = "/api/v1/studies/shadow-puppets/sessions";
    let created = client.call("POST", sessions, "", &json!({})).await;
    assert_eq!(breaches("create_session", &created), [""; 0]);
    let session = created.json();
    let (path, token) =
        (format!("/api/v1/sessions/{}", session["session_id"].as_str().unwrap()), &session["token"]);
    let token = token.as_str().unwrap();
    let none = Value::Null;
    for (operation, method, rest, body) in [
        ("get_session", "GET", "", &none),
        ("put_answer", "PUT", "/trials/0", &body_of("left")),
        ("give_consent", "POST", "/consent", &none),
        ("put_answer", "PUT", "/trials/0?known=0", &body_of("left")),
        ("put_answer", "PUT", "/trials/0", &body_of("right")),
        ("put_answer", "PUT", "/trials/0", &json!({ "choice": "up" })),
        ("complete_session", "POST", "/completion", &none),
        ("put_answer", "PUT", "/trials/1", &body_of("left")),
        ("put_answer", "PUT", "/trials/2", &body_of("left")),
        ("complete_session", "POST", "/completion", &none),
        ("get_session", "GET", "", &none),
    ] {
        let answer = client.call(method, &format!("{path}{rest}"), token, body).await;
        assert_eq!(breaches(operation, &answer), [""; 0], "{method} {rest}: {}", answer.text());
    }
    let cookie = client.sign_in().await;
    for (operation, path) in [
        ("get_study", "studies/shadow-puppets"),
        ("get_signed_in", "auth/session"),
        ("list_studies", "studies?limit=1"),
        ("list_versions", "studies/shadow-puppets/versions"),
        ("get_results", "studies/shadow-puppets/versions/current/results"),
        ("get_report", "studies/shadow-puppets/versions/current/report"),
        ("get_document", "studies/shadow-puppets/versions/current/document"),
        ("get_codebook", "studies/shadow-puppets/versions/current/codebook.json"),
        ("get_taylor_cameron", "papers/taylor-cameron"),
    ] {
        let answer = client.research(&cookie, &format!("/api/v1/{path}")).await;
        assert_eq!(answer.status.as_u16(), 200, "{operation}");
        assert_eq!(breaches(operation, &answer), [""; 0], "{operation}");
    }
    // The comparison can fail.
    let answer = client.research(&cookie, "/api/v1/papers/taylor-cameron").await;
    assert!(!breaches("get_results", &answer).is_empty());
}
