//! The whole line: three people take the built-in study; what they clicked is what is stored and judged.

use kelir_tests::{Server, browser, kelir_ok, prepared_data, root, sql};
use serde_json::{Value, json};

const STUDY: &str = "shadow-puppets";

/// t of a one-sample test, worked out from the definition.
fn t_statistic(values: &[f64], mu: f64) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let sd = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
    (mean - mu) / (sd / n.sqrt())
}

#[test]
fn three_participants_from_the_welcome_to_the_t_test() {
    let data = prepared_data();
    let server = Server::start(data.path(), true);
    let shots = root().join("tests/screenshots");
    let desktop = json!({"width": 1280, "height": 800});
    let phone = json!({"width": 390, "height": 844});
    let taken = browser(
        "participants.mjs",
        &json!({"base": server.base, "study": STUDY, "shots": shots, "participants": [
            {"name": "ana", "viewport": desktop, "touch": false, "input": "mouse", "choices": ["left", "right", "right", "left", "left"]},
            {"name": "budi", "viewport": phone, "deviceScaleFactor": 3, "touch": true, "input": "touch", "choices": ["right", "right", "left", "left", "right"]},
            {"name": "citra", "viewport": desktop, "touch": false, "input": "keyboard", "choices": ["left", "left", "left", "right", "left"], "reloadAfter": 2},
        ]}),
    );
    let taken = taken.as_array().unwrap();
    for participant in taken {
        assert_eq!(participant["complaints"], json!([]), "the browser's console is clean");
        assert_eq!(participant["trials"].as_array().unwrap().len(), 5);
        assert!(participant["code"].as_str().unwrap().len() >= 6, "{participant}");
    }

    // The rows in SQLite, read with another program, are exactly what was clicked.
    let database = database(data.path());
    let rows = sql(
        &database,
        "SELECT a.trial_index, json_extract(s.params, '$.PROLIFIC_PID') AS person, s.completion_code,
         json_extract(t.trial, '$.block_id') AS block_id,
         json_extract(a.row, '$[5].left.sha256') AS left_sha256, json_extract(a.row, '$[5].right.sha256') AS right_sha256,
         (SELECT width FROM stimuli WHERE sha256 = json_extract(a.row, '$[5].left.sha256')) AS width,
         (SELECT width FROM stimuli WHERE sha256 = json_extract(a.row, '$[5].right.sha256')) AS right_width,
         json_extract(a.row, '$[5].left.condition') AS left_condition, json_extract(a.row, '$[5].right.condition') AS right_condition,
         json_extract(c.answer, '$.choice') AS choice, json_extract(c.answer, '$.rt_ms') AS rt_ms,
         json_extract(a.row, '$[5].' || json_extract(c.answer, '$.choice') || '.condition') AS chosen_condition
         FROM answers a JOIN sessions s USING (session_id) JOIN session_trials t USING (session_id, trial_index)
         JOIN answer_contents c ON c.study_id = a.study_id AND c.seq = a.seq ORDER BY s.created_at, a.trial_index",
    );
    assert_eq!(rows.len(), 15, "one row a trial");
    for (rows, participant) in rows.chunks(5).zip(taken) {
        for (index, (row, trial)) in rows.iter().zip(participant["trials"].as_array().unwrap()).enumerate() {
            assert_eq!(row["person"], participant["name"]);
            assert_eq!(row["completion_code"], participant["code"]);
            assert_eq!(row["trial_index"], index);
            assert_eq!(row["choice"], trial["choice"]);
            // A phone of three device pixels to a CSS pixel has room for the larger size.
            let width = if participant["name"] == "budi" { 1008 } else { 592 };
            assert_eq!((&row["width"], &row["right_width"]), (&json!(width), &json!(width)));
            for side in ["left", "right"] {
                let pixels = pixels_of(data.path(), row[format!("{side}_sha256")].as_str().unwrap());
                let seen = trial[side].as_str().unwrap().to_owned();
                assert!(pixels.contains(&seen), "what was on the {side} is what row {index} says");
            }
            assert_ne!(row["left_sha256"], row["right_sha256"]);
            let side = if trial["choice"] == "left" { "left_condition" } else { "right_condition" };
            assert_eq!(row["chosen_condition"], row[side]);
            assert!(row["rt_ms"].as_f64().unwrap() > 0.0);
        }
    }
    assert!(
        rows.iter()
            .any(|row| row["left_condition"] == "simulated-photo"
                || row["right_condition"] == "simulated-photo")
    );

    // t per block, recomputed here from those rows.
    let expected: Vec<(String, f64)> = blocks(&rows)
        .into_iter()
        .map(|(block, pairs)| {
            let chosen = |chunk: &[Value]| {
                chunk
                    .iter()
                    .filter(|row| row["block_id"] == block.as_str() && row["chosen_condition"] == "pa")
                    .count() as f64
            };
            let counts: Vec<f64> = rows.chunks(5).map(chosen).collect();
            (block, t_statistic(&counts, pairs as f64 / 2.0))
        })
        .collect();
    assert_eq!(expected.len(), 3);

    let stats: Value = serde_json::from_str(&kelir_ok(&[
        "stats",
        STUDY,
        "--data",
        data.path().to_str().unwrap(),
        "--format",
        "json",
    ]))
    .unwrap();
    let password = std::fs::read_to_string(data.path().join("researcher-password")).unwrap();
    let page = browser(
        "console.mjs",
        &json!({"base": server.base, "study": STUDY, "shots": shots, "password": password.trim()}),
    );
    assert!(
        page["refused"].as_str().is_some_and(|text| !text.is_empty()),
        "a wrong password is refused in words"
    );
    assert_eq!(page["complaints"], json!([]));
    assert_eq!(page["missing"], json!([]), "the page has all that the report's document says");
    let missed = page["control"][0].as_str().unwrap_or_default();
    assert!(missed.contains("One more"), "and a section that it hasn't is missed: {missed}");
    for (block, t) in &expected {
        let printed = stats["blocks"].as_array().unwrap().iter().find(|b| b["id"] == block.as_str()).unwrap();
        let shown = &page["blocks"][printed["title"].as_str().unwrap()];
        if t.is_finite() {
            assert!(
                (printed["t"].as_f64().unwrap() - t).abs() < 1e-12 * t.abs().max(1.0),
                "{block}: {printed} against {t}"
            );
            let shown: f64 = shown.as_str().unwrap().parse().unwrap();
            assert!(
                (shown - t).abs() < 1e-12 * t.abs().max(1.0),
                "{block}: the page says {shown}, the rows {t}"
            );
        } else {
            // All three chose alike: t is not defined, and both places say so.
            assert!(printed["t"].is_null() && printed["note"].is_string() && shown.is_null(), "{printed}");
        }
    }
    // The choices above were made so that at least one block has a defined t.
    assert!(expected.iter().any(|(_, t)| t.is_finite()), "{expected:?}");
}

/// Block id → number of pairs, in order of appearance.
fn blocks(rows: &[Value]) -> Vec<(String, usize)> {
    let mut found: Vec<(String, usize)> = Vec::new();
    for row in &rows[..5] {
        let id = row["block_id"].as_str().unwrap();
        match found.iter_mut().find(|(known, _)| known == id) {
            Some((_, pairs)) => *pairs += 1,
            None => found.push((id.to_owned(), 1)),
        }
    }
    found
}

fn database(data: &std::path::Path) -> std::path::PathBuf {
    let mut files = std::fs::read_dir(data).unwrap().map(|entry| entry.unwrap().path());
    files
        .find(|path| path.extension().is_some_and(|end| end == "sqlite" || end == "db"))
        .expect("a database file")
}

/// Opens a session and consents; answers (id, token).
fn join(server: &Server) -> (String, String) {
    let (status, session) = server.call(
        "POST",
        &format!("/api/v1/studies/{STUDY}/sessions"),
        None,
        &json!({"params": {}, "display": {}}),
    );
    assert_eq!(status, 201, "{session}");
    let (id, token) =
        (session["session_id"].as_str().unwrap().to_owned(), session["token"].as_str().unwrap().to_owned());
    let (status, state) =
        server.call("POST", &format!("/api/v1/sessions/{id}/consent"), Some(&token), &Value::Null);
    assert_eq!(status, 200, "{state}");
    (id, token)
}

fn answer(choice: &str) -> Value {
    json!({"choice": choice, "rt": 812.5, "onset": 100.0, "time_elapsed": 5000, "trial_type": "two-alternative", "plugin_version": "0.1.0",
           "input": "keyboard", "scale": 1.0, "device_pixel_ratio": 1.0, "viewport": [1280, 800], "refresh_hz": 60.0,
           "reload_count": 0, "timestamp": "2026-11-22T10:30:00.000Z"})
}

#[test]
fn a_killed_server_loses_nothing_that_it_acknowledged() {
    let data = prepared_data();
    let mut server = Server::start(data.path(), true);
    let (id, token) = join(&server);
    for trial in 0..5 {
        let choice = if trial % 2 == 0 { "left" } else { "right" };
        let path = format!("/api/v1/sessions/{id}/trials/{trial}");
        let (status, ack) = server.call("PUT", &path, Some(&token), &answer(choice));
        assert_eq!((status, &ack["acknowledged"]), (200, &json!(true)), "{ack}");
        server.kill();
        server = Server::start(data.path(), true);
        let (_, state) = server.call("GET", &format!("/api/v1/sessions/{id}"), Some(&token), &Value::Null);
        let next = if trial < 4 { json!(trial + 1) } else { Value::Null };
        assert_eq!(state["next_trial"], next, "{state}");
    }
    let rows = sql(
        &database(data.path()),
        &format!(
            "SELECT a.trial_index, json_extract(c.answer, '$.choice') AS choice FROM answers a JOIN answer_contents c USING (study_id, seq)
             WHERE a.session_id = '{id}' ORDER BY a.trial_index"
        ),
    );
    let choices: Vec<&str> = rows.iter().map(|row| row["choice"].as_str().unwrap()).collect();
    assert_eq!(choices, ["left", "right", "left", "right", "left"]);
    let (status, done) =
        server.call("POST", &format!("/api/v1/sessions/{id}/completion"), Some(&token), &Value::Null);
    assert_eq!(status, 200, "{done}");
    assert_eq!(sql(&database(data.path()), "PRAGMA integrity_check")[0]["integrity_check"], "ok");
}

#[test]
fn no_code_before_every_trial_is_stored_and_no_answer_changes() {
    let data = prepared_data();
    let server = Server::start(data.path(), true);
    let (id, token) = join(&server);
    let (status, body) =
        server.call("POST", &format!("/api/v1/sessions/{id}/completion"), Some(&token), &Value::Null);
    assert_eq!((status, &body["code"]), (409, &json!("incomplete")), "{body}");
    let path = format!("/api/v1/sessions/{id}/trials/0");
    assert_eq!(server.call("PUT", &path, Some(&token), &answer("left")).0, 200);
    assert_eq!(
        server.call("PUT", &path, Some(&token), &answer("left")).0,
        200,
        "the same answer again is acknowledged"
    );
    let (status, body) = server.call("PUT", &path, Some(&token), &answer("right"));
    assert_eq!((status, &body["code"]), (409, &json!("already_answered")), "{body}");
    let rows =
        sql(&database(data.path()), "SELECT json_extract(answer, '$.choice') AS choice FROM answer_contents");
    assert_eq!(rows, [json!({"choice": "left"})]);
    // Wrong requests: one shape, no stack, no SQL.
    for (method, path, token, body, expected) in [
        ("PUT", path.as_str(), Some("not-the-token"), answer("left"), 401),
        ("PUT", path.as_str(), Some(token.as_str()), json!({"choice": "middle"}), 422),
        ("GET", "/api/v1/studies/none", None, Value::Null, 404),
        ("GET", "/api/v1/studies", None, Value::Null, 401),
        ("DELETE", "/api/v1/studies/shadow-puppets", None, Value::Null, 405),
    ] {
        let (status, answer) = server.call(method, path, token, &body);
        assert!(
            (400..500).contains(&status)
                && answer["status"] == status
                && answer["code"].is_string()
                && answer["detail"].is_string(),
            "{method} {path}: {status} {answer}"
        );
        assert_eq!(status, expected, "{method} {path}: {answer}");
        let text = answer.to_string().to_lowercase();
        assert!(!text.contains("sqlx") && !text.contains("select ") && !text.contains("panicked"), "{text}");
    }
    // The database itself refuses to change an answer, whoever asks.
    let out = std::process::Command::new("sqlite3")
        .arg(database(data.path()))
        .arg("UPDATE answer_contents SET answer = replace(answer, 'left', 'right')")
        .output()
        .unwrap();
    assert!(!out.status.success() && String::from_utf8_lossy(&out.stderr).contains("append-only"), "{out:?}");
}

/// Hashes of the pixels that a stored stimulus may have on the screen: a still's, or those of an animation's frames.
fn pixels_of(data: &std::path::Path, sha256: &str) -> Vec<String> {
    let bytes = std::fs::read(data.join("stimuli").join(&sha256[..2]).join(sha256)).unwrap();
    let manifest: Option<Value> = serde_json::from_slice(&bytes).ok();
    let names = match &manifest {
        Some(manifest) => {
            manifest["frames"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect()
        }
        None => vec![sha256],
    };
    let rows = sql(&database(data), "SELECT sha256, pixels_sha256 FROM stimuli");
    let named = rows.iter().filter(|row| names.contains(&row["sha256"].as_str().unwrap()));
    named.map(|row| row["pixels_sha256"].as_str().unwrap().to_owned()).collect()
}
