//! Reading a TOML table field by field, so that one pass finds every problem and every unknown key.

use crate::problems::Problem;
use std::cell::RefCell;
use toml::{Table, Value};

/// Where problems are gathered while one file is read.
pub(crate) struct Gatherer<'a> {
    file: &'a str,
    problems: RefCell<Vec<Problem>>,
}

impl<'a> Gatherer<'a> {
    pub(crate) fn new(file: &'a str) -> Self {
        Gatherer { file, problems: RefCell::default() }
    }

    pub(crate) fn report(&self, field: &str, value: Option<&Value>, rule: impl Into<String>) {
        self.problems.borrow_mut().push(Problem {
            file: self.file.to_owned(),
            field: field.to_owned(),
            value: value.map(shorten),
            rule: rule.into(),
        });
    }

    pub(crate) fn into_problems(self) -> Vec<Problem> {
        self.problems.into_inner()
    }
}

/// A message stays one line, however long the value is.
pub(crate) fn shorten(value: &Value) -> String {
    let text = value.to_string().replace('\n', "\\n");
    if text.chars().count() <= 80 { text } else { text.chars().take(77).chain("...".chars()).collect() }
}

/// Told which keys are asked for, whether each may not be missing, and its rule: the reference page is made of it.
#[cfg(not(test))]
fn noted(_path: &str, _asked: Option<(bool, &str)>) {}

#[cfg(test)]
use crate::reference::noted;

/// One table of the file; its `finish` reports the keys that nobody asked for.
pub(crate) struct Fields<'a> {
    gatherer: &'a Gatherer<'a>,
    table: &'a Table,
    path: String,
    asked: Vec<&'static str>,
}

impl<'a> Fields<'a> {
    pub(crate) fn new(gatherer: &'a Gatherer<'a>, path: impl Into<String>, table: &'a Table) -> Self {
        Fields { gatherer, table, path: path.into(), asked: Vec::new() }
    }

    /// The table under `value`, or a problem.
    pub(crate) fn of(gatherer: &'a Gatherer<'a>, path: String, value: &'a Value) -> Option<Self> {
        match value.as_table() {
            Some(table) => Some(Fields::new(gatherer, path, table)),
            None => {
                gatherer.report(&path, Some(value), "must be a table");
                None
            }
        }
    }

    pub(crate) fn path_of(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    /// Whether the table has this key.
    pub(crate) fn has(&self, key: &str) -> bool {
        noted(&self.path_of(key), None);
        self.table.contains_key(key)
    }

    pub(crate) fn raw(&mut self, key: &'static str) -> Option<&'a Value> {
        noted(&self.path_of(key), None);
        if !self.asked.contains(&key) {
            self.asked.push(key);
        }
        self.table.get(key)
    }

    /// An optional field: `None` when absent, a problem when `read` refuses it.
    pub(crate) fn get<T>(
        &mut self,
        key: &'static str,
        rule: &str,
        read: impl FnOnce(&'a Value) -> Option<T>,
    ) -> Option<T> {
        noted(&self.path_of(key), Some((false, rule)));
        let value = self.raw(key)?;
        let read = read(value);
        if read.is_none() {
            self.gatherer.report(&self.path_of(key), Some(value), format!("must be {rule}"));
        }
        read
    }

    /// A required field: a problem when absent or refused.
    pub(crate) fn need<T>(
        &mut self,
        key: &'static str,
        rule: &str,
        read: impl FnOnce(&'a Value) -> Option<T>,
    ) -> Option<T> {
        if !self.table.contains_key(key) {
            self.raw(key);
            noted(&self.path_of(key), Some((true, rule)));
            self.gatherer.report(&self.path_of(key), None, format!("missing; must be {rule}"));
            return None;
        }
        let read = self.get(key, rule, read);
        noted(&self.path_of(key), Some((true, rule)));
        read
    }

    /// The table under `key`; a problem where it is something else.
    pub(crate) fn table(&mut self, key: &'static str) -> Option<Fields<'a>> {
        let value = self.raw(key)?;
        Fields::of(self.gatherer, self.path_of(key), value)
    }

    /// The entries of an array of tables with their paths; a problem where it is something else or absent.
    pub(crate) fn tables(&mut self, key: &'static str) -> Vec<Fields<'a>> {
        let items = self.need(key, "an array of tables with at least one", |v| {
            v.as_array().filter(|items| !items.is_empty())
        });
        let path = self.path_of(key);
        items
            .into_iter()
            .flatten()
            .enumerate()
            .filter_map(|(i, item)| Fields::of(self.gatherer, format!("{path}[{i}]"), item))
            .collect()
    }

    pub(crate) fn report(&self, key: &str, value: Option<&Value>, rule: impl Into<String>) {
        self.gatherer.report(&self.path_of(key), value, rule);
    }

    /// Reports every key that was not asked for.
    pub(crate) fn finish(self) {
        for (key, value) in self.table {
            if !self.asked.contains(&key.as_str()) {
                let known = self.asked.join(", ");
                self.gatherer.report(
                    &self.path_of(key),
                    Some(value),
                    format!("unknown key; known here are {known}"),
                );
            }
        }
    }
}

/// A finite number within `[low, high]`, integers included.
pub(crate) fn number(value: &Value, low: f64, high: f64) -> Option<f64> {
    let x = match value {
        Value::Float(x) => *x,
        Value::Integer(i) => *i as f64,
        _ => return None,
    };
    (x >= low && x <= high).then_some(x)
}

/// An integer within `[low, high]`.
pub(crate) fn integer(value: &Value, low: i64, high: i64) -> Option<u64> {
    value.as_integer().filter(|i| (low..=high).contains(i)).and_then(|i| u64::try_from(i).ok())
}

/// A string that is not blank and has at most `most` characters, none of which controls a terminal.
pub(crate) fn text(value: &Value, most: usize) -> Option<String> {
    let controls = |c: char| c.is_control() && !matches!(c, '\n' | '\r' | '\t');
    let shows = |c: char| !c.is_whitespace() && !UNSEEN.contains(&c);
    let text = value.as_str()?.trim();
    let fits = text.chars().any(shows) && text.chars().count() <= most && !text.contains(controls);
    fits.then(|| text.to_owned())
}

/// Characters without a width: joiners, marks of direction, the mark of a byte order.
const UNSEEN: [char; 7] =
    ['\u{200b}', '\u{200c}', '\u{200d}', '\u{200e}', '\u{200f}', '\u{2060}', '\u{feff}'];

/// The rule of [`identifier`] in words.
pub(crate) const IDENTIFIER: &str = "a name of 1 to 64 of a-z, 0-9 and -, starting with a letter or digit";

/// An identifier as it may stand in an address, a file name and a CSV column.
pub(crate) fn identifier(s: &str) -> bool {
    (1..=64).contains(&s.len())
        && !s.starts_with('-')
        && s.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'-')
}
