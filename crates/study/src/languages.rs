//! A study in several languages: its own, and the translations of all that participants read.

use crate::definition::{StudyDefinition, Texts};
use crate::fields::{SECTION, text};
use crate::parse::{QUESTION, TITLE, read_texts};
use kelir_reader::Fields;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use utoipa::ToSchema;

/// The language of a file that names none.
const UNNAMED: &str = "en";

/// The rule of [`language`] in words.
const LANGUAGE: &str = "a language tag such as \"de\", \"pt-BR\" or \"zh-Hant\", of at most 35 characters";

/// What participants read of a study, in another language than its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Translation {
    /// Title.
    pub title: String,
    /// The question over every trial.
    pub question: String,
    /// What participants read.
    pub texts: Texts,
}

impl StudyDefinition {
    /// The language in which a session that asked for `wanted` reads the study: that one where the study has it, else its own.
    pub fn language_for<'a>(&'a self, wanted: Option<&'a str>) -> &'a str {
        wanted.filter(|wanted| self.translations.contains_key(*wanted)).unwrap_or(&self.language)
    }

    /// What participants read in a language; in the study's own where it has no such translation.
    pub fn texts_in(&self, language: &str) -> &Texts {
        self.translations.get(language).map_or(&self.texts, |translation| &translation.texts)
    }
}

/// The study's own language.
pub(crate) fn read_language(fields: &mut Fields<'_>) -> Option<String> {
    fields.defaulted("language", LANGUAGE, unnamed(), |v| {
        v.as_str().filter(|tag| language(tag)).map(str::to_owned)
    })
}

/// The translations by language; each is whole.
pub(crate) fn read_translations(
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
        let texts = read_texts(&mut fields);
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

pub(crate) fn unnamed() -> String {
    UNNAMED.to_owned()
}

pub(crate) fn is_unnamed(language: &str) -> bool {
    language == UNNAMED
}

#[cfg(test)]
mod tests;
