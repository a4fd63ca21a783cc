//! One value of a file: looked at in silence (`as_…`), or asked for with a rule that it is refused by.

use std::ops::{Range, RangeBounds};

use toml::Spanned;
use toml::de::DeValue;

use crate::asked::Noted;
use crate::canonical::canonical;
use crate::source::Source;
use crate::words::{did_you_mean, join, list, shorten};
use crate::written;

/// One value, where it is and how it was written.
#[derive(Clone, Debug)]
pub struct Node<'a> {
    pub(crate) source: &'a Source<'a>,
    path: String,
    pub(crate) value: &'a DeValue<'a>,
    span: Option<Range<usize>>,
}

// Here and not beside `Source`, which a node names: no file needs one that needs it.
impl Source<'_> {
    /// What `read` makes of the document; nothing where it is no TOML, whose every error is collected.
    pub fn read<T>(&self, read: impl FnOnce(&Node) -> Option<T>) -> Option<T> {
        let table = self.parse()?;
        read(&Node { source: self, path: String::new(), value: &table, span: None })
    }
}

impl<'a> Node<'a> {
    fn child(&self, path: String, value: &'a Spanned<DeValue<'a>>) -> Node<'a> {
        Node { source: self.source, path, value: value.get_ref(), span: Some(value.span()) }
    }

    /// The path from the document's root: `puppets[1].position_m`.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The path of a key of this table.
    pub fn path_of(&self, key: &str) -> String {
        join(&self.path, key)
    }

    /// The value in one fixed form, for hashes: sorted keys, plain numbers, no comments or layout.
    pub fn canonical(&self) -> String {
        canonical(self.value)
    }

    /// The document as TOML in one layout, without comments: values as written, keys sorted; a value that is no table gives nothing.
    pub fn to_toml(&self) -> String {
        self.value.as_table().map(written::document).unwrap_or_default()
    }

    /// The value as a message shows it.
    fn shown(&self) -> Option<String> {
        let text = self.source.text_at(self.span.as_ref());
        match self.value {
            DeValue::Table(_) if !text.starts_with('{') => None,
            _ => shorten(text),
        }
    }

    /// Reports that this value breaks `rule`; returns `None` for the caller to pass on.
    pub fn refuse<T>(&self, rule: impl Into<String>) -> Option<T> {
        self.source.refuse_at(self.span.as_ref(), self.path.clone(), self.shown(), rule.into());
        None
    }

    /// Says that this value may be a mistake, though nothing is wrong with it.
    pub fn warn(&self, about: impl Into<String>) {
        self.source.warn_at(self.span.as_ref(), self.path.clone(), self.shown(), about.into());
    }

    /// Reports what is wrong with a value of this table without showing it, or with one that it lacks.
    pub fn report(&self, key: &str, rule: impl Into<String>) {
        let there = self.get(key);
        let span = there.as_ref().map_or(self.span.as_ref(), |node| node.span.as_ref());
        self.source.refuse_at(span, self.path_of(key), None, rule.into());
    }

    pub(crate) fn wrong_type<T>(&self, wanted: &str) -> Option<T> {
        let found = match self.value {
            DeValue::String(_) => "a string",
            DeValue::Integer(_) | DeValue::Float(_) => "a number",
            DeValue::Boolean(_) => "a boolean",
            DeValue::Datetime(_) => "a date",
            DeValue::Array(_) => "an array",
            DeValue::Table(_) => "a table",
        };
        self.refuse(format!("{wanted} is wanted here, not {found}"))
    }

    /// The value of a key, if this is a table that has it.
    pub fn get(&self, key: &str) -> Option<Node<'a>> {
        let DeValue::Table(table) = self.value else { return None };
        Some(self.child(self.path_of(key), table.get(key)?))
    }

    /// A string.
    pub fn as_str(&self) -> Option<&'a str> {
        self.value.as_str()
    }

    /// `true` or `false`.
    pub fn as_bool(&self) -> Option<bool> {
        self.value.as_bool()
    }

    /// A whole number that fits i64.
    pub fn as_integer(&self) -> Option<i64> {
        let integer = self.value.as_integer()?;
        i64::from_str_radix(integer.as_str(), integer.radix()).ok()
    }

    /// A number, written as a whole one or not.
    pub fn as_number(&self) -> Option<f64> {
        match self.value {
            DeValue::Float(float) => Some(float.as_str().parse().unwrap_or(f64::INFINITY)),
            _ => self.as_integer().map(|integer| integer as f64),
        }
    }

    /// The items of an array.
    pub fn as_array(&self) -> Option<Vec<Node<'a>>> {
        let DeValue::Array(array) = self.value else { return None };
        Some(array.iter().enumerate().map(|(i, v)| self.child(format!("{}[{i}]", self.path), v)).collect())
    }

    /// Every key and value of a table, sorted by key.
    pub fn as_entries(&self) -> Option<Vec<(&'a str, Node<'a>)>> {
        let DeValue::Table(table) = self.value else { return None };
        Some(table.iter().map(|(k, v)| (&**k.get_ref(), self.child(self.path_of(k.get_ref()), v))).collect())
    }

    /// Whether this is a table.
    pub fn is_table(&self) -> bool {
        self.value.is_table()
    }

    /// What `read` makes of the value; where it makes nothing of it, the value is refused: it must be `rule`.
    pub fn must<T>(&self, rule: &str, read: impl FnOnce(&Node<'a>) -> Option<T>) -> Option<T> {
        read(self).or_else(|| self.refuse(format!("must be {rule}")))
    }

    /// A finite number, written as an integer or a float.
    pub fn number(&self) -> Option<f64> {
        let number = match self.value {
            DeValue::Float(_) => self.as_number()?,
            DeValue::Integer(_) => self.integer()? as f64,
            _ => return self.wrong_type("a number"),
        };
        // −0 becomes 0, so that equal values have equal bits.
        if f64::is_finite(number) { Some(number + 0.0) } else { self.refuse("a number must be finite") }
    }

    /// A number in a range, else `rule`.
    pub fn number_in(&self, range: impl RangeBounds<f64>, rule: &str) -> Option<f64> {
        self.noted_rule(rule);
        let number = self.number()?;
        if range.contains(&number) { Some(number) } else { self.refuse(rule) }
    }

    /// An integer that fits i64.
    pub fn integer(&self) -> Option<i64> {
        if !self.value.is_integer() {
            return self.wrong_type("a whole number");
        }
        self.as_integer().or_else(|| self.refuse("a whole number must fit 64 bits"))
    }

    /// An integer in a range, else `rule`.
    pub fn integer_in(&self, range: impl RangeBounds<i64>, rule: &str) -> Option<i64> {
        self.noted_rule(rule);
        let integer = self.integer()?;
        if range.contains(&integer) { Some(integer) } else { self.refuse(rule) }
    }

    /// `true` or `false`.
    pub fn boolean(&self) -> Option<bool> {
        self.as_bool().or_else(|| self.wrong_type("true or false"))
    }

    /// A string.
    pub fn string(&self) -> Option<&'a str> {
        self.as_str().or_else(|| self.wrong_type("a string"))
    }

    /// One of the named choices.
    pub fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Option<T> {
        let names: Vec<_> = choices.iter().map(|(name, _)| *name).collect();
        self.noted_rule(&format!("one of {}", list(&names)));
        let string = self.string()?;
        let found = choices.iter().find(|(name, _)| *name == string);
        if let Some((_, choice)) = found {
            return Some(*choice);
        }
        self.refuse(format!("must be one of {}{}", list(&names), did_you_mean(string, &names)))
    }

    /// The items of an array, at most `most` of them.
    pub fn array(&self, most: usize) -> Option<Vec<Node<'a>>> {
        let DeValue::Array(array) = self.value else { return self.wrong_type("an array") };
        if array.len() > most {
            return self.refuse(format!("has {} items, more than the {most} allowed", array.len()));
        }
        self.as_array()
    }

    /// Exactly N items, each read by `read`; all of them are read before any failure is passed on.
    pub fn items<T, const N: usize>(&self, read: impl Fn(&Node<'a>) -> Option<T>) -> Option<[T; N]> {
        let DeValue::Array(array) = self.value else {
            return self.wrong_type(&format!("an array of {N} numbers"));
        };
        if array.len() != N {
            return self.refuse(format!("must have {N} numbers, not {}", array.len()));
        }
        let items: Vec<_> = self.as_array()?.iter().map(read).collect();
        items.into_iter().collect::<Option<Vec<T>>>()?.try_into().ok()
    }

    /// A number for all three channels or `[r, g, b]`.
    pub fn rgb(&self, read: impl Fn(&Node<'a>) -> Option<f64>) -> Option<[f64; 3]> {
        match self.value {
            DeValue::Array(_) => self.items(read),
            DeValue::Integer(_) | DeValue::Float(_) => Some([read(self)?; 3]),
            _ => self.wrong_type("a number or [r, g, b]"),
        }
    }

    /// Every key and value of a table whose keys are names, at most `most`.
    pub fn entries(&self, most: usize) -> Option<Vec<(&'a str, Node<'a>)>> {
        let DeValue::Table(table) = self.value else { return self.wrong_type("a table") };
        if table.len() > most {
            return self.refuse(format!("has {} keys, more than the {most} allowed", table.len()));
        }
        self.as_entries()
    }

    fn noted_rule(&self, rule: &str) {
        self.source.reading.noted(&self.path, Noted::Rule(rule));
    }
}
