//! What stands before every route: starting, slashes, pages for people, other sites, headers.

use crate::client::{Client, PASSWORD, STUDY, config, folder, send};
use crate::placeholder::Placeholder;
use axum::body::Body;
use axum::http::{Request, StatusCode, header};
use kelir_server::Server;
use serde_json::{Value, json};
use std::sync::Arc;

const FOR_PEOPLE: &str = "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8";

async fn browse(client: &Client, path: &str) -> crate::client::Answer {
    client.send(Request::get(path).header(header::ACCEPT, FOR_PEOPLE).body(Body::empty()).unwrap()).await
}

#[tokio::test(flavor = "multi_thread")]
async fn a_wrong_study_is_not_served_and_the_others_are() {
    let folder = folder();
    let wrong = STUDY
        .replace("technique = \"mc\"", "technique = \"mc\"\nspq = 3")
        .replace("far.toml", "nobody.toml")
        .replace("dance.toml", "near.toml");
    std::fs::write(folder.path().join("studies/draft.toml"), wrong).unwrap();
    std::fs::write(folder.path().join("studies/rubbish.toml"), b"\xff\xfe").unwrap();
    let drawer = Arc::new(Placeholder::default());
    let server = Server::open(&config(folder.path(), drawer.clone())).await.unwrap();
    let said = server.make_stimuli(&|_| {}).await.unwrap_err();
    assert_eq!(said.lines().filter(|line| line.starts_with("study ")).count(), 2, "{said}");
    let client = Client { server, folder, drawer };
    let cookie = client.sign_in().await;
    let listed = client.research(&cookie, "/api/v1/studies").await.json();
    let studies = listed["items"].as_array().unwrap();
    let of = |id: &str| studies.iter().find(|study| study["id"] == id).unwrap();
    assert_eq!(
        (&of("shadow-puppets")["status"], &of("shadow-puppets")["reason"]),
        (&json!("ready"), &Value::Null)
    );
    let draft = of("draft");
    assert_eq!((&draft["status"], &draft["version"]), (&json!("failed"), &Value::Null));
    assert_eq!(draft["file_hash"].as_str().unwrap().len(), 64);
    let reason = draft["reason"].as_str().unwrap();
    for expected in ["conditions.mc", "spq", "nobody.toml", "blocks[1].pairs[0].scene", "has no [timeline]"] {
        assert!(reason.contains(expected) && said.contains(expected), "{expected} in {reason}");
    }
    assert_eq!(of("rubbish")["status"], "failed");
    client.take(json!({}), ["left", "left", "left"]).await;

    let told = client.get("/api/v1/studies/draft").await;
    assert_eq!((told.status.as_u16(), &told.json()["code"]), (503, &json!("stimuli_failed")));
    let detail = told.json()["detail"].as_str().unwrap().to_owned();
    assert!(detail.contains("in their console") && !detail.contains("spq"), "{detail}");
    let begun = client.call("POST", "/api/v1/studies/draft/sessions", "", &json!({})).await;
    assert_eq!(begun.status.as_u16(), 503);
    assert_eq!(client.get("/study/draft").await.status, StatusCode::OK, "the page, which says so");

    // Mended, it is served at the next start.
    std::fs::write(client.folder.path().join("studies/draft.toml"), STUDY.as_str()).unwrap();
    std::fs::remove_file(client.folder.path().join("studies/rubbish.toml")).unwrap();
    let again = Server::open(&config(client.folder.path(), client.drawer.clone())).await.unwrap();
    again.make_stimuli(&|_| {}).await.unwrap();
    assert_eq!(again.studies(), ["draft", "shadow-puppets"]);
}

#[tokio::test(flavor = "multi_thread")]
async fn people_get_pages_and_programs_get_problems() {
    let client = Client::ready().await;
    for path in ["/nowhere", "/api/v1/studies", "/assets/none.js"] {
        let page = browse(&client, path).await;
        assert!(page.status.is_client_error(), "{path}: {}", page.status);
        assert_eq!(page.header("content-type"), "text/html; charset=utf-8", "{path}");
        let problem = client.get(path).await;
        assert_eq!(
            (problem.status, problem.header("content-type")),
            (page.status, "application/problem+json")
        );
        let detail = problem.json()["detail"].as_str().unwrap().to_owned();
        assert!(page.text().contains(&detail) && !page.text().contains('{'), "{}", page.text());
        assert!(page.header("content-security-policy").contains("default-src 'none'"), "{path}");
    }
    for (path, to) in [
        ("/console/", "/console"),
        ("/study/shadow-puppets/", "/study/shadow-puppets"),
        ("/study/shadow-puppets/?PROLIFIC_PID=5f%200a&x=1", "/study/shadow-puppets?PROLIFIC_PID=5f%200a&x=1"),
    ] {
        let answer = browse(&client, path).await;
        assert_eq!((answer.status, answer.header("location")), (StatusCode::PERMANENT_REDIRECT, to));
    }
    let one = browse(&client, "/?PROLIFIC_PID=5f%200a&x=1").await;
    assert_eq!(one.status, StatusCode::TEMPORARY_REDIRECT);
    assert_eq!(one.header("location"), "/study/shadow-puppets?PROLIFIC_PID=5f%200a&x=1");
    for path in ["/study/nobody", "/console/studies/x"] {
        assert!(browse(&client, path).await.text().contains("<script"), "{path}: the page itself");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn another_site_touches_no_cookie() {
    let client = Client::ready().await;
    let cookie = client.sign_in().await;
    let from = |method: &str, path: &str, headers: &[(&str, &str)]| {
        let body = Body::from(json!({ "password": PASSWORD }).to_string());
        let mut request = Request::builder().method(method).uri(path).header(header::COOKIE, &cookie);
        request =
            request.header(header::CONTENT_TYPE, "application/json").header(header::HOST, "kelir.example");
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        send(client.server.router(), request.body(body).unwrap())
    };
    let strange = [("Origin", "https://evil.example"), ("Sec-Fetch-Site", "cross-site")];
    for headers in [&strange[..], &strange[..1], &strange[1..], &[("Origin", "null")]] {
        for (method, path) in [("POST", "/api/v1/auth/session"), ("DELETE", "/api/v1/auth/session")] {
            let answer = from(method, path, headers).await;
            assert_eq!(
                (answer.status.as_u16(), &answer.json()["code"]),
                (403, &json!("cross_site")),
                "{headers:?}"
            );
            assert_eq!(answer.header("set-cookie"), "");
        }
    }
    assert_eq!(
        client.research(&cookie, "/api/v1/auth/session").await.status,
        StatusCode::OK,
        "still signed in"
    );
    for headers in [&[][..], &[("Origin", "http://kelir.example")], &[("Sec-Fetch-Site", "same-origin")]] {
        assert_eq!(from("POST", "/api/v1/auth/session", headers).await.status, StatusCode::NO_CONTENT);
    }
    assert_eq!(from("DELETE", "/api/v1/auth/session", &[]).await.status, StatusCode::NO_CONTENT);
}

#[tokio::test(flavor = "multi_thread")]
async fn pages_may_use_the_screen_and_no_sensor() {
    let client = Client::unready().await;
    for path in ["/console", "/study/shadow-puppets", "/healthz", "/nowhere"] {
        let policy = client.get(path).await.header("permissions-policy").to_owned();
        for part in ["camera=()", "microphone=()", "geolocation=()", "fullscreen=(self)"] {
            assert!(policy.contains(part), "{path}: {part} in {policy}");
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn scenes_are_remembered_from_start_to_start() {
    let client = Client::ready().await;
    let file = client.folder.path().join("scenes.json");
    let remembered = || serde_json::from_slice::<Value>(&std::fs::read(&file).unwrap()).unwrap();
    let first = remembered();
    let dance = &first["scenes"]["studies/../scenes/dance.toml"];
    assert_eq!(dance["facts"]["moves"], true, "{first}");
    assert_eq!(dance["files"].as_object().unwrap().len(), 2, "the scene and its puppet");
    let start = async || {
        let server = Server::open(&config(client.folder.path(), client.drawer.clone())).await.unwrap();
        server.make_stimuli(&|_| {}).await
    };
    start().await.unwrap();
    // What is remembered is what is used, while the files are the same.
    let mut other = first.clone();
    other["scenes"]["studies/../scenes/dance.toml"]["facts"]["moves"] = json!(false);
    std::fs::write(&file, other.to_string()).unwrap();
    assert!(start().await.unwrap_err().contains("has no [timeline]"));
    let scene = client.folder.path().join("scenes/dance.toml");
    let text = std::fs::read_to_string(&scene).unwrap();
    std::fs::write(&scene, format!("{text}# seen again\n")).unwrap();
    start().await.unwrap();
    assert_eq!(
        remembered()["scenes"]["studies/../scenes/dance.toml"]["facts"],
        dance["facts"],
        "a comment is no value"
    );
}

#[tokio::test(flavor = "multi_thread")]
async fn damaged_stimuli_are_made_again_or_the_study_pauses_and_answers_are_taken() {
    let client = Client::ready().await;
    let (path, token, _) = client.join(json!({})).await;
    assert_eq!(client.server.check_integrity().await, Vec::<String>::new());
    assert_eq!(client.get("/healthz").await.text(), "ok\n");

    let version = client.version().await;
    let stimuli = client.server.store().version_stimuli("shadow-puppets", &version).await.unwrap();
    let file = |sha256: &str| client.folder.path().join("stimuli").join(&sha256[..2]).join(sha256);
    let still = file(&stimuli[0].sha256);
    let bytes = std::fs::read(&still).unwrap();
    for damage in [None, Some(&b"rubbish"[..]), Some(&[])] {
        match damage {
            None => std::fs::remove_file(&still).unwrap(),
            Some(damage) => std::fs::write(&still, damage).unwrap(),
        }
        assert_eq!(client.server.check_integrity().await, Vec::<String>::new(), "mended");
        assert!(std::fs::read(&still).unwrap() == bytes, "to the same bytes");
    }

    // What cannot be made again pauses its study, with the reason, and nothing else.
    let disguise = client.drawer.disguised.swap(true, std::sync::atomic::Ordering::SeqCst);
    assert!(!disguise);
    std::fs::remove_file(&still).unwrap();
    let faults = client.server.check_integrity().await;
    assert!(
        matches!(&faults[..], [one] if one.contains("shadow-puppets") && one.contains("came out otherwise")),
        "{faults:?}"
    );
    let cookie = client.sign_in().await;
    let listed = client.research(&cookie, "/api/v1/studies").await.json()["items"][0].clone();
    assert_eq!(listed["status"], "failed");
    assert!(listed["reason"].as_str().unwrap().contains("paused"), "{listed}");
    let health = client.get("/healthz").await;
    assert_eq!(
        (health.status, health.text().as_str()),
        (StatusCode::OK, "degraded\n"),
        "and nothing for participants"
    );
    let told = client.research(&cookie, "/api/v1/integrity").await.json();
    assert_eq!(told["faults"], json!(faults));
    assert_eq!(client.get("/api/v1/integrity").await.status, StatusCode::UNAUTHORIZED);
    let new = client.call("POST", "/api/v1/studies/shadow-puppets/sessions", "", &json!({})).await;
    assert_eq!((new.status.as_u16(), &new.json()["code"]), (503, &json!("stimuli_failed")));
    assert_eq!(
        client.choose(&path, &token, 0, "left").await.status,
        StatusCode::OK,
        "whoever has begun goes on"
    );

    client.drawer.disguised.store(false, std::sync::atomic::Ordering::SeqCst);
    std::fs::write(&still, &bytes).unwrap();
    assert_eq!(client.server.check_integrity().await, Vec::<String>::new());
    client.join(json!({})).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_damaged_database_is_seen_and_said_and_answers_are_taken() {
    let client = Client::ready().await;
    for who in 0..40 {
        client.take(json!({ "PROLIFIC_PID": format!("p{who}") }), ["left", "left", "right"]).await;
    }
    let cookie = client.sign_in().await;
    let results = "/api/v1/studies/shadow-puppets/versions/current/results";
    assert_eq!(client.research(&cookie, results).await.status, StatusCode::OK);
    assert_eq!(client.server.check_integrity().await, Vec::<String>::new());
    client.server.store().close().await;
    let database = client.folder.path().join("kelir.sqlite");
    let mut bytes = std::fs::read(&database).unwrap();
    // A page from the middle of what was answered: later answers go behind it.
    let answered = b"{\"choice\":\"";
    let places = bytes.windows(answered.len()).enumerate().filter(|(_, window)| window == answered);
    let places: Vec<usize> = places.map(|(at, _)| at / 4096).collect();
    let page = places[places.len() / 2];
    assert!(places[0] < page && page < places[places.len() - 1], "{places:?}");
    bytes[page * 4096..(page + 1) * 4096].fill(0x5a);
    std::fs::write(&database, bytes).unwrap();
    let server = Server::open(&config(client.folder.path(), client.drawer.clone())).await.unwrap();
    server.make_stimuli(&|_| {}).await.unwrap();
    let client = Client { server, ..client };
    let faults = client.server.check_integrity().await;
    assert!(faults.iter().any(|fault| fault.contains("The database is damaged")), "{faults:?}");
    let told = client.research(&cookie, results).await;
    assert_eq!(told.status, StatusCode::SERVICE_UNAVAILABLE);
    let detail = told.json()["detail"].as_str().unwrap().to_owned();
    for said in
        ["The server's database is damaged.", "copy of the data folder", "backup", "kelir chain check"]
    {
        assert!(detail.contains(said), "{said}: {detail}");
    }
    assert_eq!(client.get("/healthz").await.text(), "degraded\n");
    client.take(json!({ "PROLIFIC_PID": "later" }), ["left", "left", "right"]).await;
}
