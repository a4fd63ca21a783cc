//! A JSON value held to a schema.

use super::{FieldError, Record, escaped, list, words};
use serde_json::{Map, Value};

/// A walk through a value beside its schema. What is right costs no memory: places and rules are put into words where something is wrong.
pub(super) struct Check<'a> {
    record: &'a Record,
    /// The names down to where the walk is.
    place: Vec<Step<'a>>,
    /// What is wrong; `None` where it only matters whether anything is.
    told: Option<Vec<FieldError>>,
    wrong: bool,
}

enum Step<'a> {
    Field(&'a str),
    Item(usize),
}

impl<'a> Check<'a> {
    /// Everything in `value` that the record's schema does not allow.
    pub(super) fn of(record: &'a Record, value: &'a Value) -> Vec<FieldError> {
        let mut check = Check { record, place: Vec::new(), told: Some(Vec::new()), wrong: false };
        check.value(&record.schema, value);
        check.told.unwrap_or_default()
    }

    /// Checks `value` and all below it; a value that is wrong in itself is told once, and what is in it is not looked at.
    fn value(&mut self, schema: &'a Value, value: &'a Value) {
        if !self.fits(schema, value) {
            return self.breach(schema, value, |record| format!("must be {}", record.words(schema)));
        }
        let composed = |rules: &Map<String, Value>| {
            rules.keys().any(|key| matches!(key.as_str(), "$ref" | "allOf" | "anyOf" | "oneOf"))
        };
        if schema.as_object().is_some_and(composed) {
            if let Some(target) = schema.get("$ref").map(|_| self.record.resolve(schema)) {
                self.value(target, value);
            }
            for part in list(schema, "allOf") {
                self.value(part, value);
            }
            self.alternatives(schema, value);
        }
        match value {
            Value::Object(object) => self.object(schema, object),
            Value::Array(items) => self.items(schema, items),
            _ => {}
        }
    }

    /// Whether the value itself, apart from what is in it, is allowed.
    fn fits(&self, schema: &Value, value: &Value) -> bool {
        let Value::Object(rules) = schema else { return *schema != Value::Bool(false) };
        rules.iter().all(|(key, rule)| match (key.as_str(), value) {
            ("type", _) => match rule {
                Value::Array(types) => types.iter().any(|one| is_of_type(one, value)),
                one => is_of_type(one, value),
            },
            ("enum", _) => rule.as_array().is_none_or(|allowed| allowed.iter().any(|one| same(one, value))),
            ("const", _) => same(rule, value),
            ("minimum", Value::Number(_)) => value.as_f64() >= rule.as_f64(),
            ("maximum", Value::Number(_)) => value.as_f64() <= rule.as_f64(),
            ("exclusiveMinimum", Value::Number(_)) => value.as_f64() > rule.as_f64(),
            ("exclusiveMaximum", Value::Number(_)) => value.as_f64() < rule.as_f64(),
            ("minLength", Value::String(text)) => text.chars().count() as u64 >= count(rule),
            ("maxLength", Value::String(text)) => text.chars().count() as u64 <= count(rule),
            ("minItems", Value::Array(items)) => items.len() as u64 >= count(rule),
            ("maxItems", Value::Array(items)) => items.len() as u64 <= count(rule),
            ("minProperties", Value::Object(object)) => object.len() as u64 >= count(rule),
            ("maxProperties", Value::Object(object)) => object.len() as u64 <= count(rule),
            _ => true,
        })
    }

    /// `anyOf` and `oneOf`. Where all but one alternative is null, what is wrong is told of that one's inside.
    fn alternatives(&mut self, schema: &'a Value, value: &'a Value) {
        for (key, most) in [("anyOf", usize::MAX), ("oneOf", 1)] {
            let parts = list(schema, key);
            let fitting = parts.iter().filter(|part| self.is_right(part, value)).count();
            if parts.is_empty() || (1..=most).contains(&fitting) {
                continue;
            }
            let not_null: Vec<&Value> = parts.iter().filter(|part| part["type"] != "null").collect();
            match not_null[..] {
                [only] if fitting == 0 && only_null_beside(parts) => self.value(only, value),
                _ if fitting == 0 => {
                    self.breach(schema, value, |record| format!("must be {}", record.words(schema)));
                }
                _ => self
                    .breach(schema, value, |record| format!("must be only one of: {}", record.words(schema))),
            }
        }
    }

    fn is_right(&self, schema: &Value, value: &Value) -> bool {
        let mut inner = Check { record: self.record, place: Vec::new(), told: None, wrong: false };
        inner.value(schema, value);
        !inner.wrong
    }

    fn object(&mut self, schema: &'a Value, object: &'a Map<String, Value>) {
        let properties = schema["properties"].as_object();
        let property = |name: &str| properties.and_then(|known| known.get(name));
        for name in list(schema, "required").iter().filter_map(Value::as_str) {
            if !object.contains_key(name) {
                self.below(Step::Field(name), |at| {
                    at.tell(|record| {
                        let rule = match property(name) {
                            Some(schema) => format!("must be given: {}", record.words(schema)),
                            None => "must be given".to_owned(),
                        };
                        (None, rule)
                    });
                });
            }
        }
        for (name, value) in object {
            self.below(Step::Field(name), |at| {
                if let Some(names) = schema.get("propertyNames")
                    && !at.is_right(names, &Value::from(name.as_str()))
                {
                    at.breach(names, value, |record| {
                        format!("has a name that must be {}", record.words(names))
                    });
                }
                match (property(name), schema.get("additionalProperties")) {
                    (Some(schema), _) => at.value(schema, value),
                    (None, Some(Value::Bool(false))) => {
                        at.breach(schema, value, |_| {
                            let known: Vec<&str> =
                                properties.into_iter().flatten().map(|(name, _)| name.as_str()).collect();
                            format!("is not known here; known are {}", known.join(", "))
                        });
                    }
                    (None, Some(schema)) => at.value(schema, value),
                    (None, None) => {}
                }
            });
        }
    }

    fn items(&mut self, schema: &'a Value, items: &'a [Value]) {
        let first = list(schema, "prefixItems");
        for (index, item) in items.iter().enumerate() {
            if let Some(schema) = first.get(index).or_else(|| schema.get("items")) {
                self.below(Step::Item(index), |at| at.value(schema, item));
            }
        }
    }

    /// Walks on one level down.
    fn below(&mut self, step: Step<'a>, walk: impl FnOnce(&mut Self)) {
        self.place.push(step);
        walk(self);
        self.place.pop();
    }

    fn breach(&mut self, schema: &Value, value: &Value, rule: impl FnOnce(&Record) -> String) {
        self.tell(|record| ((schema["writeOnly"] != true).then(|| words::shortened(value)), rule(record)));
    }

    /// Something is wrong here; what was found and the rule are asked for only where they are told.
    fn tell(&mut self, what: impl FnOnce(&Record) -> (Option<Value>, String)) {
        self.wrong = true;
        if let Some(told) = &mut self.told {
            let (value, rule) = what(self.record);
            told.push(FieldError { pointer: self.place.iter().map(Step::pointer).collect(), value, rule });
        }
    }
}

impl Step<'_> {
    /// As a JSON Pointer has it.
    fn pointer(&self) -> String {
        match self {
            Step::Field(name) => format!("/{}", escaped(name)),
            Step::Item(index) => format!("/{index}"),
        }
    }
}

fn only_null_beside(parts: &[Value]) -> bool {
    parts.iter().filter(|part| part["type"] == "null").count() + 1 == parts.len()
}

fn count(rule: &Value) -> u64 {
    rule.as_u64().unwrap_or_default()
}

fn is_of_type(name: &Value, value: &Value) -> bool {
    match (name.as_str().unwrap_or_default(), value) {
        ("null", Value::Null) | ("boolean", Value::Bool(_)) | ("number", Value::Number(_)) => true,
        ("string", Value::String(_)) | ("array", Value::Array(_)) | ("object", Value::Object(_)) => true,
        // 2.0 is a whole number, however it is written.
        ("integer", Value::Number(number)) => {
            !number.is_f64() || number.as_f64().is_some_and(|x| x.fract() == 0.0)
        }
        _ => false,
    }
}

/// Equality of JSON values: 1 is 1.0.
fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(_), Value::Number(_)) => a.as_f64() == b.as_f64(),
        _ => a == b,
    }
}
