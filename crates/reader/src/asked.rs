//! What a reader asks for, noted while it reads: reference pages are made of it.

use std::collections::BTreeMap;

/// What is noted.
pub(crate) enum Noted<'a> {
    /// A key, whether it may not be missing, and what it is.
    Key { needed: bool, what: &'a str },
    /// A rule that a value is held to.
    Rule(&'a str),
}

/// What is known of a key.
#[derive(Clone, Debug)]
pub struct Key {
    /// Its place in the order of asking, from 0.
    pub order: usize,
    /// Whether it may not be missing where its table is there.
    pub needed: bool,
    /// What it is.
    pub what: String,
    /// Rules that its value is held to, besides what it is.
    pub rules: Vec<String>,
}

/// The keys that were asked for, by path; every item of a list is read alike, and `[3]` stands as `[]`.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// Paths and what is known of each.
    pub keys: BTreeMap<String, Key>,
}

impl Asked {
    pub(crate) fn note(&mut self, path: &str, what: Noted<'_>) {
        let path = any_item(path);
        match what {
            Noted::Key { needed, what } => {
                let order = self.keys.len();
                // What is said with the file at hand in mind is told in its first form.
                let key = self.keys.entry(path).or_insert_with(|| Key {
                    order,
                    needed,
                    what: what.to_owned(),
                    rules: Vec::new(),
                });
                key.needed = needed;
            }
            // A rule of an item is its key's.
            Noted::Rule(rule) => {
                if let Some(key) = self.keys.get_mut(path.trim_end_matches("[]"))
                    && !key.rules.iter().any(|known| known == rule)
                    && key.what != rule
                {
                    key.rules.push(rule.to_owned());
                }
            }
        }
    }

    /// The rows of a Markdown table in the order of asking: path, whether it is needed, what it is with its rules.
    pub fn rows(&self) -> String {
        let mut keys: Vec<_> = self.keys.iter().collect();
        keys.sort_by_key(|(_, key)| key.order);
        let row = |(path, key): &(&String, &Key)| {
            let rules =
                if key.rules.is_empty() { String::new() } else { format!(" ({})", key.rules.join("; ")) };
            let needed = if key.needed { "yes" } else { "" };
            format!("| `{path}` | {needed} | {}{rules} |", key.what.replace('|', "\\|"))
        };
        keys.iter().map(row).collect::<Vec<_>>().join("\n")
    }
}

/// `a[3].b` as `a[].b`.
fn any_item(path: &str) -> String {
    let mut kept = String::new();
    for part in path.split_inclusive(['[', ']']) {
        kept.push_str(if part.ends_with(']') { "]" } else { part });
    }
    kept
}
