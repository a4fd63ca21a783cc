//! A table whose keys are asked for one by one.
//!
//! Two ways of asking: `need`, `optional` and `given` leave it to what reads a value to refuse it; `must`, `may` and `defaulted` take a reader that
//! knows no messages, and refuse what it makes nothing of.

use toml::de::{DeTable, DeValue};

use crate::asked::Noted;
use crate::node::Node;
use crate::words::{did_you_mean, list};

/// A table being read. Dropping it without [`Fields::done`] would let unknown keys pass, so always end with it.
#[must_use]
#[derive(Debug)]
pub struct Fields<'a> {
    node: Node<'a>,
    table: &'a DeTable<'a>,
    known: Vec<&'static str>,
}

// Here and not beside `Node`, which a table names: no file needs one that needs it.
impl<'a> Node<'a> {
    /// A table whose keys are asked for one by one.
    pub fn table(&self) -> Option<Fields<'a>> {
        match self.value {
            DeValue::Table(table) => Some(Fields { node: self.clone(), table, known: Vec::new() }),
            _ => self.wrong_type("a table"),
        }
    }
}

impl<'a> Fields<'a> {
    /// The table itself.
    pub fn node(&self) -> &Node<'a> {
        &self.node
    }

    /// The value of `key` if it is there; `key` is known from now on.
    pub fn get(&mut self, key: &'static str) -> Option<Node<'a>> {
        if !self.known.contains(&key) {
            self.known.push(key);
        }
        self.node.get(key)
    }

    /// Whether the table has this key, which it need not know.
    pub fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// A required value; `what` says what is missing.
    pub fn need<T>(
        &mut self,
        key: &'static str,
        what: &str,
        read: impl FnOnce(&Node<'a>) -> Option<T>,
    ) -> Option<T> {
        self.noted(key, true, what);
        match self.get(key) {
            Some(node) => read(&node),
            None => {
                self.report(key, format!("is missing: {what}"));
                None
            }
        }
    }

    /// A value that may be missing; `what` says what it is, and what is so without it.
    pub fn given(&mut self, key: &'static str, what: &str) -> Option<Node<'a>> {
        self.noted(key, false, what);
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

    /// A required value that must be `rule`: what `read` makes of it.
    pub fn must<T>(
        &mut self,
        key: &'static str,
        rule: &str,
        read: impl FnOnce(&Node<'a>) -> Option<T>,
    ) -> Option<T> {
        self.need(key, rule, |node| node.must(rule, read))
    }

    /// A value that must be `rule` where it is there; `None` where it is absent or wrong.
    pub fn may<T>(
        &mut self,
        key: &'static str,
        rule: &str,
        read: impl FnOnce(&Node<'a>) -> Option<T>,
    ) -> Option<T> {
        self.given(key, rule)?.must(rule, read)
    }

    /// A value that must be `rule`: `default` where it is absent, `None` only where it is wrong.
    pub fn defaulted<T>(
        &mut self,
        key: &'static str,
        rule: &str,
        default: T,
        read: impl FnOnce(&Node<'a>) -> Option<T>,
    ) -> Option<T> {
        self.optional(key, rule, default, |node| node.must(rule, read))
    }

    /// The tables of an array that must have at least one; none where it is something else or absent.
    pub fn tables(&mut self, key: &'static str) -> Vec<Fields<'a>> {
        let items = self.must(key, "an array of tables with at least one", |node| {
            node.as_array().filter(|items| !items.is_empty())
        });
        items.iter().flatten().filter_map(Node::table).collect()
    }

    /// A value that does not go with others is refused with `rule` when it is there.
    pub fn reject(&mut self, key: &'static str, rule: &str) {
        if let Some(node) = self.get(key) {
            node.refuse::<()>(rule);
        }
    }

    /// Reports what is wrong with a value without showing it, or with one that is not there.
    pub fn report(&self, key: &str, rule: impl Into<String>) {
        self.node.report(key, rule);
    }

    /// Refuses every key that was not asked for, naming the nearest known one.
    pub fn done(self) {
        for (key, _) in self.table {
            let key: &str = key.get_ref();
            if let (false, Some(node)) = (self.known.contains(&key), self.node.get(key)) {
                let known = list(&self.known);
                let hint = did_you_mean(key, &self.known);
                node.refuse::<()>(format!("is not a known key{hint}; known are {known}"));
            }
        }
    }

    fn noted(&self, key: &str, needed: bool, what: &str) {
        self.node.source.reading.noted(&self.node.path_of(key), Noted::Key { needed, what });
    }
}
