//! The one result that a study is made to decide, named before there are answers.

use crate::definition::Block;
use crate::fields::{SECTION, integer};
use kelir_reader::Fields;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The primary endpoint: which test of what decides, and after how many participants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct PrimaryEndpoint {
    /// The test that decides, at a level of 0.05 and uncorrected, as it is one.
    pub test: PrimaryTest,
    /// The block that is tested; absent for a difference on the scale.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub block: Option<String>,
    /// The item of the block that is tested alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub item: Option<String>,
    /// The two conditions whose difference on the scale is tested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compare: Option<[String; 2]>,
    /// Participants who are to be judged when the result is first looked at; absent: the file does not say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub participants: Option<u32>,
}

/// A test that can decide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PrimaryTest {
    /// The block's t-test of participants' counts.
    TTest,
    /// The exact sign test of the same.
    Sign,
    /// Wilcoxon's signed-rank test of the same.
    Wilcoxon,
    /// Equivalence of the block's share to a half, within the study's bound.
    Equivalence,
    /// The exact binomial test of one item, which each participant answers once.
    Binomial,
    /// A difference on the scale, by sign flips.
    Scale,
}

impl PrimaryTest {
    const ALL: [PrimaryTest; 6] = [
        PrimaryTest::TTest,
        PrimaryTest::Sign,
        PrimaryTest::Wilcoxon,
        PrimaryTest::Equivalence,
        PrimaryTest::Binomial,
        PrimaryTest::Scale,
    ];

    /// Its name in study files.
    pub fn as_str(self) -> &'static str {
        match self {
            PrimaryTest::TTest => "t-test",
            PrimaryTest::Sign => "sign",
            PrimaryTest::Wilcoxon => "wilcoxon",
            PrimaryTest::Equivalence => "equivalence",
            PrimaryTest::Binomial => "binomial",
            PrimaryTest::Scale => "scale",
        }
    }

    /// Its name in a sentence.
    pub fn in_words(self) -> &'static str {
        match self {
            PrimaryTest::TTest => "two-tailed one-sample t-test",
            PrimaryTest::Sign => "exact sign test",
            PrimaryTest::Wilcoxon => "Wilcoxon signed-rank test",
            PrimaryTest::Equivalence => "two one-sided tests of equivalence",
            PrimaryTest::Binomial => "exact binomial test",
            PrimaryTest::Scale => "sign-flip test on the scale",
        }
    }
}

impl PrimaryEndpoint {
    /// What is tested, in words: "block stills".
    pub fn subject(&self) -> String {
        match (&self.block, &self.item, &self.compare) {
            (Some(block), Some(item), _) => format!("item {item} of block {block}"),
            (Some(block), None, _) => format!("block {block}"),
            (None, _, Some([a, b])) => format!("{a} against {b}"),
            (None, _, None) => String::new(),
        }
    }
}

/// Reads `[primary]`; what its test does not need it does not take.
pub(crate) fn read(fields: &mut Fields<'_>, blocks: &[&Block], has_bound: bool) -> Option<PrimaryEndpoint> {
    let mut fields = fields.given("primary", SECTION)?.table()?;
    let names: Vec<String> = PrimaryTest::ALL.iter().map(|test| format!("\"{}\"", test.as_str())).collect();
    let rule = format!("one of {}; \"equivalence\" only beside a bound of [equivalence]", names.join(", "));
    let test = fields.must("test", &rule, |v| {
        let test = PrimaryTest::ALL.into_iter().find(|test| v.as_str() == Some(test.as_str()))?;
        (test != PrimaryTest::Equivalence || has_bound).then_some(test)
    });
    let rule = "how many participants are to be judged when the result is first looked at, from 2 to 1000000";
    let participants = fields.may("participants", rule, |v| integer(v, 2, 1_000_000));
    // A block whose counts nobody steers: what is tested of it is what participants chose.
    let tested = || blocks.iter().filter(|block| !block.catch && block.adaptive.is_none());
    let (mut block, mut item, mut compare) = (None, None, None);
    if test != Some(PrimaryTest::Scale) {
        let rule = "the id of a block that is neither catch nor adaptive";
        block = fields.must("block", rule, |v| tested().find(|block| v.as_str() == Some(&block.id)).copied());
    }
    if test == Some(PrimaryTest::Binomial) {
        let known = |id: &str| block.is_none_or(|block| block.items.iter().any(|item| item.id == id));
        item = fields.must("item", "the id of an item of that block", |v| {
            v.as_str().filter(|id| known(id)).map(str::to_owned)
        });
    }
    if test == Some(PrimaryTest::Scale) {
        let known = |id: &str| tested().any(|block| block.conditions.iter().any(|name| name == id));
        compare = fields.must("compare", "two different conditions of blocks that compare them", |v| {
            let [a, b] = &v.as_array()?[..] else { return None };
            let (a, b) = (a.as_str()?, b.as_str()?);
            (a != b && known(a) && known(b)).then(|| [a.to_owned(), b.to_owned()])
        });
    }
    fields.done();
    Some(PrimaryEndpoint {
        test: test?,
        block: block.map(|block| block.id.clone()),
        item,
        compare,
        participants: participants.and_then(|n| u32::try_from(n).ok()),
    })
}
