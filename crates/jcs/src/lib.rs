//! Canonical JSON (RFC 8785): one text for one value, so that the text's hash is the value's.

use serde::{Serialize, de::DeserializeOwned};
use serde_json::Value;

/// Why a value has no canonical JSON.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// JSON cannot hold it.
    #[error("{0}: JSON cannot hold it; numbers must be finite")]
    Lost(String),
    /// The canonicalizer refused.
    #[error("canonical JSON: {0}")]
    Unwritable(String),
}

/// Beyond 2⁵³ not every whole number is an f64, and RFC 8785 knows no others.
const EXACT: u64 = 1 << 53;

/// The canonical text of `value`: members in the order of their UTF-16, numbers as ECMAScript writes them, −0 as 0. A whole number beyond
/// 2⁵³ would become its neighbour; it is written as a string, as the RFC's appendix D has it. Errors: none that a [`Value`] can cause.
pub fn canonical(mut value: Value) -> Result<String, Error> {
    quote(&mut value);
    if is_canonical(&value) {
        return Ok(value.to_string());
    }
    serde_json_canonicalizer::to_string(&value).map_err(|error| Error::Unwritable(error.to_string()))
}

fn quote(value: &mut Value) {
    match value {
        Value::Number(n) if !n.is_f64() && n.as_u64().or(n.as_i64().map(i64::unsigned_abs)) > Some(EXACT) => {
            *value = Value::String(n.to_string());
        }
        Value::Array(values) => values.iter_mut().for_each(quote),
        Value::Object(members) => members.values_mut().for_each(quote),
        _ => {}
    }
}

/// Whether serde_json's own text is the canonical one already, several times as fast: strings it writes as the RFC does, f64 and names beyond
/// ASCII, which UTF-16 may put elsewhere, it does not.
fn is_canonical(value: &Value) -> bool {
    match value {
        Value::Null | Value::Bool(_) | Value::String(_) => true,
        Value::Number(n) => !n.is_f64(),
        Value::Array(values) => values.iter().all(is_canonical),
        Value::Object(members) => {
            members.keys().is_sorted()
                && members.iter().all(|(name, value)| name.is_ascii() && is_canonical(value))
        }
    }
}

/// `value` as JSON that reads back as the same value. Errors: it does not, as with a number that is not finite, which serde_json (and the
/// canonicalizer, below the top) would write as null.
pub fn exact<T>(value: &T) -> Result<Value, Error>
where
    T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug,
{
    let lost = || Error::Lost(format!("{value:?}"));
    let json = serde_json::to_value(value).map_err(|_| lost())?;
    match T::deserialize(&json) {
        Ok(back) if back == *value => Ok(json),
        _ => Err(lost()),
    }
}

#[cfg(test)]
mod tests;
