//! Reports of a study that 33 people answered as the paper's did: the same numbers in every form, and R's.

use std::path::Path;

use kelir_tests::{Server, browser, kelir, kelir_ok, prepared_data, root, sql};
use serde_json::{Value, json};

const STUDY: &str = "shadow-puppets";

/// Block, how many participants choose PA 0, 1, … times, and what R 4.2.2's `t.test` makes of that: t and p.
const PAPER: [(&str, &[usize], f64, f64); 3] = [
    ("stills", &[12, 14, 6], -1.4375905768565216, 0.16056863389412473),
    ("photographs", &[3, 10, 19], 4.20883424647321, 0.00020378219167228206),
    ("animation", &[26, 7], -3.9834823795432888, 0.0003668638983360312),
];

/// Lets 33 people answer; the last one only the animation.
fn answer(server: &Server) {
    let database = server.data.join("kelir.sqlite");
    for person in 0..33 {
        let path = format!("/api/v1/studies/{STUDY}/sessions");
        let (status, session) = server.call("POST", &path, None, &json!({"params": {}, "display": {}}));
        assert_eq!(status, 201, "{session}");
        let (id, token) = (session["session_id"].as_str().unwrap(), session["token"].as_str());
        let path = format!("/api/v1/sessions/{id}");
        assert_eq!(server.call("POST", &format!("{path}/consent"), token, &Value::Null).0, 200);
        // Only the database knows which side is which.
        let plan = sql(
            &database,
            &format!("SELECT trial FROM session_trials WHERE session_id = '{id}' ORDER BY trial_index"),
        );
        let plan: Vec<Value> =
            plan.iter().map(|row| serde_json::from_str(row["trial"].as_str().unwrap()).unwrap()).collect();
        for (block, counts, ..) in PAPER {
            let wanted = counts.iter().enumerate().flat_map(|(k, n)| std::iter::repeat_n(k, *n)).nth(person);
            let trials = plan.iter().filter(|trial| trial["block_id"] == block);
            for (k, trial) in trials.enumerate() {
                let Some(wanted) = wanted else { continue };
                let pa = k < wanted;
                let choice =
                    if (trial["shown"]["left"]["condition"] == "pa") == pa { "left" } else { "right" };
                let body = json!({"choice": choice, "rt": 900.0 + 61.0 * (person * 7 % 33) as f64 + 200.0 * k as f64, "onset": 100.0, "time_elapsed": 5000,
                    "trial_type": "two-alternative", "plugin_version": "0.1.0", "input": "keyboard", "scale": 1.0, "device_pixel_ratio": 1.0,
                    "viewport": [1280, 800], "refresh_hz": 60.0, "reload_count": 0, "timestamp": "2026-11-22T10:30:00.000Z"});
                let path = format!("{path}/trials/{}", trial["trial_index"]);
                let (status, told) = server.call("PUT", &path, token, &body);
                assert_eq!(status, 200, "{told}");
            }
        }
        if person < 32 {
            assert_eq!(server.call("POST", &format!("{path}/completion"), token, &Value::Null).0, 200);
        }
    }
    // They took the time that they claim: the study leaves out who can't have.
    sql(&database, "UPDATE sessions SET consented_at = '2026-11-22T10:00:00.000Z'");
}

/// Every number behind the page's, in order.
fn numbers(page: &str) -> Vec<f64> {
    let values = page.split("<data value=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
    values.flat_map(|value| value.split(' ').map(|x| x.parse().unwrap()).collect::<Vec<f64>>()).collect()
}

fn holds(numbers: &[f64], wanted: f64) -> bool {
    numbers.iter().any(|x| (x - wanted).abs() <= 1e-12 * wanted.abs())
}

/// A download as the researcher: signs in with the password beside the data.
fn download(server: &Server, path: &str) -> String {
    let password = std::fs::read_to_string(server.data.join("researcher-password")).unwrap();
    let login = ureq::post(format!("{}/api/v1/auth/session", server.base))
        .send_json(json!({"password": password.trim()}))
        .unwrap();
    let cookie = login.headers()["set-cookie"].to_str().unwrap().split(';').next().unwrap().to_owned();
    let get = ureq::get(format!("{}{path}", server.base)).header("Cookie", &cookie);
    get.call().unwrap().body_mut().read_to_string().unwrap()
}

#[test]
fn a_report_says_what_the_answers_say_in_every_form() {
    let data = prepared_data();
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let write = |name: &str| {
        kelir_ok(&[
            "report",
            STUDY,
            "--data",
            data.path().to_str().unwrap(),
            "-o",
            at(name).to_str().unwrap(),
        ]);
        std::fs::read_to_string(at(name)).unwrap()
    };
    let stats = |format: &str| {
        kelir_ok(&["stats", STUDY, "--data", data.path().to_str().unwrap(), "--format", format])
    };

    // Before there are answers: a report that says so, with no figures but those of the paper's own counts.
    let empty = write("empty.html");
    assert!(empty.contains("0 began.") && empty.matches("<svg").count() == PAPER.len());
    assert!(stats("text").contains("0 began."));

    let server = Server::start(data.path(), true);
    answer(&server);

    let json: Value = serde_json::from_str(&stats("json")).unwrap();
    let (page, csv, text) = (write("report.html"), stats("csv"), stats("text"));
    let shown = numbers(&page);
    for (block, _, t, p) in PAPER {
        let judged = json["blocks"].as_array().unwrap().iter().find(|b| b["id"] == block).unwrap();
        let row =
            csv.lines().find(|line| line.starts_with(&format!("screened,{block},t-test,t (df"))).unwrap();
        let cells: Vec<&str> = row.split(',').collect();
        for (ours, theirs) in [
            (judged["t"].as_f64().unwrap(), t),
            (judged["p"].as_f64().unwrap(), p),
            (cells[4].parse().unwrap(), t),
            (cells[8].parse().unwrap(), p),
        ] {
            assert!((ours - theirs).abs() <= 1e-12 * theirs.abs(), "{block}: {ours} is not R's {theirs}");
        }
        assert!(holds(&shown, t) && holds(&shown, p), "{block}");
        assert!(text.contains(&format!("{t:.4}").replace('-', "−")), "{block}: {text}");
        // What stands beside the test is on the page as the JSON has it.
        for path in [
            "/analysis/effect/g",
            "/analysis/bayes/bf01",
            "/analysis/proportion/proportion",
            "/analysis/wilcoxon/p",
            "/rt_ms/median",
            "/p_holm",
        ] {
            assert!(holds(&shown, judged.pointer(path).unwrap().as_f64().unwrap()), "{block}{path}");
        }
    }
    for condition in json["scale"]["conditions"].as_array().unwrap() {
        assert!(holds(&shown, condition["jod"].as_f64().unwrap()), "{condition}");
    }
    for stimulus in json["stimuli"].as_array().unwrap() {
        assert!(page.contains(stimulus["sha256"].as_str().unwrap()));
        let rmse = stimulus.pointer("/provenance/error/penumbra/rmse").and_then(Value::as_f64);
        assert!(rmse.is_none_or(|rmse| rmse == 0.0 || holds(&shown, rmse)), "{stimulus}");
    }
    assert!(
        page.contains(json["version"].as_str().unwrap())
            && page.contains(json["chain"]["head"].as_str().unwrap())
    );
    // Control: the paper's printed third t is on the page as printed, its neighbours are not.
    assert!(holds(&shown, -3.293) && !holds(&shown, -3.2931));

    // The server hands out the very same page, and Markdown with its figures within.
    assert!(
        download(&server, &format!("/api/v1/studies/{STUDY}/versions/current/report.html")) == page,
        "the server says the same"
    );
    let embedded = download(&server, &format!("/api/v1/studies/{STUDY}/versions/current/report.md"));
    let markdown = write("report.md");
    let distributions = PAPER.map(|(block, ..)| format!("distribution-{block}"));
    let papers = ["still-mc", "still-photo", "animation-mc"].map(|id| format!("equivalence-{id}"));
    let figures = ["choices", "scale", "response-times", "errors"].map(str::to_owned).into_iter();
    let figures = figures.chain(distributions).chain(papers);
    let figures: Vec<String> = figures.collect();
    assert_eq!(embedded.matches("data:image/svg+xml;base64,").count(), figures.len());
    for figure in figures {
        let svg = std::fs::read_to_string(at(&format!("report-figures/{figure}.svg"))).unwrap();
        assert!(
            page.contains(&svg) && markdown.contains(&format!("(<report-figures/{figure}.svg>)")),
            "{figure}"
        );
    }

    let data = data.path().to_str().unwrap();
    let people = kelir_ok(&["export", STUDY, "--data", data, "--table", "participants"]);
    assert_eq!(people.lines().count(), 1 + 33);
    let sheet = at("answers.xlsx");
    kelir_ok(&["export", STUDY, "--data", data, "-o", sheet.to_str().unwrap()]);
    assert!(std::fs::read(&sheet).unwrap().starts_with(b"PK"));
    let one = kelir(&["export", STUDY, "--data", data, "--table", "pairs", "-o", sheet.to_str().unwrap()]);
    assert_eq!(one.status.code(), Some(2), "a spreadsheet holds every table");
    // What is wrong with a file is said once.
    let folder = at("folder.csv");
    std::fs::create_dir(&folder).unwrap();
    let refused = kelir(&["export", STUDY, "--data", data, "-o", folder.to_str().unwrap()]);
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(said.matches("folder.csv").count(), 1, "{said}");

    looks_right(&at("report.html"));
}

/// In a browser without a network: fits its window, even a phone's, follows the scheme, and asks nobody for anything.
fn looks_right(file: &Path) {
    let shots = root().join("tests/screenshots");
    let seen = browser("report.mjs", &json!({"file": file, "shots": shots}));
    assert_eq!(seen["complaints"], json!([]));
    assert_eq!(seen["requests"].as_array().unwrap().len(), 1, "the file alone: {}", seen["requests"]);
    for page in seen["pages"].as_array().unwrap() {
        assert!(page["overflow"].as_f64().unwrap() <= 0.5, "{page}");
        assert!(page["letters"].as_f64().unwrap() >= 8.0, "figures can be read: {page}");
    }
    assert!(seen["wider"].as_f64().unwrap() > 1000.0, "the measure sees what is too wide: {seen}");
    assert_ne!(seen["light"], seen["dark"]);
    assert_eq!(seen["dark"][0], seen["dark"][1], "figures are drawn on the page's own ground");
}

#[test]
fn what_cannot_be_reported_is_refused_and_nothing_is_written() {
    let data = prepared_data();
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let data = data.path().to_str().unwrap();
    for (args, phrase) in [
        (["report", "nobody", "--data", data, "-o", &out("x.html")], "must be one of shadow-puppets"),
        (["report", STUDY, "--data", "/nonexistent/kelir", "-o", &out("x.html")], "/nonexistent/kelir"),
        (["report", STUDY, "--data", data, "-o", &out("x.pdf")], ".html or .md"),
        (["report", STUDY, "--data", data, "-o", &out("none/x.html")], "is no folder"),
        (["stats", "nobody", "--data", data, "--format", "csv"], "must be one of shadow-puppets"),
    ] {
        let got = kelir(&args);
        let message = String::from_utf8_lossy(&got.stderr).into_owned();
        assert_eq!(got.status.code(), Some(2), "{args:?}: {message}");
        assert!(got.stdout.is_empty() && message.contains(phrase), "{args:?}: {message}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
