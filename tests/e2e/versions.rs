//! What was shown is what is judged: answers to different pictures are never pooled unless somebody names the versions, and a corrected comma
//! hides nothing.

use std::collections::BTreeMap;
use std::path::Path;

use kelir_tests::{Server, Taking, edit, fixture, kelir, kelir_ok, small_data, sql, table, take};
use serde_json::{Value, json};

const ALL: [&str; 4] = ["left", "right", "left", "right"];

fn stats(data: &Path, more: &[&str]) -> Value {
    let data = data.to_str().unwrap();
    let args = [&["stats", "small", "--data", data, "--format", "json"], more].concat();
    serde_json::from_str(&kelir_ok(&args)).unwrap()
}

/// Who answered all of the first block, with those whom screening leaves out.
fn people(report: &Value) -> Value {
    let all = if report["blocks_with_excluded"].is_null() { "blocks" } else { "blocks_with_excluded" };
    report[all][0]["n"].clone()
}

fn versions(data: &Path) -> Vec<Value> {
    let text =
        kelir_ok(&["study", "versions", "small", "--data", data.to_str().unwrap(), "--format", "json"]);
    serde_json::from_str::<Value>(&text).unwrap().as_array().unwrap().clone()
}

/// A column of a CSV, by its name.
fn column(csv: &str, name: &str) -> Vec<String> {
    let cell =
        |row: &BTreeMap<String, String>| row.get(name).unwrap_or_else(|| panic!("no column {name}")).clone();
    table(csv).iter().map(cell).collect()
}

fn export(data: &Path, more: &[&str]) -> String {
    kelir_ok(&[&["export", "small", "--data", data.to_str().unwrap()], more].concat())
}

#[test]
fn answers_to_different_pictures_are_apart_until_somebody_pools_them_by_name() {
    let data = small_data();
    let server = Server::start_small(data.path());
    take(&server, "small", "a", &ALL);
    take(&server, "small", "b", &ALL);
    server.terminate();
    // A scene is edited; the study file is not.
    edit(data.path(), "scenes/near.toml", "height_m = 0.4", "height_m = 0.3");
    let server = Server::start_small(data.path());
    take(&server, "small", "c", &ALL);
    take(&server, "small", "d", &ALL);
    take(&server, "small", "e", &ALL);

    let known = versions(data.path());
    assert_eq!(known.len(), 2);
    assert_eq!(known[0]["is_current"], true);
    let counts: Vec<_> =
        known.iter().map(|v| (v["participants"]["completed"].clone(), v["answers"].clone())).collect();
    assert_eq!(counts, [(json!(3), json!(12)), (json!(2), json!(8))]);
    assert_eq!(known[0]["design_hash"], known[1]["design_hash"], "the design is the same");
    let [current, before] = [0, 1].map(|i| known[i]["version"].as_str().unwrap());

    let now = stats(data.path(), &[]);
    assert_eq!((&now["version"], &people(&now)), (&json!(current), &json!(3)));
    assert_eq!(now["other_versions"], json!([{ "version": before, "sessions": 2, "answers": 8 }]));
    let then = stats(data.path(), &["--version", &before[..12]]);
    assert_eq!((&then["version"], &people(&then)), (&json!(before), &json!(2)));
    let hash = |report: &Value, item: &str| {
        let stimuli = report["stimuli"].as_array().unwrap();
        stimuli.iter().find(|s| s["item"] == item && s["condition"] == "pa").unwrap()["pixels_sha256"].clone()
    };
    assert_ne!(hash(&now, "a"), hash(&then, "a"), "each version lists its own pictures");
    assert_eq!(hash(&now, "b"), hash(&then, "b"));
    // What the rows of each version say was shown is what its stimuli are.
    for (version, report) in [(current, &now), (before, &then)] {
        let shown = sql(
            &data.path().join("kelir.sqlite"),
            &format!(
                "SELECT DISTINCT json_extract(stimulus.value, '$.pixels_sha256') AS pixels FROM answers a JOIN sessions s USING (session_id),
                 json_each(json_extract(a.row, '$[5]')) AS stimulus WHERE s.version = '{version}'
                 AND json_extract(stimulus.value, '$.item') = 'a' AND json_extract(stimulus.value, '$.condition') = 'pa'"
            ),
        );
        assert_eq!(shown, [json!({ "pixels": hash(report, "a") })]);
    }
    let pooled = stats(data.path(), &["--with", "all"]);
    assert_eq!(people(&pooled), 5);
    assert_eq!(pooled["pooled"].as_array().unwrap().len(), 2);
    let different: Vec<_> =
        pooled["different_stimuli"].as_array().unwrap().iter().map(|d| d["item"].as_str().unwrap()).collect();
    assert!(
        different.contains(&"a") && different.contains(&"x") && !different.contains(&"b"),
        "{different:?}"
    );
    let text = kelir_ok(&["stats", "small", "--data", data.path().to_str().unwrap(), "--with", before]);
    assert!(text.contains("are pooled") && text.contains("do not show the same"), "{text}");

    assert_eq!(column(&export(data.path(), &[]), "version"), vec![current; 12]);
    let both = export(data.path(), &["--with", "all"]);
    assert_eq!(column(&both, "version").iter().filter(|v| *v == before).count(), 8);
    assert_eq!(column(&both, "config_hash"), column(&both, "version"));
    assert!(column(&both, "item_id") == column(&both, "pair_id"));

    // The same through the API, and what is wrong with a name.
    let cookie = server.sign_in();
    let list = server.research(&cookie, "/api/v1/studies/small/versions?limit=1");
    assert_eq!(list["items"][0]["version"], current);
    let cursor = list["next_cursor"].as_str().unwrap();
    let rest = server.research(&cookie, &format!("/api/v1/studies/small/versions?limit=1&cursor={cursor}"));
    assert_eq!((&rest["items"][0]["version"], &rest["next_cursor"]), (&json!(before), &Value::Null));
    let results =
        server.research(&cookie, &format!("/api/v1/studies/small/versions/{before}/results?with=current"));
    assert_eq!((&results["version"], &people(&results)), (&json!(before), &json!(5)));
    for wrong in ["0000000000", "x", "1234567"] {
        let out = kelir(&["stats", "small", "--data", data.path().to_str().unwrap(), "--version", wrong]);
        assert_eq!(out.status.code(), Some(2), "{wrong}: {out:?}");
        let problem = server.research(&cookie, &format!("/api/v1/studies/small/versions/{wrong}/results"));
        assert!(problem["code"].is_string() && problem["status"].as_u64() < Some(500), "{problem}");
    }
}

#[test]
fn a_comma_in_the_thanks_hides_nothing_and_a_session_keeps_the_texts_it_began_with() {
    let data = small_data();
    let server = Server::start_small(data.path());
    take(&server, "small", "a", &ALL);
    let half = Taking::begin(&server, "small", "half");
    assert_eq!(half.answer(0, "left", 500.0).0, 200);
    let (id, token) = (half.id.clone(), half.token.clone());
    server.terminate();
    edit(data.path(), "studies/small.toml", "thanks = \"Thank you.\"", "thanks = \"Thank you!\"");
    edit(data.path(), "studies/small.toml", "title = \"Stills\"", "title = \"The stills\"");
    let server = Server::start_small(data.path());
    assert_eq!(
        server.call("GET", "/api/v1/studies/small", None, &Value::Null).1["texts"]["thanks"],
        json!(["Thank you!"])
    );
    take(&server, "small", "b", &ALL);
    let half = Taking::resume(&server, &id, &token);
    assert_eq!(half.state["next_trial"], 1);
    assert_eq!(half.state["study"]["texts"]["thanks"], json!(["Thank you."]), "the texts it began with");
    (1..4).for_each(|trial| assert_eq!(half.answer(trial, "left", 500.0).0, 200));
    half.finish();
    let known = versions(data.path());
    assert_eq!((known.len(), &known[0]["answers"]), (1, &json!(12)));
    assert_eq!(column(&export(data.path(), &[]), "session_id").len(), 12);
    // Balance goes on: three people, three slots.
    let slots = sql(&data.path().join("kelir.sqlite"), "SELECT slot FROM sessions ORDER BY slot");
    assert_eq!(slots, [json!({"slot": 0}), json!({"slot": 1}), json!({"slot": 2})]);
    let files = sql(
        &data.path().join("kelir.sqlite"),
        "SELECT count(*) AS n FROM study_files WHERE study_id = 'small'",
    );
    assert_eq!(files, [json!({"n": 2})]);
    // A changed instruction is another version.
    server.terminate();
    edit(data.path(), "studies/small.toml", "instructions = \"Choose\"", "instructions = \"Choose well\"");
    let server = Server::start_small(data.path());
    take(&server, "small", "c", &ALL);
    assert_eq!(versions(data.path()).len(), 2);
    // Who is in the midst of it is asked the question that they began with.
    let asked = Taking::begin(&server, "small", "d");
    let (id, token) = (asked.id.clone(), asked.token.clone());
    server.terminate();
    edit(data.path(), "studies/small.toml", "Which image is more likely to be real?", "Which is the fake?");
    let server = Server::start_small(data.path());
    let asked = Taking::resume(&server, &id, &token);
    assert_eq!(asked.state["study"]["question"], "Which image is more likely to be real?");
    assert_eq!(Taking::begin(&server, "small", "e").state["study"]["question"], "Which is the fake?");
}

#[test]
fn a_replaced_photograph_is_another_version_and_one_packed_anew_is_not() {
    let data = small_data();
    edit(
        data.path(),
        "studies/small.toml",
        "[conditions.mc]\ntechnique = \"mc\"\nspp = 16",
        "[conditions.mc]\nfiles = { a = \"p/a.png\", b = \"p/b.png\", x = \"p/b.png\" }",
    );
    let study = std::fs::read_to_string(data.path().join("studies/small.toml")).unwrap();
    let animation = study.find("[[blocks]]\nid = \"loop\"").unwrap();
    std::fs::write(data.path().join("studies/small.toml"), &study[..animation]).unwrap();
    std::fs::create_dir_all(data.path().join("studies/p")).unwrap();
    let render = |scene: &str, to: &str| {
        let [scene, to] = [data.path().join(scene), data.path().join("studies/p").join(to)];
        let (scene, to) = (scene.to_str().unwrap(), to.to_str().unwrap());
        kelir_ok(&[
            "render",
            scene,
            "--technique",
            "mc",
            "--spp",
            "16",
            "--size",
            "64x36",
            "--backend",
            "cpu",
            "-o",
            to,
        ]);
    };
    render("scenes/near.toml", "a.png");
    render("scenes/far.toml", "b.png");
    let server = Server::start_small(data.path());
    take(&server, "small", "one", &ALL[..3]);
    server.terminate();
    // Packed anew: other bytes (a text chunk more), the same pixels.
    let photo = data.path().join("studies/p/a.png");
    let bytes = std::fs::read(&photo).unwrap();
    let at = bytes.windows(4).position(|w| w == b"IDAT").unwrap() - 4;
    let chunk = [&[0, 0, 0, 4][..], b"tEXta\0bc", &crc(b"tEXta\0bc").to_be_bytes()].concat();
    std::fs::write(&photo, [&bytes[..at], &chunk, &bytes[at..]].concat()).unwrap();
    let server = Server::start_small(data.path());
    take(&server, "small", "two", &ALL[..3]);
    server.terminate();
    assert_eq!(versions(data.path()).len(), 1, "packed anew");
    render("scenes/far.toml", "a.png");
    let server = Server::start_small(data.path());
    take(&server, "small", "three", &ALL[..3]);
    let known = versions(data.path());
    let answers: Vec<_> = known.iter().map(|v| v["answers"].clone()).collect();
    assert_eq!(answers, [json!(3), json!(6)], "replaced");
}

/// CRC of a PNG chunk (ISO 3309).
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, byte| {
        (0..8).fold(
            crc ^ u32::from(*byte),
            |crc, _| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 },
        )
    })
}

#[test]
fn a_response_time_of_minus_nought_breaks_nothing() {
    let data = small_data();
    let server = Server::start_small(data.path());
    let taking = Taking::begin(&server, "small", "a");
    // serde_json writes −0.0 as "-0.0".
    assert_eq!(taking.answer(0, "left", -0.0).0, 200);
    assert_eq!(taking.answer(0, "left", -0.0).0, 200, "a resend of the same bytes");
    assert_eq!(taking.answer(0, "left", 0.0).0, 409, "other bytes");
    (1..4).for_each(|trial| assert_eq!(taking.answer(trial, "left", 5e-324 * trial as f64).0, 200));
    taking.finish();
    let chain = kelir_ok(&["chain", "check", "small", "--data", data.path().to_str().unwrap()]);
    assert!(chain.contains("4 answers checked, every one is what was written"), "{chain}");
    let payload =
        sql(&data.path().join("kelir.sqlite"), "SELECT payload, answer FROM answer_contents WHERE seq = 1");
    assert!(payload[0]["payload"].as_str().unwrap().contains("-0.0"), "what came is kept to the byte");
    assert_eq!(payload[0]["answer"], r#"{"choice":"left","rt_ms":0}"#);
}

#[test]
fn a_tampered_row_is_named_and_a_note_explains_it() {
    let data = small_data();
    let server = Server::start_small(data.path());
    take(&server, "small", "a", &ALL);
    server.terminate();
    let folder = data.path().to_str().unwrap();
    let tamper = "DROP TRIGGER contents_only_blanked; UPDATE answer_contents SET answer = replace(answer, 'left', 'right') WHERE seq = 3;";
    let out = std::process::Command::new("sqlite3")
        .arg(data.path().join("kelir.sqlite"))
        .arg(tamper)
        .output()
        .unwrap();
    assert!(out.status.success(), "{out:?}");
    let check = || kelir(&["chain", "check", "small", "--data", folder]);
    let out = check();
    let text = String::from_utf8_lossy(&out.stdout).into_owned();
    assert_eq!(out.status.code(), Some(1), "{text}");
    assert!(
        text.contains("4 answers checked, 1 is not what was written") && text.contains("unexplained"),
        "{text}"
    );
    let note = |seq: &str| {
        kelir(&[
            "chain",
            "note",
            "small",
            "--data",
            folder,
            "--seq",
            seq,
            "--why",
            "the disk failed on Friday",
            "--author",
            "ana",
        ])
    };
    assert_eq!(note("2").status.code(), Some(2), "a good row needs no note");
    assert!(note("3").status.success());
    let out = check();
    assert!(
        out.status.success() && String::from_utf8_lossy(&out.stdout).contains("the disk failed on Friday")
    );
    let report = stats(data.path(), &[]);
    assert_eq!(report["chain"]["faults"][0]["note"], "the disk failed on Friday");
}

/// What two reports say of the answers.
fn judged(report: &Value) -> Vec<Value> {
    let of = |block: &Value| {
        ["id", "n", "incomplete", "counts", "mean", "sd", "t", "p"].map(|key| block[key].clone())
    };
    report["blocks"].as_array().unwrap().iter().map(|block| json!(of(block))).collect()
}

#[test]
fn data_of_before_open_with_the_same_results_and_go_on() {
    let data = tempfile::tempdir().unwrap();
    kelir_tests::copy(&fixture("answered/."), data.path());
    let old: Value =
        serde_json::from_str(&std::fs::read_to_string(fixture("answered.stats.json")).unwrap()).unwrap();
    let new = stats(data.path(), &[]);
    assert_eq!(judged(&new), judged(&old));
    assert_eq!(
        new["participants"],
        json!({"started": 9, "in_progress": new["participants"]["in_progress"], "completed": 8})
    );
    assert_eq!(new["excluded"].as_array().unwrap().len(), old["excluded"].as_array().unwrap().len());
    assert_eq!((&new["chain"]["rows"], &new["chain"]["faults"]), (&json!(34), &json!([])));
    assert_eq!(new["chain"]["head"], old["chain"]["head"]);
    for stimulus in old["stimuli"].as_array().unwrap() {
        let same = |s: &&Value| s["item"] == stimulus["pair"] && s["condition"] == stimulus["condition"];
        let now = new["stimuli"].as_array().unwrap().iter().find(same).unwrap();
        assert_eq!((&now["sha256"], &now["provenance"]), (&stimulus["sha256"], &stimulus["provenance"]));
    }
    // Somebody who was in the midst of it goes on, with what they were shown.
    let half: Value =
        serde_json::from_str(&std::fs::read_to_string(fixture("answered.half.json")).unwrap()).unwrap();
    let server = Server::start_small(data.path());
    let half = Taking::resume(&server, half[0].as_str().unwrap(), half[1].as_str().unwrap());
    assert_eq!((&half.state["next_trial"], &half.state["more"]), (&json!(2), &json!(false)));
    assert_eq!(half.answer(0, "right", 1.0).0, 409, "what was answered before stands");
    (2..4).for_each(|trial| assert_eq!(half.answer(trial, "left", 500.0).0, 200));
    half.finish();
    let chain = kelir_ok(&["chain", "check", "small", "--data", data.path().to_str().unwrap()]);
    assert!(chain.contains("36 answers checked, every one"), "{chain}");
}

#[test]
fn pooled_data_of_before_come_apart_and_their_chain_is_whole() {
    let data = tempfile::tempdir().unwrap();
    kelir_tests::copy(&fixture("changed/."), data.path());
    let known = versions(data.path());
    let counts: Vec<_> =
        known.iter().map(|v| (v["participants"]["started"].clone(), v["answers"].clone())).collect();
    assert_eq!(counts, [(json!(3), json!(12)), (json!(2), json!(8))], "{known:?}");
    let chain = kelir_ok(&["chain", "check", "small", "--data", data.path().to_str().unwrap()]);
    assert!(chain.contains("20 answers checked, every one"), "{chain}");
    let rows = export(data.path(), &["--with", "all"]);
    assert_eq!(column(&rows, "chain"), vec!["1"; 20]);
    assert_eq!(column(&rows, "correct").iter().filter(|c| !c.is_empty()).count(), 5, "one catch trial each");
}
