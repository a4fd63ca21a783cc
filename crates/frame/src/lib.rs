//! What an image is, whatever it shows: the view asked for, the frame answered, the radiance that is white, encoders, films, a camera.
//!
//! A [`Renderer`] of some subject turns it into linear [`Frame`]s or display codes on a [`Backend`]. What renderers share and no subject
//! has stands here too: the device ([`gpu`]) and loops for each instruction set ([`simd`]).

mod backend;
pub mod camera;
pub mod encode;
mod error;
pub mod exposure;
pub mod file;
pub mod film;
pub mod folder;
mod frame;
#[cfg_attr(not(feature = "gpu"), path = "no_gpu.rs")]
pub mod gpu;
pub mod knobs;
pub mod simd;
pub mod sobol;

pub use backend::Backend;
pub use error::RenderError;
pub use frame::*;
pub use simd::Isa;
