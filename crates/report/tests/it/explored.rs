//! What a report says besides its planned tests, read back against the data.

use crate::fixture::{Study, paper};
use kelir_report::{Document, numbers, text};

fn said(study: &Study) -> String {
    text(&Document::of(&study.report())).split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Thirty-two participants: 17 chose the target in the first pair, 9 in the second, so many of these both times.
fn two_pairs(both: usize) -> Study {
    let chose = |yes: bool| if yes { "pa" } else { "mc" };
    let person = |i: usize| {
        let second = i < both || (17..26 - both).contains(&i);
        vec![("still-a", chose(i < 17), 700.0 + i as f64), ("still-b", chose(second), 600.0)]
    };
    Study { people: (0..32).map(person).collect(), ..Study::default() }
}

#[test]
fn pairs_at_53_and_28_percent_are_never_pooled_untested() {
    // McNemar's exact test, R 4.2.2: binom.test(0, 8) and binom.test(4, 16).
    for (both, sentence) in [
        (
            9,
            "Its pairs differ (28% to 53%; Cochran's Q, p = 0.0078): the share above is a mean of different ones.",
        ),
        (5, "Its pairs are not shown to differ (28% to 53%; Cochran's Q, p = 0.0768)."),
    ] {
        let said = said(&two_pairs(both));
        assert!(said.contains("Stills: 32 participants chose pa over mc in 41% of 64 choices"), "{said}");
        assert!(said.contains(sentence), "{said}");
        assert!(said.contains("can hardly be estimated from 2 pairs"), "{said}");
    }
    // One pair has none beside it.
    let alone = said(&Study { people: vec![vec![("loop-a", "pa", 900.0)]; 9], ..Study::default() });
    assert!(!alone.contains("pairs differ") && !alone.contains("Cochran"), "{alone}");
}

#[test]
fn sentences_of_order_are_made_from_the_numbers_they_name() {
    let study = paper([[12, 14, 6], [3, 10, 19], [26, 7, 0]]);
    let (said, rows) = (said(&study), numbers(&study.report()));
    let row = |statistic: &str| rows.iter().find(|n| n.statistic.starts_with(statistic)).unwrap();
    // Of five trials the first, third and fifth are answered on the left: 2 · 32 + 2 · 32 + 33 of them, by who answered which.
    let first = row("share of what stood first");
    let left: usize = study.people.iter().map(|own| own.len().div_ceil(2)).sum();
    let all: usize = study.people.iter().map(Vec::len).sum();
    assert_eq!((first.value, first.n), (Some(left as f64 / all as f64), Some(all as u64)));
    assert!(said.contains(&format!("chosen in 60% of {all} choices by 33 participants: more often than half, p ≤ 0.0005 by sign flips")), "{said}");
    assert_eq!((row("keep to one side").value, row("keep to one side").n), (Some(0.0), Some(33)));
    assert!(
        said.contains("Of 33 participants none is shown to keep to one side")
            && said.contains("at most 5 choices each nobody could be"),
        "{said}"
    );
    // An empty study has none of it.
    assert!(!self::said(&Study::default()).contains("Sides, order"));
}

#[test]
fn the_primary_endpoint_comes_first_and_leaves_the_family_of_the_others() {
    let mut study = paper([[12, 14, 6], [3, 10, 19], [26, 7, 0]]);
    let without = study.report();
    let said_without = said(&study);
    assert!(
        said_without.contains("The study file names no primary endpoint")
            && !said_without.contains("Found, primary")
    );
    study.primary = "test = \"t-test\", block = \"photographs\", participants = 33".to_owned();
    let (report, said) = (study.report(), said(&study));
    // R 4.2.2: t.test(rep(0:2, c(3, 10, 19)), mu = 1)$p.value; of the two that are left p.adjust(c(0.16057, 0.00036686), "holm").
    let primary = report.report.primary.as_ref().unwrap();
    assert!((primary.p.unwrap() - 0.00020378219167228206).abs() < 1e-15 && primary.found);
    assert!(
        said.contains("photo against pa in the block Photographs: a difference is shown by the two-tailed one-sample t-test of 32 participants, p = 2.04 × 10⁻⁴"),
        "{said}"
    );
    assert!(said.contains("Found besides, secondary and exploratory"), "{said}");
    let holm = |of: &kelir_report::StudyReport| {
        of.report.blocks.iter().map(|b| b.p_holm.unwrap()).collect::<Vec<_>>()
    };
    let p: Vec<f64> = report.report.blocks.iter().map(|b| b.summary.p.unwrap()).collect();
    assert_eq!(holm(&report), [p[0], p[1], 2.0 * p[2]]);
    assert_eq!(holm(&without)[1], 3.0 * p[1], "control: without one it is one of three");
    // One more participant is planned than is judged: a look before the end.
    study.primary = study.primary.replace("33", "34");
    let early = self::said(&study);
    assert!(early.contains("33 of the 34 participants that the study file plans are judged here"), "{early}");
    assert!(said.contains("As many participants are judged as the study file plans, 33."), "{said}");
    assert!(said_without.contains("plans no number of participants"), "{said_without}");
    // Every other test that can decide, by the numbers of the same report.
    study.within = "0.2".to_owned();
    for (keys, p) in [
        (
            "test = \"sign\", block = \"photographs\"",
            report.report.blocks[1].analysis.sign.as_ref().unwrap().p,
        ),
        (
            "test = \"wilcoxon\", block = \"photographs\"",
            report.report.blocks[1].analysis.wilcoxon.as_ref().unwrap().p,
        ),
        // R 4.2.2: binom.test(20, 32)$p.value, who chose the target of the first pair once or twice.
        ("test = \"binomial\", block = \"stills\", item = \"still-a\"", 0.2153271),
        (
            "test = \"scale\", compare = [\"pa\", \"mc\"]",
            report.report.scale.as_ref().unwrap().differences[0].p,
        ),
    ] {
        study.primary = keys.to_owned();
        let found = study.report().report.primary.unwrap();
        assert!((found.p.unwrap() - p).abs() < 1e-6, "{keys}: {found:?} {p}");
    }
}

#[test]
fn what_was_fixed_before_is_said_by_the_times_that_are_known() {
    let study = paper([[12, 14, 6], [3, 10, 19], [26, 7, 0]]);
    let mut report = study.report();
    let of = |report: &kelir_report::StudyReport| kelir_report::html(&Document::of(report));
    let before = of(&report);
    assert!(
        before
            .contains("served from 2026-11-22 09:00 UTC on, before its first answer at 2026-11-22 14:22 UTC"),
        "{before}"
    );
    assert!(before.contains(&report.design.design_hash()), "{before}");
    report.served.as_mut().unwrap().first = "2026-11-23T09:00:00.000Z".to_owned();
    assert!(of(&report).contains("it does not show that the design was fixed before"));
    report.served = None;
    assert!(!of(&report).contains("Preregistration record"));
    // What nobody can know is left blank, in the form for the paper.
    for blank in
        ["approved by [board, number, date]", "33 began and 33 completed it, from 2026-11-22 14:22 UTC"]
    {
        assert!(before.contains(blank), "{before}");
    }
    let terminal = said(&study);
    assert!(terminal.contains("Devices and displays") && terminal.contains("60 33"), "{terminal}");
}

#[test]
fn a_p_and_an_interval_that_disagree_are_named() {
    let mut report = paper([[12, 14, 6], [3, 10, 19], [26, 7, 0]]).report();
    let of = |report: &kelir_report::StudyReport| {
        text(&Document::of(report)).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert!(!of(&report).contains("disagree about none"), "they agree");
    let difference = &mut report.report.scale.as_mut().unwrap().differences[0];
    (difference.p, difference.low, difference.high) = (0.04, Some(-0.02), Some(1.5));
    assert!(of(&report).contains("(p = 0.0400, interval −0.02 to 1.50)"), "{}", of(&report));
}
