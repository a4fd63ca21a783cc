//! What a study is, once its file has been read and found right.

mod shown;

use crate::adaptive::Adaptive;
use crate::conduct::{ResponseRules, SessionRules};
use crate::display::DisplayRules;
use crate::languages::{self, Texts, Translation};
use crate::primary::{PrimaryEndpoint, PrimaryTest};
use crate::trials::{TrialKind, TrialName};
use crate::visits::{Flag, parameter};
use kelir_stats::psychometric::{Lapse, Sigmoid};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use utoipa::ToSchema;

/// A study as its file defines it; every value has been checked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct StudyDefinition {
    /// The file's name without `.toml`; stands in addresses and data.
    pub id: String,
    /// Title for participants and researchers.
    pub title: String,
    /// The question over every pair.
    pub question: String,
    /// Seed of every participant's trial plan, 0..=2^53.
    pub seed: u64,
    /// Stimulus size [width, height] in pixels; the smallest where there are several.
    pub size: [u32; 2],
    /// In which sizes stimuli are made and shown, as far as the file says so.
    // New optional keys are left out of the JSON at their default: adding one must not change older studies' hashes.
    #[serde(default, skip_serializing_if = "is_default")]
    pub display: DisplayRules,
    /// Linear luminance of the grey around the stimuli, 0..=1.
    pub surround: f64,
    /// How long taking part is said to take, in minutes.
    pub estimated_minutes: u32,
    /// A session without a sign of life for this long gives its slot to someone else, in minutes.
    pub idle_minutes: u32,
    /// The code at the end and where it leads.
    pub completion: Completion,
    /// What participants read.
    pub texts: Texts,
    /// How stimuli come to be, by condition name.
    pub conditions: BTreeMap<String, Condition>,
    /// Blocks in the order they are shown.
    pub blocks: Vec<Block>,
    /// Rules of exclusion, stated before there are results.
    #[serde(default, skip_serializing_if = "is_default")]
    pub screening: Screening,
    /// How far from one half a share may lie and still count as equivalent to it; absent: nothing is tested for equivalence.
    #[serde(default, skip_serializing_if = "is_default")]
    pub equivalence: Option<EquivalenceBound>,
    /// The one result that the study is made to decide; absent: none was named.
    #[serde(default, skip_serializing_if = "is_default")]
    pub primary: Option<PrimaryEndpoint>,
    /// Whose defaults the file has; files without one have the first's.
    #[serde(default = "first_edition", skip_serializing_if = "is_first_edition")]
    pub edition: u32,
    /// When an input counts as a response, as far as the file says so.
    #[serde(default, skip_serializing_if = "is_default")]
    pub response: ResponseRules,
    /// Whose visit is whose.
    #[serde(default, skip_serializing_if = "is_default")]
    pub session: SessionRules,
    /// The language of its texts, as a BCP 47 tag.
    #[serde(default = "languages::unnamed", skip_serializing_if = "languages::is_unnamed")]
    pub language: String,
    /// What participants read in other languages, by tag.
    #[serde(default, skip_serializing_if = "is_default")]
    pub translations: BTreeMap<String, Translation>,
}

/// The code at the end and where it leads.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[schema(as = CompletionSettings)]
pub struct Completion {
    /// One code for all (recruiting panels ask for it); absent: each session gets its own.
    pub code: Option<String>,
    /// Address to go on to; `[CODE]` and `[NAME]` of an address parameter are filled in.
    pub redirect: Option<String>,
}

/// Parameters of links by which recruiting panels (Prolific, MTurk, SONA) name people, studies and visits; any of them may stand in a redirect.
pub(crate) const PANEL_PARAMS: [&str; 10] = [
    "PROLIFIC_PID",
    "STUDY_ID",
    "SESSION_ID",
    "workerId",
    "assignmentId",
    "hitId",
    "turkSubmitTo",
    "survey_code",
    "subject_id",
    "id",
];

/// Those by which a panel credits who comes back, without a code of ours: SONA's survey code under its usual names, MTurk's assignment.
pub(crate) const CREDITING_PARAMS: [&str; 4] = ["survey_code", "id", "subject_id", "assignmentId"];

/// Where the pictures of a condition come from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(tag = "source", rename_all = "lowercase")]
pub enum Condition {
    /// Drawn from each pair's scene.
    Rendered {
        /// Technique name, such as `pa` or `mc`.
        technique: String,
        /// The technique's own settings, handed to the renderer as they are.
        knobs: BTreeMap<String, Value>,
        /// Settings of a simulated camera that photographs the drawn image.
        camera: Option<BTreeMap<String, Value>>,
    },
    /// Picture files, such as real photographs.
    Files {
        /// By item id.
        files: BTreeMap<String, Pictures>,
    },
}

/// Picture files of one item: paths relative to the study file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub enum Pictures {
    /// Of a study with one size.
    One(String),
    /// One for each of the study's sizes, in their order.
    OfSizes(Vec<String>),
}

impl Pictures {
    /// The paths, by rising size.
    pub fn paths(&self) -> &[String] {
        match self {
            Pictures::One(path) => std::slice::from_ref(path),
            Pictures::OfSizes(paths) => paths,
        }
    }
}

/// Pairs of the same two conditions, shown together and analysed together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Block {
    /// Identifier, unique in the study.
    pub id: String,
    /// Title for researchers.
    pub title: String,
    /// Stills or animations.
    pub kind: Kind,
    /// The two conditions compared.
    pub conditions: [String; 2],
    /// The condition whose choices are counted, one of `conditions`.
    pub target: String,
    /// The items, in file order: each is a scene shown under both conditions.
    #[serde(alias = "pairs")]
    pub items: Vec<Item>,
    /// What the file calls them, for messages: `items`, or `pairs` in files that are older.
    #[serde(skip)]
    pub items_key: ItemsKey,
    /// Whether the target is the right answer that attention alone is needed for; such a block screens and is not analysed.
    #[serde(default, skip_serializing_if = "is_default")]
    pub catch: bool,
    /// How each trial asks, with its settings.
    #[serde(flatten)]
    pub trial: TrialKind,
    /// Which item comes next, where the answers decide; absent: each comes once.
    #[serde(default, skip_serializing_if = "is_default")]
    pub adaptive: Option<Adaptive>,
    /// The curve that is fitted to the shares of target choices over the pairs' levels.
    #[serde(default, skip_serializing_if = "is_default")]
    pub psychometric: Option<Psychometric>,
}

/// A psychometric function of a block: how the share of target choices depends on the pairs' level. With two pictures to choose from,
/// the guess rate is ½.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Psychometric {
    /// Its shape.
    pub function: Sigmoid,
    /// Whether the share of target choices grows or falls with the level.
    pub direction: Direction,
    /// What the level is, such as `triangles`.
    pub label: String,
    /// Its unit, such as `log10` or `mm`; absent: none.
    pub unit: Option<String>,
    /// What is known of the lapse rate.
    pub lapse: Lapse,
    /// Shares of target choices, between ½ and 1, whose levels are wanted.
    pub thresholds: Vec<f64>,
    /// Whether the t-test of the block's counts is planned too, beside its thresholds.
    #[serde(default, skip_serializing_if = "is_default")]
    pub t_test: bool,
}

/// Which way a psychometric function runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// From guessing at low levels up.
    Rising,
    /// Down to guessing at high levels.
    Falling,
}

impl Direction {
    /// +1 or −1: levels times this rise with the share of target choices.
    pub fn sign(self) -> f64 {
        match self {
            Direction::Rising => 1.0,
            Direction::Falling => -1.0,
        }
    }
}

/// The guess rate of every block: two pictures, one of which is chosen.
pub const GUESS: f64 = 0.5;

/// What is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// One image.
    Still,
    /// A loop of images.
    Animation,
}

/// One scene shown under both conditions of its block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Item {
    /// Identifier, unique in the study.
    pub id: String,
    /// Scene file relative to the study file; absent only where both conditions are picture files.
    pub scene: Option<String>,
    /// Where the pair lies on the axis of the block's psychometric function.
    #[serde(default, skip_serializing_if = "is_default")]
    pub level: Option<f64>,
}

/// Whose answers are set aside, decided before there are any.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Screening {
    /// A trial answered faster than this counts as too fast, in ms; absent: none does.
    pub min_rt_ms: Option<f64>,
    /// More too-fast trials than this exclude the participant.
    pub max_fast_trials: u32,
    /// More wrong answers in catch blocks than this exclude the participant; absent: none does.
    pub max_failed_catch_trials: Option<u32>,
    /// Whether choosing the same side in every one of at least five trials excludes the participant.
    pub straight_lining: bool,
    /// Whether not finishing excludes the participant.
    pub incomplete: bool,
    /// What excludes the participant where it was noticed of the session.
    #[serde(default, skip_serializing_if = "is_default")]
    pub flags: Vec<Flag>,
}

/// How far from one half a block's share of target choices may lie and still count as equivalent to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct EquivalenceBound {
    /// Half the width of the range about ½, as a share of choices, above 0 and below ½.
    pub within: f64,
    /// Why a smaller difference does not matter.
    pub reason: String,
}

/// A key of the file that is no part of what it says: all are equal.
#[derive(Clone, Copy, Debug)]
pub struct ItemsKey(pub &'static str);

impl Default for ItemsKey {
    fn default() -> ItemsKey {
        ItemsKey("items")
    }
}

impl PartialEq for ItemsKey {
    fn eq(&self, _: &ItemsKey) -> bool {
        true
    }
}

impl std::fmt::Display for ItemsKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.0)
    }
}

fn first_edition() -> u32 {
    1
}

fn is_first_edition(edition: &u32) -> bool {
    *edition == 1
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl StudyDefinition {
    /// The most trials that a participant can see; fewer where an adaptive block ends early.
    pub fn most_trials(&self) -> usize {
        self.blocks.iter().map(Block::most_trials).sum()
    }

    /// When an input counts as a response, with the edition's defaults.
    pub fn response_rules(&self) -> ResponseRules {
        self.response.of_edition(self.edition)
    }

    /// Whether a block's t-test is the primary endpoint, and so a family of its own.
    pub fn is_primary_t_test(&self, block: &Block) -> bool {
        let is_it = |named: &PrimaryEndpoint| {
            named.test == PrimaryTest::TTest && named.block.as_ref() == Some(&block.id)
        };
        self.primary.as_ref().is_some_and(is_it)
    }

    /// The kinds of its trials, in the order of first use.
    pub fn trial_names(&self) -> Vec<TrialName> {
        let mut names = Vec::new();
        for block in &self.blocks {
            let name = block.trial.rules().name();
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }

    /// The block with this id.
    pub fn block(&self, id: &str) -> Option<&Block> {
        self.blocks.iter().find(|block| block.id == id)
    }
}

impl Block {
    /// Expected number of target choices of someone who cannot tell: half the pairs.
    pub fn mu(&self) -> f64 {
        self.items.len() as f64 / 2.0
    }

    /// The most trials that a participant can see of it.
    pub fn most_trials(&self) -> usize {
        self.adaptive.as_ref().map_or(self.items.len(), Adaptive::most_trials)
    }

    /// Whether a t-test of its counts is planned: what catches inattention and what a procedure steers has none, and a block with a psychometric
    /// function only where the file says so.
    pub fn plans_t_test(&self) -> bool {
        !self.catch && self.adaptive.is_none() && self.psychometric.as_ref().is_none_or(|p| p.t_test)
    }

    /// The condition that is not the target.
    pub fn other(&self) -> &str {
        let [a, b] = &self.conditions;
        if *a == self.target { b } else { a }
    }
}

impl Completion {
    /// The names in brackets, in order.
    ///
    /// # Errors
    /// The rule that a bracket breaks.
    pub(crate) fn placeholders(address: &str) -> Result<Vec<&str>, String> {
        let mut names = Vec::new();
        let mut rest = address;
        while let Some(at) = rest.find(['[', ']']) {
            let (bracket, after) = rest[at..].split_at(1);
            let name = after
                .split_once(']')
                .map(|(name, _)| name)
                .filter(|name| bracket == "[" && !name.contains('['));
            let Some(name) = name else {
                return Err(format!("{bracket} stands alone; a placeholder is [NAME]"));
            };
            names.push(name);
            rest = &after[name.len() + 1..];
        }
        Ok(names)
    }

    /// The address to go on to, with `[CODE]` and each `[NAME]` of `params` filled in, percent-encoded; a name that is not
    /// among them becomes empty.
    pub fn redirect_to(&self, code: &str, params: &BTreeMap<String, String>) -> Option<String> {
        let mut rest = self.redirect.as_deref()?;
        let mut address = String::with_capacity(rest.len());
        while let Some((before, after)) = rest.split_once('[') {
            let Some((name, tail)) = after.split_once(']') else { break };
            address.push_str(before);
            let value =
                if name == "CODE" { Some(code) } else { parameter(params, name).map(|(_, v)| v.as_str()) };
            percent_encode(value.unwrap_or_default(), &mut address);
            rest = tail;
        }
        address.push_str(rest);
        Some(address)
    }
}

fn percent_encode(value: &str, out: &mut String) {
    for byte in value.bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~".contains(&byte) {
            out.push(byte as char);
        } else {
            out.push_str(&format!("%{byte:02X}"));
        }
    }
}
