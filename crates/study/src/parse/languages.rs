//! `language` and `[translations]`: the language of a study's texts, and all of them in others.

use super::texts::{self, QUESTION, TITLE};
use crate::fields::{SECTION, text};
use crate::languages::{Translation, unnamed};
use kelir_reader::Fields;
use std::collections::{BTreeMap, BTreeSet};

/// The rule of [`language`] in words.
const LANGUAGE: &str = "a language tag such as \"de\", \"pt-BR\" or \"zh-Hant\", of at most 35 characters";

/// The study's own language.
pub(super) fn read_own(fields: &mut Fields<'_>) -> Option<String> {
    fields.defaulted("language", LANGUAGE, unnamed(), |v| {
        v.as_str().filter(|tag| language(tag)).map(str::to_owned)
    })
}

/// The translations by language; each is whole.
pub(super) fn read_translations(
    fields: &mut Fields<'_>,
    own: Option<&str>,
) -> Option<BTreeMap<String, Translation>> {
    let Some(node) = fields.given("translations", SECTION) else { return Some(BTreeMap::new()) };
    let table = node.must("a table with a table for each language", |v| v.as_entries())?;
    let mut translations = BTreeMap::<String, Translation>::new();
    let mut known: Vec<String> = Vec::new();
    for (tag, node) in table {
        if !language(tag) {
            node.refuse::<()>(format!("must be {LANGUAGE}"));
        }
        if own.is_some_and(|own| own.eq_ignore_ascii_case(tag)) {
            node.refuse::<()>("is the study's own language, whose texts stand outside the translations");
        }
        // "pt-BR" and "pt-br" are one language.
        if known.contains(&tag.to_ascii_lowercase()) {
            node.refuse::<()>("is a language that is there already");
        }
        known.push(tag.to_ascii_lowercase());
        let mut fields = node.table()?;
        let title = fields.must("title", TITLE, |v| text(v, 200));
        let question = fields.must("question", QUESTION, |v| text(v, 300));
        let texts = texts::read(&mut fields);
        fields.done();
        if let (Some(title), Some(question), Some(texts)) = (title, question, texts) {
            translations.insert(tag.to_owned(), Translation { title, question, texts });
        }
    }
    Some(translations)
}

/// A language tag as browsers take it (BCP 47 without extensions): language, then script, region and variants where they are there, in this order.
fn language(tag: &str) -> bool {
    let letters = |part: &str| part.bytes().all(|b| b.is_ascii_alphabetic());
    let digits = |part: &str| part.bytes().all(|b| b.is_ascii_digit());
    let alphanumeric = |part: &str| part.bytes().all(|b| b.is_ascii_alphanumeric());
    let is_script = |part: &str| part.len() == 4 && letters(part);
    let is_region = |part: &str| part.len() == 2 && letters(part) || part.len() == 3 && digits(part);
    let is_variant = |part: &str| {
        alphanumeric(part) && ((5..=8).contains(&part.len()) || part.len() == 4 && digits(&part[..1]))
    };
    let mut parts = tag.split('-').peekable();
    let first = parts.next().unwrap_or_default();
    parts.next_if(|part| is_script(part));
    parts.next_if(|part| is_region(part));
    let mut variants = BTreeSet::new();
    tag.len() <= 35
        && (2..=3).contains(&first.len())
        && first.bytes().all(|b| b.is_ascii_lowercase())
        && parts.all(|part| is_variant(part) && variants.insert(part.to_ascii_lowercase()))
}

#[cfg(test)]
mod tests;
