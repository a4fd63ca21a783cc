//! `[completion]`: the code at the end and where it leads, each placeholder of the address resolved.

use crate::conduct::SessionRules;
use crate::definition::{Completion, PANEL_PARAMS};
use crate::fields::{Fields, Gatherer, text};
use toml::Value;

pub(super) fn read(
    gatherer: &Gatherer<'_>,
    fields: &mut Fields<'_>,
    session: Option<&SessionRules>,
) -> Option<Completion> {
    let Some(value) = fields.raw("completion") else { return Some(Completion::default()) };
    let mut fields = Fields::of(gatherer, "completion".to_owned(), value)?;
    let code = fields.get("code", "a code of 1 to 64 letters, digits, - and _", |v| {
        text(v, 64).filter(|s| s.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_'))
    });
    let redirect =
        fields.get("redirect", "an https:// address of at most 2000 characters, without blanks", |v| {
            text(v, 2000).filter(|s| {
                s.starts_with("https://") && !s.contains(|c: char| c.is_whitespace() || c.is_control())
            })
        });
    if let Some(address) = &redirect {
        for rule in broken(address, code.as_deref(), session) {
            fields.report("redirect", Some(&Value::String(address.clone())), rule);
        }
    }
    fields.finish();
    Some(Completion { code, redirect })
}

/// The rules that an address breaks: a host, placeholders that are filled in, and the code among them.
fn broken(address: &str, code: Option<&str>, session: Option<&SessionRules>) -> Vec<String> {
    let mut rules = Vec::new();
    let host = address.trim_start_matches("https://").split(['/', '?', '#']).next().unwrap_or_default();
    let plain = |c: char| c.is_alphanumeric() || "-.:".contains(c);
    if host.is_empty() || host.starts_with(['.', ':', '-']) || !host.chars().all(plain) {
        rules.push(format!("must lead to a host, and {host:?} is none"));
    }
    let placeholders = match Completion::placeholders(address) {
        Ok(placeholders) => placeholders,
        Err(rule) => {
            rules.push(rule);
            return rules;
        }
    };
    let own = session.map(|session| session.params.iter().chain(&session.id)).into_iter().flatten();
    let known: Vec<&str> =
        std::iter::once("CODE").chain(PANEL_PARAMS).chain(own.map(String::as_str)).collect();
    for name in &placeholders {
        // Which parameters a link has is known for certain only of those that are listed.
        if session.is_some() && !known.contains(name) {
            let all: Vec<String> = known.iter().map(|name| format!("[{name}]")).collect();
            rules.push(format!(
                "[{name}] is never filled in; there are {}, and what session.params lists",
                all.join(", ")
            ));
        }
    }
    let written = code.is_some_and(|code| address.contains(code));
    if !placeholders.contains(&"CODE") && !written {
        rules.push("must hold [CODE], or whoever comes back has no code to show".to_owned());
    }
    rules
}
