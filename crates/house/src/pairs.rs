//! Choices as other programs read them.

use crate::results::read;
use crate::selection::Selection;
use kelir_report::{Terminator, csv_table};
use kelir_store::{Store, StoreError};
use kelir_study::answers::{blocks, compares};
use kelir_study::visits::Judged;
use std::collections::HashMap;

/// Choices as pwcmp reads them, one row a trial: `observer, session, scene, condition_A, condition_B, is_A_selected`, and
/// `left_condition` (of trials one after the other: the first), since A and B are the block's conditions in file order and never mean sides.
/// By participants in the order they began and items in file order, without the excluded, catch blocks and adaptive ones.
///
/// # Errors
/// The store cannot be read.
pub async fn pairs_csv(store: &Store, selection: &Selection) -> Result<String, StoreError> {
    let study = &selection.study;
    let answers = read(store, selection).await?;
    let visits = selection.visits(store).await?;
    let judged = Judged::of(study, &answers, &visits, &selection.include.0);
    let sessions = store.sessions(&study.id, &selection.versions).await?;
    let observers: HashMap<&str, &str> =
        sessions.iter().map(|s| (s.session_id.as_str(), s.subject_id.as_str())).collect();
    let header =
        ["observer", "session", "scene", "condition_A", "condition_B", "is_A_selected", "left_condition"];
    let mut rows = Vec::new();
    for participant in &judged.judged {
        let session = &*participant.session_id;
        let observer = observers.get(session).copied().unwrap_or_default();
        for (block, items) in blocks(study).filter(|(block, _)| compares(block)) {
            let [a, b] = &block.conditions;
            for given in participant.answers_to(&items) {
                let item = &block.items[(given.item - items.start) as usize];
                let chose = |target: bool| if target { block.target.as_str() } else { block.other() };
                let selected = if chose(given.chose_target) == a { "1" } else { "0" };
                let first = chose(given.chose_target == given.chose_first);
                rows.push([observer, session, &item.id, a, b, selected, first]);
            }
        }
    }
    Ok(csv_table(Terminator::CRLF, header, rows))
}
