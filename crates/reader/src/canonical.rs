//! A document in one fixed form, for hashes.

use toml::de::DeValue;

/// The document's values in one fixed form: sorted keys, plain numbers, no comments or layout.
pub(crate) fn canonical(value: &DeValue) -> String {
    match value {
        DeValue::String(string) => format!("{string:?}"),
        DeValue::Boolean(boolean) => boolean.to_string(),
        DeValue::Datetime(date) => date.to_string(),
        DeValue::Float(float) => number(float.as_str().parse().unwrap_or(f64::NAN)),
        // 1 and 1.0 are the same value; an integer that f64 can't hold keeps its digits.
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(whole) if whole.unsigned_abs() <= 1 << 53 => number(whole as f64),
            _ => integer.to_string(),
        },
        DeValue::Array(array) => {
            let items: Vec<_> = array.iter().map(|v| canonical(v.get_ref())).collect();
            format!("[{}]", items.join(","))
        }
        DeValue::Table(table) => {
            let mut entries: Vec<_> =
                table.iter().map(|(k, v)| (k.get_ref().to_string(), canonical(v.get_ref()))).collect();
            entries.sort();
            let entries: Vec<_> = entries.into_iter().map(|(k, v)| format!("{k:?}:{v}")).collect();
            format!("{{{}}}", entries.join(","))
        }
    }
}

/// The shortest digits that give the same f64, without −0.
fn number(number: f64) -> String {
    format!("{:?}", number + 0.0)
}
