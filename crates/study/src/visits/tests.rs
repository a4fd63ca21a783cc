#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::answers::{Answers, Row};
use crate::definition::StudyDefinition;
use crate::screening::Exclusion;
use kelir_fixtures as fixtures;
use proptest::prelude::*;
use std::collections::BTreeMap;

fn study(keys: &[(&str, &str)]) -> StudyDefinition {
    let block = fixtures::block("b", &[("items", &fixtures::items(["x", "y"], "a.toml"))]);
    let text = fixtures::study(keys, [block]);
    StudyDefinition::parse("s.toml", &text).unwrap()
}

const SECOND: i64 = 1_000_000;

/// Answers that took `rt_ms` each and came at these times.
fn pace(rt_ms: f64, received_us: &[i64]) -> Pace {
    let steps = (0..).zip(received_us).map(|(i, at)| Pace::of(i, false, rt_ms, Some(*at)));
    steps.fold(Pace::default(), Pace::then)
}

#[test]
fn a_script_that_claims_more_time_than_there_was_is_found_and_a_person_is_not() {
    let consented = Some(1000 * SECOND);
    let at = |ms: [i64; 5]| ms.map(|ms| 1000 * SECOND + 1000 * ms);
    let script = pace(1500.0, &at([20, 60, 100, 130, 164]));
    assert!(script.is_faster_than_clock(consented));
    let person = pace(1500.0, &at([1_900, 3_700, 5_500, 7_300, 9_200]));
    assert!(!person.is_faster_than_clock(consented));
    // One line down for all of the study, and all answers sent together when it is back: late, and possible.
    let queued = pace(1500.0, &at([9_200, 9_201, 9_202, 9_203, 9_204]));
    assert!(!queued.is_faster_than_clock(consented));
    let queued_impossibly = pace(1500.0, &at([5_200, 5_201, 5_202, 5_203, 5_204]));
    assert!(queued_impossibly.is_faster_than_clock(consented));
    assert!(!pace(1500.0, &[]).is_faster_than_clock(consented));
    assert!(!script.is_faster_than_clock(None), "without a consent there is nothing to hold it to");
}

#[test]
fn a_trial_that_an_answer_decides_is_not_answered_sooner_than_it_claims() {
    let steps = |gap_us: i64, decided: bool| {
        let one = |i: u16| Pace::of(i, decided, 1500.0, Some(1000 * SECOND + i64::from(i) * gap_us));
        (0..4).map(one).fold(Pace::default(), Pace::then)
    };
    let consented = Some(900 * SECOND);
    assert!(steps(SECOND / 2, true).is_faster_than_clock(consented));
    assert!(!steps(2 * SECOND, true).is_faster_than_clock(consented));
    assert!(
        !steps(SECOND / 2, false).is_faster_than_clock(consented),
        "a plan that is known can be answered offline"
    );
}

#[test]
fn times_that_cannot_be_are_noticed() {
    for rt_ms in [f64::NAN, -1.0, f64::INFINITY] {
        assert!(Pace::of(0, false, rt_ms, Some(0)).lacks_a_time(), "{rt_ms}");
    }
    assert!(!pace(0.0, &[1, 2]).lacks_a_time());
}

proptest! {
    /// However answers are read, in one go or in parts, they say the same.
    #[test]
    fn parts_of_a_session_add_up(
        steps in prop::collection::vec((0u16..20, any::<bool>(), -10.0..5000.0, prop::option::of(0i64..10 * SECOND)), 0..12),
        cut in 0usize..12,
    ) {
        let of = |steps: &[(u16, bool, f64, Option<i64>)]| {
            steps.iter().map(|(i, decided, rt, at)| Pace::of(*i, *decided, *rt, *at)).fold(Pace::default(), Pace::then)
        };
        let (early, late) = steps.split_at(cut.min(steps.len()));
        prop_assert_eq!(of(&steps), of(early).then(of(late)));
    }

    /// A person who takes their time, whose answers may all be late, is never taken for a script.
    #[test]
    fn who_takes_the_time_is_never_flagged(
        trials in prop::collection::vec((0.0..4000.0, 0i64..3 * SECOND, 0i64..60 * SECOND), 1..20),
    ) {
        let (mut now, mut sent) = (500 * SECOND, 0);
        let mut pace = Pace::default();
        for (i, (rt_ms, pause, delay)) in (0..).zip(trials) {
            now += pause + (rt_ms * 1000.0) as i64;
            // The queue keeps its order.
            sent = sent.max(now + delay);
            pace = pace.then(Pace::of(i, false, rt_ms, Some(sent)));
        }
        prop_assert!(!pace.is_faster_than_clock(Some(500 * SECOND)));
    }
}

fn visit(session: &str, person: Option<&str>, completed_us: Option<i64>) -> Visit {
    Visit {
        session_id: session.to_owned(),
        person: person.map(str::to_owned),
        version: String::new(),
        slot: session.parse().unwrap(),
        kind: SessionKind::Participant,
        flags: Vec::new(),
        consented_us: Some(0),
        completed_us,
        is_active: false,
    }
}

/// Both items answered by each of these sessions, at 9 seconds.
fn answers(study: &StudyDefinition, sessions: &[&str]) -> Answers {
    let mut answers = Answers::new(study);
    for session in sessions {
        for (index, item) in [(0, "x"), (1, "y")] {
            let row = Row::choice(session, index, item, ["pa", "mc"], true, 1500.0);
            answers.push(Row { received_us: Some(9 * SECOND), ..row });
        }
    }
    answers
}

fn ids(judged: &[&crate::answers::Participant]) -> Vec<String> {
    judged.iter().map(|p| p.session_id.to_string()).collect()
}

#[test]
fn one_session_a_person_is_judged_the_first_complete_one() {
    let study = study(&[]);
    let visits = [
        visit("1", Some("ann"), None),
        visit("2", Some("ann"), Some(50)),
        visit("3", Some("ann"), Some(40)),
        visit("4", None, Some(10)),
        visit("5", None, Some(10)),
        visit("6", Some("bob"), None),
        visit("7", Some("bob"), None),
        visit("8", Some("cy"), Some(1)),
    ];
    let answers = answers(&study, &["1", "2", "3", "4", "5", "6", "7"]);
    let judged = Judged::of(&study, &answers, &visits, &[]);
    assert_eq!(ids(&judged.judged), ["3", "4", "5", "6"]);
    assert_eq!(ids(&judged.everybody), ["3", "4", "5", "6"]);
    let left: Vec<(&str, &LeftOut)> =
        judged.left_out.iter().map(|(visit, why)| (visit.session_id.as_str(), why)).collect();
    let of = |session_id: &str, counted: &str| {
        LeftOut::Repeated(Repeated { session_id: session_id.into(), counted: counted.into() })
    };
    assert_eq!(left, [("1", &of("1", "3")), ("2", &of("2", "3")), ("7", &of("7", "6"))]);
}

#[test]
fn trial_runs_and_simulations_are_left_out_unless_asked_for_and_count_against_nobody() {
    let study = study(&[]);
    let of = |session, kind| Visit { kind, ..visit(session, Some("ann"), Some(1)) };
    let visits =
        [of("1", SessionKind::Pilot), of("2", SessionKind::Simulated), of("3", SessionKind::Participant)];
    let answers = answers(&study, &["1", "2", "3"]);
    assert_eq!(ids(&Judged::of(&study, &answers, &visits, &[]).judged), ["3"]);
    let with = Judged::of(&study, &answers, &visits[1..], &[SessionKind::Simulated]);
    assert_eq!(ids(&with.judged), ["2"], "asked for, a simulation is a person like others");
}

#[test]
fn whoever_goes_on_is_in_progress_and_not_excluded_for_not_having_finished() {
    let study = study(&[("screening", "{ incomplete = true, min_rt_ms = 200 }")]);
    let active = |session| Visit { is_active: true, ..visit(session, None, None) };
    let visits = [active("1"), visit("2", None, None), active("3")];
    let mut answers = Answers::new(&study);
    for (session, rt_ms) in [("1", 900.0), ("2", 900.0), ("3", 100.0)] {
        answers.push(Row::choice(session, 0, "x", ["pa", "mc"], true, rt_ms));
    }
    let judged = Judged::of(&study, &answers, &visits, &[]);
    let incomplete = Exclusion::Incomplete { answered: 1, trials: 2 };
    let fast = Exclusion::TooFast { trials: 1, allowed: 0 };
    let why: Vec<&LeftOut> = judged.left_out.iter().map(|(_, why)| why).collect();
    assert_eq!(
        why,
        [&LeftOut::InProgress, &LeftOut::Excluded(vec![incomplete]), &LeftOut::Excluded(vec![fast])]
    );
    assert!(judged.judged.is_empty(), "the rule judges nobody who has not finished");
}

#[test]
fn what_was_noticed_leaves_out_by_the_studys_rules_alone() {
    let flagged =
        Visit { flags: vec![Flag::ManyStarts], consented_us: Some(8 * SECOND), ..visit("1", None, Some(9)) };
    let (all, without) =
        (study(&[("screening", r#"{ flags = ["faster_than_clock", "many_starts"] }"#)]), study(&[]));
    let visits = [flagged];
    let answers = answers(&all, &["1"]);
    let judged = Judged::of(&all, &answers, &visits, &[]);
    let reasons = [Flag::ManyStarts, Flag::FasterThanClock].map(|flag| Exclusion::Flagged { flag });
    assert_eq!(judged.left_out, [(&visits[0], LeftOut::Excluded(reasons.to_vec()))]);
    assert_eq!(judged.flags["1"], [Flag::ManyStarts, Flag::FasterThanClock]);
    let judged = Judged::of(&without, &answers, &visits, &[]);
    assert_eq!((judged.judged.len(), judged.left_out.len(), judged.flags.len()), (1, 0, 1));
    let simulated = Visit { kind: SessionKind::Simulated, ..visits[0].clone() };
    assert_eq!(
        simulated.flags(answers.participants()[0].pace),
        [Flag::ManyStarts],
        "a simulation's time is its own"
    );
}

fn params(list: &[(&str, &str)]) -> BTreeMap<String, String> {
    list.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect()
}

#[test]
fn ids_are_kept_as_sent_and_named_by_the_parameters_of_panels_or_of_the_study() {
    let rules = study(&[]).session;
    for id in ["abc", "a@b.example", "ä. ö", "=1+1", "مرحبا", "\u{202e}x", &"x".repeat(512)] {
        assert_eq!(rules.identify(&params(&[("PROLIFIC_PID", id)])), Ok(Some(("PROLIFIC_PID", id))));
    }
    let both = params(&[("id", "1"), ("workerId", "2"), ("utm", "x")]);
    assert_eq!(rules.identify(&both), Ok(Some(("workerId", "2"))));
    assert_eq!(rules.identify(&params(&[("prolific_pid", "p")])), Ok(Some(("prolific_pid", "p"))));
    assert_eq!(rules.identify(&params(&[("ID", "small"), ("id", "exact")])), Ok(Some(("id", "exact"))));
    assert_eq!(rules.identify(&params(&[("workerId", ""), ("id", "1")])), Ok(Some(("id", "1"))));
    assert_eq!(rules.identify(&params(&[("participant", "p")])), Ok(None));
    let own = study(&[("session", r#"{ id = "participant" }"#)]).session;
    assert_eq!(own.identify(&params(&[("participant", "p"), ("id", "1")])), Ok(Some(("participant", "p"))));
    assert_eq!(own.identify(&params(&[("id", "1")])), Ok(None));
}

#[test]
fn an_id_that_cannot_be_taken_is_refused_by_name() {
    let rules = study(&[]).session;
    for id in ["", "a\nb", "\u{0}", "\u{7f}", "\u{85}", &"ä".repeat(257)] {
        let refused = rules.identify(&params(&[("id", id)])).unwrap_err();
        assert_eq!((refused.name.as_str(), refused.value.as_str()), ("id", id));
        assert!(refused.rule.contains("1 to 512 bytes"), "{}", refused.rule);
    }
}

#[test]
fn the_table_of_flags_in_the_study_files_pages_is_this_one() {
    let page = include_str!("../../../../stimuli/studies/README.md");
    for flag in Flag::ALL {
        let row = format!("| `{}` | {} |", flag.as_str(), flag.meaning());
        assert!(page.contains(&row), "stimuli/studies/README.md lacks: {row}");
    }
    for name in ID_PARAMETERS {
        assert!(page.contains(&format!("`{name}`")), "{name}");
    }
}

#[test]
fn places_that_two_have_completed_are_counted_and_items_that_lean_are_named() {
    let study = study(&[]);
    let mut visits = [visit("1", None, Some(1)), visit("2", None, Some(2)), visit("3", None, None)];
    let mut given = Answers::new(&study);
    // The target stands first for everybody in x, and alternates in y.
    for (session, conditions) in [("1", ["pa", "mc"]), ("2", ["mc", "pa"]), ("3", ["pa", "mc"])] {
        given.push(Row::choice(session, 0, "x", ["pa", "mc"], true, 1500.0));
        given.push(Row::choice(session, 1, "y", conditions, true, 1500.0));
    }
    let balance = |visits: &[Visit]| Balance::of(&study, &Judged::of(&study, &given, visits, &[]));
    let lean = UnevenItem { block: "b".into(), item: "x".into(), target_first: 3, answers: 3 };
    assert_eq!(balance(&visits), Balance { items: 2, doubled_places: 0, uneven: vec![lean] });
    visits[1].slot = 1;
    assert_eq!(balance(&visits).doubled_places, 1);
    visits[1].version = "another".to_owned();
    assert_eq!(balance(&visits).doubled_places, 0, "places are a version's own");
    visits[1].version = String::new();
    visits[1].completed_us = None;
    assert_eq!(balance(&visits).doubled_places, 0, "who does not finish leaves the place to another");
    assert_eq!(balance(&[]), Balance::default(), "without answers nothing is said to be even");
}
