//! A document written anew: its values as they are, in one layout.

use std::borrow::Cow;

use toml::de::{DeTable, DeValue};
use toml::{Spanned, Value};

/// The document as TOML: values as written, keys sorted, `[section]` and `[[section]]` for the outer two levels and all that is deeper in place;
/// no comments.
pub(crate) fn document(table: &DeTable) -> String {
    let mut out = String::new();
    section(&mut out, "", 0, table);
    out
}

/// How many keys a section's name has at most.
const DEEPEST: usize = 2;

fn section(out: &mut String, path: &str, depth: usize, table: &DeTable) {
    let is_section = |value: &DeValue| depth < DEEPEST && (value.is_table() || tables(value).is_some());
    let entries = || table.iter().map(|(key, value)| (name(key.get_ref()), value.get_ref()));
    for (key, value) in entries().filter(|(_, value)| !is_section(value)) {
        out.push_str(&format!("{key} = {}\n", inline(value)));
    }
    for (key, value) in entries().filter(|(_, value)| is_section(value)) {
        let path = if path.is_empty() { key } else { format!("{path}.{key}") };
        let mut begin = |head: String, table: &DeTable| {
            if !out.is_empty() {
                out.push('\n');
            }
            out.push_str(&head);
            section(out, &path, depth + 1, table);
        };
        match value {
            DeValue::Table(table) => begin(format!("[{path}]\n"), table),
            _ => tables(value).into_iter().flatten().for_each(|table| begin(format!("[[{path}]]\n"), table)),
        }
    }
}

/// The items of an array of tables that has any.
fn tables<'a>(value: &'a DeValue<'a>) -> Option<Vec<&'a DeTable<'a>>> {
    let items = value.as_array().filter(|items| !items.is_empty())?;
    items.iter().map(|item| item.get_ref().as_table()).collect()
}

/// A key, quoted unless it is bare.
fn name(key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare { key.to_owned() } else { inline(&DeValue::String(Cow::Borrowed(key))) }
}

/// The value in one piece.
fn inline(value: &DeValue) -> String {
    match value {
        DeValue::String(text) => Value::String(text.to_string()).to_string(),
        DeValue::Integer(integer) => integer.to_string(),
        DeValue::Float(float) => float.to_string(),
        DeValue::Boolean(boolean) => boolean.to_string(),
        DeValue::Datetime(date) => date.to_string(),
        DeValue::Array(items) => {
            let items: Vec<_> = items.iter().map(|item| inline(item.get_ref())).collect();
            format!("[{}]", items.join(", "))
        }
        DeValue::Table(table) if table.is_empty() => "{}".to_owned(),
        DeValue::Table(table) => {
            let entry = |(key, value): (&Spanned<Cow<str>>, &Spanned<DeValue>)| {
                format!("{} = {}", name(key.get_ref()), inline(value.get_ref()))
            };
            format!("{{ {} }}", table.iter().map(entry).collect::<Vec<_>>().join(", "))
        }
    }
}
