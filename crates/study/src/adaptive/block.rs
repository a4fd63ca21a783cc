//! A block whose answers decide which of its levels comes next.

use super::{Procedure, QuestPlus, QuestPlusRule, Staircase, StaircaseRule, Track};
use crate::definition::{Block, GUESS, Psychometric};
use kelir_stats::psychometric::{BeliefGrid, Lapse};
use kelir_stats::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// `[blocks.adaptive]`: the procedure, in the levels of the block's items.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(tag = "procedure", rename_all = "kebab-case")]
pub enum Adaptive {
    /// Up and down the block's levels.
    Staircase {
        /// Which answers move it.
        track: Track,
        /// The level that comes first; absent: the easiest.
        start: Option<f64>,
        /// By how many levels it moves, each until the next reversal and the last from then on.
        steps: Vec<u32>,
        /// Ends after so many reversals …
        reversals: u32,
        /// … and in any case after so many trials.
        trials: u32,
    },
    /// The level that is expected to tell most.
    QuestPlus {
        /// Ends after so many trials …
        trials: u32,
        /// … or once the threshold's posterior standard deviation is below this, in levels.
        precise_enough: Option<f64>,
    },
}

/// Thresholds, widths and lapse rates that QUEST+ thinks possible.
const THRESHOLDS: usize = 61;
const WIDTHS: usize = 12;
const LAPSES: [f64; 4] = [0.0, 0.02, 0.05, 0.1];
/// How far thresholds are thought possible beyond the levels, as a part of their range.
const BEYOND: f64 = 0.25;

impl Adaptive {
    /// The most trials that the block can have.
    pub fn most_trials(&self) -> usize {
        match self {
            Adaptive::Staircase { trials, .. } | Adaptive::QuestPlus { trials, .. } => *trials as usize,
        }
    }

    /// The procedure before its first answer.
    ///
    /// # Errors
    /// The settings do not go with the block's levels; they name the key.
    pub fn start(&self, block: &Block) -> Result<Running> {
        let Some(asked) = &block.psychometric else {
            return Err(StatsError::TooFew { name: "levels", len: 0, needed: 3 });
        };
        let sign = asked.direction.sign();
        let levels = rising(block, asked);
        let procedure = match self {
            Adaptive::Staircase { .. } => Either::Staircase(Staircase::new(self.staircase(&levels, asked)?)?),
            Adaptive::QuestPlus { trials, precise_enough } => {
                let grid = grid(&levels, asked)?;
                let rule = QuestPlusRule { grid, trials: *trials, precise_enough: *precise_enough };
                Either::Quest(Box::new(QuestPlus::new(rule)?))
            }
        };
        Ok(Running { sign, levels, procedure, answered: 0 })
    }

    /// The level to show after these answers (whether the target was chosen, in the order of the trials); `None` when the procedure has ended.
    ///
    /// # Errors
    /// As [`Adaptive::start`].
    pub fn next_level(&self, block: &Block, answers: impl IntoIterator<Item = bool>) -> Result<Option<f64>> {
        let mut running = self.start(block)?;
        answers.into_iter().for_each(|chose_target| running.answer(chose_target));
        Ok(running.level())
    }

    /// Whether nothing comes after `trials` answers; `answers` gives them where they have to be looked at.
    pub(crate) fn has_ended(
        &self,
        block: &Block,
        trials: usize,
        answers: impl FnOnce() -> Vec<bool>,
    ) -> bool {
        let by_count_alone = matches!(self, Adaptive::QuestPlus { precise_enough: None, .. });
        trials >= self.most_trials()
            || (!by_count_alone && self.next_level(block, answers()).is_ok_and(|level| level.is_none()))
    }

    /// The staircase over the places of `levels`.
    fn staircase(&self, levels: &[f64], asked: &Psychometric) -> Result<StaircaseRule> {
        let Adaptive::Staircase { track, start, steps, reversals, trials } = self else {
            return Err(StatsError::TooFew { name: "steps", len: 0, needed: 1 });
        };
        let easiest = levels.len().saturating_sub(1);
        let place = match start {
            None => easiest,
            Some(level) => {
                let x = asked.direction.sign() * level;
                let rule = "must be the level of one of the block's items";
                let missing = StatsError::Invalid { name: "start", value: *level, rule };
                levels.iter().position(|known| *known == x).ok_or(missing)?
            }
        };
        Ok(StaircaseRule {
            track: *track,
            start: place as f64,
            steps: steps.iter().map(|step| f64::from(*step)).collect(),
            lowest: 0.0,
            highest: easiest as f64,
            reversals: *reversals,
            trials: *trials,
        })
    }
}

/// A block's procedure in the midst of its answers.
#[derive(Clone, Debug)]
pub struct Running {
    sign: f64,
    levels: Vec<f64>,
    procedure: Either,
    answered: usize,
}

#[derive(Clone, Debug)]
enum Either {
    Staircase(Staircase),
    Quest(Box<QuestPlus>),
}

impl Running {
    /// The level to show now; `None` when the procedure has ended.
    pub fn level(&self) -> Option<f64> {
        let x = match &self.procedure {
            // The places of levels are whole numbers; weighted steps between them show the nearest.
            Either::Staircase(staircase) => {
                staircase.stimulus().and_then(|place| self.levels.get(place.round() as usize).copied())
            }
            Either::Quest(quest) => quest.stimulus(),
        };
        x.map(|x| self.sign * x)
    }

    /// Takes in whether the target was chosen at [`Running::level`].
    pub fn answer(&mut self, chose_target: bool) {
        self.answered += 1;
        match &mut self.procedure {
            Either::Staircase(staircase) => staircase.answer(chose_target),
            Either::Quest(quest) => quest.answer(chose_target),
        }
    }

    /// Answers taken in.
    pub fn answered(&self) -> usize {
        self.answered
    }
}

/// The block's levels, each once, in the order in which the target is chosen more and more.
fn rising(block: &Block, asked: &Psychometric) -> Vec<f64> {
    let sign = asked.direction.sign();
    let mut levels: Vec<f64> =
        block.items.iter().filter_map(|item| item.level).map(|level| sign * level).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    levels
}

fn grid(levels: &[f64], asked: &Psychometric) -> Result<BeliefGrid> {
    let (Some(&low), Some(&high)) = (levels.first(), levels.last()) else {
        return Err(StatsError::TooFew { name: "levels", len: 0, needed: 3 });
    };
    let range = high - low;
    let least = levels.windows(2).map(|pair| pair[1] - pair[0]).fold(range, f64::min);
    let axis = |low: f64, high: f64, n: usize| -> Vec<f64> {
        (0..n).map(|i| low + (high - low) * i as f64 / (n - 1) as f64).collect()
    };
    let widths = axis(least.max(range / 20.0).ln(), (2.0 * range).ln(), WIDTHS);
    Ok(BeliefGrid {
        sigmoid: asked.function,
        guess: GUESS,
        stimuli: levels.to_vec(),
        thresholds: axis(low - BEYOND * range, high + BEYOND * range, THRESHOLDS),
        widths: widths.into_iter().map(f64::exp).collect(),
        lapses: match asked.lapse {
            Lapse::Fixed(rate) => vec![rate],
            Lapse::Prior => LAPSES.to_vec(),
        },
    })
}
