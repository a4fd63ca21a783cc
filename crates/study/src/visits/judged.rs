//! Whose answers are judged: participants, one session a person, without those whom the study's rules leave out.

use super::{Flag, Pace, SessionKind, Visit};
use crate::answers::{Answers, Participant};
use crate::definition::StudyDefinition;
use crate::screening::{Exclusion, screen};
use serde::Serialize;
use std::collections::HashMap;
use std::fmt;
use utoipa::ToSchema;

/// A session of a person whose answers are counted already.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct Repeated {
    /// Session's id.
    pub session_id: String,
    /// The person's session that counts: the first complete one, or the first with answers where none is complete.
    pub counted: String,
}

/// Why a session's answers are not judged.
#[derive(Clone, Debug, PartialEq)]
pub enum LeftOut {
    /// The study's rules of screening say so.
    Excluded(Vec<Exclusion>),
    /// It goes on, and the rules judge nobody who has not finished.
    InProgress,
    /// Another session of the same person counts.
    Repeated(Repeated),
    /// It is no participant's.
    Kind(SessionKind),
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LeftOut::Excluded(reasons) => {
                let reasons: Vec<String> = reasons.iter().map(Exclusion::to_string).collect();
                f.write_str(&reasons.join("; "))
            }
            LeftOut::InProgress => f.write_str("still in progress"),
            LeftOut::Repeated(repeated) => {
                write!(f, "had taken part before: session {} counts", repeated.counted)
            }
            LeftOut::Kind(kind) => write!(f, "{} session", kind.as_str()),
        }
    }
}

/// Who is judged, and who is not.
#[derive(Clone, Debug, Default)]
pub struct Judged<'a> {
    /// One session a person, those that the study's rules leave out too; by their ids.
    pub everybody: Vec<&'a Participant>,
    /// The same without those.
    pub judged: Vec<&'a Participant>,
    /// Why the others are not judged, by session, in the order they began; of sessions without answers that of their kind alone.
    pub left_out: Vec<(&'a Visit, LeftOut)>,
    /// What was noticed of each session.
    pub flags: HashMap<&'a str, Vec<Flag>>,
    /// Places in the design that more than one of those who count has completed.
    pub doubled_places: u64,
}

impl<'a> Judged<'a> {
    /// Judges `visits`, in the order they began, by their answers; `with` names kinds of sessions that count as participants'.
    pub fn of(
        study: &StudyDefinition,
        answers: &'a Answers,
        visits: &'a [Visit],
        with: &[SessionKind],
    ) -> Judged<'a> {
        let answered: HashMap<&str, &Participant> = answers
            .participants()
            .into_iter()
            .map(|participant| (&*participant.session_id, participant))
            .collect();
        let counts = |visit: &Visit| visit.kind == SessionKind::Participant || with.contains(&visit.kind);
        let counted = counted(visits.iter().filter(|visit| counts(visit)), &answered);
        let mut all = Judged {
            doubled_places: doubled(visits.iter().filter(|visit| counts(visit))),
            ..Judged::default()
        };
        for visit in visits {
            let session = visit.session_id.as_str();
            let participant = answered.get(session).copied();
            let flags = visit.flags(participant.map_or(Pace::default(), |p| p.pace));
            let repeats =
                visit.person.as_deref().and_then(|person| counted.get(person)).filter(|id| **id != session);
            let why = match (participant, repeats) {
                _ if !counts(visit) => Some(LeftOut::Kind(visit.kind)),
                (None, _) => None,
                (Some(_), Some(counted)) => Some(LeftOut::Repeated(Repeated {
                    session_id: session.to_owned(),
                    counted: (*counted).to_owned(),
                })),
                (Some(participant), None) => {
                    all.everybody.push(participant);
                    let mut reasons = screen(study, participant, &flags);
                    if reasons.is_empty() {
                        all.judged.push(participant);
                        None
                    } else {
                        // Whoever goes on has not failed to finish.
                        reasons.retain(|reason| {
                            !(visit.is_active && matches!(reason, Exclusion::Incomplete { .. }))
                        });
                        Some(if reasons.is_empty() {
                            LeftOut::InProgress
                        } else {
                            LeftOut::Excluded(reasons)
                        })
                    }
                }
            };
            all.left_out.extend(why.map(|why| (visit, why)));
            if !flags.is_empty() {
                all.flags.insert(session, flags);
            }
        }
        all
    }
}

/// How many places more than one visit has completed.
fn doubled<'a>(visits: impl Iterator<Item = &'a Visit>) -> u64 {
    let mut completed: HashMap<(&str, u32), u64> = HashMap::new();
    for visit in visits.filter(|visit| visit.completed_us.is_some()) {
        *completed.entry((&visit.version, visit.slot)).or_default() += 1;
    }
    completed.values().filter(|visits| **visits > 1).count() as u64
}

/// Each person's session that counts: the one that was finished first, or else the first of those begun that has answers.
fn counted<'a>(
    visits: impl Iterator<Item = &'a Visit>,
    answered: &HashMap<&str, &Participant>,
) -> HashMap<&'a str, &'a str> {
    let mut counted: HashMap<&str, &Visit> = HashMap::new();
    for visit in visits.filter(|visit| answered.contains_key(visit.session_id.as_str())) {
        let Some(person) = &visit.person else { continue };
        let best = counted.entry(person).or_insert(visit);
        let earlier = |visit: &Visit| visit.completed_us.unwrap_or(i64::MAX);
        if earlier(visit) < earlier(best) {
            *best = visit;
        }
    }
    counted.into_iter().map(|(person, visit)| (person, visit.session_id.as_str())).collect()
}
