//! Schemas in words: what follows "must be".

use super::{Record, list};
use serde_json::Value;

/// A text in an error is cut after so many characters; a list or an object of more bytes is only counted.
const LONGEST: usize = 100;

impl Record {
    /// What a value of it must be, such as `a number from 0 to 100`.
    pub fn in_words(&self) -> String {
        self.words(&self.schema)
    }

    pub(super) fn words(&self, schema: &Value) -> String {
        let schema = self.resolve(schema);
        if let Some(only) = schema.get("const") {
            return only.to_string();
        }
        if let Some(allowed) = schema["enum"].as_array() {
            return one_of(allowed.iter().map(Value::to_string).collect());
        }
        let alternatives = [list(schema, "oneOf"), list(schema, "anyOf")].concat();
        if !alternatives.is_empty() {
            return one_of(alternatives.iter().map(|schema| self.words(schema)).collect());
        }
        let types = match &schema["type"] {
            Value::Array(types) => types.iter().filter_map(Value::as_str).collect(),
            one => Vec::from_iter(one.as_str()),
        };
        match (types.is_empty(), list(schema, "allOf").first()) {
            (false, _) => one_of(types.into_iter().map(|name| of_type(name, schema)).collect()),
            (true, Some(first)) => self.words(first),
            (true, None) => "anything".to_owned(),
        }
    }
}

fn of_type(name: &str, schema: &Value) -> String {
    match name {
        "number" => format!("a number{}", range(schema)),
        "integer" => format!("a whole number{}", range(schema)),
        "string" => format!("a text{}", length(schema, "Length", "character")),
        "boolean" => "true or false".to_owned(),
        "array" => format!("a list{}", length(schema, "Items", "item")),
        "object" => format!("an object{}", length(schema, "Properties", "key")),
        other => other.to_owned(),
    }
}

fn range(schema: &Value) -> String {
    let bound = |key: &str| schema.get(key).and_then(Value::as_f64);
    let low = bound("minimum").map(|low| format!(" from {low}"));
    let low = low.or_else(|| bound("exclusiveMinimum").map(|low| format!(" above {low}")));
    let high = bound("maximum").map(|high| format!(" to {high}"));
    let high = high.or_else(|| bound("exclusiveMaximum").map(|high| format!(" below {high}")));
    match (low, high) {
        (None, Some(high)) => high.replace(" to ", " up to "),
        (low, high) => low.unwrap_or_default() + &high.unwrap_or_default(),
    }
}

fn length(schema: &Value, of: &str, unit: &str) -> String {
    let bound = |end: &str| schema.get(format!("{end}{of}")).and_then(Value::as_u64);
    let units = |n: u64| format!("{n} {unit}{}", if n == 1 { "" } else { "s" });
    match (bound("min").filter(|least| *least > 0), bound("max")) {
        (None, None) => String::new(),
        (Some(least), None) => format!(" of at least {}", units(least)),
        (None, Some(most)) => format!(" of at most {}", units(most)),
        (Some(least), Some(most)) if least == most => format!(" of {}", units(most)),
        (Some(least), Some(most)) => format!(" of {least} to {}", units(most)),
    }
}

/// `a`, `a or b`, `a, b or c`; each once.
fn one_of(mut words: Vec<String>) -> String {
    let mut seen = std::collections::HashSet::new();
    words.retain(|word| seen.insert(word.clone()));
    match (words.pop(), words.is_empty()) {
        (Some(last), false) => format!("{} or {last}", words.join(", ")),
        (last, _) => last.unwrap_or_else(|| "nothing".to_owned()),
    }
}

/// A value as an error shows it.
pub(super) fn shortened(value: &Value) -> Value {
    match value {
        Value::String(text) if text.chars().count() > LONGEST => {
            let start: String = text.chars().take(LONGEST).collect();
            format!("{start}…").into()
        }
        Value::Array(items) if value.to_string().len() > LONGEST => {
            format!("a list of {} items", items.len()).into()
        }
        Value::Object(object) if value.to_string().len() > LONGEST => {
            format!("an object of {} keys", object.len()).into()
        }
        value => value.clone(),
    }
}
