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
