//! PA: the emitter's visibility from a summed-area table of opacity (Taylor & Cameron, with exact boxes).
//!
//! `centre` pixels are the mean opacity of the box that the pixel's centre sees ([`crate::project::ShadowBox`]).
//! `area` pixels are its mean over the pixel: box ⊛ pixel is a trapezoid window, and since a table is piecewise
//! bilinear the mean is a finite sum, so the native code draws it exactly. Drawn with n × n sub-samples instead, a straight
//! edge errs by at most 1 / (8 w n²) where the box is w pixels wide.
//!
//! A disk is cut into strips, a tilted plane is looked up piece by piece (`tilted`), and light from the dome is a convolution
//! (`dome`).
//!
//! With several planes the mean over the pixel of a product is not the product of means: where a box is narrower than
//! four pixels each pixel is cut into n × n parts, n = ⌈4 / w⌉ (at most 4). What is left is a covariance inside a part of
//! a pixel, at most ¼ of the product of both planes' change across it.

mod background;
mod dome;
#[cfg_attr(not(feature = "gpu"), path = "no_gpu.rs")]
mod gpu;
mod kept;
mod native;
pub(crate) mod plan;
pub(crate) mod rows;
mod shadow_map;
mod skips;
pub(crate) mod table;
mod tiles;
pub(crate) mod tilted;

use kelir_frame::{Backend, RenderError, Renderer, VisibilityModel};
use kelir_scene::Theatre;
use serde::{Deserialize, Serialize};

use kelir_frame::knobs::{self, Knob, Range};

#[cfg(feature = "gpu")]
pub(crate) use gpu::twins;
pub use native::Native;
pub use skips::Skips;

/// Stands in the key of every job: raise it, and bless the golden images, with any change that can change a byte that this technique
/// draws, in its own files or in what it shares with others. What was made before is then made anew.
pub const REVISION: u32 = 1;

/// What can be turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Knobs {
    /// Each emitter is split into `split × split` pieces (1..=64) whose products over the planes are averaged; 1 is the
    /// paper's way.
    pub split: u32,
    /// How pieces weigh.
    pub weights: Weights,
    /// A disk is cut into this many strips (1..=1024), each a rectangle of the strip's own area.
    pub strips: u32,
    /// Boxes on the puppets themselves, or the paper's shadow map.
    pub variant: Variant,
    /// Samples a side of the shadow map (16..=8192).
    pub map_size: u32,
    /// Lattice points per distance of the puppet that the dome's light is worked out on (2..=128).
    pub dome_steps: u32,
}

impl Default for Knobs {
    fn default() -> Self {
        Self {
            split: 1,
            weights: Weights::Area,
            strips: 64,
            variant: Variant::Exact,
            map_size: 1024,
            dome_steps: 32,
        }
    }
}

impl Knobs {
    /// [`REVISION`], or the next where weights are of irradiance: those alone changed, by a rounding, since they are taken along rows.
    pub fn revision(&self) -> u32 {
        REVISION + u32::from(self.weights == Weights::Irradiance)
    }

    /// Errors: a knob out of its range.
    pub fn check(&self) -> Result<(), RenderError> {
        knobs::check(KNOBS, self)
    }
}

/// What can be turned, for files, command line and tables.
pub const KNOBS: &[Knob] = &[
    Knob {
        name: "split",
        unit: "",
        range: Range::Whole(1, 64),
        about: "splits each emitter into K × K pieces, whose products over the puppets are averaged; 1 is the paper's way",
    },
    Knob {
        name: "weights",
        unit: "",
        range: Range::Word(&["area", "irradiance"]),
        about: "how the pieces weigh: area tends to the geometric visibility, irradiance to what a meter reads",
    },
    Knob {
        name: "strips",
        unit: "",
        range: Range::Whole(1, 1024),
        about: "strips that a disk is cut into, each a rectangle of the strip's own area",
    },
    Knob {
        name: "variant",
        unit: "",
        range: Range::Word(&["exact", "shadow-map"]),
        about: "tables of the puppets themselves, or of a shadow map drawn from the lamp, as in the paper",
    },
    knobs::MAP_SIZE,
    Knob {
        name: "dome_steps",
        unit: "",
        range: Range::Whole(2, 128),
        about: "lattice points per distance of a puppet for the dome's light",
    },
];

/// Where tables come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Variant {
    /// The puppets' own texels.
    #[default]
    Exact,
    /// The paper's: a map of `map_size` × `map_size` point samples, as the lamp's centre sees the puppets.
    ShadowMap,
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

impl Weights {
    /// The visibility that the pieces' sum tends to.
    fn model(self) -> VisibilityModel {
        match self {
            Self::Area => VisibilityModel::Geometric,
            Self::Irradiance => VisibilityModel::Irradiance,
        }
    }
}

/// The renderer for `knobs` on `backend`.
pub fn renderer(knobs: &Knobs, backend: Backend) -> Result<Box<dyn Renderer<Theatre>>, RenderError> {
    knobs.check()?;
    match kelir_frame::gpu::choose(backend)? {
        Some(gpu) => gpu::renderer(gpu, *knobs),
        None => Ok(Box::new(Native::new(*knobs))),
    }
}

#[cfg(test)]
mod tests;
