//! Monte Carlo: an unbiased estimate of each emitter's irradiance with a standard error per pixel.

use serde::{Deserialize, Serialize};

use crate::{Backend, RenderError, Renderer};

/// What can be turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Knobs {
    /// Samples per pixel and emitter, rounded up to a multiple of the 16 scrambles.
    pub spp: u32,
    /// Seed of the scrambles.
    pub seed: u64,
}

impl Default for Knobs {
    fn default() -> Self {
        Self { spp: 64, seed: 1 }
    }
}

/// The renderer for `knobs` on `backend`.
pub fn renderer(_knobs: &Knobs, _backend: Backend) -> Result<Box<dyn Renderer>, RenderError> {
    Err(RenderError::Gpu("mc is not built yet".into()))
}
