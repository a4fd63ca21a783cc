//! The oracle: f64, no random numbers, slow and obvious; what every technique is held against, on crops.

use serde::{Deserialize, Serialize};

use crate::{RenderError, Renderer};

/// What can be turned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Knobs {
    /// Where nothing is a finite sum, the emitter is subdivided until two levels differ by less than this.
    pub tolerance: f64,
}

impl Default for Knobs {
    fn default() -> Self {
        Self { tolerance: 1e-7 }
    }
}

/// The renderer for `knobs`; it has one backend.
pub fn renderer(_knobs: &Knobs) -> Result<Box<dyn Renderer>, RenderError> {
    Err(RenderError::Knob("oracle is not built yet".into()))
}
