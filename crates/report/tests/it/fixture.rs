//! Studies with known answers.

use kelir_fixtures as fixtures;
use kelir_report::{
    Chain, DeviceCount, Excluded, Participants, PooledVersion, Served, Standing, Stimulus, StudyReport,
};
use kelir_study::StudyDefinition;
use kelir_study::answers::{Answers, Participant, Row};
use kelir_study::columns::ParticipantColumns;
use kelir_study::report::Report;
use kelir_study::screening::screen;
use serde_json::json;

/// R 4.2.2: `t.test(rep(0:2, c(12, 14, 11)), mu = 1)$statistic`.
pub(crate) const T_OF_12_14_11: f64 = -0.20579830217101017;

/// A study and what each of its participants answered: (pair, condition chosen, response time in ms).
pub(crate) struct Study {
    pub title: String,
    pub question: String,
    pub block_title: String,
    pub screening: String,
    /// The bound of equivalence on the share; empty for none.
    pub within: String,
    /// The primary endpoint's keys; empty for none.
    pub primary: String,
    pub blocks: String,
    pub people: Vec<Vec<(&'static str, &'static str, f64)>>,
}

const BLOCKS: &str = r#"
[[blocks]]
id = "stills"
title = TITLE
kind = "still"
conditions = ["pa", "mc"]
target = "pa"
pairs = [{ id = "still-a", scene = "a.toml" }, { id = "still-b", scene = "a.toml" }]
[[blocks]]
id = "photographs"
title = "Photographs"
kind = "still"
conditions = ["photo", "pa"]
target = "pa"
pairs = [{ id = "photo-a", scene = "a.toml" }, { id = "photo-b", scene = "a.toml" }]
[[blocks]]
id = "animation"
title = "Animation"
kind = "animation"
conditions = ["pa", "mc"]
target = "pa"
pairs = [{ id = "loop-a", scene = "a.toml" }]
"#;

const LEVELS: [(&str, f64, usize); 6] =
    [("l0", 2.48, 96), ("l1", 2.7, 95), ("l2", 3.0, 84), ("l3", 3.2, 72), ("l4", 3.5, 58), ("l5", 3.8, 50)];

impl Default for Study {
    /// The paper's design, without answers.
    fn default() -> Study {
        Study {
            title: "Shadows".to_owned(),
            question: "Which is real?".to_owned(),
            block_title: "Stills".to_owned(),
            screening: String::new(),
            within: String::new(),
            primary: String::new(),
            blocks: BLOCKS.to_owned(),
            people: Vec::new(),
        }
    }
}

/// The paper's design; per block how many participants chose the target 0, 1 and 2 times. Who chose it once did so in the first pair.
pub(crate) fn paper(counts: [[usize; 3]; 3]) -> Study {
    let blocks: [&[(&str, &str)]; 3] = [
        &[("still-a", "mc"), ("still-b", "mc")],
        &[("photo-a", "photo"), ("photo-b", "photo")],
        &[("loop-a", "mc")],
    ];
    let mut people = Vec::new();
    for (pairs, counts) in blocks.iter().zip(counts) {
        let chosen = counts.iter().enumerate().flat_map(|(k, n)| std::iter::repeat_n(k, *n));
        for (person, times) in chosen.enumerate() {
            if people.len() <= person {
                people.push(Vec::new());
            }
            for (k, (pair, other)) in pairs.iter().enumerate() {
                people[person].push((
                    *pair,
                    if k < times { "pa" } else { *other },
                    500.0 + 10.0 * person as f64,
                ));
            }
        }
    }
    Study { people, ..Study::default() }
}

/// psignifit's golden numbers: 96, 95, 84, 72, 58, 50 of 100 at log10 triangles 2.48 … 3.8.
pub(crate) fn levels() -> Study {
    let items: Vec<String> = LEVELS
        .iter()
        .map(|(id, level, _)| format!("{{ id = \"{id}\", scene = \"a.toml\", level = {level} }}"))
        .collect();
    let blocks = format!(
        "[[blocks]]\nid = \"levels\"\ntitle = TITLE\nkind = \"still\"\nconditions = [\"pa\", \"mc\"]\ntarget = \"pa\"\npairs = [{}]\n\
         [blocks.psychometric]\nfunction = \"gaussian\"\ndirection = \"falling\"\nlabel = \"triangles\"\nunit = \"log10\"\n",
        items.join(", ")
    );
    let person = |i: usize| {
        LEVELS.iter().map(|(id, _, hits)| (*id, if i < *hits { "pa" } else { "mc" }, 800.0)).collect()
    };
    Study { blocks, people: (0..100).map(person).collect(), ..Study::default() }
}

/// Three conditions, each compared with each other one; `circular` participants choose in a circle, `straight` ones do not.
pub(crate) fn triangle(circular: usize, straight: usize) -> Study {
    let block = |id: &str, a: &str, b: &str| {
        format!(
            "[[blocks]]\nid = \"{id}\"\ntitle = TITLE\nkind = \"still\"\nconditions = [\"{a}\", \"{b}\"]\ntarget = \"{a}\"\n\
             pairs = [{{ id = \"{id}-pair\", scene = \"a.toml\" }}]\n"
        )
    };
    let blocks =
        [block("first", "pa", "mc"), block("second", "mc", "photo"), block("third", "photo", "pa")].concat();
    let person = |last: &'static str| {
        vec![("first-pair", "pa", 900.0), ("second-pair", "mc", 900.0), ("third-pair", last, 900.0)]
    };
    let people = (0..circular).map(|_| person("photo")).chain((0..straight).map(|_| person("pa")));
    Study { blocks, people: people.collect(), ..Study::default() }
}

/// A study whose every free text attacks whatever shows it.
pub(crate) fn hostile() -> Study {
    let evil = "=cmd|' /C calc'!A0 <script>alert('1')</script> | *a* [b](javascript:alert(1)) \"><img src=x onerror=alert(1)> \u{1b}[31m";
    let mut study = paper([[12, 14, 6], [3, 10, 19], [26, 7, 0]]);
    (study.title, study.question, study.block_title) = (evil.to_owned(), evil.to_owned(), evil.to_owned());
    study
}

impl Study {
    pub(crate) fn report(&self) -> StudyReport {
        // What the file itself may not hold comes from elsewhere: the report relies on no reader.
        let plain = |text: &str| text.replace(char::is_control, "");
        let quoted = |text: &str| serde_json::to_string(&plain(text)).unwrap();
        let photo =
            if self.blocks.contains("\"photo\"") { ", photo = { technique = \"mc\", spp = 4 }" } else { "" };
        let (title, question) = (quoted(&self.title), quoted(&self.question));
        let conditions = format!("{{ pa = {{ technique = \"pa\" }}, mc = {{ technique = \"mc\" }}{photo} }}");
        let screening = format!("{{ {} }}", self.screening);
        let within = format!("{{ within = {}, reason = \"Less would change nothing.\" }}", self.within);
        let mut keys = vec![
            ("title", &*title),
            ("question", &question),
            ("seed", "11"),
            ("conditions", &conditions),
            ("screening", &screening),
        ];
        let primary = format!("{{ {} }}", self.primary);
        if !self.primary.is_empty() {
            keys.push(("primary", &primary));
        }
        if !self.within.is_empty() {
            keys.push(("equivalence", &within));
        }
        let toml = fixtures::study(&keys, [self.blocks.replace("TITLE", &quoted(&self.block_title))]);
        let mut design =
            StudyDefinition::parse("studies/shadows.toml", &toml).unwrap_or_else(|e| panic!("{e}"));
        (design.title, design.question) = (self.title.clone(), self.question.clone());
        for block in design.blocks.iter_mut().filter(|block| block.title == plain(&self.block_title)) {
            block.title.clone_from(&self.block_title);
        }
        judge(design, &self.people)
    }
}

fn judge(design: StudyDefinition, people: &[Vec<(&str, &str, f64)>]) -> StudyReport {
    let mut answers = Answers::new(&design);
    for (i, own) in people.iter().enumerate() {
        for (k, (item_id, chosen, rt_ms)) in own.iter().enumerate() {
            let block = design.blocks.iter().find(|b| b.items.iter().any(|p| p.id == *item_id)).unwrap();
            let chose_left = k % 2 == 0;
            let rest = block.conditions.iter().find(|c| *c != chosen).unwrap();
            let sides = if chose_left { [*chosen, rest.as_str()] } else { [rest.as_str(), *chosen] };
            let session_id = &format!("person-{i:03}");
            answers.push(Row::choice(session_id, k as u32, item_id, sides, chose_left, *rt_ms));
        }
    }
    let everybody = answers.participants();
    let (mut judged, mut excluded) = (Vec::<&Participant>::new(), Vec::new());
    for &participant in &everybody {
        let reasons = screen(&design, participant, &[]);
        if reasons.is_empty() {
            judged.push(participant);
        } else {
            excluded.push(Excluded::new(participant.session_id.to_string(), reasons, true));
        }
    }
    let report = Report::of(&design, &judged);
    let devices = vec![ParticipantColumns { refresh_hz: Some(60.0), ..Default::default() }; judged.len()];
    let with_excluded = (!excluded.is_empty()).then(|| Report::of(&design, &everybody));
    let stimulus = |item: &str, condition: &str, rmse: f64| Stimulus {
        item: item.to_owned(),
        condition: condition.to_owned(),
        size: [64, 36],
        sha256: "5f".repeat(32),
        pixels_sha256: "a0".repeat(32),
        provenance: if rmse > 0.0 {
            json!({ "error": { "penumbra": { "rmse": rmse }, "floor": 0.003 } })
        } else {
            json!({})
        },
    };
    let people_count = people.len() as u64;
    let participants = Participants { started: people_count, in_progress: 0, completed: people_count };
    let times = ["2026-11-22T14:22:22.960Z", "2026-11-22T15:02:01.000Z"];
    let standing = Standing { judged: judged.len() as u64, ..Standing::default() };
    StudyReport {
        study: design.id.clone(),
        title: design.title.clone(),
        question: design.question.clone(),
        version: "c3".repeat(32),
        pooled: vec![PooledVersion { version: "c3".repeat(32), sessions: people.len() as u64, answers: 0 }],
        different_stimuli: Vec::new(),
        kelir_version: "0.1.0".to_owned(),
        answered: (!people.is_empty()).then(|| times.map(str::to_owned)),
        served: Some(Served { first: "2026-11-22T09:00:00.000Z".to_owned(), last: times[1].to_owned() }),
        participants,
        standing: standing.summarised(&participants, &excluded, &[]),
        screening: design.screening.clone(),
        report,
        blocks_with_excluded: with_excluded.as_ref().map(|r| r.blocks.clone()),
        scale_with_excluded: with_excluded.and_then(|r| r.scale),
        excluded,
        stimuli: vec![
            stimulus("still-a", "pa", 0.01),
            stimulus("still-a", "mc", 0.0),
            stimulus("still-b", "pa", 0.02),
            stimulus("photo-a", "pa", 0.004),
            stimulus("loop-a", "pa", 0.0),
        ],
        shown: Vec::new(),
        devices: DeviceCount::of(&devices),
        other_versions: Vec::new(),
        chain: Chain { rows: 0, head: "0".repeat(64), faults: Vec::new(), blanked: 0 },
        paper: None,
        design,
    }
}

/// Centres of an SVG's disks, in order.
pub(crate) fn svg_disks(svg: &str) -> Vec<(f64, f64)> {
    let attribute = |tag: &str, name: &str| -> f64 {
        tag.split(&format!(" {name}=\"")).nth(1).unwrap().split('"').next().unwrap().parse().unwrap()
    };
    svg.split("<circle")
        .skip(1)
        .map(|rest| {
            let tag = rest.split('>').next().unwrap();
            (attribute(tag, "cx"), attribute(tag, "cy"))
        })
        .collect()
}

/// The cells of a CSV, without its header's.
pub(crate) fn cells(csv: &str) -> Vec<String> {
    let rows = csv::Reader::from_reader(csv.as_bytes()).into_records().map(Result::unwrap);
    rows.flat_map(|row| row.iter().map(str::to_owned).collect::<Vec<_>>()).collect()
}
