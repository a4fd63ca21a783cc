//! `[texts]`: what participants read, in paragraphs.

use crate::fields::text;
use crate::languages::Texts;
use kelir_reader::{Fields, Node};

/// What a title may be.
pub(super) const TITLE: &str = "a text of 1 to 200 characters, none of them a control character";
/// What a question may be.
pub(super) const QUESTION: &str = "a text of 1 to 300 characters, none of them a control character";

/// The texts of a study, or of a translation.
pub(super) fn read(fields: &mut Fields<'_>) -> Option<Texts> {
    let mut fields = fields.need(
        "texts",
        "a table with welcome, consent, instructions, debriefing and thanks",
        Node::table,
    )?;
    let mut read = |key| {
        fields.must(
            key,
            "plain text of at most 20000 characters, paragraphs apart by an empty line",
            paragraphs,
        )
    };
    let texts = (read("welcome"), read("consent"), read("instructions"), read("debriefing"), read("thanks"));
    fields.done();
    let (welcome, consent, instructions, debriefing, thanks) = texts;
    Some(Texts {
        welcome: welcome?,
        consent: consent?,
        instructions: instructions?,
        debriefing: debriefing?,
        thanks: thanks?,
    })
}

/// Paragraphs are apart by an empty line; a line break inside one is a blank.
fn paragraphs(value: &Node) -> Option<Vec<String>> {
    let text = text(value, 20_000)?;
    let mut paragraphs = vec![String::new()];
    for line in text.lines().map(str::trim) {
        let last = paragraphs.last_mut()?;
        match (line.is_empty(), last.is_empty()) {
            (true, true) => {}
            (true, false) => paragraphs.push(String::new()),
            (false, true) => last.push_str(line),
            (false, false) => {
                last.push(' ');
                last.push_str(line);
            }
        }
    }
    Some(paragraphs)
}
