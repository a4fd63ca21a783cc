//! How a theatre is drawn: one folder per technique, its WGSL beside its CPU twin.
//!
//! A [`Technique`] with its knobs becomes a [`Renderer`] on a [`Backend`]; the renderer turns theatres into linear
//! [`Frame`]s or display codes. Everything that techniques share lives beside this file: the irradiance of an
//! unshadowed emitter ([`irradiance`]), where a point of the screen sees the emitter on an occluder plane
//! ([`project`]), the albedo on the pixel grid ([`albedo`]) and the exposure ([`exposure`]).

#![cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "the GPU's twins are not built"))]

pub mod accuracy;
pub mod albedo;
pub mod ambient;
pub mod bench;
pub mod camera;
pub mod encode;
pub mod exposure;
pub mod file;
pub mod film;
pub mod frame;
#[cfg_attr(not(feature = "gpu"), path = "no_gpu.rs")]
pub mod gpu;
pub mod irradiance;
pub mod job;
pub mod numerics;
pub mod penumbra;
pub mod project;
mod simd;
pub mod subject;
pub mod techniques;
mod trace;

pub use exposure::white;
pub use frame::*;
pub use simd::Isa;
pub use techniques::{Backend, Technique, mc, oracle, pa, pcss, points, renderer};

/// Stands in the key of every job: raise it, and bless the golden images, with any change that can change a byte whatever the technique:
/// staging and masks of a scene, exposure, albedo, irradiance, camera, sRGB, PNG, JPEG, an animation's manifest.
pub const REVISION: u32 = 1;

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
