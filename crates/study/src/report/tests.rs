#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::answers::{Answers, Row};
use kelir_fixtures as fixtures;

fn text() -> String {
    let items = |ids: &[&str]| fixtures::items(ids, "a.toml");
    let blocks = [
        fixtures::block("stills", &[("title", "\"Stills\""), ("items", &items(&["a", "b"]))]),
        fixtures::block(
            "photos",
            &[("title", "\"Photos\""), ("conditions", "[\"photo\", \"pa\"]"), ("items", &items(&["c"]))],
        ),
        fixtures::block("easy", &[("title", "\"Catch\""), ("catch", "true"), ("items", &items(&["d"]))]),
    ];
    let conditions =
        "{ pa = { technique = \"pa\" }, mc = { technique = \"mc\" }, photo = { technique = \"mc\" } }";
    fixtures::study(&[("question", "\"Which?\""), ("seed", "11"), ("conditions", conditions)], blocks)
}

fn study() -> StudyDefinition {
    StudyDefinition::parse("s.toml", &text()).unwrap()
}

const PAIRS: [(&str, &str); 4] = [("a", "mc"), ("b", "mc"), ("c", "photo"), ("d", "mc")];

/// What `people` participants choose of pair k, given by participant and k; the left picture is chosen of pair a alone.
fn answers(people: usize, chosen: impl Fn(usize, usize) -> &'static str) -> Answers {
    let mut answers = Answers::new(&study());
    for i in 0..people {
        for (k, (item_id, other)) in PAIRS.into_iter().enumerate() {
            let (chosen, chose_left) = (chosen(i, k), k == 0);
            let rest = if chosen == "pa" { other } else { "pa" };
            let sides = if chose_left { [chosen, rest] } else { [rest, chosen] };
            let (session_id, rt_ms) = (&format!("p{i:02}"), 100.0 * (i + 1) as f64);
            answers.push(Row::choice(session_id, k as u32, item_id, sides, chose_left, rt_ms));
        }
    }
    answers
}

/// Participant i chooses the target of pair a when bit 0 of i is set, of b bit 1, of c bit 2.
fn by_bits(i: usize, k: usize) -> &'static str {
    if i >> k & 1 == 1 { "pa" } else { PAIRS[k].1 }
}

#[test]
fn a_report_holds_every_part_and_leaves_catch_blocks_out() {
    let report = Report::of(&study(), &answers(16, by_bits).participants());
    assert_eq!(report.blocks.iter().map(|b| b.summary.id.as_str()).collect::<Vec<_>>(), ["stills", "photos"]);
    let stills = &report.blocks[0];
    // Sixteen participants over all combinations: 4, 8 and 4 choose the target 0, 1 and 2 times; the mean is the null's.
    assert_eq!(stills.summary.counts, [(0, 4), (1, 8), (2, 4)].into());
    assert_eq!((stills.summary.t, stills.summary.p), (Some(0.0), Some(1.0)));
    assert_eq!(stills.p_holm, Some(1.0));
    assert_eq!(stills.analysis.intraclass.as_ref().unwrap().icc, 0.0);
    assert!((stills.analysis.proportion.as_ref().unwrap().proportion - 0.5).abs() < 1e-15);
    assert_eq!(stills.by_item.iter().map(|p| p.target.as_ref().unwrap().chosen).collect::<Vec<_>>(), [8, 8]);
    assert_eq!(stills.first.as_ref().unwrap().chosen, 16);
    // Each participant has two equal times: quartiles of 100, 100, 200, 200, …, 1600 by R's quantile(type = 7).
    assert_eq!(stills.rt_ms, Some(Quartiles { n: 32, q1: 475.0, median: 850.0, q3: 1225.0 }));
    let scale = report.scale.unwrap();
    assert_eq!(scale.scale.conditions, ["mc", "pa", "photo"]);
    assert!(scale.scale.jod.iter().all(|x| x.abs() < 1e-9), "nobody was preferred");
    assert_eq!((report.methods.len(), report.references.len()), (10, 24), "{:?}", report.methods);
    // Each participant answered two of the three comparisons: no triad is whole.
    let consistency = report.consistency.unwrap();
    assert_eq!(consistency.triads, Triads { triads: 0, circular: 0, consistence: None });
    assert_eq!((consistency.observers, consistency.odd.len()), (16, 0));
    let percentiles = &report.blocks[0].rt_percentiles_ms;
    assert_eq!((percentiles.len(), percentiles[0], percentiles[49]), (99, 100.0, 850.0));
}

#[test]
fn an_empty_study_gives_a_report_that_says_so() {
    let report = Report::of(&study(), &[]);
    for block in &report.blocks {
        assert!(block.summary.note.is_some() && block.p_holm.is_none() && block.first.is_none());
        assert!(block.analysis.effect.is_none() && block.analysis.proportion.is_none());
        assert!(!block.analysis.notes.is_empty());
    }
    assert!(report.scale.is_none() && report.scale_note.is_some());
    // JSON has no NaN: what is not defined is null.
    assert!(serde_json::to_string(&report).unwrap().contains("\"t\":null"));
}

#[test]
fn holm_counts_every_planned_test_and_no_other() {
    // Seven of eight choose the target of pair c; of the other block everybody chooses one, so that its t is not defined, and yet it counts.
    let chosen = |i: usize, k: usize| match k {
        0 => "pa",
        1 => "mc",
        2 if i == 0 => "photo",
        _ => "pa",
    };
    let report = Report::of(&study(), &answers(8, chosen).participants());
    let [stills, photos] = &report.blocks[..] else { panic!() };
    assert!(stills.planned && photos.planned);
    assert_eq!((stills.summary.p, stills.p_holm), (None, None));
    // R 4.2.2: t.test(c(0, rep(1, 7)), mu = .5)$p.value = 0.0197..., p.adjust(c(p, 1), "holm")[1] = 2 p.
    let p = photos.summary.p.unwrap();
    assert_eq!(photos.p_holm, Some(2.0 * p));
    assert!(report.methods.join(" ").contains("for the 2 planned tests"), "{:?}", report.methods);
    // A block with a psychometric function plans no t-test, unless its file says so.
    let levels = |t_test: &str| {
        let items: Vec<String> =
            (1..=3).map(|i| format!("{{ id = \"c{i}\", scene = \"a.toml\", level = {i} }}")).collect();
        let block = format!(
            "items = [{}]\n[blocks.psychometric]\nfunction = \"logistic\"\ndirection = \"rising\"\nlabel = \"l\"\n{t_test}",
            items.join(", ")
        );
        let text = text().replace("items = [{ id = \"c\", scene = \"a.toml\" }]", &block);
        StudyDefinition::parse("s.toml", &text).unwrap()
    };
    let planned = |study: &StudyDefinition| {
        Report::of(study, &[]).blocks.iter().map(|block| block.planned).collect::<Vec<_>>()
    };
    assert_eq!(planned(&levels("")), [true, false]);
    assert_eq!(planned(&levels("t_test = true")), [true, true]);
    // What a file leaves out changes no hash; what it says does.
    assert!(!levels("").to_json().contains("t_test"));
    assert_eq!(levels("").design_hash(), levels("t_test = false").design_hash());
    assert_ne!(levels("").design_hash(), levels("t_test = true").design_hash());
}

#[test]
fn a_bound_of_equivalence_is_stated_with_its_reason() {
    let with = |bound: &str| text().replacen("question =", &format!("{bound}\nquestion ="), 1);
    let stated = with("equivalence = { within = 0.1, reason = \"A tenth is what we would act on.\" }");
    let study = StudyDefinition::parse("s.toml", &stated).unwrap();
    let report = Report::of(&study, &answers(16, by_bits).participants());
    let found = report.blocks[0].analysis.equivalence.unwrap();
    // Two items: a tenth of the share is a fifth of a choice.
    assert!((found.within - 0.1).abs() < 1e-15 && (found.tests.half_width - 0.2).abs() < 1e-15, "{found:?}");
    let methods = report.methods.join(" ");
    assert!(
        methods.contains("±0.1 on the share") && methods.contains("A tenth is what we would act on."),
        "{methods}"
    );
    let silent = Report::of(&self::study(), &answers(16, by_bits).participants());
    assert!(silent.blocks.iter().all(|b| b.analysis.equivalence.is_none()), "no bound is assumed");
    assert!(!self::study().to_json().contains("equivalence"), "what is left out changes no hash");
    for (bound, named) in [
        ("equivalence = { within = 0.5, reason = \"x\" }", "equivalence.within = 0.5"),
        ("equivalence = { within = 0, reason = \"x\" }", "equivalence.within = 0"),
        ("equivalence = { within = 0.1 }", "equivalence.reason: is missing"),
        ("equivalence = { reason = \"x\" }", "equivalence.within: is missing"),
        ("equivalence = { within = 0.1, reason = \"x\", sd = 1 }", "equivalence.sd"),
    ] {
        let problems = StudyDefinition::parse("s.toml", &with(bound)).unwrap_err().to_string();
        assert!(problems.contains(named), "{bound}: {problems}");
    }
}

#[test]
fn sides_are_participants_and_opposite_leanings_do_not_cancel() {
    // Thirteen always choose the left picture and seven the right: of twenty people, not of forty trials.
    let mut answers = Answers::new(&study());
    for i in 0..20 {
        for (k, (item_id, other)) in PAIRS.into_iter().enumerate() {
            let session_id = &format!("p{i:02}");
            answers.push(Row::choice(session_id, k as u32, item_id, ["pa", other], i < 13, 900.0));
        }
    }
    let report = Report::of(&study(), &answers.participants());
    let first = report.blocks[0].first.as_ref().unwrap();
    let interval = first.interval().unwrap();
    // statsmodels 0.14: proportion_confint(13, 20, method = "wilson").
    assert_eq!((first.chosen, first.trials, first.participants), (26, 40, 20));
    assert!((interval.low - 0.4329).abs() < 5e-5 && (interval.high - 0.8188).abs() < 5e-5, "{interval:?}");
    assert!((report.blocks[0].first_intraclass.as_ref().unwrap().icc - 1.0).abs() < 1e-12);
}

#[test]
fn a_scale_says_what_its_choices_are_of() {
    let report = Report::of(&study(), &answers(16, by_bits).participants());
    assert!(report.scale_pools.contains("2 blocks together: pairs of 3 stills;"), "{}", report.scale_pools);
    let films = text().replacen("kind = \"still\"", "kind = \"animation\"", 1);
    let pools = Report::of(&StudyDefinition::parse("s.toml", &films).unwrap(), &[]).scale_pools;
    assert!(pools.contains("1 still and 2 animations"), "{pools}");
}

#[test]
fn degenerate_answers_are_notes_and_no_panic() {
    for (people, choice) in [(1, "pa"), (2, "pa"), (16, "pa"), (16, "mc")] {
        let same = answers(people, |_, k| if k == 2 { "photo" } else { choice });
        let report = Report::of(&study(), &same.participants());
        assert!(
            report.blocks.iter().all(|b| b.summary.t.is_none() && !b.analysis.notes.is_empty()),
            "{people} {choice}"
        );
    }
}

#[test]
fn the_papers_counts_are_judged_as_the_issue_says() {
    let analysis = |counts: [u64; 3]| ChoiceAnalysis::of_counts(&(0..).zip(counts).collect(), 2, Some(0.25));
    let first = analysis([12, 14, 6]);
    let effect = first.effect.unwrap();
    let icc = |a: &ChoiceAnalysis| a.intraclass.as_ref().unwrap().icc;
    for (ours, printed, half_a_digit) in [
        // Half a choice of two is a quarter of the share.
        (first.equivalence.unwrap().tests.p, 0.0114, 5e-5),
        (first.bayes.unwrap().bf01, 2.1, 0.05),
        (effect.g, -0.248, 5e-4),
        (effect.g_interval.low, -0.590, 5e-4),
        (effect.g_interval.high, 0.098, 5e-4),
        // R 4.2.2: binom.test(26, 64), binom.test(6, 18), power.t.test(n = 32, power = .8, type = "one.sample", strict = TRUE). All who
        // differ from 1 do so by 1: Wilcoxon's exact p is the sign test's.
        (first.binomial.unwrap().p, 0.168642911439704, 1e-14),
        (first.sign.unwrap().p, 0.237884521484375, 1e-14),
        (first.wilcoxon.unwrap().p, 0.237884521484375, 1e-14),
        (first.detectable.unwrap().d, 0.5113, 5e-5),
        (icc(&first), 0.093, 5e-4),
        (icc(&analysis([3, 10, 19])), 0.167, 5e-4),
    ] {
        assert!((ours - printed).abs() < half_a_digit, "{ours} is not {printed}");
    }
    // Not significant, and equivalent within the bound: nothing is left open. Within a narrower one, or without any, something is.
    let open = |a: &ChoiceAnalysis| a.notes.iter().any(|n| n.contains("not shown to be absent"));
    assert!(!open(&first), "{:?}", first.notes);
    for within in [Some(0.1), None] {
        let other = ChoiceAnalysis::of_counts(&(0..).zip([12, 14, 6]).collect(), 2, within);
        assert!(open(&other) && other.equivalence.is_some() == within.is_some(), "{:?}", other.notes);
    }
    // Negative control: the second block's difference is significant, and nothing of the kind is said.
    assert!(!open(&analysis([3, 10, 19])));
}

#[test]
fn methods_say_how_each_kind_of_trial_shows_its_pictures() {
    let said = |text: &str| {
        let report = Report::of(&StudyDefinition::parse("s.toml", text).unwrap(), &[]);
        let layouts: Vec<String> = report.blocks.iter().map(|block| block.summary.layout.clone()).collect();
        (report.methods.join(" "), layouts)
    };
    let (at_once, layouts) = said(&text());
    assert!(at_once.contains("The two were shown beside each other, or below"), "{at_once}");
    assert!(!at_once.contains("fixation"), "{at_once}");
    let at_once_layout = "side by side, or one above the other in a narrow window";
    assert_eq!(layouts, [at_once_layout; 2]);
    // One of three blocks asks otherwise: each sentence says of which it speaks.
    let intervals =
        "id = \"photos\"\ntrial = \"two-interval\"\ntrial_settings = { first_ms = 250, mask_ms = 0 }";
    let (both, layouts) = said(&text().replace("id = \"photos\"", intervals));
    let sentence = "In the block \"Photos\" the two were shown one after the other (two-interval forced choice): a fixation cross for 500 ms, the \
                    first picture for 250 ms, a mask for 0 ms and the second picture for 500 ms";
    assert!(both.contains(sentence), "{both}");
    assert!(
        both.contains("In the blocks \"Stills\", \"Catch\" the two were shown beside each other"),
        "{both}"
    );
    assert_eq!(layouts, [at_once_layout, "one after the other"]);
}

#[test]
fn methods_say_which_procedure_led_a_block_and_cite_it() {
    let items: Vec<String> =
        (1..=3).map(|i| format!("{{ id = \"c{i}\", scene = \"a.toml\", level = {i} }}")).collect();
    let led = |procedure: &str| {
        let block = format!(
            "items = [{}]\n[blocks.psychometric]\nfunction = \"logistic\"\ndirection = \"rising\"\nlabel = \"l\"\n[blocks.adaptive]\n{procedure}",
            items.join(", ")
        );
        let text = text().replace("items = [{ id = \"c\", scene = \"a.toml\" }]", &block);
        let report = Report::of(&StudyDefinition::parse("s.toml", &text).unwrap(), &[]);
        (report.methods.join(" "), report.references.join(" "))
    };
    let (methods, references) = led("procedure = \"staircase\"\ndown = 2\nreversals = 7\ntrials = 31");
    let sentence = "In the block \"Photos\" an up-down staircase chose each trial's level from the answers before (2 choices of the target in a row \
                    made it harder";
    assert!(methods.contains(sentence) && methods.contains("7 reversals or 31 trials"), "{methods}");
    assert!(references.contains("Levitt") && !references.contains("QUEST+: A"), "{references}");
    let (methods, references) = led("procedure = \"staircase\"\nshare = 0.75\nreversals = 7\ntrials = 31");
    assert!(methods.contains("settle where the target is chosen by 0.75"), "{methods}");
    assert!(references.contains("Kaernbach"), "{references}");
    let (methods, references) = led("procedure = \"quest-plus\"\ntrials = 31\nprecise_enough = 0.25");
    assert!(
        methods.contains("QUEST+ chose each trial's level") && methods.contains("below 0.25"),
        "{methods}"
    );
    assert!(references.contains("Watson") && !references.contains("Levitt"), "{references}");
}

#[test]
fn a_primary_endpoint_is_read_by_its_test_and_is_part_of_the_design() {
    let with = |keys: &str| text().replacen("question =", &format!("primary = {{ {keys} }}\nquestion ="), 1);
    let read = |keys: &str| StudyDefinition::parse("s.toml", &with(keys));
    for keys in [
        "test = \"t-test\", block = \"stills\", participants = 32",
        "test = \"binomial\", block = \"photos\", item = \"c\"",
        "test = \"scale\", compare = [\"photo\", \"mc\"]",
    ] {
        let named = read(keys).unwrap();
        assert_ne!(named.design_hash(), study().design_hash(), "{keys}");
        // What is stored is read back.
        assert_eq!(serde_json::from_str::<StudyDefinition>(&named.to_json()).unwrap().primary, named.primary);
    }
    assert!(!study().to_json().contains("primary"), "what is left out changes no hash");
    for (keys, named) in [
        ("block = \"stills\"", "primary.test: is missing"),
        ("test = \"z\", block = \"stills\"", "primary.test = \"z\""),
        ("test = \"equivalence\", block = \"stills\"", "primary.test = \"equivalence\""),
        ("test = \"sign\"", "primary.block: is missing"),
        ("test = \"sign\", block = \"easy\"", "primary.block = \"easy\""),
        ("test = \"sign\", block = \"stills\", item = \"a\"", "primary.item"),
        ("test = \"binomial\", block = \"stills\", item = \"c\"", "primary.item = \"c\""),
        ("test = \"scale\", compare = [\"mc\", \"mc\"]", "primary.compare"),
        ("test = \"scale\", compare = [\"mc\", \"none\"]", "primary.compare"),
        ("test = \"sign\", block = \"stills\", participants = 1", "primary.participants = 1"),
    ] {
        let problems = read(keys).unwrap_err().to_string();
        assert!(problems.contains(named), "{keys}: {problems}");
    }
}
