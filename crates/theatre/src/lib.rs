//! How a theatre is drawn: one folder per technique, its WGSL beside it and its CPU twin.
//!
//! Everything that techniques share lives beside their folders: the irradiance of an unshadowed emitter ([`irradiance`]), where a point of
//! the screen sees the emitter on an occluder plane ([`project`]), the albedo on the pixel grid ([`albedo`]), the radiance that is white
//! ([`exposure`]). How exact it is and how fast its inner loops are: [`numerics`] and [`kernels`];
//! whether a GPU draws what the native code does: `twins`.

#![cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "the GPU's twins are not built"))]

pub mod albedo;
mod ambient;
mod emitters;
pub mod exposure;
pub mod irradiance;
pub mod kernels;
pub mod numerics;
pub mod penumbra;
pub mod project;
#[cfg(test)]
mod shaders;
pub mod techniques;
mod trace;
#[cfg(feature = "gpu")]
pub mod twins;

pub use exposure::white;
pub use techniques::{mc, oracle, pa, pcss, points};
