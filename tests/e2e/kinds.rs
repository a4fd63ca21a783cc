//! Kinds of trials in a real browser: what stood on the screen, when, how wide and what was pressed is what is stored, exported and counted.

use std::collections::BTreeMap;
use std::path::Path;

use kelir_fixtures as fixtures;
use kelir_fixtures::block;
use kelir_tests::{Server, Taking, browser, kelir_ok, root, small_data, sql, table};
use serde_json::{Value, json};

/// A study file with these blocks, its reference of few samples.
pub(crate) fn study(size: &str, blocks: &[String]) -> String {
    let keys = [
        ("question", "\"Which image is more likely to be real?\""),
        ("seed", "5"),
        ("size", size),
        ("conditions", r#"{ pa = { technique = "pa" }, mc = { technique = "mc", spp = 4 } }"#),
    ];
    fixtures::study(&keys, blocks)
}

/// Items with the scenes of `small`, by turns.
fn items(ids: &[&str]) -> String {
    let scenes = ["near", "far"].iter().cycle();
    let items = ids.iter().zip(scenes);
    let items: Vec<String> =
        items.map(|(id, scene)| format!("{{ id = \"{id}\", scene = \"../scenes/{scene}.toml\" }}")).collect();
    format!("[{}]", items.join(", "))
}

/// A block in two intervals, which take so many ms: fixation, first, mask and second.
fn intervals(id: &str, ids: &[&str], [fixation, first, mask, second]: [f64; 4]) -> String {
    let settings =
        format!("{{ fixation_ms = {fixation}, first_ms = {first}, mask_ms = {mask}, second_ms = {second} }}");
    block(id, &[("trial", "\"two-interval\""), ("trial_settings", &settings), ("items", &items(ids))])
}

/// An answer as it is stored, with whose it is.
pub(crate) struct Stored {
    pub who: String,
    pub trial_index: u64,
    pub kind: String,
    /// Role → { item, condition, sha256, … }.
    pub shown: Value,
    pub answer: Value,
    pub payload: Value,
}

impl Stored {
    /// Where the target was chosen.
    pub(crate) fn chose_target(&self) -> bool {
        self.shown[self.answer["choice"].as_str().unwrap()]["condition"] == "pa"
    }

    /// The item shown; every role's is the same.
    pub(crate) fn item(&self) -> &str {
        let items: Vec<&str> =
            self.shown.as_object().unwrap().values().map(|s| s["item"].as_str().unwrap()).collect();
        assert!(items.len() == 2 && items[0] == items[1], "{items:?}");
        items[0]
    }
}

/// The answers to a study, read with another program: in the order in which they were stored.
pub(crate) fn stored(data: &Path, study: &str) -> Vec<Stored> {
    let query = format!(
        "SELECT a.row, c.answer, c.payload, json_extract(s.params, '$.PROLIFIC_PID') AS who FROM answers a
         JOIN answer_contents c USING (study_id, seq) JOIN sessions s USING (session_id) WHERE a.study_id = '{study}' ORDER BY seq"
    );
    let parsed = |value: &Value| serde_json::from_str::<Value>(value.as_str().unwrap()).unwrap();
    let rows = sql(&data.join("kelir.sqlite"), &query);
    let stored = |row: &Value| {
        let array = parsed(&row["row"]);
        Stored {
            who: row["who"].as_str().unwrap().to_owned(),
            trial_index: array[3].as_u64().unwrap(),
            kind: array[4].as_str().unwrap().to_owned(),
            shown: array[5].clone(),
            answer: parsed(&row["answer"]),
            payload: parsed(&row["payload"]),
        }
    };
    rows.iter().map(stored).collect()
}

/// The exported rows of a study.
fn exported(data: &Path, study: &str) -> Vec<BTreeMap<String, String>> {
    table(&kelir_ok(&["export", study, "--data", data.to_str().unwrap()]))
}

/// The report of a study.
pub(crate) fn stats(data: &Path, study: &str) -> Value {
    let text = kelir_ok(&["stats", study, "--data", data.to_str().unwrap(), "--format", "json"]);
    serde_json::from_str(&text).unwrap()
}

/// t of a one-sample test, worked out from the definition.
fn t_statistic(values: &[f64], mu: f64) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let sd = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
    (mean - mu) / (sd / n.sqrt())
}

const STEPS: [&str; 4] = ["fixation", "first", "mask", "second"];

/// By how many frames each step of an exported row outlasted what was asked for, and what is wrong with its durations: nothing is where each
/// got at least the nearest whole number of frames, and as many milliseconds as those take.
fn durations(row: &BTreeMap<String, String>, asked: [f64; 4]) -> (Vec<f64>, Vec<String>) {
    let number = |name: &str| row[name].parse::<f64>().unwrap_or_else(|_| panic!("{name} = {:?}", row[name]));
    let period = 1000.0 / number("refresh_hz");
    let (mut beyond, mut wrong) = (Vec::new(), Vec::new());
    for (step, asked) in STEPS.iter().zip(asked) {
        let [requested, frames, ms] =
            ["requested_ms", "shown_frames", "shown_ms"].map(|what| number(&format!("{what}_{step}")));
        beyond.push(frames - (asked / period).round());
        if requested != asked
            || ms < asked - period / 2.0 - 1.0
            || (ms - frames * period).abs() > period / 2.0
        {
            wrong.push(format!(
                "{step}: {requested} ms were asked for, {frames} frames and {ms} ms were shown"
            ));
        }
    }
    wrong.extend(beyond.iter().any(|frames| *frames < 0.0).then(|| format!("too few frames: {beyond:?}")));
    (beyond, wrong)
}

#[test]
fn two_intervals_are_stored_exported_and_counted_as_they_were_shown() {
    const BRIEF: [f64; 4] = [200.0, 150.0, 100.0, 150.0];
    // Long enough for a screenshot of each on a busy machine.
    const SLOW: [f64; 4] = [2500.0; 4];
    let data = small_data();
    let blocks = [
        intervals("brief", &["a", "b"], BRIEF),
        intervals("slow", &["c"], SLOW),
        block("sides", &[("items", &items(&["d", "e"]))]),
    ];
    std::fs::write(data.path().join("studies/kinds.toml"), study("[320, 180]", &blocks)).unwrap();
    let server = Server::start_with(data.path(), "kinds");
    let visits = json!([
        { "name": "ana", "study": "kinds", "viewport": { "width": 1280, "height": 800 }, "input": "keyboard", "shoot": 2,
          "choices": ["first", "second", "first", "left", "left"] },
        { "name": "budi", "study": "kinds", "viewport": { "width": 390, "height": 844 }, "input": "touch", "shoot": 2,
          "choices": ["first", "first", "second", "left", "right"] },
    ]);
    let task = json!({ "base": server.base, "shots": root().join("tests/screenshots"), "visits": visits });
    let taken = browser("kinds.mjs", &task);

    let rows = stored(data.path(), "kinds");
    assert_eq!(rows.len(), 10, "one row a trial");
    let (mut beyond, mut table) = (Vec::new(), exported(data.path(), "kinds"));
    for (rows, visit) in rows.chunks(5).zip(taken.as_array().unwrap()) {
        assert_eq!(visit["complaints"], json!([]), "the browser's console is clean");
        for (index, (row, trial)) in rows.iter().zip(visit["trials"].as_array().unwrap()).enumerate() {
            assert_eq!((json!(row.who), row.trial_index), (visit["name"].clone(), index as u64));
            let (kind, roles) = if index < 3 {
                ("two-interval", ["first", "second"])
            } else {
                ("two-alternative", ["left", "right"])
            };
            assert_eq!(row.kind, kind);
            let hash = |role: &str| row.shown[role]["pixels_sha256"].clone();
            assert_eq!(
                trial["shown"],
                json!({ roles[0]: hash(roles[0]), roles[1]: hash(roles[1]) }),
                "trial {index} of {}",
                row.who
            );
            assert_ne!(hash(roles[0]), hash(roles[1]), "two pictures that are told apart");
            assert_eq!((&row.answer["choice"], &row.payload["choice"]), (&trial["choice"], &trial["choice"]));
            assert_eq!(row.payload["input"], if row.who == "ana" { "keyboard" } else { "touch" });
            assert_eq!(trial["position"], format!("{} of 5", index + 1));

            let row_of_table = table.remove(0);
            let cell = |name: &str| row_of_table[name].as_str();
            assert_eq!(
                (cell("subject_id"), cell("response")),
                (row.who.as_str(), trial["choice"].as_str().unwrap())
            );
            for role in ["left", "right", "first", "second"] {
                let shown = &row.shown[role];
                let [condition, sha256] =
                    ["condition", "sha256"].map(|key| shown[key].as_str().unwrap_or(""));
                assert_eq!(cell(&format!("shown_{role}_condition")), condition, "{role} of a {kind} trial");
                assert_eq!(cell(&format!("shown_{role}_sha256")), sha256);
                if let "left" | "right" = role {
                    assert_eq!(cell(&format!("{role}_condition")), condition);
                    assert_eq!(cell(&format!("{role}_sha256")), sha256);
                }
            }
            let asked = match index {
                0 | 1 => BRIEF,
                2 => SLOW,
                _ => {
                    for step in STEPS {
                        assert_eq!(cell(&format!("requested_ms_{step}")), "", "a trial of another kind");
                    }
                    continue;
                }
            };
            let (frames, wrong) = durations(&row_of_table, asked);
            assert_eq!(wrong, [""; 0]);
            assert!(
                !durations(&row_of_table, asked.map(|ms| ms + 40.0)).1.is_empty(),
                "40 ms too few would be seen"
            );
            // A screenshot costs frames.
            beyond.extend(if index < 2 { frames } else { Vec::new() });
        }
    }
    // A busy machine drops frames, which lengthen a step and are logged; the sequence itself asks for none too many.
    beyond.sort_by(f64::total_cmp);
    assert!(beyond.len() == 16 && beyond[8] <= 1.0, "frames beyond what was asked for: {beyond:?}");

    // A third participant, so that t is one of three.
    let citra = Taking::begin(&server, "kinds", "citra");
    for (trial, choice) in ["second", "second", "first", "right", "right"].iter().enumerate() {
        assert_eq!(citra.answer(trial, choice, 700.0).0, 200);
    }
    citra.finish();
    let (rows, report) = (stored(data.path(), "kinds"), stats(data.path(), "kinds"));
    for (at, id, trials) in [(0, "brief", 0..2), (1, "slow", 2..3), (2, "sides", 3..5)] {
        let counted = &report["blocks"][at];
        assert_eq!((&counted["id"], &counted["n"]), (&json!(id), &json!(3)));
        let hits = |rows: &[Stored]| rows[trials.clone()].iter().filter(|row| row.chose_target()).count();
        let hits: Vec<usize> = rows.chunks(5).map(hits).collect();
        for k in 0..=trials.len() {
            assert_eq!(
                counted["counts"][k.to_string()],
                hits.iter().filter(|n| **n == k).count(),
                "{id}: {k}"
            );
        }
        let values: Vec<f64> = hits.iter().map(|n| *n as f64).collect();
        let t = t_statistic(&values, trials.len() as f64 / 2.0);
        assert!(id == "slow" || t.is_finite(), "{id}: choices for which t is defined: {values:?}");
        let found = counted["t"].as_f64();
        assert!(
            found.map_or(!t.is_finite(), |found| (found - t).abs() < 1e-12 * t.abs().max(1.0)),
            "{id}: {found:?}, not {t}"
        );
    }
}

#[test]
fn what_the_export_says_of_a_stimulus_is_how_wide_it_stood_on_any_display() {
    let data = small_data();
    let blocks =
        [block("sides", &[("items", &items(&["d"]))]), intervals("brief", &["a"], [0.0, 100.0, 0.0, 100.0])];
    std::fs::write(data.path().join("studies/sizes.toml"), study("[336, 189]", &blocks)).unwrap();
    let server = Server::start_with(data.path(), "sizes");
    // (ratio, window, pressed with); the smallest window has no room for the pictures' own size. Chromium lays out in 64ths of a pixel, which these
    // widths are.
    let displays = [
        (1.0, (1280, 800), "mouse"),
        (2.0, (1280, 800), "pen"),
        (3.0, (390, 844), "touch"),
        (2.0, (180, 500), "pen"),
    ];
    let visits: Vec<Value> = (displays.iter().enumerate())
        .map(|(i, (dpr, (width, height), input))| {
            json!({ "name": format!("p{i}"), "study": "sizes", "viewport": { "width": width, "height": height }, "dpr": dpr, "input": input,
                    "choices": ["right", "second"] })
        })
        .collect();
    let taken = browser(
        "kinds.mjs",
        &json!({ "base": server.base, "shots": root().join("tests/screenshots"), "visits": visits }),
    );
    let table = exported(data.path(), "sizes");
    assert_eq!(table.len(), 2 * displays.len());
    let mut smaller = 0;
    for ((rows, visit), (dpr, _, input)) in table.chunks(2).zip(taken.as_array().unwrap()).zip(displays) {
        assert_eq!(visit["complaints"], json!([]));
        for (row, trial) in rows.iter().zip(visit["trials"].as_array().unwrap()) {
            let number = |name: &str| row[name].parse::<f64>().unwrap();
            assert_eq!((number("device_pixel_ratio"), row["input"].as_str()), (dpr, input));
            let device = number("stimulus_width_px") * number("scale");
            let seen: Vec<f64> =
                trial["widths"].as_object().unwrap().values().map(|w| w.as_f64().unwrap()).collect();
            assert_eq!(seen.len(), 2);
            for seen in seen {
                assert!(
                    (device / dpr - seen).abs() < 0.01,
                    "{} of {device} device pixels, {seen} seen",
                    row["trial_kind"]
                );
                assert!(
                    (number("css_width_px") - seen).abs() < 0.01,
                    "{} CSS px are said, {seen} seen",
                    row["css_width_px"]
                );
                // Without the ratio it would not be: not where the ratio is another than 1.
                assert_eq!((device - seen).abs() < 0.01, dpr == 1.0);
            }
            smaller += u32::from(number("scale") < 0.99);
        }
    }
    assert_eq!(smaller, 2, "both trials of the smallest window are scaled");
}
