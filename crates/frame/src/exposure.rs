//! What the radiance that the display shows as white is taken from.

use serde::{Deserialize, Serialize};

/// What white is the brightest of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Rule {
    /// The still itself: the scene as written, or at its instant.
    Still,
    /// Every frame of the scene's timeline: one white for all of them, and for a still that stands beside them. Without a timeline, as
    /// [`Rule::Still`].
    Timeline,
}

impl Rule {
    /// The name in files, options and messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Still => "still",
            Self::Timeline => "timeline",
        }
    }
}
