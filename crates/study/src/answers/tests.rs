#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
//! The oracle is the definition, row by row: every number from the rows as they came, looked up by their texts.

use super::*;
use crate::analysis::{conditions_scale, summarise};
use crate::report::Report;
use crate::screening::{Exclusion, screen};
use kelir_fixtures as fixtures;
use kelir_stats::pairwise::{ScaleOptions, Wins, scale};
use proptest::prelude::*;
use std::collections::{BTreeSet, HashSet};

/// Three blocks of 2, 3 and 1 pairs over three conditions, and a catch block of 2; with rules of screening.
fn study() -> StudyDefinition {
    let block = |id: &str, conditions: &str, target: &str, items: usize, catch: bool| {
        let items = fixtures::items((0..items).map(|i| format!("{id}{i}")), "a.toml");
        let (conditions, target, catch) =
            (format!("[{conditions}]"), format!("\"{target}\""), catch.to_string());
        let keys = [("conditions", &*conditions), ("target", &target), ("catch", &catch), ("items", &items)];
        fixtures::block(id, &keys)
    };
    let keys = [
        ("conditions", r#"{ a = { technique = "pa" }, b = { technique = "mc" }, c = { technique = "pa" } }"#),
        (
            "screening",
            "{ min_rt_ms = 200, max_fast_trials = 1, max_failed_catch_trials = 0, straight_lining = true, incomplete = true }",
        ),
    ];
    let blocks = [
        block("ab", "\"a\", \"b\"", "b", 2, false),
        block("bc", "\"b\", \"c\"", "b", 3, false),
        block("easy", "\"a\", \"c\"", "c", 2, true),
        block("ca", "\"c\", \"a\"", "a", 1, false),
    ];
    StudyDefinition::parse("s.toml", &fixtures::study(&keys, blocks)).unwrap()
}

/// A row with texts of its own: participant, pair (two of ten are none of the study's), the target left, left chosen, time.
type Drawn = (u8, u8, bool, bool, u16);

struct Told {
    session: String,
    block: String,
    pair: String,
    left: String,
    right: String,
    chose_left: bool,
    rt_ms: f64,
}

impl Told {
    fn chosen(&self) -> &str {
        if self.chose_left { &self.left } else { &self.right }
    }

    fn row(&self) -> Row<'_> {
        Row::choice(&self.session, 0, &self.pair, [&self.left, &self.right], self.chose_left, self.rt_ms)
    }
}

fn told(study: &StudyDefinition, drawn: &[Drawn]) -> Vec<Told> {
    let items: Vec<(&Block, &str)> =
        study.blocks.iter().flat_map(|b| b.items.iter().map(move |p| (b, p.id.as_str()))).collect();
    drawn
        .iter()
        .map(|&(session, pair, target_left, chose_left, rt)| {
            let session = format!("s{session:03}");
            let rt_ms = f64::from(rt);
            let Some((block, pair)) = items.get(usize::from(pair)) else {
                let (block, pair) = ("ab".to_owned(), format!("ghost{pair}"));
                return Told { session, block, pair, left: "a".into(), right: "b".into(), chose_left, rt_ms };
            };
            let (target, other) = (block.target.clone(), block.other().to_owned());
            let (left, right) = if target_left { (target, other) } else { (other, target) };
            Told {
                session,
                block: block.id.clone(),
                pair: (*pair).to_owned(),
                left,
                right,
                chose_left,
                rt_ms,
            }
        })
        .collect()
}

/// The rows that count: of known pairs, the first of each participant and pair.
fn counted(rows: &[Told]) -> Vec<&Told> {
    let mut seen = HashSet::new();
    rows.iter().filter(|r| !r.pair.starts_with("ghost") && seen.insert((&r.session, &r.pair))).collect()
}

/// The rules of screening in words of rows.
fn excluded(study: &StudyDefinition, rows: &[&Told]) -> BTreeSet<String> {
    let sessions: BTreeSet<&str> = rows.iter().map(|r| r.session.as_str()).collect();
    let out = sessions.into_iter().filter(|session| {
        let own: Vec<_> = rows.iter().filter(|r| r.session == *session).collect();
        let fast = own.iter().filter(|r| r.rt_ms < 200.0).count() > 1;
        let failed = own.iter().any(|r| r.block == "easy" && r.chosen() != "c");
        let lefts = own.iter().filter(|r| r.chose_left).count();
        let straight = own.len() >= 5 && (lefts == 0 || lefts == own.len());
        fast || failed || straight || own.len() < study.most_trials()
    });
    out.map(str::to_owned).collect()
}

/// (n, incomplete, counts) of a block.
fn tally(rows: &[&Told], block: &Block) -> (u64, u64, BTreeMap<u32, u64>) {
    let mut counts: BTreeMap<u32, u64> = (0..=block.items.len() as u32).map(|k| (k, 0)).collect();
    let (mut n, mut incomplete) = (0, 0);
    let sessions: BTreeSet<&str> = rows.iter().map(|r| r.session.as_str()).collect();
    for session in sessions {
        let own: Vec<_> = rows.iter().filter(|r| r.session == session && r.block == block.id).collect();
        if own.len() == block.items.len() {
            n += 1;
            let hits = own.iter().filter(|r| r.chosen() == block.target).count();
            *counts.get_mut(&(hits as u32)).unwrap() += 1;
        } else if !own.is_empty() {
            incomplete += 1;
        }
    }
    (n, incomplete, counts)
}

fn wins(rows: &[&Told]) -> Wins {
    let names = ["a", "b", "c"];
    let index = |name: &str| names.iter().position(|n| *n == name).unwrap();
    let real = rows.iter().copied().filter(|r| r.block != "easy");
    let pair = |r: &Told| {
        let loser = if r.chose_left { &r.right } else { &r.left };
        (index(r.chosen()), index(loser))
    };
    Wins::tally(3, real.map(pair)).unwrap()
}

/// What analyses say of participants, and what the rows say.
fn agree(
    study: &StudyDefinition,
    rows: &[&Told],
    participants: &[&Participant],
) -> Result<(), TestCaseError> {
    let summaries = summarise(study, participants);
    for (block, summary) in study.blocks.iter().filter(|b| !b.catch).zip(&summaries) {
        let (n, incomplete, counts) = tally(rows, block);
        prop_assert_eq!(&summary.id, &block.id);
        prop_assert_eq!((summary.n, summary.incomplete, &summary.counts), (n, incomplete, &counts));
        let test = crate::analysis::TTest::of_counts(&counts, block.mu());
        prop_assert_eq!((summary.t, summary.p, summary.sd), (test.t, test.p, test.sd));
    }
    let names = ["a", "b", "c"].map(str::to_owned);
    let expected = scale(&names, &wins(rows), ScaleOptions::default());
    let found = conditions_scale(study, participants);
    prop_assert_eq!(found.clone().ok(), expected.ok(), "{:?}", found);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(4), ..ProptestConfig::with_cases(150) })]

    #[test]
    fn participants_say_what_the_rows_say(
        drawn in prop::collection::vec((0u8..6, 0u8..10, any::<bool>(), any::<bool>(), 100u16..1000), 0..120),
        cut in 0usize..120,
    ) {
        let study = study();
        let rows = told(&study, &drawn);
        let mut answers = Answers::new(&study);
        rows.iter().for_each(|r| answers.push(r.row()));
        let counted = counted(&rows);
        let everybody = answers.participants();
        prop_assert_eq!(answers.len(), counted.len());
        agree(&study, &counted, &everybody)?;

        let out = excluded(&study, &counted);
        let reasons = |p: &Participant| screen(&study, p, &[]);
        let (kept, left_out): (Vec<&Participant>, Vec<&Participant>) =
            everybody.iter().copied().partition(|p| reasons(p).is_empty());
        prop_assert_eq!(left_out.iter().map(|p| p.session_id.to_string()).collect::<BTreeSet<_>>(), out.clone());
        let staying: Vec<&Told> = counted.iter().copied().filter(|r| !out.contains(&r.session)).collect();
        agree(&study, &staying, &kept)?;

        // Read in two parts, as a server does that has read before, it is the same.
        let cut = cut.min(rows.len());
        let mut first = Answers::new(&study);
        rows[..cut].iter().for_each(|r| first.push(r.row()));
        let mut later = first.emptied();
        rows[cut..].iter().for_each(|r| later.push(r.row()));
        first.append(later);
        prop_assert_eq!(first.participants(), everybody);
    }
}

#[test]
fn a_report_counts_sides_times_and_pairs_as_the_rows_do_and_notices_one_changed_row() {
    let study = study();
    // Eight participants answer everything, each pair by another pattern of bits.
    let drawn: Vec<Drawn> = (0..8u8)
        .flat_map(|s| {
            (0..8u8).map(move |p| (s, p, (s + p) % 2 == 0, (s * 5 + p * 3) % 4 < 2, 300 + 10 * u16::from(s)))
        })
        .collect();
    let check = |drawn: &[Drawn], told_of: &[Drawn]| {
        let (rows, expected) = (told(&study, drawn), told(&study, told_of));
        let mut answers = Answers::new(&study);
        rows.iter().for_each(|r| answers.push(r.row()));
        let report = Report::of(&study, &answers.participants());
        report.blocks.iter().all(|block| {
            let of_block: Vec<&Told> = expected.iter().filter(|r| r.block == block.summary.id).collect();
            let lefts = of_block.iter().filter(|r| r.chose_left).count() as u64;
            let items = block.by_item.iter().all(|pair| {
                let own: Vec<_> = of_block.iter().filter(|r| r.pair == pair.id).collect();
                let hits = own.iter().filter(|r| r.chosen() == block.summary.target).count() as u64;
                pair.target.as_ref().is_some_and(|t| (t.chosen, t.trials) == (hits, own.len() as u64))
            });
            let left = block.first.as_ref().unwrap();
            items
                && (left.chosen, left.trials) == (lefts, of_block.len() as u64)
                && block.rt_ms.unwrap().n == left.trials
        })
    };
    assert!(check(&drawn, &drawn));
    // The negative control: one answer to the other side.
    let mut other = drawn.clone();
    other[3].3 = !other[3].3;
    assert!(!check(&drawn, &other));
}

#[test]
fn what_the_study_does_not_know_is_left_out() {
    let study = study();
    let mut answers = Answers::new(&study);
    let row = |item, left, right| Row::choice("s", 0, item, [left, right], true, 1.0);
    answers.push(row("ghost", "a", "b"));
    answers.push(row("ab0", "c", "b"));
    answers.push(row("ab0", "a", "c"));
    answers.push(row("ab0", "a", "a"));
    assert!(answers.is_empty() && answers.participants().is_empty());
    answers.push(row("ab0", "b", "a"));
    let [given] = answers.participants()[0].answers()[..] else { panic!("one answer") };
    assert_eq!((given.item, given.chose_target, given.chose_first), (0, true, true));
    assert_eq!(
        screen(&study, answers.participants()[0], &[])[0],
        Exclusion::Incomplete { answered: 1, trials: 8 }
    );
}
