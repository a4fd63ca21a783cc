//! A technique from its name and what is turned on it, and what of that cannot be.

use std::collections::BTreeMap;

use kelir_frame::RenderError;
use kelir_frame::knobs::told;
pub use kelir_frame::knobs::{Knob, Range};
use kelir_reader::{did_you_mean, list};
use serde_json::{Map, Value};

use super::Technique;

impl Technique {
    /// One of each, with its knobs as they stand when nobody turns one.
    pub fn all() -> [Technique; 6] {
        [
            Self::Pa(Default::default()),
            Self::Mc(Default::default()),
            Self::Points(Default::default()),
            Self::Pcss(Default::default()),
            Self::Oracle(Default::default()),
            Self::Raytrace(Default::default()),
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
                Some(knob) => knob.wrong(value),
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

    use std::ops::Bound;

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
        assert!(seed.starts_with("seed = 1: is a knob of mc, pcss and raytrace, not of points; "), "{seed}");
        let close = said("mc", json!({ "ssp": 64 }));
        assert!(
            close.starts_with("ssp = 64: mc has no such knob (did you mean spp?); mc has spp, "),
            "{close}"
        );
        assert_eq!(
            said("pcs", json!({})),
            "technique = \"pcs\": must be one of pa, mc, points, pcss, oracle and raytrace (did you mean pcss?)"
        );
        // Every problem at once.
        let both = said("pa", json!({ "split": 1000, "map_size": 1 }));
        assert_eq!(
            both,
            "map_size = 1: must be a whole number from 16 to 8192; split = 1000: must be a whole number from 1 to 64"
        );
    }
}
