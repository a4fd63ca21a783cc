//! Records that say of themselves what they are: a Rust type's JSON schema, used to check what came in and to write codebooks.
//!
//! A type that derives [`ToSchema`] states each field's range, length, unit (`x-unit`) and meaning once. [`Record`] is that statement,
//! read: [`Record::check`] names every breach of it in a JSON value, [`Record::columns`] lists its fields for a codebook.

mod check;
mod columns;
mod worded;
mod words;

pub use crate::worded;
use check::Check;
pub use columns::{Column, Meaning};

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::any::TypeId;
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{LazyLock, PoisonError, RwLock};
use utoipa::ToSchema;
use utoipa::openapi::{RefOr, Schema};

/// One thing that is wrong with a JSON value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct FieldError {
    /// Where: a JSON Pointer (RFC 6901); empty for the whole.
    pub pointer: String,
    /// What was found there, long texts cut; absent where the field is missing, or secret.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<Value>,
    /// The rule that it breaks, as words that follow the field's name.
    pub rule: String,
}

impl FieldError {
    /// What is wrong with a field at the top, or with a parameter.
    pub fn at(name: &str, value: impl Into<Value>, rule: impl Into<String>) -> FieldError {
        let value = Some(words::shortened(&value.into()));
        FieldError { pointer: format!("/{}", escaped(name)), value, rule: rule.into() }
    }
}

/// A name as a JSON Pointer has it.
fn escaped(name: &str) -> String {
    name.replace('~', "~0").replace('/', "~1")
}

/// What can be used of a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Sound<'a> {
    /// The value, with null in place of each part that breaks a rule.
    pub value: Cow<'a, Value>,
    /// The fields at the top that break a rule, or have a part that does, in the order of the check; an empty name is the value itself.
    pub broken: Vec<String>,
}

/// A schema with the schemas that it names.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    schema: Value,
    components: Map<String, Value>,
}

impl Record {
    /// What `T` says of itself.
    pub fn of<T: ToSchema>() -> Record {
        let mut components = Vec::new();
        T::schemas(&mut components);
        Record::new(&T::schema(), components)
    }

    /// The same, made once for as long as the process runs: for what is asked of every request.
    pub fn shared<T: ToSchema + 'static>() -> &'static Record {
        static MADE: LazyLock<RwLock<HashMap<TypeId, &'static Record>>> = LazyLock::new(RwLock::default);
        let of = TypeId::of::<T>();
        if let Some(made) = MADE.read().unwrap_or_else(PoisonError::into_inner).get(&of) {
            return made;
        }
        let record = Box::leak(Box::new(Record::of::<T>()));
        MADE.write().unwrap_or_else(PoisonError::into_inner).entry(of).or_insert(record)
    }

    /// A schema and the components by which its `$ref`s are resolved.
    pub fn new(
        schema: &RefOr<Schema>,
        components: impl IntoIterator<Item = (String, RefOr<Schema>)>,
    ) -> Record {
        let components = components.into_iter().map(|(name, schema)| (name, json(&schema)));
        Record { schema: json(schema), components: components.collect() }
    }

    /// A JSON schema as it is, and the components by which its `$ref`s are resolved.
    pub fn of_json(schema: Value, components: Map<String, Value>) -> Record {
        Record { schema, components }
    }

    /// Everything in `value` that the schema does not allow, in the order of the schema's walk; empty when all is right.
    ///
    /// JSON Schema 2020-12, the part of it that Rust types come to: `type`, `enum`, `const`, bounds of numbers, lengths of texts (in
    /// characters), lists, objects, `allOf`, `anyOf`, `oneOf`, `$ref`. [`Record::unsupported`] names what else a schema holds.
    pub fn check(&self, value: &Value) -> Vec<FieldError> {
        Check::of(self, value)
    }

    /// What can be used of a value that came from outside: every part that breaks a rule is null in it.
    pub fn sound<'a>(&self, value: &'a Value) -> Sound<'a> {
        let (found, mut value, mut broken) = (self.check(value), Cow::Borrowed(value), Vec::new());
        for FieldError { pointer, .. } in found {
            if let Some(part) = value.to_mut().pointer_mut(&pointer) {
                *part = Value::Null;
            }
            let field = pointer.split('/').nth(1).unwrap_or_default().replace("~1", "/").replace("~0", "~");
            if !broken.contains(&field) {
                broken.push(field);
            }
        }
        Sound { value, broken }
    }

    /// Keywords of the schema that [`Record::check`] does not hold a value to, sorted.
    pub fn unsupported(&self) -> Vec<String> {
        let mut found = std::collections::BTreeSet::new();
        std::iter::once(&self.schema).chain(self.components.values()).for_each(|s| unchecked(s, &mut found));
        found.into_iter().collect()
    }

    /// The schema behind a chain of `$ref`s.
    fn resolve<'a>(&'a self, mut schema: &'a Value) -> &'a Value {
        // A chain longer than there are components goes round.
        for _ in 0..=self.components.len() {
            let name = schema.get("$ref").and_then(Value::as_str).and_then(|path| path.rsplit('/').next());
            match name.and_then(|name| self.components.get(name)) {
                Some(next) => schema = next,
                None => break,
            }
        }
        schema
    }
}

fn json(schema: &RefOr<Schema>) -> Value {
    serde_json::to_value(schema).expect("a schema is made of texts, numbers and lists")
}

/// Keywords that constrain nothing, or that [`Check`] knows.
const KNOWN: &str = " $ref type enum const minimum maximum exclusiveMinimum exclusiveMaximum minLength maxLength items prefixItems minItems \
    maxItems properties required additionalProperties propertyNames minProperties maxProperties allOf anyOf oneOf \
    title description summary format default example examples deprecated readOnly writeOnly discriminator xml ";

fn unchecked(schema: &Value, found: &mut std::collections::BTreeSet<String>) {
    let Value::Object(schema) = schema else { return };
    for (key, part) in schema {
        match (key.as_str(), part) {
            ("properties", Value::Object(properties)) => {
                properties.values().for_each(|property| unchecked(property, found));
            }
            ("allOf" | "anyOf" | "oneOf" | "prefixItems", Value::Array(parts)) => {
                parts.iter().for_each(|part| unchecked(part, found));
            }
            ("items" | "additionalProperties" | "propertyNames", part) => unchecked(part, found),
            (key, _) if key.starts_with("x-") || KNOWN.contains(&format!(" {key} ")) => {}
            (key, _) => drop(found.insert(key.to_owned())),
        }
    }
}

fn list<'a>(schema: &'a Value, key: &str) -> &'a [Value] {
    schema.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

#[cfg(test)]
mod tests;
