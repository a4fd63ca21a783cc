//! A record's fields as a codebook lists them.

use super::{Record, list};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use utoipa::ToSchema;

/// A column of a table, or a field of a record.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// `text`, `number`, `integer`, `boolean`, `list` or `object`.
    pub kind: String,
    /// Unit of its numbers; empty: none.
    pub unit: String,
    /// What it says.
    pub meaning: String,
    /// The values that it can have; empty: any of its kind.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(required = false)]
    pub values: Vec<Meaning>,
}

/// What one value of a column means.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Meaning {
    /// The value.
    pub value: String,
    /// What it means; empty where the value says it.
    pub meaning: String,
}

impl Record {
    /// The record's fields, by name; a field that is a record itself comes as its own fields, each named `field.inner`.
    ///
    /// The unit is the extension `x-unit`; the meaning is the description, of the field or else of its type.
    pub fn columns(&self) -> Vec<Column> {
        let mut columns = Vec::new();
        self.fields(&self.schema, ["", ""], &mut columns);
        columns
    }

    /// `outer`: name and meaning of the field that these are within.
    fn fields(&self, schema: &Value, outer: [&str; 2], columns: &mut Vec<Column>) {
        let mut properties = Map::new();
        self.properties(schema, &mut properties);
        for (name, field) in properties {
            let name = if outer[0].is_empty() { name } else { format!("{}.{name}", outer[0]) };
            let layers = self.layers(&field);
            let inner = layers.last().copied().unwrap_or(&field);
            let mut below = Map::new();
            self.properties(inner, &mut below);
            let said = |key: &str| {
                layers.iter().find_map(|layer| layer.get(key)?.as_str()).unwrap_or_default().to_owned()
            };
            let meaning = match outer[1] {
                "" => said("description"),
                of => format!("{} {}", of, said("description")),
            };
            if !below.is_empty() {
                self.fields(inner, [&name, &meaning], columns);
                continue;
            }
            columns.push(Column {
                name,
                kind: kind(inner).to_owned(),
                unit: said("x-unit"),
                meaning,
                values: values(inner),
            });
        }
    }

    /// The properties of an object, those of its `allOf` parts among them.
    fn properties(&self, schema: &Value, into: &mut Map<String, Value>) {
        let schema = self.resolve(schema);
        list(schema, "allOf").iter().for_each(|part| self.properties(part, into));
        into.extend(schema["properties"].as_object().cloned().unwrap_or_default());
    }

    /// A field's schema from the outside in: behind references, and without the alternative of being null. What is said further out
    /// counts.
    fn layers<'a>(&'a self, schema: &'a Value) -> Vec<&'a Value> {
        let mut layers = vec![schema];
        let mut inner = schema;
        loop {
            let mut parts = list(inner, "oneOf").iter().filter(|part| part["type"] != "null");
            let next = match (parts.next(), parts.next()) {
                (Some(only), None) => only,
                _ => self.resolve(inner),
            };
            if std::ptr::eq(next, inner) || layers.len() > 2 * self.components.len() + 8 {
                return layers;
            }
            layers.push(next);
            inner = next;
        }
    }
}

fn kind(schema: &Value) -> &'static str {
    let types = match &schema["type"] {
        Value::Array(types) => types.iter().find(|name| *name != "null").and_then(Value::as_str),
        one => one.as_str(),
    };
    match types {
        Some("number") => "number",
        Some("integer") => "integer",
        Some("boolean") => "boolean",
        Some("array") => "list",
        Some("object") => "object",
        _ => "text",
    }
}

/// An enum's values: of `enum`, or of a `oneOf` of constants, each with its description.
fn values(schema: &Value) -> Vec<Meaning> {
    let of = |value: &Value, meaning: &Value| Meaning {
        value: value.as_str().map_or_else(|| value.to_string(), str::to_owned),
        meaning: meaning.as_str().unwrap_or_default().to_owned(),
    };
    let plain =
        list(schema, "enum").iter().filter(|value| !value.is_null()).map(|value| of(value, &Value::Null));
    let told = list(schema, "oneOf").iter().filter_map(|part| match list(part, "enum") {
        [only] => Some(of(only, &part["description"])),
        _ => part.get("const").map(|only| of(only, &part["description"])),
    });
    plain.chain(told).collect()
}
