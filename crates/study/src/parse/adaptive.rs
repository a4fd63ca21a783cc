//! `[blocks.adaptive]`.

use crate::adaptive::{Adaptive, Track};
use crate::fields::{SECTION, integer, number};
use kelir_reader::{Fields, Node};

/// The block's adaptive procedure, if it asks for one; `None` also where something is wrong, which has been reported. Whether it goes with the
/// block's levels is looked at when the block is whole.
pub(super) fn read(block: &mut Fields<'_>) -> Option<Adaptive> {
    let mut fields = block.given("adaptive", SECTION)?.table()?;
    let procedure = fields.must("procedure", "\"staircase\" or \"quest-plus\"", |v| {
        v.as_str().filter(|name| ["staircase", "quest-plus"].contains(name))
    });
    let count = |most| move |v: &Node| integer(v, 1, most).map(|n| n as u32);
    let trials = fields.must("trials", "a count from 1 to 1000", count(1000));
    let found = match procedure {
        Some("staircase") => {
            let track = read_track(&mut fields);
            let start =
                fields.may("start", "the level of one of the block's items", |v| number(v, -1e12, 1e12));
            let rule = "a list of 1 to 20 numbers of levels from 1 to 1000";
            let steps = fields.defaulted("steps", rule, vec![4, 2, 1], |v| {
                let items = v.as_array().filter(|items| (1..=20).contains(&items.len()))?;
                items.iter().map(count(1000)).collect()
            });
            let reversals = fields.must("reversals", "a count from 1 to 1000", count(1000));
            track.zip(steps).zip(reversals).zip(trials).map(|(((track, steps), reversals), trials)| {
                Adaptive::Staircase { track, start, steps, reversals, trials }
            })
        }
        Some(_) => {
            let rule = "a number of levels above 0";
            let precise_enough = fields.may("precise_enough", rule, |v| number(v, f64::MIN_POSITIVE, 1e12));
            trials.map(|trials| Adaptive::QuestPlus { trials, precise_enough })
        }
        None => None,
    };
    fields.done();
    found
}

/// `down` correct answers for a step, or the `share` to track; three down, one up without either.
fn read_track(fields: &mut Fields<'_>) -> Option<Track> {
    let rule = "a count from 2 to 10 (with one, guessing alone would hold it)";
    let down = fields.defaulted("down", rule, 3, |v| integer(v, 2, 10));
    let rule = "a share of target choices above 0.5 and below 1";
    let share = fields
        .defaulted("share", rule, None, |v| number(v, 0.0, 1.0).filter(|p| *p > 0.5 && *p < 1.0).map(Some));
    if fields.has("down") && fields.has("share") {
        fields.report("share", "leave out either down or share");
    }
    match share? {
        Some(target) => Some(Track::Weighted { target }),
        None => down.map(|down| Track::Transformed { down: down as u32 }),
    }
}
