//! The door to what draws: a scene, a technique and an output in, a stimulus out ([`job`]).
//!
//! What can be drawn is a [`subject`]; what draws it is a [`Technique`] with its knobs. Images themselves are kelir-frame's, how a theatre
//! is drawn is kelir-theatre's: what callers need of both is named here.

pub mod accuracy;
pub mod bench;
pub mod job;
pub mod subject;
pub mod techniques;

pub use kelir_frame::{
    Backend, Frame, Isa, Meter, Pixel, RenderError, Renderer, Stats, View, Visibility, VisibilityModel,
    camera, encode, exposure, file, film, folder,
};
#[cfg(feature = "gpu")]
pub use kelir_theatre::twins;
pub use kelir_theatre::{albedo, irradiance, mc, numerics, oracle, pa, pcss, penumbra, points, white};
pub use techniques::{Technique, renderer};

/// Stands in the key of every job: raise it, and bless the golden images, with any change that can change a byte whatever the technique:
/// staging and masks of a scene, exposure, albedo, irradiance, camera, sRGB, PNG, JPEG, an animation's manifest.
pub const REVISION: u32 = 3;
