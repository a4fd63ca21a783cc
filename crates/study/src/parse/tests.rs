#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::definition::Direction;
use crate::trials::TrialKind;
use crate::versions::VersionStimulus;
use kelir_stats::psychometric::{Lapse, Sigmoid};

const GOOD: &str = r#"
title = "Two blocks"
question = "Which image is more likely to be real?"
seed = 7
size = [592, 333]
estimated_minutes = 3
[completion]
redirect = "https://example.org/done?cc=[CODE]&who=[PROLIFIC_PID]"
[texts]
welcome = """
One line
of text.

Second paragraph.
"""
consent = "c"
instructions = "i"
debriefing = "d"
thanks = "t"
[conditions.pa]
technique = "pa"
[conditions.mc]
technique = "mc"
spp = 64
[conditions.photo]
files = { fig = "photos/fig.png" }
[[blocks]]
id = "stills"
title = "Stills"
kind = "still"
conditions = ["pa", "mc"]
target = "pa"
pairs = [{ id = "a", scene = "../scenes/a.toml" }, { id = "b", scene = "../scenes/b.toml" }]
[[blocks]]
id = "photos"
title = "Photographs"
kind = "still"
conditions = ["photo", "pa"]
target = "pa"
pairs = [{ id = "fig", scene = "../scenes/a.toml" }]
"#;

/// A problem as it is told, but for where: each case would count its lines otherwise.
fn without_place(problem: &Problem) -> String {
    Problem { place: None, ..problem.clone() }.to_string()
}

fn problems(source: &str) -> Vec<String> {
    match StudyDefinition::parse("studies/two.toml", source) {
        Ok(_) => Vec::new(),
        Err(errors) => errors.iter().map(without_place).collect(),
    }
}

#[test]
fn a_good_file_is_read() {
    let study = StudyDefinition::parse("studies/two.toml", GOOD).unwrap();
    assert_eq!(study.id, "two");
    assert_eq!(study.texts.welcome, ["One line of text.", "Second paragraph."]);
    assert_eq!(study.surround, 0.2);
    assert_eq!(study.most_trials(), 3);
    assert_eq!(study.block("photos").unwrap().other(), "photo");
    let params = [("PROLIFIC_PID".to_owned(), "a&b".to_owned())].into();
    let address = study.completion.redirect_to("X Y", &params).unwrap();
    assert_eq!(address, "https://example.org/done?cc=X%20Y&who=a%26b");
    // Whoever is named by a parameter in small letters is sent back by it, too.
    let small = [("prolific_pid".to_owned(), "a".to_owned())].into();
    let address = study.completion.redirect_to("X", &small).unwrap();
    assert_eq!(address, "https://example.org/done?cc=X&who=a");
}

#[test]
fn the_hash_follows_values_and_not_layout_and_the_definition_survives_its_json() {
    let study = StudyDefinition::parse("two.toml", GOOD).unwrap();
    let commented = StudyDefinition::parse("two.toml", &format!("# a comment\n{GOOD}\n")).unwrap();
    assert_eq!(study.design_hash(), commented.design_hash());
    let changed = StudyDefinition::parse("two.toml", &GOOD.replace("spp = 64", "spp = 65")).unwrap();
    assert_ne!(study.design_hash(), changed.design_hash());
    let back: StudyDefinition = serde_json::from_str(&study.to_json()).unwrap();
    assert_eq!(back, study);
    assert_eq!(back.design_hash(), study.design_hash());
}

#[test]
fn every_problem_is_reported_with_field_value_and_rule() {
    let bad = GOOD
        .replace("seed = 7", "seed = -7\nsurrond = 0.2")
        .replace("size = [592, 333]", "size = [9000, 333]")
        .replace("spp = 64", "spp = nan")
        .replace("id = \"b\"", "id = \"a\"")
        .replace("target = \"pa\"\npairs = [{ id = \"a\"", "target = \"photo\"\npairs = [{ id = \"a\"");
    let found = problems(&bad);
    for expected in [
        "studies/two.toml: seed = -7: must be an integer from 0 to 2^53",
        "studies/two.toml: size = [9000, 333]: must be [width, height] in pixels",
        "studies/two.toml: surrond = 0.2: is not a known key",
        "studies/two.toml: conditions.mc.spp = nan: must be a finite number",
        "studies/two.toml: blocks[0].pairs[1].id = \"a\": must be unique",
        "studies/two.toml: blocks[0].target = \"photo\": must be one of",
    ] {
        assert!(found.iter().any(|p| p.starts_with(expected)), "no {expected:?} in {found:#?}");
    }
}

#[test]
fn problems_say_where_and_show_values_as_they_are_written() {
    let bad = GOOD
        .replace("seed = 7", "seed = 0x1_0000_0000_0000_0000\nsurrond = 0.20")
        .replace("[592, 333]", "[ 9_000, 333 ] # wide")
        .replace("{ id = \"b\",", "{ id = 'a',")
        .replace("\"pa\", \"mc\"]", "\"pa\", \"mc2\"]");
    let told: Vec<String> =
        StudyDefinition::parse("two.toml", &bad).unwrap_err().iter().map(Problem::to_string).collect();
    for expected in [
        "two.toml:4:8: seed = 0x1_0000_0000_0000_0000: must be an integer from 0 to 2^53",
        "two.toml:6:8: size = [ 9_000, 333 ]: must be [width, height] in pixels, width 16 to 3840, height 16 to 2160; it may be missing where \
         display.sizes is there",
        "two.toml:34:59: blocks[0].pairs[1].id = 'a': must be unique in the study",
        "two.toml:32:21: blocks[0].conditions[1] = \"mc2\": must be defined under [conditions]",
    ] {
        assert!(told.iter().any(|p| p == expected), "no {expected:?} in {told:#?}");
    }
    let unknown = "two.toml:5:11: surrond = 0.20: is not a known key (did you mean surround?); known are";
    assert!(told.iter().any(|p| p.starts_with(unknown)), "{told:#?}");
}

#[test]
fn each_rule_refuses_its_breach() {
    // (what is replaced, by what, the field named)
    let cases = [
        ("title = \"Two blocks\"", "", "title"),
        ("title = \"Two blocks\"", "title = \"  \"", "title"),
        ("title = \"Two blocks\"", "title = \"a\\u0000b\"", "title"),
        ("title = \"Two blocks\"", "title = \"\\u001b[31mred\"", "title"),
        ("title = \"Two blocks\"", "title = \"\\u200b\\ufeff\"", "title"),
        ("consent = \"c\"", "consent = \"\\u0007c\"", "texts.consent"),
        ("seed = 7", "seed = 1.5", "seed"),
        ("seed = 7", "seed = 7\nsurround = nan", "surround"),
        ("seed = 7", "seed = 7\nsurround = inf", "surround"),
        ("seed = 7", "seed = 7\nidle_minutes = 0", "idle_minutes"),
        ("seed = 7", "seed = 7\nscreening = 3", "screening"),
        ("size = [592, 333]", "size = [592]", "size"),
        ("https://example.org", "javascript:alert(1)//", "completion.redirect"),
        ("consent = \"c\"", "", "texts.consent"),
        ("technique = \"mc\"", "", "conditions.mc.technique"),
        ("technique = \"mc\"", "technique = \"mc\"\ncamera = 1", "conditions.mc.camera"),
        ("fig = \"photos/fig.png\"", "", "conditions.photo.files.fig"),
        ("photos/fig.png", "/etc/passwd", "conditions.photo.files.fig"),
        ("[conditions.mc]", "[conditions.other]\ntechnique = \"pa\"\n[conditions.mc]", "conditions.other"),
        ("[\"pa\", \"mc\"]", "[\"pa\", \"pa\"]", "blocks[0].conditions"),
        ("[\"pa\", \"mc\"]", "[\"pa\", \"ghost\"]", "blocks[0].conditions[1]"),
        ("id = \"stills\"", "id = \"Stills!\"", "blocks[0].id"),
        ("kind = \"still\"", "kind = \"film\"", "blocks[0].kind"),
        ("../scenes/b.toml", "/scenes/b.toml", "blocks[0].pairs[1].scene"),
        ("{ id = \"b\", scene = \"../scenes/b.toml\" }", "{ id = \"b\" }", "blocks[0].pairs[1].scene"),
        ("{ id = \"b\", scene = \"../scenes/b.toml\" }", "7", "blocks[0].pairs[1]"),
        ("title = \"Two blocks\"", "title = ", "line 2, column 9"),
    ];
    assert_eq!(problems(GOOD), Vec::<String>::new());
    for (from, to, field) in cases {
        assert!(GOOD.contains(from), "{from}");
        let found = problems(&GOOD.replacen(from, to, 1));
        let named = format!("studies/two.toml: {field}");
        assert!(found.iter().any(|p| p.starts_with(&named)), "{from} → {to}: no {field} in {found:#?}");
    }
}

#[test]
fn hostile_text_is_refused_without_a_panic() {
    for source in
        ["", "\0", "a = [[[[[[", "blocks = 1", "texts = []", "conditions = []", "[[blocks]]", "size = {}"]
    {
        assert!(!problems(source).is_empty(), "{source:?}");
    }
    assert!(StudyDefinition::parse("Bad Name.toml", GOOD).is_err());
}

#[test]
fn a_studys_hash_never_changes_with_kelir() {
    // Data are found by this hash: a new optional key must leave it as it was.
    let study = StudyDefinition::parse("two.toml", GOOD).unwrap();
    // By Python's json (sorted keys, no blanks) and hashlib.
    assert_eq!(study.file_hash(), "fc72125a3f6359ee4a4b98bbdbedcb7fcd4340694a223d1ff8420003c3217c2a");
    assert_eq!(study.design_hash(), "41026dc93c57f620043a100ab109b4992c12d8deca333cb1905b379933613e43");
    let stimulus = |condition: &str, digits: &str| VersionStimulus {
        item: "a".to_owned(),
        condition: condition.to_owned(),
        size: [592, 333],
        pixels_sha256: digits.repeat(32),
    };
    let stimuli = [stimulus("pa", "11"), stimulus("mc", "00")];
    let version = "efa992c7fbc479f2fbdc443ad09c09386856b9e807343e357bdc01e8e510072c";
    assert_eq!(study.version(&stimuli), version);
    assert_eq!(
        study.version(&[stimuli[1].clone(), stimuli[0].clone()]),
        version,
        "their order does not count"
    );
    assert_ne!(study.version(&[stimulus("pa", "12"), stimulus("mc", "00")]), version);
}

#[test]
fn what_nobody_judges_by_changes_the_file_and_not_the_design() {
    let study = |text: &str| StudyDefinition::parse("two.toml", text).unwrap();
    let good = study(GOOD);
    for (from, to, judged_by) in [
        ("title = \"Two blocks\"", "title = \"Blocks, two\"", false),
        ("thanks = \"t\"", "thanks = \"t!\"", false),
        ("consent = \"c\"", "consent = \"C\"", false),
        ("debriefing = \"d\"", "debriefing = \"D\"", false),
        ("Second paragraph.", "A second one.", false),
        ("estimated_minutes = 3", "estimated_minutes = 4", false),
        ("done?cc=", "finished?cc=", false),
        ("title = \"Stills\"", "title = \"The stills\"", false),
        ("instructions = \"i\"", "instructions = \"I\"", true),
        ("question = \"Which", "question = \"Which, then,", true),
        ("spp = 64", "spp = 65", true),
        ("id = \"fig\"", "id = \"fog\"", true),
        ("seed = 7", "seed = 8", true),
        ("target = \"pa\"", "target = \"mc\"", true),
        ("[592, 333]", "[592, 334]", true),
    ] {
        assert!(GOOD.contains(from), "{from}");
        let text =
            GOOD.replacen(from, to, 1).replace("fig =", if to.contains("fog") { "fog =" } else { "fig =" });
        let changed = study(&text);
        assert_ne!(changed.file_hash(), good.file_hash(), "{from}");
        assert_eq!(changed.design_hash() != good.design_hash(), judged_by, "{from}");
    }
    assert_eq!(study(&format!("# a comment\n{GOOD}")).file_hash(), good.file_hash());
}

/// The good file with a level on each pair of its first block, and the function that needs them.
fn with_levels() -> String {
    GOOD.replace("{ id = \"a\",", "{ id = \"a\", level = 1,").replace(
        "{ id = \"b\", scene = \"../scenes/b.toml\" }]",
        "{ id = \"b\", scene = \"../scenes/b.toml\", level = 2.5 },\n\
         { id = \"c\", scene = \"../scenes/b.toml\", level = 4 }]\n[blocks.psychometric]\nfunction = \"weibull\"\n\
         direction = \"falling\"\nlabel = \"triangles\"\nunit = \"log10\"\nlapse = 0.02\nthresholds = [0.75, 0.9]",
    )
}

#[test]
fn levels_and_their_function_are_read_and_count_towards_the_hash() {
    let study = StudyDefinition::parse("two.toml", &with_levels()).unwrap();
    let block = &study.blocks[0];
    assert_eq!(block.items.iter().map(|p| p.level).collect::<Vec<_>>(), [Some(1.0), Some(2.5), Some(4.0)]);
    let function = block.psychometric.as_ref().unwrap();
    assert_eq!((function.function, function.direction), (Sigmoid::Weibull, Direction::Falling));
    assert_eq!((function.label.as_str(), function.unit.as_deref()), ("triangles", Some("log10")));
    assert_eq!(
        (function.lapse, function.thresholds.as_slice()),
        (Lapse::Fixed(0.02), [0.75, 0.9].as_slice())
    );
    let back: StudyDefinition = serde_json::from_str(&study.to_json()).unwrap();
    assert_eq!(back, study);
    let moved = StudyDefinition::parse("two.toml", &with_levels().replace("level = 4", "level = 5")).unwrap();
    assert_ne!(moved.design_hash(), study.design_hash());
}

#[test]
fn each_rule_of_levels_refuses_its_breach() {
    let cases = [
        ("level = 2.5", "level = nan", "blocks[0].pairs[1].level"),
        ("level = 2.5", "level = \"much\"", "blocks[0].pairs[1].level"),
        (", level = 2.5", "", "blocks[0].pairs[1].level: is missing"),
        ("level = 2.5", "level = 1.0", "blocks[0].pairs: must have at least three different levels"),
        ("function = \"weibull\"", "function = \"line\"", "blocks[0].psychometric.function"),
        ("function = \"weibull\"", "", "blocks[0].psychometric.function: is missing"),
        ("\"falling\"", "\"down\"", "blocks[0].psychometric.direction"),
        ("label = \"triangles\"", "", "blocks[0].psychometric.label: is missing"),
        ("unit = \"log10\"", "unit = 3", "blocks[0].psychometric.unit"),
        ("lapse = 0.02", "lapse = 0.5", "blocks[0].psychometric.lapse"),
        ("lapse = 0.02", "lapse = \"some\"", "blocks[0].psychometric.lapse"),
        ("[0.75, 0.9]", "[0.5]", "blocks[0].psychometric.thresholds"),
        ("[0.75, 0.9]", "[]", "blocks[0].psychometric.thresholds"),
        ("lapse = 0.02", "lapse = 0.02\nguess = 0.5", "blocks[0].psychometric.guess"),
        (
            "[blocks.psychometric]",
            "catch = true\n[blocks.psychometric]",
            "blocks[0].psychometric: a catch block",
        ),
        ("[blocks.psychometric]", "psychometric = 3\n[other]", "blocks[0].psychometric"),
        ("{ id = \"fig\",", "{ id = \"fig\", level = 1,", "blocks[1].pairs[0].level = 1: needs"),
    ];
    let good = with_levels();
    assert_eq!(problems(&good), Vec::<String>::new());
    for (from, to, field) in cases {
        assert!(good.contains(from), "{from}");
        let found = problems(&good.replacen(from, to, 1));
        let named = format!("studies/two.toml: {field}");
        assert!(found.iter().any(|p| p.starts_with(&named)), "{from} → {to}: no {field} in {found:#?}");
    }
}

/// The file with levels, whose first block is adaptive and shows one picture after the other.
fn adaptive(settings: &str) -> String {
    let trial = "trial = \"two-interval\"\ntrial_settings = { first_ms = 250, mask_ms = 0 }\nconditions = [\"pa\", \"mc\"]";
    let adaptive = format!("[blocks.adaptive]\n{settings}\n[blocks.psychometric]");
    with_levels().replace("conditions = [\"pa\", \"mc\"]", trial).replace("[blocks.psychometric]", &adaptive)
}

const STAIRCASE: &str =
    "procedure = \"staircase\"\ntrials = 40\nreversals = 8\ndown = 2\nstart = 1.0\nsteps = [2, 1]";
const QUEST: &str = "procedure = \"quest-plus\"\ntrials = 30\nprecise_enough = 0.25";

#[test]
fn a_block_may_be_adaptive_and_of_another_kind() {
    for settings in [STAIRCASE, QUEST] {
        let study = StudyDefinition::parse("two.toml", &adaptive(settings)).unwrap_or_else(|e| panic!("{e}"));
        let block = &study.blocks[0];
        let TrialKind::TwoInterval(intervals) = &block.trial else { panic!("{:?}", block.trial) };
        assert_eq!((intervals.fixation_ms, intervals.first_ms, intervals.mask_ms), (500.0, 250.0, 0.0));
        let most = if settings == STAIRCASE { 40 } else { 30 };
        assert_eq!((block.most_trials(), study.most_trials()), (most, most + 1));
        let back: StudyDefinition = serde_json::from_str(&study.to_json()).unwrap();
        assert_eq!(back, study);
    }
}

#[test]
fn each_rule_of_kinds_and_procedures_refuses_its_breach() {
    let cases = [
        (
            STAIRCASE,
            "\"two-interval\"",
            "\"three-interval\"",
            "blocks[0].trial = \"three-interval\": must be \"two-alternative\" or",
        ),
        (
            STAIRCASE,
            "first_ms = 250",
            "first_ms = 0",
            "blocks[0].trial_settings.first_ms = 0: must be milliseconds",
        ),
        (
            STAIRCASE,
            "first_ms = 250",
            "frist_ms = 250",
            "blocks[0].trial_settings.frist_ms = 250: is not a known key",
        ),
        (STAIRCASE, "trial = \"two-interval\"", "trial = \"two-alternative\"", "blocks[0].trial_settings"),
        (STAIRCASE, "\"staircase\"", "\"ladder\"", "blocks[0].adaptive.procedure = \"ladder\""),
        (STAIRCASE, "trials = 40", "trials = 0", "blocks[0].adaptive.trials = 0"),
        (STAIRCASE, "reversals = 8\n", "", "blocks[0].adaptive.reversals: is missing"),
        (STAIRCASE, "down = 2", "down = 1", "blocks[0].adaptive.down = 1"),
        (STAIRCASE, "down = 2", "down = 2\nshare = 0.75", "blocks[0].adaptive.share: leave out"),
        (STAIRCASE, "down = 2", "share = 0.5", "blocks[0].adaptive.share = 0.5"),
        (STAIRCASE, "start = 1.0", "start = 1.5", "blocks[0].adaptive: start"),
        (STAIRCASE, "steps = [2, 1]", "steps = [0]", "blocks[0].adaptive.steps"),
        (QUEST, "precise_enough = 0.25", "precise_enough = 0", "blocks[0].adaptive.precise_enough = 0"),
        (QUEST, "trials = 30", "", "blocks[0].adaptive.trials: is missing"),
        (
            QUEST,
            "trials = 30",
            "trials = 30\nreversals = 8",
            "blocks[0].adaptive.reversals = 8: is not a known key",
        ),
    ];
    for (settings, from, to, named) in cases {
        let good = adaptive(settings);
        assert_eq!(problems(&good), Vec::<String>::new());
        assert!(good.contains(from), "{from}");
        let found = problems(&good.replacen(from, to, 1));
        let named = format!("studies/two.toml: {named}");
        assert!(found.iter().any(|p| p.starts_with(&named)), "{from} → {to}: no {named} in {found:#?}");
    }
    let without = GOOD.replacen(
        "target = \"pa\"",
        &format!("target = \"pa\"\n[blocks.adaptive]\n{QUEST}\n[[blocks]]\n"),
        1,
    );
    assert!(
        problems(&without)
            .iter()
            .any(|p| p.contains("blocks[0].adaptive: needs the block's [blocks.psychometric]"))
    );
}
