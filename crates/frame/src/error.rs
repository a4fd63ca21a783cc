//! Why nothing was drawn, by any renderer.

/// Why nothing was drawn.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The technique cannot draw this scene truthfully; the message names the field and the rule.
    #[error("{technique} cannot draw this scene: {reason}")]
    Inapplicable {
        /// Technique name.
        technique: &'static str,
        /// Field, value and rule.
        reason: String,
    },
    /// The image asked for is not possible.
    #[error("{0}")]
    View(String),
    /// A knob is out of its range; the message names the knob, the value and the rule.
    #[error("{0}")]
    Knob(String),
    /// No adapter, or it failed.
    #[error("GPU: {0}")]
    Gpu(String),
    /// An image could not be encoded.
    #[error("encoding: {0}")]
    Encode(String),
    /// A file could not be written.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: String,
        /// What the system said.
        source: std::io::Error,
    },
}

impl From<kelir_jcs::Error> for RenderError {
    fn from(error: kelir_jcs::Error) -> Self {
        match error {
            kelir_jcs::Error::Lost(_) => Self::Knob(error.to_string()),
            kelir_jcs::Error::Unwritable(_) => Self::Encode(error.to_string()),
        }
    }
}
