//! What a version of a study is: its design and the pictures it shows, as hashes.
//!
//! Everything is hashed as RFC 8785 canonical JSON (JCS): keys sorted, numbers as ECMAScript writes them, −0 as 0.

use crate::definition::StudyDefinition;
use serde_json::{Map, Value, json};
use sha2::{Digest, Sha256};

/// One picture or animation that a version shows.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct VersionStimulus {
    /// Item's id.
    pub item: String,
    /// Condition's name.
    pub condition: String,
    /// [width, height] in pixels.
    pub size: [u32; 2],
    /// SHA-256 (hex) of the decoded pixels.
    pub pixels_sha256: String,
}

/// Keys of a study that nobody judges by: what is read before and after, and how people are received. A block's title is for researchers alone.
const NOT_JUDGED_BY: [&str; 8] =
    ["title", "estimated_minutes", "idle_minutes", "completion", "conduct", "panel", "session", "language"];
const TEXTS_NOT_JUDGED_BY: [&str; 4] = ["welcome", "consent", "debriefing", "thanks"];

impl StudyDefinition {
    /// SHA-256 (hex) over all values of the file: comments and layout do not count, every value does.
    pub fn file_hash(&self) -> String {
        digest(self.value())
    }

    /// SHA-256 (hex) over what answers depend on: all values but those that nobody judges by (title, texts but the instructions, minutes,
    /// completion).
    pub fn design_hash(&self) -> String {
        let mut value = self.value();
        if let Value::Object(study) = &mut value {
            NOT_JUDGED_BY.iter().for_each(|key| drop(study.remove(*key)));
            without_texts(study);
            let translations = study.get_mut("translations").and_then(Value::as_object_mut);
            for translation in translations.into_iter().flat_map(|all| all.values_mut()) {
                let Value::Object(translation) = translation else { continue };
                translation.remove("title");
                without_texts(translation);
            }
            for block in study.get_mut("blocks").and_then(Value::as_array_mut).into_iter().flatten() {
                block.as_object_mut().and_then(|block| block.remove("title"));
            }
        }
        digest(value)
    }

    /// The version of a study with these stimuli: SHA-256 (hex) over JCS {v: 1, design_hash, stimuli: sorted [item, condition, size,
    /// pixels_sha256]}. Two files with one version ask the same of people and show them the same.
    pub fn version(&self, stimuli: &[VersionStimulus]) -> String {
        let mut stimuli = stimuli.to_vec();
        stimuli.sort();
        let rows: Vec<Value> =
            stimuli.iter().map(|s| json!([s.item, s.condition, s.size, s.pixels_sha256])).collect();
        digest(json!({ "v": 1, "design_hash": self.design_hash(), "stimuli": rows }))
    }

    /// The definition as JSON text; [`StudyDefinition`] reads it back.
    pub fn to_json(&self) -> String {
        self.value().to_string()
    }

    fn value(&self) -> Value {
        serde_json::to_value(self).expect("a definition holds only finite numbers and string keys")
    }
}

/// Takes out the texts that nobody judges by.
fn without_texts(read: &mut Map<String, Value>) {
    if let Some(Value::Object(texts)) = read.get_mut("texts") {
        TEXTS_NOT_JUDGED_BY.iter().for_each(|key| drop(texts.remove(*key)));
    }
}

fn digest(value: Value) -> String {
    let text = kelir_jcs::canonical(value).expect("a JSON value holds only finite numbers and string keys");
    hex::encode(Sha256::digest(text))
}
