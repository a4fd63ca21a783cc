use crate::client::{Client, body_of};
use axum::body::Body;
use axum::http::{Request, StatusCode};
use kelir_server::Server;
use kelir_study::trials::Role;
use serde_json::{Value, json};

#[tokio::test(flavor = "multi_thread")]
async fn from_the_first_page_to_the_code() {
    let client = Client::ready().await;
    let study = client.get("/api/v1/studies/shadow-puppets").await.json();
    assert_eq!(study["size"], json!([64, 36]));
    assert_eq!(study["texts"]["welcome"], json!(["w"]));
    let (path, token, state) = client.join(json!({ "PROLIFIC_PID": "abc123" })).await;
    assert_eq!((&state["status"], &state["next_trial"]), (&json!("in_progress"), &json!(0)));
    assert_eq!(state["trials"].as_array().unwrap().len(), 3);
    assert_eq!((&state["most_trials"], &state["more"]), (&json!(3), &json!(false)));

    let early = client.call("POST", &format!("{path}/completion"), &token, &Value::Null).await;
    assert_eq!(early.status, StatusCode::CONFLICT);
    assert_eq!(early.json()["code"], "incomplete");
    assert_eq!(early.json()["missing"], json!([0, 1, 2]));

    for (trial, next) in [(1, json!(0)), (0, json!(2)), (2, Value::Null)] {
        let answer = client.choose(&path, &token, trial, "left").await;
        assert_eq!(
            (answer.status, &answer.json()),
            (
                StatusCode::OK,
                &json!({ "acknowledged": true, "next_trial": next, "more": false, "trials": [] })
            )
        );
    }
    let done = client.call("POST", &format!("{path}/completion"), &token, &Value::Null).await.json();
    let code = done["completion_code"].as_str().unwrap();
    assert_eq!(done["redirect"], format!("https://example.org/?cc={code}&who=abc123"));
    let before_the_update =
        client.call("POST", &format!("{path}/complete"), &token, &Value::Null).await.json();
    assert_eq!(before_the_update, done, "the code is the session's own, and the old address still gives it");
    let state = client.call("GET", &path, &token, &Value::Null).await.json();
    assert_eq!((&state["status"], &state["completion_code"]), (&json!("completed"), &json!(code)));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_participant_never_learns_a_condition() {
    let client = Client::ready().await;
    let (path, token, state) = client.join(json!({})).await;
    let seen = [
        client.get("/api/v1/studies/shadow-puppets").await.text(),
        state.to_string(),
        client.call("GET", &path, &token, &Value::Null).await.text(),
        client.choose(&path, &token, 0, "left").await.text(),
    ];
    for text in seen {
        for secret in ["\"pa\"", "\"mc\"", "condition", "target", "provenance", "technique", "spp"] {
            assert!(!text.contains(secret), "{secret} in {text}");
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn the_first_answer_stands() {
    let client = Client::ready().await;
    let (path, token, _) = client.join(json!({})).await;
    assert_eq!(client.choose(&path, &token, 0, "left").await.status, StatusCode::OK);
    assert_eq!(
        client.choose(&path, &token, 0, "left").await.status,
        StatusCode::OK,
        "a retry is acknowledged"
    );
    let other = client.choose(&path, &token, 0, "right").await;
    assert_eq!((other.status, &other.json()["code"]), (StatusCode::CONFLICT, &json!("already_answered")));
    let mut slower = body_of("left");
    slower["rt"] = json!(900.0);
    let other = client.call("PUT", &format!("{path}/trials/0"), &token, &slower).await;
    assert_eq!(other.status, StatusCode::CONFLICT, "another response time is another answer");
}

#[tokio::test(flavor = "multi_thread")]
async fn whatever_a_browser_or_its_clock_makes_of_an_answer_is_stored_and_the_code_given() {
    let client = Client::ready().await;
    let (path, token, _) = client.join(json!({ "id": "odd" })).await;
    let odd = [
        json!({ "choice": "left" }),
        json!({ "choice": "right", "rt": -3.5, "onset": -1e9, "viewport": "1280x800", "frames": [], "timestamp": {}, "input": "nose" }),
        json!({ "choice": "left", "rt": null, "scale": "1", "refresh_hz": 1e300, "reload_count": 0.5, "plugin_version": "x".repeat(9999) }),
    ];
    for (trial, sent) in odd.iter().enumerate() {
        let method = if trial == 1 { "POST" } else { "PUT" };
        let answer = client.call(method, &format!("{path}/trials/{trial}"), &token, sent).await;
        assert_eq!(answer.status, StatusCode::OK, "{}", answer.text());
    }
    let done = client.call("POST", &format!("{path}/completion"), &token, &Value::Null).await;
    assert!(done.json()["completion_code"].is_string(), "{}", done.text());

    let cookie = client.sign_in().await;
    let rows = client.rows(&cookie, "responses.csv").await;
    assert_eq!(rows.len(), odd.len());
    let flags =
        ["rt", "frames input onset rt timestamp viewport", "plugin_version reload_count rt scale refresh_hz"];
    for (row, flags) in rows.iter().zip(flags) {
        let sorted =
            |text: &str| text.split(' ').map(str::to_owned).collect::<std::collections::BTreeSet<_>>();
        assert_eq!((sorted(&row["flags"]), row["rt"].as_str()), (sorted(flags), ""));
    }
    let results = "/api/v1/studies/shadow-puppets/versions/current/results";
    let results = client.research(&cookie, results).await;
    assert_eq!(results.status, StatusCode::OK, "{}", results.text());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_session_knows_what_its_browser_called_itself() {
    let client = Client::ready().await;
    let named = |name: Vec<u8>| {
        Request::post("/api/v1/studies/shadow-puppets/sessions")
            .header("content-type", "application/json")
            .header("user-agent", axum::http::HeaderValue::from_bytes(&name).unwrap())
            .body(Body::from("{}"))
            .unwrap()
    };
    for (sent, kept) in [
        (b"Tamasha/1.0".to_vec(), "Tamasha/1.0".to_owned()),
        ([b"\xff".as_slice(), &[b'x'; 999]].concat(), format!("\u{fffd}{}", "x".repeat(511))),
    ] {
        let state = client.send(named(sent)).await.json();
        let session =
            client.server.store().session(state["session_id"].as_str().unwrap()).await.unwrap().unwrap();
        assert_eq!(session.user_agent, Some(kept));
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn nothing_is_stored_before_consent() {
    let client = Client::ready().await;
    let state = client.call("POST", "/api/v1/studies/shadow-puppets/sessions", "", &json!({})).await.json();
    let path = format!("/api/v1/sessions/{}", state["session_id"].as_str().unwrap());
    let answer = client.choose(&path, state["token"].as_str().unwrap(), 0, "left").await;
    assert_eq!((answer.status, &answer.json()["code"]), (StatusCode::CONFLICT, &json!("no_consent")));
}

#[tokio::test(flavor = "multi_thread")]
async fn completed_participants_balance_the_sides_and_a_freed_slot_is_taken_again() {
    let client = Client::ready().await;
    for who in 0..4 {
        client.take(json!({ "id": format!("p{who}") }), ["left", "left", "right"]).await;
    }
    let hash = client.server.store().study_versions("shadow-puppets").await.unwrap()[0].version.clone();
    let rows =
        client.server.store().answer_rows("shadow-puppets", std::slice::from_ref(&hash)).await.unwrap();
    for item in ["a", "b", "c"] {
        let left =
            rows.iter().map(|row| &row.shown[&Role::Left]).filter(|s| s.item == item && s.condition == "pa");
        assert_eq!(left.count(), 2, "item {item}");
    }
    let sessions = client.server.store().sessions("shadow-puppets", &[hash]).await.unwrap();
    assert_eq!(sessions.iter().map(|s| s.slot).collect::<Vec<_>>(), [0, 1, 2, 3]);
    assert_eq!(sessions[0].subject_id, "p0");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_session_goes_on_with_its_own_version_after_the_study_has_changed() {
    let client = Client::ready().await;
    let (path, token, before) = client.join(json!({})).await;
    client.choose(&path, &token, 0, "left").await;
    let changed = crate::client::STUDY.replace("seed = 3", "seed = 4").replace("[64, 36]", "[80, 45]");
    std::fs::write(client.folder.path().join("studies/shadow-puppets.toml"), changed).unwrap();
    let config = crate::client::config(client.folder.path(), client.drawer.clone());
    let restarted = Client { server: Server::open(&config).await.unwrap(), ..client };
    let after = restarted.call("GET", &path, &token, &Value::Null).await.json();
    assert_eq!(after["next_trial"], 1);
    assert_eq!(after["trials"][1]["shown"], before["trials"][1]["shown"]);
    assert_eq!(after["trials"][1]["width"], 64);
    assert_eq!(restarted.choose(&path, &token, 1, "left").await.status, StatusCode::OK);
}

/// The small study with an adaptive two-interval block over seven levels before its animation.
fn adaptive(procedure: &str) -> String {
    let levels: Vec<String> = (0..7)
        .map(|i| format!("{{ id = \"l{i}\", scene = \"../scenes/near.toml\", level = {i} }}"))
        .collect();
    let block = format!(
        "[[blocks]]\nid = \"levels\"\ntitle = \"Levels\"\nkind = \"still\"\ntrial = \"two-interval\"\nconditions = [\"pa\", \"mc\"]\n\
         target = \"pa\"\nitems = [{}]\n[blocks.psychometric]\nfunction = \"logistic\"\ndirection = \"rising\"\nlabel = \"level\"\n\
         [blocks.adaptive]\n{procedure}\n[[blocks]]\nid = \"loop\"",
        levels.join(", ")
    );
    crate::client::STUDY.replace("[[blocks]]\nid = \"loop\"", &block)
}

const STAIRCASE: &str = "procedure = \"staircase\"\ntrials = 20\nreversals = 4\ndown = 2";

/// The condition that a role of a decided trial shows; only the database knows.
async fn conditions(client: &Client, session: &str) -> Vec<Vec<String>> {
    let trials = client.server.store().trials(session).await.unwrap();
    trials
        .iter()
        .map(|t| t.trial.shown.values().map(|placed| placed.condition.to_string()).collect())
        .collect()
}

#[tokio::test(flavor = "multi_thread")]
async fn an_adaptive_block_is_decided_from_the_stored_answers_and_a_restart_changes_nothing() {
    let folder = crate::client::folder();
    std::fs::write(folder.path().join("studies/shadow-puppets.toml"), adaptive(STAIRCASE)).unwrap();
    let drawer = std::sync::Arc::new(crate::placeholder::Placeholder::default());
    let config = crate::client::config(folder.path(), drawer.clone());
    let server = Server::open(&config).await.unwrap();
    server.make_stimuli(&|_| {}).await.unwrap();
    let mut client = Client { server, folder, drawer };
    let (path, token, state) = client.join(json!({})).await;
    let session = state["session_id"].as_str().unwrap().to_owned();
    assert_eq!((state["trials"].as_array().unwrap().len(), &state["more"]), (3, &json!(true)));
    assert_eq!(state["most_trials"], 2 + 20 + 1);
    assert_eq!(state["trials"][2]["trial"], "two-interval");
    assert_eq!(state["trials"][2]["settings"]["mask_ms"], 250.0);
    let mut known = 3;
    let mut trial = 0;
    loop {
        // The target always, then never: down two levels at a time, up one.
        let shown = conditions(&client, &session).await;
        let first = shown[trial][0] == "pa";
        let wants_target = trial < 9;
        let state = client.call("GET", &path, &token, &Value::Null).await.json();
        let two_interval = state["trials"][trial]["trial"] == "two-interval";
        let choice = match (two_interval, first == wants_target) {
            (true, true) => "first",
            (true, false) => "second",
            (false, true) => "left",
            (false, false) => "right",
        };
        let answer = client
            .call("PUT", &format!("{path}/trials/{trial}?known={known}"), &token, &body_of(choice))
            .await;
        assert_eq!(answer.status, StatusCode::OK, "{}", answer.text());
        let ack = answer.json();
        // What the acknowledgement tells is what the state tells, and a resend tells it again.
        let again = client
            .call("PUT", &format!("{path}/trials/{trial}?known={known}"), &token, &body_of(choice))
            .await;
        assert_eq!(again.json(), ack);
        known += ack["trials"].as_array().unwrap().len();
        if trial == 6 {
            let early = client.call("POST", &format!("{path}/completion"), &token, &Value::Null).await;
            assert_eq!((early.status, &early.json()["more"]), (StatusCode::CONFLICT, &json!(true)));
            let server = Server::open(&config).await.unwrap();
            client = Client { server, ..client };
        }
        let state = client.call("GET", &path, &token, &Value::Null).await.json();
        assert_eq!(state["trials"].as_array().unwrap().len(), known);
        if state["next_trial"].is_null() && state["more"] == json!(false) {
            break;
        }
        trial += 1;
    }
    let trials = client.server.store().trials(&session).await.unwrap();
    let levels: Vec<&str> =
        trials.iter().filter(|t| t.trial.block_id == "levels").map(|t| t.trial.item_id.as_str()).collect();
    // Two down, one up by 4, 2, then 1 from the easiest (l6), the target in the first seven of them; worked out by hand.
    assert_eq!(levels[..8], ["l6", "l6", "l2", "l2", "l0", "l0", "l0", "l0"], "{levels:?}");
    assert_eq!(trials.last().unwrap().trial.block_id, "loop", "the block after it follows");
    let done = client.call("POST", &format!("{path}/completion"), &token, &Value::Null).await;
    assert_eq!(done.status, StatusCode::OK, "{}", done.text());
    assert!(client.server.store().verify_chain("shadow-puppets").await.unwrap().faults.is_empty());
}

#[tokio::test(flavor = "multi_thread")]
async fn an_answer_is_held_to_its_own_kind() {
    let client = Client::ready().await;
    let (path, token, _) = client.join(json!({})).await;
    let refused = client.choose(&path, &token, 0, "first").await;
    assert_eq!(refused.status, StatusCode::UNPROCESSABLE_ENTITY);
    assert_eq!(refused.json()["errors"][0]["pointer"], "/choice");
    let other = client.choose(&path, &token, 0, "left").await;
    assert_eq!(other.status, StatusCode::OK);
    let mut slower = body_of("left");
    slower["rt"] = json!(900.0);
    let told = client.call("PUT", &format!("{path}/trials/0"), &token, &slower).await.json();
    assert_eq!(told["stored"]["answer"], json!({ "choice": "left", "rt_ms": 812.5 }));
    assert_eq!(told["stored"]["payload"]["plugin_version"], "0.1.0");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_stimulus_that_is_missing_is_an_error_and_never_an_empty_hash() {
    let client = Client::ready().await;
    let (path, token, state) = client.join(json!({})).await;
    // Somebody removes a picture of the version behind the server's back; a session of it that goes on after a restart finds out.
    let trials = client.server.store().trials(state["session_id"].as_str().unwrap()).await.unwrap();
    for trial in &trials {
        for (role, placed) in &trial.trial.shown {
            let hashes = &trial.stimuli[role];
            assert!(hashes.sha256.len() == 64 && hashes.pixels_sha256.len() == 64, "{placed:?}");
        }
    }
    let made: kelir_store::StudyStimulus = client
        .server
        .store()
        .version_stimuli("shadow-puppets", &client.version().await)
        .await
        .unwrap()
        .remove(0);
    let mut lacking = trials[0].clone();
    lacking.stimuli.clear();
    let error = lacking.shown(None).unwrap_err().to_string();
    assert!(error.contains("has no stimulus of condition"), "{error}");
    assert_eq!(made.sha256.len(), 64);
    assert_eq!(client.choose(&path, &token, 0, "left").await.status, StatusCode::OK);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_lost_reply_is_asked_for_again_and_begins_nothing_twice() {
    let client = Client::ready().await;
    let ask = async |key: &str| {
        let request = Request::post("/api/v1/studies/shadow-puppets/sessions")
            .header("idempotency-key", key)
            .header("content-type", "application/json");
        client.send(request.body(Body::from("{}")).unwrap()).await
    };
    let (first, again) = (ask("k1").await, ask("k1").await);
    assert_eq!((first.status, again.status), (StatusCode::CREATED, StatusCode::CREATED), "{}", again.text());
    let (first, again) = (first.json(), again.json());
    assert_eq!(first["session_id"], again["session_id"]);
    let path = format!("/api/v1/sessions/{}", first["session_id"].as_str().unwrap());
    let old = client.call("GET", &path, first["token"].as_str().unwrap(), &Value::Null).await;
    assert_eq!(old.status, StatusCode::UNAUTHORIZED, "the old token is void");
    let token = again["token"].as_str().unwrap();
    let consent = client.call("POST", &format!("{path}/consent"), token, &Value::Null).await;
    assert_eq!(consent.status, StatusCode::OK);
    let late = ask("k1").await;
    assert_eq!((late.status, late.json()["code"].clone()), (StatusCode::CONFLICT, json!("already_begun")));
    assert_ne!(ask("k2").await.json()["session_id"], first["session_id"]);
    for wrong in ["", "a b", &"k".repeat(256)] {
        let refused = ask(wrong).await;
        assert_eq!(refused.json()["code"], "invalid_parameter", "{wrong}: {}", refused.text());
    }
    assert_eq!(ask(&"k".repeat(255)).await.status, StatusCode::CREATED);
}
