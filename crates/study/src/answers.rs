//! The answers to a study, by participant: what every analysis reads. An answer takes sixteen bytes and names nothing, so that a
//! million are gone through in milliseconds.

use crate::definition::{Block, StudyDefinition};
use kelir_stats::pairwise::{Choice, Observer};
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::sync::Arc;

/// One answer as it was stored.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    /// Whose answer; any text that tells participants apart.
    pub session_id: &'a str,
    /// Item's id.
    pub item_id: &'a str,
    /// Condition on the left.
    pub left_condition: &'a str,
    /// Whether the left picture was chosen.
    pub chose_left: bool,
    /// Response time in ms.
    pub rt_ms: f64,
}

/// One answer of a participant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Given {
    /// Place of the item in the study: items are numbered through all blocks in file order.
    pub item: u32,
    /// Whether the block's target was chosen.
    pub chose_target: bool,
    /// Whether the left picture was chosen.
    pub chose_left: bool,
    /// Response time in ms.
    pub rt_ms: f64,
}

/// The answers of one participant.
#[derive(Clone, Debug, PartialEq)]
pub struct Participant {
    /// Whose answers.
    pub session_id: Arc<str>,
    /// By rising pair, one a pair.
    answers: Vec<Given>,
}

impl Participant {
    /// The answers by rising pair, one a pair.
    pub fn answers(&self) -> &[Given] {
        &self.answers
    }

    /// The answers to the pairs of one block.
    pub fn answers_to(&self, items: &Range<u32>) -> &[Given] {
        let before = |end: u32| self.answers.partition_point(|given| given.item < end);
        &self.answers[before(items.start)..before(items.end)]
    }
}

/// The answers to one version of a study. It only ever grows, as answers do.
#[derive(Clone, Debug)]
pub struct Answers {
    places: Arc<Places>,
    participants: Vec<Participant>,
    known: HashMap<Arc<str>, usize>,
}

/// Where a study's pairs lie.
#[derive(Debug)]
struct Places {
    /// Item's id → its place.
    items: HashMap<String, u32>,
    /// The target and the other condition of each place.
    conditions: Vec<[String; 2]>,
}

impl Answers {
    /// No answers yet to this study.
    pub fn new(study: &StudyDefinition) -> Answers {
        let items = study.blocks.iter().flat_map(|block| block.items.iter().map(move |pair| (block, pair)));
        let (mut ids, mut conditions) = (HashMap::new(), Vec::new());
        for (place, (block, pair)) in (0..).zip(items) {
            ids.insert(pair.id.clone(), place);
            conditions.push([block.target.clone(), block.other().to_owned()]);
        }
        let places = Arc::new(Places { items: ids, conditions });
        Answers { places, participants: Vec::new(), known: HashMap::new() }
    }

    /// No answers yet to the same study.
    pub fn emptied(&self) -> Answers {
        Answers { places: self.places.clone(), participants: Vec::new(), known: HashMap::new() }
    }

    /// Adds an answer. What names a pair or condition that the study does not have is left out; of several answers of one
    /// participant to one pair the first counts.
    pub fn push(&mut self, row: Row<'_>) {
        let Some(&item) = self.places.items.get(row.item_id) else { return };
        let [target, other] = &self.places.conditions[item as usize];
        let target_left = row.left_condition == target;
        if !target_left && row.left_condition != other {
            return;
        }
        let chose_target = target_left == row.chose_left;
        let given = Given { item, chose_target, chose_left: row.chose_left, rt_ms: row.rt_ms };
        let index = self.participant(row.session_id);
        insert(&mut self.participants[index].answers, given);
    }

    /// Adds later answers to the same study.
    pub fn append(&mut self, later: Answers) {
        for participant in later.participants {
            let index = self.participant(&participant.session_id);
            let own = &mut self.participants[index].answers;
            if own.is_empty() {
                *own = participant.answers;
            } else {
                participant.answers.into_iter().for_each(|given| insert(own, given));
            }
        }
    }

    fn participant(&mut self, session_id: &str) -> usize {
        if let Some(&index) = self.known.get(session_id) {
            return index;
        }
        let session_id: Arc<str> = session_id.into();
        self.known.insert(session_id.clone(), self.participants.len());
        self.participants.push(Participant { session_id, answers: Vec::new() });
        self.participants.len() - 1
    }

    /// Everybody who answered, by their ids.
    pub fn participants(&self) -> Vec<&Participant> {
        let mut participants: Vec<&Participant> = self.participants.iter().collect();
        // As good as sorted: an id begins with the time it was given.
        participants.sort_by(|a, b| a.session_id.cmp(&b.session_id));
        participants
    }

    /// How many answers there are.
    pub fn len(&self) -> usize {
        self.participants.iter().map(|p| p.answers.len()).sum()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.participants.is_empty()
    }
}

fn insert(answers: &mut Vec<Given>, given: Given) {
    if let Err(at) = answers.binary_search_by_key(&given.item, |known| known.item) {
        answers.insert(at, given);
    }
}

/// Each block with the places of its pairs, in study order.
pub fn blocks(study: &StudyDefinition) -> impl Iterator<Item = (&Block, Range<u32>)> {
    study.blocks.iter().scan(0, |next, block| {
        let first = *next;
        *next += block.items.len() as u32;
        Some((block, first..*next))
    })
}

/// What participants chose in one block.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally {
    /// Number of target choices → how many of those who answered all pairs made it.
    pub complete: Vec<u64>,
    /// Who answered some pairs but not all.
    pub incomplete: u64,
    /// Choices of the target, by whomever.
    pub hits: u64,
    /// All choices, by whomever.
    pub trials: u64,
}

/// A tally of every block in study order, catch blocks too, in one walk over the answers.
pub fn tallies(study: &StudyDefinition, participants: &[&Participant]) -> Vec<Tally> {
    let ends: Vec<(u32, u64)> =
        blocks(study).map(|(block, items)| (items.end, block.items.len() as u64)).collect();
    let empty = |&(_, items): &(u32, u64)| Tally {
        complete: vec![0; items as usize + 1],
        incomplete: 0,
        hits: 0,
        trials: 0,
    };
    let mut tallies: Vec<Tally> = ends.iter().map(empty).collect();
    for participant in participants {
        let mut answers = participant.answers.iter().peekable();
        for (tally, &(end, items)) in tallies.iter_mut().zip(&ends) {
            let (mut hits, mut trials) = (0, 0);
            while let Some(given) = answers.next_if(|given| given.item < end) {
                trials += 1;
                hits += u64::from(given.chose_target);
            }
            tally.hits += hits;
            tally.trials += trials;
            if trials == items {
                tally.complete[hits as usize] += 1;
            } else {
                tally.incomplete += u64::from(trials > 0);
            }
        }
    }
    tallies
}

/// The conditions of all blocks but catch blocks, sorted.
pub fn conditions(study: &StudyDefinition) -> Vec<String> {
    let compared = study.blocks.iter().filter(|block| !block.catch);
    let mut names: Vec<String> = compared.flat_map(|block| block.conditions.iter().cloned()).collect();
    names.sort();
    names.dedup();
    names
}

/// The conditions of all blocks but catch blocks, sorted, and what each participant chose over what: the way to a scale. Blocks of
/// stills and of animations are pooled: the scale is of conditions, whatever is shown.
pub fn observers(study: &StudyDefinition, participants: &[&Participant]) -> (Vec<String>, Vec<Observer>) {
    let compared: Vec<(&Block, Range<u32>)> = blocks(study).filter(|(block, _)| !block.catch).collect();
    let names = conditions(study);
    let index = |name: &str| names.iter().position(|known| known == name);
    let sides: Vec<(Range<u32>, usize, usize)> = compared
        .into_iter()
        .filter_map(|(block, items)| Some((items, index(&block.target)?, index(block.other())?)))
        .collect();
    let observers = participants
        .iter()
        .map(|participant| {
            let mut choices = BTreeMap::<(usize, usize), u64>::new();
            for (items, target, other) in &sides {
                let given = participant.answers_to(items);
                let hits = given.iter().filter(|given| given.chose_target).count();
                for (pair, times) in [((*target, *other), hits), ((*other, *target), given.len() - hits)] {
                    if times > 0 {
                        *choices.entry(pair).or_default() += times as u64;
                    }
                }
            }
            let choice = |((winner, loser), times)| Choice { winner, loser, times };
            Observer {
                id: participant.session_id.to_string(),
                choices: choices.into_iter().map(choice).collect(),
            }
        })
        .collect();
    (names, observers)
}

#[cfg(test)]
mod tests;
