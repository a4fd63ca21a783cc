use crate::client::{Client, PASSWORD, body_of, config, folder, send};
use crate::placeholder::Placeholder;
use axum::body::Body;
use axum::extract::ConnectInfo;
use axum::http::{Request, StatusCode, header};
use kelir_house::results::report_of_study;
use kelir_house::selection::{VersionRef, With};
use kelir_server::{Server, TrustedProxies};
use serde_json::{Value, json};
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::task::JoinSet;

#[tokio::test(flavor = "multi_thread")]
async fn signing_in_and_out() {
    let client = Client::ready().await;
    let wrong = client.call("POST", "/api/v1/auth/session", "", &json!({ "password": "gong" })).await;
    assert_eq!((wrong.status, &wrong.json()["code"]), (StatusCode::UNAUTHORIZED, &json!("wrong_password")));
    let answer = client.call("POST", "/api/v1/auth/session", "", &json!({ "password": PASSWORD })).await;
    let cookie = answer.header("set-cookie").to_owned();
    for part in ["kelir_session=", "HttpOnly", "SameSite=Strict", "Path=/"] {
        assert!(cookie.contains(part), "{part} in {cookie}");
    }
    let cookie = cookie.split(';').next().unwrap();
    let studies = client.research(cookie, "/api/v1/studies").await.json();
    assert_eq!(studies["items"][0]["id"], "shadow-puppets");
    assert_eq!(studies["items"][0]["status"], "ready");
    let who = client.research(cookie, "/api/v1/auth/session").await.json();
    assert_eq!(who, json!({ "name": "researcher" }));
    let out =
        Request::delete("/api/v1/auth/session").header(header::COOKIE, cookie).body(Body::empty()).unwrap();
    assert_eq!(client.send(out).await.status, StatusCode::NO_CONTENT);
    assert_eq!(client.research(cookie, "/api/v1/studies").await.status, StatusCode::UNAUTHORIZED);
    assert_eq!(client.research("kelir_session=x", "/api/v1/studies").await.status, StatusCode::UNAUTHORIZED);
}

#[tokio::test(flavor = "multi_thread")]
async fn wrong_passwords_lock_nobody_out_behind_a_proxy_or_not() {
    let folder = folder();
    let mut config = config(folder.path(), Arc::new(Placeholder::default()));
    config.trusted_proxies = TrustedProxies::parse(["10.0.0.0/8"]).unwrap();
    let router = Server::open(&config).await.unwrap().router();
    let sign_in = |password: &str, from: &str| {
        let body = Body::from(json!({ "password": password }).to_string());
        let request = Request::post("/api/v1/auth/session").header(header::CONTENT_TYPE, "application/json");
        let request = request.header("X-Forwarded-For", format!("203.0.113.250, {from}"));
        let proxy = ConnectInfo(SocketAddr::from(([10, 0, 0, 1], 4711)));
        send(router.clone(), request.extension(proxy).body(body).unwrap())
    };
    let mut guesses = JoinSet::new();
    (0..9).for_each(|guess| drop(guesses.spawn(sign_in(&format!("guess {guess}"), "198.51.100.7"))));
    assert_eq!(
        sign_in(PASSWORD, "198.51.100.8").await.status,
        StatusCode::NO_CONTENT,
        "another client of the proxy"
    );
    for guess in guesses.join_all().await {
        assert_eq!(guess.json()["code"], "wrong_password");
    }
    let right = sign_in(PASSWORD, "198.51.100.7").await;
    assert_eq!(right.status, StatusCode::NO_CONTENT, "the right password gets in: {}", right.text());
}

#[tokio::test(flavor = "multi_thread")]
async fn results_are_what_the_answers_add_up_to() {
    let client = Client::ready().await;
    let cookie = client.sign_in().await;
    let path = "/api/v1/studies/shadow-puppets/versions/current/results";
    let empty = client.research(&cookie, path).await.json();
    assert_eq!(empty["blocks"][0]["n"], 0);
    assert!(empty["blocks"][0]["t"].is_null() && empty["blocks"][0]["note"].is_string());

    for choices in [["left", "left", "left"], ["left", "right", "left"], ["right", "right", "right"]] {
        client.take(json!({}), choices).await;
    }
    let (path_of_one, token, _) = client.join(json!({})).await;
    client.choose(&path_of_one, &token, 0, "left").await;

    let results = client.research(&cookie, path).await.json();
    assert_eq!(results["participants"], json!({ "started": 4, "in_progress": 1, "completed": 3 }));
    let hash = results["version"].as_str().unwrap();
    // The expected numbers come from the rows by the definition of t.
    let rows = client.server.store().answer_rows("shadow-puppets", &[hash.to_owned()]).await.unwrap();
    for (block, pairs) in [("stills", 2), ("loop", 1)] {
        let mut by_session = std::collections::BTreeMap::<&str, Vec<f64>>::new();
        let of_block = |item: &str| if block == "loop" { item == "c" } else { item != "c" };
        for row in &rows {
            let answer: Value = serde_json::from_str(row.answer.as_ref().unwrap()).unwrap();
            let shown = serde_json::to_value(&row.shown).unwrap();
            let chosen = &shown[answer["choice"].as_str().unwrap()];
            if of_block(chosen["item"].as_str().unwrap()) {
                let hit = f64::from(u8::from(chosen["condition"] == "pa"));
                by_session.entry(&row.session_id).or_default().push(hit);
            }
        }
        let counts: Vec<f64> =
            by_session.values().filter(|c| c.len() == pairs).map(|c| c.iter().sum()).collect();
        assert_eq!(counts.len(), 3);
        let n = counts.len() as f64;
        let mean = counts.iter().sum::<f64>() / n;
        let sd = (counts.iter().map(|c| (c - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
        let got = results["blocks"].as_array().unwrap().iter().find(|b| b["id"] == block).unwrap();
        assert!((got["mean"].as_f64().unwrap() - mean).abs() < 1e-12, "{got}");
        assert!((got["sd"].as_f64().unwrap() - sd).abs() < 1e-12, "{got}");
        if sd > 0.0 {
            let t = (mean - pairs as f64 / 2.0) / (sd / n.sqrt());
            assert!((got["t"].as_f64().unwrap() - t).abs() < 1e-12, "{got}");
            assert!((0.0..=1.0).contains(&got["p"].as_f64().unwrap()));
        } else {
            assert!(got["t"].is_null() && got["note"].is_string(), "{got}");
        }
    }
    assert_eq!(results["stimuli"].as_array().unwrap().len(), 6);

    let offline = async |folder: &std::path::Path, study: &str| {
        let (version, with) = (VersionRef::Current, With::default());
        report_of_study(folder, study, &version, &with).await
    };
    let report = offline(client.folder.path(), "shadow-puppets").await.unwrap();
    let summaries: Vec<_> =
        report.report.blocks.iter().map(|b| serde_json::to_value(&b.summary).unwrap()).collect();
    assert_eq!(json!(summaries), results["blocks"], "the command reads the same");
    assert!(offline(client.folder.path(), "nobody").await.is_err());
    assert!(offline(&client.folder.path().join("none"), "shadow-puppets").await.is_err());
}

#[tokio::test(flavor = "multi_thread")]
async fn the_export_has_one_row_a_trial_and_a_codebook_for_every_column() {
    let client = Client::ready().await;
    client.take(json!({ "PROLIFIC_PID": "=cmd|' /C calc'!A0" }), ["left", "right", "left"]).await;
    client.take(json!({ "PROLIFIC_PID": "5f0a" }), ["left", "right", "left"]).await;
    let cookie = client.sign_in().await;
    let answer =
        client.research(&cookie, "/api/v1/studies/shadow-puppets/versions/current/responses.csv").await;
    assert_eq!(answer.header("content-type"), "text/csv; charset=utf-8");
    let text = answer.text();
    let lines: Vec<&str> = text.trim_end().split("\r\n").collect();
    assert_eq!(lines.len(), 7);
    assert!(text.contains("'=cmd|' /C calc'!A0,") && !text.contains(",=cmd") && !text.contains("\n=cmd"));
    let header: Vec<&str> = lines[0].split(',').collect();
    let codebook =
        client.research(&cookie, "/api/v1/studies/shadow-puppets/versions/current/codebook.csv").await.text();
    let described: Vec<&str> =
        codebook.trim_end().split("\r\n").skip(1).map(|l| l.split(',').next().unwrap()).collect();
    assert_eq!(header, described);
    let at = |name: &str| header.iter().position(|h| *h == name).unwrap();
    for line in &lines[1..] {
        // The one quoted cell, the stimuli, has a comma within: it is taken out before splitting.
        let (before, rest) = line.split_once('"').unwrap();
        let (_, after) = rest.rsplit_once('"').unwrap();
        let cells: Vec<&str> = before.split(',').chain(after.split(',').skip(1)).collect();
        assert_eq!(cells.len(), header.len(), "{line}");
        let cell = |name: &str| cells[at(name)];
        assert_eq!(cell("chosen_condition"), cell(&format!("{}_condition", cell("response"))));
        assert_eq!(cell("target_chosen"), if cell("chosen_condition") == "pa" { "1" } else { "0" });
        assert_eq!((cell("rt"), cell("time_elapsed"), cell("viewport_height")), ("812.5", "5000", "800"));
        assert_eq!((cell("status"), cell("percent_complete")), ("completed", "100"));
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn the_table_of_events_has_one_row_an_event_and_a_codebook_for_every_column() {
    let client = Client::ready().await;
    let (path, token, _) = client.join(json!({ "PROLIFIC_PID": "5f0a" })).await;
    let mut body = body_of("left");
    body["events"] = json!([
        { "event": "blur", "time_ms": 12.5 },
        { "event": "ignored", "time_ms": -180, "reason": "double", "input": "mouse", "choice": "left" },
    ]);
    let first = client.call("PUT", &format!("{path}/trials/0"), &token, &body).await;
    assert_eq!(first.status, StatusCode::OK, "{}", first.text());
    // A page of before has no log.
    assert_eq!(client.choose(&path, &token, 1, "right").await.status, StatusCode::OK);
    let cookie = client.sign_in().await;
    let table = |name: &str| format!("/api/v1/studies/shadow-puppets/versions/current/{name}");
    let answer = client.research(&cookie, &table("events.csv")).await;
    assert_eq!(answer.header("content-type"), "text/csv; charset=utf-8");
    let text = answer.text();
    let lines: Vec<Vec<&str>> = text.trim_end().split("\r\n").map(|line| line.split(',').collect()).collect();
    let codebook = client.research(&cookie, &table("events_codebook.csv")).await.text();
    let described: Vec<&str> =
        codebook.trim_end().split("\r\n").skip(1).map(|l| l.split(',').next().unwrap()).collect();
    assert_eq!(lines[0], described);
    let cell = |row: usize, name: &str| lines[row][described.iter().position(|d| *d == name).unwrap()];
    assert_eq!(lines.len(), 3);
    let cells = |row| {
        ["subject_id", "trial_index", "event_index", "event", "time_ms", "reason"].map(|name| cell(row, name))
    };
    assert_eq!(cells(1), ["5f0a", "0", "0", "blur", "12.5", ""]);
    assert_eq!(cells(2), ["5f0a", "0", "1", "ignored", "-180", "double"]);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_started_server_listens_answers_and_stops() {
    let client = Client::unready().await;
    let handle = Server::start(config(client.folder.path(), client.drawer.clone())).await.unwrap();
    handle.ready().await.unwrap();
    let address = handle.address();
    let get = move || {
        use std::io::{Read, Write};
        let mut stream = std::net::TcpStream::connect(address)?;
        write!(stream, "GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")?;
        let mut text = String::new();
        stream.read_to_string(&mut text).map(|_| text)
    };
    let text = tokio::task::spawn_blocking(get).await.unwrap().unwrap();
    assert!(text.starts_with("HTTP/1.1 200"), "{text}");
    handle.shutdown().await;
    assert!(tokio::task::spawn_blocking(get).await.unwrap().is_err());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_leaked_database_holds_no_secret() {
    let client = Client::ready().await;
    let (_, token, _) = client.join(json!({})).await;
    let cookie = client.sign_in().await;
    client.server.store().close().await;
    let bytes = std::fs::read(client.folder.path().join("kelir.sqlite")).unwrap();
    let holds = |secret: &str| bytes.windows(secret.len()).any(|window| window == secret.as_bytes());
    assert!(holds("CREATE TABLE"), "the search finds what is there");
    for secret in [PASSWORD, &token, cookie.split('=').nth(1).unwrap()] {
        assert!(!holds(secret));
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn the_screened_are_left_out_named_and_shown_apart() {
    let folder = folder();
    let rules = "[screening]\nmin_rt_ms = 300\nincomplete = true\n[texts]";
    let study = crate::client::STUDY.replace("[texts]", rules);
    std::fs::write(folder.path().join("studies/shadow-puppets.toml"), study).unwrap();
    let drawer = Arc::<Placeholder>::default();
    let server = Server::open(&config(folder.path(), drawer.clone())).await.unwrap();
    let client = Client { server, folder, drawer };
    client.server.make_stimuli(&|_| {}).await.unwrap();
    let cookie = client.sign_in().await;
    let results = async || {
        client.research(&cookie, "/api/v1/studies/shadow-puppets/versions/current/results").await.json()
    };

    client.take(json!({}), ["left", "right", "left"]).await;
    let before = results().await;
    assert!(before["excluded"].as_array().unwrap().is_empty() && before["blocks_with_excluded"].is_null());

    // One is too fast once; the other has taken the first block and is still at it, which is no reason to be left out.
    for (rts, choices) in [([900.0, 299.0, 900.0], 3), ([900.0, 900.0, 900.0], 2)] {
        let (path, token, _) = client.join(json!({})).await;
        for (trial, rt) in rts.iter().enumerate().take(choices) {
            let mut body = body_of("left");
            body["rt"] = json!(rt);
            let answer = client.call("PUT", &format!("{path}/trials/{trial}"), &token, &body).await;
            assert_eq!(answer.status, StatusCode::OK);
        }
    }
    let after = results().await;
    let reasons: Vec<&str> = after["excluded"]
        .as_array()
        .unwrap()
        .iter()
        .map(|e| e["reasons"][0]["reason"].as_str().unwrap())
        .collect();
    assert_eq!(reasons, ["too_fast"]);
    assert_eq!(after["blocks"], before["blocks"]);
    assert_eq!(after["blocks_with_excluded"][0]["n"], 3);
    assert_eq!(after["blocks_with_excluded"][1]["n"], 2);
}

#[tokio::test(flavor = "multi_thread")]
async fn the_report_and_the_pairs_agree_with_the_results() {
    let client = Client::ready().await;
    for choices in [
        ["left", "left", "left"],
        ["left", "right", "left"],
        ["right", "right", "right"],
        ["left", "left", "right"],
    ] {
        client.take(json!({}), choices).await;
    }
    let cookie = client.sign_in().await;
    let path = "/api/v1/studies/shadow-puppets/versions/current";
    let results = client.research(&cookie, &format!("{path}/results")).await.json();
    let report = client.research(&cookie, &format!("{path}/report")).await.json();
    for key in ["study", "version", "pooled", "participants", "stimuli"] {
        assert_eq!(report[key], results[key], "{key}");
    }
    for (block, short) in
        report["blocks"].as_array().unwrap().iter().zip(results["blocks"].as_array().unwrap())
    {
        for (key, value) in short.as_object().unwrap() {
            assert_eq!(&block[key], value, "{key}");
        }
        assert_eq!(block["analysis"]["proportion"]["trials"], 4 * short["items"].as_u64().unwrap());
    }
    assert_eq!((&report["chain"]["rows"], &report["chain"]["faults"]), (&json!(12), &json!([])));
    let (version, with) = (VersionRef::Current, With::default());
    let offline = report_of_study(client.folder.path(), "shadow-puppets", &version, &with).await.unwrap();
    assert!(serde_json::to_value(&offline).unwrap() == report, "the command says the same");

    // The same as files: researchers only, to be kept, and whole in themselves.
    for (ending, media_type, begins) in [
        ("html", "text/html; charset=utf-8", "<!doctype html>"),
        ("md", "text/markdown; charset=utf-8", "# Small"),
    ] {
        let path = format!("{path}/report.{ending}");
        assert_eq!(client.get(&path).await.status, StatusCode::UNAUTHORIZED);
        let file = client.research(&cookie, &path).await;
        assert_eq!((file.status, file.header("content-type")), (StatusCode::OK, media_type));
        let name = format!("attachment; filename=\"shadow-puppets-report.{ending}\"");
        assert_eq!(file.header("content-disposition"), name);
        let text = file.text();
        assert!(text.starts_with(begins) && text.contains(report["version"].as_str().unwrap()), "{text}");
        let t = report["blocks"][0]["t"].as_f64().unwrap();
        let shown =
            if ending == "html" { format!("<data value=\"{t}\">") } else { format!("{:.4}", t.abs()) };
        assert!(text.contains(&shown), "{shown} in {text}");
    }
    let nobody = client.research(&cookie, "/api/v1/studies/nobody/versions/current/report.html").await;
    assert_eq!(nobody.status, StatusCode::NOT_FOUND);

    let pairs = client.research(&cookie, &format!("{path}/pairs.csv")).await.text();
    let rows: Vec<Vec<&str>> = pairs.trim_end().split("\r\n").map(|line| line.split(',').collect()).collect();
    let header =
        ["observer", "session", "scene", "condition_A", "condition_B", "is_A_selected", "left_condition"];
    assert_eq!((rows[0].as_slice(), rows.len()), (&header[..], 13));
    // A is pa, the target, in both blocks: what is counted here is what the report counts.
    let chosen = rows[1..].iter().filter(|row| row[3] == "pa" && row[5] == "1").count() as u64;
    let counted: u64 = report["blocks"]
        .as_array()
        .unwrap()
        .iter()
        .map(|b| b["analysis"]["proportion"]["chosen"].as_u64().unwrap())
        .sum();
    assert_eq!(chosen, counted);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_hostile_study_file_writes_no_markup_into_its_report() {
    let folder = folder();
    let study =
        crate::client::STUDY.replace("Small", "<script>alert(1)</script>").replace("Which?", "<img src=x>");
    std::fs::write(folder.path().join("studies/shadow-puppets.toml"), study).unwrap();
    let drawer = Arc::<Placeholder>::default();
    let server = Server::open(&config(folder.path(), drawer.clone())).await.unwrap();
    server.make_stimuli(&|_| {}).await.unwrap();
    let client = Client { server, folder, drawer };
    let cookie = client.sign_in().await;
    for ending in ["html", "md"] {
        let path = format!("/api/v1/studies/shadow-puppets/versions/current/report.{ending}");
        let text = client.research(&cookie, &path).await.text();
        assert!(!text.contains("<script") && !text.contains("<img"), "{text}");
        assert!(
            text.contains("&lt;script&gt;alert(1)&lt;/script&gt;") && text.contains("0 began."),
            "{text}"
        );
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn the_papers_own_tests_can_be_laid_beside_the_results() {
    let client = Client::unready().await;
    let cookie = client.sign_in().await;
    let paper = client.research(&cookie, "/api/v1/papers/taylor-cameron").await.json();
    let t: Vec<f64> =
        paper["comparisons"].as_array().unwrap().iter().map(|c| c["test"]["t"].as_f64().unwrap()).collect();
    for (ours, printed) in t.iter().zip([-1.437_591, 4.208_834, -3.983_482]) {
        assert!((ours - printed).abs() < 5e-7, "{ours} is not {printed}");
    }
}
