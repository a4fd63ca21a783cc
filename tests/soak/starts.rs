//! Many people who begin at the same moment: each has a place of their own, and the design stays balanced to the last one.

use super::ledger::rows;
use super::victim::Victim;
use super::wire::{Wire, request};
use super::{Outcome, Plan, panics};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Barrier;
use std::time::Instant;

pub(super) fn attack(plan: &Plan) -> Result<Outcome, String> {
    let data = crate::small_data();
    let victim = Victim::start(data.path())?;
    let barrier = Barrier::new(plan.starts);
    let begin = request(
        "POST",
        "/api/v1/studies/small/sessions",
        &[("Content-Type", "application/json")],
        Some(b"{}"),
    );
    let begun = Instant::now();
    let statuses: Vec<u16> = std::thread::scope(|scope| {
        let person = || {
            barrier.wait();
            Wire::new(victim.port).send(&begin).map_or(0, |reply| reply.status)
        };
        let people: Vec<_> = (0..plan.starts).map(|_| scope.spawn(person)).collect();
        people.into_iter().map(|person| person.join().unwrap_or_default()).collect()
    });
    let took = begun.elapsed();
    let mut wrong = panics(&victim.log());
    let refused = statuses.iter().filter(|status| **status != 201).count();
    if refused > 0 {
        wrong.push(format!("{refused} of {} could not begin", plan.starts));
    }
    wrong.extend(unbalanced(&Design::read(&victim.database())?, plan.starts));
    Ok(Outcome { did: format!("{} starts at once: {} ms", plan.starts, took.as_millis()), wrong })
}

/// Who has which place, and what stands on the left in it.
struct Design {
    slots: Vec<u64>,
    /// How often each condition of each item.
    left: BTreeMap<String, BTreeMap<String, u64>>,
}

impl Design {
    fn read(database: &Path) -> Result<Design, String> {
        let slots = rows(database, "SELECT slot FROM sessions ORDER BY slot")?;
        let counted = rows(
            database,
            "SELECT json_extract(trial, '$.block_id') || ' ' || json_extract(trial, '$.item_id') AS item,
             json_extract(trial, '$.shown.left.condition') AS condition, count(*) AS n FROM session_trials GROUP BY 1, 2",
        )?;
        let mut left: BTreeMap<String, BTreeMap<String, u64>> = BTreeMap::new();
        for row in counted {
            let text = |column: &str| row[column].as_str().unwrap_or_default().to_owned();
            left.entry(text("item"))
                .or_default()
                .insert(text("condition"), row["n"].as_u64().unwrap_or_default());
        }
        let slots = slots.iter().filter_map(|row: &Value| row["slot"].as_u64()).collect();
        Ok(Design { slots, left })
    }
}

/// What is not as it is when so many have begun, an even number.
fn unbalanced(design: &Design, people: usize) -> Vec<String> {
    let mut wrong = Vec::new();
    if design.slots != Vec::from_iter(0..people as u64) {
        wrong.push(format!("{people} people have the places {:?}", design.slots));
    }
    if design.left.is_empty() {
        wrong.push("nobody has a trial".to_owned());
    }
    let half = people as u64 / 2;
    for (item, conditions) in &design.left {
        if conditions.len() != 2 || conditions.values().any(|n| *n != half) {
            wrong.push(format!("{item} stands on the left as {conditions:?}"));
        }
    }
    wrong
}

#[cfg(test)]
mod tests {
    use super::*;

    fn design(slots: &[u64], pa: u64, mc: u64) -> Design {
        let conditions = BTreeMap::from([("pa".to_owned(), pa), ("mc".to_owned(), mc)]);
        Design { slots: slots.to_vec(), left: BTreeMap::from([("stills a".to_owned(), conditions)]) }
    }

    #[test]
    fn doubled_places_and_uneven_sides_are_found() {
        assert_eq!(unbalanced(&design(&[0, 1, 2, 3], 2, 2), 4), [""; 0]);
        assert_eq!(unbalanced(&design(&[0, 1, 1, 3], 2, 2), 4).len(), 1);
        assert_eq!(unbalanced(&design(&[0, 1, 2, 4], 2, 2), 4).len(), 1);
        assert_eq!(unbalanced(&design(&[0, 1, 2, 3], 3, 1), 4).len(), 1);
        assert_eq!(unbalanced(&design(&[0, 1, 2, 3], 2, 1), 4).len(), 1);
    }
}
