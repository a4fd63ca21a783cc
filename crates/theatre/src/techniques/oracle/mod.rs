//! The oracle: f64, no random numbers, slow and obvious; what every technique is held against, on crops.
//!
//! Every plane's texel edges are projected through the screen point onto the lamp's plane. Between neighbouring edges all
//! masks are constant, so both visibilities are finite sums over such cells: of areas (geometric), or of Lambert's
//! formula (irradiance). An `area` pixel seen through one plane is a finite sum too: a texel's overlap with the box,
//! averaged over the pixel, has a closed form. Several planes, and irradiance, are averaged over the pixel piece by piece:
//! it is cut where a texel line crosses the emitter's edge or another plane's line, and between cuts both visibilities are
//! smooth, so that two Gauss points a side serve. Disks (cut into strips) and tilted planes (texels projected onto the lamp's
//! plane and clipped to each piece of the emitter) are averaged by midpoints, whose number is doubled until two levels differ
//! by less than the tolerance.

mod pieces;
mod renderer;
mod upright;
mod visibility;

use std::ops::Bound;

use kelir_frame::{RenderError, Renderer};
use kelir_scene::Theatre;
use serde::{Deserialize, Serialize};

use kelir_frame::knobs::{self, Knob, Range};

pub use renderer::{BothModels, Oracle};
pub use upright::Visibility;
pub use visibility::{Point, dome, geometric, visibility};

/// Stands in the key of every job: raise it, and bless the golden images, with any change that can change a byte that this technique
/// draws, in its own files or in what it shares with others. What was made before is then made anew.
pub const REVISION: u32 = 1;

/// What can be turned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Knobs {
    /// Where nothing is a finite sum, the emitter or pixel is subdivided until two levels differ by less than this.
    pub tolerance: f64,
    /// Draw E⁰ · Vgeo, as PA does, in place of the true irradiance.
    pub geometric: bool,
}

impl Default for Knobs {
    fn default() -> Self {
        Self { tolerance: 1e-4, geometric: false }
    }
}

impl Knobs {
    /// Errors: a knob out of its range.
    pub fn check(&self) -> Result<(), RenderError> {
        knobs::check(KNOBS, self)
    }
}

/// What can be turned, for files, command line and tables.
pub const KNOBS: &[Knob] = &[
    Knob {
        name: "tolerance",
        unit: "",
        range: Range::Number(Bound::Excluded(0.0), Bound::Included(0.1)),
        about: "where nothing is a finite sum, emitter or pixel is subdivided until two levels differ by less than this",
    },
    Knob {
        name: "geometric",
        unit: "",
        range: Range::Flag,
        about: "draws what an emitter gives times its geometric visibility, as pa does, in place of the true irradiance",
    },
];

/// The renderer for `knobs`; it has one backend.
pub fn renderer(knobs: &Knobs) -> Result<Box<dyn Renderer<Theatre>>, RenderError> {
    knobs.check()?;
    Ok(Box::new(Oracle::new(*knobs)))
}

#[cfg(test)]
mod tests;
