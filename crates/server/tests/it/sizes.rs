//! A study in several sizes: each stimulus is made at each, the page is told of all, and what it showed is stored.

use crate::client::{Client, STUDY, body_of, config};
use crate::placeholder::disc;
use axum::http::StatusCode;
use kelir_server::Server;
use kelir_store::sha256_hex;
use kelir_study::trials::Role;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::sync::atomic::Ordering;

const SIZES: &str = "[display]\nsizes = [[64, 36], [128, 72]]\n[texts]";

fn two_sizes() -> String {
    STUDY.replace("size = [64, 36]\n", "").replacen("[texts]", SIZES, 1)
}

/// The client of before with another study file, its stimuli made.
async fn with_study(client: Client, study: &str) -> Client {
    std::fs::write(client.folder.path().join("studies/shadow-puppets.toml"), study).unwrap();
    let server = Server::open(&config(client.folder.path(), client.drawer.clone())).await.unwrap();
    server.make_stimuli(&|_| {}).await.unwrap();
    Client { server, ..client }
}

async fn in_two_sizes() -> Client {
    with_study(Client::unready().await, &two_sizes()).await
}

#[tokio::test(flavor = "multi_thread")]
async fn each_stimulus_is_made_at_each_size_and_those_that_were_there_are_kept() {
    let client = Client::ready().await;
    let drawn = client.drawer.clone();
    let before =
        client.server.store().version_stimuli("shadow-puppets", &client.version().await).await.unwrap();
    assert_eq!(drawn.drawn.load(Ordering::SeqCst), 6);
    let client = with_study(client, &two_sizes()).await;
    assert_eq!(drawn.drawn.load(Ordering::SeqCst), 12, "the larger ones alone");
    let made =
        client.server.store().version_stimuli("shadow-puppets", &client.version().await).await.unwrap();
    let of = |size: [u32; 2]| made.iter().filter(move |s| s.size == size);
    assert_eq!((of([64, 36]).count(), of([128, 72]).count()), (6, 6));
    assert!(of([64, 36]).zip(&before).all(|(now, then)| now.sha256 == then.sha256));
    // One size written as a list is the study of before.
    let listed = two_sizes().replace(", [128, 72]", "");
    let first = client.version().await;
    let client = with_study(client, &listed).await;
    assert_ne!(client.version().await, first);
    assert_eq!(drawn.drawn.load(Ordering::SeqCst), 12);
}

#[tokio::test(flavor = "multi_thread")]
async fn progress_counts_every_size() {
    let client = Client::unready().await;
    std::fs::write(client.folder.path().join("studies/shadow-puppets.toml"), two_sizes()).unwrap();
    let server = Server::open(&config(client.folder.path(), client.drawer.clone())).await.unwrap();
    let events = std::sync::Mutex::new(Vec::new());
    server.make_stimuli(&|making| events.lock().unwrap().push(making)).await.unwrap();
    let events = events.into_inner().unwrap();
    assert_eq!((events[0].total, events.last().unwrap().done), (12, 12));
    let named: BTreeSet<&str> = events.iter().map(|making| making.stimulus.as_str()).collect();
    assert!(named.contains("a (pa, 64 × 36)") && named.contains("a (pa, 128 × 72)"), "{named:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_page_is_told_of_each_size_and_nothing_tells_the_conditions_apart_in_any() {
    let client = in_two_sizes().await;
    let study = client.get("/api/v1/studies/shadow-puppets").await.json();
    assert_eq!(study["display"], json!({ "sizes": [[64, 36], [128, 72]], "fit": "native" }));
    assert_eq!(study["size"], json!([64, 36]));
    let (_, _, state) = client.join(json!({})).await;
    let mut seen = BTreeSet::new();
    for trial in state["trials"].as_array().unwrap() {
        assert_eq!((&trial["width"], &trial["height"]), (&json!(64), &json!(36)));
        let [larger] = &trial["larger"].as_array().unwrap()[..] else { panic!("{trial}") };
        assert_eq!((&larger["width"], &larger["height"]), (&json!(128), &json!(72)));
        for (shown, width) in [(&trial["shown"], 64), (&larger["shown"], 128)] {
            let mut lengths = BTreeSet::new();
            for side in ["left", "right"] {
                let url = shown[side]["url"].as_str().unwrap();
                let answer = client.get(url).await;
                assert_eq!(answer.status, StatusCode::OK);
                assert_eq!(sha256_hex(&answer.bytes), shown[side]["sha256"].as_str().unwrap());
                let head = answer.bytes.split(|byte| *byte == b'\n').next().unwrap();
                let head: Value = serde_json::from_slice(head).unwrap();
                assert_eq!(head["width"], width);
                lengths.insert(answer.bytes.len());
                assert!(seen.insert(url.to_owned()));
            }
            assert_eq!(lengths.len(), 1, "both of a size are as long");
        }
    }
    // A server that has forgotten what it told finds a larger one again, too.
    let url = state["trials"][0]["larger"][0]["shown"]["left"]["url"].as_str().unwrap();
    let restarted = Server::open(&config(client.folder.path(), client.drawer.clone())).await.unwrap();
    let client = Client { server: restarted, ..client };
    assert_eq!(client.get(url).await.status, StatusCode::OK);
    // A study of one size tells of no other.
    let client = with_study(client, &STUDY).await;
    let (_, _, state) = client.join(json!({})).await;
    assert_eq!(state["trials"][0]["larger"], json!([]));
}

/// The cells of a column of the table of responses, in the order of the trials.
async fn column(client: &Client, cookie: &str, name: &str) -> Vec<String> {
    let rows = client.rows(cookie, "responses.csv").await;
    rows.iter().map(|row| row[name].clone()).collect()
}

#[tokio::test(flavor = "multi_thread")]
async fn what_was_shown_is_stored_exported_and_reported_by_its_size() {
    let client = in_two_sizes().await;
    let (path, token, _) = client.join(json!({})).await;
    // As a page of before the sizes answers; at the larger; at one that the study has not.
    for (trial, size) in [json!(null), json!([128, 72]), json!([99, 99])].into_iter().enumerate() {
        let mut body = body_of("left");
        body["scale"] = json!(1 + trial);
        body["css_width_px"] = json!(100 * (1 + trial));
        match size {
            Value::Null => {}
            size => body["stimulus_size"] = size,
        }
        let answer = client.call("PUT", &format!("{path}/trials/{trial}"), &token, &body).await;
        assert_eq!(answer.status, StatusCode::OK, "{}", answer.text());
    }
    client.call("POST", &format!("{path}/completion"), &token, &Value::Null).await;
    let version = client.version().await;
    let store = client.server.store();
    let stimuli = store.version_stimuli("shadow-puppets", &version).await.unwrap();
    let rows = store.answer_rows("shadow-puppets", std::slice::from_ref(&version)).await.unwrap();
    for (row, size) in rows.iter().zip([[64, 36], [128, 72], [64, 36]]) {
        for role in [Role::Left, Role::Right] {
            let found = stimuli.iter().find(|s| s.sha256 == row.shown[&role].sha256).unwrap();
            assert_eq!((found.size, &found.pixels_sha256), (size, &row.shown[&role].pixels_sha256));
        }
    }
    let cookie = client.sign_in().await;
    assert_eq!(column(&client, &cookie, "stimulus_width_px").await, ["64", "128", "64"]);
    assert_eq!(column(&client, &cookie, "stimulus_height_px").await, ["36", "72", "36"]);
    assert_eq!(column(&client, &cookie, "css_width_px").await, ["100", "200", "300"]);
    assert_eq!(column(&client, &cookie, "flags").await, ["", "", "stimulus_size"]);
    let hashes = column(&client, &cookie, "shown_left_sha256").await;
    assert_eq!(hashes[1], rows[1].shown[&Role::Left].sha256);

    let of_version = "/api/v1/studies/shadow-puppets/versions/current";
    let results = client.research(&cookie, &format!("{of_version}/results")).await.json();
    let said = results["display"].as_str().unwrap();
    assert!(said.contains("64 × 36 or 128 × 72 pixels, natively at each"), "{said}");
    assert_eq!(results["stimuli"].as_array().unwrap().len(), 12);
    assert_eq!(results["stimuli"][1]["size"], json!([128, 72]));
    let report = client.research(&cookie, &format!("{of_version}/report")).await.json();
    assert_eq!(
        report["shown"],
        json!([
            { "size": [64, 36], "answers": 2, "scale": [1.0, 3.0], "css_width_px": [100.0, 300.0] },
            { "size": [128, 72], "answers": 1, "scale": [2.0, 2.0], "css_width_px": [200.0, 200.0] },
        ])
    );
    let written = client.research(&cookie, &format!("{of_version}/report.md")).await.text();
    for said in ["the largest of these that fits", "64 × 36", "128 × 72", "1 to 3"] {
        assert!(written.contains(said), "{said}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_preview_is_told_of_each_size_too() {
    let client = in_two_sizes().await;
    let cookie = client.sign_in().await;
    let request = axum::http::Request::post("/api/v1/studies/shadow-puppets/sessions")
        .header("cookie", cookie)
        .header("content-type", "application/json")
        .body(axum::body::Body::from(json!({ "params": { "preview": "" } }).to_string()))
        .unwrap();
    let state = client.send(request).await.json();
    let larger = &state["trials"][0]["larger"][0];
    assert_eq!(larger["width"], 128, "{state}");
    assert_eq!(client.get(larger["shown"]["left"]["url"].as_str().unwrap()).await.status, StatusCode::OK);
}

#[tokio::test(flavor = "multi_thread")]
async fn pictures_of_ones_own_are_asked_for_at_each_size() {
    let client = Client::unready().await;
    let folder = client.folder.path().join("studies/photos");
    std::fs::create_dir_all(&folder).unwrap();
    for (name, size) in [("small.png", [64, 36]), ("large.png", [128, 72])] {
        std::fs::write(folder.join(name), disc(size, 7, 0.0, true)).unwrap();
    }
    let study = two_sizes();
    let (stills, _) = study.rsplit_once("[[blocks]]").unwrap();
    let with = |files: &str| {
        stills.replace(
            "[conditions.mc]\ntechnique = \"mc\"",
            &format!("[conditions.mc]\nfiles = {{ {files} }}"),
        )
    };
    let pair = "[\"photos/small.png\", \"photos/large.png\"]";
    let good = with(&format!("a = {pair}, b = {pair}"));
    let client = with_study(client, &good).await;
    let made =
        client.server.store().version_stimuli("shadow-puppets", &client.version().await).await.unwrap();
    let sizes: Vec<_> =
        made.iter().filter(|s| s.item == "a" && s.condition == "mc").map(|s| s.size).collect();
    assert_eq!(sizes, [[64, 36], [128, 72]]);
    let swapped = "[\"photos/large.png\", \"photos/small.png\"]";
    std::fs::write(
        client.folder.path().join("studies/shadow-puppets.toml"),
        with(&format!("a = {pair}, b = {swapped}")),
    )
    .unwrap();
    let library = kelir_house::Library::new(client.folder.path());
    let refused = library.study("studies/shadow-puppets.toml").unwrap_err().to_string();
    assert!(refused.contains("conditions.mc.files.b[0]") && refused.contains("128 × 72"), "{refused}");
    assert!(refused.contains("conditions.mc.files.b[1]") && !refused.contains("files.a"), "{refused}");
}
