//! Whether the two orders of each item were judged equally often, counted from the answers and not from the plan.

use super::Judged;
use crate::answers::blocks;
use crate::definition::StudyDefinition;
use serde::Serialize;
use utoipa::ToSchema;

/// How even the design came out, among those who are judged.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, ToSchema)]
pub struct Balance {
    /// Items of blocks with a fixed plan that have answers.
    pub items: u64,
    /// Places in the design that more than one participant has completed: who came back late to a place that somebody else had got meanwhile is
    /// kept, and counted here.
    pub doubled_places: u64,
    /// Items whose target did not come first in half of their answers, give or take the odd one.
    pub uneven: Vec<UnevenItem>,
}

/// An item that one order was judged of more often than the other.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct UnevenItem {
    /// Block's id.
    pub block: String,
    /// Item's id.
    pub item: String,
    /// Answers in whose trial the target came first: on the left, above, or earlier.
    pub target_first: u64,
    /// All answers.
    pub answers: u64,
}

impl Balance {
    /// Of those who are judged.
    pub fn of(study: &StudyDefinition, judged: &Judged<'_>) -> Balance {
        let mut balance = Balance { doubled_places: judged.doubled_places, ..Balance::default() };
        for (block, places) in blocks(study).filter(|(block, _)| block.adaptive.is_none()) {
            for (item, place) in block.items.iter().zip(places) {
                let given = judged.judged.iter().flat_map(|one| one.answers_to(&(place..place + 1)));
                let (target_first, answers) = given.fold((0, 0), |(first, all), given| {
                    (first + u64::from(given.chose_target == given.chose_first), all + 1)
                });
                balance.items += u64::from(answers > 0);
                if target_first.abs_diff(answers - target_first) > 1 {
                    let (block, item) = (block.id.clone(), item.id.clone());
                    balance.uneven.push(UnevenItem { block, item, target_first, answers });
                }
            }
        }
        balance
    }
}
