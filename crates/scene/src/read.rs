//! A small reader of TOML that goes on after a problem: every value is asked for with its rule, and what breaks a
//! rule, is missing, is of another type or was never asked for is collected with its path and its text as written.

use std::cell::RefCell;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::problem::Problem;

/// A file being read and what was found wrong with it.
pub(crate) struct Source<'a> {
    name: &'a str,
    text: &'a str,
    problems: &'a RefCell<Vec<Problem>>,
}

impl<'a> Source<'a> {
    /// `name` is how messages call the file.
    pub fn new(name: &'a str, text: &'a str, problems: &'a RefCell<Vec<Problem>>) -> Self {
        Self { name, text, problems }
    }

    /// The document's table, or every syntax error with its line.
    pub fn parse(&self) -> Option<Spanned<DeTable<'a>>> {
        let (table, errors) = DeTable::parse_recoverable(self.text);
        for error in &errors {
            let field = error.span().map_or(String::new(), |span| {
                let before = &self.text.as_bytes()[..span.start.min(self.text.len())];
                format!("line {}", before.iter().filter(|&&b| b == b'\n').count() + 1)
            });
            let value = error.span().and_then(|span| self.text.get(span)).and_then(shorten);
            self.problem(field, value, error.message().replace('\n', ", "));
        }
        errors.is_empty().then_some(table)
    }

    /// The document as a node without a path.
    pub fn root<'s>(&'s self, table: &'s DeValue<'a>) -> Node<'s> {
        Node { source: self, path: String::new(), value: table, text: "" }
    }

    /// Collects a problem.
    pub fn problem(&self, field: impl Into<String>, value: Option<String>, rule: impl Into<String>) {
        // A decoder's message may quote the file: no line break or control character gets through.
        let rule = rule.into().replace(char::is_control, " ");
        let problem = Problem { file: self.name.to_owned(), field: field.into(), value, rule };
        self.problems.borrow_mut().push(problem);
    }
}

/// One value, where it is and how it was written.
#[derive(Clone)]
pub(crate) struct Node<'a> {
    source: &'a Source<'a>,
    path: String,
    value: &'a DeValue<'a>,
    text: &'a str,
}

impl<'a> Node<'a> {
    fn child(&self, path: String, value: &'a Spanned<DeValue<'a>>) -> Node<'a> {
        let text = self.source.text.get(value.span()).unwrap_or("");
        Node { source: self.source, path, value: value.get_ref(), text }
    }

    /// The path from the document's root: `puppets[1].position_m`.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The value as a message shows it.
    fn shown(&self) -> Option<String> {
        match self.value {
            DeValue::Table(_) if !self.text.starts_with('{') => None,
            _ => shorten(self.text),
        }
    }

    /// Reports that this value breaks `rule`; returns `None` for the caller to pass on.
    pub fn refuse<T>(&self, rule: impl Into<String>) -> Option<T> {
        self.source.problem(&self.path, self.shown(), rule);
        None
    }

    fn wrong_type<T>(&self, wanted: &str) -> Option<T> {
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

    /// A finite number, written as an integer or a float.
    pub fn number(&self) -> Option<f64> {
        let number = match self.value {
            DeValue::Float(float) => float.as_str().parse().unwrap_or(f64::INFINITY),
            DeValue::Integer(_) => self.integer()? as f64,
            _ => return self.wrong_type("a number"),
        };
        // −0 becomes 0, so that equal values have equal bits.
        if f64::is_finite(number) { Some(number + 0.0) } else { self.refuse("a number must be finite") }
    }

    /// A number in a range, else `rule`.
    pub fn number_in(&self, range: impl std::ops::RangeBounds<f64>, rule: &str) -> Option<f64> {
        noted(&self.path, Noted::Rule(rule));
        let number = self.number()?;
        if range.contains(&number) { Some(number) } else { self.refuse(rule) }
    }

    /// An integer that fits i64.
    pub fn integer(&self) -> Option<i64> {
        let DeValue::Integer(integer) = self.value else { return self.wrong_type("a whole number") };
        match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(integer) => Some(integer),
            Err(_) => self.refuse("a whole number must fit 64 bits"),
        }
    }

    /// An integer in a range, else `rule`.
    pub fn integer_in(&self, range: impl std::ops::RangeBounds<i64>, rule: &str) -> Option<i64> {
        noted(&self.path, Noted::Rule(rule));
        let integer = self.integer()?;
        if range.contains(&integer) { Some(integer) } else { self.refuse(rule) }
    }

    /// `true` or `false`.
    pub fn boolean(&self) -> Option<bool> {
        match self.value {
            DeValue::Boolean(boolean) => Some(*boolean),
            _ => self.wrong_type("true or false"),
        }
    }

    /// A string.
    pub fn string(&self) -> Option<&'a str> {
        match self.value {
            DeValue::String(string) => Some(string),
            _ => self.wrong_type("a string"),
        }
    }

    /// One of the named choices.
    pub fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Option<T> {
        let names: Vec<_> = choices.iter().map(|(name, _)| *name).collect();
        noted(&self.path, Noted::Rule(&format!("one of {}", list(&names))));
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
        Some(array.iter().enumerate().map(|(i, v)| self.child(format!("{}[{i}]", self.path), v)).collect())
    }

    /// Exactly N items, each read by `read`; all of them are read before any failure is passed on.
    pub fn items<T, const N: usize>(&self, read: impl Fn(&Node<'a>) -> Option<T>) -> Option<[T; N]> {
        let DeValue::Array(array) = self.value else {
            return self.wrong_type(&format!("an array of {N} numbers"));
        };
        if array.len() != N {
            return self.refuse(format!("must have {N} numbers, not {}", array.len()));
        }
        let items: Vec<_> = self.array(N)?.iter().map(read).collect();
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

    /// A table whose keys are asked for one by one.
    pub fn table(&self) -> Option<Fields<'a>> {
        let DeValue::Table(table) = self.value else { return self.wrong_type("a table") };
        Some(Fields { node: self.clone(), table, known: Vec::new() })
    }

    /// Whether this is a table.
    pub fn is_table(&self) -> bool {
        self.value.is_table()
    }

    /// Whether this is a string.
    pub fn is_string(&self) -> bool {
        self.value.is_str()
    }

    /// Every key and value of a table whose keys are names, at most `most`.
    pub fn entries(&self, most: usize) -> Option<Vec<(&'a str, Node<'a>)>> {
        let DeValue::Table(table) = self.value else { return self.wrong_type("a table") };
        if table.len() > most {
            return self.refuse(format!("has {} keys, more than the {most} allowed", table.len()));
        }
        Some(
            table
                .iter()
                .map(|(k, v)| (&**k.get_ref(), self.child(join(&self.path, k.get_ref()), v)))
                .collect(),
        )
    }
}

/// A table being read. Dropping it without [`Fields::done`] would let unknown keys pass, so always end with it.
#[must_use]
pub(crate) struct Fields<'a> {
    node: Node<'a>,
    table: &'a DeTable<'a>,
    known: Vec<&'static str>,
}

impl<'a> Fields<'a> {
    /// The value of `key` if it is there; `key` is known from now on.
    pub fn get(&mut self, key: &'static str) -> Option<Node<'a>> {
        self.known.push(key);
        let value = self.table.get(key)?;
        Some(self.node.child(join(&self.node.path, key), value))
    }

    /// A required value; `what` says what is missing.
    pub fn need<T>(
        &mut self,
        key: &'static str,
        what: &str,
        read: impl FnOnce(&Node<'a>) -> Option<T>,
    ) -> Option<T> {
        noted(&join(&self.node.path, key), Noted::Key { needed: true, what });
        match self.get(key) {
            Some(node) => read(&node),
            None => {
                self.node.source.problem(join(&self.node.path, key), None, format!("is missing: {what}"));
                None
            }
        }
    }

    /// A value that may be missing; `what` says what it is, and what is so without it.
    pub fn given(&mut self, key: &'static str, what: &str) -> Option<Node<'a>> {
        noted(&join(&self.node.path, key), Noted::Key { needed: false, what });
        self.get(key)
    }

    /// An optional value: `default` when it is absent, `None` only when it is wrong. `what` says what it is, the default too.
    pub fn optional<T>(
        &mut self,
        key: &'static str,
        what: &str,
        default: T,
        read: impl FnOnce(&Node<'a>) -> Option<T>,
    ) -> Option<T> {
        match self.given(key, what) {
            Some(node) => read(&node),
            None => Some(default),
        }
    }

    /// A key that belongs to another choice: refused with `rule` when it is there.
    pub fn reject(&mut self, key: &'static str, rule: &str) {
        if let Some(node) = self.get(key) {
            node.refuse::<()>(rule);
        }
    }

    /// Refuses every key that was not asked for, naming the nearest known one.
    pub fn done(self) {
        for (key, value) in self.table {
            let key: &str = key.get_ref();
            if !self.known.contains(&key) {
                let node = self.node.child(join(&self.node.path, key), value);
                let known = list(&self.known);
                let hint = did_you_mean(key, &self.known);
                node.refuse::<()>(format!("is not a known key{hint}; known are {known}"));
            }
        }
    }
}

/// What the reader asks for: the reference page is made of it.
#[cfg_attr(not(test), expect(dead_code, reason = "the page is made by a test"))]
pub(crate) enum Noted<'a> {
    /// A key, whether it may not be missing, and what it is.
    Key { needed: bool, what: &'a str },
    /// A rule that a value is held to.
    Rule(&'a str),
}

#[cfg(not(test))]
fn noted(_: &str, _: Noted) {}

#[cfg(test)]
use crate::reference::noted;

/// `a.b`, with a key that is no bare key quoted.
fn join(path: &str, key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    let key = if bare { key.to_owned() } else { shorten(&format!("{key:?}")).unwrap_or_default() };
    if path.is_empty() { key } else { format!("{path}.{key}") }
}

/// A value on one line, shortened to what a message can carry; `None` for nothing.
pub(crate) fn shorten(text: &str) -> Option<String> {
    const MOST: usize = 60;
    let mut line = String::new();
    for c in text.chars() {
        let c = if c.is_whitespace() { ' ' } else { c };
        if !(c == ' ' && (line.is_empty() || line.ends_with(' '))) && !c.is_control() {
            line.push(c);
        }
        if line.chars().count() > MOST {
            line.pop();
            line.push('…');
            break;
        }
    }
    let line = line.trim_end().to_owned();
    (!line.is_empty()).then_some(line)
}

/// `a, b and c`, at most twenty of them.
pub fn list<S: AsRef<str>>(names: &[S]) -> String {
    let mut names: Vec<&str> = names.iter().map(S::as_ref).collect();
    let more = names.len().saturating_sub(20);
    names.truncate(20);
    match names.split_last() {
        None => "none".to_owned(),
        Some(_) if more > 0 => format!("{} and {more} more", names.join(", ")),
        Some((last, [])) => (*last).to_owned(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}

/// ` (did you mean x?)` when a known name is close.
pub fn did_you_mean<S: AsRef<str>>(name: &str, known: &[S]) -> String {
    let nearest = known.iter().map(|k| (edits(name, k.as_ref()), k.as_ref())).min();
    match nearest {
        Some((distance, known)) if distance <= 1 + known.len() / 4 => format!(" (did you mean {known}?)"),
        _ => String::new(),
    }
}

/// Levenshtein distance; names longer than 64 characters are far from everything.
fn edits(a: &str, b: &str) -> usize {
    if a.len() > 64 || b.len() > 64 {
        return usize::MAX;
    }
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.len()]
}

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
