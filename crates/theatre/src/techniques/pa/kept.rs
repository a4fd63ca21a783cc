//! Tables on the CPU, kept from one drawing to the next.

use std::sync::Arc;

use kelir_frame::Stats;
use kelir_scene::{Mask, Theatre};

use super::plan::Plan;
use super::table::{Sums, Table};

/// A table and the mask it was made from.
#[derive(Debug)]
struct Kept {
    mask: Arc<Mask>,
    channel: usize,
    table: Table,
}

impl Kept {
    fn wide(&self) -> bool {
        matches!(self.table.sums, Sums::U64(_))
    }
}

/// Tables that [`prepare`](Self::prepare) made and did not forget.
#[derive(Debug, Default)]
pub(super) struct Tables(Vec<Kept>);

impl Tables {
    /// Makes it hold what `plan` needs and no other, building all anew unless `keep`; counts what was built and what was there.
    pub(super) fn prepare(&mut self, theatre: &Theatre, plan: &Plan, keep: bool, stats: &mut Stats) {
        let mut needed: Vec<(usize, usize)> = Vec::new();
        for p in (0..theatre.planes.len()).filter(|p| plan.lookups.iter().any(|l| l.plane == *p)) {
            needed.extend((0..theatre.planes[p].mask.channels).map(|c| (p, c)));
        }
        let (kept, mut spare): (Vec<Kept>, Vec<Kept>) = std::mem::take(&mut self.0)
            .into_iter()
            .partition(|kept| keep && needed.iter().any(|n| serves(kept, theatre, plan, *n)));
        self.0 = kept;
        let mut built = 0;
        for need in &needed {
            if self.0.iter().any(|kept| serves(kept, theatre, plan, *need)) {
                continue;
            }
            let mask = &theatre.planes[need.0].mask;
            let old = spare
                .iter()
                .position(|k| k.wide() == plan.wide[need.0] && k.table.width == mask.width)
                .map(|i| spare.swap_remove(i).table);
            let table = Table::new(mask, need.1, plan.wide[need.0], old);
            self.0.push(Kept { mask: mask.clone(), channel: need.1, table });
            built += 1;
        }
        stats.counts.insert("tables_built".into(), built);
        stats.counts.insert("tables_reused".into(), needed.len() as u64 - built);
    }

    /// The table of look-up `l` in channel `c` at `l * plan.channels + c`; [`prepare`](Self::prepare) must have been called.
    pub(super) fn of(&self, theatre: &Theatre, plan: &Plan) -> Vec<&Table> {
        let find = |p: usize, c: usize| {
            let need = (p, c % theatre.planes[p].mask.channels);
            let kept = self.0.iter().find(|kept| serves(kept, theatre, plan, need));
            &kept.expect("prepared for this plan").table
        };
        plan.lookups
            .iter()
            .flat_map(|l| (0..plan.channels).map(move |c| (l.plane, c)))
            .map(|(p, c)| find(p, c))
            .collect()
    }
}

fn serves(kept: &Kept, theatre: &Theatre, plan: &Plan, (p, c): (usize, usize)) -> bool {
    kept.mask.id == theatre.planes[p].mask.id && kept.channel == c && kept.wide() == plan.wide[p]
}
