//! Knobs: what can be turned on a technique, each said once. Study files, the command line, the tables and every message are made of these.

use std::fmt;
use std::ops::{Bound, RangeBounds};

use kelir_reader::list;
use serde::Serialize;
use serde_json::Value;

use crate::RenderError;

/// What can be turned.
#[derive(Clone, Copy, Debug)]
pub struct Knob {
    /// Its name in study files, in `--knob NAME=VALUE` and in a picture's provenance.
    pub name: &'static str,
    /// Its unit; empty for a number of things, which `about` names, and for words.
    pub unit: &'static str,
    /// What it may be.
    pub range: Range,
    /// What it does, in a line.
    pub about: &'static str,
}

impl Knob {
    /// Why it cannot stand at `value`, if it cannot.
    pub fn wrong(&self, value: &Value) -> Option<String> {
        (!self.range.holds(value)).then(|| format!("{} = {value}: must be {}", self.name, self.range))
    }
}

/// Of techniques with shadow maps.
pub const MAP_SIZE: Knob = Knob {
    name: "map_size",
    unit: "samples",
    range: Range::Whole(16, 8192),
    about: "samples a side of a shadow map: of the lamp's (pa, variant shadow-map) or of each puppet's (pcss)",
};

/// Of techniques that sample.
pub const SEED: Knob = Knob {
    name: "seed",
    unit: "",
    range: Range::Whole(0, u64::MAX),
    about: "seed of the sample points: same seed and count, same bytes",
};

/// What a knob may be; displayed as the words after "must be".
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// A whole number, both ends included.
    Whole(u64, u64),
    /// A square number, likewise.
    Square(u64, u64),
    /// A finite number.
    Number(Bound<f64>, Bound<f64>),
    /// One of these words.
    Word(&'static [&'static str]),
    /// True or false.
    Flag,
}

impl Range {
    fn holds(&self, value: &Value) -> bool {
        let whole = |from: u64, to: u64| value.as_u64().filter(|n| (from..=to).contains(n));
        match *self {
            Self::Whole(from, to) => whole(from, to).is_some(),
            Self::Square(from, to) => whole(from, to).is_some_and(|n| n.isqrt().pow(2) == n),
            Self::Number(from, to) => {
                value.as_f64().is_some_and(|x| x.is_finite() && (from, to).contains(&x))
            }
            Self::Word(words) => value.as_str().is_some_and(|word| words.contains(&word)),
            Self::Flag => value.is_boolean(),
        }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Whole(0, u64::MAX) => f.write_str("a whole number"),
            Self::Whole(from, to) => write!(f, "a whole number from {from} to {to}"),
            Self::Square(from, to) => write!(f, "a square number from {from} to {to}"),
            Self::Number(from, to) => {
                let from = match from {
                    Bound::Included(from) => Some(format!("from {from}")),
                    Bound::Excluded(from) => Some(format!("above {from}")),
                    Bound::Unbounded => None,
                };
                let to = match to {
                    Bound::Included(to) => Some(format!("up to {to}")),
                    Bound::Excluded(to) => Some(format!("below {to}")),
                    Bound::Unbounded => None,
                };
                let ends: Vec<String> = from.into_iter().chain(to).collect();
                write!(f, "a number {}", ends.join(" and "))
            }
            Self::Word(words) => write!(f, "one of {}", list(words)),
            Self::Flag => f.write_str("true or false"),
        }
    }
}

/// Checks what a technique's knobs stand at.
///
/// # Errors
/// [`RenderError::Knob`]: every knob that is out of its range, with its value and its rule.
pub fn check(knobs: &[Knob], stand: &impl Serialize) -> Result<(), RenderError> {
    let stand = serde_json::to_value(stand).unwrap_or_default();
    told(stand.as_object().into_iter().flatten().filter_map(|(name, value)| {
        let knob = knobs.iter().find(|knob| knob.name == name)?;
        // JSON has null for a number that is not finite.
        let not_finite = || format!("{name} is not a finite number: must be {}", knob.range);
        if value.is_null() { Some(not_finite()) } else { knob.wrong(value) }
    }))
}

/// Errors: these problems, in one message.
pub fn told(problems: impl Iterator<Item = String>) -> Result<(), RenderError> {
    let problems: Vec<String> = problems.collect();
    if problems.is_empty() { Ok(()) } else { Err(RenderError::Knob(problems.join("; "))) }
}
