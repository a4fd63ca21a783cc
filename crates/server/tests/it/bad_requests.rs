use crate::client::{Answer, Client, body_of};
use axum::body::Body;
use axum::http::{Method, Request, StatusCode, header};
use kelir_server::api::Problem;
use serde_json::{Value, json};

/// The one shape of every refusal, and nothing of what is behind the server.
fn assert_shape(what: &str, answer: &Answer, status: u16) {
    assert_eq!(answer.status.as_u16(), status, "{what}: {}", answer.text());
    assert_eq!(answer.header("content-type"), "application/problem+json", "{what}");
    let problem: Problem = serde_json::from_slice(&answer.bytes).unwrap();
    assert_eq!((problem.status, problem.kind.as_str()), (status, "about:blank"), "{what}");
    assert_eq!(Some(problem.title.as_str()), answer.status.canonical_reason(), "{what}");
    assert_eq!(problem.code.status(), answer.status, "{what}");
    assert!(!problem.detail.is_empty(), "{what}");
    let text = answer.text().to_lowercase();
    for leak in ["sqlx", "sqlite", "select ", "panicked", ".rs:", "backtrace", "/tmp"] {
        assert!(!text.contains(leak), "{what}: {leak} in {text}");
    }
    assert!(answer.header("content-security-policy").contains("script-src 'self'"), "{what}");
    assert_eq!(answer.header("x-content-type-options"), "nosniff", "{what}");
}

#[tokio::test(flavor = "multi_thread")]
async fn bad_answers_to_a_trial() {
    let client = Client::ready().await;
    let (path, token, _) = client.join(json!({})).await;
    let cases = [
        ("no choice", json!({ "rt": 1.0 }), 422),
        ("choice in the middle", json!({ "choice": "middle", "rt": 1.0 }), 422),
        ("choice no text", json!({ "choice": 1, "rt": 1.0 }), 422),
        ("an array", json!([1]), 400),
        ("a text", json!("left"), 400),
    ];
    for (what, body, status) in cases {
        let answer = client.call("PUT", &format!("{path}/trials/0"), &token, &body).await;
        assert_shape(what, &answer, status);
    }
    for trial in ["3", "99999999999999999999", "-1", "+1", "01", "x", "1.0", "%00", "%ff"] {
        let answer = client.call("PUT", &format!("{path}/trials/{trial}"), &token, &body_of("left")).await;
        assert_shape(trial, &answer, 404);
    }
    let state = client.call("GET", &path, &token, &Value::Null).await.json();
    assert_eq!(state["next_trial"], 0, "nothing of it was stored");
}

#[tokio::test(flavor = "multi_thread")]
async fn every_wrong_field_is_named_with_its_value_and_its_rule() {
    let client = Client::ready().await;
    let (path, token, _) = client.join(json!({})).await;
    let mut body = body_of("middle");
    body["rt"] = json!(-1);
    body["frames"]["a/b"] = json!({ "fps": -1 });
    let answer = client.call("PUT", &format!("{path}/trials/0"), &token, &body).await;
    assert_shape("wrong choice", &answer, 422);
    // What would be stored without is not asked to be right.
    let expected =
        json!([{ "pointer": "/choice", "value": "middle", "rule": "must be \"left\" or \"right\"" }]);
    assert_eq!(answer.json()["errors"], expected);
    assert_eq!(answer.json()["detail"], "choice must be \"left\" or \"right\".");
    // A hostile body is answered shortly, and a password is not said back.
    let many: serde_json::Map<String, Value> = (0..5000).map(|i| (format!("k{i}"), json!(1))).collect();
    let answer = client.call("POST", "/api/v1/studies/shadow-puppets/sessions", "", &json!(many)).await;
    assert_eq!(answer.json()["errors"].as_array().unwrap().len(), 100);
    let secret = json!({ "password": "s3cret".repeat(200), "name": "x" });
    let answer = client.call("POST", "/api/v1/auth/session", "", &secret).await;
    assert_shape("a long password", &answer, 422);
    assert!(!answer.text().contains("s3cret") && answer.json()["errors"][1]["pointer"] == "/password");
}

/// The page says which kind of trial it answers so that its answer is checked early: by the rules of the trial that was shown all the same.
#[tokio::test(flavor = "multi_thread")]
async fn an_answer_to_another_kind_of_trial_is_refused() {
    let client = Client::ready().await;
    let (path, token, _) = client.join(json!({})).await;
    let put = async |choice: &str| {
        let mut body = body_of(choice);
        body["trial_type"] = json!("two-interval");
        client.call("PUT", &format!("{path}/trials/0"), &token, &body).await
    };
    let answer = put("first").await;
    assert_shape("another kind's choice", &answer, 422);
    let expected =
        json!([{ "pointer": "/choice", "value": "first", "rule": "must be \"left\" or \"right\"" }]);
    assert_eq!(answer.json()["errors"], expected);
    let state = client.call("GET", &path, &token, &Value::Null).await.json();
    assert_eq!(state["next_trial"], 0, "nothing of it was stored");
    assert_eq!(
        put("left").await.status,
        StatusCode::OK,
        "what is an answer to the trial is one, whatever the page calls it"
    );
}

#[tokio::test(flavor = "multi_thread")]
async fn bad_parameters_are_named() {
    let client = Client::ready().await;
    let cookie = client.sign_in().await;
    for (path, pointers) in [
        ("studies?limit=0", vec!["/limit"]),
        ("studies?limit=201&cursor=00", vec!["/limit"]),
        ("studies?limit=ten", vec!["/limit"]),
        ("studies?limit=%2B1", vec!["/limit"]),
        ("studies?limit=1&limit=2", vec!["/limit"]),
        ("studies?cursor=00", vec!["/cursor"]),
        ("studies?limt=5&limit=-1&a/b=1", vec!["/limt", "/limit", "/a~1b"]),
        ("studies/shadow-puppets/versions/curent/results", vec!["/version"]),
        ("studies/shadow-puppets/versions/0123456/results", vec!["/version"]),
        ("studies/shadow-puppets/versions/current/results?with=some", vec!["/with"]),
        ("studies/shadow-puppets/versions/current/report?wiht=all", vec!["/wiht"]),
    ] {
        let answer = client.research(&cookie, &format!("/api/v1/{path}")).await;
        assert_shape(path, &answer, 400);
        let errors = answer.json()["errors"].clone();
        let named: Vec<&str> =
            errors.as_array().unwrap().iter().map(|e| e["pointer"].as_str().unwrap()).collect();
        assert_eq!(named, pointers, "{path}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn bad_bodies_on_every_route_that_takes_one() {
    let client = Client::ready().await;
    let (path, token, _) = client.join(json!({})).await;
    let routes = [
        ("POST", "/api/v1/studies/shadow-puppets/sessions".to_owned(), 64 << 10),
        ("PUT", format!("{path}/trials/0"), 1 << 20),
        ("POST", "/api/v1/auth/session".to_owned(), 64 << 10),
    ];
    for (method, path, limit) in &routes {
        let send = |media: &'static str, body: Vec<u8>| {
            let request = Request::builder()
                .method(Method::from_bytes(method.as_bytes()).unwrap())
                .uri(path)
                .header(header::AUTHORIZATION, format!("Bearer {token}"))
                .header(header::CONTENT_TYPE, media)
                .body(Body::from(body))
                .unwrap();
            client.send(request)
        };
        let json = "application/json";
        let huge = format!("{{\"x\":\"{}\"}}", "y".repeat(*limit)).into_bytes();
        let deep = [b"[".repeat(5000), b"]".repeat(5000)].concat();
        for (what, media, body, status) in [
            ("empty", json, Vec::new(), 400),
            ("half an object", json, b"{\"choice\":".to_vec(), 400),
            ("no UTF-8", json, b"{\"choice\":\"\xff\"}".to_vec(), 400),
            ("NaN", json, b"{\"choice\":\"left\",\"rt\":NaN}".to_vec(), 400),
            ("an infinite number", json, b"{\"choice\":\"left\",\"rt\":1e999}".to_vec(), 400),
            ("an array", json, b"[]".to_vec(), 400),
            ("nested deeply", json, deep, 400),
            ("a form", "application/x-www-form-urlencoded", b"choice=left".to_vec(), 415),
            ("plain text", "text/plain", b"{}".to_vec(), 415),
            ("too large", json, huge, 413),
        ] {
            assert_shape(&format!("{method} {path}: {what}"), &send(media, body).await, status);
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn bad_sessions() {
    let client = Client::ready().await;
    let many: serde_json::Map<String, Value> = (0..65).map(|i| (format!("k{i}"), json!("v"))).collect();
    for (what, body) in [
        ("params no object", json!({ "params": [] })),
        ("a param that is no text", json!({ "params": { "a": 1 } })),
        ("a long param", json!({ "params": { "a": "x".repeat(1025) } })),
        ("a long name", json!({ "params": { "x".repeat(65): "a" } })),
        ("many params", json!({ "params": many })),
        ("display no object", json!({ "display": "big" })),
        ("an unknown key", json!({ "slot": 3 })),
    ] {
        assert_shape(
            what,
            &client.call("POST", "/api/v1/studies/shadow-puppets/sessions", "", &body).await,
            422,
        );
    }
    assert_shape("study", &client.call("POST", "/api/v1/studies/none/sessions", "", &json!({})).await, 404);
    assert_shape("study", &client.get("/api/v1/studies/none").await, 404);
}

#[tokio::test(flavor = "multi_thread")]
async fn wrong_tokens_and_unknown_sessions_look_the_same() {
    let client = Client::ready().await;
    let (path, token, _) = client.join(json!({})).await;
    let (_, other, _) = client.join(json!({})).await;
    let mut texts = Vec::new();
    for (path, token) in [
        (path.as_str(), ""),
        (path.as_str(), "wrong"),
        (path.as_str(), other.as_str()),
        ("/api/v1/sessions/01a202fd-0000-7000-8000-000000000000", token.as_str()),
        ("/api/v1/sessions/x'%20OR%201=1", token.as_str()),
    ] {
        for (method, rest, body) in [
            ("GET", "", Value::Null),
            ("POST", "/consent", Value::Null),
            ("PUT", "/trials/0", body_of("left")),
            ("POST", "/completion", Value::Null),
        ] {
            let answer = client.call(method, &format!("{path}{rest}"), token, &body).await;
            assert_shape(&format!("{method} {path}{rest}"), &answer, 401);
            texts.push(answer.text());
        }
    }
    texts.dedup();
    assert_eq!(texts.len(), 1);
}

#[tokio::test(flavor = "multi_thread")]
async fn addresses_and_methods_that_there_are_not() {
    let client = Client::ready().await;
    for (method, path, status) in [
        ("GET", "/api/v1/nothing", 404),
        ("GET", "/nothing", 404),
        ("GET", "/api/v1/studies/%ff", 404),
        ("GET", "/stimuli/abc", 401),
        ("GET", "/stimuli/..%2f..%2fkelir.sqlite", 401),
        ("GET", "/stimuli/0000000000000000000000000000000000000000000000000000000000000000", 401),
        ("GET", "/assets/../../Cargo.toml", 404),
        ("GET", "/assets/..%2f..%2fCargo.toml", 404),
        ("DELETE", "/api/v1/studies/shadow-puppets", 405),
        ("PUT", "/api/v1/auth/session", 405),
        ("POST", "/healthz", 405),
        ("PATCH", "/stimuli/abc", 405),
        ("GET", "/api/v1/studies", 401),
        ("GET", "/api/v1/studies/shadow-puppets/versions", 401),
        ("GET", "/api/v1/studies/shadow-puppets/versions/current/results", 401),
        ("GET", "/api/v1/studies/shadow-puppets/versions/current/responses.csv", 401),
        ("GET", "/api/v1/papers/taylor-cameron", 401),
        ("GET", "/api/v1/admin/studies", 404),
        ("POST", "/api/v1/login", 404),
        ("POST", "/api/v1/logout", 404),
    ] {
        assert_shape(&format!("{method} {path}"), &client.call(method, path, "", &Value::Null).await, status);
    }
    assert_eq!(client.get("/healthz").await.status, StatusCode::OK);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_study_that_is_not_ready_says_so() {
    let client = Client::unready().await;
    for (method, path, body) in [
        ("GET", "/api/v1/studies/shadow-puppets", Value::Null),
        ("POST", "/api/v1/studies/shadow-puppets/sessions", json!({})),
    ] {
        let answer = client.call(method, path, "", &body).await;
        assert_shape(path, &answer, 503);
        assert_eq!(answer.json()["code"], "not_ready");
        assert_eq!(answer.header("retry-after"), "5");
    }
}
