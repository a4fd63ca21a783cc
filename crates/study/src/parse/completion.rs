//! `[completion]`: the code at the end and where it leads, each placeholder of the address resolved.

use crate::conduct::SessionRules;
use crate::definition::{CREDITING_PARAMS, Completion, PANEL_PARAMS, StudyDefinition};
use crate::fields::{SECTION, text};
use kelir_reader::{Fields, Problem, shorten};
use std::net::Ipv4Addr;

/// From this edition on an address that breaks a rule is refused. Before, studies ran with it, and go on: it is a warning.
const STRICT_FROM: u64 = 2;

pub(super) fn read(
    fields: &mut Fields<'_>,
    session: Option<&SessionRules>,
    edition: Option<u64>,
) -> Option<Completion> {
    let Some(node) = fields.given("completion", SECTION) else { return Some(Completion::default()) };
    let mut fields = node.table()?;
    let code = fields.may("code", "a code of 1 to 64 letters, digits, - and _", |v| {
        text(v, 64).filter(|s| s.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_'))
    });
    let redirect =
        fields.may("redirect", "an https:// address of at most 2000 characters, without blanks", |v| {
            text(v, 2000).filter(|s| {
                s.starts_with("https://") && !s.contains(|c: char| c.is_whitespace() || c.is_control())
            })
        });
    let completion = Completion { code, redirect };
    if edition.is_some_and(|edition| edition >= STRICT_FROM)
        && let Some(session) = session
    {
        for rule in broken(&completion, session) {
            fields.reject("redirect", &rule);
        }
    }
    fields.done();
    Some(completion)
}

impl StudyDefinition {
    /// What may be a mistake in a study that is served all the same, because studies of its edition always were. `file` names it.
    pub fn warnings(&self, file: &str) -> Vec<Problem> {
        if u64::from(self.edition) >= STRICT_FROM {
            return Vec::new();
        }
        let value = self.completion.redirect.as_ref().and_then(|address| shorten(&format!("{address:?}")));
        let warning = |rule| Problem::new(file, "completion.redirect", value.clone(), rule);
        broken(&self.completion, &self.session).into_iter().map(warning).collect()
    }
}

/// Whether browsers take this for a host, with its port where it has one.
fn leads_somewhere(host: &str) -> bool {
    let (name, port) = host.split_once(':').unwrap_or((host, ""));
    let plain = |c: char| c.is_alphanumeric() || "-.".contains(c);
    let last = name.trim_end_matches('.').rsplit('.').next().unwrap_or_default();
    // Where the last part is a number, all of it is an address.
    let is_address = !last.is_empty() && last.bytes().all(|b| b.is_ascii_digit());
    !name.is_empty()
        && !name.starts_with(['.', '-'])
        && name.chars().all(plain)
        && (port.is_empty() || port.bytes().all(|b| b.is_ascii_digit()) && port.parse::<u16>().is_ok())
        && (!is_address || name.parse::<Ipv4Addr>().is_ok())
}

/// The rules that an address breaks: a host, placeholders that are filled in, and something among them to be credited by.
fn broken(completion: &Completion, session: &SessionRules) -> Vec<String> {
    let mut rules = Vec::new();
    let Some(address) = completion.redirect.as_deref() else { return rules };
    let host = address.trim_start_matches("https://").split(['/', '?', '#']).next().unwrap_or_default();
    if !leads_somewhere(host) {
        rules.push(format!("must lead to a host, and {host:?} is none"));
    }
    let placeholders = match Completion::placeholders(address) {
        Ok(placeholders) => placeholders,
        Err(rule) => {
            rules.push(rule);
            return rules;
        }
    };
    let known: Vec<&str> = std::iter::once("CODE")
        .chain(PANEL_PARAMS)
        .chain(session.params.iter().chain(&session.id).map(String::as_str))
        .collect();
    for name in &placeholders {
        // Which parameters a link has is known for certain only of those that are listed.
        if !known.contains(name) {
            let all: Vec<String> = known.iter().map(|name| format!("[{name}]")).collect();
            rules.push(format!(
                "[{name}] is filled in only where session.params lists it; known here are {}",
                all.join(", ")
            ));
        }
    }
    let written = completion.code.as_ref().is_some_and(|code| address.contains(code.as_str()));
    let credited = |name: &&str| {
        *name == "CODE" || CREDITING_PARAMS.contains(name) || session.id.as_deref() == Some(*name)
    };
    if !written && !placeholders.iter().any(credited) {
        rules.push("must hold [CODE], or whoever comes back has no code to show".to_owned());
    }
    rules
}
