#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::findings::PER_TRIAL;
use super::*;
use crate::answers::blocks;
use crate::definition::{EquivalenceBound, StudyDefinition};
use crate::primary::PrimaryTest;
use kelir_fixtures as fixtures;
use kelir_reader::Problem;

/// `blocks` of (conditions, pairs, rest of the block) with rules of screening.
fn study(screening: &str, blocks: &[(&str, &str, usize, &str)]) -> StudyDefinition {
    let block = |(id, conditions, items, rest): &(&str, &str, usize, &str)| {
        let level =
            |i: usize| if rest.contains("psychometric") { format!(", level = {i}") } else { String::new() };
        let items: Vec<String> =
            (0..*items).map(|i| format!("{{ id = \"{id}-{i}\", scene = \"a.toml\"{} }}", level(i))).collect();
        let (target, _) = conditions.split_once(' ').unwrap();
        let conditions = conditions.replace(' ', "\", \"");
        let keys = [
            ("conditions", &*format!("[\"{conditions}\"]")),
            ("target", &format!("\"{target}\"")),
            ("items", &format!("[{}]", items.join(", "))),
        ];
        format!("{}{rest}\n", fixtures::block(id, &keys))
    };
    let mut names: Vec<&str> = blocks.iter().flat_map(|b| b.1.split(' ')).collect();
    names.sort_unstable();
    names.dedup();
    let conditions: Vec<String> = names.iter().map(|n| format!("{n} = {{ technique = \"pa\" }}")).collect();
    let conditions = format!("{{ {} }}", conditions.join(", "));
    let keys = [("seed", "5"), ("conditions", &conditions), ("screening", &format!("{{ {screening} }}"))];
    let text = fixtures::study(&keys, blocks.iter().map(block).collect::<Vec<_>>());
    StudyDefinition::parse("s.toml", &text).unwrap()
}

fn design(study: StudyDefinition, text: &str) -> Design {
    DesignFile::parse("d.toml", &format!("study = \"s.toml\"\n{text}")).unwrap().design(study).unwrap()
}

fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn run(study: StudyDefinition, text: &str) -> Power {
    power(&design(study, text), threads(), &|_, _| {})
}

fn test<'a>(size: &'a Size, of: &str, name: &str) -> &'a TestRate {
    size.tests.iter().find(|t| t.of == of && t.test.starts_with(name)).unwrap()
}

fn interval<'a>(size: &'a Size, of: &str, name: &str) -> &'a IntervalRate {
    size.intervals.iter().find(|i| i.of == of && i.interval.starts_with(name)).unwrap()
}

/// Whether a rate of so many runs could come from `p`: within four standard errors.
fn plausible(rate: &Rate, p: f64) -> bool {
    (rate.rate - p).abs() <= 4.0 * (p * (1.0 - p) / rate.runs as f64).sqrt()
}

#[test]
fn without_a_preference_tests_keep_alpha_and_intervals_cover_but_per_trial_ones_do_not() {
    let study = study("", &[("clear", "pa mc", 6, "")]);
    let power = run(
        study,
        "participants = [32]\nsimulations = 400\nseed = 2\n[[truth]]\npreference = 0.5\nicc = 0.3\n",
    );
    let size = &power.sizes[0];
    for name in ["t-test of", "t-test, Holm", "sign", "Wilcoxon", "cluster-robust", "random-intercept"] {
        let found = test(size, "clear", name);
        assert!(found.null);
        // Exact tests of few different numbers may stay below their level, none may exceed it.
        assert!(found.rate.rate < 0.05 || plausible(&found.rate, 0.05), "{found:?}");
    }
    assert!(plausible(&test(size, "clear", "t-test of").rate, 0.05));
    let covered = interval(size, "clear", "share of target choices, over");
    assert_eq!(covered.truth, Some(0.5));
    assert!(plausible(&covered.coverage, 0.95), "{covered:?}");
    // The negative control, and the platform's plain warning: counting choices instead of people.
    let per_trial = test(size, "clear", PER_TRIAL);
    assert!(per_trial.rate.low > 0.1, "{per_trial:?}");
    let wilson = interval(size, "clear", "share of target choices, ignoring");
    assert!(wilson.coverage.high < 0.9 && wilson.width < covered.width, "{wilson:?}");
    assert!(power.needed.is_empty(), "the study file states no bound of equivalence: {:?}", power.needed);
}

#[test]
fn a_scale_covers_the_true_differences_and_finds_those_that_are_there() {
    let blocks = [("ab", "a b", 4, ""), ("bc", "b c", 4, ""), ("ca", "c a", 4, "")];
    let power = run(
        study("", &blocks),
        "participants = [24]\nsimulations = 60\nseed = 3\n[[truth]]\njod = { a = 0.0, b = 0.0, c = 1.0 }\nobserver_sd = 0.3\n",
    );
    let size = &power.sizes[0];
    let mut coverage = (0, 0);
    for of in ["a − b", "a − c", "b − c"] {
        let found = interval(size, of, "difference");
        coverage = (coverage.0 + found.coverage.hits, coverage.1 + found.coverage.runs);
        // Observers' own deviations shrink the pooled difference a little.
        let stated = if of == "a − b" { 0.0 } else { -1.0 };
        let truth = found.truth.unwrap();
        assert!((truth - stated).abs() < 0.05 && (stated == 0.0 || truth > stated), "{truth}");
    }
    let coverage = Rate::new(coverage.0, coverage.1, 0);
    assert!(coverage.rate > 0.9 && coverage.rate < 0.98, "{coverage:?}");
    let nothing = test(size, "a − b", "difference");
    assert!(nothing.null && (nothing.rate.rate < 0.05 || plausible(&nothing.rate, 0.07)), "{nothing:?}");
    let found = test(size, "a − c", "difference");
    assert!(!found.null && found.rate.rate > 0.9, "{found:?}");
    let needed = power.needed.iter().find(|n| n.of == "b − c").unwrap();
    assert_eq!((needed.participants, needed.rate), (Some(24), test(size, "b − c", "difference").rate));
}

#[test]
fn the_share_of_the_excluded_is_the_careless_ones_and_those_who_leave() {
    let blocks = [("real", "pa mc", 4, ""), ("easy", "pa mc", 6, "catch = true")];
    let rules = "max_failed_catch_trials = 0, incomplete = true";
    let text = "participants = { from = 10, to = 30, step = 20 }\nsimulations = 30\nseed = 4\n\
                [observers]\ncareless = 0.2\ndropout = 0.1\n[[truth]]\npreference = 0.9\n";
    let found = run(study(rules, &blocks), text);
    // A careless one passes six catch trials with probability 1/64.
    let expected = 1.0 - 0.9 * (0.8 + 0.2 / 64.0);
    for size in &found.sizes {
        let people = f64::from(size.participants) * 30.0;
        // Who leaves before the first trial has no answers, and so is not among the excluded.
        let none = 0.1 / 10.0;
        let error = 4.0 * (expected * (1.0 - expected) / people).sqrt();
        assert!((size.excluded - (expected - none)).abs() < error, "{} {expected}", size.excluded);
    }
    assert_eq!(found.sizes.iter().map(|s| s.participants).collect::<Vec<_>>(), [10, 30]);
    // Without rules nobody is excluded, and the careless ones dilute what is found.
    let lax = run(study("", &blocks), text);
    assert_eq!(lax.sizes[1].excluded, 0.0);
    let covers =
        |power: &Power| interval(&power.sizes[1], "real", "share of target choices, over").coverage.rate;
    assert!(covers(&found) > covers(&lax) + 0.2, "{} {}", covers(&found), covers(&lax));
    // More participants find more, and the smaller study is part of the larger: the search is steady.
    let rate = |i: usize| test(&found.sizes[i], "real", "t-test of").rate.rate;
    assert!(rate(1) >= rate(0));
    assert_eq!(found, run(study(rules, &blocks), text), "the seed repeats it on any number of threads");
}

#[test]
fn threads_change_neither_the_answer_nor_what_is_told_on_the_way() {
    let text = "participants = [8, 20]\nsimulations = 24\nseed = 4\n[[truth]]\npreference = 0.7\nicc = 0.2\n";
    let design = design(study("", &[("real", "pa mc", 3, "")]), text);
    let watched = |threads| {
        let told = Mutex::new(Vec::new());
        let answer = power(&design, threads, &|done, so_far| told.lock().unwrap().push((done, so_far())));
        (answer, told.into_inner().unwrap())
    };
    let (answer, told) = watched(1);
    assert_eq!(told.iter().map(|(done, _)| *done).collect::<Vec<_>>(), (1..=24).collect::<Vec<u64>>());
    assert!(told.iter().all(|(done, so_far)| so_far.simulations == *done));
    assert_eq!(told[23].1, answer, "the last word is the answer");
    assert_ne!(told[5].1.sizes, answer.sizes, "and earlier ones are rougher");
    for threads in [2, 5] {
        assert_eq!((&answer, &told), (&watched(threads).0, &watched(threads).1), "{threads} threads");
    }
}

#[test]
fn a_test_that_nobody_can_make_is_left_out() {
    let blocks = [("one", "pa mc", 1, ""), ("two", "pa mc", 2, "")];
    let power = run(
        study("", &blocks),
        "participants = [12]\nsimulations = 20\nseed = 8\n[[truth]]\npreference = 0.7\n",
    );
    // One choice a participant says nothing about how participants differ; two do.
    let mixed: Vec<&str> = power.sizes[0]
        .tests
        .iter()
        .filter(|t| t.test.starts_with("random-intercept"))
        .map(|t| t.of.as_str())
        .collect();
    assert_eq!(mixed, ["two"]);
    assert_eq!(power.needed.iter().filter(|n| n.test.starts_with("random-intercept")).count(), 1);
    assert!(power.needed.iter().any(|n| n.of == "one" && n.test.starts_with("t-test of")));
}

fn endpoint(test: PrimaryTest, block: Option<&str>) -> PrimaryEndpoint {
    PrimaryEndpoint { test, block: block.map(str::to_owned), item: None, compare: None, participants: None }
}

/// The row of the primary endpoint, which comes first.
fn first(power: &Power) -> &TestRate {
    let [found, rest @ ..] = &power.sizes[0].tests[..] else { panic!("no tests") };
    assert!(found.primary && rest.iter().all(|test| !test.primary));
    found
}

#[test]
fn a_primary_t_test_is_judged_by_itself_and_the_others_without_it() {
    let blocks = ["one", "two", "three", "four"].map(|id| (id, "pa mc", 6, ""));
    let text = "participants = [16]\nsimulations = 200\nseed = 9\n[[truth]]\nblocks = [\"one\"]\npreference = 0.62\nicc = 0.05\n\
                [[truth]]\npreference = 0.5\nicc = 0.05\n";
    let plain = run(study("", &blocks), text);
    let mut named = study("", &blocks);
    named.primary = Some(endpoint(PrimaryTest::TTest, Some("one")));
    let found = run(named, text);
    let (primary, before) = (first(&found), &plain.sizes[0]);
    assert_eq!(
        (&*primary.of, primary.test, primary.null),
        ("block one", "two-tailed one-sample t-test", false)
    );
    assert_eq!(primary.rate, test(before, "one", "t-test of").rate, "it is not corrected");
    // Control: corrected for four blocks it would be found less often.
    assert!(primary.rate.rate > test(before, "one", "t-test, Holm").rate.rate + 0.05, "{primary:?}");
    // Holm's family is that of the other three: which needs one comparison fewer.
    let holm =
        |size: &Size| size.tests.iter().filter(|t| t.test.contains("Holm")).cloned().collect::<Vec<_>>();
    assert_eq!(holm(&found.sizes[0]).iter().map(|t| &*t.of).collect::<Vec<_>>(), ["two", "three", "four"]);
    let hits =
        |size: &Size| holm(size).iter().filter(|t| t.of != "one").map(|t| t.rate.hits).collect::<Vec<_>>();
    assert!(hits(&found.sizes[0]).iter().zip(hits(before)).all(|(now, then)| *now >= then));
    assert!(found.needed[0].primary && found.needed.iter().skip(1).all(|needed| !needed.primary));
    assert!(plain.primary.is_none() && plain.sizes[0].tests.iter().all(|test| !test.primary));
}

#[test]
fn a_primary_endpoint_has_the_power_of_its_test() {
    // A choice each of one item, of which 75% are of the target: power is a sum over the counts that an exact test rejects.
    let n = 20;
    let text = format!("participants = [{n}]\nsimulations = 400\nseed = 10\n[[truth]]\npreference = 0.75\n");
    let mut named = study("", &[("real", "pa mc", 3, "")]);
    let item = Some("real-1".to_owned());
    named.primary = Some(PrimaryEndpoint { item, ..endpoint(PrimaryTest::Binomial, Some("real")) });
    let found = run(named.clone(), &text);
    let choose = |k: i32| (0..k).map(|j| f64::from(n - j) / f64::from(k - j)).product::<f64>();
    let chance = |k: i32, p: f64| choose(k) * p.powi(k) * (1.0 - p).powi(n - k);
    // Of a fair coin the counts as far from the middle as k.
    let p = |k: i32| {
        (0..=n).filter(|j| (2 * j - n).abs() >= (2 * k - n).abs()).map(|j| chance(j, 0.5)).sum::<f64>()
    };
    let exact: f64 = (0..=n).filter(|k| p(*k) < 0.05).map(|k| chance(k, 0.75)).sum();
    let primary = first(&found);
    assert_eq!((&*primary.of, primary.test), ("item real-1 of block real", "exact binomial test"));
    assert!(plausible(&primary.rate, exact), "{primary:?} and {exact}");
    // Control: all three choices of everybody are another test.
    let all = test(&found.sizes[0], "real", PER_TRIAL);
    assert!(!plausible(&all.rate, exact), "{all:?}");

    // Whether there is anything to be found, by what is tested.
    let blocks = [("ab", "a b", 2, ""), ("bc", "b c", 2, ""), ("ca", "c a", 2, "")];
    let qualities =
        "participants = [12]\nsimulations = 20\nseed = 3\n[[truth]]\njod = { a = 0.0, b = 0.0, c = 1.0 }\n";
    for (compared, null) in [(["b", "a"], true), (["c", "a"], false)] {
        let mut named = study("", &blocks);
        let compare = Some(compared.map(str::to_owned));
        named.primary = Some(PrimaryEndpoint { compare, ..endpoint(PrimaryTest::Scale, None) });
        let found = run(named, qualities);
        let of = if null { "a − b" } else { "a − c" };
        assert_eq!(
            (first(&found).null, first(&found).rate),
            (null, test(&found.sizes[0], of, "difference").rate)
        );
    }
    for (test, null) in [(PrimaryTest::Sign, true), (PrimaryTest::Equivalence, false)] {
        named.equivalence = Some(EquivalenceBound { within: 0.2, reason: "r".to_owned() });
        named.primary = Some(endpoint(test, Some("real")));
        let even = run(
            named.clone(),
            "participants = [12]\nsimulations = 20\nseed = 3\n[[truth]]\npreference = 0.5\n",
        );
        assert_eq!(first(&even).null, null, "{test:?}");
    }
}

#[test]
fn thresholds_are_covered_at_a_given_truth() {
    let rest = "[blocks.psychometric]\nfunction = \"logistic\"\ndirection = \"falling\"\nlabel = \"triangles\"\nlapse = 0.02";
    let power = run(
        study("", &[("levels", "full few", 5, rest)]),
        "participants = [40]\nsimulations = 20\nseed = 6\n[[truth]]\nthreshold = 2.0\nwidth = 3.0\nlapse = 0.04\n",
    );
    let size = &power.sizes[0];
    for name in ["threshold, posterior", "threshold, participants"] {
        let found = interval(size, "levels", name);
        assert_eq!((found.truth, found.coverage.runs), (Some(2.0), 20));
        // Twenty at 95%: fewer than 16 has a probability below 3e-4.
        assert!(found.coverage.hits >= 16 && found.width.unwrap() < 2.0, "{found:?}");
    }
    assert!(test(size, "levels", "t-test of").rate.rate > 0.9);
}

#[test]
fn chances_are_those_of_many_simulated_observers() {
    use super::crowd::chances;
    let rest = "[blocks.psychometric]\nfunction = \"gaussian\"\ndirection = \"rising\"\nlabel = \"x\"";
    let study = study("", &[("lev", "a b", 3, rest), ("jod", "b c", 4, ""), ("pref", "c a", 5, "")]);
    let text = "participants = [20000]\nsimulations = 20\nseed = 8\n\
                [[truth]]\nblocks = [\"lev\"]\nthreshold = 1.2\nwidth = 2.0\nthreshold_sd = 0.8\nlapse = 0.1\n\
                [[truth]]\nblocks = [\"jod\"]\njod = { b = 1.0, c = 0.3 }\nobserver_sd = 0.7\n\
                [[truth]]\nblocks = [\"pref\"]\npreference = 0.7\nicc = 0.3\nlapse = 0.2\n";
    let design = design(study, text);
    let answers = Crowd::new(&design).take(0);
    for (b, (_, items)) in blocks(&design.study).enumerate() {
        let count = |p: &&Participant| p.answers_to(&items).iter().filter(|g| g.chose_target).count() as f64;
        let counts: Vec<f64> = answers.participants().iter().map(count).collect();
        let n = counts.len() as f64;
        let mean = counts.iter().sum::<f64>() / n;
        let variance = counts.iter().map(|c| (c - mean).powi(2)).sum::<f64>() / n;
        let chances = chances(&design, b).unwrap();
        let truth: f64 = chances.iter().sum();
        assert!((mean - truth).abs() < 4.0 * (variance / n).sqrt(), "block {b}: {mean} {truth}");
        // The negative control: independent choices would vary less.
        let independent: f64 = chances.iter().map(|p| p * (1.0 - p)).sum();
        assert!(variance / independent > 1.1, "block {b}");
    }
}

#[test]
fn every_problem_of_a_design_is_named() {
    let rest = "[blocks.psychometric]\nfunction = \"logistic\"\ndirection = \"rising\"\nlabel = \"x\"";
    let blocks = [
        ("one", "pa mc", 2, ""),
        ("two", "pa photo", 2, ""),
        ("lev", "pa mc", 3, rest),
        ("easy", "pa mc", 1, "catch = true"),
    ];
    let study = study("", &blocks);
    let good = "study = \"s.toml\"\nparticipants = [8, 16]\nsimulations = 20\nseed = 1\n[[truth]]\nblocks = [\"lev\"]\nthreshold = 1\n\
                width = 1.5\n[[truth]]\nblocks = [\"two\"]\njod = { pa = 0, photo = 1.5 }\n[[truth]]\npreference = 0.6\nsd = 0.2\n";
    let problems =
        |text: &str| match DesignFile::parse("d.toml", text).and_then(|file| file.design(study.clone())) {
            Ok(_) => Vec::new(),
            Err(errors) => {
                errors.iter().map(|p| Problem { place: None, ..p.clone() }.to_string()).collect::<Vec<_>>()
            }
        };
    assert_eq!(problems(good), Vec::<String>::new());
    let icc = match &DesignFile::parse("d.toml", good).unwrap().design(study.clone()).unwrap().truths[0] {
        Some(Supposed { truth: Truth::Preference { icc, .. }, .. }) => *icc,
        other => panic!("{other:?}"),
    };
    assert!((icc - 0.04 / 0.24).abs() < 1e-15);
    for (from, to, named) in [
        ("study = \"s.toml\"", "", "study: is missing"),
        ("[8, 16]", "[8, 8]", "participants = [8, 8]"),
        ("[8, 16]", "[1]", "participants"),
        ("[8, 16]", "{ from = 8, to = 4, step = 1 }", "participants"),
        ("[8, 16]", "{ from = 2, to = 4000, step = 1 }", "participants"),
        ("simulations = 20", "simulations = 0", "simulations = 0"),
        ("seed = 1", "seed = -1", "seed"),
        ("seed = 1", "seed = 1\nalpha = 1.0", "alpha"),
        ("seed = 1", "seed = 1\npower = nan", "power"),
        ("seed = 1", "seed = 1\nsamples = 3", "samples = 3: is not a known key"),
        ("seed = 1", "seed = 1\nobservers = { dropout = 2 }", "observers.dropout"),
        ("seed = 1", "seed = 1\nobservers = 3", "observers"),
        ("preference = 0.6", "preference = 1.6", "truth[2].preference"),
        ("preference = 0.6", "preference = 0.6\njod = { pa = 1 }", "truth[2].preference: give one of"),
        ("preference = 0.6", "", "truth[2].preference: give one of"),
        ("sd = 0.2", "sd = 0.5", "truth[2].sd"),
        ("sd = 0.2", "sd = 0.2\nicc = 0.1", "truth[2].sd: give icc or sd"),
        ("sd = 0.2", "blocks = [\"easy\"]", "truth[2].blocks"),
        ("sd = 0.2", "blocks = [\"two\"]", "truth[2].blocks[0] = \"two\": an earlier"),
        ("sd = 0.2", "blocks = [\"two\"]", "truth: no [[truth]] is of block one"),
        ("photo = 1.5", "photo = nan", "truth[1].jod.photo"),
        (", photo = 1.5", "", "truth: jod gives no quality for condition photo"),
        ("width = 1.5", "", "truth[0].width: is missing"),
        ("[\"lev\"]", "[\"one\"]", "truth: a threshold is of a block with levels"),
        ("[8, 16]", "[8, 16", "line 3"),
    ] {
        assert!(good.contains(from), "{from}");
        let found = problems(&good.replacen(from, to, 1));
        assert!(
            found.iter().any(|p| p.starts_with(&format!("d.toml: {named}"))),
            "{from} → {to}: {found:#?}"
        );
    }
}

/// A two-interval block over nine levels, led by a procedure.
fn led(procedure: &str) -> StudyDefinition {
    let rest = format!(
        "trial = \"two-interval\"\n[blocks.psychometric]\nfunction = \"logistic\"\ndirection = \"rising\"\nlabel = \"l\"\n\
         [blocks.adaptive]\n{procedure}"
    );
    study(
        "incomplete = true",
        &[("led", "pa mc", 9, &rest), ("fixed", "pa mc", 2, "trial = \"two-interval\"")],
    )
}

const DESIGN: &str = "participants = [12]\nsimulations = 20\nseed = 4\nobservers = { dropout = 0.25 }\n[[truth]]\nblocks = [\"led\"]\n\
    threshold = 4.3\nwidth = 4.0\nthreshold_sd = 0.0\n[[truth]]\npreference = 0.5\nicc = 0.1\n";

#[test]
fn adaptive_and_two_interval_blocks_are_taken_by_their_own_plans() {
    for (procedure, trials) in [
        ("procedure = \"staircase\"\ntrials = 60\nreversals = 60\ndown = 3\nsteps = [2, 1]", 60.0),
        ("procedure = \"quest-plus\"\ntrials = 40", 40.0),
    ] {
        let design = design(led(procedure), DESIGN);
        let crowd = Crowd::new(&design);
        let answers = crowd.take(7);
        let block = &blocks(&design.study).next().unwrap().1;
        let mut finished = 0;
        for participant in answers.participants() {
            let own = participant.answers_to(block);
            assert!(own.len() as f64 <= trials, "{}", own.len());
            let screened = screen(&design.study, participant, &[]);
            // Who saw the procedure to its end and the block after it is complete; the others are told so.
            let complete = own.len() as f64 == trials && participant.answers().len() == own.len() + 2;
            assert_eq!(screened.is_empty(), complete, "{screened:?}");
            finished += usize::from(complete);
        }
        assert!((4..12).contains(&finished), "some leave: {finished}");
        // Both alternatives stand first in one of every two trials.
        let first =
            answers.participants()[0].answers().iter().filter(|a| a.chose_first == a.chose_target).count();
        assert!((18..=32).contains(&first), "{first}");

        let power = power(&design, threads(), &|_, _| {});
        let size = &power.sizes[0];
        let covered = interval(size, "led", "threshold, posterior");
        assert_eq!(covered.truth, Some(4.3));
        assert!(covered.coverage.rate > 0.8 && covered.width.unwrap() < 2.0, "{procedure}: {covered:?}");
        // Its choices are steered: no test of their number, no interval of their share.
        assert!(size.tests.iter().all(|t| t.of != "led"), "{:?}", size.tests);
        assert!(size.intervals.iter().all(|i| i.of != "led" || i.interval.starts_with("threshold")));
        assert!(size.tests.iter().any(|t| t.of == "fixed"));
    }
}
