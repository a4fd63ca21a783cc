//! The answers to a study, by participant: what every analysis reads. An answer takes sixteen bytes and names nothing, so that a
//! million are gone through in milliseconds.

use crate::definition::{Block, StudyDefinition};
use crate::trials::{self, Observation};
use crate::visits::Pace;
use kelir_stats::pairwise::{Choice, Observer};
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::sync::Arc;

/// One answer as it was stored.
#[derive(Clone, Debug)]
pub struct Row<'a> {
    /// Whose answer; any text that tells participants apart.
    pub session_id: &'a str,
    /// 0-based place of the trial in the session.
    pub trial_index: u32,
    /// What it says.
    pub observation: Observation<'a>,
    /// When the server received it, µs since 1970; `None` where that is not known.
    pub received_us: Option<i64>,
}

impl<'a> Row<'a> {
    /// The choice between two conditions of an item, in the order in which they stood.
    pub fn choice(
        session_id: &'a str,
        trial_index: u32,
        item: &'a str,
        [first, second]: [&'a str; 2],
        chose_first: bool,
        rt_ms: f64,
    ) -> Row<'a> {
        let observation = Observation::Choice(trials::Choice {
            item: item.into(),
            first_condition: first.into(),
            second_condition: second.into(),
            chose_first,
            rt_ms,
        });
        Row { session_id, trial_index, observation, received_us: None }
    }
}

/// One answer of a participant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Given {
    /// Place of the item in the study: items are numbered through all blocks in file order.
    pub item: u32,
    /// 0-based place of the trial in the session; a study has at most 10,000.
    pub trial_index: u16,
    /// Whether the block's target was chosen.
    pub chose_target: bool,
    /// Whether the stimulus was chosen that stood first: on the left, or in the first interval.
    pub chose_first: bool,
    /// Response time in ms; NaN where it is not known.
    pub rt_ms: f64,
}

/// The answers of one participant.
#[derive(Clone, Debug, PartialEq)]
pub struct Participant {
    /// Whose answers.
    pub session_id: Arc<str>,
    /// What the answers claim of time.
    pub pace: Pace,
    /// By rising item, then by trial.
    answers: Vec<Given>,
}

impl Participant {
    /// The answers by rising item, then by trial.
    pub fn answers(&self) -> &[Given] {
        &self.answers
    }

    /// The answers to the items of one block.
    pub fn answers_to(&self, items: &Range<u32>) -> &[Given] {
        let before = |end: u32| self.answers.partition_point(|given| given.item < end);
        &self.answers[before(items.start)..before(items.end)]
    }

    /// Whether the target was chosen in each trial of one block, in the order of the trials.
    pub fn in_order(&self, items: &Range<u32>) -> Vec<bool> {
        let mut answers = self.answers_to(items).to_vec();
        answers.sort_by_key(|given| given.trial_index);
        answers.into_iter().map(|given| given.chose_target).collect()
    }
}

/// The answers to one version of a study. It only ever grows, as answers do.
#[derive(Clone, Debug)]
pub struct Answers {
    places: Arc<Places>,
    participants: Vec<Participant>,
    known: HashMap<Arc<str>, usize>,
}

/// Where a study's items lie.
#[derive(Debug)]
struct Places {
    /// Item's id → its place.
    items: HashMap<String, u32>,
    /// Of each place the target, the other condition, and whether it may be shown more than once.
    of: Vec<(String, String, bool)>,
}

impl Answers {
    /// No answers yet to this study.
    pub fn new(study: &StudyDefinition) -> Answers {
        let items = study.blocks.iter().flat_map(|block| block.items.iter().map(move |item| (block, item)));
        let mut places = Places { items: HashMap::new(), of: Vec::new() };
        for (place, (block, item)) in (0..).zip(items) {
            places.items.insert(item.id.clone(), place);
            places.of.push((block.target.clone(), block.other().to_owned(), block.adaptive.is_some()));
        }
        Answers { places: Arc::new(places), participants: Vec::new(), known: HashMap::new() }
    }

    /// No answers yet to the same study.
    pub fn emptied(&self) -> Answers {
        Answers { places: self.places.clone(), participants: Vec::new(), known: HashMap::new() }
    }

    /// Adds an answer. What names an item or condition that the study does not have is left out; of several answers of one participant to one
    /// item that is shown once the first counts.
    pub fn push(&mut self, row: Row<'_>) {
        let Observation::Choice(choice) = row.observation;
        let Some(&item) = self.places.items.get(&*choice.item) else { return };
        let (target, other, again) = &self.places.of[item as usize];
        let target_first = choice.first_condition == *target;
        let [first, second] = if target_first { [target, other] } else { [other, target] };
        let known = choice.first_condition == *first && choice.second_condition == *second;
        let Some(trial_index) = u16::try_from(row.trial_index).ok().filter(|_| known) else { return };
        let (again, chose_first, rt_ms) = (*again, choice.chose_first, choice.rt_ms);
        let chose_target = target_first == chose_first;
        let given = Given { item, trial_index, chose_target, chose_first, rt_ms };
        let index = self.participant(row.session_id);
        let participant = &mut self.participants[index];
        participant.pace = participant.pace.then(Pace::of(trial_index, again, rt_ms, row.received_us));
        insert(&mut participant.answers, given, again);
    }

    /// Adds later answers to the same study.
    pub fn append(&mut self, later: Answers) {
        for participant in later.participants {
            let index = self.participant(&participant.session_id);
            let Participant { pace, answers: own, .. } = &mut self.participants[index];
            *pace = pace.then(participant.pace);
            if own.is_empty() {
                *own = participant.answers;
            } else {
                for given in participant.answers {
                    insert(own, given, self.places.of[given.item as usize].2);
                }
            }
        }
    }

    fn participant(&mut self, session_id: &str) -> usize {
        if let Some(&index) = self.known.get(session_id) {
            return index;
        }
        let session_id: Arc<str> = session_id.into();
        self.known.insert(session_id.clone(), self.participants.len());
        self.participants.push(Participant { session_id, pace: Pace::default(), answers: Vec::new() });
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

/// Puts an answer in its place; `again`: to an item that may be shown more than once.
fn insert(answers: &mut Vec<Given>, given: Given, again: bool) {
    let key = |given: &Given| (given.item, if again { given.trial_index } else { 0 });
    if let Err(at) = answers.binary_search_by_key(&key(&given), key) {
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
    /// Number of target choices → how many of those who answered all items made it; empty for an adaptive block, which has no such number.
    pub complete: Vec<u64>,
    /// Who answered everything that the block asked of them.
    pub finished: u64,
    /// Who answered some trials but not all.
    pub incomplete: u64,
    /// Choices of the target, by whomever.
    pub hits: u64,
    /// All choices, by whomever.
    pub trials: u64,
}

/// A tally of every block in study order, catch blocks too, in one walk over the answers.
pub fn tallies(study: &StudyDefinition, participants: &[&Participant]) -> Vec<Tally> {
    let blocks: Vec<(&Block, Range<u32>)> = blocks(study).collect();
    let empty = |(block, _): &(&Block, Range<u32>)| Tally {
        complete: if block.adaptive.is_some() { Vec::new() } else { vec![0; block.items.len() + 1] },
        finished: 0,
        incomplete: 0,
        hits: 0,
        trials: 0,
    };
    let mut tallies: Vec<Tally> = blocks.iter().map(empty).collect();
    for participant in participants {
        let mut answers = participant.answers.iter().peekable();
        for (tally, (block, items)) in tallies.iter_mut().zip(&blocks) {
            let (mut hits, mut trials) = (0, 0);
            while let Some(given) = answers.next_if(|given| given.item < items.end) {
                trials += 1;
                hits += u64::from(given.chose_target);
            }
            tally.hits += hits;
            tally.trials += trials;
            let finished = trials > 0 && trials == asked(block, items, participant, trials as usize) as u64;
            tally.finished += u64::from(finished);
            tally.incomplete += u64::from(trials > 0 && !finished);
            if let Some(count) = tally.complete.get_mut(hits as usize).filter(|_| finished) {
                *count += 1;
            }
        }
    }
    tallies
}

/// How many trials a block asks of a participant who answered `trials` of it; of an adaptive one that goes on, the most there can be.
fn asked(block: &Block, items: &Range<u32>, participant: &Participant, trials: usize) -> usize {
    match &block.adaptive {
        Some(adaptive) if trials > 0 && adaptive.has_ended(block, trials, || participant.in_order(items)) => {
            trials
        }
        _ => block.most_trials(),
    }
}

/// How many trials a study asks of a participant, as far as their answers decide it.
pub fn trials_asked(study: &StudyDefinition, participant: &Participant) -> usize {
    let of = |(block, items): (&Block, Range<u32>)| {
        asked(block, &items, participant, participant.answers_to(&items).len())
    };
    blocks(study).map(of).sum()
}

/// Whether a block's choices compare its conditions: catch blocks screen, and in adaptive ones the procedure steers how often the target is
/// chosen.
pub fn compares(block: &Block) -> bool {
    !block.catch && block.adaptive.is_none()
}

/// The conditions of all blocks that compare them, sorted.
pub fn conditions(study: &StudyDefinition) -> Vec<String> {
    let compared = study.blocks.iter().filter(|block| compares(block));
    let mut names: Vec<String> = compared.flat_map(|block| block.conditions.iter().cloned()).collect();
    names.sort();
    names.dedup();
    names
}

/// The conditions of all blocks that compare them, sorted, and what each participant chose over what: the way to a scale. Blocks of
/// stills and of animations are pooled: the scale is of conditions, whatever is shown.
pub fn observers(study: &StudyDefinition, participants: &[&Participant]) -> (Vec<String>, Vec<Observer>) {
    let compared: Vec<(&Block, Range<u32>)> = blocks(study).filter(|(block, _)| compares(block)).collect();
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
