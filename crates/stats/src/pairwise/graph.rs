//! What the comparisons connect.

use super::Wins;
use crate::{Result, StatsError};

/// Groups of conditions linked by any comparison.
pub(super) fn components(wins: &Wins) -> Vec<Vec<usize>> {
    let n = wins.conditions();
    let mut group = vec![usize::MAX; n];
    let mut found = Vec::new();
    for start in 0..n {
        if group[start] != usize::MAX {
            continue;
        }
        let members = reach(start, n, |i, j| wins.count(i, j) + wins.count(j, i) > 0);
        for &m in &members {
            group[m] = found.len();
        }
        found.push(members);
    }
    found
}

/// The error that names the groups, unless there is only one.
pub(super) fn connected(wins: &Wins, names: &[String]) -> Result<()> {
    let groups = components(wins);
    if groups.len() < 2 {
        return Ok(());
    }
    let named = |g: &Vec<usize>| g.iter().map(|&i| names[i].clone()).collect();
    Err(StatsError::Disconnected { components: groups.iter().map(named).collect() })
}

/// The conditions that were never beaten by any of the others, when there is such a group: then no finite maximum exists.
///
/// Ford (1957): the maximum-likelihood scale is finite and unique exactly when, however the conditions are split in two, each part was
/// chosen over the other at least once, that is, when "was chosen over" makes a strongly connected graph.
pub(super) fn unbeaten(wins: &Wins) -> Option<Vec<usize>> {
    let n = wins.conditions();
    // Strongly connected means that everything is reached from 0 and reaches 0.
    let beats = reach(0, n, |i, j| wins.count(i, j) > 0);
    if beats.len() < n {
        // Nothing reached from 0 ever won against the rest.
        return Some((0..n).filter(|i| !beats.contains(i)).collect());
    }
    let beaten_by = reach(0, n, |i, j| wins.count(j, i) > 0);
    (beaten_by.len() < n).then_some(beaten_by)
}

fn reach(start: usize, n: usize, edge: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let mut seen = vec![false; n];
    let mut stack: Vec<usize> = if start < n { vec![start] } else { vec![] };
    while let Some(i) = stack.pop() {
        if !std::mem::replace(&mut seen[i], true) {
            stack.extend((0..n).filter(|&j| !seen[j] && edge(i, j)));
        }
    }
    (0..n).filter(|&i| seen[i]).collect()
}
