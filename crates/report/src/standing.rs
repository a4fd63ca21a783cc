//! Who is judged and who is not, in numbers and in one sentence made from them.

use crate::format::count;
use crate::{Participants, PooledVersion};
use kelir_study::StudyDefinition;
use kelir_study::screening::Exclusion;
use kelir_study::visits::{Balance, Flag, Judged, LeftOut, Repeated, SessionKind, Visit};
use serde::Serialize;
use utoipa::ToSchema;

/// A participant who is left out.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Excluded {
    /// Session's id.
    pub session_id: String,
    /// Every reason there is.
    pub reasons: Vec<Exclusion>,
    /// The reasons in words.
    pub why: String,
    /// Whether the session was finished.
    pub is_completed: bool,
}

/// How many sessions something was noticed of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct Flagged {
    /// What was noticed.
    pub flag: Flag,
    /// What that means.
    pub meaning: String,
    /// Of how many sessions.
    pub sessions: u64,
    /// Whether the study's rules leave these out.
    pub excludes: bool,
}

/// Who is judged, and who is not.
#[derive(Clone, Debug, Default, Serialize, ToSchema)]
pub struct Standing {
    /// The numbers in a sentence.
    pub summary: String,
    /// Participants whose answers are judged.
    pub judged: u64,
    /// Participants in progress who are judged only once they finish.
    pub unfinished: u64,
    /// Sessions of persons whose first complete session counts.
    pub repeated: Vec<Repeated>,
    /// Trial runs of researchers, left out.
    pub pilots: u64,
    /// Sessions of simulations, left out.
    pub simulated: u64,
    /// Kinds of sessions that are judged like participants', because somebody asked for it.
    pub with: Vec<SessionKind>,
    /// What was noticed of sessions, whether or not it leaves them out.
    pub flagged: Vec<Flagged>,
    /// How even the design came out.
    pub balance: Balance,
    /// The same in words; empty without answers.
    pub balance_summary: String,
}

impl Standing {
    /// Of these sessions, judged.
    pub fn of(study: &StudyDefinition, judged: &Judged<'_>, with: &[SessionKind]) -> Standing {
        let kind = |wanted: SessionKind| {
            let of_kind =
                |(_, why): &&(&Visit, LeftOut)| matches!(why, LeftOut::Kind(kind) if *kind == wanted);
            judged.left_out.iter().filter(of_kind).count() as u64
        };
        let flagged = Flag::ALL.iter().map(|flag| Flagged {
            flag: *flag,
            meaning: flag.meaning().to_owned(),
            sessions: judged.flags.values().filter(|flags| flags.contains(flag)).count() as u64,
            excludes: study.screening.flags.contains(flag),
        });
        let repeated = judged.left_out.iter().filter_map(|(_, why)| match why {
            LeftOut::Repeated(repeated) => Some(repeated.clone()),
            _ => None,
        });
        let balance = Balance::of(study, judged);
        Standing {
            summary: String::new(),
            judged: judged.judged.len() as u64,
            unfinished: judged.left_out.iter().filter(|(_, why)| *why == LeftOut::InProgress).count() as u64,
            repeated: repeated.collect(),
            pilots: kind(SessionKind::Pilot),
            simulated: kind(SessionKind::Simulated),
            with: with.to_vec(),
            flagged: flagged.filter(|flagged| flagged.sessions > 0).collect(),
            balance_summary: in_words(&balance),
            balance,
        }
    }

    /// With the sentence: what these numbers come to, and nothing that they do not say.
    pub fn summarised(
        self,
        people: &Participants,
        excluded: &[Excluded],
        others: &[PooledVersion],
    ) -> Standing {
        Standing { summary: self.sentences(people, excluded, others).join(" "), ..self }
    }

    fn sentences(
        &self,
        people: &Participants,
        excluded: &[Excluded],
        others: &[PooledVersion],
    ) -> Vec<String> {
        let mut parts = Vec::new();
        if people.started == 0 || people.started != people.completed {
            parts.push(format!("{} began", people.started));
        }
        if people.completed > 0 {
            parts.push(format!("{} completed", people.completed));
        } else if people.started > 0 {
            parts.push("none finished yet".to_owned());
        }
        if people.in_progress > 0 {
            let until = match self.unfinished {
                0 => String::new(),
                n => format!(" ({n} judged only once they finish)"),
            };
            parts.push(format!("{} in progress{until}", people.in_progress));
        }
        if !excluded.is_empty() {
            let completed = excluded.iter().filter(|one| one.is_completed).count();
            let of_these = match excluded.len() - completed {
                0 => String::new(),
                _ => format!(" ({completed} of them completed)"),
            };
            parts.push(format!("{} left out by your rules{of_these}", excluded.len()));
        }
        if !excluded.is_empty() || !self.repeated.is_empty() || self.unfinished > 0 {
            parts.push(format!("{} judged", self.judged));
        }
        let mut sentences = vec![format!("{}.", parts.join(", "))];
        let mut left_out = |n: u64, one: &str, many: &str| match n {
            0 => {}
            1 => sentences.push(format!("1 {one} is left out.")),
            n => sentences.push(format!("{n} {many} are left out.")),
        };
        left_out(
            self.repeated.len() as u64,
            "session of a person who had taken part before",
            "sessions of persons who had taken part before",
        );
        left_out(self.pilots, "trial run", "trial runs");
        left_out(self.simulated, "simulated session", "simulated sessions");
        if !self.with.is_empty() {
            let kinds: Vec<&str> = self.with.iter().map(|kind| kind.as_str()).collect();
            sentences.push(format!("Sessions of kind {} are judged too, as was asked.", kinds.join(" and ")));
        }
        let elsewhere: u64 = others.iter().map(|version| version.sessions).sum();
        if people.started == 0 && elsewhere > 0 {
            let versions = others.iter().filter(|version| version.sessions > 0).count() as u64;
            sentences.push(format!(
                "{} of the study {} {}.",
                count(versions, "other version"),
                if versions == 1 { "has" } else { "have" },
                count(elsewhere, "session")
            ));
        }
        sentences
    }
}

/// What a balance comes to.
fn in_words(balance: &Balance) -> String {
    let mut sentences = Vec::new();
    let worst =
        balance.uneven.iter().max_by_key(|item| item.target_first.abs_diff(item.answers - item.target_first));
    match worst {
        _ if balance.items == 0 => {}
        None => sentences.push("Of each item's judged answers the target came first in half, give or take the odd one.".to_owned()),
        Some(worst) => sentences.push(format!(
            "The target came first more often or more seldom than second in {} of {}; farthest from half is {}, with {} of {}.",
            balance.uneven.len(),
            count(balance.items, "item"),
            worst.item,
            worst.target_first,
            count(worst.answers, "answer"),
        )),
    }
    match balance.doubled_places {
        0 => {}
        1 => sentences.push(
            "1 place in the design was completed by more than one participant; all of them count here."
                .to_owned(),
        ),
        n => sentences.push(format!(
            "{n} places in the design were completed by more than one participant; all of them count here."
        )),
    }
    sentences.join(" ")
}

impl Excluded {
    /// Somebody whom the study's rules leave out.
    pub fn new(session_id: impl Into<String>, reasons: Vec<Exclusion>, is_completed: bool) -> Excluded {
        let why: Vec<String> = reasons.iter().map(Exclusion::to_string).collect();
        Excluded { session_id: session_id.into(), why: why.join("; "), reasons, is_completed }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kelir_study::visits::UnevenItem;

    fn said(
        started: u64,
        in_progress: u64,
        completed: u64,
        standing: &Standing,
        excluded: &[bool],
    ) -> String {
        let people = Participants { started, in_progress, completed };
        let one = |is_completed: &bool| {
            Excluded::new("s", vec![Exclusion::StraightLining { trials: 5 }], *is_completed)
        };
        let excluded: Vec<Excluded> = excluded.iter().map(one).collect();
        standing.clone().summarised(&people, &excluded, &[]).summary
    }

    #[test]
    fn a_summary_is_made_from_the_counts() {
        let none = Standing::default();
        assert_eq!(said(0, 0, 0, &none, &[]), "0 began.");
        assert_eq!(said(3, 0, 0, &none, &[]), "3 began, none finished yet.");
        assert_eq!(said(3, 1, 0, &none, &[]), "3 began, none finished yet, 1 in progress.");
        assert_eq!(said(2, 0, 2, &none, &[]), "2 completed.");
        assert_eq!(said(2, 0, 2, &none, &[true, true]), "2 completed, 2 left out by your rules, 0 judged.");
        let one = Standing { judged: 1, pilots: 1, ..Standing::default() };
        assert_eq!(
            said(4, 1, 2, &one, &[true, false]),
            "4 began, 2 completed, 1 in progress, 2 left out by your rules (1 of them completed), 1 judged. 1 trial run is left out."
        );
        let going_on = Standing { judged: 1, unfinished: 2, ..Standing::default() };
        assert_eq!(
            said(4, 2, 1, &going_on, &[]),
            "4 began, 1 completed, 2 in progress (2 judged only once they finish), 1 judged."
        );
        let again = Repeated { session_id: "2".into(), counted: "1".into() };
        let repeats =
            Standing { judged: 1, repeated: vec![again.clone(), again], simulated: 3, ..Standing::default() };
        assert_eq!(
            said(3, 0, 3, &repeats, &[]),
            "3 completed, 1 judged. 2 sessions of persons who had taken part before are left out. 3 simulated sessions are left out."
        );
    }

    #[test]
    fn a_balance_is_told_by_what_was_counted() {
        assert_eq!(in_words(&Balance::default()), "");
        let even = Balance { items: 3, ..Balance::default() };
        assert_eq!(
            in_words(&even),
            "Of each item's judged answers the target came first in half, give or take the odd one."
        );
        let uneven = |item: &str, target_first| UnevenItem {
            block: "b".into(),
            item: item.into(),
            target_first,
            answers: 8,
        };
        let uneven = Balance { doubled_places: 1, uneven: vec![uneven("x", 5), uneven("y", 2)], ..even };
        assert_eq!(
            in_words(&uneven),
            "The target came first more often or more seldom than second in 2 of 3 items; farthest from half is y, with 2 of 8 answers. \
             1 place in the design was completed by more than one participant; all of them count here."
        );
    }

    #[test]
    fn an_empty_version_says_where_the_answers_are() {
        let other = |sessions| PooledVersion { version: "a".into(), sessions, answers: 0 };
        let of = |others: &[PooledVersion]| {
            Standing::default().summarised(&Participants::default(), &[], others).summary
        };
        assert_eq!(of(&[other(2)]), "0 began. 1 other version of the study has 2 sessions.");
        assert_eq!(of(&[other(2), other(1)]), "0 began. 2 other versions of the study have 3 sessions.");
    }
}
