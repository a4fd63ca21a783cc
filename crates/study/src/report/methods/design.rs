//! What participants saw, in which order, and what decided it.

use super::Text;
use crate::adaptive::{Adaptive, Track};
use crate::definition::{Kind, StudyDefinition};
use crate::display::Fit;
use crate::report::words::count;
use std::collections::BTreeMap;

const LEVITT: &str = "Levitt, H. (1971). Transformed up-down methods in psychoacoustics. Journal of the Acoustical Society of America, 49(2B), 467–477.";
const KAERNBACH: &str = "Kaernbach, C. (1991). Simple adaptive testing with the weighted up-down method. Perception & Psychophysics, 49(3), 227–229.";
const WATSON: &str = "Watson, A. B. (2017). QUEST+: A general multidimensional Bayesian adaptive psychometric method. Journal of Vision, 17(3), 10.";

/// The design, and which procedures decided it.
pub(super) fn say(text: &mut Text, study: &StudyDefinition) {
    text.say(design(study), &[]);
    procedures(text, study);
}

fn design(study: &StudyDefinition) -> String {
    let of_kind = |kind| study.blocks.iter().filter(|b| b.kind == kind).map(|b| b.items.len()).sum::<usize>();
    let kinds: Vec<String> = [(Kind::Still, "still"), (Kind::Animation, "animation")]
        .into_iter()
        .map(|(kind, name)| (of_kind(kind), name))
        .filter(|(pairs, _)| *pairs > 0)
        .map(|(pairs, name)| count(pairs, name))
        .collect();
    let catch = study.blocks.iter().filter(|b| b.catch).map(|b| b.items.len()).sum::<usize>();
    let catch = if catch == 0 {
        String::new()
    } else {
        format!(" Of these, {} served to catch inattention and entered no analysis.", count(catch, "pair"))
    };
    format!(
        "Participants saw {} of pictures made at {} ({}) in {} on a uniform grey of linear luminance {}, and were asked: \
         \"{}\" They had to choose one of the two pictures of each trial. {}{catch} Blocks came in a fixed order and items within a block in a \
         random one. Which of the two came first (on the left, above or earlier) was balanced within participants and, over participants, item by item (mirrored plans from the seed {}, given to \
         the lowest place in the design that no completed or active session held).",
        pairs(study),
        sizes(study),
        kinds.join(", "),
        count(study.blocks.len(), "block"),
        study.surround,
        study.question,
        presentation(study),
        study.seed,
    )
}

/// In which sizes they were made, and what became of these in a window.
fn sizes(study: &StudyDefinition) -> String {
    let which = match (study.sizes(), study.fit()) {
        (_, Fit::Fill) => "resampled to fill a participant's window",
        ([_], Fit::Integer) => {
            "enlarged by whole multiples where a participant's window had room and scaled down where it had too little"
        }
        ([_], Fit::Native) => "scaled down where a participant's window had too little room",
        (_, Fit::Integer) => {
            "the largest that fitted a participant's window shown, or a whole multiple of it, and the smallest scaled down where none did"
        }
        (_, Fit::Native) => {
            "the largest that fitted a participant's window shown, and the smallest scaled down where none did"
        }
    };
    format!("{}, {which}", study.sizes_in_words())
}

/// How many pairs of pictures participants saw.
fn pairs(study: &StudyDefinition) -> String {
    let most = if study.blocks.iter().any(|block| block.adaptive.is_some()) { "at most " } else { "" };
    format!("{most}{}", count(study.most_trials(), "pair"))
}

/// How each kind of trial shows its pictures.
fn presentation(study: &StudyDefinition) -> String {
    let mut titles: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for block in &study.blocks {
        titles.entry(block.trial.presentation()).or_default().push(format!("\"{}\"", block.title));
    }
    let everywhere = titles.len() < 2;
    let of = |titles: Vec<String>| match titles.len() {
        _ if everywhere => "The".to_owned(),
        1 => format!("In the block {} the", titles[0]),
        _ => format!("In the blocks {} the", titles.join(", ")),
    };
    let sentences = titles.into_iter().map(|(how, titles)| format!("{} two were shown {how}.", of(titles)));
    Vec::from_iter(sentences).join(" ")
}

/// Which procedure chose the levels of adaptive blocks.
fn procedures(text: &mut Text, study: &StudyDefinition) {
    for block in &study.blocks {
        let Some(adaptive) = &block.adaptive else { continue };
        let title = &block.title;
        match adaptive {
            Adaptive::Staircase { track, reversals, trials, .. } => {
                let (rule, source) = match track {
                    Track::Transformed { down } => {
                        let down = count(*down as usize, "choice");
                        (
                            format!(
                                "{down} of the target in a row made it harder, one of the other condition easier"
                            ),
                            LEVITT,
                        )
                    }
                    Track::Weighted { target } => (
                        format!("steps were weighted to settle where the target is chosen by {target}"),
                        KAERNBACH,
                    ),
                };
                text.say(
                    format!(
                        "In the block \"{title}\" an up-down staircase chose each trial's level from the answers before ({rule}; it ended after \
                         {reversals} reversals or {trials} trials)."
                    ),
                    &[source],
                );
            }
            Adaptive::QuestPlus { trials, precise_enough } => {
                let precise = precise_enough.map_or(String::new(), |sd| {
                    format!(" or once the threshold's posterior standard deviation was below {sd}")
                });
                text.say(
                    format!(
                        "In the block \"{title}\" QUEST+ chose each trial's level, the one expected to tell most about threshold, width and lapse \
                         rate, from the answers before; it ended after {trials} trials{precise}."
                    ),
                    &[WATSON],
                );
            }
        }
    }
}
