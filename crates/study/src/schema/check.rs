//! A JSON value held to a schema.

use super::{FieldError, Record, escaped, list, words};
use serde_json::{Map, Value};

/// A walk through a value beside its schema.
pub(super) struct Check<'a> {
    record: &'a Record,
    pointer: String,
    found: Vec<FieldError>,
}

impl Check<'_> {
    /// Everything in `value` that the record's schema does not allow.
    pub(super) fn of(record: &Record, value: &Value) -> Vec<FieldError> {
        let mut check = Check { record, pointer: String::new(), found: Vec::new() };
        check.value(&record.schema, value);
        check.found
    }

    /// Checks `value` and all below it; a value that is wrong in itself is told once, and what is in it is not looked at.
    fn value(&mut self, schema: &Value, value: &Value) {
        if !self.fits(schema, value) {
            return self.breach(schema, value, format!("must be {}", self.record.words(schema)));
        }
        if let Some(target) = schema.get("$ref").map(|_| self.record.resolve(schema)) {
            self.value(target, value);
        }
        for part in list(schema, "allOf") {
            self.value(part, value);
        }
        self.alternatives(schema, value);
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
    fn alternatives(&mut self, schema: &Value, value: &Value) {
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
                    self.breach(schema, value, format!("must be {}", self.record.words(schema)))
                }
                _ => {
                    self.breach(schema, value, format!("must be only one of: {}", self.record.words(schema)));
                }
            }
        }
    }

    fn is_right(&self, schema: &Value, value: &Value) -> bool {
        let mut inner = Check { record: self.record, pointer: String::new(), found: Vec::new() };
        inner.value(schema, value);
        inner.found.is_empty()
    }

    fn object(&mut self, schema: &Value, object: &Map<String, Value>) {
        let properties = schema["properties"].as_object();
        let property = |name: &str| properties.and_then(|known| known.get(name));
        for name in list(schema, "required").iter().filter_map(Value::as_str) {
            if !object.contains_key(name) {
                let rule = match property(name) {
                    Some(schema) => format!("must be given: {}", self.record.words(schema)),
                    None => "must be given".to_owned(),
                };
                self.below(name, |at| {
                    at.found.push(FieldError { pointer: at.pointer.clone(), value: None, rule })
                });
            }
        }
        for (name, value) in object {
            self.below(name, |at| {
                if let Some(names) = schema.get("propertyNames")
                    && !at.is_right(names, &Value::from(name.as_str()))
                {
                    let rule = format!("has a name that must be {}", at.record.words(names));
                    at.breach(names, value, rule);
                }
                match (property(name), schema.get("additionalProperties")) {
                    (Some(schema), _) => at.value(schema, value),
                    (None, Some(Value::Bool(false))) => {
                        let known: Vec<&str> =
                            properties.into_iter().flatten().map(|(name, _)| name.as_str()).collect();
                        at.breach(
                            schema,
                            value,
                            format!("is not known here; known are {}", known.join(", ")),
                        );
                    }
                    (None, Some(schema)) => at.value(schema, value),
                    (None, None) => {}
                }
            });
        }
    }

    fn items(&mut self, schema: &Value, items: &[Value]) {
        let first = list(schema, "prefixItems");
        for (index, item) in items.iter().enumerate() {
            if let Some(schema) = first.get(index).or_else(|| schema.get("items")) {
                self.below(&index.to_string(), |at| at.value(schema, item));
            }
        }
    }

    /// Runs `step` one level down, at `name`.
    fn below(&mut self, name: &str, step: impl FnOnce(&mut Self)) {
        let before = self.pointer.len();
        self.pointer.push('/');
        self.pointer.push_str(&escaped(name));
        step(self);
        self.pointer.truncate(before);
    }

    fn breach(&mut self, schema: &Value, value: &Value, rule: String) {
        let value = (schema["writeOnly"] != true).then(|| words::shortened(value));
        self.found.push(FieldError { pointer: self.pointer.clone(), value, rule });
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
