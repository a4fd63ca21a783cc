//! How a theatre is drawn: one folder per technique, its WGSL beside its CPU twin.
pub mod frame;
pub use frame::*;

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
    /// No adapter, or it failed.
    #[error("GPU: {0}")]
    Gpu(String),
}
