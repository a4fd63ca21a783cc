//! Who is left out: the rules of the study file, applied the same way each time.

use crate::answers::{Given, Participant, blocks, trials_asked};
use crate::definition::StudyDefinition;
use crate::visits::Flag;
use serde::Serialize;
use std::fmt;
use utoipa::ToSchema;

/// Why a participant is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(tag = "reason", rename_all = "snake_case")]
pub enum Exclusion {
    /// Too many answers faster than `min_rt_ms`.
    TooFast {
        /// How many there were.
        trials: u32,
        /// How many there may be.
        allowed: u32,
    },
    /// Too many wrong answers in catch blocks.
    FailedCatchTrials {
        /// How many there were.
        trials: u32,
        /// How many there may be.
        allowed: u32,
    },
    /// The same side, or the same interval, in every trial.
    StraightLining {
        /// How many trials there were.
        trials: u32,
    },
    /// Something was noticed of the session that the rules leave out for.
    Flagged {
        /// What was noticed.
        flag: Flag,
    },
    /// The study was not finished.
    Incomplete {
        /// How many trials were answered.
        answered: u32,
        /// How many there are.
        trials: u32,
    },
}

impl fmt::Display for Exclusion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = |n: &u32, what: &str| format!("{n} {what}{}", if *n == 1 { "" } else { "s" });
        match self {
            Exclusion::TooFast { trials, allowed } => {
                write!(f, "{} too fast, {allowed} allowed", count(trials, "answer"))
            }
            Exclusion::FailedCatchTrials { trials, allowed } => {
                write!(f, "{} failed, {allowed} allowed", count(trials, "catch trial"))
            }
            Exclusion::StraightLining { trials } => {
                write!(f, "the same side in all {}", count(trials, "trial"))
            }
            Exclusion::Flagged { flag } => f.write_str(flag.meaning()),
            Exclusion::Incomplete { answered, trials } => {
                write!(f, "{answered} of {} answered", count(trials, "trial"))
            }
        }
    }
}

/// Fewest trials in which always choosing one place says anything: by chance it happens once in 2⁴ times then.
const STRAIGHT: usize = 5;

/// Every reason of the study's rules to leave this participant out, of whose session `flags` were noticed; none: they stay.
pub fn screen(study: &StudyDefinition, participant: &Participant, flags: &[Flag]) -> Vec<Exclusion> {
    let rules = &study.screening;
    let answers = participant.answers();
    let count = |is: &dyn Fn(&Given) -> bool| answers.iter().filter(|a| is(a)).count() as u32;
    let mut reasons = Vec::new();
    if let Some(least) = rules.min_rt_ms {
        let (trials, allowed) = (count(&|a| a.rt_ms < least), rules.max_fast_trials);
        if trials > allowed {
            reasons.push(Exclusion::TooFast { trials, allowed });
        }
    }
    if let Some(allowed) = rules.max_failed_catch_trials {
        let catch = blocks(study).filter(|(block, _)| block.catch);
        let failed = |(_, items)| participant.answers_to(&items).iter().filter(|a| !a.chose_target).count();
        let trials = catch.map(failed).sum::<usize>() as u32;
        if trials > allowed {
            reasons.push(Exclusion::FailedCatchTrials { trials, allowed });
        }
    }
    if rules.straight_lining && answers.len() >= STRAIGHT {
        let firsts = count(&|a| a.chose_first) as usize;
        if firsts == 0 || firsts == answers.len() {
            reasons.push(Exclusion::StraightLining { trials: answers.len() as u32 });
        }
    }
    let flagged = flags.iter().filter(|flag| rules.flags.contains(flag));
    reasons.extend(flagged.map(|flag| Exclusion::Flagged { flag: *flag }));
    if rules.incomplete {
        let (answered, trials) = (answers.len() as u32, trials_asked(study, participant) as u32);
        if answered < trials {
            reasons.push(Exclusion::Incomplete { answered, trials });
        }
    }
    reasons
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;
    use crate::answers::{Answers, Row};
    use kelir_fixtures as fixtures;

    fn study(screening: &str) -> StudyDefinition {
        let block = |id: &str, catch: &str| {
            let items = fixtures::items((0..3).map(|i| format!("{id}{i}")), "a.toml");
            fixtures::block(id, &[("items", &items), ("catch", catch)])
        };
        let blocks = [block("main", "false"), block("easy", "true")];
        let text = fixtures::study(&[("screening", &format!("{{ {screening} }}"))], blocks);
        StudyDefinition::parse("s.toml", &text).unwrap()
    }

    /// One participant's answers: side and time of each; the last three are of the catch block, with the condition chosen.
    fn seen(study: &StudyDefinition, sides: &[bool], rt_ms: [f64; 6], catch: [&str; 3]) -> Participant {
        let mut answers = Answers::new(study);
        for (i, &chose_left) in sides.iter().enumerate() {
            let item_id = &format!("{}{}", if i < 3 { "main" } else { "easy" }, i % 3);
            let chosen = if i < 3 { "mc" } else { catch[i - 3] };
            let other = if chosen == "mc" { "pa" } else { "mc" };
            let sides = if chose_left { [chosen, other] } else { [other, chosen] };
            answers.push(Row::choice("s", i as u32, item_id, sides, chose_left, rt_ms[i]));
        }
        answers.participants()[0].clone()
    }

    const MIXED: [bool; 6] = [true, false, true, true, false, true];

    #[test]
    fn each_rule_excludes_beyond_its_limit_and_not_at_it() {
        let fast = study("min_rt_ms = 200, max_fast_trials = 1");
        let once = seen(&fast, &MIXED, [100.0, 200.0, 900.0, 900.0, 900.0, 900.0], ["pa"; 3]);
        assert!(screen(&fast, &once, &[]).is_empty(), "200 ms is not faster than 200 ms, and one is allowed");
        let twice = seen(&fast, &MIXED, [100.0, 199.9, 900.0, 900.0, 900.0, 900.0], ["pa"; 3]);
        assert_eq!(screen(&fast, &twice, &[]), [Exclusion::TooFast { trials: 2, allowed: 1 }]);

        let catch = study("max_failed_catch_trials = 1");
        let slow = [900.0; 6];
        assert!(screen(&catch, &seen(&catch, &MIXED, slow, ["pa", "mc", "pa"]), &[]).is_empty());
        let failed = screen(&catch, &seen(&catch, &MIXED, slow, ["mc", "mc", "pa"]), &[]);
        assert_eq!(failed, [Exclusion::FailedCatchTrials { trials: 2, allowed: 1 }]);

        let straight = study("straight_lining = true");
        assert!(screen(&straight, &seen(&straight, &MIXED, slow, ["pa"; 3]), &[]).is_empty());
        for side in [true, false] {
            let same = |n: usize| seen(&straight, &[side; 6][..n], slow, ["pa"; 3]);
            assert_eq!(screen(&straight, &same(6), &[]), [Exclusion::StraightLining { trials: 6 }]);
            assert!(screen(&straight, &same(4), &[]).is_empty(), "four of a kind say nothing");
        }

        let incomplete = study("incomplete = true");
        assert!(screen(&incomplete, &seen(&incomplete, &MIXED, slow, ["pa"; 3]), &[]).is_empty());
        let five = &seen(&incomplete, &MIXED[..5], slow, ["pa"; 3]);
        assert_eq!(screen(&incomplete, five, &[]), [Exclusion::Incomplete { answered: 5, trials: 6 }]);
    }

    #[test]
    fn without_rules_nobody_is_left_out_and_with_all_every_reason_is_given() {
        let none = study("");
        assert!(screen(&none, &seen(&none, &[true; 6], [1.0; 6], ["mc"; 3]), &[]).is_empty());
        let all =
            study("min_rt_ms = 200, max_failed_catch_trials = 0, straight_lining = true, incomplete = true");
        assert_eq!(screen(&all, &seen(&all, &[true; 5], [1.0; 6], ["mc"; 3]), &[]).len(), 4);
    }
}
