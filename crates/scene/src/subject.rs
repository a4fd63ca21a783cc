//! What a scene file says that it shows.

use kelir_reader::Node;

/// What is shown; each has sections of its own in a scene file.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Subject {
    /// Puppets between a lamp and a screen.
    Theatre,
    /// Meshes on a stage.
    Stage,
    /// A photographed shadow.
    Plate,
}

/// Reads a scene's subject, and refuses what cannot be drawn yet.
pub(crate) fn subject(node: &Node) -> Option<Subject> {
    let choices = [("theatre", Subject::Theatre), ("stage", Subject::Stage), ("plate", Subject::Plate)];
    let subject = node.choice(&choices)?;
    let what = match subject {
        Subject::Theatre | Subject::Stage => return Some(subject),
        Subject::Plate => "a photographed shadow",
    };
    node.refuse::<()>(format!("{what} can't be drawn yet, only a \"theatre\" or a \"stage\""));
    Some(subject)
}
