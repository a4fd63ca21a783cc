#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::plan::TrialPlan;
use kelir_fixtures as fixtures;
use std::collections::BTreeSet;

fn study() -> StudyDefinition {
    let block = |id: &str, catch: &str, trial: &str| {
        let items = fixtures::items([format!("{id}-x")], "a.toml");
        fixtures::block(id, &[("catch", catch), ("trial", trial), ("items", &items)])
    };
    let blocks = [
        block("sides", "false", "\"two-alternative\""),
        block("easy", "true", "\"two-alternative\""),
        block("intervals", "false", "\"two-interval\""),
    ];
    StudyDefinition::parse("s.toml", &fixtures::study(&[], blocks)).unwrap()
}

#[test]
fn every_column_that_there_was_is_there_in_its_place_and_every_one_is_explained() {
    let codebook = codebook();
    let names: Vec<&str> = codebook.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names[..FIRST.len()], FIRST);
    assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "no name twice: {names:?}");
    for column in &codebook {
        assert!(column.meaning.len() > 4, "{column:?}");
        assert!(!column.name.contains('.'), "{column:?}");
    }
    for name in [
        "trial_kind",
        "version",
        "design_hash",
        "item_id",
        "repeat",
        "is_catch",
        "is_practice",
        "css_width_px",
        "min_visible_ms",
        "shown_left_condition",
        "shown_left_sha256",
        "shown_second_condition",
        "shown_second_sha256",
        "requested_ms_mask",
    ] {
        assert!(names.contains(&name), "{name}");
    }
    let column = |name: &str| codebook.iter().find(|column| column.name == name).unwrap();
    assert!(column("scale").meaning.contains("Device pixels per stimulus pixel"));
    assert_eq!(column("arrangement").values.len(), 4);
    assert!(column("input").values.iter().any(|value| value.value == "pen"));
}

#[test]
fn a_row_says_of_each_kind_what_was_shown_and_chosen_and_leaves_other_kinds_columns_empty() {
    let study = study();
    let session = SessionColumns {
        subject_id: "p1".to_owned(),
        session_id: "s".to_owned(),
        study_id: study.id.clone(),
        config_hash: "v".to_owned(),
        version: "v".to_owned(),
        design_hash: "d".to_owned(),
        status: SessionStatus::InProgress,
        percent_complete: 100.0 / 3.0,
        slot: 0,
        plan_seed: "0".to_owned(),
        judged: 1,
        reject_reason: None,
    };
    let rows = Rows::default();
    for trial in TrialPlan::for_slot(&study, 0).trials {
        let rules = trial.trial.rules();
        let roles = rules.roles();
        let sha256: BTreeMap<Role, &str> = [(roles[0], "aa"), (roles[1], "bb")].into();
        for chose_first in [true, false] {
            let mut payload = rules.simulate(chose_first, 812.5);
            payload["viewport"] = json!([1280, 800.5]);
            payload["requested_ms"] = json!({ "mask": 250 });
            payload["hidden_ms"] = json!(0);
            payload["onset"] = json!(-1);
            let checked = rules.check(&payload).map_or_else(|_| String::new(), |checked| checked.answer);
            let broken = if trial.trial.name() == "two-interval" { "onset requested_ms" } else { "onset" };
            let answer = if trial.trial.name() == "two-interval" {
                json!({ "choice": roles[usize::from(!chose_first)].as_str(), "rt_ms": 812.5 }).to_string()
            } else {
                checked
            };
            let cells = rows.cells(&Answered {
                study: &study,
                session: &session,
                trial: &trial,
                sha256: sha256.clone(),
                size: [1110, 624],
                answer: Some(&answer),
                payload: &payload,
                payload_hash: Some("ph".to_owned()),
                answer_hash: "ah",
                received_at: "2026-11-28T10:00:00.000Z",
                place: (2, 7),
            });
            let cell = |name: &str| cells[rows.names().iter().position(|n| n == name).unwrap()].as_str();
            let chosen = roles[usize::from(!chose_first)];
            let condition = &*trial.shown[&chosen].condition;
            assert_eq!((cell("response"), cell("chosen_condition")), (chosen.as_str(), condition));
            assert_eq!(cell("target_chosen"), if condition == "pa" { "1" } else { "0" });
            let catch = trial.block_id == "easy";
            assert_eq!(cell("is_catch"), if catch { "1" } else { "0" });
            assert_eq!(cell("correct"), if catch { cell("target_chosen") } else { "" });
            assert_eq!(
                (cell("rt"), cell("viewport_height"), cell("percent_complete")),
                ("812.5", "800.5", "33.333333333333336")
            );
            let intervals = trial.trial.name() == "two-interval";
            assert_eq!(cell("left_condition").is_empty(), intervals);
            assert_eq!(cell("shown_first_condition").is_empty(), !intervals);
            assert_eq!(cell(&format!("shown_{}_sha256", roles[1].as_str())), "bb");
            assert_eq!(cell("stimulus"), r#"["aa","bb"]"#);
            assert_eq!(
                (cell("requested_ms_mask"), cell("status"), cell("chain_seq")),
                ("250", "in progress", "7")
            );
            assert_eq!((cell("flags"), cell("onset"), cell("hidden_ms")), (broken, "", "0"));
        }
    }
}

#[test]
fn each_event_is_a_row_that_its_codebook_explains_and_pages_of_before_sent_none() {
    let codebook = events_codebook();
    let names: Vec<&str> = codebook.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "no name twice: {names:?}");
    assert!(codebook.iter().all(|column| column.meaning.len() > 4), "{codebook:?}");
    let column = |name: &str| codebook.iter().find(|column| column.name == name).unwrap();
    assert_eq!((column("time_ms").unit.as_str(), column("event").values.len()), ("ms", 9));
    assert!(column("reason").values.iter().any(|value| value.value == "double"));

    let study = study();
    let trial = &TrialPlan::for_slot(&study, 0).trials[0];
    let of = EventSession { subject_id: "p1", session_id: "s", study_id: "t", version: "v" };
    let mut payload = trial.trial.rules().simulate(true, 812.5);
    assert!(event_rows(&of, trial, &payload).is_empty());
    assert!(event_rows(&of, trial, &Value::Null).is_empty(), "withdrawn");
    payload["events"] = json!([
        { "event": "ignored", "time_ms": -120.5, "reason": "answered", "input": "pen", "choice": "left" },
        { "event": "resize", "time_ms": 300, "viewport": [390, 844], "scale": 0.5, "css_width_px": 296, "device_pixel_ratio": 2,
          "arrangement": "stack" },
        { "event": "blur", "time_ms": "soon" },
    ]);
    let rows = event_rows(&of, trial, &payload);
    let cell = |row: usize, name: &str| rows[row][names.iter().position(|n| *n == name).unwrap()].as_str();
    assert_eq!(rows.len(), 3);
    for (row, cells) in rows.iter().enumerate() {
        assert_eq!(cells.len(), names.len());
        assert_eq!((cell(row, "subject_id"), cell(row, "event_index")), ("p1", row.to_string().as_str()));
        assert_eq!(cell(row, "trial_index"), trial.trial_index.to_string());
    }
    assert_eq!(
        ["event", "time_ms", "reason", "input", "choice"].map(|name| cell(0, name)),
        ["ignored", "-120.5", "answered", "pen", "left"]
    );
    assert_eq!(
        ["viewport_width", "viewport_height", "scale", "arrangement"].map(|name| cell(1, name)),
        ["390", "844", "0.5", "stack"]
    );
    assert_eq!((cell(2, "event"), cell(2, "time_ms")), ("blur", ""), "what breaks its rule is empty");
}
