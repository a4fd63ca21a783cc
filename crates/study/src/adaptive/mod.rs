//! Adaptive procedures: which stimulus to show next, and where the threshold is.
//!
//! Stimuli are numbers of which more is easier (negate one that isn't). A procedure is a rule and nothing else: it has no clock and no
//! randomness, so that the same answers always show the same stimuli and a session resumes by answering again ([`replay`]).
//! A [`Staircase`] tracks one proportion and needs no model; [`QuestPlus`] measures threshold, width and lapse rate together with fewer
//! trials, and its interval is a posterior's.

mod block;
mod quest;
mod staircase;
#[cfg(test)]
mod tests;

pub use block::{Adaptive, Running};
pub use quest::{QuestPlus, QuestPlusRule};
pub use staircase::{Bracket, Staircase, StaircaseRule, Track};

/// What all procedures do.
pub trait Procedure {
    /// The stimulus to show now; `None` when the procedure has ended.
    fn stimulus(&self) -> Option<f64>;

    /// Takes in whether the answer to [`Procedure::stimulus`] was correct. After the end it changes nothing.
    fn answer(&mut self, correct: bool);
}

/// Answers in their order, as after a reload: the procedure is then where it was.
pub fn replay(procedure: &mut impl Procedure, answers: impl IntoIterator<Item = bool>) {
    for correct in answers {
        procedure.answer(correct);
    }
}
