//! PA: the emitter's visibility from a summed-area table of opacity (Taylor & Cameron, with exact boxes).
//!
//! `centre` pixels are the mean opacity of the box that the pixel's centre sees ([`crate::project::ShadowBox`]).
//! `area` pixels are its mean over the pixel: box ⊛ pixel is a trapezoid window, and since a table is piecewise
//! bilinear the mean is a finite sum, so the native code draws it exactly. Drawn with n × n sub-samples instead, a straight
//! edge errs by at most 1 / (8 w n²) where the box is w pixels wide.

use serde::{Deserialize, Serialize};

use crate::{Backend, RenderError, Renderer};

/// What can be turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Knobs {
    /// Each emitter is split into `split × split` pieces whose products over the planes are averaged; 1 is the paper's way.
    pub split: u32,
    /// How pieces weigh.
    pub weights: Weights,
}

impl Default for Knobs {
    fn default() -> Self {
        Self { split: 1, weights: Weights::Area }
    }
}

/// How the pieces of a split emitter weigh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Weights {
    /// By area: tends to the geometric visibility.
    #[default]
    Area,
    /// By each piece's own unshadowed irradiance: tends to what a light meter reads.
    Irradiance,
}

/// The renderer for `knobs` on `backend`.
pub fn renderer(_knobs: &Knobs, _backend: Backend) -> Result<Box<dyn Renderer>, RenderError> {
    Err(RenderError::Gpu("pa is not built yet".into()))
}
