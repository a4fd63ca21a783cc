//! Blocks whose answers decide what comes next: in a real browser over a bad line, and over HTTP alone.

use std::collections::BTreeMap;
use std::path::Path;

use kelir_fixtures as fixtures;
use kelir_fixtures::block;
use kelir_tests::{Server, Taking, browser, kelir_ok, root, small_data, sql};
use serde_json::{Value, json};

use crate::kinds::{Stored, stats, stored, study};

/// Levels of the items, and the most trials of either procedure.
const LEVELS: u32 = 8;
const MOST: usize = 24;

/// A data folder with the study `adaptive`: a pair, a block of eight levels with this procedure, and a pair again.
fn data(procedure: &str) -> tempfile::TempDir {
    let data = small_data();
    let near = std::fs::read_to_string(data.path().join("scenes/near.toml")).unwrap();
    let mut items = Vec::new();
    for level in 1..=LEVELS {
        // Each level's picture is another: the puppet stands so many centimetres from the screen.
        let scene = near.replace("0.0, 0.0, -0.2", &format!("0.0, 0.0, -0.{level}"));
        assert_ne!((level, &scene), (1, &near));
        std::fs::write(data.path().join(format!("scenes/level-{level}.toml")), scene).unwrap();
        items.push(format!(
            "{{ id = \"l{level}\", scene = \"../scenes/level-{level}.toml\", level = {level} }}"
        ));
    }
    let pair =
        |id: &str| block(id, &[("items", &fixtures::items([format!("{id}-1")], "../scenes/far.toml"))]);
    let levels = [
        ("items", &*format!("[{}]", items.join(", "))),
        (
            "psychometric",
            r#"{ function = "logistic", direction = "rising", label = "distance", unit = "dm" }"#,
        ),
        ("adaptive", procedure),
    ];
    let text = study("[64, 36]", &[pair("before"), block("steps", &levels), pair("after")]);
    std::fs::write(data.path().join("studies/adaptive.toml"), text).unwrap();
    data
}

/// The level of an item of the adaptive block.
fn level(item: &str) -> Option<i64> {
    item.strip_prefix('l')?.parse().ok()
}

/// Levitt's transformed rule over the levels 1 to [`LEVELS`] (more is easier): after `down` right answers in a row a step down, after a wrong one
/// a step up; a step is of `steps` levels, each until the next reversal. The level of each trial until the last reversal asked for, and whether it
/// came to that.
fn levitt(down: u32, steps: &[i64], reversals: usize, right: &[bool]) -> (Vec<i64>, bool) {
    let (mut at, mut in_a_row, mut turned, mut before) = (i64::from(LEVELS), 0, 0, 0);
    let mut shown = Vec::new();
    for right in right {
        shown.push(at);
        in_a_row = if *right { in_a_row + 1 } else { 0 };
        let direction = match (*right, in_a_row == down) {
            (false, _) => 1,
            (true, true) => -1,
            (true, false) => continue,
        };
        in_a_row = 0;
        turned += usize::from(before == -direction);
        before = direction;
        at = (at + direction * steps[turned.min(steps.len() - 1)]).clamp(1, i64::from(LEVELS));
        if turned == reversals {
            return (shown, true);
        }
    }
    (shown, false)
}

/// (level, choices of the target, choices) of the adaptive block's answers.
fn counts<'a>(rows: impl IntoIterator<Item = &'a Stored>) -> Vec<(i64, u64, u64)> {
    let mut counts = BTreeMap::<i64, (u64, u64)>::new();
    for row in rows {
        let Some(level) = level(row.item()) else { continue };
        let (chosen, all) = counts.entry(level).or_default();
        *chosen += u64::from(row.chose_target());
        *all += 1;
    }
    counts.into_iter().map(|(level, (chosen, all))| (level, chosen, all)).collect()
}

/// Checks the report of the block `steps`: the points of its psychometric function, and that nothing else is said of how often the target was chosen.
fn check_report(data: &Path, expected: &[(i64, u64, u64)]) {
    let report = stats(data, "adaptive");
    let block = &report["blocks"][1];
    assert_eq!((&block["id"], &block["n"], &block["incomplete"]), (&json!("steps"), &json!(1), &json!(0)));
    let points = block["psychometric"]["points"].as_array().unwrap();
    assert_eq!(points.len(), LEVELS as usize, "a point a level");
    let seen: Vec<_> = points
        .iter()
        .filter(|point| point["target"]["trials"].as_u64().is_some_and(|n| n > 0))
        .map(|point| {
            let of = |key: &str| point["target"][key].as_u64().unwrap();
            (point["level"].as_f64().unwrap() as i64, of("chosen"), of("trials"))
        })
        .collect();
    assert_eq!(seen, expected);
    assert_eq!(block["counts"], json!({}));
    for number in ["mean", "sd", "t", "df", "p", "p_holm"] {
        assert_eq!(block[number], Value::Null, "{number}");
    }
    let steered = "the procedure steers how often the target is chosen";
    assert!(block["note"].as_str().unwrap().starts_with(steered), "{block}");
    let text = kelir_ok(&["stats", "adaptive", "--data", data.to_str().unwrap()]);
    assert!(text.contains(steered) || text.contains(&steered.replacen('t', "T", 1)), "{text}");
    // The blocks around it are judged as ever.
    assert_eq!(
        (&report["blocks"][0]["n"], &report["blocks"][2]["counts"].as_object().unwrap().len()),
        (&json!(1), &2)
    );
}

#[test]
fn a_staircase_in_a_browser_goes_as_levitt_wrote_over_a_reload_and_a_line_that_drops() {
    let data = data(r#"{ procedure = "staircase", down = 2, steps = [2, 1], reversals = 5, trials = 24 }"#);
    let server = Server::start_with(data.path(), "adaptive");
    let cookie = server.sign_in();
    let results = server.research(&cookie, "/api/v1/studies/adaptive/versions/current/results");
    let stimuli = results["stimuli"].as_array().unwrap();
    let targets: Vec<&Value> =
        stimuli.iter().filter(|s| s["condition"] == "pa").map(|s| &s["pixels_sha256"]).collect();
    assert_eq!(targets.len(), 10);
    // After a pair, thirteen trials with five reversals (where the procedure ends, long before its most trials), and a pair again.
    let right = "tttttfttfttttft".chars().map(|c| c == 't').collect::<Vec<_>>();
    let task = json!({ "base": server.base, "shots": root().join("tests/screenshots"), "visits": [
        { "name": "ana", "study": "adaptive", "viewport": { "width": 1280, "height": 800 }, "input": "mouse", "targets": targets, "right": right,
          "reload": [4], "reload_after": [6], "offline": [2, 8], "ask_early": 9 },
    ]});
    let visit = browser("kinds.mjs", &task)[0].clone();
    assert_eq!(visit["complaints"], json!([]));

    // What was shown and clicked is what is stored, each once and in order, over the reloads and without a line.
    let rows = stored(data.path(), "adaptive");
    let trials = visit["trials"].as_array().unwrap();
    assert_eq!((rows.len(), trials.len()), (right.len(), right.len()));
    for (index, ((row, trial), right)) in rows.iter().zip(trials).zip(&right).enumerate() {
        assert_eq!(row.trial_index, index as u64);
        let hash = |role: &str| row.shown[role]["pixels_sha256"].clone();
        assert_eq!(trial["shown"], json!({ "left": hash("left"), "right": hash("right") }), "trial {index}");
        for shown in row.shown.as_object().unwrap().values() {
            let of_item = |s: &&Value| s["item"] == shown["item"] && s["condition"] == shown["condition"];
            assert_eq!(stimuli.iter().find(of_item).unwrap()["sha256"], shown["sha256"]);
        }
        assert_eq!((&row.answer["choice"], row.chose_target()), (&trial["choice"], *right));
        // How many there will be is known when the procedure has ended, and not before.
        let of = if index == 14 { "15".to_owned() } else { format!("at most {}", MOST + 2) };
        assert_eq!(trial["position"], format!("{} of {of}", index + 1));
    }
    assert_eq!(trials[4]["again"]["shown"], trials[4]["shown"], "a reload shows the same trial");
    assert_eq!(trials[4]["again"]["position"], trials[4]["position"]);
    let decided = sql(
        &data.path().join("kelir.sqlite"),
        "SELECT count(*) AS decided, count(DISTINCT after_seq) AS after FROM session_trials",
    );
    // The pair at the start with the block's first trial from no answer, one from each of the block's others, the last pair with the end.
    assert_eq!(decided, [json!({ "decided": 15, "after": 14 })]);

    let steps: Vec<&Stored> = rows.iter().filter(|row| level(row.item()).is_some()).collect();
    let shown: Vec<i64> = steps.iter().filter_map(|row| level(row.item())).collect();
    let answers: Vec<bool> = steps.iter().map(|row| row.chose_target()).collect();
    assert_eq!(levitt(2, &[2, 1], 5, &answers), (shown.clone(), true));
    // The comparison can fail: another rule, other steps, another end.
    assert_ne!(levitt(3, &[2, 1], 5, &answers).0, shown);
    assert_ne!(levitt(2, &[1], 5, &answers).0, shown);
    assert!(!levitt(2, &[2, 1], 6, &answers).1 && levitt(2, &[2, 1], 4, &answers).0.len() < shown.len());

    // No code before its end: neither for the page nor past it.
    assert_eq!(visit["early"], json!({ "status": 409, "code": "incomplete", "more": true }));
    assert_eq!(
        visit["said"],
        "No connection. Your answers are kept here and sent later; this page goes on by itself when it is back."
    );
    let log = visit["log"].as_array().unwrap();
    let ends = |call: &&Value| call["path"].as_str().unwrap().ends_with("/completion");
    assert_eq!(log.iter().filter(ends).count(), 1, "{log:?}");
    assert!(ends(&log.last().unwrap()) && log.last().unwrap()["status"] == 200, "{log:?}");

    check_report(data.path(), &counts(&rows));
}

#[test]
fn quest_plus_over_http_ends_after_its_trials() {
    const TRIALS: usize = 12;
    let data = data(&format!("{{ procedure = \"quest-plus\", trials = {TRIALS} }}"));
    let server = Server::start_with(data.path(), "adaptive");
    let mut taking = Taking::begin(&server, "adaptive", "budi");
    assert_eq!((&taking.state["more"], &taking.state["most_trials"]), (&json!(true), &json!(TRIALS + 2)));
    let mut trials = taking.state["trials"].as_array().unwrap().clone();
    let mut more = true;
    for index in 0.. {
        if index == trials.len() {
            break;
        }
        // Decided one by one, until the end decides the pair after it.
        assert_eq!(
            (trials.len(), more),
            if index <= TRIALS { (index.max(1) + 1, true) } else { (TRIALS + 2, false) }
        );
        let (status, early) = taking.call("POST", "/completion", &Value::Null);
        assert_eq!((status, &early["code"], &early["more"]), (409, &json!("incomplete"), &json!(more)));
        let choice = if index % 3 == 0 { "left" } else { "right" };
        let (status, answered) = taking.call(
            "PUT",
            &format!("/trials/{index}?known={}", trials.len()),
            &json!({ "choice": choice, "rt": 500 }),
        );
        assert_eq!(status, 200, "{answered}");
        trials.extend(answered["trials"].as_array().unwrap().iter().cloned());
        more = answered["more"].as_bool().unwrap();
    }
    assert_eq!(trials.len(), TRIALS + 2);
    let beyond =
        taking.call("PUT", &format!("/trials/{}", TRIALS + 2), &json!({ "choice": "left", "rt": 500 }));
    assert_eq!(beyond.0, 404, "{beyond:?}");
    // The server's word is the same after it was killed.
    let (id, token) = (taking.id.clone(), taking.token.clone());
    server.kill();
    let server = Server::start_with(data.path(), "adaptive");
    taking = Taking::resume(&server, &id, &token);
    let shown = |trials: &[Value]| trials.iter().map(|trial| trial["shown"].clone()).collect::<Vec<_>>();
    assert_eq!(shown(taking.state["trials"].as_array().unwrap()), shown(&trials));
    assert_eq!((&taking.state["more"], &taking.state["next_trial"]), (&json!(false), &Value::Null));
    taking.finish();
    let rows = stored(data.path(), "adaptive");
    let counts = counts(&rows);
    assert_eq!(counts.iter().map(|(_, _, all)| *all).sum::<u64>(), TRIALS as u64);
    assert!(counts.len() >= 3, "it looks for what tells most: {counts:?}");
    check_report(data.path(), &counts);
}
