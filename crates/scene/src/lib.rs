//! What is drawn: a scene file becomes a [`Scene`], and a scene at one instant a [`Theatre`].
//!
//! Reading is strict and never stops at the first problem: [`Problems`] holds all of them, each with file, field,
//! value and rule. Input may be hostile; [`limits`] says how large a scene may be.
//!
//! `docs/reference/scene-file.md` lists every key; it is made of what the reader asks for.

mod assets;
mod colour;
mod fields;
pub mod limits;
mod load;
mod mend;
mod picture;
mod puppet;
#[cfg(test)]
mod reference;
mod scene;
pub mod stage;
mod staging;
mod subject;
pub mod theatre;
mod timeline;
mod weave;

pub use assets::{Assets, DirAssets};
pub use colour::srgb_to_linear;
pub use kelir_reader::{Problem, Problems};
pub use mend::{Mending, mend};
pub use puppet::figure::Pose;
pub use puppet::manifest::Part;
pub use puppet::masks::Masks;
pub use puppet::svg::Mended;
pub use scene::{AnyScene, Scene};
pub use staging::{Puppet, Setting, Staging};
pub use theatre::*;
pub use timeline::Timeline;
