//! Masks kept for poses that come again, as in a loop.

use std::collections::HashMap;
use std::sync::Arc;

use super::figure::{Figure, Pose, Posed};
use crate::theatre::Texels;

/// Bytes of masks that are kept of a puppet.
const KEPT_BYTES: usize = 64 << 20;

/// The masks of the poses that a drawing was shown last: whoever draws keeps one, and a pose that comes again keeps its mask, the same [`Arc`] and
/// the same [`Mask::id`](crate::Mask::id). One may be used for several scenes.
#[derive(Debug, Default)]
pub struct Masks {
    /// By the id of the mask that the figure has at rest.
    of_figure: HashMap<u64, Vec<Posed>>,
}

impl Masks {
    /// The figure in a pose.
    pub(crate) fn posed(&mut self, figure: &Figure, pose: &Pose) -> Posed {
        let rest = figure.rest();
        if let Some(rest) = rest.filter(|rest| rest.pose == *pose) {
            return rest.clone();
        }
        let kept = self.of_figure.entry(rest.map_or(0, |rest| rest.mask.id)).or_default();
        let posed = match kept.iter().position(|posed| posed.pose == *pose) {
            Some(at) => kept.remove(at),
            None => {
                let spent = make_room(kept, figure.bytes(figure.extent(pose)));
                figure.posed(pose, spent)
            }
        };
        kept.push(posed.clone());
        posed
    }
}

/// Forgets the masks that were not asked for longest until `bytes` more fit; the texels of one that nobody holds any more are handed back for reuse.
fn make_room(kept: &mut Vec<Posed>, bytes: usize) -> Option<Texels> {
    let mut held: usize = kept.iter().map(|posed| posed.mask.bytes()).sum();
    let mut spent = None;
    while held + bytes > KEPT_BYTES && kept.len() > 1 {
        let forgotten = kept.remove(0);
        held -= forgotten.mask.bytes();
        spent = Arc::into_inner(forgotten.mask).map(|mask| mask.texels).or(spent);
    }
    spent
}
