#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::schema::Sound;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use serde_json::json;

#[test]
fn every_kind_has_its_own_name_and_is_found_by_it() {
    for kind in TrialKind::all() {
        assert!(std::ptr::addr_eq(rules(kind.name()).unwrap(), kind.rules()));
        let json = serde_json::to_value(&kind).unwrap();
        assert_eq!(json["trial"], kind.name());
        assert_eq!(serde_json::from_value::<TrialKind>(json).unwrap(), kind);
    }
    let names: std::collections::BTreeSet<_> = TrialKind::all().iter().map(TrialKind::name).collect();
    assert_eq!(names.len(), TrialKind::all().len());
    assert!(rules("three-alternative").is_none());
}

#[test]
fn what_is_planned_is_what_is_observed_for_each_kind_order_and_choice() {
    for kind in TrialKind::all() {
        let rules = kind.rules();
        for (target_first, chose_first) in [(true, true), (true, false), (false, true), (false, false)] {
            let shown = rules.plan("item", "target", "other", target_first);
            assert_eq!(shown.keys().copied().collect::<Vec<_>>(), rules.roles());
            let sent = rules.simulate(chose_first, 812.5);
            let checked = rules.check(&sent).unwrap();
            let Observation::Choice(choice) = rules.observe(&shown, &checked.answer).unwrap();
            assert_eq!(
                (choice.item.as_ref(), choice.rt_ms, choice.chose_first),
                ("item", 812.5, chose_first)
            );
            assert_eq!(choice.first_condition == "target", target_first);
            assert_ne!(choice.first_condition, choice.second_condition);
            assert_eq!(rules.chosen(&checked.answer), Some(rules.roles()[usize::from(!chose_first)]));
            assert_eq!(rules.chose(&shown, chose_first, 812.5), Some(Observation::Choice(choice)));
        }
        let shown = rules.plan("item", "target", "other", true);
        let other = if kind.name() == "two-interval" { "left" } else { "first" };
        let foreign = json!({ "choice": other, "rt_ms": 1.0 }).to_string();
        assert!(rules.observe(&shown, &foreign).is_err(), "another kind's answer says nothing");
        assert!(
            rules.observe(&Shown::new(), &rules.check(&rules.simulate(true, 1.0)).unwrap().answer).is_err()
        );
    }
}

#[test]
fn what_breaks_a_rule_beside_the_choice_is_an_answer_without_it_and_named() {
    let good = json!({
        "choice": "left", "rt": 812.5, "onset": 100.25, "time_elapsed": 5000, "trial_type": "two-alternative", "plugin_version": "1",
        "input": "pen", "scale": 1.0, "arrangement": "stack", "device_pixel_ratio": 2, "viewport": [1280, 800], "refresh_hz": null,
        "hidden_ms": 0, "min_visible_ms": 800, "css_width_px": 296.0, "reload_count": 0, "timestamp": "2026-11-22T10:30:00.000Z",
        "frames": { "left": { "fps": 12, "shown": 24 } }, "something": "of its own",
    });
    let rules = TrialKind::TwoAlternative.rules();
    assert_eq!(rules.check(&good).unwrap().answer, r#"{"choice":"left","rt_ms":812.5}"#);
    assert_eq!(rules.record().sound(&good).broken, Vec::<String>::new());
    let cases = [
        ("rt", json!(-1)),
        ("rt", json!(86_400_000.5)),
        ("rt", json!("fast")),
        ("rt", Value::Null),
        ("onset", json!(-0.5)),
        ("scale", json!(101)),
        ("input", json!("nose")),
        ("arrangement", json!("above")),
        ("viewport", json!([1280])),
        ("viewport", json!([1280, "800"])),
        ("timestamp", json!("x".repeat(101))),
        ("reload_count", json!(1.5)),
        ("frames", json!({ "left": { "fps": -1, "shown": 24 } })),
        ("frames", json!((0..999).map(|i| (i.to_string(), json!({}))).collect::<serde_json::Map<_, _>>())),
    ];
    for (field, value) in cases {
        let mut sent = good.clone();
        sent[field] = value.clone();
        let rt = if field == "rt" { "null" } else { "812.5" };
        let answer = format!(r#"{{"choice":"left","rt_ms":{rt}}}"#);
        assert_eq!(rules.check(&sent).unwrap().answer, answer, "{field} = {value}");
        let Sound { broken, .. } = rules.record().sound(&sent);
        assert_eq!(broken, [field], "{value}");
        let shown = rules.plan("item", "target", "other", true);
        let Observation::Choice(choice) = rules.observe(&shown, &answer).unwrap();
        assert_eq!(choice.rt_ms.is_nan(), field == "rt");
    }
    let sent = json!({ "choice": "left", "rt": 1, "frames": { "left": { "fps": -1, "shown": 24 } } });
    let half = rules.record().sound(&sent);
    assert_eq!(half.value["frames"]["left"], json!({ "fps": null, "shown": 24 }), "only what is wrong goes");
    assert_eq!(
        rules.record().sound(&json!({ "choice": "left" })).broken,
        ["rt"],
        "what is asked for and missing is named"
    );
}

#[test]
fn without_one_of_its_choices_it_is_no_answer() {
    let rules = TrialKind::TwoAlternative.rules();
    for choice in [json!("first"), json!(3), Value::Null] {
        let errors = rules.check(&json!({ "choice": choice, "rt": -1, "scale": -1 })).unwrap_err();
        assert_eq!(errors.len(), 1, "{errors:?}");
        assert_eq!(
            (errors[0].pointer.as_str(), errors[0].rule.contains("\"left\" or \"right\"")),
            ("/choice", true)
        );
    }
    for sent in [json!([]), Value::Null, json!("left"), json!({})] {
        assert!(rules.check(&sent).is_err(), "{sent}");
    }
}

#[test]
fn the_codebook_says_type_unit_meaning_and_values_of_every_column() {
    for kind in TrialKind::all() {
        for column in kind.rules().record().columns() {
            assert!(column.meaning.len() > 10, "{column:?}");
            assert!(column.kind == "text" || column.values.is_empty(), "{column:?}");
        }
    }
    let columns = TrialKind::TwoAlternative.rules().record().columns();
    let column = |name: &str| columns.iter().find(|column| column.name == name).unwrap();
    assert_eq!((column("rt").kind.as_str(), column("rt").unit.as_str()), ("number", "ms"));
    let values = |name| column(name).values.iter().map(|v| v.value.as_str()).collect::<Vec<_>>();
    assert_eq!(values("arrangement"), ["side", "stack", "beside", "below"]);
    assert_eq!(column("arrangement").values[1].meaning, "the right one below the left one");
    assert_eq!(values("input"), ["mouse", "touch", "pen", "keyboard"]);
    assert_eq!(column("viewport").kind, "list");
    assert!(column("scale").meaning.starts_with("Device pixels per stimulus pixel"));
}

proptest! {
    #![proptest_config(Config { cases: 2000, rng_seed: RngSeed::Fixed(20_261_128), failure_persistence: None, ..Config::default() })]

    /// What is stored is what is read back, to the bit, but for −0, which canonical JSON does not have.
    #[test]
    fn response_times_survive_being_stored(bits in any::<u64>()) {
        let rt = f64::from_bits(bits);
        let sent = json!({ "choice": "left", "rt": rt });
        let checked = TrialKind::TwoAlternative.rules().check(&sent);
        let answer = checked.unwrap().answer;
        let back: Value = serde_json::from_str(&answer).unwrap();
        prop_assert_eq!(&kelir_jcs::canonical(back.clone()).unwrap(), &answer);
        prop_assert_eq!(back["rt_ms"].is_number(), (0.0..=86_400_000.0).contains(&rt));
        if let Some(read) = back["rt_ms"].as_f64() {
            prop_assert_eq!((read + 0.0).to_bits(), (rt + 0.0).to_bits());
        }
    }
}
