use crate::client::{Client, body_of};
use axum::http::StatusCode;
use kelir_server::Server;
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
async fn nothing_is_stored_before_consent() {
    let client = Client::ready().await;
    let state = client.call("POST", "/api/v1/studies/shadow-puppets/sessions", "", &json!({})).await.json();
    let path = format!("/api/v1/sessions/{}", state["session_id"].as_str().unwrap());
    let answer = client.choose(&path, state["token"].as_str().unwrap(), 0, "left").await;
    assert_eq!((answer.status, &answer.json()["code"]), (StatusCode::CONFLICT, &json!("no_consent")));
}

#[tokio::test(flavor = "multi_thread")]
async fn stimuli_are_immutable_and_known_by_their_hash() {
    let client = Client::ready().await;
    let (_, _, state) = client.join(json!({})).await;
    for side in ["left", "right"] {
        let still = client.get(state["trials"][0]["shown"][side]["url"].as_str().unwrap()).await;
        assert_eq!((still.status, still.header("content-type")), (StatusCode::OK, "image/png"));
        assert!(still.header("cache-control").contains("immutable"));
        assert_eq!(
            kelir_store::sha256_hex(&still.bytes),
            state["trials"][0]["shown"][side]["sha256"].as_str().unwrap()
        );
        let request = axum::http::Request::get(state["trials"][0]["shown"][side]["url"].as_str().unwrap())
            .header("if-none-match", still.header("etag"))
            .body(axum::body::Body::empty());
        assert_eq!(client.send(request.unwrap()).await.status, StatusCode::NOT_MODIFIED);
    }
    let manifest = client.get(state["trials"][2]["shown"]["left"]["url"].as_str().unwrap()).await;
    assert_eq!(manifest.header("content-type"), "application/vnd.kelir.animation+json");
    let frame = manifest.json()["frames"][0].as_str().unwrap().to_owned();
    assert_eq!(client.get(&format!("/stimuli/{frame}")).await.header("content-type"), "image/png");
}

#[tokio::test(flavor = "multi_thread")]
async fn completed_participants_balance_the_sides_and_a_freed_slot_is_taken_again() {
    let client = Client::ready().await;
    for who in 0..4 {
        client.take(json!({ "id": format!("p{who}") }), ["left", "left", "right"]).await;
    }
    let hash = client.server.store().study_versions("shadow-puppets").await.unwrap()[0].config_hash.clone();
    let rows = client.server.store().responses("shadow-puppets", &hash).await.unwrap();
    for pair in ["a", "b", "c"] {
        let left = rows.iter().filter(|(r, _)| r.pair_id == pair && r.left_condition == "pa").count();
        assert_eq!(left, 2, "pair {pair}");
    }
    let sessions = client.server.store().sessions("shadow-puppets", &hash).await.unwrap();
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
