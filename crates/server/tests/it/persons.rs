//! Who is who: ids, people who come again, what is noticed of sessions, and the table of participants.

use crate::client::{Answer, Client, STUDY, config, folder};
use crate::placeholder::Placeholder;
use axum::body::Body;
use axum::http::{Request, StatusCode, header};
use kelir_server::Server;
use serde_json::{Value, json};
use std::sync::Arc;

const VERSION: &str = "/api/v1/studies/shadow-puppets/versions/current";
const SESSIONS: &str = "/api/v1/studies/shadow-puppets/sessions";

/// A server whose study has these tables too.
async fn with(tables: &str) -> Client {
    let folder = folder();
    std::fs::write(folder.path().join("studies/shadow-puppets.toml"), format!("{}\n{tables}", *STUDY))
        .unwrap();
    let drawer = Arc::new(Placeholder::default());
    let server = Server::open(&config(folder.path(), drawer.clone())).await.unwrap();
    server.make_stimuli(&|_| {}).await.unwrap();
    Client { server, folder, drawer }
}

/// Somebody comes by a link with this id.
async fn begin(client: &Client, id: &str) -> Answer {
    client.call("POST", SESSIONS, "", &json!({ "params": { "PROLIFIC_PID": id } })).await
}

async fn results(client: &Client, query: &str) -> Value {
    let cookie = client.sign_in().await;
    client.research(&cookie, &format!("{VERSION}/results{query}")).await.json()
}

#[tokio::test(flavor = "multi_thread")]
async fn who_comes_twice_is_one_person_and_everything_says_so() {
    let client = Client::ready().await;
    for session in ["a", "b", "c"] {
        client
            .take(json!({ "PROLIFIC_PID": "5f0a", "SESSION_ID": session }), ["left", "right", "left"])
            .await;
    }
    client.take(json!({ "PROLIFIC_PID": "77aa" }), ["left", "right", "left"]).await;
    let found = results(&client, "").await;
    assert_eq!(found["participants"]["completed"], 4);
    assert_eq!(found["blocks"][0]["n"], 2, "one session a person");
    let standing = &found["standing"];
    assert_eq!((&standing["judged"], standing["repeated"].as_array().unwrap().len()), (&json!(2), 2));
    let said = "4 completed, 2 judged. 2 sessions of persons who had taken part before are left out.";
    assert_eq!(standing["summary"], said);
    assert_eq!(standing["flagged"][0]["flag"], "repeated_id");
    assert_eq!(standing["flagged"][0]["sessions"], 2);

    let cookie = client.sign_in().await;
    let people = client.rows(&cookie, "participants.csv").await;
    let judged: Vec<&str> = people.iter().map(|row| row["judged"].as_str()).collect();
    assert_eq!(judged, ["1", "0", "0", "1"]);
    let first = &people[0]["session_id"];
    assert_eq!(people[1]["reject_reason"], format!("had taken part before: session {first} counts"));
    assert!(people[1]["flags"].contains("repeated_id") && !people[0]["flags"].contains("repeated_id"));
    let report = client.research(&cookie, &format!("{VERSION}/report.md")).await.text();
    assert!(report.contains(said), "{report}");
    let pairs = client.research(&cookie, &format!("{VERSION}/pairs.csv")).await.text();
    assert_eq!(pairs.trim_end().split("\r\n").count(), 1 + 2 * 3);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_study_that_can_be_taken_once_refuses_who_comes_again_and_tells_no_code() {
    let client = with("[session]\nrepeat = \"refuse\"").await;
    let (path, token, _) = client.join(json!({ "PROLIFIC_PID": "ann" })).await;
    let begun = begin(&client, "ann").await;
    assert_eq!((begun.status, &begun.json()["code"]), (StatusCode::CONFLICT, &json!("already_begun")));
    for (trial, choice) in [(0, "left"), (1, "left"), (2, "left")] {
        assert_eq!(client.choose(&path, &token, trial, choice).await.status, StatusCode::OK);
    }
    let code = client.call("POST", &format!("{path}/completion"), &token, &Value::Null).await.json();
    let again = begin(&client, "ann").await;
    assert_eq!((again.status, &again.json()["code"]), (StatusCode::CONFLICT, &json!("already_finished")));
    assert!(!again.text().contains(code["completion_code"].as_str().unwrap()));
    assert_eq!(begin(&client, "bob").await.status, StatusCode::CREATED);
    let nameless = client.call("POST", SESSIONS, "", &json!({ "params": {} })).await;
    assert_eq!(nameless.status, StatusCode::CREATED, "whose link names nobody is nobody's repeat");
    let stolen = begin(&client, nameless.json()["session_id"].as_str().unwrap()).await;
    assert_eq!(stolen.status, StatusCode::CREATED, "a session's own id is nobody's");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_session_without_consent_is_whoevers_the_link_is() {
    for policy in ["refuse", "resume"] {
        let client = with(&format!("[session]\nrepeat = \"{policy}\"")).await;
        let (first, second) = (begin(&client, "ann").await.json(), begin(&client, "ann").await.json());
        assert_eq!(first["session_id"], second["session_id"], "{policy}");
        assert_ne!(first["token"], second["token"], "{policy}");
        let path = format!("/api/v1/sessions/{}", first["session_id"].as_str().unwrap());
        let of = async |state: &Value| {
            client.call("GET", &path, state["token"].as_str().unwrap(), &Value::Null).await.status
        };
        assert_eq!(
            (of(&first).await, of(&second).await),
            (StatusCode::UNAUTHORIZED, StatusCode::OK),
            "{policy}"
        );
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_session_is_gone_on_with_in_another_browser_where_the_study_says_so() {
    let client = with("[session]\nrepeat = \"resume\"").await;
    let (path, token, state) = client.join(json!({ "PROLIFIC_PID": "ann" })).await;
    assert_eq!(client.choose(&path, &token, 0, "left").await.status, StatusCode::OK);
    let again = begin(&client, "ann").await.json();
    assert_eq!((&again["session_id"], &again["next_trial"]), (&state["session_id"], &json!(1)));
    let token = again["token"].as_str().unwrap();
    for trial in [1, 2] {
        assert_eq!(client.choose(&path, token, trial, "left").await.status, StatusCode::OK);
    }
    let code = client.call("POST", &format!("{path}/completion"), token, &Value::Null).await.json();
    let finished = begin(&client, "ann").await;
    assert_eq!(finished.json()["code"], "already_finished");
    assert!(!finished.text().contains(code["completion_code"].as_str().unwrap()));
}

#[tokio::test(flavor = "multi_thread")]
async fn two_who_finished_and_are_screened_out_are_no_silence() {
    let client = with("[screening]\nmin_rt_ms = 5000").await;
    for _ in 0..2 {
        client.take(json!({}), ["left", "right", "left"]).await;
    }
    let found = results(&client, "").await;
    assert_eq!(found["standing"]["summary"], "2 completed, 2 left out by your rules, 0 judged.");
    assert_eq!(found["excluded"][0]["why"], "3 answers too fast, 0 allowed");
    let cookie = client.sign_in().await;
    let report = client.research(&cookie, &format!("{VERSION}/report.md")).await.text();
    assert!(report.contains("2 completed, 2 left out by your rules"), "{report}");
    assert!(!report.contains("obody has answered"), "{report}");
}

#[tokio::test(flavor = "multi_thread")]
async fn answers_that_claim_more_time_than_there_was_are_flagged_and_left_out_by_rule_alone() {
    for (rule, judged) in [("", 1), ("[screening]\nflags = [\"faster_than_clock\"]", 0)] {
        let client = with(rule).await;
        // Three answers that claim 812.5 ms each, in a moment.
        client.take(json!({}), ["left", "right", "left"]).await;
        let found = results(&client, "").await;
        assert_eq!(found["standing"]["judged"], judged, "{rule}");
        let flagged = &found["standing"]["flagged"][0];
        assert_eq!((&flagged["flag"], &flagged["sessions"]), (&json!("faster_than_clock"), &json!(1)));
        assert_eq!(flagged["excludes"], judged == 0);
        assert_eq!(found["excluded"].as_array().unwrap().len(), 1 - judged);
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn ids_are_kept_as_sent_or_refused_aloud() {
    let client = Client::ready().await;
    for id in ["a@b.example", "ä. ö/…", "مرحبا", "\u{202e}x", "01936d2e.tar"] {
        client.take(json!({ "PROLIFIC_PID": id }), ["left", "right", "left"]).await;
        let sessions =
            client.server.store().sessions("shadow-puppets", &[client.version().await]).await.unwrap();
        assert_eq!(sessions.last().unwrap().subject_id, id);
    }
    for id in ["", "a\nb", &"ä".repeat(257)] {
        let refused = begin(&client, id).await;
        assert_eq!(refused.status, StatusCode::UNPROCESSABLE_ENTITY, "{id:?}");
        let problem = refused.json();
        assert_eq!(problem["errors"][0]["pointer"], "/params/PROLIFIC_PID");
        assert!(problem["detail"].as_str().unwrap().contains("1 to 512 bytes"), "{problem}");
    }
    let own = with("[session]\nid = \"teilnehmer\"").await;
    let body = json!({ "params": { "Teilnehmer": "7", "id": "x" } });
    assert_eq!(own.call("POST", SESSIONS, "", &body).await.status, StatusCode::CREATED);
    let sessions = own.server.store().sessions("shadow-puppets", &[own.version().await]).await.unwrap();
    assert_eq!(sessions[0].subject_id, "7");
}

#[tokio::test(flavor = "multi_thread")]
async fn simulations_are_a_researchers_marked_and_left_out_unless_asked_for() {
    let client = Client::ready().await;
    let body = json!({ "kind": "simulated" });
    let anybody = client.call("POST", SESSIONS, "", &body).await;
    assert_eq!(anybody.status, StatusCode::UNAUTHORIZED, "who says so is not enough");
    let cookie = client.sign_in().await;
    let request = Request::post(SESSIONS)
        .header(header::COOKIE, &cookie)
        .header(header::CONTENT_TYPE, "application/json")
        .body(Body::from(body.to_string()))
        .unwrap();
    let state = client.send(request).await.json();
    let (path, token) = (
        format!("/api/v1/sessions/{}", state["session_id"].as_str().unwrap()),
        state["token"].as_str().unwrap(),
    );
    client.call("POST", &format!("{path}/consent"), token, &Value::Null).await;
    for trial in 0..3 {
        assert_eq!(client.choose(&path, token, trial, "left").await.status, StatusCode::OK);
    }
    client.call("POST", &format!("{path}/completion"), token, &Value::Null).await;
    let found = results(&client, "").await;
    assert_eq!(found["standing"]["summary"], "0 began. 1 simulated session is left out.");
    assert_eq!((&found["participants"]["started"], &found["standing"]["flagged"]), (&json!(0), &json!([])));
    let asked = results(&client, "?include=simulated").await;
    assert_eq!((&asked["standing"]["judged"], &asked["blocks"][0]["n"]), (&json!(1), &json!(1)));
    let wrong = client.research(&cookie, &format!("{VERSION}/results?include=robots")).await;
    assert_eq!(wrong.json()["errors"][0]["pointer"], "/include");
    // A simulation holds no place in the design.
    let (_, _, person) = client.join(json!({})).await;
    let slots = client.server.store().sessions("shadow-puppets", &[client.version().await]).await.unwrap();
    let of = |id: &Value| slots.iter().find(|s| Some(s.session_id.as_str()) == id.as_str()).unwrap().slot;
    assert_eq!((of(&state["session_id"]), of(&person["session_id"])), (0, 0));
}

#[tokio::test(flavor = "multi_thread")]
async fn participants_are_a_table_with_all_that_is_known_and_allowed() {
    let client = with("[session]\nparams = [\"batch\"]").await;
    let params = json!({ "PROLIFIC_PID": "a@b", "Batch": "7", "secret": "s3cr3t" });
    let display = json!({ "resolution": [2560, 1440], "viewport": [1280, 720], "device_pixel_ratio": 2, "touch": false, "language": "de" });
    let request = Request::post(SESSIONS)
        .header(header::USER_AGENT, "Gamelan/1")
        .header(header::CONTENT_TYPE, "application/json")
        .body(Body::from(json!({ "params": params, "display": display }).to_string()))
        .unwrap();
    let state = client.send(request).await.json();
    let (path, token) = (
        format!("/api/v1/sessions/{}", state["session_id"].as_str().unwrap()),
        state["token"].as_str().unwrap(),
    );
    client.call("POST", &format!("{path}/consent"), token, &Value::Null).await;
    for trial in 0..3 {
        client.choose(&path, token, trial, "left").await;
    }
    let code = client.call("POST", &format!("{path}/completion"), token, &Value::Null).await.json();
    begin(&client, "late").await;

    let cookie = client.sign_in().await;
    let people = client.rows(&cookie, "participants.csv").await;
    let row = |at: usize, names: &[&str]| -> Vec<String> {
        names.iter().map(|name| people[at][*name].clone()).collect()
    };
    assert_eq!(people.len(), 2);
    assert_eq!(people[0]["completion_code"], code["completion_code"].as_str().unwrap());
    assert_eq!(row(0, &["subject_id", "id_parameter", "param_batch"]), ["a@b", "PROLIFIC_PID", "7"]);
    assert_eq!(row(0, &["resolution_width", "viewport_height", "device_pixel_ratio"]), ["2560", "720", "2"]);
    assert_eq!(
        row(0, &["user_agent", "language", "touch", "reload_count", "refresh_hz"]),
        ["Gamelan/1", "de", "0", "0", "60"]
    );
    assert_eq!(row(0, &["status", "percent_complete", "answers", "judged"]), ["completed", "100", "3", "1"]);
    for time in ["created_at", "consented_at", "completed_at"] {
        assert!(people[0][time].ends_with('Z'), "{time}");
    }
    let took: f64 = people[0]["duration_s"].parse().unwrap();
    assert!((0.0..3600.0).contains(&took));
    assert_eq!(
        row(1, &["status", "judged", "reject_reason", "completion_code"]),
        ["in progress", "0", "no answers", ""]
    );
    let text = client.research(&cookie, &format!("{VERSION}/participants.csv")).await.text();
    assert!(!text.contains("s3cr3t"), "a parameter that the study does not list stays inside");
    let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let codebook = client.research(&cookie, &format!("{VERSION}/participants_codebook.csv")).await.text();
    let described: Vec<&str> =
        codebook.trim_end().split("\r\n").skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(header, described);

    let file = client.research(&cookie, &format!("{VERSION}/export.xlsx")).await;
    assert_eq!(file.header("content-disposition"), "attachment; filename=\"shadow-puppets.xlsx\"");
    assert!(file.bytes.starts_with(b"PK"));
    assert_eq!(client.get(&format!("{VERSION}/participants.csv")).await.status, StatusCode::UNAUTHORIZED);
}

#[tokio::test(flavor = "multi_thread")]
async fn many_starts_at_one_address_are_noticed_and_refused_to_nobody() {
    let client = Client::ready().await;
    for i in 0..32 {
        assert_eq!(begin(&client, &format!("p{i}")).await.status, StatusCode::CREATED);
    }
    let flagged = &results(&client, "").await["standing"]["flagged"];
    assert_eq!((&flagged[0]["flag"], &flagged[0]["sessions"]), (&json!("many_starts"), &json!(2)));
}
