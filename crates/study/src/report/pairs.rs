//! Whether the pairs of a block differ, and what is so of other pairs than these.

use super::choices::keep;
use super::words::count;
use crate::answers::Given;
use crate::definition::Block;
use kelir_stats::clustered::{CrossedLogit, ENOUGH_PAIRS, Heterogeneity, crossed_logit, heterogeneity};
use serde::Serialize;
use std::ops::Range;
use utoipa::ToSchema;

/// Random ways to deal participants' choices over pairs, where there are too many to count them all.
const DEALS: usize = 9999;

/// The pairs of a block beside each other.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct PairsReport {
    /// Whether they differ, whatever the choices of one participant have in common; null where nothing tells.
    pub test: Option<Heterogeneity>,
    /// Logistic regression with random intercepts of participants and of pairs; null where it cannot be fitted.
    pub model: Option<CrossedLogit>,
    /// Why something is missing, and what the model cannot say.
    pub notes: Vec<String>,
}

/// Of a block whose pairs ask the same: not of one whose pairs stand at levels, which are meant to differ, nor where a procedure chose among them.
pub(super) fn of(block: &Block, places: &Range<u32>, seen: &[&[Given]], seed: u64) -> Option<PairsReport> {
    if block.adaptive.is_some() || block.psychometric.is_some() || block.items.len() < 2 {
        return None;
    }
    let row = |answers: &&[Given]| {
        let mut row = vec![None; block.items.len()];
        answers.iter().for_each(|given| row[(given.item - places.start) as usize] = Some(given.chose_target));
        row
    };
    let choices: Vec<Vec<Option<bool>>> = seen.iter().filter(|own| !own.is_empty()).map(row).collect();
    if choices.len() < 2 {
        return None;
    }
    let mut notes = Vec::new();
    let test = keep("test of pairs", heterogeneity(&choices, DEALS, seed), &mut notes);
    let model = keep("logit with participants and pairs", crossed_logit(&choices), &mut notes);
    if let Some(model) = model.as_ref().filter(|model| model.pairs < ENOUGH_PAIRS) {
        notes.push(format!(
            "How much pairs differ can hardly be estimated from {}: the standard deviation of pairs, and the interval over other pairs than these, say \
             little.",
            count(model.pairs as usize, "pair")
        ));
    }
    Some(PairsReport { test, model, notes })
}
