#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::definition::StudyDefinition;
use kelir_fixtures as fixtures;

/// A study in one language, with more keys at its root and tables at its end.
fn with(keys: &[(&str, &str)], tables: &str) -> String {
    let block = fixtures::block("stills", &[("items", &fixtures::items(["a"], "a.toml"))]);
    fixtures::study(keys, [block, tables.to_owned()])
}

const GERMAN: &str = r#"
[translations.de]
title = "Schatten"
question = "Welches?"
[translations.de.texts]
welcome = "W"
consent = "C"
instructions = "I"
debriefing = "D"
thanks = "T"
"#;

fn read(source: &str) -> StudyDefinition {
    StudyDefinition::parse("shadows.toml", source).unwrap()
}

fn problems(source: &str) -> Vec<String> {
    let errors = StudyDefinition::parse("shadows.toml", source).unwrap_err();
    errors.iter().map(|problem| format!("{}: {}", problem.field, problem.rule)).collect()
}

#[test]
fn a_session_reads_the_language_it_asked_for_where_the_study_has_it() {
    let study = read(&with(&[], GERMAN));
    assert_eq!(study.language, "en");
    let read = |wanted| {
        let language = study.language_for(wanted);
        (language, study.texts_in(language).consent[0].as_str())
    };
    assert_eq!(read(Some("de")), ("de", "C"));
    assert_eq!(read(Some("en")), ("en", "c"));
    assert_eq!(read(Some("fr")), ("en", "c"));
    assert_eq!(read(None), ("en", "c"));
}

#[test]
fn a_study_in_one_language_may_say_which_and_no_answer_depends_on_it() {
    let (unnamed, german) = (read(&with(&[], "")), read(&with(&[("language", "\"de\"")], "")));
    assert_eq!(german.language_for(Some("en")), "de");
    assert_eq!(unnamed.design_hash(), german.design_hash());
    assert_ne!(unnamed.file_hash(), german.file_hash());
    assert_eq!(read(&with(&[("language", "\"en\"")], "")).file_hash(), unnamed.file_hash());
}

#[test]
fn what_is_judged_by_counts_in_every_language() {
    let study = with(&[], GERMAN);
    let hash = |source: &str| read(source).design_hash();
    assert_ne!(hash(&study), hash(&with(&[], "")));
    for text in ["\"Schatten\"", "\"W\"", "\"C\"", "\"D\"", "\"T\""] {
        assert_eq!(hash(&study.replace(text, "\"anders\"")), hash(&study), "{text}");
    }
    for text in ["\"Welches?\"", "\"I\""] {
        assert_ne!(hash(&study.replace(text, "\"anders\"")), hash(&study), "{text}");
    }
    let back: StudyDefinition = serde_json::from_str(&read(&study).to_json()).unwrap();
    assert_eq!(back, read(&study));
}

#[test]
fn every_problem_of_a_translation_is_named() {
    let missing =
        GERMAN.replace("consent = \"C\"\n", "").replace("title = \"Schatten\"\n", "titel = \"Schatten\"\n");
    let found = problems(&with(&[], &missing));
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found.iter().any(|p| p.starts_with("translations.de.title: is missing")), "{found:?}");
    assert!(found.iter().any(|p| p.starts_with("translations.de.texts.consent: is missing")), "{found:?}");
    assert!(found.iter().any(|p| p.starts_with("translations.de.titel: is not a known key")), "{found:?}");
    let own = problems(&with(&[("language", "\"de\"")], GERMAN));
    assert_eq!(
        own,
        ["translations.de: is the study's own language, whose texts stand outside the translations"]
    );
    let again = GERMAN.replace("translations.de", "translations.de-AT");
    let twice = problems(&with(&[], &[again.clone(), again.replace("de-AT", "de-at")].concat()));
    assert_eq!(twice, ["translations.de-at: is a language that is there already"]);
    let own = problems(&with(&[("language", "\"de-at\"")], &again));
    assert_eq!(
        own,
        ["translations.de-AT: is the study's own language, whose texts stand outside the translations"]
    );
    let named = problems(&with(&[("language", "\"Deutsch\"")], ""));
    assert!(named[0].starts_with("language: must be a language tag"), "{named:?}");
    let table = problems(&with(&[("translations", "3")], ""));
    assert_eq!(table, ["translations: must be a table with a table for each language"]);
}

#[test]
fn language_tags_by_their_shape() {
    for tag in ["de", "pt-BR", "zh-Hant", "ar", "gsw", "de-CH-1996"] {
        assert!(language(tag), "{tag}");
    }
    for tag in ["sr-Latn-RS", "es-419", "sl-rozaj-biske-1994"] {
        assert!(language(tag), "{tag}");
    }
    // No browser knows these, and each would refuse to name them: parts that are none, in another order, or said twice.
    for tag in ["de-ab12", "en-12", "en-US-US", "de-abcd-abcd", "zh-yue", "sl-rozaj-Rozaj", "de-1996-DE"] {
        assert!(!language(tag), "{tag}");
    }
    for tag in ["", "d", "DE", "german", "de_AT", "de-", "de-x", "ar-\u{661}1", "de-aaaaaaaaa"] {
        assert!(!language(tag), "{tag}");
    }
}
