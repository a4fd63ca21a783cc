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
    /// A drawn value that is no finite number. It is never shown, stored or measured.
    #[error("{drawn}{channel} is {value} at pixel ({}, {}), counted from the top left", at[0], at[1])]
    NotFinite {
        /// What was drawn by what, as [`RenderError::of`] says it.
        drawn: String,
        /// The channel, as EXR files name it.
        channel: String,
        /// The value.
        value: f32,
        /// Column and row.
        at: [usize; 2],
    },
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

impl RenderError {
    /// The same error; of a value that is not finite it says in which scene and by which technique.
    pub fn of(self, scene: &str, technique: &str) -> Self {
        match self {
            Self::NotFinite { channel, value, at, .. } => {
                Self::NotFinite { drawn: format!("{scene} drawn by {technique}: "), channel, value, at }
            }
            other => other,
        }
    }
}

impl From<kelir_jcs::Error> for RenderError {
    fn from(error: kelir_jcs::Error) -> Self {
        match error {
            kelir_jcs::Error::Lost(_) => Self::Knob(error.to_string()),
            kelir_jcs::Error::Unwritable(_) => Self::Encode(error.to_string()),
        }
    }
}
