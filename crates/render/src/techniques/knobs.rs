//! Knobs: what can be turned on a technique, each said once. Study files, the command line, the tables and every message are made of these.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Bound, RangeBounds};

use kelir_reader::{did_you_mean, list};
use serde::Serialize;
use serde_json::{Map, Value};

use super::Technique;
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

/// Of techniques with shadow maps.
pub(crate) const MAP_SIZE: Knob = Knob {
    name: "map_size",
    unit: "samples",
    range: Range::Whole(16, 8192),
    about: "samples a side of a shadow map: of the lamp's (pa, variant shadow-map) or of each puppet's (pcss)",
};

/// Of techniques that sample.
pub(crate) const SEED: Knob = Knob {
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
pub(crate) fn check(knobs: &[Knob], stand: &impl Serialize) -> Result<(), RenderError> {
    let stand = serde_json::to_value(stand).unwrap_or_default();
    told(stand.as_object().into_iter().flatten().filter_map(|(name, value)| {
        let knob = knobs.iter().find(|knob| knob.name == name)?;
        // JSON has null for a number that is not finite.
        let not_finite = || format!("{name} is not a finite number: must be {}", knob.range);
        if value.is_null() { Some(not_finite()) } else { wrong(knob, value) }
    }))
}

fn wrong(knob: &Knob, value: &Value) -> Option<String> {
    (!knob.range.holds(value)).then(|| format!("{} = {value}: must be {}", knob.name, knob.range))
}

fn told(problems: impl Iterator<Item = String>) -> Result<(), RenderError> {
    let problems: Vec<String> = problems.collect();
    if problems.is_empty() { Ok(()) } else { Err(RenderError::Knob(problems.join("; "))) }
}

impl Technique {
    /// One of each, with its knobs as they stand when nobody turns one.
    pub fn all() -> [Technique; 5] {
        [
            Self::Pa(Default::default()),
            Self::Mc(Default::default()),
            Self::Points(Default::default()),
            Self::Pcss(Default::default()),
            Self::Oracle(Default::default()),
        ]
    }

    /// The technique of this name with these knobs turned, the others as in [`Technique::all`].
    ///
    /// # Errors
    /// [`RenderError::Knob`]: there is none of this name; every knob that it does not have or that is out of its range.
    pub fn parse(name: &str, turned: &BTreeMap<String, Value>) -> Result<Technique, RenderError> {
        let all = Technique::all();
        let names = all.each_ref().map(Technique::name);
        let Some(technique) = all.iter().find(|technique| technique.name() == name) else {
            let rule = format!("must be one of {}{}", list(&names), did_you_mean(name, &names));
            return Err(RenderError::Knob(format!("technique = {name:?}: {rule}")));
        };
        let knobs = technique.knobs();
        told(turned.iter().filter_map(
            |(turned, value)| match knobs.iter().find(|knob| knob.name == turned) {
                Some(knob) => wrong(knob, value),
                None => Some(format!("{turned} = {value}: {}", no_knob(&all, technique, turned))),
            },
        ))?;
        let mut object: Map<String, Value> = turned.clone().into_iter().collect();
        object.insert("technique".to_owned(), Value::from(name));
        serde_json::from_value(Value::Object(object)).map_err(|error| RenderError::Knob(error.to_string()))
    }

    /// What its knobs stand at, by name; without those that stand nowhere, as a target that is not asked for.
    pub fn stand(&self) -> Map<String, Value> {
        let mut stand = match serde_json::to_value(self) {
            Ok(Value::Object(stand)) => stand,
            _ => Map::new(),
        };
        stand.remove("technique");
        stand
    }
}

/// Why a technique has no such knob, and which it has.
fn no_knob(all: &[Technique], technique: &Technique, name: &str) -> String {
    let owners: Vec<&str> =
        all.iter().filter(|t| t.knobs().iter().any(|knob| knob.name == name)).map(Technique::name).collect();
    let known: Vec<&str> = technique.knobs().iter().map(|knob| knob.name).collect();
    let of = if owners.is_empty() {
        format!("{} has no such knob{}", technique.name(), did_you_mean(name, &known))
    } else {
        format!("is a knob of {}, not of {}", list(&owners), technique.name())
    };
    format!("{of}; {} has {}", technique.name(), list(&known))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use serde_json::json;

    use super::*;

    fn turned(name: &str, knobs: &Value) -> Result<Technique, String> {
        let knobs = serde_json::from_value(knobs.clone()).unwrap();
        Technique::parse(name, &knobs).map_err(|error| error.to_string())
    }

    /// Values inside and outside a range, its ends among them.
    fn tries(range: Range) -> (Vec<Value>, Vec<Value>) {
        let strange = vec![json!(null), json!([1]), json!("many"), json!(-1)];
        let (inside, outside) = match range {
            Range::Whole(from, u64::MAX) => (vec![json!(from), json!(u64::MAX)], vec![json!(1.5)]),
            Range::Whole(from, to) => {
                (vec![json!(from), json!(to)], vec![json!(from.wrapping_sub(1)), json!(to + 1), json!(1.5)])
            }
            Range::Square(from, to) => (vec![json!(from), json!(to)], vec![json!(from + 1), json!(0)]),
            Range::Number(from, to) => {
                let end = |bound: Bound<f64>, inwards: f64| match bound {
                    Bound::Included(x) => (Some(json!(x)), Some(json!(x - inwards))),
                    Bound::Excluded(x) => (Some(json!(x + inwards)), Some(json!(x))),
                    Bound::Unbounded => (None, None),
                };
                let ((a, below), (b, above)) = (end(from, 1e-3), end(to, -1e-3));
                (a.into_iter().chain(b).collect(), below.into_iter().chain(above).collect())
            }
            Range::Word(words) => (words.iter().map(|word| json!(word)).collect(), vec![json!(words.len())]),
            Range::Flag => (vec![json!(true), json!(false)], vec![json!("true")]),
        };
        (inside, [outside, strange].concat())
    }

    #[test]
    fn every_knob_can_be_turned_within_its_range_alone() {
        for technique in Technique::all() {
            let name = technique.name();
            for knob in technique.knobs() {
                let (inside, outside) = tries(knob.range);
                for value in inside {
                    let drawn = turned(name, &json!({ knob.name: value })).unwrap();
                    assert_eq!(drawn.stand()[knob.name], value, "{name}: {}", knob.name);
                    drawn.check().unwrap();
                }
                for value in outside {
                    let said = turned(name, &json!({ knob.name: value })).unwrap_err();
                    let expected = format!("{} = {value}: must be {}", knob.name, knob.range);
                    assert_eq!(said, expected, "{name}");
                }
            }
        }
    }

    /// Tables and structs have the same names, and one name means one thing wherever it stands.
    #[test]
    fn tables_are_whole() {
        let mut ranges: BTreeMap<&str, (Range, &str)> = BTreeMap::new();
        for technique in Technique::all() {
            let names: Vec<&str> = technique.knobs().iter().map(|knob| knob.name).collect();
            for stands in technique.stand().keys() {
                assert!(
                    names.contains(&stands.as_str()),
                    "{}: {stands} stands in no table",
                    technique.name()
                );
            }
            technique.check().unwrap();
            for knob in technique.knobs() {
                let known = ranges.insert(knob.name, (knob.range, knob.unit));
                assert!(known.is_none_or(|known| known == (knob.range, knob.unit)), "{}", knob.name);
            }
        }
    }

    #[test]
    fn what_is_not_there_is_told_with_what_is() {
        let said = |name, knobs| turned(name, &knobs).unwrap_err();
        assert_eq!(
            said("pa", json!({ "lights": 7 })),
            "lights = 7: is a knob of points, not of pa; pa has split, weights, strips, variant, map_size and dome_steps"
        );
        let seed = said("points", json!({ "seed": 1 }));
        assert!(seed.starts_with("seed = 1: is a knob of mc and pcss, not of points; "), "{seed}");
        let close = said("mc", json!({ "ssp": 64 }));
        assert!(
            close.starts_with("ssp = 64: mc has no such knob (did you mean spp?); mc has spp, "),
            "{close}"
        );
        assert_eq!(
            said("pcs", json!({})),
            "technique = \"pcs\": must be one of pa, mc, points, pcss and oracle (did you mean pcss?)"
        );
        // Every problem at once.
        let both = said("pa", json!({ "split": 1000, "map_size": 1 }));
        assert_eq!(
            both,
            "map_size = 1: must be a whole number from 16 to 8192; split = 1000: must be a whole number from 1 to 64"
        );
    }
}
